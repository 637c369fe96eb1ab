"""The C library as ctypes sees it: where it lies, what its functions take, its sentences.

It is a shared library of its own that knows nothing of Python (``packaging/python``), so that one build of it serves
every Python of a platform. Python's global lock is released during every call.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import POINTER, Structure, c_char_p, c_int, c_int16, c_int32, c_size_t, c_uint32, c_void_p
from functools import cache
from pathlib import Path
from typing import Any, Dict, Optional, Sequence, Tuple

from labial import __version__
from labial.errors import LabialError, StreamError

#: Names another library than the one in this folder: a build of the source tree, for instance.
VARIABLE = "LABIAL_RUNTIME"
#: LABIAL_PYTHON_INTERFACE of packaging/python/labial_python.h.
_INTERFACE = 1

#: Results of include/labial/labial.h that this package tells apart.
OK, WAITING, STARVED, DONE = 0, 1, 2, 3
ERROR_STATE, ERROR_PHONEME, ERROR_DURATION, ERROR_RATE, ERROR_NAME = -5, -6, -7, -9, -11

#: LABIAL_DURATION_MAX: the longest duration of one phoneme, milliseconds.
DURATION_MAX = 3_600_000
#: LABIAL_LAUGH_FULL.
LAUGH_FULL = 256


class Control(Structure):
    """The members of ``labial_python_t`` that Python sets and reads."""

    _fields_ = [("items", c_void_p), ("models", c_void_p), ("frames", c_void_p), ("count", c_uint32),
                ("used", c_uint32), ("ends", c_uint32), ("capacity", c_uint32), ("delivered", c_uint32),
                ("number", c_uint32)]  # fmt: skip


class About(Structure):
    """``labial_python_model_t``."""

    _fields_ = [("fps", c_uint32), ("stride", c_uint32), ("phonemes", c_uint32), ("silence", c_uint32)]


class LatencyStruct(Structure):
    """``labial_latency_t``."""

    _fields_ = [("frames", c_uint32), ("milliseconds", c_uint32), ("phonemes", ctypes.c_uint), ("delay", ctypes.c_uint)]


class RigSegment(Structure):
    """``labial_rig_segment_t``."""

    _fields_ = [("first", c_int32), ("to", c_int32), ("slope", c_int32)]


class RigCurve(Structure):
    """``labial_rig_curve_t``."""

    _fields_ = [("count", ctypes.c_uint16), ("segments", RigSegment * 8)]


class RigOutput(Structure):
    """``labial_rig_output_t``."""

    _fields_ = [("weights", c_int16 * 13), ("invert", ctypes.c_uint8), ("contact", ctypes.c_uint8), ("gain", c_int32),
                ("neutral", c_int32), ("minimum", c_int32), ("maximum", c_int32), ("slew", c_int32),
                ("closed", c_int32), ("deadband", c_int32), ("acceleration", c_int32),
                ("curve", POINTER(RigCurve))]  # fmt: skip


class RigTable(Structure):
    """``labial_rig_t``."""

    _fields_ = [("outputs", POINTER(RigOutput)), ("count", ctypes.c_uint16)]


_FUNCTIONS: Dict[str, Tuple[Any, Sequence[Any]]] = {
    "labial_python_interface": (c_uint32, ()),
    "labial_python_version": (c_char_p, ()),
    "labial_python_size": (c_uint32, ()),
    "labial_python_blob_size": (c_uint32, ()),
    "labial_python_output_size": (c_uint32, ()),
    "labial_python_open": (c_int, (c_void_p,)),
    "labial_python_feed": (c_int, (c_void_p,)),
    "labial_python_run": (c_int, (c_void_p, c_uint32)),
    "labial_python_cancel": (c_int, (c_void_p, c_uint32)),
    "labial_python_restart": (c_int, (c_void_p,)),
    "labial_python_latency": (None, (c_void_p, POINTER(LatencyStruct))),
    "labial_python_model": (c_int, (c_void_p, POINTER(About))),
    "labial_python_laugh": (c_int, (c_uint32, c_uint32, c_uint32, c_uint32, c_void_p, c_uint32)),
    "labial_python_label": (c_char_p, (c_void_p, c_uint32)),
    "labial_result_text": (c_char_p, (c_int,)),
    "labial_find_in": (c_int, (c_void_p, c_int, c_char_p, c_size_t)),
    "labial_find_nearest": (c_int, (c_void_p, c_int, c_char_p, c_size_t, ctypes.c_uint)),
    "labial_model_load": (c_int, (c_void_p, c_void_p, c_size_t)),
    "labial_rig_check": (c_int, (POINTER(RigTable),)),
    "labial_rig_rest": (c_int, (POINTER(RigTable), c_void_p)),
    "labial_rig_apply_ahead": (c_int, (POINTER(RigTable), c_void_p, ctypes.c_uint16, c_void_p, c_void_p)),
}


@cache
def library() -> ctypes.CDLL:
    """The library, loaded once. Raises LabialError where there is none, or one of another version."""
    path = _path()
    try:
        loaded = ctypes.CDLL(str(path))
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(loaded, name)
            function.restype, function.argtypes = result, list(arguments)
    except (OSError, AttributeError) as error:
        raise LabialError(f"{path} is not Labial's run-time: {error}") from None
    version = (loaded.labial_python_version() or b"").decode("ascii", "replace")
    if loaded.labial_python_interface() != _INTERFACE or version != __version__:
        raise LabialError(f"{path} is the run-time of Labial {version}, and this package is Labial {__version__}: "
                          "install or build it anew")
    return loaded


def _path() -> Path:
    given = os.environ.get(VARIABLE)
    if given:
        return Path(given)
    folder = Path(__file__).resolve().parent
    for suffix in (".so", ".dll", ".dylib"):
        if (folder / f"labial_runtime{suffix}").is_file():
            return folder / f"labial_runtime{suffix}"
    raise LabialError("the run-time is not compiled: install the package with pip, or name a build of it in the "
                      f"environment variable {VARIABLE}")


def sentence(result: int) -> str:
    """The library's sentence for a result."""
    text: Optional[bytes] = library().labial_result_text(result)
    return (text or b"").decode("utf-8")


def failure(result: int, what: str = "") -> StreamError:
    """The exception for a result, about `what`."""
    return StreamError(result, f"{what}: {sentence(result)}" if what else sentence(result))


def checked(result: int, what: str = "") -> int:
    """`result`, if it is no error; raises StreamError with the library's sentence, about `what`."""
    if result < 0:
        raise failure(result, what)
    return result


def address_of(symbol: str) -> int:
    """Where the library has one of its tables."""
    return ctypes.addressof(ctypes.c_char.in_dll(library(), symbol))


def memory(size: int) -> Any:
    """Zeros, aligned to eight bytes, that live as long as what is returned."""
    return (ctypes.c_uint64 * ((size + 7) // 8))()
