"""The front end of hearing: sound to log energies of bands of the mel scale, relative to the level of the voice.

``lib/hear_features.c`` computes the same in integers. Both are causal: features of a hop depend on the samples up to
its end alone.

- A window of 256 samples, Hann's, ends with each hop of 160. The window is the periodic one: an offset reaches only the
  bins up to 62.5 Hz, of which no band has a share. Before its first sample and behind its last one, a sound stays at
  these, so that an offset does not sound at its ends either.
- The energies |X|^2 of the bins add up to those of `BANDS` bands, triangles that are evenly spaced on the mel scale.
  Samples count as int16, so that full scale is 32768.
- The level is the mean of the bands' log2 energies. It follows a rise at once and falls by `DECAY` for each hop, but
  not below `LEVEL_LEAST`. A feature is the band's log2 energy relative to the level, limited to `RANGE`.
- A sound begins at a level that speech has, `LEVEL_BEGIN` where none is known, and waits for a voice: the level stays
  until a hop comes within `NEAR_LEVEL` of it, or is `RISE` above the quietest hops so far, of which the louder of two
  neighbours counts. Then the level falls by `SEARCH` for each hop until one reaches it. So the noise before the first
  word does not count as a voice, and a quiet voice is found soon.

An energy below `FLOOR` counts as that, which is `RANGE` below the least level. So digital silence has the lowest
features at any time, and speech whose peaks are within 40 dB of full scale has the same features at any gain.
"""

from __future__ import annotations

from typing import List

import numpy as np

from labial.hearing.convert import extended

#: Samples per second of the sound that the network hears.
RATE = 16000
#: Samples of a window, from one window to the next, and of a frame, which has two hops.
WINDOW = 256
HOP = 160
HOPS = 2
FRAME = HOPS * HOP
#: Bands, and the ends of the lowest and the highest triangle, Hz.
BANDS = 24
LOWEST, HIGHEST = 120.0, 7600.0
#: log2 energies: the least; the least level; by how much the level falls for each hop (2.4 dB a second).
FLOOR = 1.0
LEVEL_LEAST = 13.0
DECAY = 0.008
#: log2 energies: the level before any sound; by how much it falls for each hop until a hop reaches it; how far below
#: it, or above the noise, a hop is that begins a voice. Chosen on clips that the bundled networks learned, with noise
#: 40 dB below the voice and without, at peaks of -6, -24 and -40 dB.
LEVEL_BEGIN = 26.0
SEARCH = 0.03
NEAR_LEVEL, RISE = 4.0, 3.0
#: The least and the largest log2 energy relative to the level, and the feature of each: (value + OFFSET) / SCALE.
RANGE = (-12.0, 8.0)
OFFSET, SCALE = 3.0, 4.0


def mel(frequency: np.ndarray) -> np.ndarray:
    """Mels of frequencies in Hz."""
    return 1127.0 * np.log1p(np.asarray(frequency, dtype=np.float64) / 700.0)


def places() -> np.ndarray:
    """(129,) where each bin lies between the bands' edges: 0 is the lower end of band 0, 1 its peak, 2 its end."""
    ends = mel(np.array([LOWEST, HIGHEST]))
    return (mel(np.arange(WINDOW // 2 + 1) * (RATE / WINDOW)) - ends[0]) / (ends[1] - ends[0]) * (BANDS + 1)


def triangles() -> np.ndarray:
    """(129, 24) the share of each bin's energy in each band."""
    return np.maximum(1.0 - np.abs(places()[:, None] - np.arange(1, BANDS + 1)), 0.0)


def frames_of(samples: int) -> int:
    """Frames that so many samples at `RATE` fill; the last one may be filled in part."""
    return -(-samples // FRAME)


#: Hops that are transformed at once.
_BLOCK = 4096


def log_energies(sound: np.ndarray) -> np.ndarray:
    """(2 T, 24) float32 log2 energies of the bands in each hop of a sound: (N,) samples at `RATE`, int16 or floats of
    the same scale. Its first sample precedes it and its last one fills its last frame: T is `frames_of(N)`."""
    sound = np.asarray(sound)
    count = HOPS * frames_of(len(sound))
    before = WINDOW - HOP
    padded = extended(sound.astype(np.float32), before, count * HOP - len(sound))
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(WINDOW) / WINDOW)
    shape, weights = window.astype(np.float32), triangles().astype(np.float32)
    rows: List[np.ndarray] = [np.zeros((0, BANDS), dtype=np.float32)]
    for first in range(0, count, _BLOCK):
        at = np.arange(first, min(first + _BLOCK, count))[:, None] * HOP + np.arange(WINDOW)
        power = np.abs(np.fft.rfft(padded[at] * shape, axis=1)) ** 2
        rows.append(np.log2(np.maximum(power @ weights, 2.0**FLOOR)).astype(np.float32))
    return np.concatenate(rows)


def levels(energies: np.ndarray, begin: float = LEVEL_BEGIN) -> np.ndarray:
    """(n,) the level in each hop of a sound's log2 energies (n, 24). A hop counts as sound unless it is digital
    silence; the library also calls steps of 32 silence."""
    mean = np.asarray(energies, dtype=np.float64).mean(axis=-1)
    level, waiting, fall = begin, True, SEARCH
    quietest, before = np.inf, np.inf
    result = np.empty(len(mean))
    for k, now in enumerate(mean.tolist()):
        sounds = now > FLOOR + 0.5
        if waiting and sounds:
            quietest = min(quietest, max(before, now))
            waiting = now <= level - NEAR_LEVEL and now <= quietest + RISE
        before = now if sounds else np.inf
        if not waiting:
            level = max(level - fall, LEVEL_LEAST)
        if now >= level:
            level, waiting, fall = now, False, DECAY
        result[k] = level
    return result


def crop_levels(energies: np.ndarray) -> np.ndarray:
    """(..., n) the level in each hop of log2 energies (..., n, 24) that are cut out of sounds: nothing is known of what
    was before."""
    mean = np.asarray(energies, dtype=np.float64).mean(axis=-1)
    fallen = DECAY * np.arange(mean.shape[-1])
    return np.maximum(np.maximum.accumulate(mean + fallen, axis=-1) - fallen, LEVEL_LEAST)


def normalise(energies: np.ndarray) -> np.ndarray:
    """Features of a sound's log2 energies (n, 24), of the same shape, float32, -2.25 .. 2.75."""
    return relative_to(levels(energies), energies)


def normalise_crops(energies: np.ndarray) -> np.ndarray:
    """The same of crops (..., n, 24), which begin within sounds."""
    return relative_to(crop_levels(energies), energies)


def relative_to(level: np.ndarray, energies: np.ndarray) -> np.ndarray:
    """Features of log2 energies (..., n, 24) at levels (..., n)."""
    return ((np.clip(energies - level[..., None], *RANGE) + OFFSET) / SCALE).astype(np.float32)


def features(sound: np.ndarray) -> np.ndarray:
    """(T, 48) float32, what the network hears of a sound: a row for each frame, the features of its two hops."""
    return normalise(log_energies(sound)).reshape(frames_of(len(sound)), HOPS * BANDS)
