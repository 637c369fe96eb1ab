"""Speech by espeak-ng's library, which tells where each phoneme starts. examples/speak/espeak.c is the same in C."""

from __future__ import annotations

import ctypes
import unicodedata
from array import array
from ctypes import CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_int, c_short, c_size_t, c_ubyte, c_uint, c_void_p
from typing import List, Sequence, Tuple

from utterance import Utterance

#: Shorter stretches without a label are no pauses but a word's boundary or a glottal stop; milliseconds.
SHORTEST_PAUSE = 65
#: Frames by which the sound's level is told, and the longest silence that belongs to a stop; milliseconds.
LEVEL, LONGEST_CLOSURE = 5, 100
#: Milliseconds that the phoneme before a stop keeps, and how much softer than it a silence is (24 dB).
KEPT, SOFTER = 20, 16

_STOPS = ("p", "t", "k", "b", "d", "g", "c", "q", "ɡ", "ʈ", "ɖ", "ɟ", "ɢ")

# Of espeak-ng/speak_lib.h.
_SYNCHRONOUS, _PHONEMES, _IPA, _DONT_EXIT = 2, 0x0001, 0x0002, 0x8000
_LIST_TERMINATED, _PHONEME, _CHARACTERS, _UTF8, _OK = 0, 7, 1, 1, 0


class _Event(Structure):
    _fields_ = [("type", c_int), ("identifier", c_uint), ("text_position", c_int), ("length", c_int),
                ("audio_position", c_int), ("sample", c_int), ("user_data", c_void_p), ("string", c_char * 8)]


class _Voice(Structure):
    _fields_ = [("name", c_char_p), ("languages", c_char_p), ("identifier", c_char_p), ("gender", c_ubyte),
                ("age", c_ubyte), ("variant", c_ubyte), ("spare", c_ubyte), ("score", c_int), ("more", c_void_p)]


_Callback = CFUNCTYPE(c_int, POINTER(c_short), c_int, POINTER(_Event))


class Espeak:
    """espeak-ng with one voice or language, such as "en-us". Raises RuntimeError where it is not installed."""

    def __init__(self, voice: str = "en-us") -> None:
        try:
            self._library = ctypes.CDLL("libespeak-ng.so.1")
        except OSError:
            raise RuntimeError("espeak-ng is not installed: apt-get install espeak-ng") from None
        self._library.espeak_Synth.argtypes = [c_char_p, c_size_t, c_uint, c_int, c_uint, c_uint, c_void_p, c_void_p]
        self._rate = self._library.espeak_Initialize(_SYNCHRONOUS, 0, None, _PHONEMES | _IPA | _DONT_EXIT)
        wanted = _Voice(languages=voice.encode())
        if self._rate <= 0 or (self._library.espeak_SetVoiceByName(voice.encode()) != _OK
                               and self._library.espeak_SetVoiceByProperties(ctypes.byref(wanted)) != _OK):
            raise RuntimeError(f"espeak-ng has no voice {voice!r}")
        self._callback = _Callback(self._heard)
        self._library.espeak_SetSynthCallback(self._callback)

    def say(self, text: str) -> Utterance:
        """The sound of a text and its phonemes."""
        self._sound, self._events = array("h"), []
        content = text.encode("utf-8")
        if (self._library.espeak_Synth(content, len(content) + 1, 0, _CHARACTERS, 0, _UTF8, None, None) != _OK
                or self._library.espeak_Synchronize() != _OK):
            raise RuntimeError("espeak-ng does not speak this text")
        return Utterance(self._sound.tobytes(), self._rate, timings(self._events, self._sound, self._rate), "ipa")

    def _heard(self, samples: POINTER(c_short), count: int, events: POINTER(_Event)) -> int:
        if samples and count > 0:
            self._sound.extend(samples[:count])
        place = 0
        while events[place].type != _LIST_TERMINATED:
            if events[place].type == _PHONEME:
                label = events[place].string.decode("utf-8", "replace")
                label = "ʊɐ" if label == "??" else label  # what espeak-ng 1.51 has no IPA for, in German "Uhr"
                self._events.append((max(events[place].audio_position, 0), label))
            place += 1
        return 0


def timings(events: Sequence[Tuple[int, str]], sound: Sequence[int], rate: int) -> List[Tuple[str, float]]:
    """Phonemes with their milliseconds, from events of (start, label), milliseconds; "" is silence, and all together
    they last as long as the sound. Stops begin where the sound falls silent before their burst."""
    levels = _levels(sound, rate)
    end = (len(sound) * 1000 + rate // 2) // rate
    heard = [(start, label) for start, label in events if not label.startswith("(") and not _is_mark(label)]
    starts = [(0, "")]
    for place, (start, label) in enumerate(heard):
        if not label:
            later = next((after for after, following in heard[place:] if following), end)
            if not starts[-1][1] or later - start < SHORTEST_PAUSE:
                continue
        elif label.startswith(_STOPS) and starts[-1][1]:
            start = closure(levels, starts[-1][0], start)
        starts.append((start, label))
    ends = [start for start, _ in starts[1:]] + [end]
    return [(label, max(after - start, 0)) for (start, label), after in zip(starts, ends)]


def closure(levels: Sequence[int], before: int, burst: int) -> int:
    """Where a stop begins, milliseconds: with the silence before its `burst`, in the phoneme from `before` on."""
    end = min(burst // LEVEL, len(levels))
    loudest = max(levels[before // LEVEL : end], default=0)
    first = max(-(-(before + KEPT) // LEVEL), end - LONGEST_CLOSURE // LEVEL)
    begin = end
    while begin > first and levels[begin - 1] * SOFTER <= loudest:
        begin -= 1
    return begin * LEVEL if begin < end else burst


def _levels(sound: Sequence[int], rate: int) -> List[int]:
    """Mean absolute sample of each frame of `LEVEL` milliseconds."""
    count = len(sound) * 1000 // (rate * LEVEL)
    ends = [-(-frame * rate * LEVEL // 1000) for frame in range(count + 1)]
    return [sum(map(abs, sound[a:b])) // (b - a) for a, b in zip(ends, ends[1:])]


def _is_mark(label: str) -> bool:
    """Whether a label is a tone's digit or modifier letters alone, which belong to the phoneme before."""
    return bool(label) and all(c.isdigit() or unicodedata.category(c) == "Lm" for c in label)
