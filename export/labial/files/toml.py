"""Reads handwritten TOML files, with errors that name the file and the line or the key."""

from __future__ import annotations

import difflib
import math
import re
import sys
from typing import Any, Dict, Iterable, List, Mapping

from labial.errors import DataError, PathLike
from labial.files import limits
from labial.files.grammar import read_bytes

if sys.version_info >= (3, 11):
    import tomllib
else:  # pragma: no cover - the same parser before it became a part of Python
    import tomli as tomllib
#: Largest number in a file: products of several stay within a float's range.
LARGEST_NUMBER = 1e12
#: Most levels of tables and lists, and most dots in a line, outside of its texts and remarks.
_LEVELS, _DOTS = 10, 200
_TEXTS = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'|#[^\n]*')


class Table:
    """A table of a file: `content` by key. Only `known` keys are allowed; errors write `prefix` before a key."""

    def __init__(self, path: PathLike, prefix: str, content: Mapping[str, Any], known: Iterable[str]) -> None:
        self.path, self.prefix, self.content = path, prefix, content
        known = list(known)
        for key in content:
            if key not in known:
                raise self.error(key, f"unknown key{meant(key, known) or '; known are ' + ', '.join(known)}")

    def error(self, key: str, message: str) -> DataError:
        """An error that names the file and the key."""
        return DataError(self.path, None, f"{self.prefix}{key}: {message}")

    def refuse(self, wrong: bool, key: str, message: str) -> None:
        """Raises an error that names the file and the key where something is `wrong`."""
        if wrong:
            raise self.error(key, message)

    def number(self, key: str) -> float:
        """A finite number; the key is required."""
        if key not in self.content:
            raise self.error(key, "is missing")
        return self.as_number(key, self.content[key])

    def as_number(self, key: str, value: object) -> float:
        """`value` of `key` as a finite number."""
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.error(key, f"{value!r} is not a number")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.error(key, f"{number} is not a finite number")
        if abs(number) > LARGEST_NUMBER:
            raise self.error(key, f"{number:g} is not within -{LARGEST_NUMBER:g} .. {LARGEST_NUMBER:g}")
        return number

    def flag(self, key: str, default: bool) -> bool:
        """True or false; `default` without the key."""
        value = self.content.get(key, default)
        if not isinstance(value, bool):
            raise self.error(key, f"{value!r} is neither true nor false")
        return value


def meant(name: str, known: Iterable[str]) -> str:
    """``; did you mean NAME?`` with the member of `known` whose spelling is nearest to `name`, or nothing."""
    near = difflib.get_close_matches(name, list(known), n=1)
    return f"; did you mean {near[0]}?" if near else ""


def read_toml(path: PathLike) -> Dict[str, Any]:
    """The content of a TOML file. Raises DataError, which names the file and the line, for invalid TOML."""
    try:
        text = read_bytes(path, limits.TOML).decode("utf-8-sig")
        for number, content in enumerate(_TEXTS.sub("", text).split("\n"), 1):
            if content.count(".") > _DOTS:  # the parser's time grows with the square of a key's parts
                raise DataError(path, number, "not TOML: nested too deeply")
        content_of = tomllib.loads(text)
    except UnicodeDecodeError as error:
        raise DataError(path, None, f"not UTF-8 text: byte {error.start}") from None
    except ValueError as error:  # TOMLDecodeError, or a number of more digits than Python takes
        found = re.fullmatch(r"(.*?)(?: \(at line (\d+), column (\d+)\))?", str(error), re.DOTALL)
        line = int(found[2]) if found and found[2] else None
        column = f" (column {found[3]})" if found and found[3] else ""
        raise DataError(path, line, f"not TOML: {found[1] if found else error}{column}") from None
    except RecursionError:
        raise DataError(path, None, "not TOML: nested too deeply") from None
    level: List[Any] = [content_of]
    for _ in range(_LEVELS):
        level = [item for holder in level for item in (holder.values() if isinstance(holder, dict) else holder)
                 if isinstance(item, (dict, list))]
    if level:
        raise DataError(path, None, f"nested in more than {_LEVELS} levels")
    return content_of
