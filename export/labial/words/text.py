"""The reference of ``lib/words_text.c``: what is said where a text stands. ``include/labial/words.h`` has the rules.

The text becomes a string of simple characters - ASCII, `FOREIGN` for a letter of another script, `NOTHING` for what is
not said - with the place of each in the text; patterns then find words, numbers and signs in it.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Callable, List, NamedTuple, Sequence, Tuple

from labial.words import decoder
from labial.words.dictionary import LONGEST
from labial.words.tables import WordTables

#: Characters that are read, and phonemes that they become at most (LABIAL_WORDS_CHARACTERS, LABIAL_WORDS_PHONEMES).
CHARACTERS, PHONEMES = 255, 96

FOREIGN, NOTHING = "\1", "\2"
_FOREIGN = ((0x180, 0x2FF), (0x370, 0x1FFF), (0x2C00, 0x2DFF), (0x3041, 0xD7FF), (0xF900, 0xFAFF), (0x20000, 0x3FFFF))
_MARKS = ((0x300, 0x36F), (0xAD, 0xAD), (0x200B, 0x200D), (0xFE00, 0xFE0F), (0xFEFF, 0xFEFF))
#: Latin letters that do not come apart into a letter and a mark.
_LETTERS = {"Æ": "E", "Ð": "D", "Ø": "O", "Þ": "T", "ß": "s", "æ": "e", "ð": "d", "ø": "o", "þ": "t", "Đ": "D",
            "đ": "d", "Ħ": "H", "ħ": "h", "ı": "i", "Ĳ": "I", "ĳ": "i", "ĸ": "k", "Ŀ": "L", "ŀ": "l", "Ł": "L",
            "ł": "l", "ŉ": "n", "Ŋ": "N", "ŋ": "n", "Œ": "E", "œ": "e", "Ŧ": "T", "ŧ": "t", "ſ": "s"}  # fmt: skip

_UNITS = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen "
          "seventeen eighteen nineteen").split()
_TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
_ORDINALS = {"one": "first", "two": "second", "three": "third", "five": "fifth", "eight": "eighth", "nine": "ninth",
             "twelve": "twelfth"}
_NAMES = dict(zip("abcdefghijklmnopqrstuvwxyz", "ay bee see dee e eff gee aitch eye jay kay ell em en oh pee cue are "
                  "ess tee you vee double_you ex why zee".split()))
_SIGNS = {"&": "and", "@": "at", "%": "percent", "+": "plus", "=": "equals"}
_MEANINGS = {"mr": "mister", "mrs": "missiz", "ms": "mizz", "dr": "doctor", "st": "saint", "prof": "professor",
             "jr": "junior", "sr": "senior", "vs": "versus", "etc": "etcetera"}
_INITIALS = "AI API ATM CEO CPU DIY EU EV GPU ID IOS IP IQ LED OK PA UFO UI UK UN URL USA USB UX".split()

_TOKEN = re.compile(
    r"""(?P<tag>\[[^\]]*\]?|<[^>]*>?)
    |(?P<number>[0-9]+(?:,[0-9]{3}(?![0-9]))*)(?P<ordinal>(?:st|nd|rd|th)(?![a-z0-9\1]))?
    |(?P<letters>[a-z](?:[a-z]|'(?=[a-z]))*)
    |(?P<sign>[&@%+=])|(?P<other>.)""", re.IGNORECASE | re.VERBOSE | re.DOTALL)  # fmt: skip
_POINTED = re.compile(r"[a-z](?:\.[a-z](?![a-z0-9\1]))+", re.IGNORECASE)
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")


class Reading(NamedTuple):
    """What a text sounds like."""

    kind: str  #: "silent", "read" or "unknown"
    phonemes: Tuple[Tuple[int, int, bool], ...]  #: phoneme, place of its character, whether a spoken word begins
    characters: int  #: of the text, `CHARACTERS` at most


def read(tables: WordTables, text: str) -> Reading:
    """Reads a text that has no blank, or stretches between which blanks do not matter."""
    kept = [(plain, place) for place, character in enumerate(text[:CHARACTERS])
            for plain in [simplified(character)] if plain]
    said = _Said(tables, [place for _, place in kept])
    simple = "".join(plain for plain, _ in kept)
    place = 0
    while place < len(simple):
        place = _read_token(simple, place, said)
    kind = "read" if said.phonemes else "unknown" if said.foreign else "silent"
    return Reading(kind, tuple(said.phonemes[:PHONEMES]), min(len(text), CHARACTERS))


def simplified(character: str) -> str:
    """One simple character, or none for a mark."""
    code = ord(character)
    if any(low <= code <= high for low, high in _MARKS):
        return ""
    if 0xFF01 <= code <= 0xFF5E:
        return chr(code - 0xFEE0)
    if code < 0x80:
        return character if 0x20 < code < 0x7F else NOTHING
    if character in "\u2019\u02bc":
        return "'"
    if 0xC0 <= code < 0x180:
        plain = _LETTERS.get(character, unicodedata.normalize("NFD", character)[0])
        return plain if plain.isascii() else NOTHING
    return FOREIGN if any(low <= code <= high for low, high in _FOREIGN) else NOTHING


class _Said:
    """Phonemes as they are added."""

    def __init__(self, tables: WordTables, places: Sequence[int]) -> None:
        self.tables, self.places = tables, places
        self.phonemes: List[Tuple[int, int, bool]] = []
        self.foreign = False  #: there was a letter of another script

    def spell(self, word: str, place_of: Callable[[int], int]) -> None:
        """Adds a spoken word, whose letter i belongs to the simple character ``place_of(i)``."""
        first = True
        for phoneme, letter in decoder.read(self.tables, word):
            self.phonemes.append((phoneme, self.places[place_of(letter)], first))
            first = False

    def say(self, words: str, place: int) -> None:
        """Adds words, which are separated by blanks, at one simple character."""
        for word in words.replace("_", " ").split():
            self.spell(word, lambda _: place)


def _read_token(simple: str, place: int, said: _Said) -> int:
    """Reads what begins at a place; returns the place behind it."""
    pointed = _POINTED.match(simple, place)
    if pointed:
        return _read_pointed(pointed[0], place, said)
    token = _TOKEN.match(simple, place)
    assert token is not None  # "other" takes any character
    if token["number"]:
        return _read_number(simple, place, token, said)
    if token["letters"]:
        run = _CAMEL.split(token["letters"])[0][:LONGEST]
        while run.endswith("'"):
            run = run[:-1]
        _read_letters(run, place, said)
        return place + len(run)
    if token["sign"]:
        said.say(_SIGNS[token["sign"]], place)
    said.foreign |= token["other"] == FOREIGN
    return token.end()


def _read_pointed(text: str, place: int, said: _Said) -> int:
    meaning = {"e.g": "for example", "i.e": "that is"}.get(text[:3].lower())
    if meaning:
        said.say(meaning, place)
        return place + 3
    for offset in range(0, len(text), 2):
        said.say(_NAMES[text[offset].lower()], place + offset)
    return place + len(text)


def _read_letters(run: str, place: int, said: _Said) -> None:
    small = run.lower()
    is_short = run.isalpha() and run.isupper() and 2 <= len(run) <= 5
    if small in _MEANINGS:
        said.say(_MEANINGS[small], place)
    elif (is_short and (run in _INITIALS or not re.search("[AEIOUY]", run))) or (len(run) == 1 and small not in "ai"):
        for offset, letter in enumerate(small):
            said.say(_NAMES[letter], place + offset)
    else:
        said.spell(small, lambda letter: place + letter)


def _read_number(simple: str, place: int, token: re.Match[str], said: _Said) -> int:
    digits = token["number"].replace(",", "")
    end = token.end("number")
    if len(digits) > 9 or (len(digits) > 1 and digits[0] == "0"):
        found = re.compile(r"[0-9](?:,?[0-9])*").match(simple, place)
        assert found is not None
        for offset, digit in enumerate(found[0]):
            if digit != ",":
                said.say(_UNITS[int(digit)], place + offset)
        end = found.end()
    else:
        words = _cardinal(int(digits))
        if token["ordinal"]:
            words[-1] = _ordinal(words[-1])
            end = token.end()
        said.say(" ".join(words), place)
    fraction = re.compile(r"\.([0-9]+)").match(simple, end)
    if not fraction:
        return end
    said.say("point", end)
    for offset, digit in enumerate(fraction[1], 1):
        said.say(_UNITS[int(digit)], end + offset)
    return fraction.end()


def _cardinal(value: int) -> List[str]:
    """The words of 0 to 999,999,999."""
    words: List[str] = []
    for scale, name in ((1_000_000, "million"), (1000, "thousand"), (1, "")):
        part = value // scale % 1000
        words += _below_thousand(part) + [name] * bool(part and name)
    return words or ["zero"]


def _below_thousand(value: int) -> List[str]:
    words = [_UNITS[value // 100], "hundred"] if value >= 100 else []
    rest = value % 100
    if rest >= 20:
        words.append(_TENS[rest // 10 - 2])
        rest %= 10
    return words + [_UNITS[rest]] * bool(rest)


def _ordinal(word: str) -> str:
    if word in _ORDINALS:
        return _ORDINALS[word]
    return word[:-1] + "ieth" if word.endswith("y") else word + "th"
