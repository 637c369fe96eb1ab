"""JSON documents as entries: objects whose fields are checked when they are read, with their place for messages."""

from __future__ import annotations

import json
import os
from dataclasses import fields as dataclass_fields
from dataclasses import is_dataclass
from functools import lru_cache
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple

from labial.errors import DataError, PathLike
from labial.files.grammar import is_blank, lines_of, read_text
from labial.files.limits import MESSAGE_FIELDS, MESSAGE_NESTING

#: Types that hold no fields.
_VALUES = (str, bytes, bytearray, memoryview, int, float, list, tuple, set, type(None))
#: What an object of a client library calls its fields as a dictionary.
_DUMPS = ("model_dump", "to_dict", "_asdict", "dict")
#: Fields of server-sent events.
_EVENT = ("event:", "id:", "retry:", ":")


class Entry:
    """One object of a file or message: `line` if a line is a document, else its `number` in the document, from 1."""

    __slots__ = ("_plain", "fields", "line", "number", "path")

    def __init__(self, path: PathLike, line: Optional[int], number: int, fields: Mapping[Any, Any]) -> None:
        self.path, self.line, self.number, self.fields = path, line, number, fields
        self._plain: Optional[Dict[str, Any]] = None

    def error(self, problem: str) -> DataError:
        """`problem`, with its place in the file."""
        return DataError(self.path, self.line, problem if self.line else f"entry {self.number}: {problem}")

    @property
    def plain(self) -> Dict[str, Any]:
        """The fields by their names in small letters without underscores; of two that are then alike, the first."""
        if self._plain is None:
            self._plain = {plain_name(key): value for key, value in reversed(list(self.fields.items()))}
        return self._plain

    def inner(self, value: Any, number: Optional[int] = None) -> Optional[Entry]:
        """An object within this one; None for what is no object."""
        fields = fields_of(value)
        return None if fields is None else Entry(self.path, self.line, number or self.number, fields)


@lru_cache(maxsize=4096)
def plain_name(key: Any) -> str:
    """A field's name in small letters without underscores."""
    return str(key).replace("_", "").lower()


def is_list(value: Any) -> bool:
    """Whether a value is a list, or a sequence of a client library."""
    return isinstance(value, (list, tuple)) or (isinstance(value, Sequence) and not isinstance(value, _VALUES))


def fields_of(value: Any) -> Optional[Mapping[Any, Any]]:
    """The fields of a dictionary or of an object of a client library: what it dumps, or its public attributes, of which
    at most `MESSAGE_FIELDS` are read. None for texts, numbers, lists and None."""
    if isinstance(value, Mapping):
        return value
    if isinstance(value, type) or (isinstance(value, (*_VALUES, Sequence)) and not hasattr(value, "_asdict")):
        return None
    if is_dataclass(value):
        names = [field.name for field in dataclass_fields(value)]
        names += [name for name, item in vars(type(value)).items() if isinstance(item, property) and name[0] != "_"]
        return _attributes(value, names)
    for name in _DUMPS:
        dump = getattr(value, name, None)
        if callable(dump):
            found = dump()
            return found if isinstance(found, Mapping) else None
    return _attributes(value, [name for name in dir(value) if not name.startswith("_")][:MESSAGE_FIELDS]) or None


def _attributes(value: Any, names: Sequence[str]) -> Dict[str, Any]:
    """Attributes of an object that have values and are no functions."""
    found = {}
    for name in names:
        try:
            item = getattr(value, name)
        except Exception:  # noqa: BLE001 - a property of a library that has no value yet
            continue
        if not callable(item):
            found[name] = item
    return found


class Parsed(os.PathLike[str]):
    """Parsed JSON, or objects of a client library, that stand in for those of a file. Errors call the file `name`."""

    def __init__(self, items: Sequence[Any], name: str) -> None:
        self.items, self._name = items, name

    def __fspath__(self) -> str:
        return self._name


def read_entries(path: PathLike) -> List[Entry]:
    """The objects of a file: those of a list, a single one, or one per line. Lines may be server-sent events."""
    if isinstance(path, Parsed):
        return [_entry_of(path, None, number, item) for number, item in enumerate(path.items, 1)]
    return [_entry_of(path, *document) for document in documents(path, read_text(path))]


def documents(path: PathLike, text: str, most: Optional[int] = None,
              odd: Optional[Callable[[DataError], None]] = None) -> List[Tuple[Optional[int], int, Any]]:
    """The documents of a text, each with its line, if it has one of its own, and its number. Raises DataError where the
    text is neither JSON nor lines of JSON, and for more than `most` lines; `odd` is called for single lines that are no
    JSON, if it is given, and a text may then have no documents, as that of an event that only ends a stream."""
    try:
        document = loads(path, None, text)
        items = document if isinstance(document, list) else [document]
        return [(None, number, item) for number, item in enumerate(items, 1)]
    except json.JSONDecodeError as error:
        lines = [(number, _content(line)) for number, line in enumerate(lines_of(text), 1)]
        lines = [(number, line) for number, line in lines if not is_blank(line)]
        if odd is not None and not lines:
            return []  # an event without a document
        # Two lines at least, or one of an event; the first shows whether lines are documents.
        is_event = len(lines) == 1 and lines[0][1] != text.strip()
        if not (len(lines) > 1 or is_event) or not _is_document(lines[0][1]):
            raise DataError(path, error.lineno, f"not JSON: {error.msg}") from None
    if most is not None and len(lines) > most:
        raise DataError(path, None, f"{len(lines)} lines, more than the {most} that are read")
    found: List[Tuple[Optional[int], int, Any]] = []
    for number, line in lines:
        try:
            found.append((number, number, loads(path, number, line)))
        except (json.JSONDecodeError, DataError) as error:
            problem = error if isinstance(error, DataError) else DataError(path, number, f"not JSON: {error.msg}")
            if odd is None:
                raise problem from None
            odd(problem)
    return found


def loads(path: PathLike, line: Optional[int], text: str) -> Any:
    """JSON; raises JSONDecodeError, and DataError beyond `MESSAGE_NESTING` levels or for endless digits."""
    try:
        found = json.loads(text)
        if not _nests_deeper(found, MESSAGE_NESTING):
            return found
    except json.JSONDecodeError:
        raise
    except (RecursionError, ValueError):
        pass
    raise DataError(path, line, "JSON that is nested too deeply or has a number of too many digits")


def _nests_deeper(value: Any, most: int) -> bool:
    level = [value]
    for _ in range(most + 1):
        level = [item for one in level if isinstance(one, (dict, list))
                 for item in (one.values() if isinstance(one, dict) else one)]
    return bool(level)


def _content(line: str) -> str:
    """The document of a line: what follows ``data:`` in a server-sent event, "" in its other fields."""
    text = line.lstrip(" \t\ufeff")
    if text.startswith("data:"):
        return "" if text[5:].strip() == "[DONE]" else text[5:]
    return "" if text.startswith(_EVENT) else line


def _is_document(line: str) -> bool:
    try:
        return isinstance(json.loads(line), dict)
    except (RecursionError, ValueError):
        return False


def _entry_of(path: PathLike, line: Optional[int], number: int, item: Any) -> Entry:
    document = Entry(path, line, number, {})
    entry = document.inner(item)
    if entry is None:
        raise document.error(f"{shown(item)} is not an object")
    return entry


def shown(value: Any) -> str:
    """A value for a message, at most 40 characters of it."""
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    if isinstance(value, int) and value.bit_length() > 128:
        return "a number of many digits"
    text = value if isinstance(value, str) else json.dumps(value, default=lambda other: type(other).__name__)
    return text if len(text) <= 40 else text[:37] + "..."
