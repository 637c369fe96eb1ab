"""The loss of exporting, tables against the float model; the run-time's deviation from the published method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Optional, Sequence

import numpy as np

from labial.files.faps import CHANNELS, FAP_NAMES
from labial.reference.published import path_cost, viterbi
from labial.reference.stream import aims
from labial.reference.stream import synthesise as as_device
from labial.reference.synthesis import is_published, synthesise
from labial.reference.tables import ExportedTables, FloatTables, Tables
from labial.reference.trajectory import WINDOW
from labial.reference.viterbi import block_ends, looked_at
from labial.tables import emit
from labial.tables.fixed import COST_SCALE, LEAP, SEARCHED, WEIGHT_MIN, weight_value
from labial.tables.followers import solved
from labial.tables.layout import table_bytes
from labial.tables.model import Model
from labial.tables.phones import Stream
from labial.tables.quantise import ExportedModel


@dataclass(frozen=True)
class Deviation:
    """The run-time's deviation from the published method by design: RMS over all channels, FAP units."""

    total: float  #: on the exported tables
    trained: float  #: on the float tables; 0 of a library that is built to the letter

    def __str__(self) -> str:
        if not self.trained:
            return (f"The device differs from the published method by {self.total:.1f} FAP units RMS: it is that "
                    f"method, and its tables are integers.")
        return (f"The device differs from the published method by {self.total:.1f} FAP units RMS, by design: it "
                f"decides on states as the frames arrive and solves a window of them, without beginning anew at each "
                f"unit ({self.trained:.1f} on the trained tables), and its own tables soften the stiffness of states "
                f"to what the solver can carry.")


@dataclass(frozen=True)
class Loss:
    """Per channel, (13,): motion of the exported tables against the float model's, by the reference of its method."""

    rms: np.ndarray  #: FAP
    largest: np.ndarray  #: FAP
    extent: np.ndarray  #: FAP: the 1 to 99 percentile range, to compare `rms` with
    path: np.ndarray  #: nats per state that the exported tables' paths lose against the stream's most probable path
    by_design: Optional[Deviation]  #: of a model of the published method

    @property
    def share(self) -> np.ndarray:
        """(13,) rms in percent of the range."""
        return 100.0 * self.rms / self.extent


def channel_extent(model: Model, motion: np.ndarray) -> np.ndarray:
    """(13,) FAP: the 1 to 99 percentile range of the model's corpus; of `motion` (T, 13) where it does not tell."""
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
    return Loss(rms=np.sqrt(np.mean(difference**2, axis=0)), largest=np.abs(difference).max(axis=0),
                extent=channel_extent(model, expected), path=paths.mean(axis=0),
                by_design=deviation(model, streams, expected, found))


def deviation(model: Model, streams: Sequence[Stream], published: np.ndarray, found: np.ndarray,
              as_built: Callable[[Tables, Stream], np.ndarray] = as_device) -> Optional[Deviation]:
    """The deviation over `streams`, of which `published` (T, 13) is the float model's motion, by the reference of its
    method, and `found` (T, 13) that of the exported tables, FAP; `as_built` is the reference
    of the run-time's method. None for a model that is not of the published method."""
    if not is_published(model):
        return None
    tables = FloatTables(model)
    trained = np.concatenate([as_built(tables, stream) for stream in streams])
    total, on_trained = (float(np.sqrt(np.mean((motion - published) ** 2))) for motion in (found, trained))
    return Deviation(total, on_trained)


def path_loss(ideal: FloatTables, tables: ExportedTables, stream: Stream) -> np.ndarray:
    """(1, 13) nats per state by which, by the float tables, the exported ones' path is less likely than the best; 0 in
    channels that follow others."""
    wanted, _, _ = aims(ideal, stream)
    given, _, ends = aims(tables, stream)
    taken = tables.search(given, ends)
    chains = ideal.chains
    transition = np.minimum(chains.transition, LEAP / COST_SCALE)  # the library enters any state at that cost
    lost = np.zeros((1, CHANNELS))
    for k, channel in enumerate(ideal.solved):
        last = block_ends(len(given), ideal.stride, k)
        seen = wanted[looked_at(len(given), ideal.stride, len(last))[:, k], k]
        every = np.broadcast_to(np.arange(chains.mean.shape[1]), chains.mean.shape)
        emission = chains.emission(np.repeat(seen[:, None], len(chains.mean), axis=1), every)[:, k]
        terms = (emission, transition[k], chains.initial[k])
        lost[0, channel] = (path_cost(taken[last, k], *terms) - path_cost(viterbi(*terms), *terms)) / len(last)
    return lost


def workspace_bytes(stride: int, channels: int) -> int:
    """LABIAL_WORKSPACE_SIZE of the library's default limits."""
    progress = 44 + 8 * (WINDOW + 1) + (3 + SEARCHED + 3) // 4 * 4
    shapes = 2 * 4  # of the present phoneme and of the next one
    return channels * (progress + shapes) + (stride * (32 + 2 * channels) + 3) // 4 * 4


def memory(exported: ExportedModel) -> str:
    """Flash by group of tables, and RAM."""
    tables = {f"flash, {name}": size for name, size in table_bytes(exported).items()}
    rows = {**tables, "flash, model": sum(tables.values()), "flash, names, if used": emit.names_bytes(exported),
            "RAM, workspace": workspace_bytes(exported.search_stride, len(exported.centre))}
    return "\n".join(f"{name:<32}{size:>8} bytes" for name, size in rows.items())


def loosened(model: Model, exported: ExportedModel) -> int:
    """States whose delta-delta weight is less of what holds them than trained by more than codes are rounded."""
    trained = model.state_precision[..., 2] / (model.state_precision[..., 0] + model.state_anchor)
    trained = trained[solved(exported.source)]
    kept = weight_value(exported.state_weight[..., 1]) / weight_value(exported.state_hold)
    return int((kept < 0.85 * trained).sum())


def quantisation(loss: Loss, model: Model, exported: ExportedModel) -> str:
    """The loss per channel, and what was dropped or held to a limit."""
    title = "from the published method, FAP" if loss.by_design else "quantisation loss, FAP units"
    lines = [f"{title:<32}{'rms':>8}{'max':>8}{'% of range':>12}{'nats per state':>15}"]
    for k, name in enumerate(FAP_NAMES):
        lines.append(f"{name:<32}{loss.rms[k]:>8.3f}{loss.largest[k]:>8.2f}{loss.share[k]:>12.2f}{loss.path[k]:>15.3f}")
    possible = int(np.isfinite(model.log_transition[solved(exported.source)]).sum())
    kept = int(np.isfinite(exported.dense_transitions()).sum())
    lines.append(f"transitions kept: {kept} of {possible}; the state paths lose {loss.path.mean():.3f} nats per state "
                 "on average")
    floor = int((weight_value(exported.state_hold) <= WEIGHT_MIN).sum())
    lines.append(f"states held by no more than the least weight: {floor} of {exported.state_hold.size}")
    lines.append(f"states that are less stiff than trained, within the solver's bounds: {loosened(model, exported)} "
                 f"of {exported.state_hold.size}")
    if loss.by_design:
        lines.append(str(loss.by_design))
    return "\n".join(lines)
