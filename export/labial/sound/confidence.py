"""The confidence of an alignment, stretch by stretch: the expected share of a stretch with the right phonemes.

The recogniser gives each phoneme a score, the mean of its frames: 0 for a sound that the models expect for that
phoneme, far below for another sound. The confidence is a logistic function of the mean score of a stretch and of the
share of its time that lies in phonemes longer than people speak. Its numbers were fitted to 27 recordings of
LibriSpeech, LibriTTS, VCTK and ARCTIC whose text was cut or another recording's, or whose sound was faster or under
noise or music; the alignment of the same unchanged recording served as the truth. There the confidence and the share
that was right correlate by .82; 84 % of the stretches that were mostly wrong are below `LOW`, 7 % of the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.phonesets import VOWELS

#: Below this a stretch is named in a warning.
LOW = 0.6
#: A stretch ends at a pause that is longer, or when it is longer itself; seconds.
_PAUSE, _LONGEST = 0.15, 3.0
#: Shorter sounds without a phoneme, such as a breath, are not missing text; seconds.
_UNSPOKEN = 0.6
#: The logistic function: constant, factor of the mean score, factor of the share of time in long phonemes.
_CONSTANT, _SCORE, _LONG = 3.64, 0.0587, -2.59
#: Lower scores carry no more information.
_LEAST = -90.0
#: The score of a phoneme that is not from a text.
UNTOLD = -70.0
#: Durations in seconds that vowels and consonants hardly ever exceed.
_LONG_VOWEL, _LONG_CONSONANT = 0.35, 0.25

_VOWELS = frozenset(VOWELS.split())


@dataclass(frozen=True)
class Heard:
    """A phoneme found by the recogniser; times in seconds."""

    start: float
    end: float
    label: str  #: SIL for silence and noises
    score: float  #: of the mean frame


@dataclass(frozen=True)
class Stretch:
    """A part of a sound, in seconds, and the confidence that its phonemes are right, 0 .. 1."""

    start: float
    end: float
    confidence: float


def stretches(heard: Sequence[Heard], start: float) -> List[Stretch]:
    """The speech between pauses, at most three seconds of it, in phonemes whose times count from `start`."""
    parts: List[List[Heard]] = []
    open_part = False
    for item in heard:
        if item.label == "SIL":
            open_part = open_part and item.end - item.start < _PAUSE
        elif open_part and item.end - parts[-1][0].start <= _LONGEST:
            parts[-1].append(item)
        else:
            parts.append([item])
            open_part = True
    return [Stretch(start + part[0].start, start + part[-1].end, confidence(part)) for part in parts]


def unspoken(segments: Sequence[Segment], silences: Sequence[Tuple[float, float]], start: float) -> List[Stretch]:
    """Stretches of confidence 0: `segments` have no phoneme, though the sound is not silent, as if the text lacks
    words. `silences` are the sound's, begin and end; their times and those of `segments` count from `start`."""
    found: List[Stretch] = []
    for item in segments:
        moment = item.start
        for begin, end in [*silences, (item.end, item.end)] if item.label == "SIL" else []:
            until = min(begin, item.end)
            if until - moment >= _UNSPOKEN:
                found.append(Stretch(start + moment, start + until, 0.0))
            moment = max(moment, end)
    return found


def confidence(part: Sequence[Heard]) -> float:
    """The confidence in phonemes that sound."""
    length = np.array([item.end - item.start for item in part])
    score = np.array([item.score for item in part])
    most = np.array([_LONG_VOWEL if item.label in _VOWELS else _LONG_CONSONANT for item in part])
    total = max(float(length.sum()), 1e-9)
    mean = max(float((score * length).sum()) / total, _LEAST)
    return float(1 / (1 + np.exp(-(_CONSTANT + _SCORE * mean + _LONG * float(length[length > most].sum()) / total))))


def comments(found: Sequence[Stretch]) -> str:
    """The stretches as comments of a .lab: start and end in seconds, and the confidence."""
    if not found:
        return ""
    return "# confidence of stretches: start, end, 0 to 1\n" + "".join(
        f"# {item.start:.2f} {item.end:.2f} {item.confidence:.2f}\n" for item in found)


def summary(found: Sequence[Stretch]) -> str:
    """A line: the mean confidence and the lowest, with its place."""
    length = np.array([item.end - item.start for item in found])
    mean = float(np.average([item.confidence for item in found], weights=length))
    worst = min(found, key=lambda item: item.confidence)
    return f"confidence {mean:.2f}, lowest {worst.confidence:.2f} from {worst.start:.1f} to {worst.end:.1f} s"


def unsure(found: Sequence[Stretch]) -> str:
    """The stretches of low confidence, neighbours as one, for a message; "" where there are none."""
    spans: List[List[float]] = []
    before = False
    for item in found:
        if item.confidence < LOW:
            if before:
                spans[-1][1] = item.end
            else:
                spans.append([item.start, item.end])
        before = item.confidence < LOW
    more = f" and {len(spans) - 6} more" if len(spans) > 6 else ""
    return ", ".join(f"{a:.1f} to {b:.1f} s" for a, b in spans[:6]) + more
