"""The host: frames per second, instructions under callgrind, and the checksums that the boards must arrive at."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Dict, List, Sequence, Union

from measure.boards import RATE, SECONDS
from measure.core import Bench, run, tool, version

#: Seconds of motion that are timed; a run takes a fraction of a second.
TIMED_SECONDS = 600

MODELS = ("speech", "laughter")


def collected(command: Sequence[Union[str, Path]], function: str = "") -> int:
    """Instructions that callgrind counts in a program, or within `function` and what it calls."""
    valgrind = tool("valgrind", "valgrind", "What callgrind counts")
    toggle = [f"--toggle-collect={function}"] if function else []
    done = run([valgrind, "--tool=callgrind", *toggle, "--callgrind-out-file=/dev/null", *command])
    found = re.search(r"Collected : (\d+)", done.stderr.decode(errors="replace"))
    if not found:
        raise RuntimeError(f"callgrind says nothing about {command[0]}")
    return int(found.group(1))


def shown_callgrind(command: Sequence[Union[str, Path]], function: str) -> List[Union[str, Path]]:
    """The command that :func:`collected` runs, as it is shown."""
    return ["valgrind", "--tool=callgrind", *([f"--toggle-collect={function}"] if function else []), *command]


def heap_peak(command: Sequence[Union[str, Path]], scratch: Path) -> int:
    """The most bytes that a program holds on its heap at a time, by massif, allocator's overhead not counted."""
    valgrind = tool("valgrind", "valgrind", "What massif counts")
    out = scratch / "massif.out"
    run([valgrind, "--tool=massif", "--peak-inaccuracy=0.0", f"--massif-out-file={out}", *command])
    found = re.findall(r"^mem_heap_B=(\d+)$", out.read_text(encoding="ascii"), re.MULTILINE)
    return max(int(number) for number in found)


def parse(line: str) -> Dict[str, float]:
    """What labial-bench prints."""
    found = re.match(r"(\d+) frames in [\d.]+ s: (\d+) frames/s, .*checksum ([0-9a-f]{8})\)", line)
    if not found:
        raise RuntimeError(f"labial-bench printed: {line}")
    return {"frames": int(found.group(1)), "rate": int(found.group(2)), "checksum": int(found.group(3), 16)}


def checksums(bench: Bench) -> Dict[str, int]:
    """What the boards' frames must sum up to, by model."""
    program = bench.build / "bench" / "labial-bench"
    return {model: int(parse(run([program, model, str(SECONDS)]).stdout.decode())["checksum"]) for model in MODELS}


def measure(bench: Bench, compiler: str) -> None:
    """Instructions per frame and frames per second of both models; timings are the best of three runs."""
    program = bench.build / "bench" / "labial-bench"
    for model in MODELS:
        command = [program, model, str(TIMED_SECONDS)]
        rate = max(parse(run(command).stdout.decode())["rate"] for _ in range(3))
        bench.add("host", f"{model}: speed", rate, "frames/s", command, version(compiler))
        bench.add("host", f"{model}: speed at {RATE} frames/s", round(rate / RATE), "times real time", command,
                  version(compiler))
    for model in MODELS:
        command = [program, model, str(SECONDS)]
        frames = parse(run(command).stdout.decode())["frames"]
        bench.add("host", f"{model}: mean", round(collected(command, "labial_tick") / frames), "instructions/frame",
                  shown_callgrind(command, "labial_tick"), version(compiler))
