"""Phoneme timings: what aligners and synthesisers write, as lists of segments in seconds.

Lines and TextGrids are parsed by the library. Every reader checks that times are finite and from 0 on, that no segment
ends before it begins and that segments are in order and do not overlap by more than `TOLERANCE`; anything else is a
DataError with file and line. Labels stay as they are until :func:`phoneme_segments` maps them.
"""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import dataclass, field
from io import StringIO
from itertools import islice
from typing import Iterable, List, Optional, Sequence, Set, Tuple

from labial.core import lines
from labial.core.guard import SHORTEST
from labial.core.lines import LAUGH
from labial.corpus.episode import Segment
from labial.corpus.phonesets import AUTO, PHONE_SETS, PhoneSet
from labial.errors import DataError, PathLike
from labial.files.grammar import read_text

#: Overlaps and gaps up to this many seconds come from rounding and are closed.
TOLERANCE = 0.001
#: No timing of an episode is later; beyond it the unit is not seconds (HTK writes units of 100 ns).
LONGEST = 86400.0
#: No phoneme is longer, in seconds (LABIAL_DURATION_MAX).
_LONGEST_PHONEME = 3600
#: Seconds. No sound of speech lasts longer; the times of one that does are probably in another unit.
_LONGEST_SOUND = 10.0
#: A TextGrid's interval tier and its name.
_TIER = re.compile(r'"IntervalTier"[^"]*"((?:[^"]|"")*)"')
_NO_LAUGH = "one model alone cannot laugh, so laughs are silence; labial-say and labial.render() laugh"


@dataclass(frozen=True)
class SourceSegment(Segment):
    """A segment with the line it was read from; None where lines tell nothing, as in a JSON document."""

    line: Optional[int] = None
    labels: str = AUTO  #: the set that the format's labels are of
    tier: str = field(default="", compare=False)  #: the name of a TextGrid's tier


def read_segments(path: PathLike, form: str = AUTO, tier: Optional[str] = None, number: int = 0) -> List[SourceSegment]:
    """Reads timings in one of the formats of labial/timings.h, which the library parses; "auto" tells by the first line
    which. Of a TextGrid the interval tier called `tier` or, from 1 on, the one of this `number`, which may be none;
    without them that of phones."""
    segments: List[SourceSegment] = []
    text, name = read_text(path), ""
    try:
        for item in lines.timings(text.encode("utf-8"), form, tier, number):
            if not segments:
                name = next(iter(_TIER.findall("".join(islice(StringIO(text), item.line)))[-1:]), "")
            segments.append(SourceSegment(item.start, item.end, item.label, item.apex, item.word, item.line,
                                          "xsampa" if item.xsampa else AUTO, name))
    except lines.Malformed as error:
        raise DataError(path, error.line, str(error)) from None
    if not segments and not number:
        raise DataError(path, None, "no segments")
    return segments


def phone_set_of(segments: Sequence[SourceSegment], labels: str = AUTO) -> PhoneSet:
    """The phone set that knows most of the segments' labels; the first one, speech, where several know as many."""
    return max(PHONE_SETS.values(), key=lambda phones: sum(
        meaning(segment, phones, labels) is not None for segment in segments))


def meaning(segment: SourceSegment, phone_set: PhoneSet, labels: str = AUTO) -> Optional[str]:
    """The phoneme of `phone_set` that a segment's label means in the set `labels`, or None; silence where it has none.
    Where `labels` is "auto", labels of a format that has one set are of that first."""
    if not segment.label:
        return phone_set.silence
    known = phone_set.resolve(segment.label, segment.labels) if labels == AUTO else None
    return phone_set.resolve(segment.label, labels) if known is None else known


def phoneme_segments(path: PathLike, segments: Sequence[SourceSegment], phone_set: PhoneSet, strict: bool = True,
                     labels: str = AUTO, laughs: bool = False) -> Tuple[Segment, ...]:
    """Maps labels of the set `labels` to `phone_set` and joins the segments without gaps from time 0; `path` is for the
    error message. An empty label and every gap over `TOLERANCE` are silence; smaller gaps and overlaps go to the later
    segment. A silence of more than an hour becomes several; another phoneme of such a length is a DataError. Unknown
    labels are a DataError, as a corpus of the wrong kind should be; unless `strict`, they are the nearest phoneme, with
    one warning each. Laughs stay as ``<laugh:0.7>`` if `laughs`; otherwise they are unknown labels, too, and silence.
    Sounds that are too long or too short to be speech give a warning."""
    result: List[Segment] = []
    warned: Set[str] = set()
    long_named = False
    previous = 0.0
    for place, item in enumerate(segments, 1):
        laugh = laugh_of(item.label)
        label = laugh if laughs and laugh else meaning(item, phone_set, labels)
        where = "" if item.line else f"interval {place}: "
        if label is None:
            tier = f" (tier {item.tier!r})" if item.tier else ""
            problem = DataError(path, item.line, f"{where}no {phone_set.kind} phoneme is called {item.label!r}{tier}")
            if strict:
                raise problem
            label = phone_set.silence if laugh else phone_set.nearest(item.label, labels)
            if (key := "<laugh>" if laugh else item.label) not in warned:
                warned.add(key)
                silent = str(DataError(path, item.line, f"{where}{_NO_LAUGH}"))
                warnings.warn(silent if laugh else f"{problem}; it moves as {label}", stacklevel=2)
        if item.start - previous > TOLERANCE:
            previous = _silence(result, previous, item.start, phone_set)
        end = max(item.end, previous)
        if end - previous > _LONGEST_PHONEME:
            if label != phone_set.silence:
                raise DataError(path, item.line, f"{where}{item.label!r} lasts {end - previous:g} s, more than the "
                                f"{_LONGEST_PHONEME} s that a phoneme may")
            previous = _silence(result, previous, end - _LONGEST_PHONEME, phone_set)
        if end - previous > _LONGEST_SOUND and label not in (phone_set.silence, laugh) and not long_named:
            long_named = True
            lasts = f"{item.label!r} lasts {end - previous:g} s: is the unit of time right?"
            warnings.warn(str(DataError(path, item.line, lasts)), stacklevel=2)
        apex = None if item.apex is None else min(max(item.apex, previous), end)
        result.append(Segment(previous, end, label, apex, item.word))
        previous = end
    durations = [item.duration for item in result if item.label != phone_set.silence]
    # The length of the last sound may be a guess, as services report only when it begins.
    if durations and 1000 * max(durations[:-1] or durations) < SHORTEST:
        what = "every sound but the last" if len(durations) > 1 else "every sound"
        text = f"{what} is shorter than {SHORTEST:g} ms: is the unit of time right?"
        warnings.warn(str(DataError(path, None, text)), stacklevel=2)
    return tuple(result)


def laugh_of(label: str) -> Optional[str]:
    """A laugh's label without blanks; None for a label that is not a laugh's."""
    found = LAUGH.fullmatch(label)
    return found and (f"<laugh:{found[1]}>" if found[1] else "<laugh>")


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


def checked(path: PathLike, segments: List[SourceSegment]) -> List[SourceSegment]:
    """`segments`, or a DataError where times are late, turned round, overlap, or there are none."""
    if not segments:
        raise DataError(path, None, "no segments")
    previous = -math.inf
    for place, item in enumerate(segments, 1):
        times = [item.start, item.end] + ([] if item.apex is None else [item.apex])
        problem = ""
        if min(times) < 0:
            problem = f"{min(times):g} s is before the beginning, 0"
        elif max(times) > LONGEST:
            problem = f"{max(times):g} s is more than a day; are these seconds?"
        elif item.end < item.start:
            problem = f"the segment ends at {item.end:g} s, before its start {item.start:g} s"
        elif item.start < previous - TOLERANCE:
            problem = f"the segment starts at {item.start:g} s, before the end of the one before, {previous:g} s"
        elif item.apex is not None and not item.start - TOLERANCE <= item.apex <= item.end + TOLERANCE:
            problem = f"the apex {item.apex:g} s is outside its segment"
        if problem:
            raise DataError(path, item.line, problem if item.line else f"interval {place}: {problem}")
        previous = max(previous, item.end)
    return segments
