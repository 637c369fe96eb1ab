"""Phoneme timings in any format: the list of formats, how to recognise each by name, suffix or content, and its reader.

Files of messages that speech services report become segments, in seconds, as the readers of
:mod:`labial.corpus.timings` make them. Sounds, as from Piper and Kokoro, are characters of the IPA that become
phonemes: a stress mark's time goes to the vowel after it, that of a length mark or diacritic to the phoneme before it,
the two halves of a diphthong or affricate are one phoneme, and punctuation is silence. The blank between two words
takes time, too, but lips do not rest there: up to `LONGEST_GAP`, its time is added to the phoneme before it.

docs/timings.md has what each viseme becomes. Two in a row that occur together in only one English phoneme become that
phoneme; rounded lips are W before a vowel, else UW.
"""

from __future__ import annotations

import os
import unicodedata
from dataclasses import replace
from functools import cache
from itertools import accumulate, zip_longest
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

from labial.core import lines
from labial.corpus.entries import Parsed, read_entries
from labial.corpus.phonesets import AUTO, VOWELS
from labial.corpus.services import KINDS, SERVICES, TABLE, VISEMES, Odd, Timed, Told, service_of
from labial.corpus.timings import SourceSegment, checked, lab_of, phone_set_of, phoneme_segments, read_segments
from labial.corpus.words import PLAIN, Pronunciation, Word, timings_of, words_of_characters
from labial.errors import DataError, PathLike, StreamError
from labial.files.grammar import Content, read_bytes, read_text
from labial.files.limits import LABEL

#: A blank between words, or a gap between a service's phonemes, is a pause if it is longer, in seconds.
LONGEST_GAP = 0.15
#: Duration of the last viseme, seconds: services report only its beginning.
LAST_VISEME = 0.1
#: Times that differ by no more, in seconds, are the same.
_ROUNDING = 1e-3
#: Messages of which the times go on may overlap by as much, seconds.
_OVERLAP = 0.02
_STRESS = ("ˈ", "ˌ")


def read_service(path: PathLike, name: str, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads a file of a service's messages, in the order of their arrival. Errors are DataErrors with the line where
    each line is a document of its own, else with the number of the entry. Words and characters get phonemes by
    :mod:`labial.corpus.words`, as `how` says."""
    service, odd = SERVICES[name], Odd(strict=True)
    found: Dict[str, List[Tuple[Optional[str], Told]]] = {kind: [] for kind in KINDS}
    for item in read_entries(path):
        for told in service.read(item, odd):
            found[told.kind].append((service.utterance(item), told))
    kind = next((kind for kind, messages in found.items() if any(told.items for _, told in messages)), "words")
    items = _all(found[kind], service.times)
    if not items:
        advice = f": {service.advice}" if service.advice else ""
        raise DataError(path, None, f"{service.title} times nothing here{advice}")
    if kind in ("words", "characters"):
        return checked(path, _from_words(path, items, kind, how))
    return checked(path, _from_visemes(items, VISEMES[kind]) if kind in VISEMES else phoneme_segments_of(items, kind))


def _all(messages: Sequence[Tuple[Optional[str], Told]], times: str) -> List[Timed]:
    """The items of messages one after the other. Where messages have keys, they are in the order of these, and the
    latest of each counts. Times begin again with an utterance, and where a service may count from the message before:
    in one that begins before that one began, or with other words within it, of which it lasts at least half. They then
    count from the end of all that came before."""
    if any(told.key is not None for _, told in messages):
        keyed = {number if told.key is None else told.key: told.items for number, (_, told) in enumerate(messages)}
        return [item for key in sorted(keyed) for item in keyed[key]]
    found: List[Timed] = []
    origin = end = 0.0
    before: Optional[str] = None
    last: Optional[Timed] = None
    for utterance, told in messages:
        if not told.items:
            continue
        first = told.items[0]
        length = max(item.end or item.start for item in told.items) - first.start
        again = last is not None and (first.start < last.start - _ROUNDING or (
            (first.start, first.text) != (last.start, last.text)
            and end - origin - first.start > max(_OVERLAP, min(length, end - origin - last.start) / 2)))
        other = last is not None and utterance != before and origin + first.start < end - _ROUNDING
        if times == "chained" or other or (times == "restart" and again):
            origin = end
        found += [item._replace(start=item.start + origin, end=None if item.end is None else item.end + origin)
                  for item in told.items]
        end = max(end, *(item.end or item.start for item in found[-len(told.items) :]))
        before, last = utterance, first
    return found


def phoneme_segments_of(items: Sequence[Timed], kind: str) -> List[SourceSegment]:
    """Segments of sounds, labels or phonemes; short gaps belong to the phoneme before."""
    labels = "auto" if kind == "labels" else "ipa"
    segments = [SourceSegment(item.start, item.start if item.end is None else item.end, item.text,
                              line=item.place.line, labels=labels) for item in items]
    if kind == "sounds":
        return _phonemes_of(segments)
    if kind == "phonemes":
        nexts = [*(item.start for item in items[1:]), -1.0]
        segments = [_grown(one, after, one.label) if one.end < after <= one.end + LONGEST_GAP else one
                    for one, after in zip(segments, nexts)]
    return segments


def _from_words(path: PathLike, items: Sequence[Timed], kind: str, how: Pronunciation) -> List[SourceSegment]:
    words = [Word(item.text, round(1000 * item.start), None if item.end is None else round(1000 * item.end))
             for item in items]
    if kind == "characters":
        words = words_of_characters([word.text for word in words], [word.start for word in words],
                                    [word.end or word.start for word in words], how.language)
    for before, word in zip(words, words[1:]):
        if word.start < before.start:
            raise DataError(path, None, f"{word.text!r:.40} begins before {before.text!r:.40}, which comes first")
    try:
        timings = timings_of(words, how)
    except StreamError as error:
        raise DataError(path, None, str(error)) from None
    ends = [*accumulate((length for _, length in timings), initial=0)]
    return [SourceSegment(start / 1000, end / 1000, "" if label == "SIL" else label, labels="arpabet")
            for (label, _), start, end in zip(timings, ends, ends[1:])]


def _from_visemes(marks: Sequence[Timed], table: Dict[str, str]) -> List[SourceSegment]:
    """The phoneme of each viseme, or of two that stand for one."""
    names, found = [mark.text for mark in marks], []
    ends = [*(mark.start for mark in marks[1:]), marks[-1].start + LAST_VISEME]
    at = 0
    while at < len(names):
        count = 2 if names[at + 1 :] and f"{names[at]} {names[at + 1]}" in table else 1
        phoneme = table[" ".join(names[at : at + count])]
        found.append(SourceSegment(marks[at].start, ends[at + count - 1], phoneme, line=marks[at].place.line,
                                   labels="arpabet"))
        at += count
    vowels = set(VOWELS.split()) - {"UW"}
    return [replace(item, label="W") if item.label == "UW" and after and after.label in vowels else item
            for item, after in zip_longest(found, found[1:])]


# ---- Sounds


def _phonemes_of(tokens: Sequence[SourceSegment]) -> List[SourceSegment]:
    """Phonemes, in the IPA, of successive characters (see above); "" is silence, and so is every gap."""
    result: List[SourceSegment] = []
    begin: Optional[float] = None  # of the stress mark before the next phoneme
    joins = False  # the next character may be the second half of the phoneme before it
    for token in tokens:
        label = token.label
        last = result[-1] if result and result[-1].label else None
        if label in _STRESS:
            begin = token.start if begin is None else begin
        elif last and begin is None and label and all(
                unicodedata.category(c) in ("Lm", "Mn", "Sk", "Nd") for c in label):  # length, release, nasality, tone
            result[-1] = _grown(last, token.end, (last.label + label)[:LABEL])
        elif last and begin is None and joins and last.label + label in TABLE["pairs"] and token.start <= last.end:
            result[-1] = _grown(last, token.end, last.label + label)
        elif last and label.isspace() and token.duration <= LONGEST_GAP:
            result[-1] = _grown(last, token.end, last.label)
            joins = False
        elif all(unicodedata.category(c)[0] in "PSZC" for c in label):  # silence
            if result and not last:
                result[-1] = _grown(result[-1], token.end, "")
            else:
                result.append(SourceSegment(token.start, token.end, "", line=token.line))
            begin = None
        else:
            start = token.start if begin is None else begin
            result.append(SourceSegment(start, token.end, label, line=token.line, labels="ipa"))
            begin, joins = None, True
    return result


def _grown(segment: SourceSegment, end: float, label: str) -> SourceSegment:
    return SourceSegment(segment.start, end, label, line=segment.line, labels=segment.labels)


def names() -> Tuple[str, ...]:
    """Every format by its name for --from, which is that of labial-say where it has the format."""
    return (*lines.names()[1:], *SERVICES)


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
    the content. `how` says how words are pronounced. `offset` seconds are added to all times; what
    that moves before the beginning is cut off. `tier` names the tier of a TextGrid."""
    path = stored(path)
    form = source or suffixes().get(Path(path).suffix.lower()) or _told_by_content(path)
    segments = read_service(path, form, how) if form in SERVICES else read_segments(path, form, tier)
    if not offset:
        return segments
    moved = [replace(segment, start=max(0.0, segment.start + offset), end=segment.end + offset,
                     apex=None if segment.apex is None else max(0.0, segment.apex + offset))
             for segment in segments if segment.end + offset > 0.0]
    if not moved:
        raise DataError(path, None, f"an offset of {1000 * offset:g} ms leaves no segments")
    return moved


def stored(path: PathLike) -> PathLike:
    """What stands in for a file that is read several times, as a pipe cannot be: its bytes."""
    return path if isinstance(path, (Content, Parsed)) else Content(read_bytes(path), os.fspath(path))


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
    found = next((name for name in map(service_of, entries[:100]) if name), None)
    if found is None:
        titles = f"{', '.join(lines.names()[1:])}; JSON of {', '.join(item.title for item in SERVICES.values())}"
        raise DataError(path, None, f"no known format of phoneme timings ({titles})")
    return found
