"""espeak-ng's library through ctypes. It has one state in a process: whoever uses it holds `LOCK`."""

from __future__ import annotations

import ctypes
import ctypes.util
import threading
from functools import cache
from typing import Any, List, Optional, Tuple

from labial.errors import apt, missing

#: Values of espeak-ng's speak_lib.h.
_SYNCHRONOUS, _PHONEME_EVENTS, _IPA, _DONT_EXIT = 2, 0x1, 0x2, 0x8000
_UTF8, _SEPARATED = 1, _IPA | ord("_") << 8

LOCK = threading.RLock()


class _Voice(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("languages", ctypes.c_char_p), ("identifier", ctypes.c_char_p),
                ("numbers", ctypes.c_ubyte * 4), ("score", ctypes.c_int), ("spare", ctypes.c_void_p)]


@cache
def library() -> Tuple[Any, int]:
    """The library, and the rate of its sound. It stays loaded: after espeak_Terminate() it cannot begin again. Raises
    LabialError where it or its data are missing."""
    name = ctypes.util.find_library("espeak-ng") or "libespeak-ng.so.1"
    try:
        found = ctypes.CDLL(name)
    except OSError:
        raise missing("this voice", "espeak-ng", apt("libespeak-ng1")) from None
    rate = int(found.espeak_Initialize(_SYNCHRONOUS, 0, None, _PHONEME_EVENTS | _IPA | _DONT_EXIT))
    if rate <= 0:
        raise missing("espeak-ng", "its data", apt("espeak-ng-data"))
    found.espeak_TextToPhonemes.restype = ctypes.c_char_p
    found.espeak_TextToPhonemes.argtypes = [ctypes.POINTER(ctypes.c_void_p), ctypes.c_int, ctypes.c_int]
    found.espeak_GetCurrentVoice.restype = ctypes.POINTER(_Voice)
    return found, rate


def set_voice(found: Any, voice: str) -> bool:
    """Has the library speak with a voice, by its name or by that of its language, such as en-gb; False without one."""
    name = voice.encode("utf-8")
    return not found.espeak_SetVoiceByName(name) or not found.espeak_SetVoiceByProperties(
        ctypes.byref(_Voice(None, name)))


def ipa(texts: List[str], voice: str) -> Optional[List[str]]:
    """The IPA of each text, with ``_`` between phonemes and blanks between words; None if there is no such voice. The
    voice that was set stays set."""
    with LOCK:
        found, _ = library()
        current = found.espeak_GetCurrentVoice()
        before = current.contents.identifier if current else None
        if not set_voice(found, voice):
            return None
        try:
            return [_ipa(found, text) for text in texts]
        finally:
            if before:
                found.espeak_SetVoiceByName(before)


def _ipa(found: Any, text: str) -> str:
    content = ctypes.create_string_buffer(text.replace("\0", " ").encode("utf-8", "replace"))
    place = ctypes.c_void_p(ctypes.addressof(content))
    clauses = []
    while place.value:
        clauses.append(found.espeak_TextToPhonemes(ctypes.byref(place), _UTF8, _SEPARATED).decode("utf-8", "replace"))
    return " ".join(clauses)


def replacements(text: str, voice: str) -> str:
    """What espeak-ng's dictionary of a voice writes for a text, which it prints when its translation is traced: pinyin
    for Chinese. Empty where the system has no streams in memory."""
    libc = ctypes.CDLL(None)
    if not hasattr(libc, "open_memstream"):
        return ""
    libc.open_memstream.restype = ctypes.c_void_p
    at, size = ctypes.c_void_p(), ctypes.c_size_t()
    stream = libc.open_memstream(ctypes.byref(at), ctypes.byref(size))
    if not stream:
        return ""
    with LOCK:
        found, _ = library()
        found.espeak_SetPhonemeTrace(0x8, ctypes.c_void_p(stream))
        try:
            ipa([text], voice)
        finally:
            found.espeak_SetPhonemeTrace(0, None)
            libc.fclose(ctypes.c_void_p(stream))
    content = ctypes.string_at(at, size.value).decode("utf-8", "replace")
    libc.free(at)
    lines = [line.split() for line in content.splitlines() if line.startswith("Replace:")]
    return " ".join(line[2] for line in lines if len(line) > 2)
