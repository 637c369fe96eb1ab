"""The reference of ``lib/words_characters.c``: the characters of a text as the rules see them.

Each becomes a string of simple characters: ASCII, `FOREIGN` for a letter of another script, `NOTHING` for what is not
said, or one of the signs below; ligatures and fractions become several, and marks none. A letter whose accent tells how
it sounds has that sound as well.
"""

from __future__ import annotations

import re
from typing import Dict, List, NamedTuple, Optional, Tuple

FOREIGN, NOTHING, BLANK = "\1", "\2", " "
EURO, POUND, YEN, RUPEE, CENT, DEGREE, SQUARE, TIMES, MINUS, DIVIDED, CUBE = (chr(code) for code in range(3, 14))
MOST, LEAST, ABOUT, EITHER = (chr(code) for code in range(14, 18))

_SIGNS = {"€": EURO, "£": POUND, "¥": YEN, "₹": RUPEE, "¢": CENT, "°": DEGREE, "²": SQUARE, "³": CUBE, "×": TIMES,
          "−": MINUS, "÷": DIVIDED, "≤": MOST, "≥": LEAST, "≈": ABOUT, "±": EITHER,
          "’": "'", "‘": "'", "ʼ": "'", "`": "'", "′": "'", "″": '"', "µ": "u", "μ": "u",
          "\u2010": "-", "\u2011": "-", "\u2012": "-", "–": "-", "\u2044": "/",
          # Punctuation of Greek, Armenian, Hebrew, Arabic, Urdu, the scripts of India, Burmese, Ethiopic and Khmer.
          **dict(zip("\u037e\u0589\u05be\u05c3\u060c\u061b\u061f\u06d4\u0964\u0965\u104a\u104b\u1362\u1363\u17d4\u17d5",
                     "?.-.,;?...,..,..")),
          **dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789"))}
_BLANKS = ((9, 13), (0x20, 0x20), (0x85, 0x85), (0xA0, 0xA0), (0x2000, 0x200A), (0x2028, 0x2029), (0x202F, 0x202F),
           (0x205F, 0x205F), (0x3000, 0x3000))
_FOREIGN = ((0x180, 0x2FF), (0x370, 0x1FFF), (0x2C00, 0x2DFF), (0x3041, 0xD7FF), (0xF900, 0xFAFF), (0x20000, 0x3FFFF))
_MARKS = ((0x300, 0x36F), (0xAD, 0xAD), (0x200B, 0x200D), (0xFE00, 0xFE0F), (0xFEFF, 0xFEFF))
#: Letters of U+00C0 to U+017F without their accents; a blank stands for a sign.
_PLAIN = ("AAAAAAACEEEEIIIIDNOOOOO OUUUUYTsaaaaaaaceeeeiiiidnooooo ouuuuyty"
          "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLlNnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTtUuUuUu"
          "UuUuUuWwYyYZzZzZzs")
_SIGNS.update({
    "Æ": "AE", "æ": "ae", "Œ": "OE", "œ": "oe", "ﬀ": "ff", "ﬁ": "fi", "ﬂ": "fl", "ﬃ": "ffi", "ﬄ": "ffl", "ﬅ": "st",
    "ﬆ": "st", "℃": DEGREE + "C", "℉": DEGREE + "F",
    # Fractions have blanks around them.
    **{sign: f" {number[0]}/{number[1]} " for sign, number in zip(
        "¼½¾⅓⅔⅕⅖⅗⅘⅙⅚⅛⅜⅝⅞", "14 12 34 13 23 15 25 35 45 16 56 18 38 58 78".split())}})
#: What HTML and SSML write for a character.
_ENTITY = re.compile("&(amp|lt|gt|quot|apos|rsquo|nbsp|mdash|ldquo|rdquo|hellip|#39);")
_ENTITIES = {"amp": "&", "quot": '"', "apos": "'", "rsquo": "'", "#39": "'", "nbsp": BLANK}
#: The accents that tell a sound, as combining marks: grave, acute, circumflex, tilde, diaeresis, cedilla; and those of
#: U+00C0 to U+00DF, as of the small letters 32 behind.
_ACCENTS = dict(zip("\u0300\u0301\u0302\u0303\u0308\u0327", "`'^~:,"))
_ACCENTED = "`'^~:  ,`'^:`'^: ~`'^~:  `'^:'  "
#: What accented letters sound like; ë like EH, and at the end of a word like IY.
_SOUNDS: Dict[str, str] = {"a`": "AA", "a'": "AA", "a^": "AA", "c,": "S", "e`": "EH", "e'": "EY", "e^": "EH",
                           "e:": "EH IY", "i'": "IY", "i^": "IY", "i:": "IY", "o'": "OW", "o^": "OW",
                           "u'": "UW", "u^": "UW"}


class Simple(NamedTuple):
    """A simple character."""

    plain: str
    place: int  #: of its character in the text
    sound: Optional[Tuple[str, ...]]  #: phonemes that a letter has by its accent


def simple_characters(text: str) -> List[Simple]:
    """The simple characters of a text."""
    found: List[Simple] = []
    place = 0
    while place < len(text):
        entity = _ENTITY.match(text, place)
        simple = _ENTITIES.get(entity[1], NOTHING) if entity else simplified(text[place])
        code = ord(text[place])
        accent = _ACCENTED[code - 0xC0 & 31].strip() if 0xC0 <= code < 0x100 else ""
        accent = accent or _ACCENTS.get(text[place + 1 : place + 2], " ")
        for plain in simple:
            sound = _SOUNDS.get(plain.lower() + accent) if simple[0].isalpha() else None
            found.append(Simple(plain, place, tuple(sound.split()) if sound else None))
        place = entity.end() if entity else place + 1
    return found


def simplified(character: str) -> str:
    """One simple character, none for a mark, or those of a ligature or a fraction."""
    code = ord(character)
    if any(low <= code <= high for low, high in _MARKS):
        return ""
    if any(low <= code <= high for low, high in _BLANKS):
        return BLANK
    if 0xFF01 <= code <= 0xFF5E:
        return simplified(chr(code - 0xFEE0))
    if character in _SIGNS:
        return _SIGNS[character]
    if code < 0x80:
        return character if 0x20 < code < 0x7F else NOTHING
    if 0xC0 <= code < 0x180:
        return _PLAIN[code - 0xC0].replace(" ", NOTHING)
    return FOREIGN if any(low <= code <= high for low, high in _FOREIGN) else NOTHING


def is_inside(character: str) -> bool:
    """Whether a simple character is a letter or a digit."""
    return character == FOREIGN or (character.isascii() and character.isalnum())
