"""What is known of a voice: its utterances and their phonemes, in time. docs/streams.md has the rules.

All times are whole milliseconds: those of items from the beginning of their utterance, those of segments from the
beginning of the played sound.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

from labial.corpus.messages import Heard
from labial.corpus.services import LAST_VISEME, VISEMES, stand_ins
from labial.corpus.words import (
    ENGLISH,
    Pronunciation,
    Word,
    known_words,
    own_words,
    stretches_of,
    timings_of,
    words_of_characters,
)
from labial.errors import LabialError

#: Items that may be known at a time: a server is not trusted.
MOST = 10_000
#: Kinds of items: of those that an utterance has, the first counts.
KINDS = ("phonemes", *VISEMES, "words", "characters")
#: What is over is forgotten so many milliseconds later.
_KEPT = 1000
#: A gap between phonemes up to this comes from rounding.
_ROUNDING = 1
#: Before a change, so many characters are read again, for a [tag] may have begun there.
_BACK = 100
#: Pronunciations of other languages that are kept.
_SPOKEN = 10_000


class Item(NamedTuple):
    """A phoneme, viseme, word or character of an utterance."""

    start: int
    end: Optional[int]  #: None where it is not known
    what: Union[str, int]  #: its text; a phoneme's label or number
    gap: int = _ROUNDING  #: so long a gap after a phoneme belongs to it
    key: Optional[float] = None  #: a later message with this key replaces it


class Segment(NamedTuple):
    """A phoneme in time."""

    start: int
    end: float  #: infinite for the silence after all that is known
    phoneme: int  #: its number in the model


def milliseconds(seconds: float) -> int:
    """Whole milliseconds; halves are rounded up, here and in JavaScript."""
    return math.floor(seconds * 1000.0 + 0.5)


class Timeline:
    """The utterances of a voice.

    Args:
        number: the model's number of a phoneme's label. silence: that of its silence. how: how words are pronounced.
        offset: milliseconds, added to all times.
    """

    def __init__(self, number: Callable[[Union[str, int]], int], silence: int, how: Pronunciation,
                 offset: int = 0) -> None:
        self._number, self._silence, self._how, self._offset = number, silence, how, offset
        self._spoken: Dict[str, Sequence[str]] = {}
        self._utterances: List[_Utterance] = []
        own_words([], how)  # an error in a word of the caller's own is raised now

    @property
    def is_empty(self) -> bool:
        """Whether nothing is known."""
        return not any(utterance.segments for utterance in self._utterances)

    @property
    def end(self) -> int:
        """When the last utterance ends, as far as is known."""
        if not self._utterances:
            return 0
        last = self._utterances[-1]
        return max(last.end, last.origin + last.segments[-1][1]) if last.segments else last.end

    def begin(self, origin: int) -> None:
        """A new utterance; the one before it ends there at the latest."""
        self._utterances.append(_Utterance(origin))

    def clear(self) -> None:
        """Forgets all utterances."""
        self._utterances = []

    def tell(self, heard: Heard) -> None:
        """Adds what a message tells to the last utterance; items that begin within the time of the new ones are
        replaced. Raises LabialError where that cannot be read, and where there is too much of it; then nothing is
        changed."""
        copy = self._utterances[-1].copy()
        self._add(copy, _items_of(heard, copy))

    def put(self, kind: str, item: Item) -> None:
        """The same with an item of the caller's own."""
        self._add(self._utterances[-1].copy(), [(kind, [item])])

    def plan(self, start: int) -> List[Segment]:
        """All phonemes from `start` on, without gaps, and silence without end after them."""
        found: List[Segment] = []
        moment = start
        for utterance, limit in zip(self._utterances, [*(one.origin for one in self._utterances[1:]), math.inf]):
            shift = utterance.origin + self._offset
            for segment in utterance.segments:
                begin, end = max(segment[0] + shift, moment), int(min(segment[1] + shift, limit))
                if end <= begin:
                    continue
                if begin > moment:
                    self._append(found, moment, begin, self._silence)
                self._append(found, begin, end, segment[2])
                moment = end
        self._append(found, moment, math.inf, self._silence)
        return found

    def forget(self, moment: int) -> None:
        """Forgets what ended well before `moment`."""
        limit = moment - _KEPT - self._offset
        while len(self._utterances) > 1 and max(self._utterances[0].end, self._utterances[1].origin) < limit:
            del self._utterances[0]
        for utterance in self._utterances:
            utterance.forget(limit - utterance.origin)

    def _add(self, copy: _Utterance, told: List[Tuple[str, List[Item]]]) -> None:
        """Adds items to a copy of the last utterance, which then takes its place."""
        for kind, items in told:
            first = _put(copy.items.setdefault(kind, []), items)
            for item in items:
                copy.end = max(copy.end, copy.origin + (item.start if item.end is None else item.end))
            if sum(len(found) for one in (*self._utterances[:-1], copy) for found in one.items.values()) > MOST:
                raise LabialError(f"more than {MOST} words or phonemes are told ahead of the sound")
            if kind == copy.kind():
                self._convert(copy, kind, first if kind == copy.counted else 0)
        self._utterances[-1] = copy

    def _append(self, found: List[Segment], begin: int, end: float, phoneme: int) -> None:
        """Appends a segment; silences that adjoin are one."""
        if found and found[-1].phoneme == phoneme == self._silence:
            found[-1] = found[-1]._replace(end=end)
        else:
            found.append(Segment(begin, end, phoneme))

    def _convert(self, utterance: _Utterance, kind: str, changed: int) -> None:
        """Makes the segments of the items of a kind, of which those from `changed` on are new."""
        items = utterance.items[kind]
        first = _converted_from(kind, items, changed)
        kept = bisect_left(utterance.segments, (items[first].start - _ROUNDING,)) if first > 0 else 0
        del utterance.segments[kept:]
        utterance.counted = kind
        if kind == "phonemes":
            found = _sounds(items[first:], utterance.segments[-1][1] if kept else -math.inf)
        elif kind in VISEMES:
            found = _shapes(items[first:], kind)
        else:
            found = self._words(items[first:], kind)
        utterance.segments += [(start, end, self._number(what)) for start, end, what in found]

    def _words(self, items: Sequence[Item], kind: str) -> List[_Sound]:
        """The phonemes of words or of characters."""
        if kind == "words":
            words = [Word(str(item.what), item.start, item.end) for item in items]
        else:
            words = words_of_characters([str(item.what) for item in items], [item.start for item in items],
                                        [item.start if item.end is None else item.end for item in items])
        found: List[_Sound] = []
        moment = 0
        for label, length in timings_of(words, self._how_said([word.text for word in words])):
            if label != "SIL":
                found.append((moment, moment + length, label))
            moment += length
        return found

    def _how_said(self, texts: Sequence[str]) -> Pronunciation:
        """How these texts are pronounced; what other programs said of them once is not asked for again."""
        how = self._how
        if how.language == ENGLISH and not how.numbers:
            return how
        known = {**self._spoken, **how.own}
        asked = stretches_of(texts, known)
        if asked:
            if len(self._spoken) > _SPOKEN:
                self._spoken = {}
            found = known_words(asked, how._replace(own={}))
            self._spoken.update(found)
            known.update(found)
        wanted = stretches_of(texts, ())
        return Pronunciation({**{word: known[word] for word in wanted if word in known}, **how.own})


#: Beginning, end, label or number.
_Sound = Tuple[int, int, Union[str, int]]


class _Utterance:
    """Words or phonemes whose times count from `origin`."""

    def __init__(self, origin: int) -> None:
        self.origin = self.end = origin
        self.items: Dict[str, List[Item]] = {}
        self.told: Dict[str, float] = {}  # seconds up to which messages of a kind told something
        self.counted = ""  # the kind that `segments` are of
        self.segments: List[Tuple[int, int, int]] = []  # beginning and end from the origin, phoneme

    def copy(self) -> _Utterance:
        found = _Utterance(self.origin)
        found.items, found.told = {kind: [*items] for kind, items in self.items.items()}, {**self.told}
        found.end, found.counted, found.segments = self.end, self.counted, [*self.segments]
        return found

    def kind(self) -> str:
        """The kind that counts."""
        return next((kind for kind in KINDS if self.items.get(kind)), "")

    def forget(self, limit: int) -> None:
        """Forgets the items that end before `limit`, but the last ones; characters up to a blank."""
        for kind, items in self.items.items():
            count = 0
            for place, item in enumerate(items[:-1]):
                if max(item.start, item.end or 0, items[place + 1].start) >= limit:
                    break
                if kind != "characters" or str(item.what).isspace():
                    count = place + 1
            del items[:count]
        while len(self.segments) > 1 and self.segments[0][1] < limit:
            del self.segments[0]


def _items_of(heard: Heard, utterance: _Utterance) -> List[Tuple[str, List[Item]]]:
    """The items that a message tells, by kind, and in the order of their beginnings."""
    found = []
    for told in heard.told:
        before, timed = utterance.told.get(told.kind, 0.0), told.items
        if timed and (heard.chained or heard.joins):
            origin = before if heard.chained or timed[0].start < before - 1e-3 else 0.0
            timed = [item._replace(start=item.start + origin, end=None if item.end is None else item.end + origin)
                     for item in timed]
        if timed:
            utterance.told[told.kind] = max(before, *(item.end or item.start for item in timed))
        gap = max(milliseconds(heard.gap), _ROUNDING)
        items = [Item(milliseconds(item.start), None if item.end is None else milliseconds(item.end), item.text, gap,
                      told.key) for item in timed]
        if told.key is not None:
            known = utterance.items.get(told.kind, [])
            utterance.items[told.kind] = [item for item in known if item.key != told.key]
            utterance.counted = ""
        found.append((told.kind, sorted(items, key=lambda item: item.start)))
    return found


def _put(known: List[Item], items: List[Item]) -> int:
    """Puts items where they belong, in place of those that begin within their time; returns the place of the first."""
    if not items:
        return len(known)
    begin = items[0].start
    end = max(begin + 1, *(item.start + 1 if item.end is None else item.end for item in items))
    first = bisect_left(known, (begin,))
    known[first : bisect_left(known, (end,))] = items
    return first


def _converted_from(kind: str, items: Sequence[Item], changed: int) -> int:
    """The first item that may sound otherwise if those from `changed` on do."""
    if kind != "characters":
        return max(0, changed - 2)
    first = changed - _BACK
    while first > 0 and not str(items[first - 1].what).isspace():
        first -= 1
    return max(0, first)


def _sounds(items: Sequence[Item], previous: float) -> List[_Sound]:
    """Phonemes after one that ends at `previous`: each lasts until the next if the gap between them is short, and no
    longer."""
    found: List[_Sound] = []
    for item, after in zip(items, [*(item.start for item in items[1:]), -1]):
        start, end = item.start, item.start if item.end is None else item.end
        if abs(start - previous) <= _ROUNDING:
            start = int(previous)
        if end < after <= end + item.gap or end > after + _ROUNDING > 0:
            end = after
        end = max(start, end)
        found.append((start, end, item.what))
        previous = end
    return found


def _shapes(items: Sequence[Item], kind: str) -> List[_Sound]:
    """Visemes: each lasts until the next."""
    ends = [*(item.start for item in items[1:]), items[-1].start + milliseconds(LAST_VISEME)]
    return [(items[first].start, ends[last], phoneme)
            for (first, last), phoneme in stand_ins([str(item.what) for item in items], kind)]
