#!/usr/bin/env python3
"""Reproduces the bundled models, and the first split of RESULTS.md.

    python export/reproduce.py [models | split]

Without an argument it does both. It compares exported models with lib/models byte for byte, trained ones with
export/models to TOLERANCE, and the evaluation with the table of docs/reproduction.md. The exit status is 1 if anything
differs. It needs the packages of export/requirements-reproduce.txt, cmake and a C compiler.
"""

from __future__ import annotations

import argparse
import filecmp
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "export"))

from labial.__main__ import main as labial  # noqa: E402
from labial.defaults import EPISODES  # noqa: E402

CORPORA = ROOT / "export" / "corpora"
#: What each bundled model is trained on, and how; LAUGHTER is the synthetic corpus, which is made for it.
MODELS: Dict[str, List[str]] = {
    "speech_en": [*(str(CORPORA / name) for name in ("grid_s1", "addresses", "grid_singles", "grid_more")),
                  "--talker-variance", "1"],
    "laughter_synthetic": ["LAUGHTER", "--kind", "laughter"],
}
#: Share by which a trained number, in double precision, may differ: linear algebra rounds otherwise on processors with
#: other vector instructions. Exported tables, in fixed point, may not differ.
TOLERANCE = 1e-9
PAGE = ROOT / "docs" / "reproduction.md"
#: Columns of the page's table of the first split: title, measure, digits.
COLUMNS = (("diff", "diff/mean", 4), ("correlation", "correlation/mean", 3), ("amplitude", "amplitude/mean", 3),
           ("closure", "closure/rate", 3), ("jitter", "jitter", 3), ("seam", "seam/mean", 3))
HEADING = "| method | " + " | ".join(name for name, _, _ in COLUMNS) + " |"


def run(*arguments: str) -> None:
    """Runs a command of labial; ends the program if it fails."""
    print("labial", *arguments, flush=True)
    if labial(list(arguments)):
        sys.exit(1)


def agrees(made: Any, committed: Any) -> bool:
    """Whether two values, or all in two containers or arrays, are the same, numbers to TOLERANCE."""
    import numpy as np

    if isinstance(made, dict):
        return made.keys() == committed.keys() and all(agrees(made[key], committed[key]) for key in made)
    if isinstance(made, (list, tuple)):
        return len(made) == len(committed) and all(map(agrees, made, committed))
    if isinstance(made, (float, np.ndarray)):
        return np.shape(made) == np.shape(committed) and np.allclose(made, committed, rtol=TOLERANCE, atol=TOLERANCE)
    return bool(made == committed)


def compared(made: Path, committed: Path) -> str:
    """How a file compares with the committed one; DIFFERENT where that is a failure."""
    if filecmp.cmp(made, committed, shallow=False):
        return "the same bytes"
    if made.suffix == ".npz":
        from labial.tables.model import load

        if agrees(vars(load(made)), vars(load(committed))):
            return f"the same to {TOLERANCE:g}"
    return "DIFFERENT"


def models(folder: Path) -> bool:
    """Trains and exports the bundled models in a folder; returns whether all files agree with the committed ones."""
    from labial.tables.model import load

    run("laughter-corpus", str(folder / "LAUGHTER"), "--episodes", str(EPISODES), "--seed", "0")
    same = True
    for name, how in MODELS.items():
        committed = ROOT / "export" / "models" / f"{name}.npz"
        made = folder / f"{name}.npz"
        run("train", *(str(folder / item) if item == "LAUGHTER" else item for item in how), "-o", str(made),
            "--attribution", load(committed).attribution)
        run("export", str(made), "--name", name, "-o", str(folder / "tables"))
        tables = [folder / "tables" / f"{name}{end}" for end in (".c", ".h", "_names.c")]
        for own, other in ((made, committed), *((path, ROOT / "lib" / "models" / path.name) for path in tables)):
            found = compared(own, other)
            same &= found != "DIFFERENT"
            print(f"{os.path.relpath(other, ROOT)}: {found}")
    return same


def first_split() -> str:
    """The Markdown table of the first of RESULTS.md's random splits."""
    from labial.corpus import read_corpora
    from labial.evaluate.material import Options
    from labial.evaluate.protocol import evaluate
    from labial.evaluate.report import title

    (corpus,) = read_corpora([CORPORA / "grid_s1"])
    (outcome,) = evaluate(corpus, Options(splits=1))
    rows = [HEADING, "|---" * (len(COLUMNS) + 1) + "|"]
    for method, values in outcome.measures.items():
        shown = ((values.get(measure, math.nan), digits) for _, measure, digits in COLUMNS)
        cells = ("-" if math.isnan(value) else f"{value:.{digits}f}" for value, digits in shown)
        rows.append(f"| {title(method)} | " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def build_runtime(folder: Path) -> None:
    """Builds these sources' library for `labial` to load, whatever other build there is."""
    subprocess.run(["cmake", "-S", ROOT / "flat", "-B", folder, "-DCMAKE_BUILD_TYPE=Release"], check=True)
    subprocess.run(["cmake", "--build", folder], check=True)
    os.environ["LABIAL_RUNTIME"] = str(folder / "labial_runtime.so")


def committed_split() -> str:
    """The table in docs/reproduction.md."""
    found = re.search(rf"^{re.escape(HEADING)}\n(?:\|.*\n)+", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    return found[0] if found else ""


def split() -> bool:
    """Evaluates the first split; returns whether its table equals the committed one."""
    table = first_split()
    print(table, end="")
    same = table == committed_split()
    print(f"{os.path.relpath(PAGE, ROOT)}: {'the same figures' if same else 'DIFFERENT'}")
    return same


def main() -> int:
    """The command line; see the module."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("what", nargs="?", choices=("models", "split"), help="one of both alone")
    what = parser.parse_args().what
    same = True
    with tempfile.TemporaryDirectory() as folder:
        build_runtime(Path(folder) / "flat")
        if what != "split":
            same &= models(Path(folder))
        if what != "models":
            same &= split()
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
