"""Bytes of the examples that docs/esp32-hear.md and docs/arduino.md give sizes of."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from measure.boards import BOARDS
from measure.core import Bench, run, tool, version
from measure.sizes import compile_command, sections


def esp32_hear(bench: Bench) -> None:
    """examples/esp32-hear/lips.c for a Cortex-M4, whose RAM has the stream and its workspace in it."""
    (board,) = (one for one in BOARDS if one.preset == "m4")
    path = bench.source / "examples" / "esp32-hear" / "lips.c"
    command = [*compile_command(bench, board, "-Os"), "-Ilib/models", path]
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        out = Path(scratch) / "lips.o"
        run([*command, "-o", out], cwd=bench.source)
        found = sections(f"{board.prefix}size", out)
    shown = [*command, "&&", f"{board.prefix}size", "lips.o"]
    for figure, value in (("flash", found["text"]), ("RAM", found["data"] + found["bss"])):
        bench.add(board.preset, f"esp32-hear, lips.c: {figure}", value, "bytes", shown, version(f"{board.prefix}gcc"))


def uno(bench: Bench) -> None:
    """examples/uno without its motion, and the player of baked motion: a program with it less one without."""
    what = "The program for an Arduino Uno"
    compiler, size = (tool(name, "gcc-avr", what) for name in ("avr-gcc", "avr-size"))
    talk = bench.source / "examples" / "talk"
    command = [compiler, "-mmcu=atmega328p", "-Os", "-std=gnu99", "-ffunction-sections", "-Wl,--gc-sections",
               f"-I{talk}", f"-I{bench.source / 'export' / 'labial' / 'bake'}"]
    found = {}
    jaw, player = bench.source / "examples" / "uno" / "main.c", bench.source / "tests" / "device" / "uno_player.c"
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        for name, source, option in (("program", jaw, []), ("with", player, ["-DPLAYER"]), ("without", player, [])):
            out = Path(scratch) / f"{name}.elf"
            run([*command, *option, source, "-o", out])
            found[name] = sections(size, out)
    motion = re.search(r"const uint8_t (\w+)\[(\d+)\]", (talk / "talk.h").read_text(encoding="utf-8"))
    if not motion:
        raise RuntimeError(f"{talk / 'talk.h'}: no array")

    def bytes_of(name: str) -> int:
        return found[name]["text"] + found[name]["data"]

    for figure, value, path in (("program without its motion", bytes_of("program") - int(motion[2]), jaw),
                                ("player", bytes_of("with") - bytes_of("without"), player)):
        bench.add("uno", figure, value, "bytes", [*command, path, "&&", size, "a.out"], version(compiler))
