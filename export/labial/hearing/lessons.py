"""What a network learns of each frame: the true frames, classes and closures, or what a teacher hears, or both.

A teacher is a network that was trained before, larger or with more frames ahead. It hears each take as it was prepared;
the network that learns hears it with the noise and channels of a batch. What is learned is a mean of the truth and of
what the teacher tells, as all parts of the loss but the frames' differences are linear in it; of sounds whose text is
not known, the teacher's alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from labial.hearing import targets
from labial.hearing.features import HOPS, normalise
from labial.hearing.model import HearingModel
from labial.hearing.network import run
from labial.hearing.plans import CLASSES, CLOSED
from labial.hearing.prepared import Prepared

#: How often frames count for the score of closed lips: others in speech once; those of p, b, m; of n, t, d, f and v,
#: which are taken for them; of p, b, m next to silence; of silence, where the face rests anyway.
_PRESSED, _RIVALS, _EDGES, _SILENCE = 4.0, 2.5, 8.0, 0.3
#: Frames to both sides of p, b, m that count as these, and of silence that are next to it.
_NEAR, _NEXT = 2, 6


@dataclass(frozen=True)
class Lesson:
    """T frames of a folder's takes, one after the other."""

    energies: np.ndarray  #: (2 T, 24) float16 log2 energies
    frames: np.ndarray  #: (T, 13) int16 FAP units
    classes: np.ndarray  #: (T,) uint8: the true, or likeliest, class
    likely: np.ndarray  #: (T, 26) float16: how likely each class is
    closed: np.ndarray  #: (T,) float16: how likely lips touch in p, b, m
    weight: np.ndarray  #: (T,) float16: how often the frame counts for `closed`


def lesson(part: Prepared, teacher: Optional[HearingModel] = None, share: float = 0.0) -> Lesson:
    """What is to be learned of takes; a `teacher` tells this share of it, 1 for takes of which no truth is known."""
    frames, classes = part.frames, part.classes
    likely = np.eye(len(CLASSES), dtype=np.float16)[classes]
    closed = targets.touching(frames.astype(np.float32), classes).astype(np.float16)
    if teacher is not None:
        ends = np.cumsum(part.lengths)
        frames, likely, closed = frames.copy(), likely.copy(), closed.copy()
        for begin, end in zip(ends - part.lengths, ends):
            energies = part.energies[HOPS * begin : HOPS * end].astype(np.float32)
            told = run(teacher, normalise(energies).reshape(end - begin, -1))
            at = slice(begin, end)
            odds = np.exp(told.scores - told.scores.max(axis=1, keepdims=True))
            likely[at] = (1 - share) * likely[at] + share * odds / odds.sum(axis=1, keepdims=True)
            closed[at] = (1 - share) * closed[at] + share / (1 + np.exp(-np.clip(told.closed, -30, 30)))
            frames[at] = np.rint((1 - share) * frames[at] + share * told.faps)
        if share == 1:
            classes = likely.argmax(axis=1).astype(np.uint8)
    return Lesson(part.energies, frames, classes, likely, closed, _weight(classes))


def _weight(classes: np.ndarray) -> np.ndarray:
    """(T,) float16: see the top of this module."""
    number = {name: k for k, name in enumerate(CLASSES)}
    pressed = _around(classes == number[CLOSED], _NEAR)
    silence = classes == number["SIL"]
    weight = np.where(np.isin(classes, [number["T"], number["F"]]), _RIVALS, np.where(silence, _SILENCE, 1.0))
    weight = np.where(pressed, np.where(_around(silence, _NEXT), _EDGES, _PRESSED), weight)
    return weight.astype(np.float16)


def _around(where: np.ndarray, reach: int) -> np.ndarray:
    """(T,) bool: within `reach` frames of a true one."""
    counts = np.concatenate([[0], np.cumsum(where)])
    at = np.arange(len(where))
    result: np.ndarray = counts[np.minimum(at + reach + 1, len(where))] > counts[np.maximum(at - reach, 0)]
    return result
