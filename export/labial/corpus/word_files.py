"""Files of what speech services tell of words, of written characters and of phonemes, as segments.

A file holds one message, a list of messages or one per line, in the order of their arrival;
:mod:`labial.corpus.word_services` says what each tells. Words and characters get phonemes by
:mod:`labial.corpus.words`, as `how` says: English ones without it.
"""

from __future__ import annotations

from typing import Callable, Dict, List, Sequence, Tuple

from labial.corpus.entries import Entry, read_entries
from labial.corpus.timings import PathLike, SourceSegment, checked
from labial.corpus.word_services import SERVICES, Timed, Told, end_of, later, origin_of
from labial.corpus.words import LATEST, PLAIN, Pronunciation, Word, timings_of, words_of_characters
from labial.errors import DataError, StreamError

#: A gap between phonemes, in seconds, is silence if it is longer.
LONGEST_GAP = 0.15


def reader(name: str) -> Callable[..., List[SourceSegment]]:
    """The reader of a service's files."""
    service = SERVICES[name]

    def read_file(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
        return read(path, service.tell, how, service.joins)

    return read_file


def read(path: PathLike, tell: Callable[[Entry], List[Told]], how: Pronunciation = PLAIN,
         joins: bool = False) -> List[SourceSegment]:
    """Reads a file of a service's messages, of which `tell` says what each tells."""
    found: Dict[str, List[Tuple[int, Told]]] = {"phonemes": [], "words": [], "characters": []}
    for number, item in enumerate(read_entries(path)):
        for told in tell(item):
            found[told.kind].append((number, told))
    kind = next((kind for kind, messages in found.items() if any(told.items for _, told in messages)), "words")
    items = _all(found[kind], joins)
    if kind == "phonemes":
        return _from_phonemes(path, items)
    return _from_words(path, items, how) if kind == "words" else _from_characters(path, items, how)


def _all(messages: Sequence[Tuple[int, Told]], joins: bool) -> List[Timed]:
    """The items of numbered messages one after the other. Where messages have keys, they are in the order of these, and
    the latest of each counts; one without has its number."""
    if any(told.key is not None for _, told in messages):
        keyed = {number if told.key is None else told.key: told.items for number, told in messages}
        return [item for key in sorted(keyed) for item in keyed[key]]
    found: List[Timed] = []
    end = 0.0
    for _, told in messages:
        if told.items:
            origin = origin_of(told.items, end) if joins else 0.0
            found += [later(item, origin) for item in told.items]
            end = max(end, end_of(found[-len(told.items) :]))
    return found


# ---- Segments


def _from_words(path: PathLike, words: Sequence[Timed], how: Pronunciation) -> List[SourceSegment]:
    return _segments(path, [Word(word.text, milliseconds_of(word, word.start),
                                 None if word.end is None else milliseconds_of(word, word.end)) for word in words],
                     words, how)


def _from_characters(path: PathLike, found: Sequence[Timed], how: Pronunciation) -> List[SourceSegment]:
    starts = [milliseconds_of(item, item.start) for item in found]
    ends = [milliseconds_of(item, item.end or item.start) for item in found]
    return _segments(path, words_of_characters([item.text for item in found], starts, ends), found, how)


def _segments(path: PathLike, words: Sequence[Word], found: Sequence[Timed],
              how: Pronunciation) -> List[SourceSegment]:
    if not found:
        raise DataError(path, None, "no words with their times")
    for before, word in zip(words, words[1:]):
        if word.start < before.start:
            raise DataError(path, None, f"{word.text!r:.40} begins before {before.text!r:.40}, which comes first")
    try:
        timings = timings_of(words, how)
    except StreamError as error:
        raise DataError(path, None, str(error)) from None
    segments, moment = [], 0
    for label, length in timings:
        segments.append(SourceSegment(moment / 1000, (moment + length) / 1000, "" if label == "SIL" else label,
                                      labels="arpabet"))
        moment += length
    return checked(path, segments)


def _from_phonemes(path: PathLike, found: Sequence[Timed]) -> List[SourceSegment]:
    """Segments of phonemes in the IPA; short gaps belong to the phoneme before."""
    nexts = [item.start for item in found[1:]]
    segments = []
    for item, after in zip(found, [*nexts, -1.0]):
        end = item.start if item.end is None else item.end
        end = after if end < after <= end + LONGEST_GAP else end
        label = item.text.strip()
        segments.append(SourceSegment(item.start, end, label, line=item.place.line, labels="ipa"))
    return checked(path, segments)


def milliseconds_of(item: Timed, seconds: float) -> int:
    """A time of an item in milliseconds. Raises DataError for one that is not believed."""
    if not seconds * 1000 <= LATEST:
        raise item.place.error(f"{seconds:g} s is later than any time that is believed")
    return round(seconds * 1000)
