"""What hearing and words cost on the boards: instructions for each rate of sound, flash and RAM of each model of
hearing; instructions for a word."""

from __future__ import annotations

from typing import Dict, List

from measure.boards import RATE, SECONDS, Board, build, printed
from measure.core import Bench, version
from measure.sizes import compile_command, sized

#: The files of lib/ that hear; a program links the others only if it calls them.
PARTS = ("hear", "hear_convert", "hear_features", "hear_motion", "hear_network", "fixed")
#: Rates of sound that the images hear, samples per second.
RATES = (16000, 24000, 44100, 48000)
#: Words that the images read (bench/CMakeLists.txt).
WORDS = 2000


def models(bench: Bench) -> List[str]:
    """The bundled models of hearing that builds for boards have; the others need a larger LABIAL_HEAR_UNITS_MAX."""
    return sorted(path.stem for path in (bench.source / "lib" / "models").glob("hear_*.c")
                  if "#if LABIAL_HEAR_UNITS_MAX" not in path.read_text("utf-8"))


def measure(bench: Bench, board: Board, checksums: Dict[str, int]) -> None:
    """Adds the figures of `board`. `checksums` are those of the boards before, by image; raises RuntimeError if its
    frames differ from theirs."""
    tool_version, size = version(f"{board.prefix}gcc"), f"{board.prefix}size"
    compile_one = compile_command(bench, board, "-Os")
    code = sum(sized(size, [*compile_one, bench.source / "lib" / f"{part}.c"])["text"] for part in PARTS)
    images = build(bench, board)
    for model in models(bench):
        for rate in RATES:
            command = images[f"bench_{model}_{rate}"]
            found = printed(command)
            if found["frames"] != SECONDS * RATE:
                raise RuntimeError(f"{bench.shown(command)}: {found['frames']} frames, not {SECONDS * RATE}")
            if checksums.setdefault(f"{model}_{rate}", found["checksum"]) != found["checksum"]:
                raise RuntimeError(f"{bench.shown(command)}: its frames are not those of the other boards")
            for figure, value in ((f"{model}, {rate} Hz: mean", round(found["push_instructions"] / found["frames"])),
                                  (f"{model}, {rate} Hz: worst frame", found["push_worst"])):
                bench.add(board.preset, figure, value, "instructions/frame", command, tool_version)
        bench.add(board.preset, f"{model}: RAM", found["ram"], "bytes", command, tool_version)
        bench.add(board.preset, f"{model}: stack, painted", found["stack"], "bytes", command, tool_version)
        tables = sized(size, [*compile_one, bench.source / "lib" / "models" / f"{model}.c"])["text"]
        shown = [*compile_one, *(f"lib/{part}.c" for part in PARTS), f"lib/models/{model}.c", "&&", size, "*.o"]
        bench.add(board.preset, f"{model}: flash", code + tables, "bytes", shown, tool_version)


def measure_words(bench: Bench, board: Board, checksums: Dict[str, int]) -> None:
    """Adds what words cost on `board`: instructions to read one, and to make phonemes in time of it. `checksums` are
    those of the boards before; raises RuntimeError if its phonemes differ from theirs."""
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
                          ("words: worst to say one", found["say_worst"])):
        bench.add(board.preset, figure, value, "instructions", command, tool_version)
    bench.add(board.preset, "words: stack, painted", found["stack"], "bytes", command, tool_version)
