"""The input and the truth of methods: timelines of phonemes, and the human motion."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from functools import cached_property
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus import resample
from labial.corpus.episode import Episode
from labial.corpus.phonesets import PhoneSet
from labial.defaults import FPS, KINDS, SPLITS
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
        return np.cumsum(self.length) - self.length

    @cached_property
    def segment_at(self) -> np.ndarray:
        """(T,) int64: the segment of each frame."""
        return np.repeat(np.arange(len(self.length)), self.length)

    @cached_property
    def phoneme_at(self) -> np.ndarray:
        """(T,) int64: the phoneme of each frame."""
        return self.phoneme[self.segment_at]


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
        return np.array([word in wanted for word in self.words], dtype=bool)[self.timeline.segment_at]

    def holds(self, words: Iterable[str]) -> bool:
        """Whether one of `words` is said."""
        return not set(words).isdisjoint(self.words)

    def longest_word(self, silence: int, words: Optional[Iterable[str]] = None) -> Optional[Tuple[int, int]]:
        """First and last segment of the word with the most phonemes, the first of equals, among `words` if given."""
        wanted = set(self.words if words is None else words)
        said = [word if word in wanted and phoneme != silence else None
                for word, phoneme in zip(self.words, self.timeline.phoneme)]
        runs = [list(run) for word, run in itertools.groupby(range(len(said)), said.__getitem__) if word is not None]
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
    synthesised, cut at both ends. `phonemes` and `kinds` (P,) are labels and kinds of bands by phoneme number."""
    end = given.frames if end is None else end
    found = []
    for segment in given.held:
        first = max(int(given.start[segment]), begin)
        last = min(int(given.start[segment] + given.length[segment]), end)
        if first < last:
            phoneme = given.phoneme[segment]
            found.append(Band(first / fps, last / fps, phonemes[phoneme], kinds[phoneme]))
    return found


# ---- Splits of episodes into training and test part ------------------------------------------------------------------

#: Share of the episodes in the training part.
TRAINING_SHARE = 0.8


@dataclass(frozen=True)
class Split:
    """One repetition: indices of episodes, ascending, and the words whose frames are judged (None: all)."""

    number: int
    training: Tuple[int, ...]
    test: Tuple[int, ...]
    words: Optional[Tuple[str, ...]] = None
    added: Tuple[int, ...] = ()  #: of further corpora, which Labial's models are trained on too
    talker: str = ""  #: who is left out


@dataclass(frozen=True)
class Options:
    """What an evaluation is asked to do."""

    kind: str = KINDS[0]
    methods: str = "all"
    splits: int = SPLITS
    seed: int = 0
    fps: int = FPS
    held_out: Tuple[str, ...] = ()
    leave_out_talkers: bool = False  #: in place of random splits
    talker_variance: Optional[float] = None  #: of Labial's models: talkers as random effects
    first_corpus_alone: bool = False  #: Labial's models learn from the first corpus alone, as all other methods do
    synthetic: bool = False  #: the motion was computed, not recorded; every table and plot says so


@dataclass(frozen=True)
class Example:
    """An utterance of the test part and what every method made of it, for the plots; (T, 13) each, FAP."""

    kind: str
    index: int  #: of the utterance in the corpus
    utterance: Utterance
    stretch: Optional[Tuple[int, int]]  #: first and last segment that plots show: see :mod:`labial.evaluate.protocol`
    steps: np.ndarray
    motion: Dict[str, np.ndarray]


@dataclass(frozen=True)
class Outcome:
    """One split: measures by method and name; processor seconds by method, shared work with the first that asks."""

    split: Split
    frames: int  #: that are judged
    measures: Dict[str, Dict[str, float]]
    seconds: Dict[str, float] = field(compare=False)
    example: Optional[Example] = None


def draw(candidates: np.ndarray, seed: int, number: int) -> np.ndarray:
    """A random TRAINING_SHARE of `candidates`, ascending, at least one and not all of them where there are two."""
    rng = np.random.default_rng([seed, number])
    count = min(max(round(TRAINING_SHARE * len(candidates)), 1), max(len(candidates) - 1, 1))
    return np.sort(rng.permutation(candidates)[:count])


def make_splits(corpus: Sequence[Utterance], count: int, seed: int, held_out: Sequence[str] = ()) -> List[Split]:
    """`count` splits, each drawn by a generator of its own, so that split n is the same whatever `count` is. With
    `held_out` words the test part is every episode that contains one of them, of which only those words' frames are
    judged, and each split trains on a random 80 % of the other episodes."""
    everyone = np.arange(len(corpus))
    if not held_out:
        if len(corpus) < 2:
            raise LabialError("an evaluation needs two episodes or more")
        chosen = [draw(everyone, seed, number) for number in range(count)]
        return [Split(number, tuple(own.tolist()), tuple(np.setdiff1d(everyone, own).tolist()))
                for number, own in enumerate(chosen)]
    words = tuple(sorted(set(held_out)))
    known = {word for item in corpus for word in item.words}
    missing = [word for word in words if word not in known]
    if missing:
        raise LabialError(f"no episode holds the words {', '.join(missing)}")
    contains = np.array([item.holds(words) for item in corpus])
    if contains.all():
        raise LabialError("every episode holds one of the words to hold out; nothing is left to train on")
    test, rest = tuple(everyone[contains].tolist()), everyone[~contains]
    return [Split(number, tuple(draw(rest, seed, number).tolist()), test, words) for number in range(count)]


def leave_talkers_out(corpus: Sequence[Utterance], first: int) -> List[Split]:
    """A split for each talker of the further corpora, with the `first` utterances, those of the first, to train on."""
    talkers = list(dict.fromkeys(item.episode.source.talker for item in corpus[first:]))
    if not talkers:
        raise LabialError("a talker is left out of a second corpus, but there is only one")
    further = range(first, len(corpus))
    own = {talker: tuple(i for i in further if corpus[i].episode.source.talker == talker) for talker in talkers}
    return [Split(number, tuple(range(first)), own[talker], added=tuple(i for i in further if i not in own[talker]),
                  talker=talker) for number, talker in enumerate(talkers)]
