"""The apex of a phoneme: the moment at which the envelope of its sound is largest (docs/method.md, Equation 1).

The envelope is the root mean square of the samples under a Hann window of `WINDOW` seconds, every `STEP` seconds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.errors import DataError, PathLike
from labial.files import wav

#: Seconds of the window: at least two periods of a low voice, so that the envelope does not follow glottal pulses.
WINDOW = 0.025
#: Seconds from one value of the envelope to the next.
STEP = 0.005


def envelope(samples: np.ndarray, rate: float) -> np.ndarray:
    """The envelope of samples (N,) at `rate` per second, (M,): value i is that of the time i * STEP seconds."""
    window = np.hanning(max(round(WINDOW * rate), 1) + 2)[1:-1]
    power = np.convolve(np.square(samples, dtype=np.float64), window / window.sum(), mode="same")
    at = np.round(np.arange(0.0, len(samples) / rate, STEP) * rate).astype(np.int64)
    return np.sqrt(power[at[at < len(samples)]])


def with_apexes(segments: Sequence[Segment], samples: np.ndarray, rate: float) -> Tuple[Segment, ...]:
    """The segments with their apexes in a sound, (N,) samples at `rate` per second from time 0. A segment keeps its own
    apex; one without sound, or with constant sound, gets none."""
    loudness = envelope(samples, rate)
    times = np.arange(len(loudness)) * STEP
    result = []
    for segment in segments:
        inside = np.flatnonzero((times >= segment.start) & (times < segment.end))
        if segment.apex is None and len(inside) and np.ptp(loudness[inside]) > 0:
            segment = replace(segment, apex=float(times[inside[np.argmax(loudness[inside])]]))
        result.append(segment)
    return tuple(result)


def read_wave(path: PathLike) -> Tuple[np.ndarray, int]:
    """The mean (N,) of the channels of a WAV file of 16 bits, and its rate. Raises DataError for any other file."""
    try:
        with open(path, "rb") as file, wav.Sound(file) as sound:
            if sound.getsampwidth() != 2:
                raise DataError(path, None, f"samples of {8 * sound.getsampwidth()} bits, not of 16")
            data, size = b"".join(wav.blocks(sound)), 2 * sound.getnchannels()
            samples = np.frombuffer(data[: len(data) // size * size], "<i2")
            return samples.reshape(-1, sound.getnchannels()).mean(axis=1), sound.getframerate()
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    except wav.ERRORS as error:
        raise DataError(path, None, f"not a WAV file that can be read: {error or 'it ends too early'}") from None


def told(segments: Sequence[Segment]) -> int:
    """The number of segments that have an apex."""
    return sum(segment.apex is not None for segment in segments)
