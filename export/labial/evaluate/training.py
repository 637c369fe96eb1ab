"""The training part as every method receives it, and what several methods derive from it, made once."""

from __future__ import annotations

import contextlib
import io
from functools import cached_property
from typing import Callable, Dict, List, Protocol, Sequence, Tuple, TypeVar

import numpy as np

from labial.evaluate.material import Timeline, Utterance
from labial.evaluate.measures import Scale, mean_difference, measure_scale, silence_of
from labial.model import Model
from labial.phonesets import PhoneSet
from labial.train import train

#: Share of the training part that inner validation fits on; the rest chooses the settings.
INNER_SHARE = 0.8

Setting = TypeVar("Setting")


class Predictor(Protocol):
    """A fitted method."""

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) FAP for an utterance of T frames."""


class Training:
    """A training part: utterances, and models that are trained on them when first asked for."""

    def __init__(self, utterances: Sequence[Utterance], phone_set: PhoneSet, fps: int, seed: int) -> None:
        self.utterances = list(utterances)
        self.phone_set = phone_set
        self.fps = fps
        self.seed = seed
        self._models: Dict[str, Model] = {}
        self._derived: Dict[object, object] = {}

    @property
    def silence(self) -> int:
        """The number of the silence phoneme."""
        return silence_of(self.phone_set)

    @cached_property
    def scale(self) -> Scale:
        """The scale of the part's labial parameters."""
        return measure_scale(self.utterances, self.phone_set, self.fps)

    @cached_property
    def inner(self) -> Tuple[Training, List[Utterance]]:
        """A part to fit on and utterances to choose settings by, both from this part alone."""
        order = np.random.default_rng([self.seed, 1]).permutation(len(self.utterances))
        count = min(max(round(INNER_SHARE * len(order)), 1), max(len(order) - 1, 1))
        fit = [self.utterances[index] for index in sorted(order[:count])]
        rest = [self.utterances[index] for index in sorted(order[count:])]
        return Training(fit, self.phone_set, self.fps, self.seed), rest or fit

    def model(self, method: str) -> Model:
        """The model of `method` ("paper" or "labial") trained on this part; its reports of back-offs are dropped."""
        if method not in self._models:
            with contextlib.redirect_stdout(io.StringIO()):
                self._models[method] = train(
                    [item.episode for item in self.utterances],
                    kind=self.phone_set.kind,
                    method=method,
                    fps=self.fps,
                    seed=self.seed,
                    jobs=1,
                    progress=False,
                )
        return self._models[method]

    def derived(self, key: object, make: Callable[[], Setting]) -> Setting:
        """What `make` returns, made once for this part under `key`."""
        if key not in self._derived:
            self._derived[key] = make()
        return self._derived[key]  # type: ignore[return-value]


def validation_error(training: Training, utterances: Sequence[Utterance], predict: Callable) -> float:
    """Mean diff over the four labial parameters outside silence: the figure that methods are judged and tuned by.

    `predict` takes a timeline and returns (T, 13) FAP.
    """
    masks = [item.timeline.phoneme_at != training.silence for item in utterances]
    human = np.concatenate([item.human[mask] for item, mask in zip(utterances, masks)])
    motion = np.concatenate([predict(item.timeline)[mask] for item, mask in zip(utterances, masks)])
    return float(mean_difference(training.scale, human, motion).mean())


def best(settings: Sequence[Setting], error: Callable[[Setting], float]) -> Setting:
    """The setting of least error, the first of equals."""
    errors = [error(setting) for setting in settings]
    return settings[int(np.argmin(errors))]
