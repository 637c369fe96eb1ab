"""Baseline: the step stream, each phoneme's selected mean shape held for the phoneme (equation 2 of the paper).

Also the step stream of the context-aware mixtures (docs/method.md, What Labial adds), which other baselines build on,
and the step stream under a Gaussian.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict

import numpy as np
from scipy.ndimage import gaussian_filter1d

from labial.evaluate.material import Timeline
from labial.evaluate.training import Training, choose
from labial.reference.shape import ShapeTables, shapes
from labial.reference.shape import choose as chosen
from labial.train.recordings import neighbour_classes, occurrences, recordings
from labial.train.shapes import Mixture, back_off, corpus_scale, fit_context, fit_mixture, shape_tables

#: Components of each phoneme's mixture (C of equation 1).
COMPONENTS = 5


@dataclass(frozen=True)
class Steps:
    """Selected shapes: the best component, as in the paper, or, `soft`, the mean over components with context."""

    tables: ShapeTables
    viseme_class: np.ndarray  #: (P,)
    silence: int
    soft: bool

    def selected(self, timeline: Timeline) -> np.ndarray:
        """(H, 13) FAP: the shape of every segment that has frames."""
        phoneme = timeline.phoneme[timeline.held]
        seconds = timeline.milliseconds[timeline.held] / 1000.0
        before, after = neighbour_classes(phoneme, self.viseme_class, self.silence)
        return shapes(self.tables, chosen(self.tables, phoneme, seconds, before, after, soft=self.soft))

    def __call__(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) FAP."""
        return np.repeat(self.selected(timeline), timeline.length[timeline.held], axis=0)


def _fit(training: Training, context: bool) -> Steps:
    phone_set = training.phone_set
    items = occurrences(recordings([item.episode for item in training.utterances], phone_set, training.fps), phone_set)
    plan = back_off(np.bincount(items.phoneme, minlength=len(phone_set.phonemes)), phone_set)
    vectors = items.vectors()
    scale = corpus_scale(vectors)
    fitted: Dict[object, Mixture] = {}  # by the phonemes whose samples it is made of
    for members in filter(None, plan.members):
        if members in fitted:
            continue
        rows = np.flatnonzero(np.isin(items.phoneme, members))
        mixture = fit_mixture(vectors[rows], scale, COMPONENTS, training.seed)
        if context:
            mixture = fit_context(mixture, vectors[rows], scale, items.previous[rows], items.next[rows],
                                  len(phone_set.classes))
        fitted[members] = mixture
    mixtures = [fitted[plan.members[stand_in]] for stand_in in plan.stand_in]
    tables = shape_tables(mixtures, conditional=context)
    return Steps(tables, np.array(phone_set.viseme_class, dtype=np.int64), training.silence, context)


def fit(training: Training, context: bool = False) -> Steps:
    """The step stream of equation 2; with `context` that of the context-aware mixtures."""
    return training.derived(("steps", context), lambda: _fit(training, context))


#: Standard deviations that are tried, seconds.
WIDTHS = tuple(round(0.005 * n, 3) for n in range(17))


@dataclass(frozen=True)
class Blur:
    """A smoothed step stream."""

    steps: Steps
    width: float  #: seconds
    fps: int

    def __call__(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) FAP."""
        frames, deviation = self.steps(timeline), self.width * self.fps
        return gaussian_filter1d(frames, deviation, axis=0, mode="nearest") if deviation > 0 and len(frames) else frames


def fit_blur(training: Training) -> Blur:
    """The step stream under a Gaussian; chooses its width on the inner validation part, with shapes from the rest."""
    width = choose(training, WIDTHS, lambda part: lambda width: Blur(fit(part), width, training.fps))
    return Blur(fit(training), width, training.fps)
