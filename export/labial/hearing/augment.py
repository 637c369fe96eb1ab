"""What a batch of log energies goes through before the network hears it: other voices, channels and noise, drawn anew
for each batch. Arrays are (B, n, 24), log2 energies as of :func:`labial.hearing.features.log_energies`.
"""

from __future__ import annotations

import numpy as np

from labial.hearing.features import BANDS, FLOOR, HIGHEST, LOWEST, RATE, log_energies, mel

#: Share of the crops whose bands are warped, from and to which factor: voices of other sizes.
WARPED, WARPS = 0.6, (0.87, 1.15)
#: Share of the crops under noise, and its ratio to the speech, dB.
NOISY, RATIOS = 0.85, (0.0, 48.0)
#: Share of the crops of which a few bands, or all above some band, are missing.
DROPPED, CUT = 0.25, 0.1
#: Octaves of level in the three waves of a random equaliser, and of gain.
_EQUALISER, _GAIN = 1.2, 2.0

#: Mels of the bands' peaks, and their octaves relative to the lowest.
_PEAKS = np.linspace(mel(np.array(LOWEST)), mel(np.array(HIGHEST)), BANDS + 2)[1:-1]
_OCTAVES = np.log2(700.0 * np.expm1(_PEAKS / 1127.0) / (700.0 * np.expm1(_PEAKS[0] / 1127.0)))


def white(seconds: float, random: np.random.Generator) -> np.ndarray:
    """(n, 24) float32 log2 energies of white noise, relative to the mean energy of all bands together."""
    noise = log_energies(random.normal(scale=1000.0, size=round(seconds * RATE)))[2:]
    result: np.ndarray = noise - np.log2(np.exp2(noise).mean())
    return result


def power(energies: np.ndarray) -> np.ndarray:
    """(B, 1, 1) log2 of the mean energy of each crop."""
    result: np.ndarray = np.log2(np.exp2(energies).mean(axis=(1, 2), keepdims=True))
    return result


def mixed(energies: np.ndarray, noise: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Crops with `noise`, (B, n, 24) of any level, added at `ratio` (B,) dB below the crops' mean energy."""
    level = power(energies) - power(noise) - np.asarray(ratio)[:, None, None] * (np.log2(10.0) / 10.0)
    result: np.ndarray = np.log2(np.exp2(energies) + np.exp2(noise + level.astype(np.float32)))
    return result


def warped(energies: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Crops whose band k has the energy of band k * factor, `factor` (B,), between bands linearly."""
    at = np.clip(np.arange(BANDS) * factor[:, None], 0, BANDS - 1)
    share = np.maximum(1 - np.abs(np.arange(BANDS)[:, None] - at[:, None, :]), 0)  # of each band in each new one
    result: np.ndarray = energies @ share.astype(np.float32)
    return result


def noises(count: int, length: int, pool: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(count, length, 24) noises of several colours, from a pool of :func:`white`: white to twice as steep as pink,
    with random bands; some are hum alone, some swell."""
    starts = random.integers(len(pool) - length, size=count)
    found = pool[starts[:, None] + np.arange(length)]
    slope = random.choice([0.0, 1.0], size=count, p=[0.4, 0.6]) * random.uniform(0.0, 2.0, size=count)
    colour = -slope[:, None] * _OCTAVES + random.normal(scale=0.5, size=(count, BANDS))
    hums = random.random(count) < 0.08
    colour[hums] -= 2.5 * np.maximum(np.arange(BANDS) - random.integers(1, 4, size=(int(hums.sum()), 1)), 0)
    time = np.arange(length) / 100.0
    rate, phase = random.uniform(0.1, 3.0, size=(count, 1)), random.uniform(0, 2 * np.pi, size=(count, 1))
    depth = random.uniform(0.0, 2.5, size=(count, 1)) * (random.random((count, 1)) < 0.3)
    swell = depth * np.sin(2 * np.pi * rate * time + phase)
    result: np.ndarray = found + colour[:, None, :].astype(np.float32) + swell[:, :, None].astype(np.float32)
    return result


def augmented(energies: np.ndarray, pool: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(B, n, 24) float32: `energies` after everything above, not below the floor."""
    count, length = energies.shape[:2]
    found = np.asarray(energies, dtype=np.float32)
    silent = found <= FLOOR + 0.01  # digital silence stays silent whatever the channel does
    factor = np.where(random.random(count) < WARPED, random.uniform(*WARPS, size=count), 1.0)
    found = warped(found, factor)
    place = np.linspace(0.0, 1.0, BANDS)
    shape = random.normal(scale=_GAIN, size=(count, 1)) + np.zeros(BANDS)
    for k in range(1, 4):
        phase = random.uniform(0, 2 * np.pi, size=(count, 1))
        shape += random.normal(size=(count, 1)) * _EQUALISER / k * np.cos(np.pi * k * place + phase)
    dropped = random.random((count, 1)) < DROPPED
    first, width = random.integers(BANDS, size=(count, 1)), random.integers(1, 4, size=(count, 1))
    within = (np.arange(BANDS) >= first) & (np.arange(BANDS) < first + width)
    shape -= np.where(within & dropped, random.uniform(2, 14, size=(count, 1)), 0.0)
    edge = np.where(random.random((count, 1)) < CUT, random.integers(16, BANDS, size=(count, 1)), BANDS)
    shape -= np.where(np.arange(BANDS) >= edge, 16.0, 0.0)
    found = np.where(silent, FLOOR, found + shape[:, None, :].astype(np.float32))
    noisy = np.flatnonzero(random.random(count) < NOISY)
    if len(noisy):
        ratio = random.uniform(*RATIOS, size=len(noisy))
        found[noisy] = mixed(found[noisy], noises(len(ratio), length, pool, random), ratio)
    result: np.ndarray = np.maximum(found, FLOOR).astype(np.float32)
    return result
