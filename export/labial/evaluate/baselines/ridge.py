"""Ridge regression of motion on features of the timeline, shared by the regression baselines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Dict, Sequence

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_matrix, diags, vstack

from labial.evaluate.material import Timeline, Utterance
from labial.evaluate.training import Training, choose

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
        result: np.ndarray = self.sparse @ weights[:count] + self.dense @ weights[count:]
        return result


Design = Callable[[Timeline], Rows]


@dataclass(frozen=True)
class Normal:
    """Normal equations of K features: `gram` (K, K) and `cross` (K, 13)."""

    gram: np.ndarray
    cross: np.ndarray


def normal(design: Design, utterances: Sequence[Utterance], base: np.ndarray, silence: int) -> Normal:
    """The weighted normal equations of the human motion less `base` (13,)."""
    rows = [design(item.timeline) for item in utterances]
    sparse, dense = vstack([row.sparse for row in rows]).tocsr(), np.concatenate([row.dense for row in rows])
    phoneme_at = np.concatenate([item.timeline.phoneme_at for item in utterances])
    weight = np.where(phoneme_at == silence, SILENCE_WEIGHT, 1.0)
    motion = np.concatenate([item.human for item in utterances]) - base
    weighted = (diags(weight) @ sparse).T.tocsr()
    heavy = dense * weight[:, None]
    mixed = weighted @ dense
    gram = np.block([[(weighted @ sparse).toarray(), mixed], [mixed.T, heavy.T @ dense]])
    return Normal(gram, np.concatenate([weighted @ motion, heavy.T @ motion]))


def solve(equations: Normal, penalty: np.ndarray) -> np.ndarray:
    """(K, 13) weights of least squared error plus penalty (K,) times their squares."""
    result: np.ndarray = cho_solve(cho_factor(equations.gram + np.diag(penalty)), equations.cross)
    return result


@dataclass(frozen=True)
class Linear:
    """Motion that is linear in the features."""

    design: Design
    base: np.ndarray  #: (13,) FAP
    weights: np.ndarray  #: (K, 13)

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13)."""
        result: np.ndarray = self.base + self.design(timeline) @ self.weights
        return result


def fit(
    training: Training, make_design: Callable[[Training], Design], penalties: Sequence[np.ndarray]
) -> Linear:
    """Chooses among `penalties`, each (K,), on the inner validation part, then fits on the whole training part.

    `make_design` computes the features of a part, since they may be trained, too.
    """
    frames = [item.human[item.timeline.phoneme_at != training.silence] for item in training.utterances]
    base = np.concatenate(frames).mean(axis=0)

    def prepare(part: Training) -> Callable[..., Any]:
        rough = make_design(part)
        equations = normal(rough, part.utterances, base, training.silence)
        known: Dict[int, Rows] = {}  # features of the utterances that every penalty is tried on

        def rows(timeline: Timeline) -> Rows:
            if id(timeline) not in known:
                known[id(timeline)] = rough(timeline)
            return known[id(timeline)]

        def predict_with(penalty: np.ndarray) -> Callable[..., Any]:
            weights = solve(equations, penalty)
            return lambda timeline: base + rows(timeline) @ weights

        return predict_with

    penalty = choose(training, penalties, prepare)
    design = make_design(training)
    return Linear(design, base, solve(normal(design, training.utterances, base, training.silence), penalty))
