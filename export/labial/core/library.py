"""The C library through ctypes: its location, the types of its functions, its messages.

It is a shared library that is independent of Python (``flat``), so that one build serves every Python of a platform.
Python's global lock is released during every call.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import POINTER, c_char_p, c_int, c_int16, c_int32, c_uint8, c_uint32, c_void_p
from functools import cache
from pathlib import Path
from typing import Any, Dict, Optional, Sequence, Tuple

from labial import __version__
from labial.errors import LabialError, StreamError, pip

#: Environment variable that names another library than the one in this folder, such as a build of the sources.
VARIABLE = "LABIAL_RUNTIME"
#: FLAT_INTERFACE of flat/flat.h, which says what the functions do.
_INTERFACE = 7

#: Results of include/labial/result.h that this package distinguishes.
OK, WAITING, STARVED, DONE = 0, 1, 2, 3
ERROR_STATE, ERROR_PHONEME, ERROR_DURATION, ERROR_FRAME_RATE, ERROR_NAME = -5, -6, -7, -9, -11

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


_POINTER, _NUMBER, _TEXT = c_void_p, c_uint32, c_char_p
_FUNCTIONS: Dict[str, Tuple[Any, Sequence[Any]]] = {
    "flat_interface": (_NUMBER, ()), "flat_version": (_TEXT, ()), "flat_method": (_TEXT, ()),
    "result_text": (_TEXT, (c_int,)),
    "mouth_size": (_NUMBER, ()), "blob_size": (_NUMBER, ()), "laugh_size": (_NUMBER, ()), "timings_size": (_NUMBER, ()),
    "rig_output_size": (_NUMBER, ()), "rig_curve_size": (_NUMBER, ()),
    "bundled_name": (_TEXT, (_NUMBER,)), "bundled_model": (_POINTER, (_NUMBER,)),
    "bundled_names": (_POINTER, (_NUMBER,)),
    "model_phonemes": (_NUMBER, (_POINTER,)), "model_silence": (_NUMBER, (_POINTER,)),
    "model_fps": (_NUMBER, (_POINTER,)), "model_stride": (_NUMBER, (_POINTER,)),
    "model_load": (c_int, (_POINTER, _POINTER, _NUMBER)),
    "label_at": (_TEXT, (_POINTER, _NUMBER)), "find": (c_int, (_POINTER, _NUMBER, _TEXT, _NUMBER)),
    "find_nearest": (c_int, (_POINTER, _NUMBER, _TEXT, _NUMBER, _NUMBER)),
    "mouth_init": (c_int, (_POINTER, _POINTER)), "mouth_use": (c_int, (_POINTER, _POINTER)),
    "mouth_push": (c_int, (_POINTER, _NUMBER, _NUMBER)), "mouth_room": (_NUMBER, (_POINTER,)),
    "mouth_end": (c_int, (_POINTER,)), "mouth_cancel": (c_int, (_POINTER, _NUMBER)),
    "mouth_restart": (c_int, (_POINTER,)), "mouth_articulation": (c_int, (_POINTER, _NUMBER)),
    "mouth_run": (c_int, (_POINTER, _POINTER, _POINTER, _NUMBER)), "mouth_exact": (c_int, (_POINTER, _NUMBER)),
    "mouth_moved": (_NUMBER, (_POINTER,)),
    "mouth_tick": (c_int, (_POINTER,)), "mouth_faps": (POINTER(c_int16), (_POINTER,)), "mouth_visemes": (POINTER(c_uint8), (_POINTER,)),
    "mouth_state": (c_int, (_POINTER,)), "mouth_held": (_NUMBER, (_POINTER,)),
    "mouth_milliseconds": (_NUMBER, (_POINTER,)), "mouth_waiting": (_NUMBER, (_POINTER,)),
    "mouth_delay": (_NUMBER, (_POINTER,)),
    "laugh_init": (c_int, (_POINTER, _NUMBER, _NUMBER, _NUMBER)), "laugh_next": (c_int, (_POINTER, _POINTER)),
    "rig_output": (None, (_POINTER, _POINTER, _POINTER)), "rig_check": (c_int, (_POINTER, _NUMBER)),
    "rig_rest": (c_int, (_POINTER, _NUMBER, _POINTER)),
    "rig_apply": (c_int, (_POINTER, _NUMBER, _POINTER, _NUMBER, _POINTER, _POINTER)),
    "rig_show": (c_int, (_POINTER, _NUMBER, _POINTER, _POINTER, _POINTER)),
    "timings_name": (_TEXT, (_NUMBER,)), "timings_suffix": (_TEXT, (_NUMBER,)),
    "timings_init": (c_int, (_POINTER, _NUMBER, _TEXT, _NUMBER)),
    "timings_next": (c_int, (_POINTER, _POINTER, _NUMBER, _POINTER, _POINTER)),
    "timings_end": (c_int, (_POINTER, _POINTER, _POINTER)),
    "timings_label": (_TEXT, (_POINTER,)), "timings_word": (_TEXT, (_POINTER,)),
    "timings_message": (_TEXT, (_POINTER,)), "timings_line": (_NUMBER, (_POINTER,)),
    "ears_size": (_NUMBER, ()), "hearing_name": (_TEXT, (_NUMBER,)), "hearing_model": (_POINTER, (_NUMBER,)),
    "hearing_classes": (_NUMBER, (_NUMBER,)), "hearing_class": (_TEXT, (_NUMBER, _NUMBER)),
    "ears_init": (c_int, (_POINTER, _POINTER, _NUMBER, _NUMBER)), "ears_latency": (_NUMBER, (_POINTER,)),
    "ears_push": (c_int, (_POINTER, _POINTER, _NUMBER, _POINTER, _POINTER, _NUMBER)),
    "ears_end": (c_int, (_POINTER, _POINTER, _POINTER, _NUMBER)),
    "ears_cancel": (c_int, (_POINTER, _NUMBER, _POINTER, _POINTER, _NUMBER)),
    "ears_stretches": (_NUMBER, (_POINTER,)), "ears_restart": (c_int, (_POINTER,)),
    "ears_exact": (c_int, (_POINTER, _NUMBER)), "ears_articulation": (c_int, (_POINTER, _NUMBER)),
    "ears_level": (_NUMBER, (_POINTER,)), "ears_set_level": (c_int, (_POINTER, _NUMBER)),
    "servos_size": (_NUMBER, (_NUMBER, _NUMBER)), "servos_init": (c_int, (_POINTER, _POINTER, _NUMBER, _NUMBER)),
    "servos_frame": (None, (_POINTER, _POINTER)), "servos_values": (c_int, (_POINTER, _POINTER)),
    "servos_tick": (c_int, (_POINTER, _POINTER)), "servos_play": (c_int, (_POINTER,)),
    "servos_skip": (c_int, (_POINTER, _NUMBER)), "servos_cancel": (c_int, (_POINTER, _NUMBER)),
    "servos_soft_start": (c_int, (_POINTER, _NUMBER)), "servos_attached": (_NUMBER, (_POINTER,)),
    "servos_place": (c_int, (_POINTER, _POINTER)),
    "words_size": (_NUMBER, ()), "words_own_size": (_NUMBER, (_NUMBER,)),
    "words_own": (_POINTER, (_POINTER, _NUMBER, _POINTER)), "words_label": (_TEXT, (_NUMBER,)),
    "words_read": (c_int, (_POINTER, _TEXT, _NUMBER, _POINTER)),
    "words_init": (c_int, (_POINTER, _POINTER, c_int32)),
    "words_push": (c_int, (_POINTER, _TEXT, _NUMBER, _NUMBER, _NUMBER)),
    "words_push_characters": (c_int, (_POINTER, _TEXT, _NUMBER, _NUMBER, _POINTER, _NUMBER)),
    "words_end": (c_int, (_POINTER,)), "words_restart": (c_int, (_POINTER,)),
    "words_next": (c_int, (_POINTER, _POINTER)),
}  # fmt: skip


@cache
def library() -> ctypes.CDLL:
    """The library, loaded once. Raises LabialError if it is missing or of another version."""
    path = library_path()
    try:
        loaded = ctypes.CDLL(str(path))
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(loaded, name)
            function.restype, function.argtypes = result, list(arguments)
    except (OSError, AttributeError) as error:
        raise LabialError(f"{path} is not Labial's run-time: {error}") from None
    version = (loaded.flat_version() or b"").decode("ascii", "replace")
    if loaded.flat_interface() != _INTERFACE or version != __version__:
        raise LabialError(f"{path} is the run-time of Labial {version}, and this package is Labial {__version__}: "
                          "install or build it anew")
    return loaded


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
    text: bytes = library().flat_method()
    return text.decode("ascii")


def sentence(result: int) -> str:
    """The library's description of a result."""
    text: Optional[bytes] = library().result_text(result)
    return (text or b"").decode("utf-8")


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
