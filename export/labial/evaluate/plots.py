"""Plots of an evaluation: like the paper's figures 3 and 6, and of errors by group."""

from __future__ import annotations

from pathlib import Path
from typing import List, Sequence, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from labial.corpus.phonesets import PHONE_SETS
from labial.evaluate.material import Example, Options, Outcome, bands
from labial.evaluate.measures import JUDGED, JUDGED_NAMES
from labial.evaluate.protocol import HUMAN
from labial.evaluate.report import cell, grouping, methods_of, table_4, title
from labial.see import drawing
from labial.see.drawing import COLOURS, pyplot, style
from labial.see.motion import Band, kind_of

#: Seconds of an utterance that its trajectories are shown for.
LONGEST = 5

#: Methods whose curves are drawn, if they were run; all of them would hide each other.
DRAWN = ("hmm_synthesis", "paper", "labial")


def _drawn(example: Example) -> List[str]:
    return [name for name in DRAWN if name in example.motion] or list(example.motion)[-2:]


def _stretch(example: Example) -> Tuple[int, int, str]:
    """First frame, end frame and name of the word, or train of pulses, that is shown; else the whole utterance."""
    given = example.utterance.timeline
    if example.stretch is None:
        return 0, given.frames, ""
    first, last = example.stretch
    return int(given.start[first]), int(given.start[last] + given.length[last]), example.utterance.words[first] or ""


def _around(example: Example, fps: int) -> Tuple[int, int]:
    """First and end frame of LONGEST seconds of the utterance, around what :func:`_stretch` shows."""
    total = example.utterance.timeline.frames
    first, last, _ = _stretch(example)
    begin = min(max((first + last - LONGEST * fps) // 2, 0), max(total - LONGEST * fps, 0))
    return begin, min(begin + LONGEST * fps, total)


def _name(example: Example, options: Options) -> str:
    return example.utterance.episode.name + (", synthetic data" if options.synthetic else "")


def _curves(axes: Axes, example: Example, frames: slice, channel: int, options: Options) -> None:
    """The original and the methods, over the phonemes."""
    drawing.shade(axes, _bands(example, frames, options))
    time = (np.arange(frames.start, frames.stop) + 0.5) / options.fps
    original = title(HUMAN, options.synthetic)
    axes.plot(time, example.utterance.human[frames, channel], color="black", linewidth=1.6, label=original)
    for name, colour in zip(_drawn(example), COLOURS):
        axes.plot(time, example.motion[name][frames, channel], color=colour, linewidth=1.3, label=title(name))
    axes.set_xlim(frames.start / options.fps, frames.stop / options.fps)


def _bands(example: Example, frames: slice, options: Options) -> List[Band]:
    phones = PHONE_SETS[example.kind]
    kinds = [kind_of(label, phones) for label in phones.phonemes]
    return bands(example.utterance.timeline, phones.phonemes, kinds, options.fps, frames.start, frames.stop)


def _finish(figure: Figure, every: Sequence[Axes], example: Example, frames: slice, options: Options,
            path: Path) -> str:
    """Phonemes above the first axes, the legend below the last, and the file; returns its name."""
    shown = _bands(example, frames, options)
    curves = every[0].get_legend_handles_labels()[0]
    patches = list(drawing.legend_patches(shown))
    figure.align_ylabels(every)
    handles = [*curves, *patches]
    figure.legend(handles=handles, loc="lower center", ncol=len(handles) if len(handles) <= 7 else 5, frameon=False,
                  fontsize=7.5, columnspacing=1.6)
    room = (0, (0.25 if len(handles) <= 7 else 0.42) / figure.get_figheight(), 1, 1)  # below it is the legend
    figure.tight_layout(rect=room)
    drawing.label(every[0], shown, upright=example.kind == "laughter")
    figure.tight_layout(rect=room)
    drawing.write(figure, path)
    return path.name


def step_stream(example: Example, options: Options, folder: Path) -> str:
    """The paper's figure 3: step stream and smoothed curve over one word, or one train of pulses."""
    begin, end, word = _stretch(example)
    frames = slice(begin, end)
    figure, every = pyplot.subplots(2, 1, figsize=(8.5, 6), sharex=True)
    for axes, k, channel in zip(every, JUDGED, JUDGED_NAMES):
        edges = np.arange(begin, end + 1) / options.fps
        axes.stairs(example.steps[frames, k], edges, color="0.5", label="step stream (eq. 2)", baseline=None)
        _curves(axes, example, frames, k, options)
        axes.set_ylabel(f"{channel}, FAP units")
    every[-1].set_xlabel(f"seconds, {_name(example, options)}" + (f', "{word}"' if word else ""))
    return _finish(figure, every, example, frames, options, folder / "steps_and_curve.png")


def trajectories(example: Example, options: Options, folder: Path) -> str:
    """The paper's figure 6: human and synthetic trajectories of an utterance, at most LONGEST seconds."""
    frames = slice(*_around(example, options.fps))
    figure, every = pyplot.subplots(len(JUDGED), 1, figsize=(11, 9), sharex=True)
    for axes, k, channel in zip(every, JUDGED, JUDGED_NAMES):
        _curves(axes, example, frames, k, options)
        axes.set_ylabel(channel)
    every[-1].set_xlabel(f"seconds, {_name(example, options)}; FAP units")
    return _finish(figure, every, example, frames, options, folder / "trajectories.png")


def _bars(
    outcomes: Sequence[Outcome], groups: Sequence[Tuple[str, str]], label: str, options: Options, path: Path
) -> str:
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
    drawing.write(figure, path)
    return path.name


@style()
def write(outcomes: Sequence[Outcome], options: Options, folder: Path) -> List[str]:
    """Writes all plots; returns their file names."""
    names = []
    example = next((item.example for item in outcomes if item.example is not None), None)
    if example is not None:
        names += [step_stream(example, options, folder), trajectories(example, options, folder)]
    apart = folder / f"error_per_{grouping(options.kind)}.png"
    names.append(_bars(outcomes, table_4(outcomes, options.kind), "mean diff", options, apart))
    channels = [(name, f"amplitude/{name}") for name in JUDGED_NAMES]
    names.append(_bars(outcomes, channels, "amplitude, original = 1", options, folder / "amplitude.png"))
    return names
