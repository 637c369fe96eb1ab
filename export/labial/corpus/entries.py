"""JSON documents as entries: objects whose fields are checked when they are read, with their place for messages."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any, Dict, List, Optional

from labial.corpus.timings import PathLike
from labial.errors import DataError
from labial.files.grammar import is_blank, lines_of, read_text


@dataclass(frozen=True)
class Entry:
    """One object of a file: `line` if a line is a document, else its `number` in the document, from 1."""

    path: PathLike
    line: Optional[int]
    number: int
    fields: Dict[str, Any]

    def error(self, problem: str) -> DataError:
        """`problem`, with its place in the file."""
        return DataError(self.path, self.line, problem if self.line else f"entry {self.number}: {problem}")

    def get(self, *names: str) -> Any:
        """The first existing field of `names`, ignoring case and underscores of the file's keys."""
        for key, value in self.fields.items():
            if _plain(key) in names:
                return value
        raise self.error(f"no field {names[0]!r}")

    def has(self, *names: str) -> bool:
        """Whether all of `names` exist."""
        return {_plain(key) for key in self.fields} >= set(names)

    def number_of(self, *names: str) -> float:
        """A field that must be a finite number, not below zero."""
        return self.as_number(self.get(*names), names[0])

    def as_number(self, value: Any, what: str) -> float:
        """`value` as a float, or an error."""
        try:
            number = float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else math.nan
        except OverflowError:
            number = math.inf
        if not 0.0 <= number < math.inf:
            raise self.error(f"{what!r} is {shown(value)}, not a number from 0 on")
        return number

    def text_of(self, *names: str) -> str:
        """A field that must be text."""
        value = self.get(*names)
        if not isinstance(value, str):
            raise self.error(f"{names[0]!r} is {shown(value)}, not text")
        return value

    def list_of(self, *names: str) -> List[Any]:
        """A field that must be a list."""
        value = self.get(*names)
        if not isinstance(value, list):
            raise self.error(f"{names[0]!r} is {shown(value)}, not a list")
        return value

    def parts(self, *names: str) -> List[Entry]:
        """A field that must be a list of objects, as entries."""
        return [entry_of(self.path, self.line, number, item) for number, item in enumerate(self.list_of(*names), 1)]


class Documents(os.PathLike[str]):
    """Parsed JSON that stands in for that of a file wherever one is read. Errors call the file `name`."""

    def __init__(self, items: List[Any], name: str) -> None:
        self.items, self._name = items, name

    def __fspath__(self) -> str:
        return self._name


def read_entries(path: PathLike) -> List[Entry]:
    """The objects of a file: those of a list, a single one, or one per line."""
    if isinstance(path, Documents):
        return [entry_of(path, None, number, item) for number, item in enumerate(path.items, 1)]
    text = read_text(path)
    try:
        document = _loads(path, text)
        items = document if isinstance(document, list) else [document]
        return [entry_of(path, None, number, item) for number, item in enumerate(items, 1)]
    except json.JSONDecodeError as error:
        lines = [(number, line) for number, line in enumerate(lines_of(text), 1) if not is_blank(line)]
        if len(lines) < 2 or not _is_document(lines[0][1]):
            raise DataError(path, error.lineno, f"not JSON: {error.msg}") from None
    entries = []
    for number, line in lines:
        try:
            entries.append(entry_of(path, number, number, _loads(path, line)))
        except json.JSONDecodeError as error:
            raise DataError(path, number, f"not JSON: {error.msg}") from None
    return entries


def entry_of(path: PathLike, line: Optional[int], number: int, item: Any) -> Entry:
    """`item` as an entry; raises DataError if it is not an object."""
    if not isinstance(item, dict):
        raise Entry(path, line, number, {}).error(f"{shown(item)} is not an object")
    return Entry(path, line, number, item)


def _loads(path: PathLike, text: str) -> Any:
    try:
        return json.loads(text)
    except (RecursionError, ValueError) as error:  # nested too deeply; a number of too many digits
        if isinstance(error, json.JSONDecodeError):
            raise
        raise DataError(path, None, "JSON that is nested too deeply or has a number of too many digits") from None


def _is_document(line: str) -> bool:
    try:
        return isinstance(json.loads(line), dict)
    except (RecursionError, ValueError):
        return False


def _plain(key: str) -> str:
    return key.replace("_", "").lower()


def shown(value: Any) -> str:
    """A value for a message, at most 40 characters of it."""
    text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= 40 else text[:37] + "..."
