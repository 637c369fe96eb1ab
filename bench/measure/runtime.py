"""The Python run-time: microseconds per frame and bytes of the library that the package brings."""

from __future__ import annotations

import json
import os
import sys

from measure.core import Bench, LeftOut, run, version


def measure(bench: Bench, compiler: str) -> None:
    """What bench/runtime.py measures, and the size of the shared library."""
    library = bench.build / "packaging" / "python" / "labial_runtime.so"
    if not library.is_file():
        raise LeftOut(f"The Python run-time is left out: {bench.shown([library])} is not built.")
    environment = {"PYTHONPATH": "export", "LABIAL_RUNTIME": str(library)}
    command = [sys.executable, bench.source / "bench" / "runtime.py"]
    done = run(command, cwd=bench.source, env={**os.environ, **environment})
    shown = ["env", *(f"{name}={bench.shown([value])}" for name, value in environment.items()), "python3", command[1]]
    python = ".".join(map(str, sys.version_info[:3]))
    for way, value in json.loads(done.stdout).items():
        bench.add("python", f"speech: {way}", value, "us/frame", shown, f"Python {python}, {version(compiler)}")
    bench.add("python", "shared library with both models", library.stat().st_size, "bytes", ["ls", "-l", library],
              version(compiler))
