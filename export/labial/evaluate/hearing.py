"""``labial evaluate-hear``: lips from sound, compared with those that Labial makes of the true times of phonemes.

The figures are those of :mod:`labial.hearing.measures`. Sounds are folders of speech, as for ``labial train-hear``, and
sentences spoken by synthesisers. Each is also judged in conditions that degrade it, and beside what most
talking things do today: a mouth that opens with the loudness of the sound. Both such methods know the loudness of the
whole sound in advance and so are at their best; a device would have to guess it.
"""

from __future__ import annotations

import itertools
import zlib
from functools import cache
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import SPEECH
from labial.errors import PathLike
from labial.hearing import clips, distort, targets
from labial.hearing.features import FRAME, RATE, frames_of
from labial.hearing.integer import delivered
from labial.hearing.measures import Figures, Judged, delay, measured
from labial.hearing.model import HearingModel
from labial.hearing.network import hear
from labial.hearing.quantise import quantise
from labial.hearing.voices import speak

#: dB below the loud frames' level at which the mouth is shut.
_RANGE = 30.0
#: Crossings of zero per second from and to which a sound counts as a fricative, and how far the mouth is open in one.
_CROSSINGS, _FRICATIVE = (3000.0, 5000.0), 0.3
#: The share of a new frame's loudness in what the mouth follows.
_FOLLOWS = 0.7


@cache
def long_pose(phoneme: str) -> np.ndarray:
    """(13,) FAP units: the middle of a long phoneme."""
    return targets.frames([(SPEECH.silence, 200), (phoneme, 400)], 30)[20]


def _pieces(sound: np.ndarray) -> np.ndarray:
    count = frames_of(len(sound))
    return np.pad(np.asarray(sound, np.float64), (0, count * FRAME - len(sound))).reshape(count, FRAME)


def levels(sound: np.ndarray) -> np.ndarray:
    """(T,) dB: the level of each frame of an int16 sound."""
    return 10 * np.log10(np.square(_pieces(sound)).mean(axis=1) + 1.0)


def shares(level: np.ndarray) -> np.ndarray:
    """(T,) 0 .. 1: the loudness of frames whose levels are (T,) dB, from `_RANGE` dB below the loud ones up to them."""
    if not len(level):
        return np.zeros(0)
    found = np.clip((level - np.percentile(level, 95)) / _RANGE + 1.0, 0.0, 1.0)
    follow = itertools.accumulate(found, lambda last, value: last + _FOLLOWS * (value - last), initial=0.0)
    return np.fromiter(follow, float)[1:]


def crossings(sound: np.ndarray) -> np.ndarray:
    """(T,) how often a second each frame changes its sign."""
    signs: np.ndarray = np.signbit(_pieces(sound))
    return (signs[:, 1:] != signs[:, :-1]).sum(axis=1) * (RATE / FRAME)


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
    shut = targets.closure().pose
    return shut + share[:, None] * (long_pose("AA") - shut)


#: Sentences that no bundled network was trained on, which voices say here.
SENTENCES = Path(clips.__file__).with_name("sentences.txt")
#: Voices that no bundled network was trained on.
VOICES = ("flite:awb", "espeak:en-us+klatt4", "espeak:en-us+f5", "espeak:en-us+Jacky")
#: dB of full scale that sounds peak at where a condition does not say otherwise.
PEAK = -6.0
#: Frames of delay that are looked for: 300 ms, more than any method has.
LATEST = 15
#: (N,) int16 at 16 kHz -> (T, 13) frames, T of `frames_of(N)`.
Method = Callable[[np.ndarray], np.ndarray]
_Phonemes = List[Tuple[str, int]]


class Sounds(NamedTuple):
    """A set of sounds with the true times of their phonemes."""

    name: str
    sounds: List[Tuple[np.ndarray, _Phonemes]]  #: (N,) float32 at 16 kHz, phonemes with their milliseconds


class Row(NamedTuple):
    """What a method reaches on a set in a condition."""

    sounds: str
    condition: str
    method: str
    delay: int  #: milliseconds behind the true motion, taken out before anything else is measured
    figures: Figures
    tenth: float  #: correlation of the opening that nine clips in ten exceed


def of_folder(folder: PathLike, cache: PathLike, jobs: int, most: int) -> Sounds:
    """The first clips of a folder, `most` of them, spread evenly; 0: all. Raises DataError as :func:`clips.read`."""
    from labial.sound.samples import read_sound

    found = clips.read(folder, cache, jobs)
    if 0 < most < len(found):
        found = [found[len(found) * k // most] for k in range(most)]
    place = Path(folder).resolve()
    return Sounds(f"{place.parent.name}/{place.name}",
                  [(read_sound(clip.sound), targets.durations(clip.segments)) for clip in found])


def of_voice(voice: str, sentences: Sequence[str]) -> Sounds:
    """What a voice says (:mod:`labial.hearing.voices`)."""
    found = []
    for spoken in speak(voice, sentences):
        sound = spoken.samples.astype(np.float32) / 32768.0
        if spoken.rate != RATE:
            sound = distort.resampled(sound, spoken.rate / RATE)
        found.append((sound, targets.durations(spoken.segments)))
    return Sounds(voice, found)


def _noisy(sound: np.ndarray, noise: np.ndarray, ratio: float) -> np.ndarray:
    scale = distort.rms(sound) / max(distort.rms(noise), 1e-9) * 10 ** (-ratio / 20)
    return distort.as_integers(sound + noise * scale, PEAK)


def pink(count: int, random: np.random.Generator) -> np.ndarray:
    """(`count`,) noise whose energy falls by 3 dB an octave, above 20 Hz."""
    spectrum = np.fft.rfft(random.normal(size=count))
    frequency = np.arange(len(spectrum)) * RATE / max(count, 1)
    return np.fft.irfft(spectrum / np.sqrt(np.maximum(frequency, 20.0)), count)


def _telephone(sound: np.ndarray, random: np.random.Generator) -> np.ndarray:
    limited = distort.limited(sound, 300.0, 3400.0)
    return distort.as_integers(distort.companded(limited / max(float(np.abs(limited).max(initial=0)), 1e-9)), PEAK)


#: What is done to a sound, by name.
CONDITIONS: Dict[str, Callable[[np.ndarray, np.random.Generator], np.ndarray]] = {
    "clean": lambda sound, _: distort.as_integers(sound, PEAK),
    "-40 dBFS": lambda sound, _: distort.as_integers(sound, -40.0),
    "white noise 20 dB": lambda sound, random: _noisy(sound, random.normal(size=len(sound)), 20.0),
    "pink noise 10 dB": lambda sound, random: _noisy(sound, pink(len(sound), random), 10.0),
    "telephone": _telephone,
    "reverberation .25 s": lambda sound, random: distort.as_integers(
        distort.reverberated(sound, 0.25, 1.0, random), PEAK),
    "clipped 5 %": lambda sound, _: distort.as_integers(distort.clipped(sound, 0.05), PEAK),
}


def methods(model: HearingModel) -> Dict[str, Method]:
    """The network in floating point and in the library's integers, and what follows loudness. The integers are
    as a stream delivers them, at rest before the first voice and in silence."""
    tables = quantise(model, "hear")
    return {"network": lambda sound: hear(model, sound).faps,
            "integers": lambda sound: delivered(tables, sound, exact=True).faps,
            "loudness": loudness, "loudness and crossings": loudness_and_crossings}


def evaluated(sets: Sequence[Sounds], judged: Dict[str, Method], conditions: Sequence[str]) -> Iterator[Row]:
    """A row for each set, condition and method. The distortions of a sound are the same for all methods."""
    for item in sets:
        true = [[of(timings, frames_of(len(sound))) for of in (targets.frames, targets.classes)]
                for sound, timings in item.sounds]
        for condition in conditions:
            heard = [CONDITIONS[condition](sound, np.random.default_rng([zlib.crc32(condition.encode()), number]))
                     for number, (sound, _) in enumerate(item.sounds)]
            for name, method in judged.items():
                rows = [(frames, method(sound), classes) for (frames, classes), sound in zip(true, heard)]
                yield _row(item.name, condition, name, rows)


def _row(sounds: str, condition: str, method: str, rows: Sequence[Judged]) -> Row:
    lag = delay(rows, LATEST)
    rows = [_without(lag, *row) for row in rows]
    each = np.array([measured([row]).opening for row in rows])
    each = each[np.isfinite(each)]
    tenth = float(np.percentile(each, 10)) if len(each) else float("nan")
    return Row(sounds, condition, method, lag * targets.FRAME_MS, measured(rows), tenth)


def _without(lag: int, true: np.ndarray, heard: np.ndarray, classes: np.ndarray) -> Judged:
    """Frames without the delay of the heard ones; the last, or first, one repeats."""
    return true, heard[np.clip(np.arange(len(heard)) + lag, 0, max(len(heard) - 1, 0))], classes


COLUMNS = ("sounds", "condition", "method", "opening", "in speech", "10th percentile", "channels", "p, b, m closed",
           "false closures per second", "jerk", "delay, ms")


def table(rows: Sequence[Row]) -> str:
    """A table in Markdown."""
    lines = [f"| {' | '.join(COLUMNS)} |", f"|{'---|' * 3}{'---:|' * (len(COLUMNS) - 3)}"]
    for row in rows:
        f = row.figures
        cells = (f"{f.opening:.3f}", f"{f.speech:.3f}", f"{row.tenth:.2f}", f"{f.channels:.3f}", f"{f.closed:.2f}",
                 f"{f.false:.2f}", f"{f.jerk:.2f}", str(row.delay))
        lines.append(f"| {row.sounds} | {row.condition} | {row.method} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"
