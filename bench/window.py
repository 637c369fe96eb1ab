#!/usr/bin/env python3
"""Compares the motion of a build with LABIAL_WINDOW 1, a delay of 80 ms, with that of the default (docs/porting.md).

    window.py SENTENCES.flite

A file of sentences has a line of phonemes and their ends for each, as flite's -psdur prints. It needs numpy, cmake, a C
compiler, and the exporter with the run-time on the path.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Sequence

import numpy as np

SOURCE = Path(__file__).resolve().parents[1]


def motion(sentences: Path, runtime: str, output: Path) -> np.ndarray:
    """(T, 13) FAPs of all sentences by a build of the library."""
    subprocess.run([sys.executable, __file__, str(sentences), str(output)], check=True,
                   env={**os.environ, "LABIAL_RUNTIME": runtime})
    return np.load(output)


def render(sentences: Path, output: Path) -> None:
    import labial

    lines = sentences.read_text(encoding="utf-8").splitlines()
    spoken = [timing for line in lines for timing in labial.read_timings(io.StringIO(line), source="flite")]
    np.save(output, np.array(labial.render(spoken), "int16"))


def main(arguments: Sequence[str]) -> int:
    """Prints the correlation of each FAP, and the largest difference."""
    if len(arguments) == 2:
        render(Path(arguments[0]), Path(arguments[1]))
        return 0
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="labial-window-") as folder:
        build = Path(folder) / "build"
        for command in (["-S", str(SOURCE / "flat"), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release",
                         "-DCMAKE_C_FLAGS=-DLABIAL_WINDOW=1"], ["--build", str(build)]):
            subprocess.run(["cmake", *command], check=True, stdout=subprocess.DEVNULL)
        live = motion(Path(arguments[0]), str(build / "labial_runtime.so"), Path(folder) / "live.npy")
        default = motion(Path(arguments[0]), os.environ["LABIAL_RUNTIME"], Path(folder) / "default.npy")
    correlation = [np.corrcoef(live[:, k], default[:, k])[0, 1] for k in range(live.shape[1])]
    difference = np.sqrt(((live - default.astype(float)) ** 2).mean(axis=0)) / default.std(axis=0)
    print(f"correlation {min(correlation):.4f} .. {max(correlation):.4f}, mean {np.mean(correlation):.4f};"
          f" difference up to {difference.max():.3f} of a FAP's standard deviation")
    print(f"{len(default) / 50:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
