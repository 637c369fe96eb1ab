"""Phoneme timings in any format: which there are, by which name, suffix or content each is told, and its reader."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Dict, List, Optional, Tuple

from labial.core import lines
from labial.corpus import service_files, services
from labial.corpus.entries import Parsed, read_entries
from labial.corpus.phonesets import AUTO
from labial.corpus.timings import PathLike, SourceSegment, lab_of, phone_set_of, phoneme_segments, read_segments
from labial.corpus.words import PLAIN, Pronunciation
from labial.errors import DataError
from labial.files.grammar import Content, read_bytes, read_text


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


def read_timings(path: PathLike, source: Optional[str] = None, how: Pronunciation = PLAIN,
                 offset: float = 0.0, tier: Optional[str] = None) -> List[SourceSegment]:
    """Reads timings in the format `source`, one of `names()`; without it, in the one that the suffix tells, else
    the content. Where words are told, `how` says how they are pronounced. `offset` seconds are added to all times; what
    that moves before the beginning is cut off. `tier` names the tier of a TextGrid."""
    path = stored(path)
    form = source or suffixes().get(Path(path).suffix.lower()) or _told_by_content(path)
    segments = service_files.read(path, form, how) if form in services.SERVICES else read_segments(path, form, tier)
    if not offset:
        return segments
    moved = _moved(segments, offset)
    if not moved:
        raise DataError(path, None, f"an offset of {1000 * offset:g} ms leaves no segments")
    return moved


def stored(path: PathLike) -> PathLike:
    """What stands in for a file that is read several times, as a pipe cannot be: its bytes."""
    return path if isinstance(path, (Content, Parsed)) else Content(read_bytes(path), os.fspath(path))


def _moved(segments: List[SourceSegment], offset: float) -> List[SourceSegment]:
    """Segments with `offset` seconds added to their times, from 0 on."""
    return [replace(segment, start=max(0.0, segment.start + offset), end=segment.end + offset,
                    apex=None if segment.apex is None else max(0.0, segment.apex + offset))
            for segment in segments if segment.end + offset > 0.0]


def as_lab(path: PathLike, labels: str = AUTO, source: Optional[str] = None, how: Pronunciation = PLAIN,
           offset: float = 0.0, tier: Optional[str] = None) -> str:
    """Timings of any format as lines of ``start end phoneme``, seconds: phonemes of speech and laughs, or phonemes of
    laughter where that knows more of the labels. They follow each other without gaps from time 0."""
    segments = read_timings(path, source, how, offset, tier)
    return lab_of(phoneme_segments(path, segments, phone_set_of(segments, labels), False, labels, laughs=True))


def _told_by_content(path: PathLike) -> str:
    if not isinstance(path, Parsed) and read_text(path)[:4000].lstrip(" \t\r\n")[:1] not in ("{", "["):
        return AUTO
    entries = read_entries(path)
    found = next((name for name in map(services.service_of, entries[:100]) if name), None)
    if found is None:
        raise DataError(path, None, f"no known format of phoneme timings ({titles()})")
    return found
