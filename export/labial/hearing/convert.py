"""The conversion of a sound to 16 kHz: a windowed sinc, whose samples lie on a fine grid.

``lib/hear_convert.c`` computes the same in integers, sample by sample. The grid has 16 points for each sample of 48 or
44.1 kHz. Between two samples of the sound there are `stride` / 10 points, between two converted samples `step` / 10; a
converted sample is moved to the nearest point. For rates below 16 kHz the filter is wider, by the distance of its
points, so that no image of the sound remains above the half of its rate.
"""

from __future__ import annotations

from typing import Dict, NamedTuple

import numpy as np


class Rate(NamedTuple):
    """How a rate is converted."""

    stride: int  #: tenths of a grid point between two samples of the sound
    step: int  #: and between two converted samples

    @property
    def reach(self) -> int:
        """Samples of the sound on either side that the filter takes."""
        return -(-POINTS * 10 // self.stride)


#: Rates, samples per second; 16000 needs none.
RATES: Dict[int, Rate] = {
    8000: Rate(480, 240), 12000: Rate(480, 360), 16000: Rate(480, 480), 22050: Rate(320, 441), 24000: Rate(320, 480),
    32000: Rate(240, 480), 44100: Rate(160, 441), 48000: Rate(160, 480),
}
#: Grid points of either half of the filter, and those after it that a sample may fall on, which are zero.
POINTS, BEYOND = 256, 33
#: The filter's cut-off at 48 kHz, Hz (at half the amplitude), and the shape of its window (Kaiser's).
CUTOFF, BETA = 7800.0, 4.5
#: Grid points for each sample of 48 kHz.
FINE = 16


def taps() -> np.ndarray:
    """(289,) the filter from its middle on. Those at distances of 16 points, on both sides, add up to one, wherever
    they begin; those of the wider spacings do so in proportion. So a constant stays one."""
    at = np.arange(1 - POINTS, POINTS)
    window = np.i0(BETA * np.sqrt(1.0 - (at / POINTS) ** 2)) / np.i0(BETA)
    width = 2 * CUTOFF / (48000 * FINE)
    whole = width * np.sinc(width * at) * window
    for _ in range(20):
        for spacing in (48, 32):  # those of 24 and 16 are sums of these
            for first in range(spacing):
                whole[first::spacing] *= FINE / spacing / whole[first::spacing].sum()
    return np.pad(whole[POINTS - 1 :], (0, BEYOND))


def extended(sound: np.ndarray, before: int, after: int) -> np.ndarray:
    """A sound (N,) whose first sample stays for `before` samples before it, and the last one for `after` behind it, so
    that an offset has no step at its ends. Zeros where there is no sample."""
    return np.pad(sound, (before, after), mode="edge" if len(sound) else "constant")


def converted_count(samples: int, rate: int) -> int:
    """Samples at 16 kHz of so many samples at `rate`: those that lie before the end of the last one."""
    stride, step = RATES[rate]
    return -(-samples * stride // step)


def convert(sound: np.ndarray, rate: int) -> np.ndarray:
    """(M,) float64, a sound (N,) at `rate` as one at 16 kHz, without limits; before it and after it, its first and its
    last sample stay (:func:`extended`). Raises KeyError for a rate that is not one of `RATES`."""
    sound = np.asarray(sound, dtype=np.float64)
    way = RATES[rate]
    if way.stride == way.step:
        return sound
    place = np.arange(converted_count(len(sound), rate)) * way.step
    left, rest = np.divmod(place, way.stride)
    filter_, spacing = taps(), way.stride // 10
    padded = extended(sound, way.reach, way.reach)
    result = np.zeros(len(place))
    distance = (rest + 5) // 10
    for k in range(way.reach):
        result += padded[left + way.reach - k] * filter_[distance + k * spacing]
        result += padded[left + way.reach + 1 + k] * filter_[spacing - distance + k * spacing]
    return result * (way.stride / (10 * FINE))


def mixed(sound: np.ndarray) -> np.ndarray:
    """(N,) int64, a sound (N,) or (N, 2) of int16 as one channel, rounded down."""
    sound = np.asarray(sound, dtype=np.int64)
    return sound if sound.ndim == 1 else (sound[:, 0] + sound[:, 1]) >> 1
