"""The trained models: the published method and Labial in float64, and Labial as the C library runs it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence

import numpy as np

from labial.evaluate.material import Timeline
from labial.evaluate.training import Training
from labial.model import Model
from labial.native import NativeModel
from labial.quantise import ExportedModel, quantise
from labial.reference.synthesis import synthesise


@dataclass(frozen=True)
class Float:
    """A model in the float64 reference of its method."""

    model: Model

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13)."""
        return synthesise(self.model, timeline.stream)


@dataclass(frozen=True)
class Device:
    """A model's exported tables in the integer C library."""

    exported: ExportedModel

    def predict_all(self, timelines: Sequence[Timeline]) -> List[np.ndarray]:
        """(T, 13) of every timeline, from one run of one compiled program."""
        with NativeModel(self.exported) as native:
            return [frames.astype(np.float64) for frames in native.synthesise([item.stream for item in timelines])]

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) of one timeline."""
        return self.predict_all([timeline])[0]


def fit_paper(training: Training) -> Float:
    """The published method, unit by unit."""
    return Float(training.model("paper"))


def fit_paper_normalised(training: Training) -> Float:
    """The published method with features that are normalised before they are clustered."""
    return Float(training.model("paper", normalise=True))


def fit_labial(training: Training) -> Float:
    """Labial, in floating point."""
    return Float(training.model("labial"))


def fit_device(training: Training) -> Device:
    """Labial, as it runs on the device."""
    return Device(quantise(training.model("labial"), "evaluated_model"))
