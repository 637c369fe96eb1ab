"""The tables of an exported model in the order of the C source, the binary form and the report of sizes.

One list says for each table its C type and its layout (``include/labial/model.h``, ``include/labial/blob.h``);
``labial.tables.emit`` writes it as C, :func:`blob` as bytes, :func:`table_bytes` adds up its sizes.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from itertools import chain
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.core.library import BLOB_MAGIC
from labial.errors import ModelError
from labial.tables.followers import FROM_CORNERS, IN_TABLES, VALUES, columns
from labial.tables.quantise import FORMAT, ExportedModel


def check_fits(name: str, code: str, values: np.ndarray) -> None:
    """Raises ModelError, which calls the table `name`, unless all of `values` (R,) are integers in the range of the C
    type that :mod:`struct` calls `code`."""
    bits = 8 * struct.calcsize("<" + code)
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if code.islower() else (0, (1 << bits) - 1)
    wrong = ~((values >= low) & (values <= high) & (values == np.rint(values)))
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ModelError(f"the table {name} cannot be written: in row {row} a value is {values[row]:g}, not a whole "
                         f"number within {low} .. {high}")


@dataclass(frozen=True)
class Table:
    """A table of R rows of F integers; without rows it is absent, and the model's pointer to it is NULL."""

    name: str  #: in C
    kind: str  #: its C type
    layout: str  #: the format of a row's F integers for :mod:`struct`
    rows: np.ndarray  #: (R, F) or (R,) int64
    pattern: str = "%d"  #: a row in C
    group: str = ""  #: its name in the report of sizes; `name` if empty

    @property
    def size(self) -> int:
        """Bytes."""
        return struct.calcsize("<" + self.layout) * len(self.rows)

    def __post_init__(self) -> None:
        """Raises ModelError, which names the table and the row, for a value out of its C type's range."""
        rows = np.reshape(self.rows, (len(self.rows), len(self.layout)))
        for column, code in enumerate(self.layout):
            check_fits(self.name, code, rows[:, column])

    def packed(self) -> bytes:
        """The rows as little-endian bytes."""
        return struct.pack("<" + self.layout * len(self.rows), *self.rows.ravel().tolist())


def _flat(name: str, kind: str, layout: str, values: Optional[np.ndarray], group: str = "") -> Table:
    return Table(name, kind, layout, np.zeros(0, dtype=np.int64) if values is None else np.ravel(values), group=group)


def shared_tables(model: ExportedModel) -> List[Table]:
    """The tables of all channels together."""
    phonemes = np.stack([model.first_component, model.component_count, model.viseme_class, model.boundary, model.floor],
                        axis=1)
    components = np.stack([model.cost, model.duration_mean, model.duration_gain], axis=1)
    computed = np.zeros((0, 19), dtype=np.int64) if model.protrusion is None else model.protrusion[None]
    return [
        Table("phonemes", "labial_phoneme_t", "HBBBB", phonemes, "{ %d, %d, %d, %d, %d }"),
        Table("components", "labial_component_t", "HHH", components, "{ %d, %d, %d }", "phonemes"),
        _flat("contexts", "uint8_t", "B", _contexts(model)),
        _flat("shapes", "int8_t", "b", model.shapes),
        _flat("slopes", "int8_t", "b", model.slopes),
        Table("kernels", "uint32_t", "I", _kernel_words(model.kernels), "0x%08xu"),
        _flat("pair_keys", "uint16_t", "H", model.pair_keys, "pairs"),
        _flat("pairs", "int8_t", "b", model.pairs),
        _flat("floors", "int16_t", "h", model.floors[1:]),  # the first is none at all
        _flat("contacts", "uint16_t", "H", model.contacts[1:], "floors"),
        Table("protrusion", "labial_protrusion_t", "hH" + VALUES * "h", computed,
              f"{{ %d, %d, {{ {', '.join(VALUES * ['%d'])} }} }}"),
    ]


def _contexts(model: ExportedModel) -> Optional[np.ndarray]:
    """(N, V) the previous class's cost in the low four bits, the next one's in the high four."""
    if model.contexts is None:
        return None
    if not ((model.contexts >= 0) & (model.contexts <= 15)).all():
        raise ModelError("the table contexts cannot be written: a value is not a whole number within 0 .. 15")
    return model.contexts[:, 0] | model.contexts[:, 1] << 4


def _kernel_words(kernels: np.ndarray) -> np.ndarray:
    """(P L W, 1) words of kernels (P, L, C), four channels to a word, each 128 more; zeros fill the last."""
    check_fits("kernels", "b", kernels.reshape(-1))
    biased = np.pad(kernels, [(0, 0), (0, 0), (0, -kernels.shape[-1] % 4)]).reshape(-1, 4) + 128
    return biased @ (1 << np.array([[0], [8], [16], [24]]))


def channel_tables(model: ExportedModel, k: int) -> List[Table]:
    """The tables of channel `k`."""
    emissions = np.stack([model.emission_mean[k], model.emission_gain[k], model.emission_cost[k]], axis=1)
    states = np.column_stack([model.state_mean[k], model.state_motion[k], model.state_hold[k], model.state_share[k],
                              model.state_weight[k]])
    return [Table(f"emissions_{k}", "labial_emission_t", "hBB", emissions, "{ %d, %d, %d }", "states"),
            Table(f"states_{k}", "labial_state_t", "hbbBBBB", states, "{ %d, { %d, %d }, %d, %d, { %d, %d } }",
                  "states"),
            Table(f"transitions_{k}", "labial_transition_t", "BB", model.transitions[k].reshape(-1, 2), "{ %d, %d }",
                  "transitions"),
            _flat(f"initials_{k}", "uint8_t", "B", model.initial[k], "states")]


#: The layout of :func:`channel_scalars`.
CHANNEL_SCALARS = "hHHHHHHB"


def channel_scalars(model: ExportedModel, channel: int) -> List[int]:
    """The members of ``labial_channel_t`` before its pointers: centre, scales of shapes, slopes, kernels, pairs and
    motion, weight in contact."""
    values = [int(values[channel]) for values in (
        model.centre, model.shape_scale, model.slope_scale, model.kernel_scale, model.pair_scale,
        *model.motion_scale.T, model.firm)]
    for code, value in zip(CHANNEL_SCALARS, values):
        check_fits(f"channels[{channel}]", code, np.array([value]))
    return values


def scalars(model: ExportedModel) -> List[Tuple[str, int, str]]:
    """Name, value and layout of the first members of ``labial_model_t`` and of the binary form."""
    values = [("format", FORMAT, "H"), ("frames_per_second", model.fps, "H"), ("component_count", len(model.cost), "H"),
              ("phoneme_count", len(model.phonemes), "B"), ("class_count", len(model.classes), "B"),
              ("state_count", model.transitions.shape[1], "B"),
              ("predecessor_fours", model.transitions.shape[2] // 4, "B"), ("search_stride", model.search_stride, "B"),
              ("silence", model.silence, "B"), ("mixture_mean", int(model.soft), "B"),
              ("kernel_taps", model.kernels.shape[1], "B"), ("kernel_stride", model.kernel_stride, "B"),
              ("kernel_behind", model.kernel_behind, "B")]
    for name, value, code in values:
        check_fits(name, code, np.array([value]))
    return values


def sources(model: ExportedModel) -> List[int]:
    """`sources` of ``labial_model_t``."""
    column = columns(model.source)
    return [int(of) for of in np.where(column == FROM_CORNERS, IN_TABLES, column)]


def table_bytes(model: ExportedModel) -> Dict[str, int]:
    """Flash bytes of each group of tables on a 32-bit target, without names."""
    sizes: Dict[str, int] = {}
    for table in chain(shared_tables(model), *(channel_tables(model, k) for k in range(len(model.centre)))):
        group = table.group or table.name
        sizes[group] = sizes.get(group, 0) + table.size
    return {**sizes, "descriptors": 32 * len(model.centre) + 84}


def _packed(tables: Sequence[Table]) -> bytes:
    return b"".join(table.packed() + bytes(-table.size % 4) for table in tables)


def blob(model: ExportedModel) -> bytes:
    """NAME.lbm: the binary form that ``labial_model_load`` reads (``include/labial/blob.h``)."""
    optional = ((model.contexts is not None) | (model.slopes is not None) << 1 | (model.pairs.shape[1] == 2) << 2
                | (model.protrusion is not None) << 3)
    _, values, codes = zip(*scalars(model))
    head = struct.pack(f"<{''.join(codes)}BBH", *values, optional, len(model.floors) - 1, len(model.pair_keys))
    head += bytes([len(model.centre), *sources(model), 0, 0])
    body = head + _packed(shared_tables(model))
    for k in range(len(model.centre)):
        body += struct.pack(f"<{CHANNEL_SCALARS}B", *channel_scalars(model, k), 0) + _packed(channel_tables(model, k))
    return BLOB_MAGIC + struct.pack("<II", 12 + len(body), zlib.crc32(body)) + body
