"""The Labial corpus folder: per episode ``NAME.csv`` (motion) and ``NAME.lab`` or ``NAME.TextGrid`` (phonemes).

Files may be in the folder itself or in zip files in the folder.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Dict, Iterator, List, Sequence, Tuple

import numpy as np

from labial.corpus.episode import UNSEEN, Episode
from labial.corpus.formats import read_timings
from labial.corpus.phonesets import PhoneSet
from labial.corpus.timings import LONGEST, phoneme_segments
from labial.errors import DataError, PathLike
from labial.files import limits
from labial.files.arrays import ArrayError, read_zip
from labial.files.faps import CHANNELS, FAP_COLUMNS
from labial.files.grammar import Content, columns_of, number, read_lines, table_rows

#: First line of a frames file.
HEADER = ",".join(("time", *FAP_COLUMNS))
#: Phonemes may exceed the motion by this many seconds; more means that the two files do not belong together.
SLACK = 1.0
#: Most seconds between two frames of an episode; more means that frames are lost, or that times are not in seconds.
LONGEST_GAP = 10.0
#: Largest value of a frame, and largest FAP of the mouth, FAP units: a face is some thousands wide.
LARGEST, LARGEST_OF_MOUTH = 1e6, 1e4


def read_frames(path: PathLike) -> Tuple[np.ndarray, np.ndarray]:
    """Reads a frames file: (T,) times in seconds, strictly increasing, and (T, 13) FAPs, both float64."""
    lines = read_lines(path)
    if not lines or columns_of(lines[0]) != HEADER.split(","):
        raise DataError(path, 1, f"the header is not {HEADER!r}")
    rows: List[List[float]] = []
    for line, fields in table_rows(path, lines, CHANNELS + 1):
        row = [number(path, line, field) for field in fields]
        check_range(path, line, row[0], row[1:], LARGEST_OF_MOUTH)
        if rows and row[0] <= rows[-1][0]:
            raise DataError(path, line, f"time {row[0]:g} does not follow {rows[-1][0]:g}")
        rows.append(row)
    if not rows:
        raise DataError(path, None, "no frames")
    table = np.array(rows)
    return table[:, 0].copy(), table[:, 1:].copy()


def check_range(path: PathLike, line: int, time: float, values: Sequence[float], most: float = LARGEST) -> None:
    """Raises DataError for a time beyond a day and for FAPs beyond `most`."""
    if abs(time) > LONGEST:
        raise DataError(path, line, f"time {time:g} s is more than a day")
    largest = max(values, key=abs)
    if abs(largest) > most:
        raise DataError(path, line, f"the value {largest:g} is beyond {most:.0f} FAP units")


def read_episode(frames: PathLike, timings: PathLike, phone_set: PhoneSet) -> Episode:
    """Reads one episode, named after the frames file. Raises DataError also when the two files' times differ."""
    times, values = read_frames(frames)
    episode = Episode(Path(frames).stem, times, values, phoneme_segments(timings, read_timings(timings), phone_set))
    check_unit(frames, times)
    check_span(timings, episode)
    return episode


def check_unit(path: PathLike, times: np.ndarray) -> None:
    """Raises DataError for frames whose `times` (T,), seconds, are too far apart to learn from."""
    step = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    if step > UNSEEN:
        raise DataError(path, None, f"its frames are {step:g} s apart, over {UNSEEN:g} s; are the times in seconds?")


def check_span(path: PathLike, episode: Episode) -> None:
    """Raises DataError, which names `path`, when phonemes lie over `SLACK` seconds before or after the motion, or where
    motion is missing for `LONGEST_GAP`."""
    first, last = episode.segments[0].start, episode.segments[-1].end
    if episode.times[0] > first + SLACK or episode.times[-1] < last - SLACK:
        raise DataError(path, None, f"phonemes last from {first:g} to {last:g} s, "
                        f"motion from {episode.times[0]:g} to {episode.times[-1]:g} s")
    gaps = np.diff(episode.times)
    if len(gaps) and gaps.max() > LONGEST_GAP:
        at = episode.times[int(gaps.argmax())]
        raise DataError(path, None, f"no motion from {at:g} to {at + gaps.max():g} s, longer than {LONGEST_GAP:g} s")


def _files(folder: Path) -> Iterator[PathLike]:
    """The files of a folder and of its zip files, except hidden ones and sub-folders. Raises DataError for a zip file
    that is invalid, damaged, or larger than `limits.CORPUS` bytes."""
    for file in sorted(folder.iterdir()):
        if file.name.startswith(".") or not file.is_file():
            continue
        if file.suffix.lower() != ".zip":
            yield file
            continue
        try:
            members = read_zip(file, None, limits.CORPUS)
        except (ArrayError, OSError) as error:
            raise DataError(file, None, getattr(error, "strerror", None) or str(error)) from None
        for name in sorted(members):
            if "/" not in name and not name.startswith("."):
                yield Content(members[name], os.path.join(file, name))


def read_folder(path: PathLike, phone_set: PhoneSet) -> List[Episode]:
    """Reads all episodes of a folder, sorted by name. Other files, hidden ones and sub-folders are ignored."""
    if not Path(path).is_dir():
        raise DataError(path, None, "no such folder")
    frames: Dict[str, PathLike] = {}
    timings: Dict[str, PathLike] = {}
    tables = {".csv": frames, ".lab": timings, ".textgrid": timings}
    for file in _files(Path(path)):
        suffix, stem = Path(file).suffix.lower(), Path(file).stem
        other = tables[suffix].setdefault(stem, file) if suffix in tables else file
        if other is not file:
            where = Path(other).relative_to(path)
            raise DataError(file, None, f"there is also {where}; which of them to use is not clear")
    for name in sorted(set(frames) ^ set(timings)):
        if name in frames:
            raise DataError(frames[name], None, f"no {name}.lab or {name}.TextGrid with its phonemes")
        raise DataError(timings[name], None, f"no {name}.csv with its motion")
    if not frames:
        raise DataError(path, None, "no episodes (NAME.csv with NAME.lab or NAME.TextGrid)")
    return [read_episode(frames[name], timings[name], phone_set) for name in sorted(frames)]
