"""Instructions and cycles by function, from a plugin that counts what QEMU executes at every address.

QEMU does not count cycles. Those of a core are sums from Arm's table, without wait states; for a range, such as for
loads that may overlap and for divisions, the largest value is used. For other cores no such table is published.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

from measure.boards import BOARDS, RATE, Board, build, printed
from measure.core import Bench, LeftOut, run, version

#: Functions of the image itself, which are not part of the library.
_IMAGE = re.compile(r"main|board_.*|bench_.*")
#: Cycles of each core's instructions; the first that matches counts. Taken conditional branches and listed registers
#: are added where they are counted. Cortex-M0: Arm DDI 0432, table 3-1, with the multiplier that takes one cycle;
#: Cortex-M3: DDI 0337, table 3-1; Cortex-M4: DDI 0439, table 3-1, with a pipeline that refills in two cycles.
_LISTED = (r"(push|pop|(ld|st)m(ia|db)?|ldrd|strd)(\.n|\.w)?$", 1)
_SINGLE = (r"(ldr|str)(b|h|sb|sh)?(\.n|\.w)?$", 2)
_BRANCH = (r"(bl|bx|blx|b|b\.n|b\.w)$", 3)
_OTHER = (r"", 1)
_CYCLES = {
    "m0": (_LISTED, _SINGLE, (r"bl$", 4), _BRANCH, (r"(mrs|msr|dmb|dsb|isb)$", 4), _OTHER),
    "m3": (_LISTED, _SINGLE, _BRANCH, (r"tb[bh]$", 4), (r"[us]mull$", 5), (r"[us]mlal$", 7), (r"ml[as]$", 2),
           (r"[us]div$", 12), _OTHER),
    "m4": (_LISTED, _SINGLE, _BRANCH, (r"tb[bh]$", 4), (r"[us]div$", 12), _OTHER),
}
_CONDITIONAL = re.compile(r"(b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(\.n|\.w)?|cbn?z)$")
_TAKEN = 2  #: further cycles of a conditional branch that is taken


@dataclass(frozen=True)
class Row:
    """The cost of a function per delivered frame, without its callees."""

    function: str
    instructions: float
    cycles: float
    calls: float


def cycles(mnemonic: str, operands: str, core: str = "m0") -> int:
    """Cycles of an instruction as objdump shows it, on the core of a preset; a conditional branch as if it were not
    taken."""
    count = next(number for pattern, number in _CYCLES[core] if re.match(pattern, mnemonic))
    listed = re.search(r"\{(.*)\}", operands)
    if re.match(r"(ldr|str)d", mnemonic):
        count += 2
    elif listed:
        for one in listed.group(1).split(","):
            low, _, high = (part.strip(" r") for part in one.partition("-"))
            count += int(high) - int(low) + 1 if high else 1
        if "pc" in listed.group(1):
            count += 2  # the list counts pc as a register: 4 + N with N registers beside it
    elif re.match(r"(mov|add)s?(\.n)?$", mnemonic) and operands.startswith("pc"):
        count += 2
    return count


def measure(bench: Bench, rows: List[Row]) -> None:
    """Cycles per frame of both models on every core whose cycles are known; `rows` receives the profile of speech on
    the first of them, most instructions first. Raises LeftOut if the plugin (bench/plugin.c) cannot be compiled or QEMU
    does not support plugins."""
    for board in (board for board in BOARDS if board.preset in _CYCLES):
        images = build(bench, board)
        for model in ("speech", "laughter"):
            command, found = _profile(bench, board, images[f"bench_{model}"])
            total = sum(row.cycles for row in found)
            tool = version(f"{board.prefix}gcc")
            bench.add(board.preset, f"{model}: cycles", round(total), "cycles/frame", command, tool)
            bench.add(board.preset, f"{model}: share of the core",
                      round(100.0 * total * RATE / (board.clock * 1e6), 2), "%", command, tool)
            if model == "speech" and not rows:
                rows.extend(found)
                for name, instructions in _by_file(bench, found).items():
                    bench.add(board.preset, f"speech: {name}", round(instructions), "instructions/frame", command, tool)


def _by_file(bench: Bench, rows: Sequence[Row]) -> Dict[str, float]:
    """Instructions per frame in the functions of each file of lib/. Inlined functions count in their callers."""
    sums: Dict[str, float] = {}
    for path in sorted((bench.source / "lib").glob("*.c")):
        text = path.read_text(encoding="utf-8")
        own = sum(row.instructions for row in rows  # the compiler's copies of a function have a point in their names
                  if re.search(rf"^\w[^;\n]*\b{re.escape(row.function.split('.')[0])}\(", text, re.MULTILINE))
        if own >= 0.5:
            sums[path.name] = own
    return sums


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
            places[int(parts.group(1), 16)] = (function, begins, cycles(mnemonic, operands, board.preset), conditional)
            begins = False
    return places
