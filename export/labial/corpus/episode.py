"""A recorded (or synthesised) episode: motion and the phonemes that go with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np


@dataclass(frozen=True)
class Segment:
    """A phoneme in time. Times are in seconds from the start of the episode; `apex` is the time of the audio
    envelope's maximum inside the segment where it is known."""

    start: float
    end: float
    label: str
    apex: Optional[float] = None
    word: Optional[str] = None

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.end - self.start


@dataclass(frozen=True)
class Episode:
    """One utterance or bout of laughter.

    `times` is (T,), seconds, strictly increasing; `frames` is (T, 13), float64, FAP units relative to the neutral
    mouth; `segments` follow each other without gaps or overlaps (readers fill gaps with silence).
    """

    name: str
    times: np.ndarray
    frames: np.ndarray
    segments: Tuple[Segment, ...]
