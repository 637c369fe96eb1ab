"""Phoneme timings in formats of lines and TextGrids, parsed by the library (include/labial/timings.h)."""

from __future__ import annotations

import ctypes
import re
from functools import cache
from typing import Any, Iterator, NamedTuple, Optional, Tuple

from labial.core.library import LAUGH_FULL, OK, STARVED, WAITING, Library, library, memory, texts
from labial.errors import LabialError

#: A laugh between phonemes, with its intensity.
LAUGH = re.compile(r"<laugh(?:[: ]\s*([^\s>]+))?>")


class Timing(NamedTuple):
    """A phoneme, a silence or a laugh; times are in seconds."""

    start: float
    end: float
    apex: Optional[float]
    label: str  #: as written, empty for silence; ``<laugh:INTENSITY>`` for a laugh between phonemes
    word: Optional[str]
    line: int
    xsampa: bool  #: whether labels are X-SAMPA by the format


class Malformed(Exception):
    """Text that is no timings; `line` is the one that is wrong."""

    def __init__(self, message: str, line: int) -> None:
        super().__init__(message)
        self.line = line


@cache
def names() -> Tuple[str, ...]:
    """The formats, of which the first one, auto, looks at the first line. Raises LabialError without the library."""
    return texts(library().timings_name)


def suffix(name: str) -> str:
    """How the names of files of a format end, in small letters; empty where that does not tell it."""
    return library().timings_suffix(names().index(name)).decode("ascii")


def timings(text: bytes, form: str = "auto", tier: Optional[str] = None, number: int = 0) -> Iterator[Timing]:
    """The timings of a text in UTF-8; of a TextGrid those of the interval tier called `tier` or, from 1 on, of this
    `number`, without them of the tier of phones. Raises Malformed, and LabialError for a format that is none."""
    if form not in names():
        raise LabialError(f"no format of timings is called {form!r}; there are {', '.join(names()[1:])}")
    core = library()
    block = memory(core.timings_size())
    held = None if tier is None else tier.encode("utf-8")  # as long as the parser
    core.timings_init(block, names().index(form), held, number)
    times, numbers = (ctypes.c_double * 3)(), (ctypes.c_int32 * 4)()
    data = ctypes.create_string_buffer(text, max(len(text), 1))
    result = STARVED
    while result == STARVED:  # the text is wanted, perhaps once more
        at, left = ctypes.addressof(data), len(text)
        result = OK
        while result in (OK, WAITING) and left:
            result = core.timings_next(block, at, left, times, numbers)
            at, left = at + numbers[0], left - numbers[0]
            if result == OK:
                yield _timing(core, block, times, numbers)
        while result in (OK, WAITING):
            result = core.timings_end(block, times, numbers)
            if result == OK:
                yield _timing(core, block, times, numbers)
    if result < 0:
        raise Malformed(core.timings_message(block).decode("utf-8", "replace"), core.timings_line(block))


def _timing(core: Library, block: Any, times: Any, numbers: Any) -> Timing:
    label, word = core.timings_label(block), core.timings_word(block)
    if label is None:
        label = b"" if numbers[2] < 0 else b"<laugh:%.3g>" % (numbers[2] / LAUGH_FULL)
    return Timing(times[0], times[1], None if times[2] < 0 else times[2], label.decode("utf-8"),
                  None if word is None else word.decode("utf-8"), numbers[1], bool(numbers[3]))
