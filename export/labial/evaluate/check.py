"""Compares an exported model, run by the C library, with the reference, within the limits below.

A model of the published method is compared with that method, unit by unit. The device differs from it by design: it
must equal the reference on its own tables; the distance from the published method is reported, not judged. A library
that is built to the letter (LABIAL_METHOD of lib/CMakeLists.txt) must equal the published method on its own tables.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.core.library import method
from labial.errors import ModelError
from labial.evaluate.loss import Deviation, channel_extent, deviation
from labial.files.faps import CHANNELS, FAP_NAMES
from labial.reference import published
from labial.reference.fade import delivered
from labial.reference.stream import synthesise as as_device
from labial.reference.synthesis import frames_of, is_published, synthesise
from labial.reference.tables import ExportedTables
from labial.runtime.models import Model as DeviceModel
from labial.runtime.stream import Stream as DeviceStream
from labial.tables.followers import solved
from labial.tables.layout import blob
from labial.tables.model import Model
from labial.tables.phones import Stream
from labial.tables.quantise import ExportedModel

#: Against float64 on the same tables, after rounding to whole FAP units.
LARGEST = 1.0
RMS = 0.25
#: Against the float model: root mean square in percent of each channel's range.
SHARE = 1.0
#: With fewer frames (20 s) that share is not judged: one phoneme with another path in the rounded tables exceeds it.
FRAMES = 1000


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
        """A message for each exceeded limit."""
        found = []
        if self.overall_rms > RMS:
            found.append(f"RMS {self.overall_rms:.3f} from the reference on the same tables, limit {RMS}")
        for k, name in enumerate(FAP_NAMES):
            if self.tables_largest[k] > LARGEST:
                found.append(f"{name}: {self.tables_largest[k]:.0f} FAP units from the reference on the same tables, "
                             f"limit {LARGEST:.0f}")
            share = 100.0 * self.model_rms[k] / self.extent[k]
            if share > SHARE and self.frames >= FRAMES and not self.by_design:
                found.append(f"{name}: RMS {share:.2f} % of its range from the float model, limit {SHARE} %")
        return found

    def table(self) -> str:
        """The measurements, one line per channel."""
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
        elif self.frames < FRAMES:
            lines.append(f"{self.frames} frames are too few to judge the distance from the float model, which takes "
                         f"{FRAMES:,}")
        return "\n".join(lines)


def device_model(exported: ExportedModel) -> DeviceModel:
    """The exported model in the run-time. Raises ModelError for one that the library refuses."""
    with tempfile.TemporaryDirectory(prefix="labial-") as folder:
        path = Path(folder) / f"{exported.name}.lbm"
        path.write_bytes(blob(exported))
        return DeviceModel(path)


def device_frames(exported: ExportedModel, streams: Sequence[Sequence[Tuple[int, int]]]) -> List[np.ndarray]:
    """The library's frames, (T, 13) int64, of each stream of (phoneme number, milliseconds) alone."""
    model = device_model(exported)
    return [stream_frames(model, phonemes) for phonemes in streams]


def stream_frames(model: DeviceModel, phonemes: Sequence[Tuple[int, int]]) -> np.ndarray:
    """The library's frames, (T, 13) int64, of a stream of (phoneme number, milliseconds)."""
    with DeviceStream(model, exact=True) as stream:
        for number, milliseconds in phonemes:
            stream.push(number, milliseconds)
        stream.end()
        return np.array(stream.drain(), dtype=np.int64).reshape(-1, CHANNELS)


def compare(model: Model, exported: ExportedModel, streams: Sequence[Stream]) -> Comparison:
    """Runs `streams` through the library and both references. Raises ModelError where their methods differ."""
    to_the_letter = method() == "paper"
    if to_the_letter and not is_published(model):
        raise ModelError("the run-time is built for the published method (LABIAL_METHOD=paper), and the model is not: "
                         "train it by --method paper")
    frames = np.concatenate(device_frames(exported, streams))
    tables = ExportedTables(exported)
    as_built = published.synthesise if to_the_letter else as_device
    ideal = model
    if not is_published(model):  # with its exported transitions alone; `labial export` tells the loss of the others
        kept = np.ones(model.log_transition.shape, dtype=bool)
        kept[solved(exported.source)] = np.isfinite(exported.dense_transitions())
        ideal = replace(model, log_transition=np.where(kept, model.log_transition, -np.inf))
    same = np.concatenate([as_built(tables, stream) for stream in streams])
    wanted = np.concatenate([synthesise(ideal, stream) for stream in streams])
    lengths = np.cumsum([frames_of(model, stream) for stream in streams])[:-1]

    def from_rest(motion: np.ndarray) -> np.ndarray:
        return np.concatenate([delivered(part, exact=True) for part in np.split(motion, lengths)])

    difference = frames - np.floor(from_rest(same) + 0.5)
    return Comparison(frames=len(frames), tables_largest=np.abs(difference).max(axis=0),
                      tables_rms=np.sqrt(np.mean(difference**2, axis=0)),
                      model_rms=np.sqrt(np.mean((frames - from_rest(wanted)) ** 2, axis=0)),
                      extent=channel_extent(model, wanted), by_design=deviation(model, streams, wanted, same, as_built))
