"""Compares measurements with the committed baseline."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

from measure.core import Figure

#: A figure may be worse by this share. Smaller is better in every figure that is not a timing.
TOLERANCE = 0.02


def write(path: Path, figures: Sequence[Figure]) -> None:
    lines = ",\n".join("  " + json.dumps(dataclasses.asdict(figure)) for figure in figures)
    path.write_text(f"[\n{lines}\n]\n", encoding="utf-8")


def read(path: Path) -> List[Figure]:
    """The figures of a file; ValueError names the file when it is none."""
    try:
        return [Figure(**one) for one in json.loads(path.read_text(encoding="utf-8"))]
    except (TypeError, json.JSONDecodeError) as error:
        raise ValueError(f"{path}: not a list of figures: {error}") from None


def checked(figures: Sequence[Figure]) -> List[Figure]:
    return [figure for figure in figures if figure.checked]


#: Up to so many missing figures of a target are named; of more, only their number.
_NAMED = 4


def compare(old: Sequence[Figure], new: Sequence[Figure]) -> Tuple[List[str], List[str]]:
    """A message for every figure that got worse by more than TOLERANCE, and for every reason why figures of the
    baseline were not compared."""
    measured: Dict[Tuple[str, str], Figure] = {(figure.target, figure.figure): figure for figure in new}
    worse: List[str] = []
    passed_over: List[str] = []
    missing: Dict[str, List[str]] = {}
    for before in checked(old):
        now = measured.get((before.target, before.figure))
        if not now:
            missing.setdefault(before.target, []).append(before.figure)
        elif now.tool != before.tool:
            passed_over.append(f"Not compared: what {before.tool} was measured with, since this is {now.tool}.")
        elif now.value > before.value + abs(before.value) * TOLERANCE:
            share = f" ({100.0 * (now.value / before.value - 1.0):+.1f} %)" if before.value else ""
            worse.append(f"{before.target}, {before.figure}: {before.value:g} became {now.value:g} {now.unit}{share}.")
    for target, figures in missing.items():
        what = ", ".join(figures) if len(figures) <= _NAMED else f"{len(figures)} figures"
        passed_over.append(f"Not measured, and so not compared: {target}, {what}.")
    return worse, list(dict.fromkeys(passed_over))
