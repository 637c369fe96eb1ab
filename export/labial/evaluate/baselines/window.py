"""Baselines: ridge regression on the labels in a window around each frame.

On phoneme labels; or on viseme-class labels together with the context-aware step stream of all channels. Without
shapes, states and trajectories, they show what additive temporal kernels achieve alone.
"""

from __future__ import annotations

import itertools
from typing import Callable, List, Optional

import numpy as np
from scipy.sparse import csr_matrix

from labial.evaluate.baselines import ridge, steps
from labial.evaluate.material import Timeline
from labial.evaluate.training import Training
from labial.files.faps import CHANNELS

#: The window reaches this far to both sides; labels are read every frame, the step stream every SPACING. Seconds.
REACH = 0.3
SPACING = 0.04

#: Penalties that are tried: of labels, and of the stream divided by its standard deviations; frames.
LABEL_PENALTIES = (10.0, 30.0, 100.0, 300.0, 1000.0)
STREAM_PENALTIES = (30.0, 300.0, 3000.0)


def window(fps: int, spacing: int = 1) -> np.ndarray:
    """(L,) int64 frames from -REACH to REACH, multiples of `spacing`."""
    side = round(REACH * fps) // spacing
    return np.arange(-side, side + 1, dtype=np.int64) * spacing


def labels(label_at: np.ndarray, lag: np.ndarray, count: int, outside: int) -> csr_matrix:
    """(T, L * count) one-hot labels at every lag from each of T frames; `outside` before and after the utterance."""
    frames = len(label_at)
    at = np.arange(frames)[:, None] + lag[None, :]
    inside = (at >= 0) & (at < frames)
    found = np.where(inside, label_at[np.clip(at, 0, max(frames - 1, 0))], outside)
    column = found + np.arange(len(lag)) * count
    start = np.arange(frames + 1) * len(lag)
    return csr_matrix((np.ones(column.size), column.ravel(), start), shape=(frames, len(lag) * count))


def shifted(stream: np.ndarray, lag: np.ndarray) -> np.ndarray:
    """(T, L * K) the stream (T, K) at every lag, held beyond its ends."""
    at = np.clip(np.arange(len(stream))[:, None] + lag[None, :], 0, len(stream) - 1)
    result: np.ndarray = stream[at].reshape(len(stream), -1)
    return result


def _design(training: Training, of_class: bool, stream: Optional[steps.Steps]) -> ridge.Design:
    viseme_class = np.array(training.phone_set.viseme_class, dtype=np.int64)
    label_of = viseme_class if of_class else np.arange(len(viseme_class))
    lag = window(training.fps)
    wide = window(training.fps, max(1, round(SPACING * training.fps)))
    count = int(label_of.max()) + 1
    if stream is not None:
        moving = np.concatenate([stream.predict(item.timeline) for item in training.utterances])
        centre, spread = moving.mean(axis=0), np.maximum(moving.std(axis=0), 1e-9)

    def rows(timeline: Timeline) -> ridge.Rows:
        onehot = labels(label_of[timeline.phoneme_at], lag, count, int(label_of[training.silence]))
        if stream is None:
            return ridge.Rows(onehot, np.zeros((timeline.frames, 0)))
        return ridge.Rows(onehot, shifted((stream.predict(timeline) - centre) / spread, wide))

    return rows


def _penalties(training: Training, of_class: bool, with_stream: bool) -> List[np.ndarray]:
    phone_set = training.phone_set
    labels_wide = len(window(training.fps)) * (len(phone_set.classes) if of_class else len(phone_set.phonemes))
    stream_wide = len(window(training.fps, max(1, round(SPACING * training.fps)))) * CHANNELS if with_stream else 0
    tried = itertools.product(LABEL_PENALTIES, STREAM_PENALTIES if with_stream else (1.0,))
    return [np.repeat([label, stream], [labels_wide, stream_wide]) for label, stream in tried]


def _fit(training: Training, of_class: bool, with_stream: bool) -> ridge.Linear:
    make: Callable[[Training], ridge.Design] = lambda part: _design(  # noqa: E731
        part, of_class, steps.fit(part, context=True) if with_stream else None
    )
    return ridge.fit(training, make, _penalties(training, of_class, with_stream))


def fit_phonemes(training: Training) -> ridge.Linear:
    """Phoneme labels within REACH."""
    return _fit(training, of_class=False, with_stream=False)


def fit_classes(training: Training) -> ridge.Linear:
    """Viseme-class labels within REACH, and the context-aware step stream of all channels."""
    return _fit(training, of_class=True, with_stream=True)
