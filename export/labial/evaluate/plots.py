"""Plots of an evaluation, after the paper's figures 3 and 6, and of where the errors are."""

from __future__ import annotations

from pathlib import Path
from typing import List, Sequence, Tuple

import numpy as np

from labial.evaluate.protocol import HUMAN, Example, Outcome
from labial.evaluate.report import cell, classes_of, methods_of, title
from labial.evaluate.trajectories import JUDGED, JUDGED_NAMES
from labial.phonesets import PHONE_SETS
from labial.see import drawing
from labial.see.drawing import pyplot
from labial.see.motion import Band, kind_of

#: Methods whose curves are drawn where they were run; all of them would hide each other.
DRAWN = ("hmm_synthesis", "paper", "labial")


def _drawn(example: Example) -> List[str]:
    return [name for name in DRAWN if name in example.motion] or list(example.motion)[-2:]


def _word(example: Example) -> Tuple[int, int, str]:
    """First frame, end frame and name of the word that is shown; the whole utterance where no word is known."""
    given = example.utterance.timeline
    if example.word is None:
        return 0, given.frames, ""
    first, last = example.word
    return int(given.start[first]), int(given.start[last] + given.length[last]), str(example.utterance.words[first])


def _bands(example: Example, begin: int, end: int, fps: int) -> List[Band]:
    """The phonemes from frame `begin` to frame `end`."""
    given = example.utterance.timeline
    phones = PHONE_SETS[example.kind]
    bands = []
    for segment in given.held:
        first, last = int(given.start[segment]), int(given.start[segment] + given.length[segment])
        if first >= begin and last <= end:
            name = phones.phonemes[given.phoneme[segment]]
            bands.append(Band(first / fps, last / fps, name, kind_of(name, phones)))
    return bands


def _finish(figure: pyplot.Figure, path: Path) -> str:
    figure.tight_layout()
    drawing.write(figure, path)
    return path.name


def step_stream(example: Example, fps: int, folder: Path) -> str:
    """The paper's figure 3: step stream and smoothed curve over one word."""
    begin, end, word = _word(example)
    frames = slice(begin, end)
    time = (np.arange(begin, end) + 0.5) / fps
    bands = _bands(example, begin, end, fps)
    figure, every = pyplot.subplots(2, 1, figsize=(8, 6), sharex=True)
    for axes, channel in zip(every, (0, 1)):
        k = JUDGED[channel]
        edges = np.arange(begin, end + 1) / fps
        axes.stairs(example.steps[frames, k], edges, color="0.5", label="step stream (eq. 2)", baseline=None)
        axes.plot(time, example.utterance.human[frames, k], color="black", linewidth=1.5, label=HUMAN)
        for name in _drawn(example):
            axes.plot(time, example.motion[name][frames, k], label=title(name))
        axes.set_ylabel(f"{JUDGED_NAMES[channel]}, FAP units")
        drawing.shade(axes, bands)
        drawing.label(axes, bands)
    every[-1].set_xlabel(f"seconds, {example.utterance.episode.name}" + (f', "{word}"' if word else ""))
    every[0].legend(fontsize=7)
    return _finish(figure, folder / "steps_and_curve.png")


def trajectories(example: Example, fps: int, folder: Path) -> str:
    """The paper's figure 6: human and synthetic trajectories of an utterance."""
    total = example.utterance.timeline.frames
    time = (np.arange(total) + 0.5) / fps
    bands = _bands(example, 0, total, fps)
    figure, every = pyplot.subplots(len(JUDGED), 1, figsize=(11, 9), sharex=True)
    for axes, k, channel in zip(every, JUDGED, JUDGED_NAMES):
        axes.plot(time, example.utterance.human[:, k], color="black", linewidth=1.5, label=HUMAN)
        for name in _drawn(example):
            axes.plot(time, example.motion[name][:, k], linewidth=1, label=title(name))
        axes.set_ylabel(channel, fontsize=8)
        drawing.shade(axes, bands)
    drawing.label(every[0], bands)
    figure.align_ylabels(every)
    every[-1].set_xlabel(f"seconds, {example.utterance.episode.name}; FAP units")
    every[0].legend(fontsize=7, loc="upper right")
    return _finish(figure, folder / "trajectories.png")


def _bars(outcomes: Sequence[Outcome], groups: Sequence[Tuple[str, str]], label: str, path: Path) -> str:
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
    axes.set_ylabel(label)
    axes.legend(fontsize=7, ncol=3)
    return _finish(figure, path)


def write(outcomes: Sequence[Outcome], fps: int, folder: Path) -> List[str]:
    """Writes all plots; returns their file names."""
    with pyplot.rc_context(drawing.STYLE):
        return _write(outcomes, fps, folder)


def _write(outcomes: Sequence[Outcome], fps: int, folder: Path) -> List[str]:
    names = []
    example = next((item.example for item in outcomes if item.example is not None), None)
    if example is not None:
        names += [step_stream(example, fps, folder), trajectories(example, fps, folder)]
    classes = [(name, f"class/{name}") for name in classes_of(outcomes)]
    names.append(_bars(outcomes, classes, "mean diff", folder / "error_per_class.png"))
    channels = [(name, f"amplitude/{name}") for name in JUDGED_NAMES]
    names.append(_bars(outcomes, channels, "amplitude, human = 1", folder / "amplitude.png"))
    return names
