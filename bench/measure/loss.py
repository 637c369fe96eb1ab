"""Runs accuracy.py in a Python that has numpy."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Dict, List, Optional, Union

from measure.core import Bench, LeftOut, run
from measure.sizes import MODELS

#: Figures, their names in accuracy.py, and their units.
FIGURES = (
    ("MLPG error, largest", "solver_largest", "1/1024 of full scale"),
    ("MLPG error, RMS", "solver_rms", "1/1024 of full scale"),
    ("window, largest", "window_largest", "FAP units"),
    ("window, RMS", "window_rms", "FAP units"),
    ("likelihood lost by paths, per state", "path_state", "nats/state and channel"),
    ("likelihood lost by paths, per state, worst channel", "path_worst_channel", "nats/state"),
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


def delay(bench: Bench, corpus: Optional[str]) -> None:
    """The latest frames of the demo's sentence and of a corpus's utterances."""
    program = bench.build / "bench" / "labial-bench-delay"
    bench.add("delay", "demo sentence: latest frame", int(run([program]).stdout), "ms", [program], "the frame rate")
    if not corpus:
        return
    command = [python_with_numpy(bench), bench.source / "bench" / "accuracy.py", "utterances",
               model_path(bench, "speech_en"), corpus]
    utterances = run(command, env=environment(bench)).stdout
    found = sorted(map(int, run([program, "-"], input=utterances).stdout.split()))
    shown = ["PYTHONPATH=export", "python3", *map(str, command[1:-1]), "CORPUS", "|", program, "-"]
    for figure, value in (("median", statistics.median(found)), ("largest", found[-1])):
        bench.add("delay", f"corpus of {len(found)} utterances: latest frame, {figure}", value, "ms", shown,
                  "the frame rate")


def environment(bench: Bench) -> Dict[str, str]:
    return dict(os.environ, PYTHONPATH=str(bench.source / "export"), OPENBLAS_NUM_THREADS="1")


def model_path(bench: Bench, name: str) -> Path:
    return bench.source / "export" / "models" / f"{name}.npz"


def measure(bench: Bench, corpus: Optional[str]) -> None:
    """The solver's error and the paths' loss of both models; `corpus` is one of speech."""
    python = python_with_numpy(bench)
    for model, name in MODELS.items():
        command: List[Union[str, os.PathLike]] = [python, bench.source / "bench" / "accuracy.py",
                                                  model_path(bench, name), name,
                                                  bench.build / "bench" / "labial-bench-solve", model]
        shown = ["PYTHONPATH=export", "python3", *map(str, command[1:])]
        for where, given in (("drawn streams", []), ("corpus", [corpus])):
            if where == "corpus" and (not corpus or model != "speech"):
                continue
            found = json.loads(run([*command, *given], env=environment(bench)).stdout)
            for figure, key, unit in FIGURES:
                bench.add("accuracy", f"{model}, {where}: {figure}", round(found[key], 4), unit,
                          [*shown, *("CORPUS" for _ in given)], "numpy")
