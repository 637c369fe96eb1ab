"""Baselines that regress motion on features of the timeline, such as the labels in a window around each frame."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_matrix, diags, hstack, vstack

from labial.evaluate.baselines import steps
from labial.evaluate.material import Timeline, Utterance
from labial.evaluate.training import Predictor, Training, choose
from labial.files.faps import CHANNELS
from labial.train.recordings import neighbour_classes

#: Weight of a frame of silence, which is not judged: enough to keep the mouth at rest in pauses.
SILENCE_WEIGHT = 0.1


@dataclass(frozen=True)
class Rows:
    """Features of T frames: sparse ones (T, K1), then dense ones (T, K2)."""

    sparse: csr_matrix
    dense: np.ndarray

    def __matmul__(self, weights: np.ndarray) -> np.ndarray:
        """(T, 13) for weights (K1 + K2, 13)."""
        count = self.sparse.shape[1]
        return self.sparse @ weights[:count] + self.dense @ weights[count:]


Design = Callable[[Timeline], Rows]


#: Normal equations of K features: (K, K) and (K, 13).
Normal = Tuple[np.ndarray, np.ndarray]


def normal(design: Design, utterances: Sequence[Utterance], base: np.ndarray, silence: int) -> Normal:
    """The weighted normal equations of the human motion less `base` (13,)."""
    rows = [design(item.timeline) for item in utterances]
    sparse, dense = vstack([row.sparse for row in rows]).tocsr(), np.concatenate([row.dense for row in rows])
    weight = np.where(np.concatenate([item.timeline.phoneme_at for item in utterances]) == silence, SILENCE_WEIGHT, 1.0)
    motion = np.concatenate([item.human for item in utterances]) - base
    weighted = (diags(weight) @ sparse).T.tocsr()
    heavy = dense * weight[:, None]
    mixed = weighted @ dense
    gram = np.block([[(weighted @ sparse).toarray(), mixed], [mixed.T, heavy.T @ dense]])
    return gram, np.concatenate([weighted @ motion, heavy.T @ motion])


def solve(equations: Normal, penalty: np.ndarray) -> np.ndarray:
    """(K, 13) weights of least squared error plus penalty (K,) times their squares."""
    gram, cross = equations
    return cho_solve(cho_factor(gram + np.diag(penalty)), cross)


def _mean(training: Training) -> np.ndarray:
    """(13,) FAP: the mean of the training frames outside silence."""
    frames = [item.human[item.timeline.phoneme_at != training.silence] for item in training.utterances]
    return np.concatenate(frames).mean(axis=0)


def fit_ridge(training: Training, make_design: Callable[[Training], Design],
              penalties: Sequence[np.ndarray]) -> Predictor:
    """Motion that is linear in the features. Chooses among `penalties`, each (K,), on the inner validation part, then
    fits on the whole training part. `make_design` computes the features of a part, since they may be trained, too."""
    base = _mean(training)

    def prepare(part: Training) -> Callable[[np.ndarray], Predictor]:
        design = make_design(part)
        equations = normal(design, part.utterances, base, training.silence)
        known: Dict[int, Rows] = {}  # features of the utterances that every penalty is tried on

        def rows(timeline: Timeline) -> Rows:
            if id(timeline) not in known:
                known[id(timeline)] = design(timeline)
            return known[id(timeline)]

        def predict_with(penalty: np.ndarray) -> Predictor:
            weights = solve(equations, penalty)
            return lambda timeline: base + rows(timeline) @ weights

        return predict_with

    penalty = choose(training, penalties, prepare)
    design = make_design(training)
    weights = solve(normal(design, training.utterances, base, training.silence), penalty)
    return lambda timeline: base + design(timeline) @ weights


def fit_mean(training: Training) -> Predictor:
    """A mouth that does not move: the mean of the training frames outside silence, for all frames."""
    shape = _mean(training)
    return lambda timeline: np.tile(shape, (timeline.frames, 1))


#: Penalties that are tried, frames.
REGRESSION_PENALTIES = (0.1, 1.0, 10.0, 100.0)


def _onehot(label: np.ndarray, count: int, value: np.ndarray) -> csr_matrix:
    """(T, count) with `value` (T,) in the column of `label` (T,)."""
    return csr_matrix((value, label, np.arange(len(label) + 1)), shape=(len(label), count))


def _design_of_neighbours(training: Training) -> Design:
    viseme_class = np.array(training.phone_set.viseme_class, dtype=np.int64)
    phonemes, classes, silence = len(viseme_class), len(training.phone_set.classes), training.silence

    def rows(timeline: Timeline) -> Rows:
        held = timeline.held
        length = timeline.length[held]
        phoneme = timeline.phoneme[held]
        before, after = (np.repeat(item, length) for item in neighbour_classes(phoneme, viseme_class, silence))
        into = np.arange(timeline.frames) + 0.5 - np.repeat(timeline.start[held], length)
        position = into / np.repeat(length, length)
        seconds = np.repeat(timeline.milliseconds[held] / 1000.0, length)
        duration = np.log(np.clip(seconds, 0.02, 1.0) / 0.1)
        blocks: List[csr_matrix] = []
        for course in (np.ones_like(position), position - 0.5):
            blocks += [_onehot(timeline.phoneme_at, phonemes, course),
                       _onehot(timeline.phoneme_at, phonemes, course * duration), _onehot(before, classes, course),
                       _onehot(after, classes, course)]
        return Rows(hstack(blocks).tocsr(), np.zeros((timeline.frames, 0)))

    return rows


def fit_regression(training: Training) -> Predictor:
    """Linear regression from the phoneme, its neighbours' classes and its duration; chooses the penalty on the inner
    validation part. Each feature may also change along the phoneme: the design has it once unchanged and once times the
    frame's relative position, so that motion need not be a step."""
    count = 2 * 2 * (len(training.phone_set.phonemes) + len(training.phone_set.classes))
    return fit_ridge(training, _design_of_neighbours, [np.full(count, penalty) for penalty in REGRESSION_PENALTIES])


# ---- A window of labels ----------------------------------------------------------------------------------------------

# On phoneme labels; or on viseme-class labels together with the context-aware step stream of all channels. Without
# shapes, states and trajectories, they show what additive temporal kernels achieve alone.

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
    return stream[np.clip(np.arange(len(stream))[:, None] + lag[None, :], 0, len(stream) - 1)].reshape(len(stream), -1)


def _design_of_window(training: Training, stream: Optional[steps.Steps]) -> Design:
    viseme_class = np.array(training.phone_set.viseme_class, dtype=np.int64)
    label_of = np.arange(len(viseme_class)) if stream is None else viseme_class
    lag = window(training.fps)
    wide = window(training.fps, max(1, round(SPACING * training.fps)))
    count = int(label_of.max()) + 1
    if stream is not None:
        moving = np.concatenate([stream(item.timeline) for item in training.utterances])
        centre, spread = moving.mean(axis=0), np.maximum(moving.std(axis=0), 1e-9)

    def rows(timeline: Timeline) -> Rows:
        onehot = labels(label_of[timeline.phoneme_at], lag, count, int(label_of[training.silence]))
        if stream is None:
            return Rows(onehot, np.zeros((timeline.frames, 0)))
        return Rows(onehot, shifted((stream(timeline) - centre) / spread, wide))

    return rows


def fit_phonemes(training: Training) -> Predictor:
    """Phoneme labels within REACH."""
    wide = len(window(training.fps)) * len(training.phone_set.phonemes)
    return fit_ridge(training, lambda part: _design_of_window(part, None),
                     [np.full(wide, penalty) for penalty in LABEL_PENALTIES])


def fit_classes(training: Training) -> Predictor:
    """Viseme-class labels within REACH, and the context-aware step stream of all channels."""
    wide = (len(window(training.fps)) * len(training.phone_set.classes),
            len(window(training.fps, max(1, round(SPACING * training.fps)))) * CHANNELS)
    return fit_ridge(training, lambda part: _design_of_window(part, steps.fit(part, context=True)),
                     [np.repeat(penalties, wide) for penalties in itertools.product(LABEL_PENALTIES, STREAM_PENALTIES)])
