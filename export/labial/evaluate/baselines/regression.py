"""Baseline: linear regression from the phoneme, its neighbours' classes and its duration.

Each feature may also change along the phoneme: the design has it once unchanged and once times the frame's relative
position, so that motion need not be a step.
"""

from __future__ import annotations

from typing import List

import numpy as np
from scipy.sparse import csr_matrix, hstack

from labial.evaluate.baselines import ridge
from labial.evaluate.material import Timeline
from labial.evaluate.training import Training
from labial.train.recordings import neighbour_classes

#: Penalties that are tried, frames.
PENALTIES = (0.1, 1.0, 10.0, 100.0)


def _onehot(label: np.ndarray, count: int, value: np.ndarray) -> csr_matrix:
    """(T, count) with `value` (T,) in the column of `label` (T,)."""
    return csr_matrix((value, label, np.arange(len(label) + 1)), shape=(len(label), count))


def _design(training: Training) -> ridge.Design:
    viseme_class = np.array(training.phone_set.viseme_class, dtype=np.int64)
    phonemes, classes, silence = len(viseme_class), len(training.phone_set.classes), training.silence

    def rows(timeline: Timeline) -> ridge.Rows:
        held = timeline.held
        length = timeline.length[held]
        phoneme = timeline.phoneme[held]
        before, after = (np.repeat(item, length) for item in neighbour_classes(phoneme, viseme_class, silence))
        position = (np.arange(timeline.frames) + 0.5 - np.repeat(timeline.start[held], length)) / np.repeat(
            length, length
        )
        seconds = np.repeat(timeline.milliseconds[held] / 1000.0, length)
        duration = np.log(np.clip(seconds, 0.02, 1.0) / 0.1)
        blocks: List[csr_matrix] = []
        for course in (np.ones_like(position), position - 0.5):
            blocks += [
                _onehot(timeline.phoneme_at, phonemes, course),
                _onehot(timeline.phoneme_at, phonemes, course * duration),
                _onehot(before, classes, course),
                _onehot(after, classes, course),
            ]
        return ridge.Rows(hstack(blocks).tocsr(), np.zeros((timeline.frames, 0)))

    return rows


def fit(training: Training) -> ridge.Linear:
    """Chooses the penalty on the inner validation part."""
    count = 2 * 2 * (len(training.phone_set.phonemes) + len(training.phone_set.classes))
    return ridge.fit(training, _design, [np.full(count, penalty) for penalty in PENALTIES])
