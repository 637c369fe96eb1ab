"""Where instructions and cycles go on Cortex-M0, by a plugin that counts what QEMU executes at every address."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Tuple

from measure.boards import BOARDS, RATE, Board, build, printed
from measure.core import Bench, LeftOut, run, version

#: Functions of the image itself, which are no part of what the library costs.
_IMAGE = re.compile(r"main|board_.*|bench_.*")

#: Cycles of Cortex-M0's instructions (Arm DDI 0432, table 3-1) without wait states and with the multiplier that takes
#: one cycle; the first that matches counts. Taken conditional branches and listed registers are added where they are
#: counted.
_CYCLES = (
    (r"(push|pop|ldmia|stmia|ldm|stm)(\.w)?$", 1),
    (r"(ldr|str)(b|h|sb|sh)?(\.n|\.w)?$", 2),
    (r"bl$", 4),
    (r"(bx|blx|b|b\.n|b\.w)$", 3),
    (r"(mrs|msr|dmb|dsb|isb)$", 4),
    (r"", 1),
)
_CONDITIONAL = re.compile(r"b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(\.n)?$")
_TAKEN = 2  #: further cycles of a conditional branch that is taken


@dataclass(frozen=True)
class Row:
    """What a function takes per frame delivered, without what it calls."""

    function: str
    instructions: float
    cycles: float
    calls: float


def cycles(mnemonic: str, operands: str) -> int:
    """Cycles of an instruction as objdump shows it; a conditional branch as if it were not taken."""
    count = next(number for pattern, number in _CYCLES if re.match(pattern, mnemonic))
    listed = re.search(r"\{(.*)\}", operands)
    if listed:
        for one in listed.group(1).split(","):
            low, _, high = (part.strip(" r") for part in one.partition("-"))
            count += int(high) - int(low) + 1 if high else 1
        if "pc" in listed.group(1):
            count += 2  # the list counts pc as a register: 4 + N with N registers beside it
    elif re.match(r"(mov|add)s?(\.n)?$", mnemonic) and operands.startswith("pc"):
        count += 2
    return count


def measure(bench: Bench, rows: List[Row]) -> None:
    """Cycles per frame of both models; `rows` receives the profile of speech, most instructions first.

    LeftOut where the plugin (bench/plugin.c) cannot be compiled or QEMU takes none.
    """
    board = BOARDS[0]
    images = build(bench, board)
    for model in ("speech", "laughter"):
        command, found = _profile(bench, board, images[f"bench_{model}"])
        total = sum(row.cycles for row in found)
        tool = version(f"{board.prefix}gcc")
        bench.add(board.preset, f"{model}: cycles", round(total), "cycles/frame", command, tool)
        bench.add(board.preset, f"{model}: share of the core by cycles",
                  round(100.0 * total * RATE / (board.clock * 1e6), 2), "%", command, tool)
        if model == "speech":
            rows.extend(found)


def _profile(bench: Bench, board: Board, image: List[str]) -> Tuple[List[str], List[Row]]:
    host = shutil.which("cc")
    if not host:
        raise LeftOut("The profile by function is left out, it needs a C compiler for the host.")
    folder = Path(image[-1]).parent
    plugin, histogram = folder / "plugin.so", Path(image[-1]).with_suffix(".histogram")
    run([host, "-O2", "-std=c99", "-shared", "-fPIC", bench.source / "bench" / "plugin.c", "-o", plugin])
    command = [image[0], "-plugin", f"file={plugin},out={histogram}", *image[1:]]
    try:
        frames = printed(command)["frames"]
    except RuntimeError as error:
        if "plugin" not in str(error).split("\n", 1)[1]:
            raise
        raise LeftOut(f"The profile by function is left out, this {board.emulator} takes no plugins.") from None
    places = _places(board, image[-1])
    sums: Dict[str, List[float]] = {}
    for line in histogram.read_text(encoding="ascii").splitlines():
        address, count, left = int(line.split()[0], 16), int(line.split()[1]), int(line.split()[2])
        function, begins, each, conditional = places[address]
        own = sums.setdefault(function, [0.0, 0.0, 0.0])
        own[0] += count
        own[1] += count * each + (left * _TAKEN if conditional else 0)
        own[2] += count if begins else 0
    rows = [Row(function, *(number / frames for number in own)) for function, own in sums.items()
            if not _IMAGE.fullmatch(function)]
    return command, sorted(rows, key=lambda row: -row.instructions)


def _places(board: Board, image: str) -> Dict[int, Tuple[str, bool, int, bool]]:
    """For the address of every instruction of an image: its function, whether it is the function's first, its cycles,
    whether it is a conditional branch. Local labels of assembly do not begin a function."""
    places: Dict[int, Tuple[str, bool, int, bool]] = {}
    function, begins = "", False
    for line in run([f"{board.prefix}objdump", "-d", image]).stdout.decode(errors="replace").splitlines():
        label = re.match(r"[0-9a-f]+ <([^.>][^>]*)>:", line)
        if label:
            function, begins = label.group(1), True
            continue
        parts = re.match(r"\s*([0-9a-f]+):\t[0-9a-f ]+\t(\S+)\s*(.*)", line)
        if parts:
            mnemonic, operands = parts.group(2), parts.group(3)
            conditional = bool(_CONDITIONAL.match(mnemonic))
            places[int(parts.group(1), 16)] = (function, begins, cycles(mnemonic, operands), conditional)
            begins = False
    return places
