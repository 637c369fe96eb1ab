"""Phoneme timings: what aligners and synthesisers write, as lists of segments in seconds.

Every reader checks that times are finite and from 0 on, that no segment ends before it begins and that segments are in
order and do not overlap by more than `TOLERANCE`; anything else is a DataError with file and line. Labels stay as they
are in the file until :func:`phoneme_segments` maps them to a phone set and fills the gaps with its silence.
"""

from __future__ import annotations

import math
import os
import warnings
from dataclasses import dataclass
from typing import Iterable, Iterator, List, Optional, Sequence, Set, Tuple, Union

from labial.corpus.episode import Segment
from labial.errors import DataError
from labial.grammar import fields_of, is_number, is_whole, lines_of, number, read_text, shown
from labial.phonesets import AUTO, PHONE_SETS, PhoneSet

PathLike = Union[str, os.PathLike]

#: Overlaps and gaps up to this many seconds come from rounding and are closed.
TOLERANCE = 0.001
#: No timing of an episode is later; beyond it the unit is not seconds (HTK writes units of 100 ns).
LONGEST = 86400.0
#: Frames per second of CMU Sphinx alignments.
PHSEG_RATE = 100.0
#: HTK's units per second.
_HTK_RATE = 1e7
#: No phoneme is longer, in seconds (LABIAL_DURATION_MAX): a file whose first one would be is in HTK's units.
_LONGEST_PHONEME = 3600


@dataclass(frozen=True)
class SourceSegment(Segment):
    """A segment with the line it was read from; None where lines tell nothing, as in a JSON document."""

    line: Optional[int] = None
    labels: str = AUTO  #: the set that the format's labels are of


def read_lab(path: PathLike) -> List[SourceSegment]:
    """Reads lines of ``start end label [apex [word]]``, seconds; or HTK's labels, which are called .lab, too. A line
    that starts with # is a comment."""
    segments: List[SourceSegment] = []
    for line, fields in _rows(path):
        if fields[0].startswith("#"):
            continue
        if not segments and _is_htk(fields):
            return read_htk(path)
        if not 3 <= len(fields) <= 5:
            raise DataError(path, line, f"expected 'start end label [apex [word]]', found {len(fields)} columns")
        apex = number(path, line, fields[3], "apex") if len(fields) > 3 else None
        word = fields[4] if len(fields) > 4 else None
        start, end = number(path, line, fields[0], "start"), number(path, line, fields[1], "end")
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
        if not (is_whole(fields[0]) and is_whole(fields[1])):
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
        if not is_number(fields[1]):
            raise DataError(path, line, f"second field {shown(fields[1])} is not a number")
        start = segments[-1].end if segments else 0.0
        end = number(path, line, fields[0], "end")
        segments.append(SourceSegment(start, end, fields[2], line=line, labels="xsampa"))
    return checked(path, segments)


def read_phseg(path: PathLike) -> List[SourceSegment]:
    """Reads a CMU Sphinx phone segmentation: a header, rows ``SFrm EFrm SegAScr Phone [context]``, a total score.

    Frame k covers the 10 ms from k/100 s: EFrm is inclusive and the next row starts at EFrm + 1, so that only
    start = SFrm/100 and end = (EFrm + 1)/100 tile the utterance without gaps and without a shift that grows or differs
    between a segment's two ends.
    """
    segments: List[SourceSegment] = []
    rows = list(_rows(path))
    if not rows or [name.lower() for name in rows[0][1][:4]] != ["sfrm", "efrm", "segascr", "phone"]:
        raise DataError(path, rows[0][0] if rows else None, "expected the header 'SFrm EFrm SegAScr Phone'")
    for count, (line, fields) in enumerate(rows[1:], 2):
        if fields[0].lower() == "total":
            if count != len(rows):
                raise DataError(path, line, "the total score is not the last line")
            break
        if len(fields) < 4:
            raise DataError(path, line, f"expected 'SFrm EFrm SegAScr Phone', found {len(fields)} columns")
        if not (is_whole(fields[0]) and is_whole(fields[1])):
            raise DataError(path, line, f"frames {fields[0]!r} and {fields[1]!r} are not whole numbers")
        first, last = int(fields[0]), int(fields[1])
        if last < first:
            raise DataError(path, line, f"the segment ends in frame {last}, before its first frame {first}")
        segments.append(SourceSegment(first / PHSEG_RATE, (last + 1) / PHSEG_RATE, fields[3], line=line))
    return checked(path, segments)


def read_flite(path: PathLike) -> List[SourceSegment]:
    """Reads what ``flite -psdur`` prints: ``label:end`` for every phoneme. A line is an utterance, behind the line
    before it; `end` is in seconds from its beginning."""
    segments: List[SourceSegment] = []
    for line, fields in _rows(path):
        origin = segments[-1].end if segments else 0.0
        for item in fields:
            label, colon, end = item.rpartition(":")
            if not colon or not label:
                raise DataError(path, line, f"{item!r} is not 'label:end'")
            start = segments[-1].end if segments else 0.0
            segments.append(SourceSegment(start, origin + number(path, line, end, "end"), label, line=line))
    return checked(path, segments)


def read_pho(path: PathLike) -> List[SourceSegment]:
    """Reads an MBROLA .pho: lines of ``phoneme milliseconds [position pitch]...``; a field that starts with ``;``
    begins a comment.

    Times are summed in milliseconds, so that long files do not drift.
    """
    segments: List[SourceSegment] = []
    elapsed = 0.0
    for line, fields in _rows(path, comment=True):
        if fields == ["#"]:  # MBROLA's flush mark
            continue
        if len(fields) < 2 or len(fields) % 2:
            raise DataError(path, line, "expected 'phoneme milliseconds [position pitch]...'")
        duration = number(path, line, fields[1], "duration")
        for text in fields[2:]:
            if not is_number(text):
                raise DataError(path, line, f"{shown(text)} is not part of a pitch point, a number")
        if duration < 0:
            raise DataError(path, line, f"the duration {fields[1]} is negative")
        start, elapsed = elapsed, elapsed + duration
        segments.append(SourceSegment(start / 1000, elapsed / 1000, fields[0], line=line, labels="xsampa"))
    return checked(path, segments)


def phone_set_of(segments: Sequence[SourceSegment], labels: str = AUTO) -> PhoneSet:
    """The phone set that knows most of the segments' labels; the first one, speech, where several know as many."""
    return max(PHONE_SETS.values(), key=lambda phones: sum(
        meaning(segment, phones, labels) is not None for segment in segments))


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

    An empty label and every gap over `TOLERANCE` are silence; smaller gaps and overlaps go to the later segment. A
    silence of more than an hour becomes several; another phoneme of such a length is a DataError.
    Unknown labels are a DataError, as a corpus of the wrong kind should be; unless `strict`, they are the nearest
    phoneme, with one warning each.
    """
    result: List[Segment] = []
    unknown: Set[str] = set()
    previous = 0.0
    for place, item in enumerate(segments, 1):
        label = meaning(item, phone_set, labels)
        if label is None:
            where = f"interval {place}: " if item.line is None else ""
            problem = DataError(path, item.line, f"{where}no {phone_set.kind} phoneme is called {item.label!r}")
            if strict:
                raise problem
            label = phone_set.nearest(item.label, labels)
            if item.label not in unknown:
                warnings.warn(f"{problem}; it moves as {label}", stacklevel=2)
                unknown.add(item.label)
        if item.start - previous > TOLERANCE:
            previous = _silence(result, previous, item.start, phone_set)
        end = max(item.end, previous)
        if end - previous > _LONGEST_PHONEME:
            if label != phone_set.silence:
                where = f"interval {place}: " if item.line is None else ""
                raise DataError(path, item.line, f"{where}{item.label!r} lasts {end - previous:g} s, more than the "
                                f"{_LONGEST_PHONEME} s that a phoneme may")
            previous = _silence(result, previous, end - _LONGEST_PHONEME, phone_set)
        apex = None if item.apex is None else min(max(item.apex, previous), end)
        result.append(Segment(previous, end, label, apex, item.word))
        previous = end
    return tuple(result)


def _silence(result: List[Segment], start: float, end: float, phone_set: PhoneSet) -> float:
    """Appends silence, as several phonemes where it is too long for one; returns `end`."""
    while end - start > _LONGEST_PHONEME:
        result.append(Segment(start, start + _LONGEST_PHONEME, phone_set.silence))
        start += _LONGEST_PHONEME
    if end > start:
        result.append(Segment(start, end, phone_set.silence))
    return end


def lab_of(segments: Iterable[Segment]) -> str:
    """Segments as lines of ``start end label``, seconds."""
    return "".join(f"{item.start:.4f} {item.end:.4f} {item.label}\n" for item in segments)


def _rows(path: PathLike, comment: bool = False) -> Iterator[Tuple[int, List[str]]]:
    """Line number and fields of each line that has any, where `comment` without those of a comment behind a ``;``."""
    for line, text in enumerate(lines_of(read_text(path)), 1):
        fields = fields_of(text)
        if comment:
            fields = fields[: next((n for n, field in enumerate(fields) if field.startswith(";")), len(fields))]
        if fields:
            yield line, fields


def _is_htk(fields: Sequence[str]) -> bool:
    return len(fields) >= 3 and all(map(is_whole, fields[:2])) and int(fields[1]) > _LONGEST_PHONEME


def _centre(label: str) -> str:
    """The phoneme of a label with context; the name of a noise starts with +."""
    if label[0] in "+-<":
        return label
    begin = label.find("-", max(label.find("^"), 0))
    if 0 <= begin < len(label) - 1:
        label = label[begin + 1 :]
    return label[0] + label[1:].split("+")[0]


def checked(path: PathLike, segments: List[SourceSegment]) -> List[SourceSegment]:
    """`segments`, or a DataError where times are late, turned round, overlap, or there are none."""
    if not segments:
        raise DataError(path, None, "no segments")
    previous = -math.inf
    for place, item in enumerate(segments, 1):
        where = f"interval {place}: " if item.line is None else ""
        times = [item.start, item.end] + ([] if item.apex is None else [item.apex])
        if min(times) < 0:
            raise DataError(path, item.line, f"{where}{min(times):g} s is before the beginning, 0")
        if max(times) > LONGEST:
            raise DataError(path, item.line, f"{where}{max(times):g} s is more than a day; are these seconds?")
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
