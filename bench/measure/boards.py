"""The emulated boards: their compilers, and the figures that their images print."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Tuple

from measure.core import Bench, run, tool, version

#: Seconds of input that each image synthesises.
SECONDS = 20
#: Most bytes of stack of the images' callback.
_CALLBACK_STACK = 32
#: Frames per second for the share of a processor.
RATE = 50


@dataclass(frozen=True)
class Board:
    """An emulated board. `clock` is what a chip with this core usually runs at, in MHz, and `chip` which one is meant;
    `options` are the compiler's, which name the processor."""

    preset: str
    core: str
    prefix: str
    package: str
    emulator: str
    emulator_package: str
    clock: int
    chip: str
    options: Tuple[str, ...]


_ARM = ("arm-none-eabi-", "gcc-arm-none-eabi", "qemu-system-arm", "qemu-system-arm")
_RISCV = ("riscv64-unknown-elf-", "gcc-riscv64-unknown-elf", "qemu-system-riscv32", "qemu-system-misc")
#: All boards under QEMU, one in each row of its list.
TOOLCHAIN = Path(__file__).parents[2] / "boards" / "toolchains" / "qemu.cmake"


def _boards() -> Tuple[Board, ...]:
    found = []
    for row in re.findall(r'^  "([^"]*)"\)?$', TOOLCHAIN.read_text(encoding="utf-8"), re.MULTILINE):
        preset, _, options, link, core, clock, chip = row.split("|")
        tools = _ARM if link.startswith("arm/") else _RISCV
        found.append(Board(preset, core, *tools, int(clock), chip, tuple(options.split())))
    return tuple(found)


BOARDS = _boards()


def compiler(board: Board) -> str:
    return tool(f"{board.prefix}gcc", board.package, f"{board.core} code size")


def build(bench: Bench, board: Board) -> Dict[str, List[str]]:
    """Builds the board's images; the command that runs each, by its name."""
    what = f"What runs on {board.core}"
    tool(f"{board.prefix}gcc", board.package, what)
    tool(board.emulator, board.emulator_package, what)
    folder = bench.build / board.preset
    run(["cmake", "-S", bench.source, "-B", folder, f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}",
         f"-DLABIAL_BOARD={board.preset}", "-DCMAKE_BUILD_TYPE=Release",
         "-DLABIAL_BUILD_BENCH=ON", "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF", "-DLABIAL_WERROR=ON",
         f"-DLABIAL_BENCH_SECONDS={SECONDS}"])
    run(["cmake", "--build", folder, "--parallel", "2"])
    return json.loads((folder / "bench" / "images.json").read_text(encoding="utf-8"))


def printed(command: List[str]) -> Dict[str, int]:
    """The output of an image: lines of a name and a number."""
    found = dict(re.findall(r"^(\w+) (\d+)$", run(command).stdout.decode(), re.MULTILINE))
    return {name: int(number) for name, number in found.items()}


#: The inputs of board_ticks.c, by the names that it prints.
INPUTS = {"sentence": "the sentence", "laughter": "the laugh", "voices": "other sentences",
          "short": "phonemes of 20 to 40 ms", "frames": "phonemes of 20 ms", "turns": "models by turns",
          "changes": "another model at every phoneme", "all": "all inputs"}


def measure(bench: Bench, board: Board, checksums: Dict[str, int]) -> None:
    """Runs the images of `board`. `checksums`, by model, are those of the host's frames, which must come out again."""
    images = build(bench, board)
    tool_version = version(f"{board.prefix}gcc")
    for model in ("speech", "laughter"):
        command = images[f"bench_{model}"]
        found = printed(command)
        if model in checksums and found["checksum"] != checksums[model]:
            raise RuntimeError(f"{bench.shown(command)}: its frames are not the host's")
        _ticks(bench, board, model, "worst tick", command, found)
        pushing = round(found["push_instructions"] / found["frames"])
        for figure, value, unit in (("pushing", pushing, "instructions/frame"),
                                    ("labial_init()", found["init_instructions"], "instructions"),
                                    ("stack, painted", found["stack"], "bytes")):
            bench.add(board.preset, f"{model}: {figure}", value, unit, command, tool_version)
        # The call graph excludes the callback, a leaf.
        bound, stack = bench.value(board.preset, "stack -O2: every function"), found["stack"]
        if bound is not None and stack > bound + _CALLBACK_STACK:
            raise RuntimeError(f"{board.core}: {stack} bytes of stack were used, the call graph allows {bound}")
    _ticks(bench, board, "turns", "worst change", images["bench_turns"], printed(images["bench_turns"]))
    command = images["bench_ticks"]
    found = printed(command)
    for name, what in INPUTS.items():
        for figure, key in (("mean", "mean"), ("99th percentile", "99th"), ("largest", "largest")):
            bench.add(board.preset, f"ticks, {what}: {figure}", found[f"{name}_{key}"], "instructions", command,
                      tool_version)
    command = images["bench_mlpg"]
    found = printed(command)
    bench.add(board.preset, "MLPG", round(found["instructions"] / found["frames"], 1), "instructions/frame and channel",
              command, tool_version)


def _ticks(bench: Bench, board: Board, what: str, worst: str, command: List[str], found: Dict[str, int]) -> None:
    """Adds what the ticks take that an image has `found`."""
    mean = found["tick_instructions"] / found["frames"]
    for figure, value, unit in (("mean", round(mean), "instructions/frame"),
                                (worst, found["tick_worst"], "instructions"),
                                (f"{worst} / mean", round(found["tick_worst"] / mean, 3), "ratio")):
        bench.add(board.preset, f"{what}: {figure}", value, unit, command, version(f"{board.prefix}gcc"))
