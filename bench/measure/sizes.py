"""Bytes of code, of tables and of RAM, by compiling for each board."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Dict, List

from measure.boards import Board, compiler, cpu_flags
from measure.core import Bench, run, version

#: Files of lib/ that a program with compiled-in models does not link unless it uses them; the total leaves them out.
OPTIONAL = ("blob", "faps", "names", "result", "rig")

LEVELS = ("-Os", "-O2")

#: The bundled models: their C file, and what they are called here.
MODELS = {"speech": "speech_en", "laughter": "laughter_synthetic"}


def compile_command(bench: Bench, board: Board, level: str) -> List[str]:
    """How a file of the library is compiled for a board, up to its name."""
    return [compiler(board), *cpu_flags(bench, board), level, "-std=c99", "-ffreestanding", "-isystem",
            str(bench.source / "boards" / "include"), f"-I{bench.source / 'include'}", "-c"]


def sections(size: str, path: Path) -> Dict[str, int]:
    """text (with read-only data), data and bss of an object, bytes."""
    names, numbers = run([size, path]).stdout.decode().splitlines()[:2]
    return dict(zip(names.split()[:3], map(int, numbers.split()[:3])))


def measure(bench: Bench, board: Board) -> None:
    """Code of every file at each level, their total, tables, RAM."""
    size = f"{board.prefix}size"
    tool_version = version(compiler(board))
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        out = Path(scratch) / "out.o"
        variables = 0
        for level in LEVELS:
            total = 0
            command = compile_command(bench, board, level)
            for path in sorted((bench.source / "lib").glob("*.c")):
                run([*command, path, "-o", out])
                found = sections(size, out)
                variables += found["data"] + found["bss"]
                if path.stem not in OPTIONAL:
                    total += found["text"]
                bench.add(board.preset, f"code {level}: {path.name}", found["text"], "bytes",
                          [*command, path, "&&", size, f"{path.stem}.o"], tool_version)
            bench.add(board.preset, f"code {level}: total", total, "bytes",
                      [*command, "lib/*.c", "&&", size, "*.o"], tool_version)
        command = compile_command(bench, board, "-Os")
        for model, stem in MODELS.items():
            for figure, name in ((f"{model}: model", f"{stem}.c"), (f"{model}: names", f"{stem}_names.c")):
                path = bench.source / "lib" / "models" / name
                run([*command, path, "-o", out])
                found = sections(size, out)
                variables += found["data"] + found["bss"]
                bench.add(board.preset, figure, found["text"], "bytes",
                          [*command, path, "&&", size, f"{path.stem}.o"], tool_version)
        bench.add(board.preset, ".data and .bss of library and models", variables, "bytes",
                  [*command, "lib/*.c", "lib/models/*.c", "&&", size, "*.o"], tool_version)
        _ram(bench, board, command, Path(scratch), tool_version)


def _ram(bench: Bench, board: Board, command: List[str], scratch: Path, tool_version: str) -> None:
    source, out = scratch / "ram.c", scratch / "ram.o"
    lines = [f'#include "{stem}.h"' for stem in MODELS.values()]
    lines.append("char stream[sizeof(labial_t)];")
    lines += [f"char {model}[{stem.upper()}_WORKSPACE_SIZE];" for model, stem in MODELS.items()]
    source.write_text("\n".join(lines) + "\n", encoding="ascii")
    command = [*command, f"-I{bench.source / 'lib' / 'models'}", str(source)]
    run([*command, "-o", out])
    listing = run([f"{board.prefix}nm", "-S", out]).stdout.decode().splitlines()
    found = {line.split()[-1]: int(line.split()[1], 16) for line in listing}
    shown = [f"{board.prefix}nm", "-S", "of", "an", "array", "of", "that", "size"]
    bench.add(board.preset, "labial_t", found["stream"], "bytes", shown, tool_version)
    for model in MODELS:
        bench.add(board.preset, f"{model}: workspace", found[model], "bytes", shown, tool_version)
        bench.add(board.preset, f"{model}: workspace and labial_t", found[model] + found["stream"], "bytes", shown,
                  tool_version)
