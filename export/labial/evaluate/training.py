"""The training part, as input of every method, and cached results that several methods share."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cached_property
from typing import Callable, Dict, List, Optional, Sequence, Tuple, TypeVar

import numpy as np

from labial.corpus.episode import Episode
from labial.corpus.phonesets import PhoneSet
from labial.evaluate.material import Timeline, Utterance, draw
from labial.evaluate.measures import Scale, judged_frames, mean_difference, measure_scale, silence_of
from labial.tables.model import Model
from labial.train import train
from labial.train.codebook import lbg

#: If unseen words are judged, inner validation holds out words, too, in several folds, since few words are not enough:
#: in each fold until so many episodes contain one of them. It does not hold out words in more episodes than
#: COMMON_SHARE, which would leave too little to fit on.
WORD_FOLDS = 3
WORD_SHARE = 0.3
COMMON_SHARE = 0.15

Setting = TypeVar("Setting")
#: A fitted method: (T, 13) FAP for the timeline of T frames.
Predictor = Callable[[Timeline], np.ndarray]


@dataclass(eq=False)
class Training:
    """A training part: utterances, and models that are trained on them on first use. `unseen_words` says that the
    fitted methods will be judged on words that the part does not contain, so that settings must be chosen on such
    words, too. `added` episodes of further corpora are used only for Labial's models: other methods have no weights."""

    utterances: Sequence[Utterance]
    phone_set: PhoneSet
    fps: int
    seed: int
    unseen_words: bool = False
    added: Sequence[Episode] = ()
    talker_variance: Optional[float] = None
    _derived: Dict[object, object] = field(default_factory=dict, init=False)

    @property
    def silence(self) -> int:
        """The number of the silence phoneme."""
        return silence_of(self.phone_set)

    @cached_property
    def scale(self) -> Scale:
        """The scale of the part's labial parameters."""
        return measure_scale(self.utterances, self.phone_set, self.fps)

    @cached_property
    def folds(self) -> List[Fold]:
        """Inner validation, from this part alone: one random fold, or WORD_FOLDS of unseen words."""
        by_word = [self._fold([not item.holds(words) for item in self.utterances], words)
                   for words in self._word_draws()]
        every = np.arange(len(self.utterances))
        return by_word or [self._fold(np.isin(every, draw(every, self.seed, 1)).tolist(), ())]

    def _fold(self, fits: Sequence[bool], words: Tuple[str, ...]) -> Fold:
        """Fits on the utterances of which `fits` says so; the others choose the settings."""
        fit = [item for item, own in zip(self.utterances, fits) if own]
        rest = [item for item, own in zip(self.utterances, fits) if not own]
        return Fold(Training(fit, self.phone_set, self.fps, self.seed), rest or fit, words)

    def _word_draws(self) -> List[Tuple[str, ...]]:
        """The words of each fold, random ones, none in two folds; empty unless unseen words are to be judged."""
        if not self.unseen_words:
            return []
        holds = [{word for word, phoneme in zip(item.words, item.timeline.phoneme)
                  if word is not None and phoneme != self.silence} for item in self.utterances]
        known = sorted(set().union(*holds))
        rare = [word for word in known if sum(word in held for held in holds) <= COMMON_SHARE * len(holds)]
        left = [rare[index] for index in np.random.default_rng([self.seed, 2]).permutation(len(rare))]
        draws: List[Tuple[str, ...]] = []
        chosen: List[str] = []
        while left and len(draws) < WORD_FOLDS:
            chosen.append(left.pop())
            if not left or sum(not held.isdisjoint(chosen) for held in holds) >= WORD_SHARE * len(holds):
                draws.append(tuple(sorted(chosen)))
                chosen = []
        return draws

    def divide(self, points: np.ndarray, size: int) -> Tuple[np.ndarray, np.ndarray, float]:
        """The result of :func:`lbg`, cached for the same points: the methods' codebooks share their cells."""
        digest = hashlib.sha256(np.ascontiguousarray(points).tobytes()).digest()
        return self.derived(("cells", size, digest), lambda: lbg(points, size))

    def model(self, method: str, normalise: bool = False) -> Model:
        """The model of `method` ("paper" or "labial") trained on this part, as :func:`labial.train.train` does it."""
        added, variance = (self.added, self.talker_variance) if method == "labial" else ((), None)
        return self.derived(("model", method, normalise), lambda: train(
            [*(item.episode for item in self.utterances), *added], kind=self.phone_set.kind, method=method,
            fps=self.fps, seed=self.seed, jobs=1, progress=False, divide=self.divide, normalise=normalise,
            talker_variance=variance))

    def derived(self, key: object, make: Callable[[], Setting]) -> Setting:
        """The result of `make`, cached for this part under `key`."""
        if key not in self._derived:
            self._derived[key] = make()
        return self._derived[key]  # type: ignore[return-value]


@dataclass(frozen=True)
class Fold:
    """A part to fit on, and utterances to choose settings by, of which only `words` count if there are any."""

    training: Training
    held_out: List[Utterance]
    words: Tuple[str, ...]


def validation_error(scale: Scale, fold: Fold, predict: Predictor) -> float:
    """Mean diff over the four labial parameters, the figure that methods are judged by, on a fold's held-out frames."""
    masks = judged_frames(fold.held_out, fold.training.phone_set, fold.words)
    human = np.concatenate([item.human[mask] for item, mask in zip(fold.held_out, masks)])
    motion = np.concatenate([predict(item.timeline)[mask] for item, mask in zip(fold.held_out, masks)])
    return float(mean_difference(scale, human, motion).mean())


def choose(training: Training, settings: Sequence[Setting],
           prepare: Callable[[Training], Callable[[Setting], Predictor]]) -> Setting:
    """The setting of least error over the folds of inner validation, the first of equals. `prepare` takes the part to
    fit on and returns what makes a prediction function of a setting."""
    error = np.zeros(len(settings))
    for fold in training.folds:
        predict_with = prepare(fold.training)
        error += [validation_error(training.scale, fold, predict_with(setting)) for setting in settings]
    return settings[int(np.argmin(error))]
