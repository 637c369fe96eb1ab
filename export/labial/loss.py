"""What exporting costs: the exported tables against the float model, and what the run-time does differently from the
published method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence

import numpy as np

from labial.faps import CHANNELS
from labial.fixed import COST_SCALE, LEAP
from labial.model import Model
from labial.phones import Stream
from labial.quantise import ExportedModel
from labial.reference.published import path_cost, viterbi
from labial.reference.stream import aims
from labial.reference.stream import synthesise as as_device
from labial.reference.synthesis import is_published, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.viterbi import block_ends, looked_at


@dataclass(frozen=True)
class Deviation:
    """How far the run-time is from the published method by design: RMS over all channels, FAP units."""

    total: float  #: on the exported tables
    trained: float  #: on the float tables

    def __str__(self) -> str:
        return (f"The device differs from the published method by {self.total:.1f} FAP units RMS, by design: it "
                f"decides on states as the frames arrive and solves a window of them, without beginning anew at each "
                f"unit ({self.trained:.1f} on the trained tables), and its own tables soften the stiffness of states "
                f"to what the solver can carry.")


@dataclass(frozen=True)
class Loss:
    """Per channel, (13,): `rms` and `largest` difference between the motions of the float model, by the reference of
    its method, and of the exported tables, FAP; `extent`, the 1 to 99 percentile range that `rms` is held against, FAP;
    `path`, nats of likelihood that the exported tables' state paths lose per state, against the likeliest of the whole
    stream. `by_design`, of a model of the published method, is how the device differs from that over all channels."""

    rms: np.ndarray
    largest: np.ndarray
    extent: np.ndarray
    path: np.ndarray
    by_design: Optional[Deviation]

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
    """The loss over `streams`, each of a frame at least."""
    ideal, tables = FloatTables(model), ExportedTables(exported)
    expected = np.concatenate([synthesise(model, stream) for stream in streams])
    found = np.concatenate([as_device(tables, stream) for stream in streams])
    difference = found - expected
    paths = np.concatenate([path_loss(ideal, tables, stream) for stream in streams])
    return Loss(
        rms=np.sqrt(np.mean(difference**2, axis=0)),
        largest=np.abs(difference).max(axis=0),
        extent=channel_extent(model, expected),
        path=paths.mean(axis=0),
        by_design=deviation(model, streams, expected, found),
    )


def deviation(model: Model, streams: Sequence[Stream], published: np.ndarray, found: np.ndarray
              ) -> Optional[Deviation]:
    """The deviation over `streams`, of which `published` (T, 13) is the float model's motion, by the reference of its
    method, and `found` (T, 13) that of the exported tables, FAP. None for a model that is not of the published method.
    """
    if not is_published(model):
        return None
    tables = FloatTables(model)
    trained = np.concatenate([as_device(tables, stream) for stream in streams])
    total, on_trained = (float(np.sqrt(np.mean((motion - published) ** 2))) for motion in (found, trained))
    return Deviation(total, on_trained)


def path_loss(ideal: FloatTables, tables: ExportedTables, stream: Stream) -> np.ndarray:
    """(1, 13) nats per state by which the exported tables' path is less likely than the best, by the float tables."""
    wanted, _, _ = aims(ideal, stream)
    given, _, ends = aims(tables, stream)
    taken = tables.search(given, ends)
    chains = ideal.chains
    transition = np.minimum(chains.transition, LEAP / COST_SCALE)  # the library enters any state at that cost
    lost: List[float] = []
    for k in range(CHANNELS):
        last = block_ends(len(given), ideal.stride, k)
        seen = wanted[looked_at(len(given), ideal.stride, len(last))[:, k], k]
        every = np.broadcast_to(np.arange(chains.mean.shape[1]), chains.mean.shape)
        emission = chains.emission(np.repeat(seen[:, None], CHANNELS, axis=1), every)[:, k]
        terms = (emission, transition[k], chains.initial[k])
        lost.append(float(path_cost(taken[last, k], *terms) - path_cost(viterbi(*terms), *terms)) / len(last))
    return np.array([lost])
