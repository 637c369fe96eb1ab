"""Small networks of hearing that tests make up."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from labial.files.faps import CHANNELS
from labial.hearing.model import CLASSES, INPUTS, HearingModel, Memory


def random_hearing(seed: int = 0, units: int = 8, memories: Sequence[Memory] = (Memory(2, 1, 1),)) -> HearingModel:
    """A network with random weights whose frames stay within what a mouth can do."""
    random = np.random.default_rng(seed)

    def array(*shape: int) -> np.ndarray:
        return random.normal(scale=0.3, size=shape).astype(np.float32)

    blocks = range(len(memories))
    return HearingModel(
        memories=tuple(memories), dense=tuple(array(units, units if k else INPUTS) for k in blocks),
        bias=tuple(array(units) for _ in blocks), memory=tuple(array(units, item.taps) for item in memories),
        last=array(units, units), last_bias=array(units), class_weight=array(len(CLASSES), units),
        class_bias=array(len(CLASSES)), closed_weight=array(units), closed_bias=array(1),
        fap_weight=array(CHANNELS, units), fap_bias=array(CHANNELS), classes=CLASSES,
        fap_mean=np.zeros(CHANNELS, np.float32), fap_scale=np.full(CHANNELS, 50.0, np.float32),
        closed=np.zeros(CHANNELS, np.float32), closing=np.linspace(1, 0, CHANNELS, dtype=np.float32),
        close_from=0.0, close_to=1.0)
