"""Baseline: one shape for all frames, the mean of the training frames outside silence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labial.evaluate.material import Timeline
from labial.evaluate.training import Training


@dataclass(frozen=True)
class Mean:
    """A mouth that does not move."""

    shape: np.ndarray  #: (13,) FAP

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) the shape, repeated."""
        return np.tile(self.shape, (timeline.frames, 1))


def fit(training: Training) -> Mean:
    """The mean."""
    frames = [item.human[item.timeline.phoneme_at != training.silence] for item in training.utterances]
    return Mean(np.concatenate(frames).mean(axis=0))
