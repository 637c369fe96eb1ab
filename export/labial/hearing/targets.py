"""What the network learns: Labial's own frames and the lip classes, from the true times of phonemes."""

from __future__ import annotations

from functools import cache
from typing import List, NamedTuple, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.phonesets import SPEECH
from labial.files.faps import CHANNELS, TOUCHING
from labial.files.frames import opening
from labial.hearing.features import FRAME, RATE
from labial.hearing.model import CLASSES, CLOSED, class_of
from labial.runtime.render import render

#: Milliseconds of a frame.
FRAME_MS = 1000 * FRAME // RATE

_CLASS = {phoneme: CLASSES.index(class_of(phoneme)) for phoneme in SPEECH.phonemes}


def durations(segments: Sequence[Segment], speed: float = 1.0) -> List[Tuple[str, int]]:
    """Phonemes with their milliseconds, without gaps from time 0 on, of `segments` that are said `speed` times as fast.
    Rounding does not add up."""
    found, last = [], 0
    for item in segments:
        for end, label in ((item.start, SPEECH.silence), (item.end, item.label)):
            stop = round(1000.0 * end / speed)
            if stop > last:
                found.append((label, stop - last))
                last = stop
    return found


def frames(timings: Sequence[Tuple[str, int]], count: int) -> np.ndarray:
    """(`count`, 13) float32 FAP units: Labial's frames of the bundled model. Silence follows the last phoneme."""
    rendered = np.array(render([*timings, (SPEECH.silence, FRAME_MS * (count + 1))], exact=True), dtype=np.float32)
    return rendered.reshape(-1, CHANNELS)[:count]


def classes(timings: Sequence[Tuple[str, int]], count: int) -> np.ndarray:
    """(`count`,) uint8: the number of each frame's lip class, that of the phoneme in its middle."""
    ends = np.cumsum([length for _, length in timings])
    at = np.searchsorted(ends, np.arange(count) * FRAME_MS + FRAME_MS // 2, side="right")
    return np.array([_CLASS[label] for label in (*(label for label, _ in timings), SPEECH.silence)], dtype=np.uint8)[at]


def touching(shown: np.ndarray, found: np.ndarray) -> np.ndarray:
    """(T,) bool: where lips touch in p, b or m, but not at rest, by Labial's frames (T, 13) and their classes (T,)."""
    return (opening(shown) <= TOUCHING) & (found == CLASSES.index(CLOSED))


class Closure(NamedTuple):
    """What lips do when they close."""

    pose: np.ndarray  #: (13,) float32 FAP units
    share: np.ndarray  #: (13,) float32, 0 .. 1: how far each channel follows the pose


@cache
def closure() -> Closure:
    """The median of Labial's frames at the least opening of p, b and m between all vowels, and how far each channel is
    there wherever it was before: 1 less its variance in these frames over that in all of these sounds. So lips close,
    and corners stay as wide as the vowels around have them."""
    vowels = [label for label, edge in zip(SPEECH.phonemes, SPEECH.boundary) if edge and class_of(label) != CLOSED]
    poses, every = [], []
    for stop in ("P", "B", "M"):
        for vowel in vowels:
            shown = frames([(SPEECH.silence, 200), (vowel, 140), (stop, 100), (vowel, 140)], 30)
            within = shown[340 // FRAME_MS : 440 // FRAME_MS]
            poses.append(within[int(np.argmin(opening(within)))])
            every.append(shown[200 // FRAME_MS : 580 // FRAME_MS])
    share = 1 - np.var(poses, axis=0) / np.maximum(np.var(np.concatenate(every), axis=0), 1e-9)
    return Closure(np.median(np.array(poses), axis=0).astype(np.float32), np.clip(share, 0, 1).astype(np.float32))
