"""Plots of an evaluation, after the paper's figures 3 and 6, and of where the errors are."""

from __future__ import annotations

from pathlib import Path
from typing import List, Sequence, Tuple

import numpy as np

from labial.evaluate.drawing import Span, label_phonemes, pyplot, save, spans
from labial.evaluate.protocol import HUMAN, Example, Options, Outcome
from labial.evaluate.report import cell, grouping, methods_of, table_4, title
from labial.evaluate.trajectories import JUDGED, JUDGED_NAMES
from labial.phonesets import PHONE_SETS

#: Seconds of an utterance that its trajectories are shown for.
LONGEST = 5

#: Methods whose curves are drawn where they were run; all of them would hide each other.
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


def _curves(axes: pyplot.Axes, example: Example, frames: slice, channel: int, options: Options) -> None:
    """The original and the methods."""
    time = (np.arange(frames.start, frames.stop) + 0.5) / options.fps
    original = title(HUMAN, options.synthetic)
    axes.plot(time, example.utterance.human[frames, channel], color="black", linewidth=1.5, label=original)
    for name in _drawn(example):
        axes.plot(time, example.motion[name][frames, channel], linewidth=1.2, label=title(name))


def _phonemes(example: Example, frames: slice, options: Options) -> List[Span]:
    given, names = example.utterance.timeline, PHONE_SETS[example.kind].phonemes
    return spans(given, names, options.fps, frames.start, frames.stop)


def step_stream(example: Example, options: Options, folder: Path) -> str:
    """The paper's figure 3: step stream and smoothed curve over one word, or one train of pulses."""
    begin, end, word = _stretch(example)
    frames = slice(begin, end)
    figure, every = pyplot.subplots(2, 1, figsize=(8, 6), sharex=True)
    for axes, k, channel in zip(every, JUDGED, JUDGED_NAMES):
        edges = np.arange(begin, end + 1) / options.fps
        axes.stairs(example.steps[frames, k], edges, color="0.5", label="step stream (eq. 2)", baseline=None)
        _curves(axes, example, frames, k, options)
        axes.set_ylabel(f"{channel}, FAP units")
        label_phonemes(axes, _phonemes(example, frames, options), upright=example.kind == "laughter")
    every[-1].set_xlabel(f"seconds, {_name(example, options)}" + (f', "{word}"' if word else ""))
    every[0].legend(fontsize=7)
    figure.tight_layout()
    return save(figure, folder / "steps_and_curve.png")


def trajectories(example: Example, options: Options, folder: Path) -> str:
    """The paper's figure 6: human and synthetic trajectories of an utterance, at most LONGEST seconds."""
    frames = slice(*_around(example, options.fps))
    figure, every = pyplot.subplots(len(JUDGED), 1, figsize=(11, 9), sharex=True)
    for axes, k, channel in zip(every, JUDGED, JUDGED_NAMES):
        _curves(axes, example, frames, k, options)
        axes.set_ylabel(channel, fontsize=8)
    label_phonemes(every[0], _phonemes(example, frames, options), upright=example.kind == "laughter")
    figure.align_ylabels(every)
    every[-1].set_xlabel(f"seconds, {_name(example, options)}; FAP units")
    every[0].legend(fontsize=7, loc="upper right")
    figure.tight_layout()
    return save(figure, folder / "trajectories.png")


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
    axes.legend(fontsize=7, ncol=3)
    figure.tight_layout()
    return save(figure, path)


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
