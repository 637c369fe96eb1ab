"""What exporting costs: the exported tables against the float model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence

import numpy as np

from labial.faps import CHANNELS
from labial.fixed import COST_SCALE, LEAP
from labial.model import Model
from labial.phones import Stream
from labial.quantise import ExportedModel
from labial.reference import units
from labial.reference.shape import targets
from labial.reference.stream import frame_counts, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.viterbi import looked_at, path_cost, viterbi


@dataclass(frozen=True)
class Loss:
    """Per channel, (13,): `rms` and `largest` difference between the motions of the float and the exported tables, FAP;
    `extent`, the 1 to 99 percentile range that `rms` is held against, FAP; `path`, nats of likelihood that the exported
    tables' state paths lose per piece."""

    rms: np.ndarray
    largest: np.ndarray
    extent: np.ndarray
    path: np.ndarray

    @property
    def share(self) -> np.ndarray:
        """(13,) rms in percent of the range."""
        return 100.0 * self.rms / self.extent


def channel_extent(model: Model, motion: np.ndarray) -> np.ndarray:
    """(13,) FAP: the 1 to 99 percentile range of each channel in the model's corpus, or in `motion` (T, 13) where the
    model does not tell."""
    known = model.training.get("channel_range")
    if isinstance(known, list) and len(known) == CHANNELS:
        return np.asarray(known, dtype=np.float64)
    return np.maximum(np.percentile(motion, 99, axis=0) - np.percentile(motion, 1, axis=0), 1.0)


def measure(model: Model, exported: ExportedModel, streams: Sequence[Stream]) -> Loss:
    """The loss over `streams`."""
    ideal, tables = FloatTables(model), ExportedTables(exported)
    expected = np.concatenate([synthesise(ideal, stream) for stream in streams])
    found = np.concatenate([synthesise(tables, stream) for stream in streams])
    difference = found - expected
    paths = np.concatenate([path_loss(ideal, tables, stream) for stream in streams])
    return Loss(
        rms=np.sqrt(np.mean(difference**2, axis=0)),
        largest=np.abs(difference).max(axis=0),
        extent=channel_extent(model, expected),
        path=paths.mean(axis=0),
    )


def path_loss(ideal: FloatTables, tables: ExportedTables, stream: Stream) -> np.ndarray:
    """(pieces, 13) nats by which the exported tables' path is less likely than the best, under the float tables."""
    numbers, durations = [p for p, _ in stream], [ms for _, ms in stream]
    frames = frame_counts(durations, ideal.fps)
    wanted = targets(ideal, numbers, durations, frames)
    given = targets(tables, numbers, durations, frames)
    transition = np.minimum(ideal.transition, LEAP / COST_SCALE)  # the library enters any state at that cost
    lost: List[np.ndarray] = []
    for piece in units.pieces(frames, [bool(ideal.boundary[p]) for p in numbers]):
        span = slice(piece.begin, piece.end)
        seen = looked_at(piece.end - piece.begin, ideal.stride)
        terms = (ideal.emission(wanted[span][seen]), transition, ideal.initial)
        best = path_cost(viterbi(*terms), *terms)
        taken = path_cost(tables.search(given[span])[:: ideal.stride], *terms)
        lost.append(taken - best)
    return np.array(lost).reshape(-1, CHANNELS)
