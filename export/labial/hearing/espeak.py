"""espeak-ng's library through ctypes: the sound of a text with the times of its phonemes.

It does what ``labial-say-espeak`` does (tools/speak), so that both have the same phonemes at the same times: espeak-ng
reports p, t and k at their burst, and the silence before it, while lips or tongue are shut, is theirs.
"""

from __future__ import annotations

import ctypes
import unicodedata
from typing import Any, List, Optional, Sequence, Tuple

import numpy as np

from labial.core import espeak
from labial.errors import LabialError

#: Values of espeak-ng's speak_lib.h.
_END, _PHONEME = 0, 7
_RATE, _PITCH = 1, 3
_NORMAL_RATE, _NORMAL_PITCH = 175, 50
_UTF8 = 1

#: Shorter stretches without a label are word boundaries, glottal stops or glides, for which espeak-ng has no IPA: they
#: belong to the phoneme before. Milliseconds; pauses last 150.
SHORTEST_PAUSE = 65
#: Milliseconds: steps in which the sound's level is taken, the longest closure, and what the phoneme before it keeps.
_STEP, _LONGEST_CLOSURE, _KEPT = 5, 100, 20
#: A closure is this many times quieter than the loudest step of the phoneme before it.
_QUIETER = 16
_STOPS = frozenset("ptkbdgcq\u0261\u0288\u0256\u025f\u0262")


class _Event(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("identifier", ctypes.c_uint), ("text_position", ctypes.c_int),
                ("length", ctypes.c_int), ("audio_position", ctypes.c_int), ("sample", ctypes.c_int),
                ("user_data", ctypes.c_void_p), ("id", ctypes.c_char * 8)]  # fmt: skip


_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event))


class Speaker:
    """A voice of espeak-ng. The library has one state in a process: there is one speaker at a time."""

    def __init__(self, voice: str, pace: float = 1.0, pitch: float = 1.0) -> None:
        """`voice` is a voice or language with an optional variant, such as ``en-us+f3``. Raises LabialError without
        the library or the voice, and for MBROLA's."""
        if "mb" in voice.replace("/", "-").split("+")[0].split("-"):
            raise LabialError(f"espeak-ng's {voice!r} is a voice of MBROLA, which is not for every use")
        self._library, self.rate = espeak.library()
        self._samples: List[np.ndarray] = []
        self._events: List[Tuple[int, str]] = []
        self._callback = _CALLBACK(self._heard)  # kept: the library holds its address
        if not espeak.set_voice(self._library, voice):
            raise LabialError(f"espeak-ng has no voice {voice!r}")
        self._library.espeak_SetParameter(_RATE, round(_NORMAL_RATE * pace), 0)
        self._library.espeak_SetParameter(_PITCH, min(round(_NORMAL_PITCH * pitch), 99), 0)
        self._library.espeak_SetSynthCallback(self._callback)

    def say(self, text: str) -> Tuple[np.ndarray, int, List[Tuple[float, str]]]:
        """The sound of `text`, (N,) int16, its rate, and each phoneme's end in seconds with its IPA; "" is a pause."""
        self._samples, self._events = [], []
        content = text.encode("utf-8")
        failed = self._library.espeak_Synth(content, len(content) + 1, 0, 1, 0, _UTF8, None, None)
        if failed or self._library.espeak_Synchronize() or not self._samples:
            raise LabialError(f"espeak-ng could not say {text[:40]!r}")
        samples = np.concatenate(self._samples)
        return samples, self.rate, phonemes(self._events, samples, self.rate)

    def _heard(self, samples: Any, count: int, events: Any) -> int:
        if samples and count > 0:
            self._samples.append(np.ctypeslib.as_array(samples, (count,)).copy())
        at = 0
        while events and events[at].type != _END:
            event = events[at]
            if event.type == _PHONEME:
                # The bytes of `id` as they are: it has no NUL when it fills all of them.
                raw = ctypes.string_at(ctypes.addressof(event) + _Event.id.offset, 8).split(b"\0")[0]
                self._events.append((max(event.audio_position, 0), raw.decode("utf-8", "ignore")))
            at += 1
        return 0


def phonemes(events: Sequence[Tuple[int, str]], samples: np.ndarray, rate: int) -> List[Tuple[float, str]]:
    """The end of each phoneme, seconds, with its label, from `events`: where each begins, milliseconds, and its label;
    "" where espeak-ng has no IPA. `samples` is the sound, (N,) int16."""
    levels = _levels(samples, rate)
    found: List[Tuple[float, str]] = []
    label, begin = "", 0
    unlabelled: Optional[int] = None

    def close(end: int) -> None:
        nonlocal label, unlabelled
        if unlabelled is not None and end >= unlabelled + SHORTEST_PAUSE:
            found.append((unlabelled / 1000, label))
            label = ""
        unlabelled = None
        found.append((end / 1000, label))

    for start, name in events:
        if name.startswith("("):  # the name of a language, where words of another one begin
            continue
        if not name and not unlabelled:
            unlabelled = start
        if all(c.isdigit() or unicodedata.category(c) in ("Lm", "Sk") for c in name):  # part of the phoneme before
            continue
        pause = unlabelled is not None and start >= unlabelled + SHORTEST_PAUSE
        if label and not pause and name[0] in _STOPS:
            start = closure(levels, begin, start)
        close(start)
        label, begin = name, start
    close(max(round(1000 * len(samples) / rate), begin))
    return found


def closure(levels: np.ndarray, before: int, burst: int) -> int:
    """Where the silence before a burst begins, milliseconds: at `burst` itself if there is none. `levels` is of each
    `_STEP` of the sound; the phoneme before begins at `before`."""
    end = min(burst // _STEP, len(levels))
    first = max(-(-(before + _KEPT) // _STEP), end - _LONGEST_CLOSURE // _STEP, 0)
    loudest = levels[before // _STEP : end].max(initial=0)
    begin = end
    while begin > first and levels[begin - 1] * _QUIETER <= loudest:
        begin -= 1
    return begin * _STEP if begin < end else burst


def _levels(samples: np.ndarray, rate: int) -> np.ndarray:
    """(n,) int64: the mean magnitude of each step of `_STEP` milliseconds."""
    count = len(samples) * 1000 // (_STEP * rate)
    bounds = -(-np.arange(count + 1) * _STEP * rate // 1000)
    sums = np.concatenate([[0], np.cumsum(np.abs(samples.astype(np.int64)))])
    result: np.ndarray = (sums[bounds[1:]] - sums[bounds[:-1]]) // np.maximum(np.diff(bounds), 1)
    return result
