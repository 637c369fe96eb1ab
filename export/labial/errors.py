"""Errors that a user can cause and correct."""

from __future__ import annotations

import os
from contextlib import contextmanager
from difflib import get_close_matches
from typing import Iterable, Iterator, List, Optional, Union

#: A file's path.
PathLike = Union[str, os.PathLike[str]]


class LabialError(Exception):
    """An input cannot be used; the message says what and where."""


class DataError(LabialError):
    """A file's content is wrong. The message begins with ``file:line:`` (or ``file:``)."""

    def __init__(self, path: PathLike, line: Optional[int], message: str) -> None:
        where = f"{os.fspath(path)}:{line}" if line is not None else os.fspath(path)
        super().__init__(f"{where}: {message}")


class SilentError(DataError):
    """A video has no sound."""


class ModelError(LabialError):
    """A model is inconsistent, not finite, of another version or beyond the library's limits."""


class StreamError(LabialError):
    """The library refuses a call; the message contains its description (``labial_result_text``)."""

    def __init__(self, result: int, message: str) -> None:
        super().__init__(message)
        self.result = result  #: LABIAL_ERROR_PHONEME and so on, a negative number (labial/labial.h)


def expect(condition: bool, message: str) -> None:
    """Raises ModelError with the message unless the condition holds."""
    if not condition:
        raise ModelError(message)


def did_you_mean(name: object, known: Iterable[str]) -> str:
    """The end of a message about an unknown name: the known one that looks most like it, or all of them."""
    names = list(known)
    given = str(name).lower()
    near: List[str] = []
    if len(given) <= 100:
        near = get_close_matches(given, names, 1, 0.7) or [item for item in names if sorted(item) == sorted(given)]
    return f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}"


def missing(what: str, thing: str, command: str) -> LabialError:
    """The error that `what`, such as "training", needs a package or a program, which `command` installs."""
    return LabialError(f"{what} needs {thing}: {command}")


def pip(extra: str = "") -> str:
    """The command that installs this package with an extra, from its folder: on an index others may bear its name."""
    target = f"'.[{extra}]'" if extra else "."
    return f"pip install {target} in Labial's folder (docs/install.md)"


def apt(package: str) -> str:
    """The command that installs a program on Debian, Ubuntu and Raspberry Pi OS."""
    return f"apt-get install {package}"


@contextmanager
def needs(what: str, extra: str) -> Iterator[None]:
    """Wraps imports of optional packages: a LabialError says that `what`, such as "training", needs one, and which
    `extra` of this package installs it."""
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] == "labial":
            raise
        raise missing(what, f"the package {error.name}", pip(extra)) from None
