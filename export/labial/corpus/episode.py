"""A recorded (or synthesised) episode: motion and its phonemes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, FrozenSet, Iterable, List, Optional, Tuple

from labial.files.faps import SIDES

#: Seconds from one frame to the next, or to a phoneme before the first or after the last, beyond which the motion
#: counts as unknown.
UNSEEN = 0.2

if TYPE_CHECKING:
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
class Source:
    """The origin of an episode, and which part of it training uses."""

    talker: str = ""
    recording: str = ""  #: what was recorded and measured together, so that means and scales are its own
    weight: float = 1.0  #: how much each frame counts beside those of other episodes
    left_out: FrozenSet[int] = frozenset()  #: channels that are not learnt from
    silences: bool = True  #: whether silences are
    scales: FrozenSet[int] = frozenset()  #: channels whose standard deviation all corpora take from this one
    stretch: Tuple[float, ...] = ()  #: what each channel's motion was multiplied by to bring talkers together; (): 1


@dataclass(frozen=True)
class Episode:
    """One utterance or bout of laughter. `times` is (T,), seconds, strictly increasing; `frames` is (T, 13), float64,
    FAP units relative to the neutral mouth; `segments` follow each other without gaps or overlaps."""

    name: str
    times: np.ndarray
    frames: np.ndarray
    segments: Tuple[Segment, ...]
    source: Source = Source()

    def sounding(self, silence: str) -> np.ndarray:
        """(T,) bool: frames within phonemes other than `silence`."""
        import numpy as np

        ends = np.array([segment.end for segment in self.segments])
        voiced = np.array([segment.label != silence for segment in self.segments])
        at = np.searchsorted(ends, self.times, side="right")
        inside = (at < len(ends)) & (self.times >= self.segments[0].start)
        return inside & voiced[np.minimum(at, len(ends) - 1)]

    def unseen(self, silence: str) -> List[Tuple[float, float]]:
        """The stretches, in seconds, whose motion is unknown: gaps over `UNSEEN`, and what lies outside the motion if
        phonemes other than `silence` do by as much. In silence the mouth may rest."""
        import numpy as np

        times = self.times
        found = [(float(times[i]), float(times[i + 1])) for i in np.flatnonzero(np.diff(times) > UNSEEN + 1e-6)]
        sounding = [segment for segment in self.segments if segment.label != silence]
        if sounding and sounding[0].start < times[0] - UNSEEN:
            found.insert(0, (self.segments[0].start, float(times[0])))
        if sounding and sounding[-1].end > times[-1] + UNSEEN:
            found.append((float(times[-1]), self.segments[-1].end))
        return found


def with_even_sides(corpus: Iterable[Episode]) -> List[Episode]:
    """The episodes with the channels of both sides at their mean. Where only one side is learnt from, both are it.
    Phonemes ask the same of both sides of a mouth. What a talker's sides do differently is his own, and twice as much
    is learnt of their mean as of either."""
    episodes = []
    for item in corpus:
        frames, left_out = item.frames.copy(), item.source.left_out
        for left, right in SIDES:
            own = [side for side in (left, right) if side not in left_out] or [left, right]
            frames[:, left] = frames[:, right] = frames[:, own].mean(axis=1)
            if len(own) == 1:
                left_out = left_out - {left, right}
        episodes.append(replace(item, frames=frames, source=replace(item.source, left_out=left_out)))
    return episodes
