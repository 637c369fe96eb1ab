"""The number formats of the exported tables (``include/labial/model.h``) and the library's integer helpers."""

from __future__ import annotations

import numpy as np

#: Costs are 1/32 nat.
COST_SCALE = 32
#: Positions are 1/16 FAP unit, at most this far from the channel's centre.
POSITION_SCALE = 16
POSITION_MAX = 16383
NO_FLOOR = -16384
#: LABIAL_CONTACT_FRAMES: a shorter phoneme in contact borrows frames from its neighbours.
CONTACT_FRAMES = 3
#: Bounds of equation 3, per channel: the largest diagonal element; the least hold of a frame; the largest ratio of a #:
#: state's delta-delta weight to its hold; and how far, in positions, delta means may pull the frame of least hold.
WEIGHT_SUM_MAX = 16383
WEIGHT_MIN = 8
STIFFNESS_MAX = 16
PULL_MAX = 65535
#: The largest z, Q6, of a duration and of an emission; beyond it a Gaussian's cost no longer grows.
DURATION_Z_MAX = 65535
EMISSION_Z_MAX = 1023
#: The number of states that the search scores, around the one nearest to the target. Any of them can be entered from
#: the best one of the previous step at the highest cost of a transition, which is also the largest score above the
#: best.
SEARCHED = 8
LEAP = 255
#: Values of the 256 codes of the minifloat weight.
WEIGHTS = np.array([m if e == 0 else (16 + m) << (e - 1) for e in range(16) for m in range(16)], dtype=np.int64)


def weight_value(code: np.ndarray) -> np.ndarray:
    """int64: the weights of minifloat codes."""
    return WEIGHTS[np.asarray(code, dtype=np.int64)]


def weight_code(value: np.ndarray) -> np.ndarray:
    """uint8: the codes whose weights are nearest to the values, which must not be negative."""
    value = np.asarray(value, dtype=np.float64)
    above = np.clip(np.searchsorted(WEIGHTS, value), 1, 255)
    return np.where(value - WEIGHTS[above - 1] <= WEIGHTS[above] - value, above - 1, above).astype(np.uint8)


def weight_code_below(value: np.ndarray) -> np.ndarray:
    """uint8: the codes of the largest weights that do not exceed the values, which must not be negative."""
    return (np.searchsorted(WEIGHTS, value, side="right") - 1).astype(np.uint8)


def share_value(code: np.ndarray) -> np.ndarray:
    """int64: the values of the codes of a share in 256ths, 0 .. 256; only 128 has no code."""
    code = np.asarray(code, dtype=np.int64)
    return code + (code >> 7)


def share_code(share: np.ndarray) -> np.ndarray:
    """uint8: the codes nearest to shares, 0 .. 1."""
    parts = np.asarray(share, dtype=np.float64) * 256.0
    nearest = np.rint(parts)
    return np.where(parts < 128.0, np.minimum(nearest, 127), np.maximum(nearest, 129) - 1).astype(np.uint8)


def gain(deviation: np.ndarray) -> np.ndarray:
    """int64: the gain of a standard deviation, 2^18 / (deviation sqrt 2), held to 1 .. 65535."""
    return np.clip(np.rint(2.0**18 / (np.asarray(deviation) * np.sqrt(2.0))), 1, 65535).astype(np.int64)


#: Values of the 256 codes of a short gain.
SHORT_GAINS = np.array([(16 + code % 16) * 2.0 ** (12 - code // 16) for code in range(256)])


def short_gain_code(deviation: np.ndarray) -> np.ndarray:
    """int64: the codes of the short gains nearest to those of standard deviations."""
    wanted = 2.0**18 / (np.asarray(deviation, dtype=np.float64) * np.sqrt(2.0))
    order = np.argsort(SHORT_GAINS)
    above = np.clip(np.searchsorted(SHORT_GAINS[order], wanted), 1, 255)
    below, up = SHORT_GAINS[order][above - 1], SHORT_GAINS[order][above]
    return order[np.where(wanted - below <= up - wanted, above - 1, above)].astype(np.int64)


def short_gain_z(distance: np.ndarray, code: np.ndarray) -> np.ndarray:
    """z in Q6 of distances, int64, by the codes of their short gains."""
    return (distance * (16 + (code & 15))) >> (code >> 4)


def z_cost(z: np.ndarray) -> np.ndarray:
    """A Gaussian's exponent z^2 as a cost."""
    return (z * z) >> 7


def rounded_shift(value: np.ndarray, shift: int) -> np.ndarray:
    """value / 2^shift, rounded to the nearest, halves up."""
    return (value + (1 << (shift - 1))) >> shift
