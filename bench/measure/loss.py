"""Runs accuracy.py, which needs numpy, in a Python that has it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import List, Optional, Union

from measure.core import Bench, LeftOut, run
from measure.sizes import MODELS

#: Figures, what accuracy.py calls them, and their units.
FIGURES = (
    ("MLPG error, largest", "solver_largest", "1/1024 of full scale"),
    ("MLPG error, RMS", "solver_rms", "1/1024 of full scale"),
    ("likelihood lost by paths, per piece", "path_piece", "nats/piece and channel"),
    ("likelihood lost by paths, per piece, worst channel", "path_worst_channel", "nats/piece"),
    ("likelihood lost by paths, per unit", "path_unit", "nats/unit and channel"),
    ("likelihood lost by paths, per 100 frames", "path_frames", "nats/100 frames and channel"),
)


def python_with_numpy(bench: Bench) -> str:
    """A Python that can import numpy: this one, or that of the tests' build."""
    for candidate in (sys.executable, str(bench.build.parent / "test" / "python" / "bin" / "python")):
        try:
            if subprocess.run([candidate, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode == 0:
                return candidate
        except OSError:
            continue
    raise LeftOut("What integers cost against float64 is left out, it needs numpy: install the Debian package "
                  "python3-numpy, or run the preset test first, whose Python has it.")


def measure(bench: Bench, corpus: Optional[str]) -> None:
    """The solver's error and the paths' loss of both models; `corpus` is one of speech."""
    python = python_with_numpy(bench)
    environment = dict(os.environ, PYTHONPATH=str(bench.source / "export"), OPENBLAS_NUM_THREADS="1")
    for model, name in MODELS.items():
        trained = bench.source / "export" / "models" / f"{name}.npz"
        command: List[Union[str, os.PathLike]] = [
            python, bench.source / "bench" / "accuracy.py", trained, name,
            bench.build / "bench" / "labial-bench-solve", model,
        ]
        shown = ["PYTHONPATH=export", "python3", *map(str, command[1:])]
        for where, given in (("drawn streams", []), ("corpus", [corpus])):
            if where == "corpus" and (not corpus or model != "speech"):
                continue
            found = json.loads(run([*command, *given], env=environment).stdout)
            for figure, key, unit in FIGURES:
                bench.add("accuracy", f"{model}, {where}: {figure}", round(found[key], 4), unit,
                          [*shown, *("CORPUS" for _ in given)], "numpy")
