"""Phoneme timings in any format: which there are, by which name, suffix or content each is told, and its reader."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Callable, Dict, List, Optional

from labial.corpus import services
from labial.corpus.timings import (
    PathLike,
    SourceSegment,
    is_number,
    lab_of,
    phone_set_of,
    phoneme_segments,
    read_flite,
    read_htk,
    read_lab,
    read_mary,
    read_pho,
    read_phseg,
    read_textgrid,
    text_of,
)
from labial.errors import DataError
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
    head = text_of(path, ("utf-8-sig", "utf-16")).lstrip()[:4000]
    first = next((line.split() for line in head.splitlines() if line.strip() and not line.lstrip().startswith(";")), [])
    found: Optional[str] = None
    if head[:1] in ("{", "["):
        found = services.service_of(path)
    elif "ooTextFile" in head[:200]:
        found = "textgrid"
    elif first and first[0].lower() == "sfrm":
        found = "phseg"
    elif first and all(re.fullmatch(r".+:\d+(\.\d*)?", item) for item in first):
        found = "flite"
    elif first and first[0].startswith("#"):
        found = "mary"
    elif len(first) >= 3 and is_number(first[0]) and is_number(first[1]):
        found = "lab"
    elif len(first) >= 2 and is_number(first[1]):
        found = "pho"
    if found is None:
        raise DataError(path, None, "no known format of phoneme timings (.lab, HTK, .TextGrid, .phseg, .pho, MaryTTS, "
                        "flite -psdur; JSON of Piper, Azure, Polly, HeadTTS, Kokoro or of phoneme, start and end)")
    return found
