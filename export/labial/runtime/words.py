"""Words to phonemes: of texts, of words with their times, of characters with theirs."""

from __future__ import annotations

from typing import Any, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from labial.core.guard import expect_milliseconds, number, whole
from labial.corpus.words import (
    ENGLISH,
    LATEST,
    Word,
    phonemes_of,
    pronunciation,
    timings_of,
    words_of,
    words_of_characters,
)
from labial.errors import LabialError

#: Phonemes in ARPABET: with blanks between them, or a list.
Sounds = Union[str, Sequence[str]]
#: A word, when it begins and when it ends, milliseconds; None for an end that is not known.
TimedWord = Tuple[str, float, Optional[float]]


def phonemes(text: str, *, own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH,
             numbers: bool = False) -> List[str]:
    """The phonemes of a text, in ARPABET without stress, word after word; silences are not known.

    `own` has words that are pronounced otherwise: ``{"google": "G UW G AH L"}``, or lists of phonemes. `language` is
    "en", which the library reads itself, or what espeak-ng, if it is installed, calls a language or a voice; its
    phonemes become those of English that look most like them. With `numbers`, num2words, if it is installed, writes
    out what stands in digits. Raises LabialError.
    """
    if not isinstance(text, str):
        raise TypeError(f"a text is a str, not {type(text).__name__}")
    found = phonemes_of(words_of(text), pronunciation(own, language, numbers))
    return [label for spoken in found for label in spoken.phonemes]


def word_timings(timed: Iterable[TimedWord], *, offset_ms: float = 0,
                 own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH,
                 numbers: bool = False) -> List[Tuple[str, int]]:
    """The timings of :func:`labial.render` from words and their times.

    `timed` are words as they are written, punctuation included, with their beginnings and ends in milliseconds. An end
    may be None: then the word lasts until the next one, or as long as such a word usually does. `offset_ms` is added to
    all times: a positive number for a voice that reports its words too early. The other arguments are those of
    :func:`labial.phonemes`. Raises LabialError, with the word, for words that are not in order; warns where all
    durations are below 5 ms, as seconds are.
    """
    found, longest, before = [], 0.0, 0.0
    for place, item in enumerate(timed, 1):
        if not isinstance(item, (tuple, list)) or len(item) != 3 or not isinstance(item[0], str):
            raise TypeError(f"word {place} is no text with its beginning and end in milliseconds")
        text, start, end = item
        found.append(Word(text, _time(start), None if end is None else _time(end)))
        longest = max(longest, float(start) - before, 0.0 if end is None else float(end) - float(start))
        before = float(start)
    expect_milliseconds(longest)
    return timings_of(found, pronunciation(own, language, numbers), offset(offset_ms))


def character_timings(text: Union[str, Sequence[str]], starts: Sequence[float], ends: Sequence[float], *,
                      offset_ms: float = 0, own: Optional[Mapping[str, Sounds]] = None,
                      language: str = ENGLISH, numbers: bool = False) -> List[Tuple[str, int]]:
    """The same from characters and their times in milliseconds, as ElevenLabs reports them; `text` is a string or a
    list of characters, blanks included. Raises LabialError where the numbers of characters and times differ."""
    if not len(text) == len(starts) == len(ends):
        raise LabialError(f"{len(text)} characters have {len(starts)} beginnings and {len(ends)} ends")
    found = words_of_characters(list(text), [_time(time) for time in starts], [_time(time) for time in ends],
                                language)
    expect_milliseconds(max((float(end) - float(start) for start, end in zip(starts, ends)), default=0.0))
    return timings_of(found, pronunciation(own, language, numbers), offset(offset_ms))


def _time(value: Any) -> int:
    found = number(value, "a time")
    if not 0.0 <= found <= LATEST:
        raise LabialError(f"{found:g} ms is no time from 0 to {LATEST} ms")
    return round(found)


def offset(value: Any) -> int:
    """Milliseconds to be added to times. Raises TypeError, and LabialError for more than 1e9."""
    found = number(value, "an offset")
    if not abs(found) <= 1e9:
        raise LabialError(f"an offset of {found:g} ms is not within 1e9 ms")
    return whole(round(found), "an offset")
