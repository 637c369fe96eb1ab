"""Tables of an evaluation: Markdown for people, CSV for programs. They do not depend on time or machine.

The plots are like the paper's figures 3 and 6, and of errors by group.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, List, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import PHONE_SETS
from labial.evaluate.material import Example, Options, Outcome, bands
from labial.evaluate.measures import JUDGED, JUDGED_NAMES, LIPS, PARAMETERS, groups
from labial.evaluate.methods import METHODS
from labial.evaluate.protocol import HUMAN
from labial.see import plot
from labial.see.motion import kind_of
from labial.see.plot import COLOURS, pyplot, style

#: Column title and measure.
Columns = Sequence[Tuple[str, str]]
#: The paper's Table 1: diff per labial parameter.
TABLE_1: Columns = [(name, f"diff/{name}") for name in (*PARAMETERS, "mean")]
#: The first and last of the other measures, for all kinds.
_FIRST: Columns = (("correlation", "correlation/mean"), ("amplitude", "amplitude/mean"))
_LAST: Columns = (("jitter", "jitter"), ("seam, mean", "seam/mean"), ("seam, largest", "seam/largest"))
#: The other measures, by kind.
TABLE_2: Dict[str, Columns] = {
    "speech": [*_FIRST, ("closure", "closure/rate"), ("of human", "closure/of human"),
               ("firm closure", "firm closure/rate"), ("of human", "firm closure/of human"),
               ("readability", "readability"), ("with residual", "readability/with residual"), *_LAST],
    "laughter": [*_FIRST, ("pulses seen", "pulses/seen"), ("of original", "pulses/of human"),
                 ("rise of pulses", "pulses/height"), ("closure in ne, nasal", "closure/rate"),
                 ("of original", "closure/of human"), *_LAST]}
#: Correlation and amplitude, channel by channel.
TABLE_3: Columns = [(f"{what} {name}", f"{what}/{name}")
                    for what in ("correlation", "amplitude") for name in JUDGED_NAMES]


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


def markdown_table(outcomes: Sequence[Outcome], methods: Sequence[str], columns: Columns,
                   synthetic: bool = False) -> str:
    """Methods down, measures across."""
    lines = ["| method | " + " | ".join(name for name, _ in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for method in methods:
        cells = [str(cell(outcomes, method, measure)) for _, measure in columns]
        lines.append(f"| {title(method, synthetic)} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def talkers_table(outcomes: Sequence[Outcome], methods: Sequence[str]) -> str:
    """Methods down; correlation with each talker left out, their mean, its standard error, and means of LIPS across."""
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

    parts = [f"# Evaluation: {options.kind}" + (", synthetic data" if synthetic else ""),
             *([_SYNTHETIC] if synthetic else []), _heading(outcomes, options),
             *([f"## {caption('Table 0', 'correlation, talker by talker', options)}", talkers_table(outcomes, methods),
                _NOTE_TALKERS] if options.leave_out_talkers else []),
             table(1, "diff, |original - synthetic| / maximum", methods, TABLE_1),
             table(2, "other measures", [HUMAN, *methods], TABLE_2[options.kind], _NOTE_2[options.kind]),
             table(3, "correlation and amplitude per channel", methods, TABLE_3),
             table(4, f"mean diff per {apart}", methods, table_4(outcomes, options.kind))]
    parts += [f"![{Path(name).stem.replace('_', ' ')}]({name})" for name in plots]
    return "\n\n".join(parts) + "\n"


def write(outcomes: Sequence[Outcome], options: Options, folder: Path, plots: Sequence[str] = ()) -> List[Path]:
    """Writes report.md, table1.csv to table4.csv (means and deviations) and splits.csv (every measure, every split).
    The CSV files of synthetic data say so in their names."""
    methods = methods_of(outcomes)
    written = [folder / "report.md"]
    written[0].write_text(markdown(outcomes, options, plots), encoding="utf-8")

    def key(name: str) -> str:
        return name.replace(HUMAN, "original") if options.synthetic else name

    def write_csv(name: str, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
        written.append(folder / f"{name}{'_synthetic' if options.synthetic else ''}.csv")
        with open(written[-1], "w", encoding="utf-8", newline="") as out:
            csv.writer(out, lineterminator="\n").writerows([header, *rows])

    tables: Sequence[Tuple[Sequence[str], Columns]] = (
        (methods, TABLE_1), ([HUMAN, *methods], TABLE_2[options.kind]), (methods, TABLE_3),
        (methods, table_4(outcomes, options.kind)))
    for number, (who, columns) in enumerate(tables, 1):
        cells = ((method, measure, cell(outcomes, method, measure)) for method in who for _, measure in columns)
        write_csv(f"table{number}", ("method", "measure", "mean", "deviation"),
                  ((key(method), key(measure), f"{found.mean:.6g}", f"{found.deviation:.6g}")
                   for method, measure, found in cells))
    write_csv("splits", ("split", "method", "measure", "value"),
              ((item.split.number, key(method), key(measure), f"{value:.6g}") for item in outcomes
               for method, measures in item.measures.items() for measure, value in measures.items()))
    return written


#: Seconds of an utterance whose trajectories the report shows.
LONGEST = 5
#: Methods whose curves are drawn, if they were run; all of them would hide each other.
DRAWN = ("hmm_synthesis", "paper", "labial")


def _figure(example: Example, options: Options, path: Path, span: Tuple[int, int], size: Tuple[float, float],
            labels: Sequence[str], about: str, with_steps: bool) -> str:
    """The original and the methods over the phonemes from the first to the end frame of `span`, a channel above each of
    `labels`; returns the file's name."""
    frames, fps, phones = slice(*span), options.fps, PHONE_SETS[example.kind]
    kinds = [kind_of(label, phones) for label in phones.phonemes]
    shown = bands(example.utterance.timeline, phones.phonemes, kinds, fps, *span)
    drawn = [name for name in DRAWN if name in example.motion] or list(example.motion)[-2:]
    time = (np.arange(*span) + 0.5) / fps
    figure, every = pyplot.subplots(len(labels), 1, figsize=size, sharex=True)
    for axes, k, label in zip(every, JUDGED, labels):
        if with_steps:
            edges = np.arange(span[0], span[1] + 1) / fps
            axes.stairs(example.steps[frames, k], edges, color="0.5", label="step stream (eq. 2)", baseline=None)
        plot.shade(axes, shown)
        axes.plot(time, example.utterance.human[frames, k], color="black", linewidth=1.6,
                  label=title(HUMAN, options.synthetic))
        for name, colour in zip(drawn, COLOURS):
            axes.plot(time, example.motion[name][frames, k], color=colour, linewidth=1.3, label=title(name))
        axes.set_xlim(span[0] / fps, span[1] / fps)
        axes.set_ylabel(label)
    every[-1].set_xlabel(about)
    figure.align_ylabels(every)
    handles = [*every[0].get_legend_handles_labels()[0], *plot.legend_patches(shown)]
    figure.legend(handles=handles, loc="lower center", ncol=len(handles) if len(handles) <= 7 else 5, frameon=False,
                  fontsize=7.5, columnspacing=1.6)
    room = (0, (0.25 if len(handles) <= 7 else 0.42) / figure.get_figheight(), 1, 1)  # below it is the legend
    figure.tight_layout(rect=room)
    plot.label(every[0], shown, upright=example.kind == "laughter")
    figure.tight_layout(rect=room)
    plot.write(figure, path)
    return path.name


def _figures(example: Example, options: Options, folder: Path) -> List[str]:
    """The paper's figure 3, step stream and smoothed curve over one word, or one train of pulses; and its figure 6,
    trajectories of the utterance, at most LONGEST seconds around that. Without such a stretch both show all of it."""
    given, most = example.utterance.timeline, LONGEST * options.fps
    begin, end, word = 0, given.frames, None
    if example.stretch is not None:
        first, last = example.stretch
        begin, end = int(given.start[first]), int(given.start[last] + given.length[last])
        word = example.utterance.words[first]
    around = min(max((begin + end - most) // 2, 0), max(given.frames - most, 0))
    about = f"seconds, {example.utterance.episode.name}" + (", synthetic data" if options.synthetic else "")
    return [_figure(example, options, folder / "steps_and_curve.png", (begin, end), (8.5, 6),
                    [f"{name}, FAP units" for name in JUDGED_NAMES[:2]], about + (f', "{word}"' if word else ""), True),
            _figure(example, options, folder / "trajectories.png", (around, min(around + most, given.frames)), (11, 9),
                    JUDGED_NAMES, f"{about}; FAP units", False)]


def _bars(outcomes: Sequence[Outcome], groups: Sequence[Tuple[str, str]], label: str, options: Options,
          path: Path) -> str:
    """One group of bars per (name, measure), one bar per method, with the deviation over the splits."""
    methods = methods_of(outcomes)
    width = 0.85 / len(methods)
    figure, axes = pyplot.subplots(figsize=(max(9, 1.1 * len(groups)), 4.5))
    for index, method in enumerate(methods):
        cells = [cell(outcomes, method, measure) for _, measure in groups]
        place = np.arange(len(groups)) + (index - (len(methods) - 1) / 2) * width
        axes.bar(place, [item.mean for item in cells], width, yerr=[item.deviation for item in cells],
                 label=title(method), color=pyplot.get_cmap("tab20")(index), error_kw={"linewidth": 0.6})
    axes.set_xticks(np.arange(len(groups)), [name for name, _ in groups], rotation=20, ha="right", fontsize=8)
    axes.set_ylabel(label + (", synthetic data" if options.synthetic else ""))
    axes.legend(fontsize=7, ncol=3, frameon=False)
    figure.tight_layout()
    plot.write(figure, path)
    return path.name


@style()
def draw(outcomes: Sequence[Outcome], options: Options, folder: Path) -> List[str]:
    """Writes all plots; returns their file names."""
    names = []
    example = next((item.example for item in outcomes if item.example is not None), None)
    if example is not None:
        names += _figures(example, options, folder)
    apart = folder / f"error_per_{grouping(options.kind)}.png"
    names.append(_bars(outcomes, table_4(outcomes, options.kind), "mean diff", options, apart))
    channels = [(name, f"amplitude/{name}") for name in JUDGED_NAMES]
    names.append(_bars(outcomes, channels, "amplitude, original = 1", options, folder / "amplitude.png"))
    return names
