"""Folders of speech that a network of hearing is trained on or judged by.

A folder has sounds in any depth. What each of them says stands in, in this order,

- timings beside it, with the sound's name and a suffix that tells their format (``a.wav`` and ``a.lab``);
- ``metadata.csv`` in LJ Speech's layout, in the same folder or the one above: lines ``NAME|text|text read aloud``;
- a text beside it (``a.wav`` and ``a.txt``), UTF-8.

Texts are aligned with their sounds by :mod:`labial.sound.align`, and the result is kept in a cache.
"""

from __future__ import annotations

import hashlib
import os
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, TypeVar

from labial.corpus.episode import Segment
from labial.corpus.formats import SOUNDS, read_timings, suffixes
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError, LabialError, PathLike, needs
from labial.files.grammar import read_text
from labial.files.outputs import writing

#: The table of texts in LJ Speech's layout.
TABLE = "metadata.csv"
#: Suffixes that are not written in small letters.
_SPELT = {".textgrid": ".TextGrid"}


class Told(NamedTuple):
    """Where a sound's words stand: a file of timings, or a text."""

    path: str
    line: Optional[int]  #: in a table
    text: Optional[str]  #: None: the file has timings


@dataclass(frozen=True)
class Clip:
    """A sound with the times of its phonemes."""

    sound: str  #: path
    segments: Tuple[Segment, ...]  #: ARPABET and SIL, without gaps from time 0 on


def find(folder: PathLike) -> List[Tuple[str, Told]]:
    """The sounds of a folder in the order of their paths, each with what tells its phonemes. Raises DataError for a
    folder without sounds, for a sound without either and for a table with a wrong line, which it names. Lines of a
    table without a sound are passed over: parts of LJ Speech come with its whole table."""
    table = cache(_table)
    return [(str(sound), _told(sound, table)) for sound in _sounds(folder)]


def untold(folder: PathLike) -> List[Clip]:
    """The sounds of a folder in the order of their paths, without a text: clips without segments. Raises
    DataError for a folder without sounds."""
    return [Clip(str(sound), ()) for sound in _sounds(folder)]


def _sounds(folder: PathLike) -> List[Path]:
    place = Path(folder)
    if not place.is_dir():
        raise DataError(place, None, "not a folder")
    sounds = sorted(item for item in place.rglob("*") if item.suffix.lower() in SOUNDS and item.is_file())
    if not sounds:
        raise DataError(place, None, f"no sounds ({', '.join(SOUNDS)})")
    return sounds


def _told(sound: Path, table: Callable[[Path], Dict[str, Told]]) -> Told:
    tables = [table(parent / TABLE) for parent in (sound.parent, sound.parent.parent)]
    for suffix in suffixes():
        for beside in (sound.with_suffix(suffix), sound.with_suffix(_SPELT.get(suffix, suffix))):
            if beside.is_file():
                return Told(str(beside), None, None)
    for texts in tables:
        if sound.stem in texts:
            return texts[sound.stem]
    text = sound.with_suffix(".txt")
    if not text.is_file():
        raise DataError(sound, None, f"neither timings nor a text are beside it, and no {TABLE} names it")
    said = " ".join(read_text(text).split())
    if not said:
        raise DataError(text, None, "no text")
    return Told(str(text), None, said)


def _table(path: Path) -> Dict[str, Told]:
    if not path.is_file():
        return {}
    found: Dict[str, Told] = {}
    for number, line in enumerate(read_text(path).splitlines(), 1):
        if not line.strip():
            continue
        columns = line.split("|")
        name, text = columns[0].strip(), " ".join(columns[-1].split())
        if len(columns) not in (2, 3) or not name or not text:
            raise DataError(path, number, "not NAME|TEXT or NAME|TEXT|TEXT READ ALOUD")
        if name in found:
            raise DataError(path, number, f"{name} is already in line {found[name].line}")
        found[name] = Told(str(path), number, text)
    return found


def read(folder: PathLike, cache: PathLike, jobs: int = 1,
         told: Optional[Callable[[int, int], None]] = None) -> List[Clip]:
    """The clips of a folder; texts are aligned in `jobs` processes, results are kept in the folder `cache`. Sounds that
    their text does not fit, and texts that are not English words, are left out with a warning. `told` receives how many
    sounds are done, and of how many. Raises DataError as :func:`find`, for wrong timings, and if no clip remains."""
    work = [(sound, item, _kept(cache, sound, item)) for sound, item in find(folder)]
    missing = [row for row in work if row[1].text is not None and not os.path.exists(row[2])]
    if missing:
        with needs("aligning sounds with their texts", "hear"):
            import labial.sound.align  # noqa: F401
        os.makedirs(cache, exist_ok=True)
    for count, problem in enumerate(in_processes(_align, missing, jobs), len(work) - len(missing) + 1):
        if problem:
            warnings.warn(f"{problem}; it is left out", stacklevel=2)
        if told:
            told(count, len(work))
    # An alignment is an empty file where the text does not fit.
    timings = [(sound, item.path if item.text is None else kept) for sound, item, kept in work
               if item.text is None or os.path.getsize(kept)]
    clips = [Clip(sound, phoneme_segments(path, read_timings(path), SPEECH)) for sound, path in timings]
    if not clips:
        raise DataError(folder, None, "no sound fits its text")
    return clips


Item = TypeVar("Item")
Found = TypeVar("Found")


def _kept(cache: PathLike, sound: str, item: Told) -> str:
    """Where the alignment of a sound with its text is kept: it depends on the content of both."""
    status = os.stat(sound)
    key = f"{os.path.basename(sound)}\n{status.st_size}\n{status.st_mtime_ns}\n{item.text}"
    return os.path.join(cache, f"{Path(sound).stem}.{hashlib.sha256(key.encode('utf-8')).hexdigest()[:12]}.lab")


def in_processes(work: Callable[[Item], Found], items: Sequence[Item], jobs: int, chunk: int = 1) -> Iterator[Found]:
    """What `work` makes of each item, in order, in `jobs` processes."""
    if jobs == 1 or len(items) < 2:
        yield from map(work, items)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(work, items, chunksize=chunk)


def _align(row: Tuple[str, Told, str]) -> str:
    """Aligns a sound and keeps the result, an empty file if the text does not fit; returns the problem, or ""."""
    from labial.sound.align import aligned
    from labial.sound.recogniser import LOW

    sound, item, kept = row
    problem = lab = ""
    where = item.path if item.line is None else f"{item.path}:{item.line}"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = aligned(sound, item.text)
        length = sum(item.end - item.start for item in found.stretches)
        if sum(item.confidence * (item.end - item.start) for item in found.stretches) < LOW * length:
            problem = f"{where}: the text hardly fits {sound}"
        else:
            lab = found.lab()
    except DataError as error:
        problem = str(error)
    except LabialError as error:
        problem = f"{where}: {error}"
    with writing(kept, "utf-8") as out:
        out.write(lab)
    return problem
