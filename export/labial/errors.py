"""Errors that a user can cause and mend."""

from __future__ import annotations

import os
from typing import Optional, Union


class LabialError(Exception):
    """Something the user gave cannot be used; the message says what and where."""


class DataError(LabialError):
    """A file's content is wrong. The message begins with ``file:line:`` (or ``file:``)."""

    def __init__(self, path: Union[str, os.PathLike], line: Optional[int], message: str) -> None:
        where = f"{os.fspath(path)}:{line}" if line is not None else os.fspath(path)
        super().__init__(f"{where}: {message}")


class ModelError(LabialError):
    """A model is inconsistent, not finite, of another version or beyond the library's limits."""


class StreamError(LabialError):
    """The library refuses a call; the message holds its own sentence (``labial_result_text``)."""

    def __init__(self, result: int, message: str) -> None:
        super().__init__(message)
        self.result = result  #: LABIAL_ERROR_PHONEME and so on, a negative number (labial/labial.h)
