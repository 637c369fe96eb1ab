"""Phoneme timings in any format: which there are, by which name, suffix or content each is told, and its reader."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Dict, List, Optional, Tuple

from labial.core import lines
from labial.corpus import services
from labial.corpus.phonesets import AUTO
from labial.corpus.timings import PathLike, SourceSegment, lab_of, phone_set_of, phoneme_segments, read_segments
from labial.errors import DataError
from labial.files.grammar import read_text


def names() -> Tuple[str, ...]:
    """Every format by its name for --from, which is that of labial-say where it has the format."""
    return (*lines.names()[1:], *services.SERVICES)


def titles() -> str:
    """Every format, for messages."""
    return f"{', '.join(lines.names()[1:])}; JSON of {', '.join(item.title for item in services.SERVICES.values())}"


#: Suffixes, in small letters, of sounds and of videos, which hold a sound too.
SOUNDS = (".wav", ".flac", ".ogg", ".oga", ".opus", ".mp3", ".aif", ".aiff", ".au", ".caf")
VIDEOS = (".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".ts", ".3gp", ".mpg", ".mpeg", ".flv", ".wmv", ".ogv",
          ".mts", ".m2ts", ".vob")


@cache
def suffixes() -> Dict[str, str]:
    """The formats by the suffixes that tell them, in small letters."""
    return {lines.suffix(name): name for name in lines.names() if lines.suffix(name)}


def read_timings(path: PathLike, source: Optional[str] = None) -> List[SourceSegment]:
    """Reads timings in the format `source`, one of `names()`; without it, in the one that the suffix tells, else
    the content."""
    form = source or suffixes().get(Path(path).suffix.lower()) or _told_by_content(path)
    return services.SERVICES[form].read(path) if form in services.SERVICES else read_segments(path, form)


def as_lab(path: PathLike, labels: str = AUTO, source: Optional[str] = None) -> str:
    """Timings of any format as lines of ``start end phoneme``, seconds: phonemes of speech, or of laughter where that
    knows more of the labels. They follow each other without gaps from time 0."""
    segments = read_timings(path, source)
    return lab_of(phoneme_segments(path, segments, phone_set_of(segments, labels), False, labels))


def _told_by_content(path: PathLike) -> str:
    if read_text(path)[:4000].lstrip(" \t\r\n")[:1] not in ("{", "["):
        return AUTO
    found = services.service_of(path)
    if found is None:
        raise DataError(path, None, f"no known format of phoneme timings ({titles()})")
    return found
