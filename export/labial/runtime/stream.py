"""A stream: phonemes and laughs in, frames out, one at a time."""

from __future__ import annotations

import ctypes
import math
from array import array
from typing import Any, List, Optional, Union

from labial.errors import LabialError, StreamError
from labial.runtime.frame import Frame, Latency
from labial.runtime.guard import Guard, alone
from labial.runtime.library import (
    DONE,
    DURATION_MAX,
    ERROR_RATE,
    ERROR_STATE,
    LAUGH_FULL,
    OK,
    Control,
    LatencyStruct,
    checked,
    failure,
    library,
    memory,
)
from labial.runtime.models import LABELS, Model, bundled
from labial.runtime.numbers import duration, number, whole

#: Numbers of an item, labial_python_item_t.
_ITEM = 3
#: Items that were pushed are forgotten when there are so many of them.
_FORGET = 1024


class Stream:
    """A mouth that speaks and laughs: what is pushed comes out as frames.

        with labial.Stream() as stream:
            stream.push("HH", 70)
            stream.push("AY", 230)
            stream.end()
            for frame in stream:
                show(frame)

    Any number of phonemes can be pushed ahead: those that the C library's queue has no room for wait here. Iterating
    yields frames as far as the phonemes go, and may be taken up again after more were pushed; :meth:`tick` is for
    programs that follow a clock. Closing frees the memory, as leaving the ``with`` block does; every call after it
    raises StreamError.

    Calls from several threads wait for each other. A call from within a call of the same stream, as from a signal
    handler that interrupts one, raises StreamError and changes nothing. After a fork the child has a copy of the
    stream, but for one that another thread was in a call of: all but :meth:`close` then raises StreamError.

    Args:
        model: the model of the first pushes; ``labial.speech_en`` without it.
        laughter: the model of :meth:`laugh`; ``labial.laughter_synthetic`` without it.
        labels: the set that labels of phonemes are of: "auto", "arpabet", "ipa" or "xsampa".
        nearest: labels that are not known move as the nearest ones, instead of raising StreamError.
    """

    def __init__(self, model: Optional[Model] = None, *, laughter: Optional[Model] = None, labels: str = "auto",
                 nearest: bool = False) -> None:
        first = _a_model(bundled("speech_en") if model is None else model)
        self._laughter = _a_model(bundled("laughter_synthetic") if laughter is None else laughter)
        if not isinstance(labels, str) or labels not in LABELS:
            raise LabialError(f"{labels!r} is no set of labels, {', '.join(LABELS)}")
        self._labels, self._nearest = labels, bool(nearest)
        self._guard = Guard()
        self._models: List[Model] = []
        self._items = array("I")
        self._owed = 0.0  # milliseconds that rounding has left over, -.5 to .5
        self._laughs = 0
        self._ended = self._done = False
        self._faps = (ctypes.c_int16 * 13)()
        self._memory: Any = memory(library().labial_python_size())
        self._address = ctypes.addressof(self._memory)
        self._control = Control.from_buffer(self._memory)
        self._control.capacity, self._control.frames = 1, ctypes.addressof(self._faps)
        self._run = library().labial_python_run
        self._current = self._place(first)
        checked(library().labial_python_open(self._address), first.name)

    # ---- What goes in

    @alone
    def push(self, phoneme: Union[str, int], milliseconds: float) -> None:
        """Appends a phoneme, by its label or its number in the current model, that lasts 0 to 3,600,000 ms.

        Fractions of a millisecond are carried on to the next phoneme. Raises StreamError for a label that is not known,
        a number or a duration out of range, and after :meth:`end` or :meth:`cancel`; TypeError for other types.
        """
        self._open(pushing=True)
        found = self._models[self._current].number(phoneme, self._labels, self._nearest)
        self._append(found, duration(milliseconds))

    @alone
    def laugh(self, seconds: float, intensity: float = 0.5, seed: Optional[int] = None) -> None:
        """Appends a laugh of 0 to 3600 seconds, from a hum (`intensity` 0) to a wide open mouth (1). The current model
        stays. The same `seed`, 0 to 2**32 - 1, makes the same laugh; without one every laugh of a stream is another."""
        self._open(pushing=True)
        length = round(duration(number(seconds, "a laugh's length") * 1000.0))
        loudness = number(intensity, "an intensity")
        if not 0.0 <= loudness <= 1.0:
            raise LabialError(f"an intensity of {loudness:g} is not within 0 .. 1")
        chosen = self._laughs + 1 if seed is None else whole(seed, "a seed")
        if not 0 <= chosen < 2**32:
            raise LabialError(f"a seed of {chosen} is not within 0 .. 4294967295")
        if not self._laughter.is_laughter:
            raise LabialError(f"{self._laughter.name} is no model of laughter")
        place = self._place(self._laughter)
        most = length // 20 + 8
        items = array("I", bytes(4 * _ITEM * most))
        count = checked(library().labial_python_laugh(
            length, math.floor(loudness * LAUGH_FULL + 0.5), chosen, place, items.buffer_info()[0], most))
        self._items += items[: _ITEM * count]
        self._laughs += 1

    @alone
    def use(self, model: Model) -> None:
        """Makes the next pushes phonemes of `model`, speech or laughter; the motion passes over in 8 frames. Raises
        StreamError where its frame rate or search stride is not the stream's."""
        self._open()
        self._current = self._place(_a_model(model))

    @alone
    def end(self) -> None:
        """No more phonemes will come."""
        self._open()
        self._ended = True

    @alone
    def cancel(self, milliseconds: float = 200) -> None:
        """Drops all that was pushed and not yet delivered, and eases back to the neutral face; then the stream is done.
        Times over 1,000 frames count as that."""
        self._open()
        length = math.ceil(duration(milliseconds))
        checked(library().labial_python_cancel(self._address, length))
        self._forget_items()
        self._ended, self._done = True, False

    @alone
    def restart(self) -> None:
        """Takes up a stream that is done or was cancelled: frames are numbered on and fade in from the last one. Raises
        StreamError while frames are still to come."""
        self._open()
        if self._waiting():
            raise failure(ERROR_STATE, "restart")
        self._feed()
        checked(library().labial_python_restart(self._address), "restart")
        self._forget_items()
        self._ended = self._done = False

    # ---- What comes out

    def __iter__(self) -> Stream:
        return self

    @alone
    def __next__(self) -> Frame:
        self._open()
        if self._advance(0) == OK:
            return Frame(self._control.number, tuple(self._faps))
        raise StopIteration

    @alone
    def tick(self) -> Optional[Frame]:
        """The next frame or None, once per frame period: None while the first one is on its way (``latency.delay``
        ticks), where the stream waits for phonemes, and when it is done. Frames that came too late are made up for by
        as many further calls."""
        self._open()
        if self._advance(1) == OK:
            return Frame(self._control.number, tuple(self._faps))
        return None

    @alone
    def rest(self) -> array:
        """All frames that can be computed now, in one call of C: T times 13 int16, FAP units. ``labial.render`` makes
        arrays of them."""
        self._open()
        control = self._control
        pieces = array("h")
        while True:
            frames = max(min(self._measure().frames, 1 << 20), 1024)
            piece = array("h", bytes(2 * 13 * frames))
            try:
                control.frames, control.capacity = piece.buffer_info()[0], frames
                result = self._advance(0)
            finally:
                control.frames, control.capacity = ctypes.addressof(self._faps), 1
            del piece[13 * control.delivered:]
            pieces += piece
            if result != OK:
                return pieces

    @property
    def done(self) -> bool:
        """Whether the last call for a frame found that the stream has ended and every frame was delivered."""
        return self._done

    @property
    @alone
    def latency(self) -> Latency:
        """What the stream holds at this moment."""
        self._open()
        return self._measure()

    @property
    def fps(self) -> int:
        """Frames per second."""
        return self._models[0].fps

    # ---- Life

    @alone
    def close(self) -> None:
        """Frees the stream's memory; may be called again."""
        self._address = 0
        self._control = self._memory = None
        self._forget_items()

    @alone
    def __enter__(self) -> Stream:
        self._open()
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # ---- Within the lock

    def _open(self, pushing: bool = False) -> None:
        if not self._address:
            raise StreamError(ERROR_STATE, "the stream is closed")
        if pushing and self._ended:
            raise failure(ERROR_STATE)

    def _place(self, model: Model) -> int:
        """The place of `model` among the stream's, at its end where it is a new one."""
        if model in self._models:
            return self._models.index(model)
        if self._models and (model.fps, model.stride) != (self._models[0].fps, self._models[0].stride):
            raise failure(ERROR_RATE, model.name)
        self._models.append(model)
        self._pointers = (ctypes.c_void_p * len(self._models))(*(held.address for held in self._models))
        self._control.models = ctypes.addressof(self._pointers)
        return len(self._models) - 1

    def _append(self, phoneme: int, length: float) -> None:
        self._owed += length
        milliseconds = min(max(math.floor(self._owed + 0.5), 0), DURATION_MAX)
        self._owed -= milliseconds
        self._items.extend((self._current, phoneme, milliseconds))

    def _waiting(self) -> int:
        """Phonemes that were not handed to the library yet."""
        return len(self._items) // _ITEM - self._control.used

    def _forget_items(self) -> None:
        self._items = array("I")
        self._owed = 0.0
        if self._control is not None:
            self._control.used = 0

    def _set(self) -> None:
        """Hands the items to the library, whose memory may have moved since."""
        control = self._control
        if control.used >= _FORGET:
            del self._items[: _ITEM * control.used]
            control.used = 0
        control.items, control.count = self._items.buffer_info()[0], len(self._items) // _ITEM
        control.ends = self._ended

    def _advance(self, ticks: int) -> int:
        """Runs the stream into `frames`, for so many ticks or, with 0, as far as it goes; what the last tick did."""
        self._set()
        result = self._run(self._address, ticks)
        if result < 0:
            raise failure(result)
        self._done = result == DONE
        return int(result)

    def _feed(self) -> None:
        self._set()
        checked(library().labial_python_feed(self._address))

    def _measure(self) -> Latency:
        self._feed()
        found = LatencyStruct()
        library().labial_python_latency(self._address, ctypes.byref(found))
        later = sum(self._items[_ITEM * self._control.used + 2::_ITEM])
        return Latency(found.frames + (later * self.fps + 500) // 1000, found.milliseconds + later,
                       found.phonemes + self._waiting(), found.delay)


def _a_model(model: Any) -> Model:
    if not isinstance(model, Model):
        raise TypeError(f"a model is a labial.Model, not {type(model).__name__}")
    return model


