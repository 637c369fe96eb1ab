"""Phoneme timings in any format: which there are, by which name, suffix or content each is told, and its reader."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence

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

#: Readers by the names of --from, which are those of labial-say where it has the format.
READERS: Dict[str, Reader] = {
    "lab": read_lab, "htk": read_htk, "textgrid": read_textgrid, "phseg": read_phseg, "pho": read_pho,
    "mary": read_mary, "flite": read_flite, **services.READERS,
}  # fmt: skip

_BY_SUFFIX: Dict[str, Reader] = {
    ".lab": read_lab, ".textgrid": read_textgrid, ".phseg": read_phseg, ".pho": read_pho, ".psdur": read_flite,
    ".realised_durations": read_mary,
}  # fmt: skip

#: Suffixes by which formats are told, in small letters.
SUFFIXES = tuple(_BY_SUFFIX)


def read_timings(path: PathLike, source: Optional[str] = None) -> List[SourceSegment]:
    """Reads timings in the format `source`, one of `READERS`; without it, in the one that the suffix tells (.lab
    .TextGrid .phseg .pho .psdur .realised_durations), else the content."""
    suffix = Path(path).suffix.lower()
    if source is not None:
        return READERS[source](path)
    if suffix in _BY_SUFFIX:
        return _BY_SUFFIX[suffix](path)
    return READERS[_told_by_content(path)](path)


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
        raise DataError(path, None, "no known format of phoneme timings (.lab, HTK, .TextGrid, .phseg, .pho, MaryTTS, "
                        "flite -psdur; JSON of Piper, Azure, Polly, HeadTTS, Kokoro or of phoneme, start and end)")
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
