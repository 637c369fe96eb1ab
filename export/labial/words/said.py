"""What is said of a text while it is read, and what the words before mean for the next one.

`lib/words_text.c` and `lib/words_numbers.c` have the same in C.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

from labial.words.characters import BLANK, Simple
from labial.words.dictionary import PHONEMES
from labial.words.tables import WordTables, read

NAMES: Dict[str, str] = dict(zip("abcdefghijklmnopqrstuvwxyz", (
    "ay bee see dee e eff jee aitch eye jay kay ell em en oh pee cue are ess tee you vee double_you ex why zee"
).split()))
_PLURALS = {"h": "aitches", "s": "esses", "x": "exes"}


@dataclass
class Context:
    """What the words so far mean for the next one: all as at the beginning of a text."""

    #: Which was said last: "one", "number", "time", "sum", "unit", "per", "month", "with", "street", "drive", "avenue"
    #: or "lane"; "money", a sign of it before its sum; "call" or "phone", behind which a number is that of a telephone;
    #: "no" or "date", of which what follows may make the word `short`; "day"; "place", which is numbered.
    after: str = ""
    currency: int = 0  #: of a sum
    day: int = 0  #: the number that `tail` says, which a month makes an ordinal
    short: str = ""  #: what a number or a date makes of the word before
    mark: str = ""  #: of the unit before, behind which a smaller one may follow
    tail: int = 0  #: phonemes that the next word may take back: "dollars" before "million", "five" before "March"
    is_old: bool = False  #: these are of an earlier text
    dropped: int = 0  #: phonemes that the text now being read took from the one before
    named: bool = False  #: the last word may be the name of a street
    shouting: bool = False  #: the last word was in capitals, but not spelt
    closing: str = ""  #: of a tag or stage direction that the text is in
    left: int = 0  #: words that it may still have
    quoted: bool = False  #: a quotation has begun with the mark that otherwise means inches


class Said:
    """Phonemes as they are added, and the simple characters that they belong to."""

    def __init__(self, tables: WordTables, characters: Sequence[Simple], context: Context) -> None:
        self.tables, self.characters, self.context = tables, characters, context
        self.simple = "".join(item.plain for item in characters)
        self.phonemes: List[Tuple[int, int, bool]] = []
        self.letters = False  #: letters stand in this word, behind them a hyphen or a number at most
        self.foreign = False  #: there was a letter of another script

    def at(self, place: int) -> str:
        """The simple character of a place; blanks around the text."""
        return self.simple[place] if 0 <= place < len(self.simple) else BLANK

    def add(self, phoneme: int, place: int, first: bool) -> None:
        """Adds a phoneme, unless there is no room."""
        if len(self.phonemes) < 96:
            self.phonemes.append((phoneme, self.characters[place].place, first))

    def spell(self, word: str, place_of: Callable[[int], int],
              sounds: Sequence[Optional[Tuple[str, ...]]] = ()) -> None:
        """Adds a spoken word, whose letter i belongs to the simple character ``place_of(i)``."""
        for number, (phoneme, letter) in enumerate(read(self.tables, word, sounds)):
            self.add(phoneme, place_of(letter), number == 0)

    def say(self, words: str, place: int) -> None:
        """Adds words, which are separated by blanks, at one simple character."""
        for word in words.replace("_", " ").split():
            self.spell(word, lambda _: place)

    def say_names(self, letters: str, places: Sequence[int], plural: bool) -> None:
        """Adds the names of letters; with `plural` an s behind the last one."""
        for number, (letter, place) in enumerate(zip(letters, places), 1):
            is_last = plural and number == len(letters)
            self.say(_PLURALS.get(letter, NAMES[letter]) if is_last else NAMES[letter], place)
            if is_last and letter not in _PLURALS:
                self.add_s(place)

    def add_s(self, place: int) -> None:
        """Adds the sound of an s behind a name."""
        self.add(PHONEMES.index("Z"), place, False)

    def say_tail(self, words: str, place: int) -> None:
        """Adds words that the next one may take back."""
        before = len(self.phonemes)
        self.say(words, place)
        self.context.tail, self.context.is_old = len(self.phonemes) - before, False

    def take_back(self) -> None:
        """Removes what was said with :meth:`say_tail` last."""
        context = self.context
        if context.is_old:
            context.dropped = context.tail
        elif context.tail:
            del self.phonemes[-context.tail :]
        context.tail = 0

    def correct(self, place: int) -> None:
        """Says in full what was said in short."""
        self.take_back()
        self.say(self.context.short, place)


def inflected(entry: str, plural: bool) -> str:
    """A name in singular or plural: "foot|feet", or with _ where the s goes."""
    if "|" in entry:
        return entry.split("|")[plural]
    return entry.replace("_", "s" if plural else "")
