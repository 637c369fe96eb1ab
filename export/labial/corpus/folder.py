"""The Labial corpus folder: per episode ``NAME.csv`` (motion) and ``NAME.lab`` or ``NAME.TextGrid`` (phonemes)."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Dict, List, Tuple, Union

import numpy as np

from labial.corpus.episode import Episode
from labial.corpus.formats import read_timings
from labial.corpus.lines import read_lines, table_rows
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError
from labial.faps import CHANNELS, FAP_COLUMNS
from labial.phonesets import PhoneSet

PathLike = Union[str, os.PathLike]

#: First line of a frames file.
HEADER = ",".join(("time", *FAP_COLUMNS))
#: Phonemes may go on for this many seconds where there is no motion; more means that two files do not go together.
SLACK = 1.0


def read_frames(path: PathLike) -> Tuple[np.ndarray, np.ndarray]:
    """Reads a frames file: (T,) times in seconds, strictly increasing, and (T, 13) FAPs, both float64."""
    lines = read_lines(path)
    if not lines or [name.strip() for name in lines[0].split(",")] != HEADER.split(","):
        raise DataError(path, 1, f"the header is not {HEADER!r}")
    rows: List[List[float]] = []
    for line, fields in table_rows(path, lines, CHANNELS + 1):
        try:
            row = [float(field) for field in fields]
        except ValueError as error:
            raise DataError(path, line, f"not a number: {error}") from None
        if not all(map(math.isfinite, row)):
            raise DataError(path, line, "a value is not finite")
        if rows and row[0] <= rows[-1][0]:
            raise DataError(path, line, f"time {row[0]:g} does not follow {rows[-1][0]:g}")
        rows.append(row)
    if not rows:
        raise DataError(path, None, "no frames")
    table = np.array(rows)
    return table[:, 0].copy(), table[:, 1:].copy()


def read_episode(frames: PathLike, timings: PathLike, phone_set: PhoneSet) -> Episode:
    """Reads one episode, named after the frames file. Raises DataError also when the two files' times differ."""
    times, values = read_frames(frames)
    segments = phoneme_segments(timings, read_timings(timings), phone_set)
    episode = Episode(Path(frames).stem, times, values, segments)
    check_span(timings, episode)
    return episode


def check_span(path: PathLike, episode: Episode) -> None:
    """Raises DataError, which names `path`, when phonemes lie over `SLACK` seconds before or after the motion."""
    first, last = episode.segments[0].start, episode.segments[-1].end
    if episode.times[0] > first + SLACK or episode.times[-1] < last - SLACK:
        raise DataError(path, None, f"phonemes last from {first:g} to {last:g} s, "
                        f"motion from {episode.times[0]:g} to {episode.times[-1]:g} s")


def read_folder(path: PathLike, phone_set: PhoneSet) -> List[Episode]:
    """Reads all episodes of a folder, sorted by name. Other files, hidden ones and sub-folders are ignored."""
    folder = Path(path)
    if not folder.is_dir():
        raise DataError(path, None, "no such folder")
    frames: Dict[str, Path] = {}
    timings: Dict[str, Path] = {}
    for file in sorted(folder.iterdir()):
        suffix = file.suffix.lower()
        if file.name.startswith(".") or not file.is_file() or suffix not in (".csv", ".lab", ".textgrid"):
            continue
        table = frames if suffix == ".csv" else timings
        if file.stem in table:
            raise DataError(file, None, f"there is also {table[file.stem].name}; which of them to use is not clear")
        table[file.stem] = file
    for name in sorted(set(frames) ^ set(timings)):
        if name in frames:
            raise DataError(frames[name], None, f"no {name}.lab or {name}.TextGrid with its phonemes")
        raise DataError(timings[name], None, f"no {name}.csv with its motion")
    if not frames:
        raise DataError(path, None, "no episodes (NAME.csv with NAME.lab or NAME.TextGrid)")
    return [read_episode(frames[name], timings[name], phone_set) for name in sorted(frames)]
