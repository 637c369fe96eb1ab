"""A stream: phonemes and laughs in, frames out, one at a time; a frame, and the latency of a stream."""

from __future__ import annotations

import ctypes
import math
from array import array
from typing import List, NamedTuple, Optional, Tuple, Union

from labial.core.guard import Closing, alone, articulation, duration, number, opened, whole
from labial.core.library import (
    DONE,
    DURATION_MAX,
    ERROR_FRAME_RATE,
    ERROR_STATE,
    LAUGH_FULL,
    OK,
    STARVED,
    VISEMES,
    checked,
    failure,
    library,
    memory,
)
from labial.errors import LabialError
from labial.runtime.models import Model, bundled, expected, set_of
from labial.runtime.rig import Rig, Values

#: Numbers in an item: its model's place among the stream's, phoneme, milliseconds.
_ITEM = 3
#: Frames that are requested at a time.
_PIECE = 1024
#: Processed items are dropped when there are so many of them.
_FORGET = 1024


class _Moment(NamedTuple):
    number: int
    faps: Tuple[int, ...]


class Frame(_Moment):
    """The mouth at one moment: a pair, `number` and `faps`.

    Attributes:
        number: counted from 0 since the stream was made; it is due number / fps seconds after the first.
        faps: 13 values, FAP units, in the order of ``labial.files.faps.FAP_NUMBERS``.
        visemes: how much of each sound the frame shows, 15 shares of together 128 in the order of
        ``labial.tables.visemes.VISEMES``; empty if unknown.
    """

    visemes: Tuple[int, ...]

    def __new__(cls, number: int, faps: Tuple[int, ...], visemes: Tuple[int, ...] = ()) -> Frame:
        """A frame."""
        frame = super().__new__(cls, number, faps)
        frame.visemes = visemes
        return frame

    def rig(self, face: Union[Rig, str]) -> Values:
        """The values of `face`: one for each output, by name, in the rig's unit; weights are 0 .. 1.

        `face` is a :class:`labial.Rig`. Outputs with a limit of speed continue from the previous frame, so call this
        once per frame, in order. `face` may also be the name of a built-in rig, such as "arkit".
        """
        return (Rig.builtin(face) if isinstance(face, str) else face).apply(self.faps, visemes=self.visemes)


class Latency(NamedTuple):
    """What has been pushed to a stream and not yet delivered (``labial_latency_t``)."""

    frames: int  #: pushed and not yet delivered
    milliseconds: int  #: the same as time
    phonemes: int  #: pushed, with frames that are not yet accepted
    delay: int  #: frames from accepting a frame to delivering it


class Stream(Closing):
    """A mouth that speaks and laughs: converts pushed phonemes to frames.

        with labial.Stream() as stream:
            stream.push("HH", 70)
            stream.push("AY", 230)
            stream.end()
            for frame in stream:
                show(frame)

    Any number of phonemes can be pushed ahead: those that do not fit into the C library's queue wait here. Iterating
    yields frames as far as the phonemes go; iterate again after pushing more. :meth:`tick` is for programs that follow
    a clock. The first frames lead from the neutral face to the motion; after :meth:`end` the face comes to rest in 12
    more frames than the phonemes have, unless it rests already.

    Calls from several threads wait for each other. A call within a call of the same stream, such as by a signal handler
    that interrupts one, raises StreamError and changes nothing. After a fork the child has a copy of the stream; if
    another thread was in a call on it, all calls of the copy but :meth:`close` raise StreamError.

    Args:
        model: the model of the first pushes; ``labial.speech_en`` without it.
        laughter: the model of :meth:`laugh`; ``labial.laughter_synthetic`` without it.
        labels: the set of phoneme labels: "auto", "arpabet", "ipa" or "xsampa". nearest: unknown labels move like the
        nearest known ones, instead of raising StreamError.
        exact: only the frames of the phonemes: the face stays as the last one leaves it, and where phonemes are late.
    """

    _what = "stream"

    def __init__(self, model: Optional[Model] = None, *, laughter: Optional[Model] = None, labels: str = "auto",
                 nearest: bool = False, exact: bool = False) -> None:
        super().__init__()
        first = expected(bundled("speech_en") if model is None else model)
        self._laughter = expected(bundled("laughter_synthetic") if laughter is None else laughter)
        set_of(labels)
        self._labels, self._nearest = labels, bool(nearest)
        self._models: List[Model] = []
        self._items = array("I")
        self._owed = 0.0  # remainder of rounding, milliseconds, -.5 to .5
        self._laughs = 0
        self._ended = self._done = False
        self._used = self._fed = 0  # items that the library has, and the place of the last one's model
        self._told = False  # whether the library knows that no more phonemes will come
        self._number = -1  # of the frame that was delivered last
        self._starved = False
        self._faps = (ctypes.c_int16 * 13)()
        self._place_of_faps = ctypes.addressof(self._faps)
        self._library = library()
        self._memory = memory(self._library.mouth_size())
        self._address = ctypes.addressof(self._memory)
        self._current = self._place(first)
        checked(self._library.mouth_init(self._address, first.address), first.name)
        self._exact = False
        self.exact = exact

    # ---- Input

    @alone
    def push(self, phoneme: Union[str, int], milliseconds: float) -> None:
        """Appends a phoneme, by its label or its number in the current model, that lasts 0 to 3,600,000 ms.

        Fractions of a millisecond carry over to the next phoneme. Raises StreamError for an unknown label, a number or
        a duration out of range, and after :meth:`end` or :meth:`cancel`; TypeError for other types.
        """
        self._open(pushing=True)
        found = self._models[self._current].number(phoneme, self._labels, self._nearest)
        self._owed += duration(milliseconds)
        length = min(max(math.floor(self._owed + 0.5), 0), DURATION_MAX)
        self._owed -= length
        self._items.extend((self._current, found, length))

    @alone
    def laugh(self, seconds: float, intensity: float = 0.5, seed: Optional[int] = None) -> None:
        """Appends a laugh of 0 to 3600 seconds, from a hum (`intensity` 0) to a wide open mouth (1). The current model
        stays. The same `seed`, 0 to 2**32 - 1, gives the same laugh; without one every laugh of a stream is
        different."""
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
        laugh, found = memory(self._library.laugh_size()), (ctypes.c_uint32 * 2)()
        checked(self._library.laugh_init(laugh, length, math.floor(loudness * LAUGH_FULL + 0.5), chosen))
        items = array("I")
        while self._library.laugh_next(laugh, found) == OK:
            items.extend((place, *found))
        self._items += items
        self._laughs += 1

    @opened
    def use(self, model: Model) -> None:
        """Selects `model`, speech or laughter, for the next pushes; the motion fades over 8 frames, that of lips
        over fewer to a contact. Raises StreamError if its frame rate or search stride is not the stream's."""
        self._current = self._place(expected(model))

    @opened
    def end(self) -> None:
        """No more phonemes will come: after the frames of the last one the face comes to rest."""
        self._ended = True

    @opened
    def cancel(self, milliseconds: float = 200) -> None:
        """Drops everything that is not yet delivered, and eases back to the neutral face over so many milliseconds,
        rounded up to whole frames, 1 to 1,000; then the stream is done."""
        length = math.ceil(duration(milliseconds))
        checked(self._library.mouth_cancel(self._address, length))
        self._forget_items()
        self._ended, self._done, self._told = True, False, True

    @opened
    def restart(self) -> None:
        """Continues a stream that has ended or was cancelled: frame numbers continue, and frames fade in from the last
        one. Raises StreamError while frames of phonemes are still to come."""
        if self._waiting():
            raise failure(ERROR_STATE, "restart")
        self._feed()
        checked(self._library.mouth_restart(self._address), "restart")
        self._forget_items()
        self._ended = self._done = self._told = False

    @opened
    def articulation(self, percent: float) -> None:
        """How far the mouth moves, 0 to 200 percent of what the models learned, rounded to whole ones: 100 at first,
        50 a mumble, 130 a shout. Lips still meet in p, b, m. It may change at any time: frames that are taken in from
        now on come nearer to it by up to 10 percent each. A cancel or a restart keeps it. Raises LabialError for a
        number out of range."""
        checked(self._library.mouth_articulation(self._address, articulation(percent)))

    # ---- Output

    def __iter__(self) -> Stream:
        return self

    @opened
    def __next__(self) -> Frame:
        if self._run(self._place_of_faps, 1):
            return Frame(self._number, tuple(self._faps), self._visemes())
        raise StopIteration

    @opened
    def tick(self) -> Optional[Frame]:
        """The next frame or None, once per frame period: None before the first frame (``latency.delay`` ticks), while
        the stream waits for phonemes, and when it is done. After a wait, catch up by an extra call for each tick that
        was :attr:`starved`.

        After five ticks without a frame or a push the face comes to rest in twelve more, unless the stream is exact:
        these return frames with the number of the missing frame, which it then has itself.
        """
        self._feed()
        result = checked(self._library.mouth_tick(self._address))
        self._done, self._starved = result == DONE, result == STARVED
        self._number += result == OK
        if not self._library.mouth_moved(self._address):
            return None
        return Frame(self._number + (result != OK), tuple(self._library.mouth_faps(self._address)[:13]),
                     self._visemes())

    @opened
    def drain(self, visemes: Optional[bytearray] = None) -> array[int]:
        """All frames that can be computed now, in one call of C: T times 13 int16, FAP units. The 15 shares of the
        sounds of each (:attr:`Frame.visemes`) are appended to `visemes`. ``labial.render`` makes frames of them."""
        pieces, piece = array("h"), array("h", bytes(2 * 13 * _PIECE))
        shares = array("B", bytes(0 if visemes is None else VISEMES * _PIECE))
        while count := self._run(piece.buffer_info()[0], _PIECE, shares.buffer_info()[0] if shares else None):
            pieces += piece[: 13 * count]
            if visemes is not None:
                visemes += shares[: VISEMES * count].tobytes()
        return pieces

    @property
    def done(self) -> bool:
        """Whether the stream has ended and every frame was delivered, as of the last call for a frame."""
        return self._done

    @property
    def exact(self) -> bool:
        """Whether the stream has only the frames of its phonemes; may be set at any time, for later frames."""
        return self._exact

    @exact.setter
    @opened
    def exact(self, exact: bool) -> None:
        checked(self._library.mouth_exact(self._address, bool(exact)))
        self._exact = bool(exact)

    @property
    def starved(self) -> bool:
        """Whether the last :meth:`tick` waited for phonemes, after the first frame."""
        return self._starved

    @property
    @opened
    def latency(self) -> Latency:
        """The stream's current latency."""
        self._feed()
        core, at = self._library, self._address
        later = sum(self._items[_ITEM * self._used + 2::_ITEM])
        return Latency(core.mouth_held(at) + (later * self.fps + 500) // 1000, core.mouth_milliseconds(at) + later,
                       core.mouth_waiting(at) + self._waiting(), core.mouth_delay(at))

    @property
    def fps(self) -> int:
        """Frames per second."""
        return self._models[0].fps

    # ---- With the lock held

    def _free(self) -> None:
        super()._free()
        self._forget_items()

    def _open(self, pushing: bool = False) -> None:
        super()._open()
        if pushing and self._ended:
            raise failure(ERROR_STATE)

    def _place(self, model: Model) -> int:
        """The index of `model` among the stream's models; appends a new one."""
        if model in self._models:
            return self._models.index(model)
        if self._models and (model.fps, model.stride) != (self._models[0].fps, self._models[0].stride):
            raise failure(ERROR_FRAME_RATE, model.name)
        self._models.append(model)
        return len(self._models) - 1

    def _waiting(self) -> int:
        """Phonemes that have not been passed to the library yet."""
        return len(self._items) // _ITEM - self._used

    def _forget_items(self) -> None:
        self._items = array("I")
        self._owed = 0.0
        self._used = 0

    def _feed(self) -> bool:
        """Pushes items while there is room for them; returns whether any was pushed."""
        core, items = self._library, self._items
        before, count = self._used, len(items) // _ITEM
        while self._used < count and core.mouth_room(self._address) > 0:
            place, phoneme, milliseconds = items[_ITEM * self._used : _ITEM * self._used + _ITEM]
            if place != self._fed:
                checked(core.mouth_use(self._address, self._models[place].address))
                self._fed = place
            checked(core.mouth_push(self._address, phoneme, milliseconds))
            self._used += 1
        fed = self._used > before
        if self._ended and self._used == count and not self._told:
            checked(core.mouth_end(self._address))
            self._told = True
        if self._used >= _FORGET:
            del items[: _ITEM * self._used]
            self._used = 0
        return fed

    def _visemes(self) -> Tuple[int, ...]:
        """The shares of the frame that was delivered last."""
        return tuple(self._library.mouth_visemes(self._address)[:VISEMES])

    def _run(self, frames: int, most: int, shares: Optional[int] = None) -> int:
        """Writes the next frames, at most so many, to an address, and their shares to another; returns their number, 0
        if the stream waits."""
        while True:
            fed = self._feed()
            count = checked(self._library.mouth_run(self._address, frames, shares, most))
            if count or not fed:
                self._number += count
                self._done = not count and self._library.mouth_state(self._address) == DONE
                return count
