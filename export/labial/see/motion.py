"""Input of plots and pages: frames of any kind of motion file, and their phonemes as bands."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.folder import check_range, read_frames
from labial.corpus.formats import read_timings
from labial.corpus.phonesets import AUTO, LAUGHTER, SPEECH, VOWELS, PhoneSet
from labial.corpus.timings import meaning, phone_set_of
from labial.errors import DataError, LabialError, PathLike
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.files.frames import opening
from labial.files.grammar import fields_of, is_blank, is_number, is_whole, read_lines, shown
from labial.tables.bundled import is_model

#: Kinds of bands: visible features of a phoneme.
KINDS = ("vowel", "closed", "labiodental", "silence", "other")
#: FAPs that MPEG-4 defines, each with an entry in the mask of a .fap file.
_MASK = 68


@dataclass(frozen=True)
class Motion:
    """The motion of one file."""

    name: str  #: the file's name without its suffix
    times: np.ndarray  #: (T,) seconds, strictly increasing
    frames: np.ndarray  #: (T, 13) FAP units
    shares: Optional[np.ndarray] = None  #: (T, 15) of the sounds that a model speaks (labial.reference.visemes)


@dataclass(frozen=True)
class Band:
    """A phoneme from `start` to `end` (seconds), with its label in a phone set and one of `KINDS`."""

    start: float
    end: float
    label: str
    kind: str


def read_motion(path: PathLike, timings: Optional[PathLike] = None, labels: str = AUTO, source: Optional[str] = None,
                tier: Optional[str] = None) -> Motion:
    """Reads a frames file (CSV) or an MPEG-4 text file, which the suffix .fap tells; or, by a model, makes the motion
    of phoneme timings of the format `source`. Raises DataError; LabialError for a model without timings."""
    name = Path(path).stem
    if not is_model(path):
        return Motion(name, *(read_fap if Path(path).suffix.lower() == ".fap" else read_frames)(path))
    if timings is None:
        raise LabialError(f"{os.fspath(path)}: a model speaks phoneme timings: give --phones")
    from labial.reference.synthesis import delivered
    from labial.reference.visemes import shares
    from labial.tables.model import load
    from labial.tables.phones import read_stream

    model = load(path)
    phonemes = read_stream(timings, model, labels, source, tier)
    frames = np.concatenate(list(delivered(model, phonemes)))
    spoken = [(model.phonemes[number], milliseconds) for number, milliseconds in phonemes]
    return Motion(name, np.arange(len(frames)) / model.fps, frames, shares(spoken, model.fps, len(frames)))


def read_motions(paths: Sequence[PathLike], timings: Optional[PathLike] = None, labels: str = AUTO,
                 source: Optional[str] = None, tier: Optional[str] = None) -> List[Motion]:
    """Reads several as :func:`read_motion` does; where two have the same name, all are called by their paths."""
    motions = [read_motion(path, timings, labels, source, tier) for path in paths]
    if len({motion.name for motion in motions}) < len(motions):
        motions = [replace(motion, name=os.fspath(path)) for motion, path in zip(motions, paths)]
    return motions


def read_fap(path: PathLike) -> Tuple[np.ndarray, np.ndarray]:
    """Reads an MPEG-4 .fap text file: (T,) times in seconds and (T, 13) FAPs. A header ``2.1 NAME FPS FRAMES``, then
    two lines per frame: a mask of zeros and ones, one per FAP (a 69th entry, which some programs write, is ignored),
    and the frame's number with the values of the FAPs whose mask is one. Other FAPs keep their values, 0 at first."""
    lines = read_lines(path)
    rows = [(line, fields_of(text)) for line, text in enumerate(lines, 1) if not is_blank(text)]
    head = rows[0][1] if rows else []
    if len(head) < 4 or not is_number(head[0]) or not is_number(head[-2]) or not is_whole(head[-1]):
        raise DataError(path, 1, "the header is not 'VERSION NAME FPS FRAMES'")
    fps, count = float(head[-2]), int(head[-1])
    if not 0.001 <= fps <= 1000 or count < 1:
        raise DataError(path, 1, "the header is not 'VERSION NAME FPS FRAMES' with 1 or more frames")
    if len(rows) != 1 + 2 * count:
        raise DataError(path, rows[-1][0], f"{count} frames need {2 * count} lines after the header, "
                        f"there are {len(rows) - 1}")
    frames = np.zeros((count, CHANNELS))
    held = np.zeros(_MASK + 1)
    for index in range(count):
        (mask_line, mask), (line, values) = rows[1 + 2 * index], rows[2 + 2 * index]
        if len(mask) not in (_MASK, _MASK + 1) or set(mask) - {"0", "1"}:
            raise DataError(path, mask_line, f"expected a mask of {_MASK} zeros and ones")
        chosen = [number for number, bit in enumerate(mask, 1) if bit == "1"]
        for text in values:
            if not is_whole(text[text.startswith("-") :]):
                raise DataError(path, line, f"not a whole number: {shown(text)}")
        numbers = [int(value) for value in values]
        if len(numbers) != 1 + len(chosen):
            raise DataError(path, line, f"expected the frame's number and {len(chosen)} values, as the mask says, "
                            f"found {len(numbers)}")
        check_range(path, line, index / fps, numbers)
        for number, value in zip(chosen, numbers[1:]):
            if number <= _MASK:
                held[number] = value
        frames[index] = held[list(FAP_NUMBERS)]
    return np.arange(count) / fps, frames


def read_bands(path: Optional[PathLike], labels: str = AUTO, source: Optional[str] = None,
               tier: Optional[str] = None) -> List[Band]:
    """Reads phoneme timings of any format that :func:`read_timings` knows as bands; none without a path. Labels are of
    the set `labels`, and of speech or laughter, whichever knows more of them. An unknown label is not an error, since
    only the band's colour depends on it: it stays unchanged, of kind "other"."""
    if path is None:
        return []
    segments = [segment for segment in read_timings(path, source, tier=tier) if segment.end > segment.start]
    phones = phone_set_of(segments, labels)
    named = [(segment, meaning(segment, phones, labels)) for segment in segments]
    return [Band(segment.start, segment.end, segment.label if name is None else name,
                 "other" if name is None else kind_of(name, phones)) for segment, name in named]


def closures(motion: Motion, bands: Sequence[Band]) -> List[Tuple[str, float]]:
    """The label of each p, b, m and the least distance of the lips, FAP units, in frames whose middles fall into it."""
    distance = opening(motion.frames)
    middles = motion.times + (np.median(np.diff(motion.times)) / 2 if len(motion.times) > 1 else 0)
    found = [(band.label, distance[(band.start <= middles) & (middles < band.end)])
             for band in bands if band.kind == "closed"]
    return [(label, float(values.min())) for label, values in found if values.size]


def laughs(bands: Sequence[Band]) -> bool:
    """Whether the bands are those of a laugh, by the labels that they bear."""
    return any(band.label in LAUGHTER.phonemes and band.label not in SPEECH.phonemes for band in bands)


def kind_of(label: str, phones: PhoneSet) -> str:
    """Which of `KINDS` a phoneme of `phones` is."""
    if label == phones.silence:
        return "silence"
    if phones.kind == "speech":
        if label in VOWELS.split():
            return "vowel"
        name = phones.classes[phones.viseme_class[phones.phonemes.index(label)]]
        return {"bilabial": "closed", "labiodental": "labiodental"}.get(name, "other")
    return "vowel" if phones.boundary[phones.phonemes.index(label)] else "other"
