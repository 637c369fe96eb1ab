"""Sentences as motion, to solve rigs for and to judge them on.

``sentences.flite`` are 24 English sentences as flite times them (``flite -voice VOICE -t SENTENCE -psdur -o none``), in
turn by its voices kal, slt and rms: each phoneme with the second at which it ends.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Sequence, Tuple, Union

import numpy as np

from labial.errors import DataError
from labial.fit.meaning import fap
from labial.runtime.render import render
from labial.runtime.stream import Stream
from labial.tables.visemes import ONE, VISEMES

#: The bundled sentences.
SENTENCES = Path(__file__).with_name("sentences.flite")
_FPS = 50
#: Seconds that a closure may be early or late.
_AROUND = 0.02


@dataclass(frozen=True)
class Motion:
    """Frames, and which phonemes they are of."""

    frames: np.ndarray  #: (T, 13) FAP units
    phonemes: Sequence[Tuple[str, int, int]]  #: label, first frame and end, a frame wider than spoken on either side
    shares: Optional[np.ndarray] = None  #: (T, 15) of the sounds in each frame, 0 .. 1; None where they are not known

    @property
    def closures(self) -> List[Tuple[int, int]]:
        """First frame and end of each p, b, m."""
        return [(begin, end) for label, begin, end in self.phonemes if label in ("p", "b", "m")]

    @property
    def contact(self) -> np.ndarray:
        """(T,) bool: the frame of each closure in which the lips are nearest."""
        found = np.zeros(len(self.frames), dtype=bool)
        opening = -(fap(self.frames, 51) + fap(self.frames, 52))
        for begin, end in self.closures:
            found[begin + int(np.argmin(opening[begin:end]))] = True
        return found


def read_sentences(path: Union[str, os.PathLike[str]] = SENTENCES, laughs: Sequence[float] = ()) -> Motion:
    """The motion of a file of sentences, one a line, with the bundled English model; after them laughs of these
    intensities, two seconds each. Raises DataError naming file and line."""
    parts: List[np.ndarray] = []
    shares: List[np.ndarray] = []
    phonemes: List[Tuple[str, int, int]] = []
    first = 0
    for number, line in enumerate(Path(path).read_text(encoding="ascii").splitlines(), 1):
        timings: List[Tuple[str, float, float]] = []
        begin = 0.0
        for item in line.split():
            label, _, last = item.partition(":")
            try:
                timings.append((label, begin, float(last)))
            except ValueError:
                raise DataError(os.fspath(path), number, f"{item!r} is not LABEL:SECONDS") from None
            begin = timings[-1][2]
        if not timings:
            continue
        lengths = [(label, round(1000.0 * (end - begin))) for label, begin, end in timings]
        with Stream(exact=True) as stream:
            for label, milliseconds in lengths:
                stream.push(label, milliseconds)
            stream.end()
            spoken = list(stream)
        frames = np.array([frame.faps for frame in spoken])
        shares.append(np.array([frame.visemes for frame in spoken]) / ONE)
        for label, start, end in timings:
            phonemes.append((label, first + max(int((start - _AROUND) * _FPS), 0),
                             first + min(int((end + _AROUND) * _FPS) + 1, len(frames))))
        parts.append(frames)
        first += len(frames)
    for intensity in laughs:
        parts.append(np.asarray(render([(f"<laugh:{intensity:g}>", 2000), ("SIL", 200)], exact=True)))
        shares.append(np.eye(len(VISEMES))[np.zeros(len(parts[-1]), dtype=int)])  # silence, the first one
    return Motion(np.concatenate(parts).astype(np.float64), phonemes, np.concatenate(shares))
