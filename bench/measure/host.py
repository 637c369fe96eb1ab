"""The host: frames per second, instructions under callgrind, and the checksums that the boards must reproduce; the
Python run-time and the npm packages: microseconds per frame and bytes."""

from __future__ import annotations

import gzip
import json
import os
import re
import sys
from pathlib import Path
from typing import Dict, List, Sequence, Union

from measure.boards import RATE, SECONDS
from measure.core import Bench, LeftOut, run, tool, version

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
    """The command of :func:`collected`, for display."""
    return ["valgrind", "--tool=callgrind", *([f"--toggle-collect={function}"] if function else []), *command]


def heap_peak(command: Sequence[Union[str, Path]], scratch: Path) -> int:
    """The peak heap of a program in bytes, by massif, without the allocator's overhead."""
    valgrind = tool("valgrind", "valgrind", "What massif counts")
    out = scratch / "massif.out"
    run([valgrind, "--tool=massif", "--peak-inaccuracy=0.0", f"--massif-out-file={out}", *command])
    found = re.findall(r"^mem_heap_B=(\d+)$", out.read_text(encoding="ascii"), re.MULTILINE)
    return max(int(number) for number in found)


def parse(line: str) -> Dict[str, float]:
    found = re.match(r"(\d+) frames in [\d.]+ s: (\d+) frames/s, .*checksum ([0-9a-f]{8})\)", line)
    if not found:
        raise RuntimeError(f"labial-bench printed: {line}")
    return {"frames": int(found.group(1)), "rate": int(found.group(2)), "checksum": int(found.group(3), 16)}


def checksums(bench: Bench) -> Dict[str, int]:
    program = bench.build / "bench" / "labial-bench"
    return {model: int(parse(run([program, model, str(SECONDS)]).stdout.decode())["checksum"]) for model in MODELS}


def measure(bench: Bench, compiler: str) -> None:
    """Instructions per frame and frames per second of both models; timings are the best of three runs."""
    program = bench.build / "bench" / "labial-bench"
    for model in MODELS:
        command = [program, model, str(TIMED_SECONDS)]
        rate = max(parse(run(command).stdout.decode())["rate"] for _ in range(3))
        for figure, value, unit in (("speed", rate, "frames/s"),
                                    (f"speed at {RATE} frames/s", round(rate / RATE), "times real time")):
            bench.add("host", f"{model}: {figure}", value, unit, command, version(compiler))
    for model in MODELS:
        command = [program, model, str(SECONDS)]
        frames = parse(run(command).stdout.decode())["frames"]
        bench.add("host", f"{model}: mean", round(collected(command, "labial_tick") / frames), "instructions/frame",
                  shown_callgrind(command, "labial_tick"), version(compiler))


def python(bench: Bench, compiler: str) -> None:
    """The figures of bench/runtime.py, and the size of the shared library."""
    library = bench.build / "flat" / "labial_runtime.so"
    if not library.is_file():
        raise LeftOut(f"The Python run-time is left out: {bench.shown([library])} is not built.")
    environment = {"PYTHONPATH": "export", "LABIAL_RUNTIME": str(library)}
    command = [sys.executable, bench.source / "bench" / "runtime.py"]
    done = run(command, cwd=bench.source, env={**os.environ, **environment})
    shown = ["env", *(f"{name}={bench.shown([value])}" for name, value in environment.items()), "python3", command[1]]
    interpreter = ".".join(map(str, sys.version_info[:3]))
    for way, value in json.loads(done.stdout).items():
        bench.add("python", f"speech: {way}", value, "us/frame", shown, f"Python {interpreter}, {version(compiler)}")
    bench.add("python", "shared library with both models", library.stat().st_size, "bytes", ["ls", "-l", library],
              version(compiler))


def npm(bench: Bench) -> None:
    """Builds the package and measures it under node. Compressed bytes are those of gzip at its highest level."""
    what = "The npm package"
    for name, package in (("clang", "clang"), ("wasm-ld", "lld"), ("node", "nodejs"), ("npm", "npm")):
        tool(name, package, what)
    folder = bench.build / "wasm"
    toolchain = bench.source / "boards" / "toolchains" / "wasm.cmake"
    run(["cmake", "-S", bench.source, "-B", folder, f"-DCMAKE_TOOLCHAIN_FILE={toolchain}", "-DCMAKE_BUILD_TYPE=Release",
         "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF", "-DLABIAL_WERROR=ON"])
    run(["cmake", "--build", folder, "--target", "npm-pack", "--parallel", "2"])
    compiler = version("clang")
    module = folder / "web" / "labial.wasm"
    bench.add("wasm", "module with speech", module.stat().st_size, "bytes", ["ls", "-l", module], compiler)
    names = ("entries.js", "index.js", "memory.js", "services.js", "speech.js", "stream.js", "table.js", "track.js",
             "unpack.js")
    laughter = folder / "npm-laughter" / "index.js"
    fetched = [("a page that speaks, each script compressed", [folder / "npm" / name for name in names],
                [folder / "npm" / "*.js"], ["#", *names]),
               ("laughter, compressed", [laughter], [laughter], [])]
    for model in ("small", "large"):
        hearing = [folder / "npm-hearing" / f"{name}.js" for name in ("index", "tap", model)]
        fetched.append((f"hearing by the {model} model, each script compressed", hearing, hearing, []))
    fetched.append(("words, each script compressed", sorted((folder / "npm-words").glob("*.js")),
                    [folder / "npm-words" / "*.js"], []))
    for figure, scripts, shown, behind in fetched:
        size = sum(len(gzip.compress(path.read_bytes(), 9, mtime=0)) for path in scripts)
        bench.add("wasm", figure, size, "bytes", ["gzip", "-9c", *shown, "|", "wc", "-c", *behind], compiler)
    for packed in sorted(folder.glob("labial-*.tgz")):
        kinds = (f"packed {kind} package" for kind in ("laughter", "hearing-host", "hearing", "words")
                 if kind in packed.name)
        name = next(kinds, "packed package")
        bench.add("wasm", name, packed.stat().st_size, "bytes", ["ls", "-l", packed], compiler)
    command = ["node", bench.source / "bench" / "npm.mjs", folder / "npm"]
    engine = "node " + run(["node", "--version"]).stdout.decode().strip().lstrip("v")
    for way, value in json.loads(run(command).stdout).items():
        bench.add("wasm", f"speech: {way}", value, "us/frame", command, f"{engine}, {compiler}")
