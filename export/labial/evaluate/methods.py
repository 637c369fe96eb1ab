"""The methods by name, in the order of the tables."""

from __future__ import annotations

from typing import Callable, List, NamedTuple, Sequence, Tuple

import numpy as np

from labial.errors import LabialError
from labial.evaluate.baselines import dominance, hmm, ridge, steps
from labial.evaluate.check import device_model, stream_frames
from labial.evaluate.material import Timeline
from labial.evaluate.training import Predictor, Training
from labial.reference.synthesis import synthesise
from labial.tables.model import Model
from labial.tables.quantise import ExportedModel, quantise


def reference(model: Model) -> Predictor:
    """A model in the float64 reference of its method."""
    return lambda timeline: synthesise(model, timeline.stream)


def device(exported: ExportedModel) -> Predictor:
    """A model's exported tables in the integer C library."""
    model = device_model(exported)
    return lambda timeline: stream_frames(model, timeline.stream).astype(np.float64)


class Method(NamedTuple):
    """A method that can be fitted; `title` is what tables call it."""

    name: str
    title: str
    fit: Callable[[Training], Predictor]


METHODS: Tuple[Method, ...] = (
    Method("mean", "mean shape", ridge.fit_mean),
    Method("steps", "steps (eq. 2)", steps.fit),
    Method("blur", "steps + Gaussian blur", steps.fit_blur),
    Method("cohen_massaro", "Cohen-Massaro dominance", dominance.fit),
    Method("regression", "linear regression", ridge.fit_regression),
    Method("ridge_phonemes", "ridge, phoneme window", ridge.fit_phonemes),
    Method("ridge_classes", "ridge, class window + shapes", ridge.fit_classes),
    Method("hmm_synthesis", "HMM synthesis", hmm.fit),
    Method("paper", "paper", lambda part: reference(part.model("paper"))),
    Method("paper_normalised", "paper, normalised features",
           lambda part: reference(part.model("paper", normalise=True))),
    Method("labial", "Labial, float64", lambda part: reference(part.model("labial"))),
    Method("device", "Labial, device", lambda part: device(quantise(part.model("labial"), "evaluated_model"))),
)


def select(names: str) -> List[Method]:
    """The methods of a comma-separated list, in the tables' order; "all" for every one."""
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    known = {method.name for method in METHODS}
    unknown = [name for name in wanted if name not in known and name != "all"]
    if unknown or not wanted:
        raise LabialError(f"methods {names!r}: not among all, {', '.join(method.name for method in METHODS)}")
    return [method for method in METHODS if "all" in wanted or method.name in wanted]


def predict_all(predictor: Predictor, timelines: Sequence[Timeline]) -> List[np.ndarray]:
    """(T, 13) of every timeline. Raises LabialError for invalid motion."""
    motion = [predictor(item) for item in timelines]
    for frames, item in zip(motion, timelines):
        if len(frames) != item.frames or not np.isfinite(frames).all():
            raise LabialError(f"a method made {len(frames)} frames of {item.frames}, or such as are not finite")
    return motion
