"""The input and the truth of methods: timelines of phonemes, and the human motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Iterable, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus import resample
from labial.corpus.episode import Episode
from labial.corpus.phonesets import PhoneSet
from labial.errors import LabialError
from labial.reference.units import frame_counts
from labial.see.motion import Band


@dataclass(frozen=True)
class Timeline:
    """The input of a method for an utterance of S segments and T frames: phonemes and integer milliseconds."""

    phoneme: np.ndarray  #: (S,) int64, index into the phone set
    milliseconds: np.ndarray  #: (S,) int64
    length: np.ndarray  #: (S,) int64 frames; sums to T; 0 for a segment too short for a frame

    @property
    def frames(self) -> int:
        """T."""
        return int(self.length.sum())

    @property
    def stream(self) -> List[Tuple[int, int]]:
        """Pairs of phoneme number and milliseconds, for the library."""
        return [(int(p), int(ms)) for p, ms in zip(self.phoneme, self.milliseconds)]

    @cached_property
    def held(self) -> np.ndarray:
        """(H,) int64: the segments that have frames; the others have no effect in any method."""
        return np.flatnonzero(self.length > 0)

    @cached_property
    def start(self) -> np.ndarray:
        """(S,) int64: first frame of each segment."""
        result: np.ndarray = np.cumsum(self.length) - self.length
        return result

    @cached_property
    def segment_at(self) -> np.ndarray:
        """(T,) int64: the segment of each frame."""
        return np.repeat(np.arange(len(self.length)), self.length)

    @cached_property
    def phoneme_at(self) -> np.ndarray:
        """(T,) int64: the phoneme of each frame."""
        result: np.ndarray = self.phoneme[self.segment_at]
        return result


@dataclass(frozen=True)
class Utterance:
    """An episode on the frame grid. Frame t of the human motion is sampled at (t + 1/2) / fps."""

    episode: Episode
    timeline: Timeline
    words: Tuple[Optional[str], ...]  #: (S,)
    human: np.ndarray  #: (T, 13) FAP

    def in_words(self, words: Iterable[str]) -> np.ndarray:
        """(T,) bool: frames of segments that belong to one of `words`."""
        wanted = set(words)
        result: np.ndarray = np.array([word in wanted for word in self.words], dtype=bool)[self.timeline.segment_at]
        return result

    def longest_word(self, silence: int, words: Optional[Iterable[str]] = None) -> Optional[Tuple[int, int]]:
        """First and last segment of the word with the most phonemes, the first of equals, among `words` if given."""
        wanted = None if words is None else set(words)
        runs: List[List[int]] = []
        for index, word in enumerate(self.words):
            if word is None or self.timeline.phoneme[index] == silence or (wanted is not None and word not in wanted):
                continue
            if runs and runs[-1][-1] == index - 1 and self.words[index - 1] == word:
                runs[-1].append(index)
            else:
                runs.append([index])
        longest = max(runs, key=len, default=None)
        return (longest[0], longest[-1]) if longest else None


def timeline(phonemes: Iterable[int], milliseconds: Iterable[int], fps: int) -> Timeline:
    """The timeline of a stream of phoneme numbers and durations."""
    durations = np.array(list(milliseconds), dtype=np.int64)
    counts = frame_counts([int(item) for item in durations], fps)
    return Timeline(np.array(list(phonemes), dtype=np.int64), durations, np.array(counts, dtype=np.int64))


def utterance(episode: Episode, phone_set: PhoneSet, fps: int) -> Utterance:
    """One episode. Boundaries are rounded to milliseconds, so that rounding errors do not accumulate; if the number of
    frames differs from the recording's, the last frame is repeated or omitted."""
    number = {label: index for index, label in enumerate(phone_set.phonemes)}
    unknown = sorted({segment.label for segment in episode.segments} - set(number))
    if unknown:
        raise LabialError(f"{episode.name}: labels {', '.join(unknown)} are not in the {phone_set.kind} phone set")
    human = resample(episode, fps).motion
    origin = episode.segments[0].start
    bounds = [0, *(round(1000 * (segment.end - origin)) for segment in episode.segments)]
    given = timeline((number[segment.label] for segment in episode.segments), np.diff(bounds), fps)
    aligned = human[np.minimum(np.arange(given.frames), len(human) - 1)]
    return Utterance(episode, given, tuple(segment.word for segment in episode.segments), aligned)


def utterances(episodes: Iterable[Episode], phone_set: PhoneSet, fps: int) -> List[Utterance]:
    """All episodes of three frames or more; shorter ones have no acceleration to learn from or to judge."""
    result = [utterance(episode, phone_set, fps) for episode in episodes]
    return [item for item in result if item.timeline.frames >= 3]


def bands(given: Timeline, phonemes: Sequence[str], kinds: Sequence[str], fps: int, begin: int = 0,
          end: Optional[int] = None) -> List[Band]:
    """The bands that figures draw: the phonemes within the frames from `begin` to before `end` (all), as they are
    synthesised, cut at both ends.

    `phonemes` and `kinds` (P,) are labels and kinds of bands by phoneme number.
    """
    end = given.frames if end is None else end
    found = []
    for segment in given.held:
        first = max(int(given.start[segment]), begin)
        last = min(int(given.start[segment] + given.length[segment]), end)
        if first < last:
            phoneme = given.phoneme[segment]
            found.append(Band(first / fps, last / fps, phonemes[phoneme], kinds[phoneme]))
    return found
