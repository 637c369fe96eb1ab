"""Phoneme timings: what aligners and synthesisers write, as lists of segments in seconds.

Every reader checks that times are finite, that no segment ends before it begins and that segments are in order and
do not overlap by more than `TOLERANCE`; anything else is a DataError with file and line. Labels stay as they are in the
file until :func:`phoneme_segments` maps them to a phone set and fills the gaps with its silence.
"""

from __future__ import annotations

import math
import os
import re
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, List, Optional, Sequence, Set, Tuple, Union

from labial.corpus.episode import Segment
from labial.errors import DataError
from labial.phonesets import AUTO, LAUGHTER, SPEECH, PhoneSet

PathLike = Union[str, os.PathLike]

#: Overlaps and gaps up to this many seconds come from rounding and are closed.
TOLERANCE = 0.001
#: No timing of an episode is later; beyond it the unit is not seconds (HTK writes units of 100 ns).
LONGEST = 86400.0
#: Frames per second of CMU Sphinx alignments.
PHSEG_RATE = 100.0
#: HTK's units per second.
_HTK_RATE = 1e7
#: No phoneme is longer, in seconds: a file whose first one would be is in HTK's units.
_LONGEST_PHONEME = 3600
#: An interval tier's class, name, two times and count, in either form of a TextGrid.
_TIER_SIZE = re.compile(
    r'"IntervalTier"\s+(?:name\s*=\s*)?"(?:[^"]|"")*"\s+'
    r"(?:(?:xmin\s*=\s*|xmax\s*=\s*)?[-+.\deE]+\s+){2}"
    r"(?:intervals\s*:\s*size\s*=\s*)?(\d+)"
)


@dataclass(frozen=True)
class SourceSegment(Segment):
    """A segment with the line it was read from; None in a TextGrid, whose intervals are numbered instead."""

    line: Optional[int] = None
    labels: str = AUTO  #: the set that the format's labels are of


def read_lab(path: PathLike) -> List[SourceSegment]:
    """Reads lines of ``start end label [apex [word]]``, seconds; or HTK's labels, which are called .lab, too."""
    segments = []
    rows = _rows(path)
    if rows and _is_htk(rows[0][1]):
        return read_htk(path)
    for line, fields in rows:
        if not 3 <= len(fields) <= 5:
            raise DataError(path, line, f"expected 'start end label [apex [word]]', found {len(fields)} columns")
        apex = _number(path, line, fields[3], "apex") if len(fields) > 3 else None
        word = fields[4] if len(fields) > 4 else None
        start, end = _number(path, line, fields[0], "start"), _number(path, line, fields[1], "end")
        segments.append(SourceSegment(start, end, fields[2], apex, word, line))
    return checked(path, segments)


def read_htk(path: PathLike) -> List[SourceSegment]:
    """Reads lines of ``start end label ...`` in whole units of 100 ns, as HTK and HTS write them.

    Of a label with context, ``a^b-c+d=e@...``, the phoneme is what stands between - and +.
    """
    segments = []
    for line, fields in _rows(path):
        if len(fields) < 3:
            raise DataError(path, line, f"expected 'start end label', found {len(fields)} columns")
        if not (_is_whole(fields[0]) and _is_whole(fields[1])):
            raise DataError(path, line, f"times {fields[0]!r} and {fields[1]!r} are not whole numbers of 100 ns")
        start, end = int(fields[0]) / _HTK_RATE, int(fields[1]) / _HTK_RATE
        segments.append(SourceSegment(start, end, _centre(fields[2]), line=line))
    return checked(path, segments)


def read_mary(path: PathLike) -> List[SourceSegment]:
    """Reads MaryTTS's REALISED_DURATIONS: lines of ``end number label``, seconds; lines that start with # are not
    read."""
    segments: List[SourceSegment] = []
    for line, fields in _rows(path):
        if fields[0].startswith("#"):
            continue
        if len(fields) != 3:
            raise DataError(path, line, f"expected 'end number label', found {len(fields)} columns")
        _number(path, line, fields[1], "second field")
        start = segments[-1].end if segments else 0.0
        end = _number(path, line, fields[0], "end")
        segments.append(SourceSegment(start, end, fields[2], line=line, labels="xsampa"))
    return checked(path, segments)


def read_phseg(path: PathLike) -> List[SourceSegment]:
    """Reads a CMU Sphinx phone segmentation: a header, rows ``SFrm EFrm SegAScr Phone [context]``, a total score.

    Frame k covers the 10 ms from k/100 s: EFrm is inclusive and the next row starts at EFrm + 1, so that only
    start = SFrm/100 and end = (EFrm + 1)/100 tile the utterance without gaps and without a shift that grows or differs
    between a segment's two ends.
    """
    segments: List[SourceSegment] = []
    rows = _rows(path)
    if not rows or [name.lower() for name in rows[0][1][:4]] != ["sfrm", "efrm", "segascr", "phone"]:
        raise DataError(path, rows[0][0] if rows else None, "expected the header 'SFrm EFrm SegAScr Phone'")
    for number, (line, fields) in enumerate(rows[1:], 2):
        if fields[0].lower() == "total":
            if number != len(rows):
                raise DataError(path, line, "the total score is not the last line")
            break
        if len(fields) < 4:
            raise DataError(path, line, f"expected 'SFrm EFrm SegAScr Phone', found {len(fields)} columns")
        if not (_is_whole(fields[0]) and _is_whole(fields[1])):
            raise DataError(path, line, f"frames {fields[0]!r} and {fields[1]!r} are not whole numbers")
        first, last = int(fields[0]), int(fields[1])
        if last < first:
            raise DataError(path, line, f"the segment ends in frame {last}, before its first frame {first}")
        segments.append(SourceSegment(first / PHSEG_RATE, (last + 1) / PHSEG_RATE, fields[3], line=line))
    return checked(path, segments)


def read_flite(path: PathLike) -> List[SourceSegment]:
    """Reads what ``flite -psdur`` prints: ``label:end`` for every phoneme, `end` in seconds from the beginning."""
    segments: List[SourceSegment] = []
    for line, fields in _rows(path):
        for item in fields:
            label, colon, end = item.rpartition(":")
            if not colon or not label:
                raise DataError(path, line, f"{item!r} is not 'label:end'")
            start = segments[-1].end if segments else 0.0
            segments.append(SourceSegment(start, _number(path, line, end, "end"), label, line=line))
    return checked(path, segments)


def read_pho(path: PathLike) -> List[SourceSegment]:
    """Reads an MBROLA .pho: lines of ``phoneme milliseconds [position pitch]...``; ``;`` begins a comment.

    Times are summed in milliseconds, so that long files do not drift.
    """
    segments: List[SourceSegment] = []
    elapsed = 0.0
    for line, fields in _rows(path, comment=";"):
        if fields == ["#"]:  # MBROLA's flush mark
            continue
        if len(fields) < 2:
            raise DataError(path, line, "expected 'phoneme milliseconds [position pitch]...'")
        duration, *_pitch = [_number(path, line, text, "value") for text in fields[1:]]
        if duration < 0:
            raise DataError(path, line, f"the duration {fields[1]} is negative")
        start, elapsed = elapsed, elapsed + duration
        segments.append(SourceSegment(start / 1000, elapsed / 1000, fields[0], line=line, labels="xsampa"))
    return checked(path, segments)


def read_textgrid(path: PathLike, tier: Optional[str] = None) -> List[SourceSegment]:
    """Reads an interval tier of a Praat TextGrid, long or short, UTF-8 or UTF-16.

    The tier is the one named `tier`; else "phones", "phonemes", "phone" or "phoneme" in any case (also after
    "speaker - "); else the only or the first interval tier. Unlabelled intervals are kept with the label "".
    """
    tiers = read_textgrid_tiers(path)
    if tier is not None:
        if tier not in tiers:
            raise DataError(path, None, f"no interval tier {tier!r}; there are {', '.join(map(repr, tiers)) or 'none'}")
        return tiers[tier]
    if not tiers:
        raise DataError(path, None, "no interval tier")
    plain = {name.lower().split(" - ")[-1].strip(): name for name in reversed(list(tiers))}
    for name in ("phones", "phonemes", "phone", "phoneme"):
        if name in plain:
            return tiers[plain[name]]
    return next(iter(tiers.values()))


def read_textgrid_tiers(path: PathLike) -> Dict[str, List[SourceSegment]]:
    """Reads all interval tiers of a TextGrid, in order. A second tier of the same name is called "name_2"."""
    try:  # whoever has no TextGrids needs no reader of them
        from praatio import textgrid
        from praatio.data_classes.interval_tier import IntervalTier
        from praatio.utilities.errors import PraatioException
    except ModuleNotFoundError as error:
        raise DataError(path, None, f"TextGrids need the package {error.name}: install labial[train]") from None

    text = text_of(path, ("utf-8-sig", "utf-16"))
    if "ooTextFile" not in text[:200] or "TextGrid" not in text[:200]:
        raise DataError(path, 1, "not a TextGrid in text form")
    _refuse_signs(path, text)
    try:
        grid = textgrid.openTextgrid(os.fspath(path), True, reportingMode="silence", duplicateNamesMode="rename")
    except (PraatioException, ValueError, LookupError, AttributeError, TypeError) as error:
        raise DataError(path, None, f"not a well-formed TextGrid: {' '.join(str(error).split())}") from None
    # The library drops what follows a malformed short interval without a word, so its counts are held to the file's.
    declared = _TIER_SIZE.findall(text)
    interval_tiers = [item for item in grid.tiers if isinstance(item, IntervalTier)]
    found = [len(item.entries) for item in interval_tiers]
    if [count.lstrip("0") or "0" for count in declared] != list(map(str, found)):  # a count may have any length
        raise DataError(path, None, f"interval tiers should have {', '.join(declared) or 'no'} intervals, "
                        f"but {', '.join(map(str, found)) or 'none'} could be read")
    result = {}
    for item in interval_tiers:
        result[item.name] = checked(path, [SourceSegment(float(a), float(b), label) for a, b, label in item.entries])
    return result


def phone_set_of(segments: Sequence[SourceSegment], labels: str = AUTO) -> PhoneSet:
    """Speech or laughter, whichever knows more of the segments' labels; speech where both know as many."""
    known = [sum(meaning(segment, phones, labels) is not None for segment in segments) for phones in (SPEECH, LAUGHTER)]
    return LAUGHTER if known[1] > known[0] else SPEECH


def meaning(segment: SourceSegment, phone_set: PhoneSet, labels: str = AUTO) -> Optional[str]:
    """The phoneme of `phone_set` that a segment's label means in the set `labels`, or None; silence where it has none.

    Where `labels` is "auto", labels of a format that has one set are of that first.
    """
    if not segment.label:
        return phone_set.silence
    known = phone_set.resolve(segment.label, segment.labels) if labels == AUTO else None
    return phone_set.resolve(segment.label, labels) if known is None else known


def phoneme_segments(
    path: PathLike, segments: Sequence[SourceSegment], phone_set: PhoneSet, strict: bool = True, labels: str = AUTO
) -> Tuple[Segment, ...]:
    """Maps labels of the set `labels` to `phone_set` and joins the segments without gaps from time 0; `path` is for the
    error message.

    An empty label and every gap over `TOLERANCE` are silence; smaller gaps and overlaps go to the later segment.
    Unknown labels are a DataError, as a corpus of the wrong kind should be; unless `strict`, they are the nearest
    phoneme, with one warning each.
    """
    result: List[Segment] = []
    unknown: Set[str] = set()
    previous = min(0.0, segments[0].start) if segments else 0.0
    for number, item in enumerate(segments, 1):
        label = meaning(item, phone_set, labels)
        if label is None:
            where = f"interval {number}: " if item.line is None else ""
            problem = DataError(path, item.line, f"{where}no {phone_set.kind} phoneme is called {item.label!r}")
            if strict:
                raise problem
            label = phone_set.nearest(item.label, labels)
            if item.label not in unknown:
                warnings.warn(f"{problem}; it moves as {label}", stacklevel=2)
                unknown.add(item.label)
        if item.start - previous > TOLERANCE:
            result.append(Segment(previous, item.start, phone_set.silence))
            previous = item.start
        end = max(item.end, previous)
        apex = None if item.apex is None else min(max(item.apex, previous), end)
        result.append(Segment(previous, end, label, apex, item.word))
        previous = end
    return tuple(result)


def text_of(path: PathLike, encodings: Sequence[str] = ("utf-8-sig",)) -> str:
    """A file's text, in the first of `encodings` that it fits."""
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeError:
            continue
    raise DataError(path, None, f"not {' or '.join(encodings)} text")


def lab_of(segments: Iterable[Segment]) -> str:
    """Segments as lines of ``start end label``, seconds."""
    return "".join(f"{item.start:.4f} {item.end:.4f} {item.label}\n" for item in segments)


def _rows(path: PathLike, comment: str = "") -> List[Tuple[int, List[str]]]:
    rows = []
    for line, text in enumerate(text_of(path).splitlines(), 1):
        fields = (text.split(comment)[0] if comment else text).split()
        if fields:
            rows.append((line, fields))
    return rows


def _is_htk(fields: Sequence[str]) -> bool:
    return len(fields) >= 3 and all(map(_is_whole, fields[:2])) and int(fields[1]) > _LONGEST_PHONEME


def _centre(label: str) -> str:
    """The phoneme of a label with context; the name of a noise starts with +."""
    if label[0] in "+-<":
        return label
    begin = label.find("-", max(label.find("^"), 0))
    if 0 <= begin < len(label) - 1:
        label = label[begin + 1 :]
    return label[0] + label[1:].split("+")[0]


def _is_whole(text: str) -> bool:
    """Whether `text` is a whole number, of at most 18 digits: times of a file are far from that."""
    return text.isdecimal() and len(text) <= 18


def is_number(text: str) -> bool:
    """Whether `text` is a finite number."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _number(path: PathLike, line: int, text: str, what: str) -> float:
    if not is_number(text):
        raise DataError(path, line, f"{what} {text!r} is not a finite number")
    return float(text)


def _refuse_signs(path: PathLike, text: str) -> None:
    """Times below zero would lose their sign in the library (it allows for a start of -0)."""
    for line, content in enumerate(text.splitlines(), 1):
        match = re.fullmatch(r"\s*(?:(?:xmin|xmax|number)\s*=\s*)?(-[\d.]+)\s*", content)
        if match and is_number(match.group(1)) and float(match.group(1)) != 0:
            raise DataError(path, line, f"the time {match.group(1)} is negative")


def checked(path: PathLike, segments: List[SourceSegment]) -> List[SourceSegment]:
    """`segments`, or a DataError where times are late, turned round, overlap, or there are none."""
    if not segments:
        raise DataError(path, None, "no segments")
    previous = -math.inf
    for number, item in enumerate(segments, 1):
        where = f"interval {number}: " if item.line is None else ""
        times = [item.start, item.end] + ([] if item.apex is None else [item.apex])
        if max(map(abs, times)) > LONGEST:
            raise DataError(path, item.line, f"{where}{max(times, key=abs):g} s is more than a day; are these seconds?")
        if item.end < item.start:
            raise DataError(path, item.line, f"{where}the segment ends at {item.end:g} s, "
                            f"before its start {item.start:g} s")
        if item.start < previous - TOLERANCE:
            raise DataError(path, item.line, f"{where}the segment starts at {item.start:g} s, "
                            f"before the end of the one before, {previous:g} s")
        if item.apex is not None and not item.start - TOLERANCE <= item.apex <= item.end + TOLERANCE:
            raise DataError(path, item.line, f"{where}the apex {item.apex:g} s is outside its segment")
        previous = max(previous, item.end)
    return segments
