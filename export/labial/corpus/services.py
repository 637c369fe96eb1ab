"""What speech services and neural synthesisers report as JSON: the table services.json, and its interpreter.

The table says of each service which lists and fields of its messages have texts and times; web/services.js reads the
same. :mod:`labial.corpus.formats` makes segments of a file of messages; :mod:`labial.corpus.messages` reads
messages as they arrive.
"""

from __future__ import annotations

import json
import math
import re
from datetime import timedelta
from numbers import Real
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from labial.corpus.entries import Entry, is_list, plain_name, shown
from labial.corpus.timings import LONGEST
from labial.errors import DataError

#: No word or phoneme lasts longer, in seconds.
_LONGEST_ITEM = 3600.0
#: The table as it stands in the file.
TABLE = json.loads(Path(__file__).with_name("services.json").read_text(encoding="utf-8"))
#: By the service, the phoneme of each viseme, and of two in a row with a blank between them.
VISEMES: Dict[str, Dict[str, str]] = TABLE["visemes"]
#: Kinds of items, of which the first that a file has counts.
KINDS = ("sounds", "labels", "phonemes", *VISEMES, "words", "characters")
_DIGITS = re.compile(r"[0-9]+$")
_MISSING = object()


class Timed(NamedTuple):
    """A text in seconds; the end is None if the service reports none."""

    text: str
    start: float
    end: Optional[float]
    place: Entry


class Told(NamedTuple):
    """What a message tells of one kind."""

    kind: str  #: one of `KINDS`
    items: List[Timed]
    key: Optional[float] = None  #: later messages with the same key replace this one


class Odd:
    """Items that make no sense: `strict` raises a DataError for the first one, otherwise they are counted."""

    def __init__(self, strict: bool) -> None:
        self._strict = strict
        self.count = 0
        self.first: Optional[DataError] = None

    def add(self, place: Entry, problem: str, *values: Any) -> None:
        """An item is skipped; `problem` is a format of `values`."""
        self.count += 1
        if self.first is None:
            self.first = place.error(problem.format(*map(shown, values)))
        if self._strict:
            raise self.first

    def count_of(self, error: DataError) -> None:
        """The same for an error that was found elsewhere."""
        self.count += 1
        self.first = self.first or error


# ---- The table's fields


class _Field:
    """A field of the table: its alternatives, each the names on its way and the divisor that makes seconds of it."""

    def __init__(self, text: str) -> None:
        self.optional = text.startswith("?")
        self.options: List[Tuple[List[Tuple[str, int, bool]], float, str]] = []
        for option in text.lstrip("?").split("|"):
            path, _, divisor = option.partition("/")
            steps = [_step(name) for name in path.split(".")] if path else []
            is_number = not divisor or divisor[0].isdigit()
            self.options.append((steps, float(divisor or 1) if is_number else 0.0,
                                 "" if is_number else plain_name(divisor)))
        self.name = text.lstrip("?=").split("|")[0].split("/")[0]

    def found(self, entry: Entry) -> Tuple[Any, int]:
        """The value of the first alternative that exists, and its number; `_MISSING` without one."""
        for number, (steps, _, _) in enumerate(self.options):
            value = _descended(entry, steps)
            if value is not _MISSING:
                return value, number
        return _MISSING, 0

    def divisor(self, number: int, entry: Entry, root: Entry) -> float:
        """What the value of an alternative is divided by; 0 where the field that says it does not."""
        _, divisor, name = self.options[number]
        if not name:
            return divisor
        value = _number(entry.plain.get(name, root.plain.get(name)), 1.0)
        return value if value is not None and value >= 1.0 else 0.0


class _Column(NamedTuple):
    """Times of items, and what they are divided by."""

    values: List[Any]
    divisor: float

    def time(self, number: int) -> Optional[float]:
        return _number(self.values[number], self.divisor)


def _step(name: str) -> Tuple[str, int, bool]:
    """A name, how many lists are in it, and whether it is looked up as it is written."""
    depth, bare = name.count("[]"), name.replace("[]", "")
    return (bare[1:], depth, True) if bare.startswith("=") else (plain_name(bare), depth, False)


def _descended(entry: Entry, steps: Sequence[Tuple[str, int, bool]]) -> Any:
    """The value at the end of a way, of lists that of the first item."""
    value: Any = _MISSING
    for place, (name, depth, exact) in enumerate(steps):
        inner = entry.inner(value) if place else entry
        if inner is None:
            return _MISSING
        value = (inner.fields if exact else inner.plain).get(name, _MISSING)
        for _ in range(depth):
            value = value[0] if is_list(value) and value else _MISSING
    return value


def _number(value: Any, divisor: float) -> Optional[float]:
    """A value in seconds; None for what is no finite number from 0 on. A timedelta has its own unit."""
    if isinstance(value, timedelta):
        value, divisor = value.total_seconds(), 1.0
    elif type(value) not in (int, float) and (isinstance(value, bool) or not isinstance(value, Real)):
        return None
    try:
        number = float(value) / divisor
    except (OverflowError, ZeroDivisionError):
        return None
    return number if 0.0 <= number < math.inf else None


def _listed(value: Any) -> Optional[List[Any]]:
    """A list, or an array or tensor as one; None for anything else."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    return list(value) if is_list(value) else None


class _Tell:
    """One row of what a service tells."""

    def __init__(self, row: Dict[str, Any]) -> None:
        self.kind: str = row["kind"]
        self.places = [[_step(name) for name in path.split(".")] if path else [] for path in row.get("in", [""])]
        self.lists: bool = row.get("lists", False)
        self.text = _Field(row["text"])
        self.start, self.end, self.length, self.span, self.offset, self.key = (
            _Field(row[name]) if name in row else None
            for name in ("start", "end", "length", "span", "offset", "key"))
        self.only, self.without = (
            [(_Field(name), text) for name, text in row.get(rule, {}).items()] for rule in ("only", "not"))
        self.pieces = [_Field(name) for name in row.get("pieces", [])]
        self.letters: Dict[str, str] = TABLE["letters"] if row.get("letters") else {}
        self.hold: float = row.get("hold", 0.0)

    def read(self, item: Entry, odd: Odd) -> List[Timed]:
        """The items of a message."""
        for path in self.places:
            found = [one for one in self._within(item, path, odd) if self.text.found(one)[0] is not _MISSING]
            if found:
                break
        else:
            return []
        later = 0.0
        if self.offset is not None:
            value, number = self.offset.found(item)
            shift = 0.0 if value is _MISSING else _number(value, self.offset.divisor(number, item, item))
            if shift is None:
                odd.add(item, "{!r} is {}, not a number from 0 on", self.offset.name, value)
                return []
            later = shift
        rows = [row for one in found for row in self._rows(one, odd)] if self.lists else self._objects(found, item, odd)
        times = [Timed(self.letters.get(text, text), start + later, None if end is None else end + later, place)
                 for text, start, end, place in rows if self._believed(text, start, end, place, odd)]
        if self.hold:
            # An item lasts until the next one if the gap is short.
            times = [one._replace(end=after) if one.end is not None and one.end >= after - self.hold else one
                     for one, after in zip(times, [*(item.start for item in times[1:]), math.inf])]
        return times

    def listed(self, item: Entry) -> bool:
        """Whether there is a list of items, which may be empty."""
        return is_list(_descended(item, [(name, 0, exact) for name, _, exact in self.places[0]]))

    def _within(self, item: Entry, path: Sequence[Tuple[str, int, bool]], odd: Odd) -> List[Entry]:
        found = [item]
        for place, (name, depth, _) in enumerate(path):
            after: List[Entry] = []
            for one in found:
                values: List[Any] = [one.plain.get(name)]
                for _ in range(depth):  # the items of lists in lists; what is no list is one item
                    values = [item for listed in values for item in (listed if is_list(listed) else [listed])]
                for value in values:
                    inner = one.inner(value, len(after) + 1 if depth else None)
                    if inner is not None:
                        after.append(inner)
                    elif value is not None and place == len(path) - 1:
                        odd.add(one, "{} is not an object", value)
            found = after
        return found

    def _objects(self, found: Sequence[Entry], root: Entry, odd: Odd) -> Iterator[_Row]:
        """Of objects, one for each item."""
        moment, behind, before = 0.0, None, None
        for one in found:
            if not all(str(field.found(one)[0]).lower() == text for field, text in self.only) or any(
                    text in str(field.found(one)[0]).lower() for field, text in self.without):
                continue
            text = self._text(self.text.found(one)[0], one, odd)
            start = moment if self.start is None else self._time(self.start, one, root, odd)
            span = None if self.length is None else self._time(self.length, one, root, odd)
            end = None if self.end is None else self._time(self.end, one, root, odd)
            if text is None or math.nan in (start, span, end):
                continue
            start = start or 0.0  # protobuf's JSON leaves zeros out
            end = end if span is None else start + span
            if self.start is None and end is not None:
                moment = end
            if self.pieces:
                first, last = (field.found(one)[0] for field in self.pieces)
                if before is not None and first == behind and before[0][-1:].isalnum() and text[:1].isalnum():
                    before = (before[0] + text, before[1], end, before[3])
                else:
                    if before is not None:
                        yield before
                    before = (text, start, end, one)
                behind = None if last is _MISSING else last
            else:
                yield text, start, end, one
        if before is not None:
            yield before

    def _rows(self, one: Entry, odd: Odd) -> Iterator[_Row]:
        """Of an object, lists of the same length."""
        value = self.text.found(one)[0]
        texts = ["", *value, ""] if isinstance(value, str) else _listed(value)
        columns = self._columns(one, odd)
        if columns is None:
            return
        starts, spans, lengths, ends = columns
        if texts is None or (spans is None and lengths is None and ends is None):
            missing = self.text if texts is None else self.span or self.end or self.length
            odd.add(one, "no field {!r}", missing.name if missing else "")
            return
        if spans is not None:
            pairs = [_listed(pair) or [] for pair in spans.values]
            starts, ends = (_Column([pair[k] if len(pair) == 2 else None for pair in pairs], spans.divisor)
                            for k in (0, 1))
        counts = {len(texts), *(len(column.values) for column in (starts, lengths, ends) if column is not None)}
        if len(counts) > 1 or (starts is None and self.start is not None):
            odd.add(one, "{!r} and their times are not of one length", self.text.name)
            return
        moment = 0.0
        for number, value in enumerate(texts):
            text = self._text(value, one, odd)
            start = moment if starts is None else starts.time(number)
            length = None if lengths is None else lengths.time(number)
            end = None if ends is None else ends.time(number)
            if start is not None and length is not None:
                end = start + length
            if start is None or end is None:
                wrong = starts if start is None else ends if lengths is None else lengths
                odd.add(one, "a time of {!r} is {}, not a number from 0 on", self.text.name,
                        wrong.values[number] if wrong else None)
                continue
            moment = end
            if text is not None:
                yield text, start, end, one

    def _columns(self, one: Entry, odd: Odd) -> Optional[List[Optional[_Column]]]:
        """The lists of starts, spans, lengths and ends of an object, None for those that it lacks; ends only where
        there are no lengths. None, and what is odd, where one is no list."""
        columns: List[Optional[_Column]] = []
        for field in (self.start, self.span, self.length, self.end):
            if field is None or (field is self.end and columns[2] is not None):
                columns.append(None)
                continue
            value, number = field.found(one)
            values = None if value is _MISSING else _listed(value)
            if value is not _MISSING and values is None:
                odd.add(one, "{!r} is {}, not a list", field.name, value)
                return None
            columns.append(None if values is None else _Column(values, field.divisor(number, one, one)))
        return columns

    def _text(self, value: Any, place: Entry, odd: Odd) -> Optional[str]:
        value = getattr(value, "value", value)  # of an enumeration
        if self.kind in VISEMES:
            value = str(value) if isinstance(value, int) else value
            if not isinstance(value, str) or value not in VISEMES[self.kind]:
                odd.add(place, "no viseme is called {!r}", value)
                return None
        if not isinstance(value, str):
            odd.add(place, "{!r} is {}, not text", self.text.name, value)
            return None
        return _DIGITS.sub("", value.strip()) if self.kind == "phonemes" else value

    def _time(self, field: _Field, one: Entry, root: Entry, odd: Odd) -> Optional[float]:
        """A field of an object in seconds; None where it may be missing and is, NaN where it makes no sense."""
        value, number = field.found(one)
        if field.optional and (value is _MISSING or value is None):
            return None
        divisor = field.divisor(number, one, root)
        if value is _MISSING or divisor == 0.0:
            odd.add(one, "no field {!r}", field.name if divisor else field.options[number][2])
            return math.nan
        found = _number(value, divisor)
        if found is None:
            odd.add(one, "{!r} is {}, not a number from 0 on", field.name, value)
            return math.nan
        return found

    def _believed(self, text: str, start: float, end: Optional[float], place: Entry, odd: Odd) -> bool:
        latest = start if end is None else max(start, end)
        if latest > LONGEST:
            odd.add(place, "{} s is more than a day; are these seconds?", f"{latest:g}")
        elif end is not None and end < start and self.kind != "characters":
            odd.add(place, "{!r} ends at {} s, before its start {} s", text, f"{end:g}", f"{start:g}")
        elif end is not None and end - start > _LONGEST_ITEM:
            odd.add(place, "{!r} lasts {} s, more than an hour", text, f"{end - start:g}")
        else:
            return True
        return False


#: Text, beginning, end and place.
_Row = Tuple[str, float, Optional[float], Entry]


class Service:
    """A service of the table."""

    def __init__(self, row: Dict[str, Any]) -> None:
        self.title: str = row["title"]  #: its name, for messages
        self.source: str = row["from"]  #: from what its entry was written
        self.advice: str = row.get("advice", "")  #: how to ask it for timings
        self.times: str = row.get("times", "")  #: "restart", "chained" or ""
        self._marks = [[_Field(name) for name in fields] for fields in row.get("is", [])]
        #: Names by one of which an object of it can be told.
        self._begins = {plain_name(steps[0][0]) for fields in self._marks for steps, _, _ in fields[0].options}
        self._utterance = _Field(row["utterance"]) if "utterance" in row else None
        self._tells = [_Tell(tell) for tell in row["tells"]]

    @property
    def is_bare(self) -> bool:
        """Whether its messages are nothing but timings: others may have fields of the same names."""
        return all(tell.places == [[]] for tell in self._tells)

    def told(self, item: Entry) -> bool:
        """Whether an object is one of this service."""
        return not self._begins.isdisjoint(item.plain) and any(
            all(field.found(item)[0] is not _MISSING for field in fields) for fields in self._marks)

    def utterance(self, item: Entry) -> Optional[str]:
        """What identifies the utterance of a message, if anything does."""
        value = _MISSING if self._utterance is None else self._utterance.found(item)[0]
        return str(value) if isinstance(value, (str, int)) else None

    def read(self, item: Entry, odd: Odd) -> List[Told]:
        """What a message tells, by kinds; those of which it tells nothing are left out unless they replace others."""
        found = []
        for tell in self._tells:
            items = tell.read(item, odd)
            key = None if tell.key is None else _number(tell.key.found(item)[0], 1.0)
            if items or (key is not None and tell.listed(item)):
                found.append(Told(tell.kind, items, key))
        return found


#: Every service by its name for --from, in the order of detection.
SERVICES: Dict[str, Service] = {name: Service(row) for name, row in TABLE["services"].items()}


def service_of(item: Entry) -> Optional[str]:
    """The service that an object is of, by its fields; None for others."""
    return next((name for name, service in SERVICES.items() if service.told(item)), None)
