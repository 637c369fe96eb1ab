"""Tables of an evaluation: Markdown for people, CSV for programs. Nothing in them depends on time or place."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.evaluate.methods import METHODS
from labial.evaluate.protocol import HUMAN, Options, Outcome
from labial.evaluate.trajectories import JUDGED_NAMES, PARAMETERS

#: Column title and measure.
Columns = Sequence[Tuple[str, str]]

#: The paper's Table 1: diff per labial parameter.
TABLE_1: Columns = [(name, f"diff/{name}") for name in (*PARAMETERS, "mean")]

#: The other measures.
TABLE_2: Columns = [
    ("correlation", "correlation/mean"),
    ("amplitude", "amplitude/mean"),
    ("closure", "closure/rate"),
    ("of human", "closure/of human"),
    ("firm closure", "firm closure/rate"),
    ("of human", "firm closure/of human"),
    ("jitter", "jitter"),
    ("seam, mean", "seam/mean"),
    ("seam, largest", "seam/largest"),
]

#: Correlation and amplitude, channel by channel.
TABLE_3: Columns = [(f"{what} {name}", f"{what}/{name}") for what in ("correlation", "amplitude")
                    for name in JUDGED_NAMES]  # fmt: skip


_NOTE_2 = """\
Correlation and amplitude (standard deviation over the human's): mean over open_jaw, raise_b_midlip_o,
stretch_l_cornerlip_o and push_t_lip, each over all judged frames. Closure: share of p, b, m whose least openness
within the segment and 40 ms around it is below the 20th percentile of the training part's speech frames; firm closure:
below the median of the human's own least openness in the training part's p, b, m. Jitter: RMS third difference over
the human's. Seam: |second difference| where units join over that elsewhere, of the means and of the largest values;
methods without units, and the human, are measured at the same frames."""


@dataclass(frozen=True)
class Cell:
    """A measure over the splits."""

    mean: float
    deviation: float  #: of the sample; NaN for one split

    def __str__(self) -> str:
        if np.isnan(self.mean):
            return "-"
        digits = 3 if abs(self.mean) >= 0.9995 else 4
        text = f"{self.mean:.{digits}f}"
        return text if np.isnan(self.deviation) else f"{text} ({self.deviation:.{digits}f})"


def title(method: str) -> str:
    """What tables call a method."""
    return next((item.title for item in METHODS if item.name == method), method)


def methods_of(outcomes: Sequence[Outcome]) -> List[str]:
    """The methods that were run, in the tables' order."""
    return [method for method in outcomes[0].measures if method != HUMAN]


def cell(outcomes: Sequence[Outcome], method: str, measure: str) -> Cell:
    """Mean and standard deviation over the splits that have the measure; NaN where none has."""
    values = np.array([item.measures[method].get(measure, np.nan) for item in outcomes])
    values = values[~np.isnan(values)]
    if not len(values):
        return Cell(float("nan"), float("nan"))
    return Cell(float(values.mean()), float(values.std(ddof=1)) if len(values) > 1 else float("nan"))


def classes_of(outcomes: Sequence[Outcome]) -> List[str]:
    """Viseme classes that were judged in any split, in the order of the first that has them."""
    return list(dict.fromkeys(name[6:] for item in outcomes for name in item.measures[HUMAN] if name[:6] == "class/"))


def table_4(outcomes: Sequence[Outcome]) -> Columns:
    """Mean diff per phoneme class."""
    return [(name, f"class/{name}") for name in classes_of(outcomes)]


def markdown_table(outcomes: Sequence[Outcome], methods: Sequence[str], columns: Columns) -> str:
    """Methods down, measures across."""
    lines = ["| method | " + " | ".join(name for name, _ in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for method in methods:
        cells = [str(cell(outcomes, method, measure)) for _, measure in columns]
        lines.append(f"| {title(method)} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _heading(outcomes: Sequence[Outcome], options: Options) -> str:
    frames = round(float(np.mean([item.frames for item in outcomes])))
    first = outcomes[0].split
    part = f"{len(first.training)} episodes trained on, {len(first.test)} held out"
    if options.held_out:
        part += f"; judged on the words {', '.join(sorted(set(options.held_out)))}, which no training episode holds"
    splits = f"{len(outcomes)} split{'s' if len(outcomes) > 1 else ''}"
    return (f"{splits} (seed {options.seed}), {part}; {frames} frames judged per split, silence excluded, "
            f"{options.fps} frames per second. Mean (standard deviation) over the splits.")


def markdown(outcomes: Sequence[Outcome], options: Options, plots: Sequence[str] = ()) -> str:
    """The whole report."""
    methods = methods_of(outcomes)
    parts = [
        f"# Evaluation: {options.kind}",
        _heading(outcomes, options),
        "## Table 1: diff, |original - synthetic| / maximum\n\n" + markdown_table(outcomes, methods, TABLE_1),
        "## Table 2: other measures\n\n" + markdown_table(outcomes, [HUMAN, *methods], TABLE_2) + "\n\n" + _NOTE_2,
        "## Table 3: correlation and amplitude per channel\n\n" + markdown_table(outcomes, methods, TABLE_3),
        "## Table 4: mean diff per phoneme class\n\n" + markdown_table(outcomes, methods, table_4(outcomes)),
    ]
    parts += [f"![{Path(name).stem.replace('_', ' ')}]({name})" for name in plots]
    return "\n\n".join(parts) + "\n"


def _write_csv(path: Path, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    with open(path, "w", encoding="utf-8", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def _table_rows(outcomes: Sequence[Outcome], methods: Sequence[str], columns: Columns) -> List[List[object]]:
    rows: List[List[object]] = []
    for method in methods:
        for _, measure in columns:
            value = cell(outcomes, method, measure)
            rows.append([method, measure, f"{value.mean:.6g}", f"{value.deviation:.6g}"])
    return rows


def write(outcomes: Sequence[Outcome], options: Options, folder: Path, plots: Sequence[str] = ()) -> List[Path]:
    """Writes report.md, table1.csv to table4.csv (means and deviations) and splits.csv (every measure, every split)."""
    methods = methods_of(outcomes)
    written = [folder / "report.md"]
    written[0].write_text(markdown(outcomes, options, plots), encoding="utf-8")
    tables: Dict[str, Tuple[Sequence[str], Columns]] = {
        "table1": (methods, TABLE_1),
        "table2": ([HUMAN, *methods], TABLE_2),
        "table3": (methods, TABLE_3),
        "table4": (methods, table_4(outcomes)),
    }
    for name, (who, columns) in tables.items():
        written.append(folder / f"{name}.csv")
        _write_csv(written[-1], ("method", "measure", "mean", "deviation"), _table_rows(outcomes, who, columns))
    written.append(folder / "splits.csv")
    rows = [(item.split.number, method, measure, f"{value:.6g}") for item in outcomes
            for method, measures in item.measures.items() for measure, value in measures.items()]
    _write_csv(written[-1], ("split", "method", "measure", "value"), rows)
    return written
