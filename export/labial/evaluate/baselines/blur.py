"""Baseline: the step stream of equation 2 under a Gaussian, whose width is chosen by inner validation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from scipy.ndimage import gaussian_filter1d

from labial.evaluate.baselines import steps
from labial.evaluate.material import Timeline
from labial.evaluate.training import Training, choose

#: Standard deviations that are tried, seconds.
WIDTHS = tuple(round(0.005 * n, 3) for n in range(17))


@dataclass(frozen=True)
class Blur:
    """A smoothed step stream."""

    steps: steps.Steps
    width: float  #: seconds
    fps: int

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13); the first and the last shape extend beyond the ends."""
        return _smooth(self.steps.predict(timeline), self.width * self.fps)


def _smooth(frames: np.ndarray, deviation: float) -> np.ndarray:
    return gaussian_filter1d(frames, deviation, axis=0, mode="nearest") if deviation > 0 and len(frames) else frames


def fit(training: Training) -> Blur:
    """Chooses the width on the inner validation part, with shapes from the rest."""

    def prepare(part: Training) -> Callable[..., Any]:
        rough = steps.fit(part)
        return lambda width: Blur(rough, width, training.fps).predict

    return Blur(steps.fit(training), choose(training, WIDTHS, prepare), training.fps)
