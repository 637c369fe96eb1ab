"""Words and characters with their times to phonemes with theirs: English by the library's tables, other languages by
espeak-ng where it is installed.

Times are whole milliseconds from the beginning of the sound. A word that the caller pronounces otherwise comes before
everything else; then numbers, if they are to be written out by num2words; then the language.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from typing import Container, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from labial.core.words import CHARACTERS_MAX, PHONEMES_MAX, OwnWords, Spoken, WordStream, read, read_words
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError, apt, missing, needs

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
        missing = [item for item in stretches if item not in known]
        known.update(zip(missing, _by_espeak(missing, how.language)))
    return {word: known[word] if word in how.own else known[word][:PHONEMES_MAX] for word in known}


def stretches_of(texts: Iterable[str], known: Container[str]) -> List[str]:
    """What these texts' words are looked up by, without those that are known."""
    return list(dict.fromkeys(item for text in texts for item in _STRETCH.findall(text) if item not in known))


def _spoken(words: Sequence[str], how: Pronunciation) -> List[str]:
    """The phonemes of words one after the other."""
    if how.language != ENGLISH:
        return [phoneme for found in _by_espeak(words, how.language) for phoneme in found]
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


def _by_espeak(words: Sequence[str], language: str) -> List[List[str]]:
    """The phonemes of words as espeak-ng says them, as those of ARPABET that look most like them."""
    if not words:
        return []
    program = shutil.which("espeak-ng")
    if program is None:
        raise missing(f"the language {language!r:.40}", "espeak-ng", apt("espeak-ng"))
    if not re.fullmatch(r"[a-z][\w+-]*(?:/[\w+-]+)*", language):
        raise LabialError(f"{language!r:.40} is no language of espeak-ng")
    lines = _ipa(program, words, language)
    if len(lines) != len(words):  # a word that is silent, or that makes two clauses
        lines = [" ".join(_ipa(program, [word], language)) for word in words]
    return [[_nearest(label) for label in re.split(r"[_\s]+", line) if label] for line in lines]


def _ipa(program: str, words: Sequence[str], language: str) -> List[str]:
    """A line of the IPA for each word."""
    done = subprocess.run([program, "-q", "-v", language, "--ipa", "--sep=_", "--stdin"],
                          input="\n\n".join(words).encode("utf-8", "replace"), capture_output=True)
    if done.returncode != 0:
        problem = " ".join(done.stderr.decode("utf-8", "replace").split())
        raise LabialError(f"espeak-ng cannot speak {language!r:.40}: {problem[:200]}")
    return [line for line in done.stdout.decode("utf-8", "replace").splitlines() if line.strip("_ ")]


def _nearest(label: str) -> str:
    return SPEECH.nearest(label, "ipa")
