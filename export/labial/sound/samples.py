"""Converts sounds of any format, rate and number of channels for the recogniser: 16 bits, 16 kHz, one channel."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import List, Tuple

import numpy as np
import soundfile
import soxr

from labial.corpus.formats import VIDEOS
from labial.errors import DataError, PathLike, needs
from labial.files import limits
from labial.files.frames import spans
from labial.files.wav import Phase

#: Samples per second of the recogniser's models.
RATE = 16000
#: The level that speech is scaled to, in dB of full scale, and that of the added noise. Synthetic speech is digitally
#: silent in its pauses, which the models, trained on microphones, do not know.
SPEECH_LEVEL, NOISE_LEVEL = -20.0, -55.0
#: Seconds that are read at once, and the most numbers that are.
_BLOCK, _NUMBERS = 10, 4_000_000


def read_sound(path: PathLike) -> np.ndarray:
    """A sound file's samples, (N,) float32 at `RATE`, the mean of its channels or, where they cancel each other, the
    first one; full scale is 1. For a video, if the package av is installed, its sound from the video's start on. Raises
    DataError for a file that is not a sound or is beyond :mod:`labial.files.limits`, for samples that are not finite
    and for a file without samples."""
    blocks: List[np.ndarray] = []
    try:
        with open(path, "rb") as file, soundfile.SoundFile(file) as sound:
            limit = limits.Samples(path, RATE)
            (low, high), rate = limits.SOUND_RATES, sound.samplerate
            if not low <= rate <= high:
                raise DataError(path, None, f"a rate of {rate:,} samples per second is not within {low:,} .. {high:,}")
            limits.refuse(path, "it has", sound.channels, limits.SOUND_CHANNELS, "channels")
            phase = Phase(path)
            resampler = soxr.ResampleStream(rate, RATE, 1, dtype="float32")
            while True:
                block = sound.read(min(_BLOCK * rate, _NUMBERS // sound.channels), dtype="float32", always_2d=True)
                last = len(block) == 0
                heard = block[:, 0] if phase.cancels(block, 1.0) else block.mean(axis=1)
                blocks.append(resampler.resample_chunk(heard, last=last))
                limit.add(len(blocks[-1]))
                if last:
                    break
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    except (RuntimeError, ValueError) as error:  # of either library
        named = Path(path).suffix.lower() in VIDEOS
        if named or importlib.util.find_spec("av") is not None:
            try:
                with needs(f"{path}: the sound of a video", "record"):
                    from labial.sound.video import sound as of_video
                return _checked(path, of_video(path, RATE))
            except DataError:
                if named:
                    raise
        problem = getattr(error, "error_string", str(error))
        raise DataError(path, None, f"not a sound that can be read: {' '.join(problem.split())}") from None
    return _checked(path, np.concatenate(blocks))


def _checked(path: PathLike, samples: np.ndarray) -> np.ndarray:
    if not np.isfinite(samples).all():
        raise DataError(path, None, "a sample is not finite")
    if not len(samples):
        raise DataError(path, None, "a sound without samples")
    limits.refuse(path, "a sample is", np.abs(samples).max(), limits.SOUND_PEAK, "times full scale")
    return samples


def prepared(samples: np.ndarray) -> np.ndarray:
    """(N,) int16: `samples` at `SPEECH_LEVEL`, with noise under them, the same for the same sound."""
    blocks = np.array_split(samples, range(_BLOCK * RATE, len(samples), _BLOCK * RATE))
    power = sum(float(np.dot(block, block)) for block in blocks) / len(samples)
    gain = 10 ** (SPEECH_LEVEL / 20) / np.sqrt(power) if power > 0 else 0.0
    rng = np.random.default_rng(0)
    noisy = (block * gain + rng.normal(0.0, 10 ** (NOISE_LEVEL / 20), len(block)) for block in blocks)
    return np.concatenate([np.clip(block * 32767, -32768, 32767).astype("<i2") for block in noisy])


def silences(samples: np.ndarray, rate: float = RATE) -> List[Tuple[float, float]]:
    """Begin and end, in seconds, of every run of 10 ms steps, `SHORTEST_SILENCE` or more, `DEPTH` dB below the level of
    the loudest twentieth."""
    hop = int(rate * _HOP)
    frames = samples[: len(samples) // hop * hop].reshape(-1, hop)
    if not len(frames):
        return []
    level = 10 * np.log10(np.einsum("ij,ij->i", frames, frames) / hop + _FLOOR)
    quiet = [(first * _HOP, end * _HOP) for first, end in spans(level < np.percentile(level, 95) - DEPTH)]
    return [(a, b) for a, b in quiet if b - a >= SHORTEST_SILENCE - 1e-9]


#: Seconds and dB of a silence.
SHORTEST_SILENCE, DEPTH = 0.08, 35.0
_HOP = 0.01
_FLOOR = 1e-9  # the power of -90 dB, which counts as silence
