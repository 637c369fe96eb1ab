"""Compares an exported model, run by the C library, with the reference, within the limits below.

A model of the published method is compared with that method, unit by unit. The device differs from it by design: it has
to be as the reference on its own tables, and how far that is from the published method is said, not judged.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import List, Optional, Sequence

import numpy as np

from labial.faps import FAP_NAMES
from labial.loss import Deviation, channel_extent, deviation
from labial.model import Model
from labial.native import NativeModel
from labial.phones import Stream
from labial.quantise import ExportedModel
from labial.reference.stream import synthesise as as_device
from labial.reference.synthesis import is_published, synthesise
from labial.reference.tables import ExportedTables

#: Against float64 on the same tables, after rounding to whole FAP units.
LARGEST = 1.0
RMS = 0.25

#: Against the float model: root mean square in percent of each channel's range.
SHARE = 1.0


@dataclass(frozen=True)
class Comparison:
    """Per channel, (13,), FAP: the library against the reference on the same tables, rounded as the library rounds, and
    against the float model by the reference of its method; and the range of each channel. Of a model of the published
    method also how far the device is from that by design."""

    frames: int
    tables_largest: np.ndarray
    tables_rms: np.ndarray
    model_rms: np.ndarray
    extent: np.ndarray
    by_design: Optional[Deviation] = None

    @property
    def overall_rms(self) -> float:
        """RMS over all channels, against the reference on the same tables."""
        return float(np.sqrt(np.mean(self.tables_rms**2)))

    def failures(self) -> List[str]:
        """A sentence for each limit that is exceeded."""
        found = []
        if self.overall_rms > RMS:
            found.append(f"RMS {self.overall_rms:.3f} from the reference on the same tables, limit {RMS}")
        for k, name in enumerate(FAP_NAMES):
            if self.tables_largest[k] > LARGEST:
                found.append(f"{name}: {self.tables_largest[k]:.0f} FAP units from the reference on the same tables, "
                             f"limit {LARGEST:.0f}")
            share = 100.0 * self.model_rms[k] / self.extent[k]
            if share > SHARE and not self.by_design:
                found.append(f"{name}: RMS {share:.2f} % of its range from the float model, limit {SHARE} %")
        return found

    def table(self) -> str:
        """What was measured, one line per channel."""
        other = "published method" if self.by_design else "float model"
        lines = [f"{self.frames} frames; FAP units",
                 f"{'channel':<24}{'same tables: max':>18}{'rms':>8}{other + ': rms':>23}{'% of range':>12}"]
        for k, name in enumerate(FAP_NAMES):
            share = 100.0 * self.model_rms[k] / self.extent[k]
            lines.append(f"{name:<24}{self.tables_largest[k]:>18.0f}{self.tables_rms[k]:>8.3f}"
                         f"{self.model_rms[k]:>23.3f}{share:>12.2f}")
        lines.append(f"{'all channels':<24}{self.tables_largest.max():>18.0f}{self.overall_rms:>8.3f}")
        if self.by_design:
            lines.append(str(self.by_design))
        return "\n".join(lines)


def _of_kept_transitions(model: Model, exported: ExportedModel) -> Model:
    """The model with the transitions alone that are exported; what fewer of them cost, `labial export` tells."""
    kept = np.isfinite(exported.dense_transitions())
    return replace(model, log_transition=np.where(kept, model.log_transition, -np.inf))


def compare(
    model: Model, exported: ExportedModel, streams: Sequence[Stream], library: Optional[str] = None
) -> Comparison:
    """Runs `streams` through the library, compiled with the host's C compiler, and through both references."""
    with NativeModel(exported, library) as native:
        frames = np.concatenate(native.synthesise(streams))
    tables = ExportedTables(exported)
    ideal = model if is_published(model) else _of_kept_transitions(model, exported)
    same = np.concatenate([as_device(tables, stream) for stream in streams])
    wanted = np.concatenate([synthesise(ideal, stream) for stream in streams])
    difference = frames - np.floor(same + 0.5)
    return Comparison(
        frames=len(frames),
        tables_largest=np.abs(difference).max(axis=0),
        tables_rms=np.sqrt(np.mean(difference**2, axis=0)),
        model_rms=np.sqrt(np.mean((frames - wanted) ** 2, axis=0)),
        extent=channel_extent(model, wanted),
        by_design=deviation(model, streams, wanted, same),
    )
