"""FAP 17 as a function of the corners (docs/method.md, Protrusion): the lips protrude as far as the corners come in.

How far is an isotonic regression on the recordings that teach FAP 17, as a table with linear pieces. A model's corners
do not move as theirs do, but the table is asked for them: so it is stretched until the model protrudes its lips as far
as AMPLITUDE says.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Optional, Sequence, Tuple

import numpy as np
from scipy.optimize import brentq
from sklearn.isotonic import IsotonicRegression

from labial.tables.followers import CORNERS, FAP_17, FROM_CORNERS, VALUES, interpolated
from labial.tables.model import Model
from labial.train.expression import AMPLITUDE, chosen, motion_of
from labial.train.recordings import Recording
from labial.train.workers import Workers

#: Where the table explains less of FAP 17 than this correlation, that stays a channel.
LEAST = 0.85

#: The percentiles of the corners' mean that the table spans: beyond there are too few values to tell.
RANGE = (0.1, 99.9)

#: How far the table is stretched at most.
STRETCH = (0.5, 2.0)


def table(corners: np.ndarray, protrusion: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The range (2,) of the corners' mean and the values (17,) over it that fit `protrusion` (T,) best for `corners`
    (T,), all FAP; they fall all along."""
    ends = np.percentile(corners, RANGE)
    smooth = IsotonicRegression(increasing=False, out_of_bounds="clip").fit(corners, protrusion)
    place = np.clip((corners - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0) * (VALUES - 1)
    nearest = np.abs(place[:, None] - np.arange(VALUES))
    share = np.maximum(1.0 - nearest, 0.0)  # of each value in the interpolation
    count = share.sum(axis=0)
    prior = smooth.predict(np.linspace(ends[0], ends[1], VALUES))  # of values that next to nothing tells
    values = np.linalg.solve(share.T @ share + np.eye(VALUES), share.T @ smooth.predict(corners) + prior)
    values = IsotonicRegression(increasing=False).fit_transform(np.arange(VALUES), values, sample_weight=count + 1.0)
    return ends, values


def with_protrusion(model: Model, material: Sequence[Recording], workers: Workers) -> Model:
    """The model with FAP 17 computed of its corners, or as it is where `material` does not tell how."""
    needed = [FAP_17, *CORNERS]
    teaching = [item for item in material if (item.weights[:, needed] > 0).all(axis=1).any()]
    frames = [item.frames[(item.weights[:, needed] > 0).all(axis=1)] for item in teaching]
    if not frames:
        return model
    human = np.concatenate(frames)
    mean = human[:, CORNERS].mean(axis=1)
    if min(mean.std(), human[:, FAP_17].std()) < 1e-6:
        return model
    ends, values = table(mean, human[:, FAP_17])
    told = interpolated(human[:, CORNERS], ends, values)
    if not np.corrcoef(told, human[:, FAP_17])[0, 1] >= LEAST:
        return model
    own = _stretched(model, chosen(teaching), workers, ends, values)
    if own is None:
        return model
    source = model.source.copy()
    source[FAP_17] = FROM_CORNERS
    return replace(model, protrusion=np.round(values, 3), protrusion_range=np.round(own, 3), source=source)


def _stretched(model: Model, material: Sequence[Recording], workers: Workers, ends: np.ndarray,
               values: np.ndarray) -> Optional[np.ndarray]:
    """The range (2,) over which the model's FAP 17 moves by AMPLITUDE of the recordings', outside silence; it is
    stretched about the mean of the model's corners."""
    silence = model.phonemes.index(model.silence)
    learnt = np.concatenate([(item.phoneme_at() != silence) & (item.weights[:, FAP_17] > 0) for item in material])
    if not learnt.any():
        return None
    human = np.concatenate([item.frames[:, FAP_17] for item in material])[learnt]
    motion = workers.run("protrusion", motion_of, [(model, item) for item in material])
    made = np.concatenate(motion)[learnt][:, CORNERS]
    middle = made.mean()

    def excess(stretch: float) -> float:
        moved = interpolated(made, middle + (ends - middle) * stretch, values)
        return float(moved.std() - AMPLITUDE * human.std())

    low, high = (excess(stretch) for stretch in STRETCH)
    stretch = brentq(excess, *STRETCH) if low * high < 0 else STRETCH[int(abs(high) < abs(low))]
    result: np.ndarray = middle + (ends - middle) * stretch
    return result
