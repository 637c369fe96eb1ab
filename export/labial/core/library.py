"""The C library through ctypes: its location, the types of its functions, its messages.

It is a shared library that is independent of Python (``flat``), so that one build serves every Python of a platform.
Python's global lock is released during every call.
"""

from __future__ import annotations

import ctypes
import os
import sys
from ctypes import POINTER, c_char_p, c_uint32, c_void_p
from functools import cache
from itertools import count, takewhile
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Dict, Tuple

from labial import __version__
from labial.errors import LabialError, StreamError, pip

#: Environment variable that names another library than the one in this folder, such as a build of the sources.
VARIABLE = "LABIAL_RUNTIME"
#: FLAT_INTERFACE of flat/flat.h, which says what the functions do.
_INTERFACE = 8
#: Results of include/labial/result.h that this package distinguishes.
OK, WAITING, STARVED, DONE = 0, 1, 2, 3
ERROR_STATE, ERROR_PHONEME, ERROR_DURATION, ERROR_FULL, ERROR_FRAME_RATE, ERROR_NAME = -5, -6, -7, -8, -9, -11
#: LABIAL_DURATION_MAX: the longest duration of one phoneme, milliseconds.
DURATION_MAX = 3_600_000
#: LABIAL_CANCEL_MAX: the longest way to rest of a cancel, frames.
CANCEL_MAX = 1000
#: LABIAL_ARTICULATION_MAX, percent.
ARTICULATION_MAX = 200
#: LABIAL_VISEMES.
VISEMES = 15
#: LABIAL_LAUGH_FULL.
LAUGH_FULL = 256
#: How a binary model begins (include/labial/blob.h).
BLOB_MAGIC = b"LBM1"
#: The types of flat/CMakeLists.txt, which makes the library's list of its functions.
_TYPES: Dict[str, Any] = {
    "void": None, "int": ctypes.c_int, "int32_t": ctypes.c_int32, "int64_t": ctypes.c_int64,
    "uint64_t": ctypes.c_uint64, "size_t": ctypes.c_size_t, "number": c_uint32, "double": ctypes.c_double,
    "text": c_char_p, "pointer": c_void_p, "frame": POINTER(ctypes.c_int16), "shares": POINTER(ctypes.c_uint8),
}
#: A function that the library asks for a word's pronunciation (labial_voice_own_fn of include/labial/voice.h).
PRONOUNCE = ctypes.CFUNCTYPE(c_void_p, c_void_p, c_void_p, ctypes.c_size_t)
#: What the functions' symbols begin with.
_PREFIX = "" if sys.platform == "win32" else "flat_"


class Library(SimpleNamespace):
    """The functions of ``flat`` as attributes, by the names of its headers."""

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)


def _bound(loaded: ctypes.CDLL) -> Library:
    """All functions that the library lists."""
    listed = getattr(loaded, f"{_PREFIX}function")
    listed.restype, listed.argtypes = c_char_p, [c_uint32]
    functions = Library()
    for row in texts(listed):
        name, result, *arguments = row.split()
        function = getattr(loaded, _PREFIX + name)
        function.restype, function.argtypes = _TYPES[result], [_TYPES[item] for item in arguments]
        setattr(functions, name, function)
    return functions


def texts(listed: Callable[[int], Any]) -> Tuple[str, ...]:
    """What a function of the library returns for 0, 1, ..., until that is NULL or empty."""
    return tuple(text.decode("ascii") for text in takewhile(bool, map(listed, count())))


@cache
def library() -> Library:
    """The library, loaded once. Raises LabialError if it is missing or of another version."""
    path = library_path()
    try:
        found = _bound(ctypes.CDLL(str(path)))
    except (OSError, AttributeError, KeyError) as error:
        raise LabialError(f"{path} is not Labial's run-time: {error}") from None
    version = (found.version() or b"").decode("ascii", "replace")
    if found.interface() != _INTERFACE or version != __version__:
        raise LabialError(f"{path} is the run-time of Labial {version}, and this package is Labial {__version__}: "
                          "install or build it anew")
    return found


def library_path() -> Path:
    """The library's file. Raises LabialError where there is none."""
    given = os.environ.get(VARIABLE)
    if given:
        return Path(given)
    folder = Path(__file__).resolve().parent
    source = folder.parents[2]
    built = source.glob("build/*/flat/labial_runtime.*") if (source / "flat").is_dir() else ()  # of the source tree
    latest = sorted(built, key=lambda path: path.stat().st_mtime, reverse=True)
    for found in (*folder.glob("labial_runtime.*"), *latest):
        if found.suffix in (".so", ".dll", ".dylib"):
            return found
    raise LabialError(f"the run-time is not compiled: {pip()}, or build the source tree with CMake, or name a build of "
                      f"it in the environment variable {VARIABLE}")


def method() -> str:
    """The method that the library is built for: "labial", or "paper" for the published one to the letter."""
    return library().method().decode("ascii")


def sentence(result: int) -> str:
    """The library's description of a result."""
    return (library().result_text(result) or b"").decode("utf-8")


def failure(result: int, what: str = "") -> StreamError:
    """The exception for a result, about `what`."""
    return StreamError(result, f"{what}: {sentence(result)}" if what else sentence(result))


def checked(result: int, what: str = "") -> int:
    """`result`, unless it is an error; then raises StreamError with the library's description, about `what`."""
    if result < 0:
        raise failure(result, what)
    return result


def memory(size: int) -> Any:
    """Zeroed memory, aligned to eight bytes, that lives as long as the returned object."""
    return (ctypes.c_uint64 * ((size + 7) // 8))()
