"""The worst-case stack of a call of the library, from the compiler's frames and call graph."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Dict, List, Set, Tuple

from measure.boards import Board, compiler
from measure.core import Bench, run, version
from measure.sizes import CALLS, LEVELS, compile_command, library

#: The node of a call through a pointer: to the program's callback, whose stack does not count, or from the follower of
#: voices to its words.
_INDIRECT = "__indirect_call"
_VOICE = re.compile(r"voice(?!_words)")
_WORDS = ("voice_words.c:next_spoken", "voice_words.c:last_word_lasts")

_NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
_EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
_FRAME = re.compile(r"(\d+) bytes \(([a-z,]+)\)")


class CallGraph:
    """Frames, bytes, and calls of every function that was added."""

    def __init__(self) -> None:
        self.frames: Dict[str, int] = {}
        self.calls: Dict[str, Set[str]] = {}

    def add_ci(self, text: str) -> None:
        """Adds what -fcallgraph-info=su,da wrote; RuntimeError for a frame whose size is not fixed."""
        for title, label in _NODE.findall(text):
            frame = _FRAME.search(label)
            if frame:
                if frame.group(2) != "static":
                    raise RuntimeError(f"{title}: its stack frame is {frame.group(2)}, not static")
                self.frames[title] = int(frame.group(1))
        for caller, callee in _EDGE.findall(text):
            self.calls.setdefault(caller, set()).add(callee)

    def link_words(self) -> None:
        """Adds the calls from the follower of voices to its words."""
        words = {title for title in self.frames if title.endswith(_WORDS)}
        for caller, callees in self.calls.items():
            if _INDIRECT in callees and _VOICE.search(caller):
                callees |= words

    def missing(self) -> Set[str]:
        return (set().union(*self.calls.values()) if self.calls else set()) - set(self.frames) - {_INDIRECT}

    def deepest(self, function: str, above: Tuple[str, ...] = ()) -> Tuple[int, Tuple[str, ...]]:
        """Bytes that a call of `function` takes at most, and the chain of calls that takes them. RuntimeError for
        recursion and for a function whose frame is not known."""
        if function in above:
            raise RuntimeError(f"recursion: {' > '.join((*above, function))}")
        if function not in self.frames:
            raise RuntimeError(f"{function}: the size of its stack frame is not known")
        below = [self.deepest(callee, (*above, function))
                 for callee in sorted(self.calls.get(function, set()) - {_INDIRECT})]
        most = max(below, key=lambda depth: depth[0], default=(0, ()))
        return self.frames[function] + most[0], (function, *most[1])


def add_archive(graph: CallGraph, board: Board, flags: List[str]) -> None:
    """Adds what is still missing from the compiler's own library, which has no call graph, by its machine code: all
    that a member of the archive ever pushes or subtracts from the stack pointer, taken together."""
    archive = run([compiler(board), *flags, "-print-libgcc-file-name"]).stdout.decode().strip()
    member_of: Dict[str, str] = {}
    for line in run([f"{board.prefix}nm", "-A", "--defined-only", archive]).stdout.decode().splitlines():
        place, _, name = line.rpartition(" ")
        member_of.setdefault(name, place.split(":")[1])
    todo = graph.missing()
    text = run([f"{board.prefix}objdump", "-dr", archive]).stdout.decode(errors="replace") if todo else ""
    parts = re.split(r"^(\S+):\s+file format .*$", text, flags=re.MULTILINE)
    listings = dict(zip(parts[1::2], parts[2::2]))
    while todo:
        name = todo.pop()
        if name not in member_of:
            raise RuntimeError(f"{name}: neither the library nor the compiler's own library has it")
        member = member_of[name]
        frame, called = _machine_code(listings[member])
        graph.frames[name] = frame
        graph.calls[name] = {other for other in called if member_of.get(other) != member}
        todo |= {other for other in graph.calls[name] if other not in graph.frames}


def _machine_code(listing: str) -> Tuple[int, Set[str]]:
    frame = 0
    for registers in re.findall(r"\b(?:push|stmdb\s+sp!,)\s*\{([^}]*)\}", listing):
        for one in registers.split(","):
            low, _, high = (part.strip("r ") for part in one.partition("-"))
            frame += 4 * (int(high) - int(low) + 1 if high else 1)
    frame += sum(int(number, 0) for number in re.findall(r"\bsub(?:\.w)?\s+(?:sp, )?sp, #(\d+)", listing))
    frame += sum(int(number) for number in re.findall(r"\baddi\s+sp,sp,-(\d+)", listing))
    return frame, set(re.findall(r"R_(?:ARM_THM_CALL|ARM_THM_JUMP24|RISCV_CALL(?:_PLT)?)\s+(\w+)", listing))


def public_functions(bench: Bench, header: str = "labial.h") -> List[str]:
    """The functions of the library that a header of include/labial declares; the program defines those of the lock."""
    text = (bench.source / "include" / "labial" / header).read_text(encoding="utf-8")
    text = re.sub(r"/\*.*?\*/|^#if LABIAL_(?:LOCKS|HEAR_SUMS)\b.*?^#endif", "", text, flags=re.DOTALL | re.MULTILINE)
    return sorted(set(re.findall(r"^[a-z][\w \*]*?\b(labial_\w+)\([^;{]*\);", text, re.MULTILINE)))


def measure(bench: Bench, board: Board) -> None:
    """The deepest call of labial_tick(), of all functions of labial.h, of those of all headers but words.h and voice.h,
    which few programs use, and of these two, at each level."""
    tool_version = version(compiler(board))
    for level in LEVELS:
        graph = CallGraph()
        command = [*compile_command(bench, board, level), CALLS]
        with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
            # The board's memcpy and memset stand for those of whatever C library a program has.
            run([*command, "-fno-tree-loop-distribute-patterns", bench.source / "boards" / "memory.c", "-o",
                 Path(scratch) / "memory.o"])
            for found in (*sorted(library(bench, board, level).glob("*.ci")), Path(scratch) / "memory.ci"):
                graph.add_ci(found.read_text(encoding="utf-8"))
        graph.link_words()
        add_archive(graph, board, list(board.options))
        headers = sorted(path.name for path in (bench.source / "include" / "labial").glob("*.h")
                         if path.name not in ("words.h", "voice.h"))
        for figure, functions in (
            ("labial_tick()", ["labial_tick"]), ("every function", public_functions(bench)),
            ("all of lib", [name for header in headers for name in public_functions(bench, header)]),
            ("words.h", public_functions(bench, "words.h")), ("voice.h", public_functions(bench, "voice.h"))):
            depth = max(map(graph.deepest, functions))
            bench.add(board.preset, f"stack {level}: {figure}", depth[0], "bytes",
                      [*command, "lib/*.c", "#", " > ".join(depth[1])], tool_version)
