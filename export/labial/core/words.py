"""Words to phonemes, and their times to theirs, by the library (include/labial/words.h)."""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from labial.core.library import OK, checked, library, memory, texts
from labial.errors import LabialError

#: LABIAL_WORDS_PHONEMES and LABIAL_WORDS_CHARACTERS: what the library makes of a word and reads of it at most.
PHONEMES_MAX, CHARACTERS_MAX = 96, 255
#: LABIAL_WORDS_NO_END.
_NO_END = 0xFFFFFFFF
_OWN_MAX = 65_535
_KINDS = ("silent", "read", "unknown")


class Spoken(NamedTuple):
    """What a word sounds like."""

    kind: str  #: "silent", "read", or "unknown" for letters of scripts that are not read
    phonemes: Tuple[str, ...]  #: in ARPABET
    characters: Tuple[int, ...]  #: of the word, from 0, that each phoneme belongs to


@cache
def labels() -> Tuple[str, ...]:
    """The phonemes by number: SIL, then ARPABET. Raises LabialError without the library."""
    return texts(library().words_label)


class OwnWords:
    """Words of the caller's own: each a text and its phonemes in ARPABET. Raises LabialError for unknown phonemes,
    empty words, words with NUL or more than `PHONEMES_MAX` phonemes, and more than 65,535 words."""

    def __init__(self, words: Optional[Mapping[str, Sequence[str]]] = None) -> None:
        given = dict(words or {})
        if len(given) > _OWN_MAX:
            raise LabialError(f"{len(given)} words of one's own are more than {_OWN_MAX}")
        packed = b"".join(_packed(word, phonemes) for word, phonemes in given.items())
        self._packed = ctypes.create_string_buffer(packed, len(packed) + 1)  # both are read as long as this lives
        self._memory = memory(library().words_own_size(len(given)))
        self.place = library().words_own(self._memory, len(given), self._packed)


def _packed(word: str, phonemes: Sequence[str]) -> bytes:
    if not word or "\0" in word:
        raise LabialError(f"{word!r:.40} is no word")
    names = phonemes.split() if isinstance(phonemes, str) else list(phonemes)
    if len(names) > PHONEMES_MAX:
        raise LabialError(f"{word!r:.40} has {len(names)} phonemes, more than {PHONEMES_MAX}")
    missing = [name for name in names if name not in labels()]
    if missing:
        raise LabialError(f"{word!r:.40}: {missing[0]!r:.40} is no phoneme of ARPABET")
    return _encoded(word) + b"\0" + bytes([len(names), *map(labels().index, names)])


def _encoded(text: str) -> bytes:
    """UTF-8; what it cannot encode, half surrogates, is a question mark."""
    return text.encode("utf-8", "replace")


class Reader:
    """Reads the words of a text one after the other: what one means may depend on those before it."""

    def __init__(self, own: Optional[OwnWords] = None) -> None:
        self._own, self._context = own, memory(library().words_context_size())

    def read(self, text: str) -> Tuple[Spoken, int]:
        """What the next word sounds like, and how many phonemes the word before loses at its end: "dollars", where
        "million" follows "$5"."""
        data = _encoded(text)
        out = (ctypes.c_uint8 * (3 + 3 * PHONEMES_MAX))()
        own = self._own.place if self._own else None
        kind = checked(library().words_read(own, self._context, data, len(data), out))
        end = 3 + 3 * out[0]
        return Spoken(_KINDS[kind], tuple(labels()[of] for of in out[3:end:3]), tuple(out[4:end:3])), out[2]


def read_words(texts: Iterable[str], own: Optional[OwnWords] = None) -> List[Spoken]:
    """What words that follow each other sound like."""
    reader = Reader(own)
    found: List[Spoken] = []
    spoken = -1  # the last one with phonemes
    for text in texts:
        item, dropped = reader.read(text)
        if dropped and spoken >= 0:
            before = found[spoken]
            found[spoken] = Spoken(before.kind, before.phonemes[:-dropped], before.characters[:-dropped])
        if item.phonemes:
            spoken = len(found)
        found.append(item)
    return found


def read(text: str, own: Optional[OwnWords] = None) -> Spoken:
    """What a text sounds like on its own."""
    return Reader(own).read(text)[0]


class WordStream:
    """Words in time, in milliseconds, to phonemes; `offset` milliseconds are added to all times. Raises StreamError
    where the library refuses a call (labial_words_push() in include/labial/words.h)."""

    def __init__(self, own: Optional[OwnWords] = None, offset: int = 0) -> None:
        self._own, self._block = own, memory(library().words_size())
        checked(library().words_init(self._block, own.place if own else None, offset))

    def push(self, text: str, start: int, end: Optional[int]) -> None:
        """A word from `start` to `end`, None if that is unknown."""
        data = _encoded(text)
        checked(library().words_push(self._block, data, len(data), start, _NO_END if end is None else end), text)

    def push_characters(self, text: str, start: int, ends: Sequence[int]) -> None:
        """A word and the end of each of its characters."""
        data = _encoded(text)
        times = (ctypes.c_uint32 * max(1, len(ends)))(*ends)
        checked(library().words_push_characters(self._block, data, len(data), start, times, len(ends)), text)

    def end(self) -> None:
        """No more words will come."""
        checked(library().words_end(self._block))

    def take(self) -> List[Tuple[str, int]]:
        """The phonemes that are complete, with their milliseconds."""
        found: List[Tuple[str, int]] = []
        out = (ctypes.c_uint32 * 2)()
        while checked(library().words_next(self._block, out)) == OK:
            found.append((labels()[out[0]], int(out[1])))
        return found
