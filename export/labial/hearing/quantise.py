"""The integer tables of a model of hearing (``include/labial/hear_model.h``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

import numpy as np

from labial.errors import ModelError
from labial.hearing.model import HearingModel, Memory

#: LABIAL_HEAR_MODEL_FORMAT.
FORMAT = 3
#: One of an activation; of a position.
ACTIVATION = 512
POSITION = 16
#: The largest weight, and the largest shift of a row.
_WEIGHT_MAX, _SHIFT_MAX = 127, 15


@dataclass(frozen=True)
class Dense:
    """A layer of R rows. All arrays are int64."""

    weight: np.ndarray  #: (R, columns) -127 .. 127; a weight is this / 2^shift
    bias: np.ndarray  #: (R,) Q9
    shift: np.ndarray  #: (R,) 0 .. 15


@dataclass(frozen=True)
class BlockTables:
    """A block of H units."""

    dense: Dense
    memory: Memory
    taps: np.ndarray  #: (H, K) int64, -127 .. 127, the oldest first
    shift: np.ndarray  #: (H,) int64, 0 .. 15


@dataclass(frozen=True)
class HearingTables:
    """The tables of a model. Arrays are int64."""

    name: str  #: of the C symbol
    classes: Tuple[str, ...]
    blocks: Tuple[BlockTables, ...]
    last: Dense
    heads: Dense  #: rows of the classes, then of closed lips, then of the 13 FAPs
    close_from: int  #: Q9
    close_width: int  #: Q9, 1 and more
    mean: np.ndarray  #: (13,) Q4
    scale: np.ndarray  #: (13,) Q4
    closed: np.ndarray  #: (13,) Q4
    closing: np.ndarray  #: (13,) Q8
    attribution: str

    @property
    def units(self) -> int:
        """Units of every layer."""
        return len(self.last.bias)

    @property
    def ahead(self) -> int:
        """Frames that must follow a frame."""
        return sum(block.memory.ahead * block.memory.dilation for block in self.blocks)

    @property
    def rows(self) -> int:
        """Rows of `units` values in the workspace."""
        held = sum((past + ahead) * dilation for past, ahead, dilation in (block.memory for block in self.blocks))
        return held + sum(block.memory.ahead * block.memory.dilation for block in self.blocks[1:])


def _rows(weight: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Weights (R, columns) as integers, and the shift of each row, (R,): the largest that keeps them below 128."""
    weight = np.asarray(weight, dtype=np.float64)
    most = np.maximum(np.abs(weight).max(axis=1), 1e-9)
    shift = np.clip(np.floor(np.log2(_WEIGHT_MAX / most)), 0, _SHIFT_MAX).astype(np.int64)
    rounded = np.rint(weight * 2.0 ** shift[:, None])
    return np.clip(rounded, -_WEIGHT_MAX, _WEIGHT_MAX).astype(np.int64), shift


def rounded(weight: np.ndarray) -> np.ndarray:
    """The weights (R, columns) that the tables hold in the place of these, float64."""
    number, shift = _rows(weight)
    return number / 2.0 ** shift[:, None]


def _dense(what: str, weight: np.ndarray, bias: np.ndarray) -> Dense:
    number, shift = _rows(weight)
    scaled = np.rint(np.asarray(bias, dtype=np.float64) * ACTIVATION).astype(np.int64)
    if np.abs(scaled).max() > 32767:
        raise ModelError(f"{what} has a bias of {np.abs(bias).max():g}, the largest is 63.99")
    return Dense(number, scaled, shift)


def _positions(value: np.ndarray) -> np.ndarray:
    return np.rint(np.asarray(value, dtype=np.float64) * POSITION).astype(np.int64)


def quantise(model: HearingModel, name: str) -> HearingTables:
    """The tables of a model under this name in C. Raises ModelError for a bias that they cannot hold."""
    blocks = []
    for k, memory in enumerate(model.memories):
        taps, shift = _rows(model.memory[k])
        blocks.append(BlockTables(_dense(f"block {k}", model.dense[k], model.bias[k]), memory, taps, shift))
    heads = _dense("the heads", np.concatenate([model.class_weight, model.closed_weight[None], model.fap_weight]),
                   np.concatenate([model.class_bias, model.closed_bias, model.fap_bias]))
    start, end = (round(value * ACTIVATION) for value in (model.close_from, model.close_to))
    return HearingTables(name, model.classes, tuple(blocks),
                         _dense("the last layer", model.last, model.last_bias), heads, start, max(end - start, 1),
                         _positions(model.fap_mean), _positions(model.fap_scale), _positions(model.closed),
                         np.rint(model.closing * 256.0).astype(np.int64), model.attribution)
