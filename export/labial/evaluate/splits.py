"""Which episodes are trained on and which are judged (docs/method.md, How it is judged)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.evaluate.material import Utterance

#: Share of the episodes that are trained on.
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
    """One split for each talker of the further corpora, who is judged by what the first corpus, the `first` utterances,
    and the other talkers teach."""
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
