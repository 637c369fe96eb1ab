"""Text files line by line, as the readers of motion take them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Iterator, List, Sequence, Tuple, Union

from labial.errors import DataError

PathLike = Union[str, os.PathLike]


def read_lines(path: PathLike) -> List[str]:
    """The lines of a UTF-8 text file, with or without a mark at its beginning. Raises DataError."""
    try:
        return Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeError) as error:
        raise DataError(path, None, f"cannot be read: {getattr(error, 'strerror', None) or error}") from None


def table_rows(path: PathLike, lines: Sequence[str], columns: int) -> Iterator[Tuple[int, List[str]]]:
    """Line number and comma-separated fields of every line after the header; `path` is for the error message.

    Empty lines may only end the file. Raises DataError for others, and for a line of more or fewer `columns`.
    """
    for line, text in enumerate(lines[1:], 2):
        if not text.strip():
            if any(rest.strip() for rest in lines[line:]):
                raise DataError(path, line, "empty line")
            return
        fields = text.split(",")
        if len(fields) != columns:
            raise DataError(path, line, f"{len(fields)} columns, not {columns}")
        yield line, fields
