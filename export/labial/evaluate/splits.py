"""Splits of episodes into training and test part (docs/method.md, How it is judged)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.defaults import FPS, KINDS, SPLITS
from labial.errors import LabialError
from labial.evaluate.material import Utterance

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


def _draw(candidates: np.ndarray, seed: int, number: int) -> np.ndarray:
    """A random TRAINING_SHARE of `candidates`, ascending, at least one and not all of them where there are two."""
    rng = np.random.default_rng([seed, number])
    count = min(max(round(TRAINING_SHARE * len(candidates)), 1), max(len(candidates) - 1, 1))
    return np.sort(rng.permutation(candidates)[:count])


def make_splits(
    corpus: Sequence[Utterance], count: int, seed: int, held_out: Sequence[str] = ()
) -> List[Split]:
    """`count` splits, each drawn by a generator of its own, so that split n is the same whatever `count` is.

    With `held_out` words the test part is every episode that contains one of them, of which only those words' frames
    are judged, and each split trains on a random 80 % of the other episodes.
    """
    everyone = np.arange(len(corpus))
    if not held_out:
        if len(corpus) < 2:
            raise LabialError("an evaluation needs two episodes or more")
        chosen = [_draw(everyone, seed, number) for number in range(count)]
        rest = [np.setdiff1d(everyone, training) for training in chosen]
        return [Split(n, tuple(map(int, a)), tuple(map(int, b))) for n, (a, b) in enumerate(zip(chosen, rest))]
    words = tuple(sorted(set(held_out)))
    known = {word for item in corpus for word in item.words}
    missing = [word for word in words if word not in known]
    if missing:
        raise LabialError(f"no episode holds the words {', '.join(missing)}")
    contains = np.array([not set(words).isdisjoint(item.words) for item in corpus])
    if contains.all():
        raise LabialError("every episode holds one of the words to hold out; nothing is left to train on")
    test = tuple(int(index) for index in everyone[contains])
    return [
        Split(n, tuple(int(index) for index in _draw(everyone[~contains], seed, n)), test, words) for n in range(count)
    ]


def leave_talkers_out(corpus: Sequence[Utterance], first: int) -> List[Split]:
    """One split for each talker of the further corpora, with a training part of the first corpus, the `first`
    utterances, and the other talkers."""
    talkers = list(dict.fromkeys(item.episode.source.talker for item in corpus[first:]))
    if not talkers:
        raise LabialError("a talker is left out of a second corpus, but there is only one")
    further = range(first, len(corpus))
    return [
        Split(
            number,
            tuple(range(first)),
            tuple(index for index in further if corpus[index].episode.source.talker == talker),
            added=tuple(index for index in further if corpus[index].episode.source.talker != talker),
            talker=talker,
        )
        for number, talker in enumerate(talkers)
    ]
