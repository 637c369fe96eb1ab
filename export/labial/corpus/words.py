"""Words and characters with their times to phonemes with theirs: English by the library's tables, other languages by
espeak-ng where it is installed.

Times are whole milliseconds from the beginning of the sound. A word that the caller pronounces otherwise comes before
everything else; then numbers, if they are to be written out by num2words; then the language.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Container, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from labial.core.words import CHARACTERS_MAX, PHONEMES_MAX, OwnWords, Spoken, WordStream, read, read_words
from labial.corpus.languages import pronounced
from labial.errors import LabialError, needs

#: The language of the library's tables.
ENGLISH = "en"
#: Latest time, milliseconds: the library counts in 32 bits.
LATEST = (1 << 32) - 2

#: What a text's words are looked up by: letters, digits and what may stand within a word.
_STRETCH = re.compile(r"[^\W_]+(?:['’\-.,][^\W_]+)*")
_NUMBER = re.compile(r"\d+(?:,\d{3})*(?:\.\d+)?")
_TAGS = {"[": "]", "<": ">"}


class Word(NamedTuple):
    """A word in time."""

    text: str
    start: int  #: milliseconds
    end: Optional[int]  #: None where it is not known
    ends: Tuple[int, ...] = ()  #: of each character of the text, or none


class Pronunciation(NamedTuple):
    """How words are pronounced."""

    own: Mapping[str, Sequence[str]] = {}  #: word -> its phonemes in ARPABET
    language: str = ENGLISH  #: "en", or what espeak-ng calls a language or voice
    numbers: bool = False  #: digits are written out by num2words


def pronunciation(own: Optional[Mapping[str, Union[str, Sequence[str]]]] = None, language: str = ENGLISH,
                  numbers: bool = False) -> Pronunciation:
    """How words are pronounced, from arguments as callers have them: phonemes in one text, or a list."""
    split = {word: sounds.split() if isinstance(sounds, str) else list(sounds) for word, sounds in (own or {}).items()}
    return Pronunciation(split, language, bool(numbers))


#: English, without words of one's own.
PLAIN = Pronunciation()


def phonemes_of(texts: Iterable[str], how: Pronunciation = PLAIN) -> List[Spoken]:
    """What words sound like. Raises LabialError for an unknown language or phoneme, and where a program or package that
    `how` asks for is not installed."""
    given = list(texts)
    return read_words(given, own_words(given, how))


def timings_of(words: Sequence[Word], how: Pronunciation = PLAIN, offset: int = 0) -> List[Tuple[str, int]]:
    """The phonemes of words, in ARPABET with SIL for silence, and their milliseconds, from time 0 on.

    `offset` milliseconds are added to all times. Raises LabialError as :func:`phonemes_of`, and StreamError where a
    word ends before it begins, begins before an earlier one, or lasts more than an hour.
    """
    stream = WordStream(own_words([word.text for word in words], how), offset)
    found: List[Tuple[str, int]] = []
    for word in words:
        if word.ends and len(word.text) == len(word.ends) <= CHARACTERS_MAX:
            stream.push_characters(word.text, word.start, word.ends)
        else:
            stream.push(word.text, word.start, word.end)
        found += stream.take()
    stream.end()
    return found + stream.take()


def words_of_characters(characters: Sequence[str], starts: Sequence[int], ends: Sequence[int]) -> List[Word]:
    """The words of characters with their times: what stands between blanks, without [tags] and <tags>. A bracket
    that is not closed begins none.

    An item of several characters shares its time evenly among them. A character that ends before the one before it, as
    rounding and zero lengths make it, ends with that.
    """
    words: List[Word] = []
    text, start, times, closing = "", 0, [0], ""
    last = {mark: max((n for n, item in enumerate(characters) if mark in item), default=-1) for mark in _TAGS.values()}
    for number, (item, begin, end) in enumerate(zip([*characters, " "], [*starts, 0], [*ends, 0])):
        for place, character in enumerate(item, 1):
            mark = _TAGS.get(character, "")
            closing = closing or (mark if last.get(mark, -1) >= number else "")
            if closing or character.isspace():
                if text:
                    words.append(Word(text, start, times[-1], tuple(times[1:])))
                text, times = "", [0]
                closing = "" if character == closing else closing
                continue
            if not text:
                start = begin + (end - begin) * (place - 1) // len(item)
                times = [start]
            text += character
            times.append(max(times[-1], begin + (end - begin) * place // len(item)))
    return words


def own_words(texts: Iterable[str], how: Pronunciation) -> OwnWords:
    """What the library is told of the words of these texts."""
    return OwnWords(known_words(texts, how))


def known_words(texts: Iterable[str], how: Pronunciation) -> Dict[str, Sequence[str]]:
    """The phonemes of the caller's own words and, from these texts, of those that the library does not read itself."""
    known: Dict[str, Sequence[str]] = dict(how.own)
    stretches = stretches_of(texts, known)
    if how.numbers:
        for item in stretches:
            if _NUMBER.fullmatch(item):
                known[item] = _spoken(_written_out(item, how.language).split(), how)
    if how.language != ENGLISH:
        asked = [item for item in stretches if item not in known]
        said = zip(asked, pronounced(asked, how.language))
        known.update((word, phonemes) for word, phonemes in said if phonemes is not None)
    return {word: known[word] if word in how.own else known[word][:PHONEMES_MAX] for word in known}


def stretches_of(texts: Iterable[str], known: Container[str]) -> List[str]:
    """What these texts' words are looked up by, without those that are known."""
    return list(dict.fromkeys(item for text in texts for item in _stretches(text) if item not in known))


def _stretches(text: str) -> List[str]:
    """The stretches of a text. Marks and joiners belong to the letter before them: without them Hindi falls apart."""
    plain = "".join("x" if _is_mark(character) else character for character in text)
    return [text[found.start() : found.end()] for found in _STRETCH.finditer(plain)]


def _is_mark(character: str) -> bool:
    return character > "\x7f" and (unicodedata.category(character)[0] == "M" or character in "\u200c\u200d")


def _spoken(words: Sequence[str], how: Pronunciation) -> List[str]:
    """The phonemes of words one after the other."""
    if how.language != ENGLISH:
        return [phoneme for found in pronounced(words, how.language) for phoneme in found or ()]
    return [phoneme for word in words for phoneme in read(word).phonemes]


def _written_out(digits: str, language: str) -> str:
    """A number in words; four digits from 1100 to 2099 are a year."""
    with needs("numbers in words", "numbers"):
        from num2words import num2words

    plain = digits.replace(",", "")
    is_year = digits == plain and re.fullmatch(r"1[1-9]\d\d|20\d\d", plain)
    try:
        value = float(plain) if "." in plain else int(plain)
        text = str(num2words(value, lang=language, to="year" if is_year else "cardinal"))
    except (NotImplementedError, OverflowError, ValueError):
        raise LabialError(f"num2words cannot write {digits!r:.40} in the language {language!r:.40}") from None
    return re.sub(r"\band\b", " ", text) if language == ENGLISH else text
