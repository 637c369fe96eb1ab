"""The trained models: the published method and Labial in float64, and Labial in the C library."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labial.evaluate.check import device_frames
from labial.evaluate.material import Timeline
from labial.evaluate.training import Training
from labial.reference.synthesis import synthesise
from labial.tables.model import Model
from labial.tables.quantise import ExportedModel, quantise


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

    def predict(self, timeline: Timeline) -> np.ndarray:
        """(T, 13)."""
        return device_frames(self.exported, [timeline.stream])[0].astype(np.float64)


def fit_paper(training: Training) -> Float:
    """The published method, unit by unit."""
    return Float(training.model("paper"))


def fit_paper_normalised(training: Training) -> Float:
    """The published method with features normalised before clustering."""
    return Float(training.model("paper", normalise=True))


def fit_labial(training: Training) -> Float:
    """Labial, in floating point."""
    return Float(training.model("labial"))


def fit_device(training: Training) -> Device:
    """Labial, as it runs on the device."""
    return Device(quantise(training.model("labial"), "evaluated_model"))
