"""Tables of an evaluation: Markdown for people, CSV for programs. They do not depend on time or machine."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import PHONE_SETS
from labial.evaluate.material import Options, Outcome
from labial.evaluate.measures import JUDGED_NAMES, LIPS, PARAMETERS, groups
from labial.evaluate.methods import METHODS
from labial.evaluate.protocol import HUMAN

#: Column title and measure.
Columns = Sequence[Tuple[str, str]]

#: The paper's Table 1: diff per labial parameter.
TABLE_1: Columns = [(name, f"diff/{name}") for name in (*PARAMETERS, "mean")]

#: The first and last of the other measures, for all kinds.
_FIRST: Columns = (("correlation", "correlation/mean"), ("amplitude", "amplitude/mean"))
_LAST: Columns = (("jitter", "jitter"), ("seam, mean", "seam/mean"), ("seam, largest", "seam/largest"))

#: The other measures, by kind.
TABLE_2: Dict[str, Columns] = {
    "speech": [
        *_FIRST,
        ("closure", "closure/rate"),
        ("of human", "closure/of human"),
        ("firm closure", "firm closure/rate"),
        ("of human", "firm closure/of human"),
        ("readability", "readability"),
        ("with residual", "readability/with residual"),
        *_LAST,
    ],
    "laughter": [
        *_FIRST,
        ("pulses seen", "pulses/seen"),
        ("of original", "pulses/of human"),
        ("rise of pulses", "pulses/height"),
        ("closure in ne, nasal", "closure/rate"),
        ("of original", "closure/of human"),
        *_LAST,
    ],
}

#: Correlation and amplitude, channel by channel.
TABLE_3: Columns = [(f"{what} {name}", f"{what}/{name}") for what in ("correlation", "amplitude")
                    for name in JUDGED_NAMES]  # fmt: skip


_NOTE_2 = {
    "speech": """\
Correlation and amplitude (standard deviation over the human's): mean over open_jaw, raise_b_midlip_o,
stretch_l_cornerlip_o and push_t_lip, each over all judged frames. Closure: share of p, b, m whose least openness
within the segment and 40 ms around it is below the 20th percentile of the training part's speech frames; firm closure:
below the median of the human's own least openness in the training part's p, b, m. Readability: share of the words that
a lip-reader reads, the mean over classes of words that stand for each other; it is a linear discriminant analysis of
time-normalised words, trained on human motion of the training part or, of unseen words, on human motion of other
utterances than those that it reads. With residual: the same with the residual of another utterance's human word added,
for synthetic motion lacks what people vary; to be held to the human's without. Jitter: RMS third difference over
the human's. Seam: |second difference| where units join over that elsewhere, of the means and of the largest values;
methods without units, and the human, are measured at the same frames.""",
    "laughter": """\
Correlation and amplitude (standard deviation over the original's): mean over open_jaw, raise_b_midlip_o,
stretch_l_cornerlip_o and push_t_lip, each over all judged frames. Pulses: the rise of openness in a, e, o, ic and
cackle, from the least since the vowel before to the greatest in the phoneme and 40 ms around it; one is seen when it
rises further than the 20th percentile of the training part's; rise of pulses: their mean over the original's. Closure:
share of ne and nasal, where air goes through the nose, whose least openness within the segment and 40 ms around it is
below the 20th percentile of the training part's frames of laughing. Jitter: RMS third difference over the original's.
Seam: |second difference| where units join over that elsewhere, of the means and of the largest values; methods without
units, and the original, are measured at the same frames.""",
}

_NOTE_TALKERS = """\
Correlation with the talker who was left out: mean over open_jaw, lower_t_midlip_o, raise_b_midlip_o,
stretch_l_cornerlip_o and openness, each over all judged frames; the mean of the talkers and its standard error; then
each of these five, mean over the talkers. Every recording's mean and scale are brought to the first corpus's, those of
the talker who is judged too."""

_SYNTHETIC = """\
**Synthetic data.** Nobody laughed: `labial laughter-corpus` computed the motion that all methods are trained on and
compared with, the "synthetic original". The timings of its phonemes follow published statistics of laughter, its
amplitudes are design choices. So these tables say how well a method learns that program's motion from phonemes, and
nothing about how human it looks."""


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


def title(method: str, synthetic: bool = False) -> str:
    """The title of a method, or of the original, in tables."""
    if method == HUMAN and synthetic:
        return "synthetic original"
    return next((item.title for item in METHODS if item.name == method), method)


def caption(table: str, what: str, options: Options) -> str:
    """A table's heading; it says when the data are synthetic."""
    return f"{table}, synthetic data: {what}" if options.synthetic else f"{table}: {what}"


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


def grouping(kind: str) -> str:
    """The groups of Table 4: "class", viseme classes of speech, or "phoneme", those of laughter."""
    return groups(PHONE_SETS[kind])[0]


def table_4(outcomes: Sequence[Outcome], kind: str) -> Columns:
    """Mean diff per phoneme class, or per phoneme: those that were judged in any split, as the first that has them."""
    prefix = f"{grouping(kind)}/"
    found = dict.fromkeys(name for item in outcomes for name in item.measures[HUMAN] if name.startswith(prefix))
    return [(name[len(prefix):], name) for name in found]


def markdown_table(
    outcomes: Sequence[Outcome], methods: Sequence[str], columns: Columns, synthetic: bool = False
) -> str:
    """Methods down, measures across."""
    lines = ["| method | " + " | ".join(name for name, _ in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for method in methods:
        cells = [str(cell(outcomes, method, measure)) for _, measure in columns]
        lines.append(f"| {title(method, synthetic)} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def talkers_table(outcomes: Sequence[Outcome], methods: Sequence[str]) -> str:
    """Methods down; the correlation with each talker left out, their mean and its standard error, and the mean of each
    of the LIPS across."""
    talkers = [item.split.talker for item in outcomes]
    columns = [*talkers, "mean", "standard error", *LIPS]
    rows = [f"| method | {' | '.join(columns)} |", "|---" * (len(columns) + 1) + "|"]
    for method in methods:
        each = [item.measures[method]["lips/mean"] for item in outcomes]
        error = np.std(each, ddof=1) / np.sqrt(len(each)) if len(each) > 1 else np.nan
        apart = [np.mean([item.measures[method][f"lips/{name}"] for item in outcomes]) for name in LIPS]
        cells = " | ".join(f"{value:.3f}" for value in [*each, np.mean(each), error, *apart])
        rows.append(f"| {title(method)} | {cells} |")
    return "\n".join(rows)


def _heading(outcomes: Sequence[Outcome], options: Options) -> str:
    frames = round(float(np.mean([item.frames for item in outcomes])))
    first = outcomes[0].split
    if options.leave_out_talkers:
        talkers = ", ".join(f"{item.split.talker} ({len(item.split.test)} episodes)" for item in outcomes)
        others = "" if options.first_corpus_alone else ", Labial's models on those of the other talkers too"
        return (f"Each talker in turn left out and judged: {talkers}; {len(first.training)} episodes of the first "
                f"corpus trained on{others}; {frames} frames judged per talker, silence excluded, {options.fps} frames "
                f"per second. Mean (standard deviation) over the talkers.")
    part = f"{len(first.training)} episodes trained on, {len(first.test)} held out"
    if options.held_out:
        part += f"; judged on the words {', '.join(sorted(set(options.held_out)))}, which no training episode holds"
    if first.added:
        part += f"; Labial's models are also trained on {len(first.added)} episodes of further corpora"
    splits = f"{len(outcomes)} split{'s' if len(outcomes) > 1 else ''}"
    return (f"{splits} (seed {options.seed}), {part}; {frames} frames judged per split, silence excluded, "
            f"{options.fps} frames per second. Mean (standard deviation) over the splits.")


def markdown(outcomes: Sequence[Outcome], options: Options, plots: Sequence[str] = ()) -> str:
    """The whole report."""
    methods, synthetic = methods_of(outcomes), options.synthetic
    apart = {"class": "phoneme class", "phoneme": "laughter phoneme"}[grouping(options.kind)]

    def table(number: int, what: str, who: Sequence[str], columns: Columns, note: str = "") -> str:
        head = f"## {caption(f'Table {number}', what, options)}"
        return "\n\n".join(filter(None, [head, markdown_table(outcomes, who, columns, synthetic), note]))

    parts = [
        f"# Evaluation: {options.kind}" + (", synthetic data" if synthetic else ""),
        *([_SYNTHETIC] if synthetic else []),
        _heading(outcomes, options),
        *([f"## {caption('Table 0', 'correlation, talker by talker', options)}", talkers_table(outcomes, methods),
           _NOTE_TALKERS] if options.leave_out_talkers else []),
        table(1, "diff, |original - synthetic| / maximum", methods, TABLE_1),
        table(2, "other measures", [HUMAN, *methods], TABLE_2[options.kind], _NOTE_2[options.kind]),
        table(3, "correlation and amplitude per channel", methods, TABLE_3),
        table(4, f"mean diff per {apart}", methods, table_4(outcomes, options.kind)),
    ]
    parts += [f"![{Path(name).stem.replace('_', ' ')}]({name})" for name in plots]
    return "\n\n".join(parts) + "\n"


def _write_csv(path: Path, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    with open(path, "w", encoding="utf-8", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def _key(name: str, options: Options) -> str:
    """A method or a measure in the CSV files."""
    return name.replace(HUMAN, "original") if options.synthetic else name


def _table_rows(
    outcomes: Sequence[Outcome], methods: Sequence[str], columns: Columns, options: Options
) -> List[List[object]]:
    rows: List[List[object]] = []
    for method in methods:
        for _, measure in columns:
            value = cell(outcomes, method, measure)
            rows.append([_key(method, options), _key(measure, options), f"{value.mean:.6g}", f"{value.deviation:.6g}"])
    return rows


def write(outcomes: Sequence[Outcome], options: Options, folder: Path, plots: Sequence[str] = ()) -> List[Path]:
    """Writes report.md, table1.csv to table4.csv (means and deviations) and splits.csv (every measure, every split).

    The CSV files of synthetic data say so in their names.
    """
    methods = methods_of(outcomes)
    written = [folder / "report.md"]
    written[0].write_text(markdown(outcomes, options, plots), encoding="utf-8")
    tables: Dict[str, Tuple[Sequence[str], Columns]] = {
        "table1": (methods, TABLE_1),
        "table2": ([HUMAN, *methods], TABLE_2[options.kind]),
        "table3": (methods, TABLE_3),
        "table4": (methods, table_4(outcomes, options.kind)),
    }
    suffix = "_synthetic.csv" if options.synthetic else ".csv"
    for name, (who, columns) in tables.items():
        written.append(folder / f"{name}{suffix}")
        rows = _table_rows(outcomes, who, columns, options)
        _write_csv(written[-1], ("method", "measure", "mean", "deviation"), rows)
    written.append(folder / f"splits{suffix}")
    rows = [[item.split.number, _key(method, options), _key(measure, options), f"{value:.6g}"] for item in outcomes
            for method, measures in item.measures.items() for measure, value in measures.items()]
    _write_csv(written[-1], ("split", "method", "measure", "value"), rows)
    return written
