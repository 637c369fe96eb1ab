"""Bytes of code, of tables and of RAM, by compiling for each board; also of what docs/esp32-hear.md, docs/arduino.md
and docs/beside.md give sizes of."""

from __future__ import annotations

import functools
import re
import shutil
import tempfile
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple, Union

from measure.boards import BOARDS, Board, compiler
from measure.core import Bench, run, tool, version

#: Files of lib/ that play compiled-in models. A program links the others only if it calls them, or for models from
#: files (model.c, the check, and blob.c).
CORE = ("stream", "channels", "units", "shape", "viterbi", "trajectory", "followers", "fade", "fixed")

LEVELS = ("-Os", "-O2")
#: The option by which the compiler writes frames and calls beside an object, which it does not change.
CALLS = "-fcallgraph-info=su,da"
#: What a program calls that moves servos by a stream and a clock.
FACE = ("labial_face_init", "labial_face_frame", "labial_face_due", "labial_face_tick", "labial_face_soft_start",
        "labial_face_attached")
#: The bundled models: their C file, and their names here.
MODELS = {"speech": "speech_en", "laughter": "laughter_synthetic"}
#: What an Arduino's processor is measured with, too.
BESIDE = "beside, one output, 128 frames ahead"
#: Parts of RAM and their bytes in C; those of the workspace add up to LABIAL_WORKSPACE_SIZE() for the voice, except for
#: rounding to four.
PARTS = {
    "labial_t: queue and labels": "sizeof(labial_units_t)",
    "labial_t: selection of shapes": "sizeof(labial_shape_t *) + sizeof(labial_selection_t)",
    "labial_t: poses": "3 * LABIAL_CHANNELS * sizeof(int16_t)",
    "workspace: searches": "COUNT * (sizeof(labial_progress_t) - sizeof(labial_solver_t)"
                           " - sizeof(labial_kept_t))",
    "workspace: solvers": "COUNT * sizeof(labial_solver_t)",
    "workspace: factors": "COUNT * sizeof(labial_kept_t)",
    "workspace: frames": "(STRIDE + LABIAL_LAG) * sizeof(labial_frame_t)",
    "workspace: motion": "STRIDE * COUNT * sizeof(int16_t)",
    "workspace: shapes": "2 * COUNT * sizeof(labial_shape_t)",
}
#: States of the modules beside the stream, and lips beside the audio with one output and 128 frames ahead, in C.
STATES = {
    **{f"labial_{name}_t": f"sizeof(labial_{name}_t)" for name in
       ("hear", "words", "voice", "laugh", "timings", "beside", "face", "clock")},
    BESIDE: "sizeof(labial_beside_t) + LABIAL_BESIDE_SIZE(1, 128)",
}
#: Frames that share a state in the voice, and its channels.
STRIDE = 3
COUNT = 8


def compile_command(bench: Bench, board: Board, level: str) -> List[str]:
    """The command that compiles a file of the library for a board, up to the file's name."""
    return [compiler(board), *board.options, level, "-std=c99", "-ffreestanding", "-isystem",
            str(bench.source / "boards" / "include"), f"-I{bench.source / 'include'}", "-c"]


def sections(size: str, path: Path) -> Dict[str, int]:
    """text (with read-only data), data and bss of an object, bytes."""
    names, numbers = run([size, path]).stdout.decode().splitlines()[:2]
    return dict(zip(names.split()[:3], map(int, numbers.split()[:3])))


def sized(size: str, command: Sequence[Union[str, Path]], cwd: Optional[Path] = None) -> Dict[str, int]:
    """The sections of what a command compiles."""
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        out = Path(scratch) / "out.o"
        run([*command, "-o", out], cwd=cwd)
        return sections(size, out)


def library(bench: Bench, board: Board, level: str) -> Path:
    """The folder of the objects of lib/ for a board, each beside its call graph; compiled once."""
    folder = bench.build / "library" / board.preset / level
    _compile(bench.source / "lib", folder, (*compile_command(bench, board, level), CALLS))
    return folder


@functools.cache
def _compile(sources: Path, folder: Path, command: Tuple[str, ...]) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path in sorted(sources.glob("*.c")):
        run([*command, path, "-o", folder / f"{path.stem}.o"])


def measure(bench: Bench, board: Board) -> None:
    """Code of every file at each level, of those that play, of all, of the compiler's helpers; tables, RAM."""
    size, tool_version = f"{board.prefix}size", version(compiler(board))
    variables = 0
    for level in LEVELS:
        text: Dict[str, int] = {}
        command, folder = compile_command(bench, board, level), library(bench, board, level)
        for path in sorted((bench.source / "lib").glob("*.c")):
            found = sections(size, folder / f"{path.stem}.o")
            variables += found["data"] + found["bss"]
            text[path.stem] = found["text"]
            bench.add(board.preset, f"code {level}: {path.name}", found["text"], "bytes",
                      [*command, path, "&&", size, f"{path.stem}.o"], tool_version)
        shown = [*command, "lib/*.c", "&&", size, "*.o"]
        core = [f"{stem}.o" for stem in CORE]
        for figure, value, what in (
            ("total", sum(text[stem] for stem in CORE), ["#", *core]), ("all of lib", sum(text.values()), []),
            ("compiler's helpers", _helpers(board, [folder / name for name in core]),
             ["#", "members", "of", "libgcc.a", "that", "these", "link"])):
            bench.add(board.preset, f"code {level}: {figure}", value, "bytes", [*shown, *what], tool_version)
    command = compile_command(bench, board, "-Os")
    tables = {f"{model}: {kind}": f"models/{stem}{end}.c" for model, stem in MODELS.items()
              for kind, end in (("model", ""), ("names", "_names"))}
    tables["words: tables"] = "words/words_en.c"
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        _face(bench, board, command, Path(scratch), tool_version)
        for figure, name in tables.items():
            path = bench.source / "lib" / name
            found = sized(size, [*command, path])
            variables += found["data"] + found["bss"]
            bench.add(board.preset, figure, found["text"], "bytes", [*command, path, "&&", size, f"{path.stem}.o"],
                      tool_version)
        bench.add(board.preset, ".data and .bss of library and models", variables, "bytes",
                  [*command, "lib/*.c", "lib/models/*.c", "lib/words/*.c", "&&", size, "*.o"], tool_version)
        _ram(bench, board, command, Path(scratch), tool_version)


def _face(bench: Bench, board: Board, command: List[str], scratch: Path, tool_version: str) -> None:
    """What a program links of face.c for servos that follow a stream, and with what that needs of rig.c and fixed.c."""
    link = [compiler(board), *board.options, "-nostdlib", "-r", "-Wl,--gc-sections",
            *(f"-Wl,-u,{name}" for name in FACE)]
    objects: List[Path] = []
    for stem, figure in (("face", "a face, of face.c"), ("rig", ""), ("fixed", "a face, with rig.c and fixed.c")):
        objects.append(scratch / f"face_part_{stem}.o")
        run([*command, "-ffunction-sections", bench.source / "lib" / f"{stem}.c", "-o", objects[-1]])
        if figure:
            bench.add(board.preset, f"code -Os: {figure}", sized(f"{board.prefix}size", [*link, *objects])["text"],
                      "bytes", [*command, "-ffunction-sections", "lib/*.c", "&&", *link, "*.o"], tool_version)


def _helpers(board: Board, objects: List[Path]) -> int:
    """Bytes that `objects` link from the compiler's library, such as division; raises RuntimeError if they need more
    than that and the functions that every C compiler relies on."""
    command, linked = [compiler(board), *board.options], objects[0].with_name("linked.o")
    archive = run([*command, "-print-libgcc-file-name"]).stdout.decode().strip()
    link_map = run([*command, "-nostdlib", "-r", "-Wl,-M", *objects, archive, "-o", linked])
    undefined = run([f"{board.prefix}nm", "-u", linked]).stdout.decode()
    unknown = set(re.findall(r"U (\w+)", undefined)) - {"memcpy", "memmove", "memset"}
    if unknown:
        raise RuntimeError(f"{board.core}: {', '.join(CORE)} call {', '.join(sorted(unknown))} of other files of lib/")
    members = set(re.findall(r"libgcc\.a\(([^)]+)\)", link_map.stdout.decode()))
    lines = run([f"{board.prefix}size", archive]).stdout.decode().splitlines()[1:]
    return sum(int(line.split()[0]) for line in lines if line.split()[5] in members)


def _ram(bench: Bench, board: Board, command: List[str], scratch: Path, tool_version: str) -> None:
    source, out = scratch / "ram.c", scratch / "ram.o"
    headers = [name[len("labial_") : -len("_t")] for name in STATES if name != BESIDE]
    lines = [f'#include "{stem}.h"' for stem in (*MODELS.values(), *(f"labial/{name}" for name in headers))]
    lines += [f"char {model}[{stem.upper()}_WORKSPACE_SIZE];" for model, stem in MODELS.items()]
    same = f"{MODELS['speech'].upper()}_WORKSPACE_SIZE == LABIAL_WORKSPACE_SIZE({STRIDE}, {COUNT})"
    lines.append(f"typedef char sizes_are_those_of_the_voice[{same} ? 1 : -1];")
    lines += [f"#define STRIDE {STRIDE}", f"#define COUNT {COUNT}"]
    parts = {"labial_t": "sizeof(labial_t)", **PARTS, **STATES}
    lines += [f"char part_{i}[{size}];" for i, size in enumerate(parts.values())]
    source.write_text("\n".join(lines) + "\n", encoding="ascii")
    run([*command, f"-I{bench.source / 'lib' / 'models'}", source, "-o", out])
    listing = run([f"{board.prefix}nm", "-S", out]).stdout.decode().splitlines()
    found = {line.split()[-1]: int(line.split()[1], 16) for line in listing}
    sizes = {part: found[f"part_{i}"] for i, part in enumerate(parts)}
    for model in MODELS:
        sizes[f"{model}: workspace"] = found[model]
        sizes[f"{model}: workspace and labial_t"] = found[model] + sizes["labial_t"]
    for figure, value in sizes.items():
        bench.add(board.preset, figure, value, "bytes",
                  [f"{board.prefix}nm", "-S", "of", "an", "array", "of", "that", "size"], tool_version)


def esp32_hear(bench: Bench) -> None:
    """examples/esp32-hear/lips.c for a Cortex-M4, whose RAM has the stream and its workspace in it."""
    (board,) = (one for one in BOARDS if one.preset == "m4")
    size, path = f"{board.prefix}size", bench.source / "examples" / "esp32-hear" / "lips.c"
    command = [*compile_command(bench, board, "-Os"), "-Ilib/models", path]
    found = sized(size, command, bench.source)
    for figure, value in (("flash", found["text"]), ("RAM", found["data"] + found["bss"])):
        bench.add(board.preset, f"esp32-hear, lips.c: {figure}", value, "bytes", [*command, "&&", size, "lips.o"],
                  version(f"{board.prefix}gcc"))


def uno(bench: Bench) -> None:
    """examples/uno without its motion, and the player of baked motion: a program with it less one without."""
    compiler, size = (tool(name, "gcc-avr", "The program for an Arduino Uno") for name in ("avr-gcc", "avr-size"))
    talk = bench.source / "examples" / "talk"
    command = [compiler, "-mmcu=atmega328p", "-Os", "-std=gnu99", "-ffunction-sections", "-Wl,--gc-sections",
               f"-I{talk}", f"-I{bench.source / 'export' / 'labial' / 'bake'}"]
    jaw, player = bench.source / "examples" / "uno" / "main.c", bench.source / "tests" / "device" / "uno_player.c"
    motion = re.search(r"const uint8_t (\w+)\[(\d+)\]", (talk / "talk.h").read_text(encoding="utf-8"))
    if not motion:
        raise RuntimeError(f"{talk / 'talk.h'}: no array")

    def bytes_of(*sources: Union[str, Path]) -> int:
        found = sized(size, [*command, *sources])
        return found["text"] + found["data"]

    for figure, value, path in (("program without its motion", bytes_of(jaw) - int(motion[2]), jaw),
                                ("player", bytes_of("-DPLAYER", player) - bytes_of(player), player)):
        bench.add("uno", figure, value, "bytes", [*command, path, "&&", size, "a.out"], version(compiler))


def uno_beside(bench: Bench) -> None:
    """lib/beside.c for an Arduino Uno, which has no room for the other modules, and its RAM."""
    what = "Lips beside the audio on an Arduino Uno"
    compiler, size = (tool(name, "gcc-avr", what) for name in ("avr-gcc", "avr-size"))
    command = [compiler, "-mmcu=atmega328p", "-Os", "-std=c99", f"-I{bench.source / 'include'}", "-c"]
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        ram = Path(scratch) / "ram.c"
        ram.write_text(f'#include "labial/beside.h"\nchar ram[{STATES[BESIDE]}] = {{ 1 }};\n', encoding="ascii")
        for figure, path, kind in (("code -Os: beside.c", bench.source / "lib" / "beside.c", "text"),
                                   (BESIDE, ram, "data")):
            shown = [*command, ram.name if path == ram else path, "&&", size, f"{path.stem}.o"]
            bench.add("uno", figure, sized(size, [*command, path])[kind], "bytes", shown, version(compiler))
