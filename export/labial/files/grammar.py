"""The grammar of the text files that Labial reads: characters, lines, fields and numbers.

Text is UTF-8, or UTF-16 with a byte order mark, without control characters except tab, CR and LF. A line ends with LF.
Only blanks, tabs and CRs separate fields. A number is::

    [-] (digits [. [digits]] | . digits) [(e | E) [+ | -] digits]

of the ASCII digits, as in the library's parser of timings (include/labial/timings.h). Numbers on a command line have
the same grammar: :func:`whole`, :func:`finite`, `positive` and `seed` are types for :mod:`argparse`.
"""

from __future__ import annotations

import argparse
import codecs
import functools
import math
import os
import re
from typing import Iterator, List, Optional, Sequence, Tuple

from labial.errors import DataError, PathLike
from labial.files import limits

#: Bytes that are read at once.
_PART = 1_000_000
#: Digits that a whole number has at most: times of a file are far from that.
_MOST_DIGITS = 18

_BLANKS = " \t\r"
_FIELD = re.compile(r"[^ \t\r\n]+")
_NUMBER = re.compile(r"-?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WHOLE = re.compile(rf"0*[0-9]{{1,{_MOST_DIGITS}}}")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")


class Content(os.PathLike[str]):
    """Bytes that stand in for those of a file wherever one is read. Errors call the file `name`."""

    def __init__(self, data: bytes, name: str) -> None:
        self.data, self._name = data, name

    def __fspath__(self) -> str:
        return self._name


def read_bytes(path: PathLike, most: int = limits.TEXT) -> bytes:
    """A file's bytes. Raises DataError where it cannot be read or has more than `most`."""
    if isinstance(path, Content):
        return path.data
    try:
        with open(path, "rb") as file:
            limits.refuse(path, "it has", os.fstat(file.fileno()).st_size, most)
            data = bytearray()
            while len(data) <= most and (part := file.read(_PART)):  # devices and pipes do not tell their size
                data += part
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    if len(data) > most:
        raise DataError(path, None, f"it has more than the {most:,} bytes that are read")
    return bytes(data)


def read_text(path: PathLike) -> str:
    """A file's text without its byte order mark. Raises DataError, which names the line of an invalid character."""
    data = read_bytes(path)
    encoding = "utf-16" if data[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else "utf-8-sig"
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        line = 1 + data.count(b"\n", 0, error.start) if encoding != "utf-16" else None
        raise DataError(path, line, f"not {'UTF-8' if line else 'UTF-16'} text") from None
    strange = _CONTROL.search(text)
    if strange:
        raise DataError(path, 1 + text.count("\n", 0, strange.start()), f"byte 0x{ord(strange[0]):02x} is not text")
    return text


def lines_of(text: str) -> List[str]:
    """The lines of a text; text after the last LF is a line, too."""
    lines = text.split("\n")
    return lines if lines[-1] else lines[:-1]


def read_lines(path: PathLike) -> List[str]:
    """The lines of a text file. Raises DataError."""
    return lines_of(read_text(path))


def fields_of(line: str) -> List[str]:
    """The fields of a line."""
    return _FIELD.findall(line)


def is_blank(line: str) -> bool:
    """Whether a line has no field."""
    return not line.strip(_BLANKS)


def columns_of(line: str) -> List[str]:
    """The comma-separated fields of a line, without the blanks around them."""
    return [field.strip(_BLANKS) for field in line.split(",")]


def table_rows(path: PathLike, lines: Sequence[str], columns: int) -> Iterator[Tuple[int, List[str]]]:
    """Line number and comma-separated fields of every line after the header; `path` is for the error message. Empty
    lines may only end the file. Raises DataError for others, and for a line of more or fewer `columns`."""
    for line, text in enumerate(lines[1:], 2):
        if is_blank(text):
            if not all(map(is_blank, lines[line:])):
                raise DataError(path, line, "empty line")
            return
        fields = columns_of(text)
        if len(fields) != columns:
            raise DataError(path, line, f"{len(fields)} columns, not {columns}")
        yield line, fields


def is_number(text: str) -> bool:
    """Whether `text` is a number of any value."""
    return _NUMBER.fullmatch(text) is not None


def is_whole(text: str) -> bool:
    """Whether `text` is an integer without a sign, of at most 18 digits after leading zeros."""
    return _WHOLE.fullmatch(text) is not None


def number(path: PathLike, line: Optional[int], text: str, what: str = "value") -> float:
    """`text` as a finite float. Raises DataError, which calls it `what`."""
    value = float(text) if is_number(text) else math.nan
    if not math.isfinite(value):
        raise DataError(path, line, f"{what} {shown(text)} is not a finite number")
    return value


def number_or_nan(path: PathLike, line: Optional[int], text: str) -> float:
    """Like :func:`number`, but NaN for ``nan`` in any case and for an empty field: a missing measurement."""
    return math.nan if not text or text.lower() == "nan" else number(path, line, text)


def shown(text: str) -> str:
    """`text` in quotes for a message: in one line, shortened if long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")


def whole(low: int, high: int, text: str) -> int:
    """`text` as a whole number within `low` .. `high`; with both given, a type of :mod:`argparse`."""
    value = int(text) if is_whole(text) else -1
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number within {low} .. {high}")
    return value


def finite(text: str) -> float:
    """`text` as a finite number: a type of :mod:`argparse`."""
    if not is_number(text) or math.isinf(float(text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return float(text)


#: On a command line: counts, up to any useful number; seeds, as NumPy and scikit-learn accept them.
positive = functools.partial(whole, 1, 1_000_000)
seed = functools.partial(whole, 0, 2**32 - 1)
