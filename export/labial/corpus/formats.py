"""Phoneme timings in any format: which there are, by which name, suffix or content each is told, and its reader."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

from labial.corpus import services
from labial.corpus.textgrid import read_textgrid
from labial.corpus.timings import (
    PathLike,
    SourceSegment,
    lab_of,
    phone_set_of,
    phoneme_segments,
    read_flite,
    read_htk,
    read_lab,
    read_mary,
    read_pho,
    read_phseg,
)
from labial.errors import DataError
from labial.grammar import fields_of, is_number, lines_of, read_text
from labial.phonesets import AUTO

Reader = Callable[[PathLike], List[SourceSegment]]

class Format(NamedTuple):
    """A format of timings."""

    title: str  #: what messages call it
    read: Reader
    suffixes: Tuple[str, ...] = ()  #: by which a file's name tells it, in small letters


_LINES: Dict[str, Format] = {
    "lab": Format(".lab", read_lab, (".lab",)),
    "htk": Format("HTK", read_htk),
    "textgrid": Format(".TextGrid", read_textgrid, (".textgrid",)),
    "phseg": Format(".phseg", read_phseg, (".phseg",)),
    "pho": Format(".pho", read_pho, (".pho",)),
    "flite": Format("flite -psdur", read_flite, (".psdur",)),
    "mary": Format("MaryTTS", read_mary, (".realised_durations",)),
}

#: Every format by its name for --from, which is that of labial-say where it has the format.
FORMATS: Dict[str, Format] = {
    **_LINES, **{name: Format(service.title, service.read) for name, service in services.SERVICES.items()},
}  # fmt: skip

#: Every format, for messages.
TITLES = (f"{', '.join(item.title for item in _LINES.values())}; JSON of "
          f"{', '.join(item.title for item in services.SERVICES.values())}")

_BY_SUFFIX = {suffix: item.read for item in FORMATS.values() for suffix in item.suffixes}

#: Suffixes, in small letters, of sounds and of videos, which hold a sound too.
SOUNDS = (".wav", ".flac", ".ogg", ".oga", ".opus", ".mp3", ".aif", ".aiff", ".au", ".caf")
VIDEOS = (".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".ts", ".3gp", ".mpg", ".mpeg", ".flv", ".wmv", ".ogv",
          ".mts", ".m2ts", ".vob")

#: Suffixes by which formats are told, in small letters.
SUFFIXES = tuple(_BY_SUFFIX)


def read_timings(path: PathLike, source: Optional[str] = None) -> List[SourceSegment]:
    """Reads timings in the format `source`, one of `FORMATS`; without it, in the one that the suffix tells, else
    the content."""
    suffix = Path(path).suffix.lower()
    if source is not None:
        return FORMATS[source].read(path)
    if suffix in _BY_SUFFIX:
        return _BY_SUFFIX[suffix](path)
    return FORMATS[_told_by_content(path)].read(path)


def as_lab(path: PathLike, labels: str = AUTO, source: Optional[str] = None) -> str:
    """Timings of any format as lines of ``start end phoneme``, seconds: phonemes of speech, or of laughter where that
    knows more of the labels. They follow each other without gaps from time 0."""
    segments = read_timings(path, source)
    return lab_of(phoneme_segments(path, segments, phone_set_of(segments, labels), False, labels))


def _told_by_content(path: PathLike) -> str:
    text = read_text(path)
    head = text[:4000].lstrip(" \t\r\n")
    if head[:1] in ("{", "["):
        found = services.service_of(path)
    elif "ooTextFile" in head[:200]:
        found = "textgrid"
    else:
        found = _told_by_lines(text)
    if found is None:
        raise DataError(path, None, f"no known format of phoneme timings ({TITLES})")
    return found


def _told_by_lines(text: str) -> Optional[str]:
    """The format of lines, by the first one that holds more than MaryTTS's ``#``; as ``examples/say/timings_lines.c``
    tells it."""
    hash_stood = False
    for line in lines_of(text):
        fields = fields_of(line)
        if fields == ["#"]:
            hash_stood = True
        elif fields and fields[0].startswith(";"):
            return "pho"
        elif fields:
            return _told_by_fields(fields, hash_stood)
    return "pho" if hash_stood else None


def _told_by_fields(fields: Sequence[str], hash_stood: bool) -> Optional[str]:
    first = fields[0]
    label, _, end = first.rpartition(":")
    if is_number(first):  # a time; or MBROLA's phoneme, such as French 2 and 9, before two numbers and more
        if "." not in first and len(fields) >= 3 and is_number(fields[2]):
            return "pho"
        return "mary" if hash_stood else "lab"
    if label and is_number(end):
        return "flite"
    if first.lower() == "sfrm":
        return "phseg"
    return "pho" if len(fields) >= 2 and is_number(fields[1]) else None
