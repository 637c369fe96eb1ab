"""What words cost on the boards: instructions to read one, and to make phonemes in time of it."""

from __future__ import annotations

from typing import Dict

from measure.boards import Board, build, printed
from measure.core import Bench, version

#: Words that the images read (bench/CMakeLists.txt).
WORDS = 2000


def measure(bench: Bench, board: Board, checksums: Dict[str, int]) -> None:
    """Adds the figures of `board`. `checksums` are those of the boards before; raises RuntimeError if its phonemes
    differ from theirs."""
    tool_version = version(f"{board.prefix}gcc")
    command = build(bench, board)["bench_words"]
    found = printed(command)
    if found["words"] != WORDS:
        raise RuntimeError(f"{bench.shown(command)}: {found['words']} words, not {WORDS}")
    if checksums.setdefault("words", found["checksum"]) != found["checksum"]:
        raise RuntimeError(f"{bench.shown(command)}: its phonemes are not those of the other boards")
    for figure, value in (("words: mean to read one", round(found["read_instructions"] / WORDS)),
                          ("words: worst to read one", found["read_worst"]),
                          ("words: mean to say one", round(found["say_instructions"] / WORDS)),
                          ("words: worst to say one", found["say_worst"])):  # fmt: skip
        bench.add(board.preset, figure, value, "instructions", command, tool_version)
    bench.add(board.preset, "words: stack, painted", found["stack"], "bytes", command, tool_version)
