"""The input of baking: phoneme timings, a sound or frames, recognised by the file."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import List, NamedTuple, Optional, Tuple

import numpy as np

from labial.corpus.formats import SOUNDS, read_timings
from labial.corpus.phonesets import AUTO
from labial.corpus.timings import SourceSegment, phone_set_of, phoneme_segments
from labial.errors import DataError, LabialError, PathLike, needs
from labial.files.faps import CHANNELS
from labial.files.frames import even, spans
from labial.see.motion import read_motion
from labial.tables.bundled import BY_KIND
from labial.tables.model import Model, load
from labial.tables.phones import Stream, phone_set, stream_of

#: Suffixes, in small letters, of frames; other files are sounds or timings.
FRAMES = (".csv", ".fap")
#: Frames per second of a track.
RATE = 50
#: Most frames of a track: five and a half hours.
_LONGEST = 1_000_000
#: Shortest pause in which a track may be cut, seconds, and the largest change between still frames, FAP units.
PAUSE, _STILL = 0.4, 1.0


@dataclass(frozen=True)
class Source:
    """The command's options about its input."""

    path: str
    model: Optional[str] = None  #: a model's file or name; without it the bundled one that knows the labels
    text: Optional[str] = None  #: the text of a sound
    labels: str = AUTO
    format: Optional[str] = None  #: of the timings; told by the file without it
    tier: Optional[str] = None  #: of a TextGrid
    progress: bool = False  #: whether to show a progress bar for a sound

    @property
    def is_sound(self) -> bool:
        """Whether the file is a sound, by its name."""
        return self.format is None and Path(self.path).suffix.lower() in SOUNDS

    @property
    def has_frames(self) -> bool:
        """Whether the file holds frames, by its name."""
        return self.format is None and Path(self.path).suffix.lower() in FRAMES


def read_phonemes(source: Source) -> Tuple[Model, str, Stream]:
    """The model, what the model is called, and the phonemes of timings or of a sound. Raises DataError."""
    if source.has_frames:
        raise DataError(source.path, None, "holds frames, which have no phonemes; --as track takes frames")
    segments = _heard(source) if source.is_sound else _timed(source)
    name = source.model or BY_KIND[phone_set_of(segments, source.labels).kind]
    model = load(name)
    found = phoneme_segments(source.path, segments, phone_set(model), False, source.labels)
    return model, Path(name).stem, stream_of(found, model, 0)


def _timed(source: Source) -> List[SourceSegment]:
    if source.text is not None:
        raise LabialError(f"{source.path}: a text goes with a sound ({', '.join(SOUNDS)}), not with timings or frames")
    return read_timings(source.path, source.format, tier=source.tier)


def _heard(source: Source) -> List[SourceSegment]:
    with needs("a sound", "align"):
        from labial.sound.align import align_with_bar
    found = align_with_bar(source.path, source.text, source.progress)
    if source.text is None:
        warnings.warn(f"{source.path}: without its text (--text, --text-file) phonemes are less sure", stacklevel=2)
    return [SourceSegment(item.start, item.end, item.label, None, "arpabet") for item in found.segments]


class Motion(NamedTuple):
    """Frames at `RATE` from time 0."""

    frames: np.ndarray  #: (T, 13) FAPs, float64
    pauses: np.ndarray  #: (T,) bool: in a pause of `PAUSE` or more
    shares: Optional[np.ndarray] = None  #: (T, 15) of the sounds, where there are phonemes


def read_track(source: Source) -> Motion:
    """The motion of a file of frames, of timings or of a sound; but for frames it begins and ends at rest. Pauses are
    silences; of frames those stretches in which they hardly move."""
    if source.has_frames:
        if source.text is not None or source.model:
            raise LabialError(f"{source.path}: frames need neither a text nor a model")
        motion = read_motion(source.path)
        frames = _at_rate(source.path, motion.times, motion.frames)
        still = np.abs(np.diff(frames, axis=0)).max(axis=1, initial=0.0) < _STILL
        return Motion(frames, _long(np.append(still, False)))
    from labial.reference import stream, synthesis
    from labial.reference.fade import delivered
    from labial.reference.tables import ExportedTables
    from labial.rig.animation import with_shares
    from labial.tables.quantise import quantise

    model, _, phonemes = read_phonemes(source)
    _check_length(source.path, sum(milliseconds for _, milliseconds in phonemes) / 1000.0)
    if synthesis.is_published(model):
        frames = synthesis.synthesise(model, phonemes)
    else:  # on the integer tables, so that choices at near ties are those of a board
        frames = stream.synthesise(ExportedTables(quantise(model, "baked")), phonemes)
    frames = with_shares(delivered(frames), [(model.phonemes[number], ms) for number, ms in phonemes], model.fps)
    frames = _at_rate(source.path, np.arange(len(frames)) / model.fps, frames)
    silence = model.phonemes.index(model.silence)
    ends = np.cumsum([milliseconds for _, milliseconds in phonemes]) * RATE / 1000.0
    at = np.minimum(np.searchsorted(ends, np.arange(len(frames)), side="right"), len(phonemes) - 1)
    pauses = _long(np.array([number == silence for number, _ in phonemes])[at])
    return Motion(frames[:, :CHANNELS], pauses, frames[:, CHANNELS:])


def _long(holds: np.ndarray) -> np.ndarray:
    """(T,) bool: `holds` (T,), but for stretches shorter than `PAUSE`."""
    result = np.zeros(len(holds), dtype=bool)
    for begin, end in spans(holds):
        result[begin:end] = end - begin >= PAUSE * RATE
    return result


def _check_length(path: PathLike, seconds: float) -> None:
    if seconds * RATE > _LONGEST:
        raise DataError(path, None, f"{seconds:.0f} s are too long: a track has at most {_LONGEST} frames")


def _at_rate(path: PathLike, times: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """Frames, of any numbers, at 50 a second from time 0, the sound's beginning: as they are, or interpolated linearly.
    Before the first and behind the last the mouth stays as it is there."""
    if times[-1] < 0:
        raise DataError(path, None, f"its last time, {times[-1]:g} s, lies before 0, where the sound begins")
    _check_length(path, float(times[-1]))
    try:
        rate, frames = even(times, frames)
    except ValueError as error:
        raise DataError(path, None, str(error)) from None
    times = times[0] + np.arange(len(frames)) / rate
    count = math.floor(round(float(times[-1] + 1.0 / rate) * RATE, 6) + 1e-3)
    grid = np.arange(max(count, 1)) / RATE
    return np.stack([np.interp(grid, times, channel) for channel in frames.T], axis=1)
