"""What most talking things do today, to compare hearing with: a mouth that opens with the loudness of the sound.

Both know the loudness of the whole sound in advance and so are at their best; a device would have to guess it.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from labial.corpus.phonesets import SPEECH
from labial.hearing.features import FRAME, RATE, frames_of
from labial.hearing.targets import closure, frames

#: dB below the loud frames' level at which the mouth is shut.
_RANGE = 30.0
#: Crossings of zero per second from and to which a sound counts as a fricative, and how far the mouth is open in one.
_CROSSINGS, _FRICATIVE = (3000.0, 5000.0), 0.3
#: The share of a new frame's loudness in what the mouth follows.
_FOLLOWS = 0.7


@cache
def _open_pose() -> np.ndarray:
    """(13,) FAP units: the middle of a long AA."""
    result: np.ndarray = frames([(SPEECH.silence, 200), ("AA", 400)], 30)[20]
    return result


@cache
def _shut_pose() -> np.ndarray:
    return closure().pose


def _pieces(sound: np.ndarray) -> np.ndarray:
    count = frames_of(len(sound))
    return np.pad(np.asarray(sound, np.float64), (0, count * FRAME - len(sound))).reshape(count, FRAME)


def levels(sound: np.ndarray) -> np.ndarray:
    """(T,) dB: the level of each frame of an int16 sound."""
    result: np.ndarray = 10 * np.log10(np.square(_pieces(sound)).mean(axis=1) + 1.0)
    return result


def shares(level: np.ndarray) -> np.ndarray:
    """(T,) 0 .. 1: the loudness of frames whose levels are (T,) dB, from `_RANGE` dB below the loud ones up to them."""
    if not len(level):
        return np.zeros(0)
    found: np.ndarray = np.clip((level - np.percentile(level, 95)) / _RANGE + 1.0, 0.0, 1.0)
    smooth: np.ndarray = np.empty_like(found)
    last = 0.0
    for k, value in enumerate(found):
        last += _FOLLOWS * (value - last)
        smooth[k] = last
    return smooth


def crossings(sound: np.ndarray) -> np.ndarray:
    """(T,) how often a second each frame changes its sign."""
    signs: np.ndarray = np.signbit(_pieces(sound))
    result: np.ndarray = (signs[:, 1:] != signs[:, :-1]).sum(axis=1) * (RATE / FRAME)
    return result


def loudness(sound: np.ndarray) -> np.ndarray:
    """(T, 13) FAP units: between closed lips and an open mouth by loudness."""
    return loudness_of(levels(sound))


def loudness_of(level: np.ndarray) -> np.ndarray:
    """The same for frames whose levels are (T,) dB."""
    return _pose(shares(level))


def loudness_and_crossings(sound: np.ndarray) -> np.ndarray:
    """The same, but nearly shut where many crossings of zero tell a fricative."""
    low, high = _CROSSINGS
    fricative = np.clip((crossings(sound) - low) / (high - low), 0.0, 1.0)
    return _pose(shares(levels(sound)) * (1 - (1 - _FRICATIVE) * fricative))


def _pose(share: np.ndarray) -> np.ndarray:
    shut = _shut_pose()
    result: np.ndarray = shut + share[:, None] * (_open_pose() - shut)
    return result
