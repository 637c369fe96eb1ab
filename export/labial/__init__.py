"""Labial: phonemes and durations in, 13 lip and jaw parameters per frame out, for speech and laughter.

    import labial
    with labial.Stream() as stream:
        stream.push("HH", 70)
        stream.push("AY", 230)
        stream.laugh(1.5, 0.7)
        stream.end()
        for frame in stream:
            print(frame.number, frame.faps)
    motion = labial.render([("HH", 70), ("AY", 230)])
    with labial.Hearing(16000) as hearing:
        print(hearing.push(bytes(9600)))
    with labial.Voice() as voice:
        voice.feed({"word": "Hi", "start": 0.0, "end": 0.3})
        print(voice.played(0.1))

This is the run-time (``labial.runtime``), the C library called from Python, which needs only Python; docs/python.md is
its manual. The other modules are the exporter, which trains models, writes them as tables for C, and needs numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, List

#: The bundled models. The order of a kind's phonemes is part of the interface: their names are those of every model.
BUNDLED = ("speech_en", "laughter_synthetic")
__version__ = "0.4.0"

if TYPE_CHECKING:
    from labial.runtime.beside import Beside
    from labial.runtime.face import Face
    from labial.runtime.hearing import Hearing, with_sound
    from labial.runtime.models import Model
    from labial.runtime.render import character_timings, phonemes, read_timings, render, word_timings
    from labial.runtime.rig import Rig
    from labial.runtime.stream import Frame, Latency, Stream
    from labial.runtime.voice import Voice

    speech_en: Model
    laughter_synthetic: Model

__all__ = ["Beside", "Face", "Frame", "Hearing", "Latency", "Model", "Rig", "Stream", "Voice", "character_timings",
           "phonemes", "read_timings", "render", "with_sound", "word_timings", *BUNDLED]

_HOMES = {"Beside": "beside", "Face": "face", "Frame": "stream", "Hearing": "hearing", "Latency": "stream",
          "Model": "models", "Rig": "rig", "Stream": "stream", "Voice": "voice", "character_timings": "render",
          "phonemes": "render", "word_timings": "render", "read_timings": "render", "render": "render",
          "with_sound": "hearing"}


def __getattr__(name: str) -> Any:
    """Loads the run-time and its library on first use of one of its names: exporting needs no library."""
    if name in ("errors", "runtime"):
        return import_module(f"labial.{name}")
    if name in BUNDLED:
        return import_module("labial.runtime.models").bundled(name)
    if name in _HOMES:
        return getattr(import_module(f"labial.runtime.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'labial' has no attribute {name!r}")


def __dir__() -> List[str]:
    return sorted([*globals(), *__all__])
