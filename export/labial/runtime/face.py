"""Faces whose servos are always safe (``include/labial/face.h``; docs/servos.md)."""

from __future__ import annotations

import ctypes
import math
from typing import Mapping, Tuple, Union

from labial.core.guard import Guard, alone, duration, number, whole
from labial.core.library import DONE, checked, library, memory
from labial.errors import LabialError, PathLike
from labial.runtime.rig import Faps, Rig, Values, one_frame, shares_of

#: LABIAL_FACE_AHEAD_MAX.
AHEAD_MAX = 1000


class Face:
    """The servos of a rig, moved by frames of any source: a stream, hearing, or values that were sent.

        face = labial.Face("face.toml", ahead=10)
        while not done or not face.rests:  # every 20 ms
            face.frame(frame)              # when there is one
            set_servos(face.tick())

    No value changes by more than its `slew` from one tick to the next, nor its change by more than its `acceleration`.
    A face shows one frame in each tick, `ahead` ticks after it came; of more than `ahead` + 1 that wait, the oldest are
    passed over. Without a frame the servos hold for 5 ticks and go to rest in 6 more, or as their limits allow.

    Args:
        rig: a :class:`labial.Rig`, the path of a description, or the name of a built-in rig. Its own state is not used.
        ahead: later frames that a frame waits for, 0 to 1,000: slow servos need them to close in time.

    Attributes:
        rig: the rig.
    """

    def __init__(self, rig: Union[Rig, PathLike], *, ahead: int = 0) -> None:
        self.rig = rig if isinstance(rig, Rig) else Rig(rig)
        ahead = whole(ahead, "a number of frames")
        if not 0 <= ahead <= AHEAD_MAX:
            raise LabialError(f"a face looks 0 to {AHEAD_MAX:,} frames ahead, not {ahead}")
        self._library = library()
        self._memory = memory(self._library.servos_size(len(self.rig.outputs), ahead))
        self._address = ctypes.addressof(self._memory)
        checked(self._library.servos_init(self._address, *self.rig._table, ahead), self.rig.name)
        self._values = (ctypes.c_int32 * len(self.rig.outputs))()
        self._result = DONE
        self._guard = Guard(whole=True)

    @property
    def rests(self) -> bool:
        """Whether all servos have come to rest and no frame waits, as of the last tick; true before the first one."""
        return self._result == DONE

    @property
    def attached(self) -> Tuple[str, ...]:
        """The outputs that may be attached: all of them, unless a soft start has not reached the last one."""
        return self.rig.outputs[:self._library.servos_attached(self._address)]

    @alone
    def frame(self, frame: Faps) -> None:
        """Takes a frame of a stream, of hearing or of :func:`labial.render`; or its 13 FAPs, integers of 16 bits, which
        do not move outputs that follow sounds."""
        numbers = one_frame(frame)  # which must outlive the call
        checked(self._library.servos_frame(self._address, numbers.buffer_info()[0], shares_of(frame)), "frame")
        self._result = min(self._result, DONE - 1)

    @alone
    def values(self, wanted: Mapping[str, float]) -> None:
        """Takes a frame as values of the outputs: one for each, by name, in the rig's unit. They go through the same
        limits."""
        numbers = self._numbers(wanted)
        checked(self._library.servos_values(self._address, numbers), "values")
        self._result = min(self._result, DONE - 1)

    @alone
    def tick(self) -> Values:
        """Moves the servos by one tick, 20 ms; returns the value of each output, by name."""
        self._result = checked(self._library.servos_tick(self._address, self._values), "tick")
        return self.rig._named(self._values)

    @alone
    def play(self) -> None:
        """Shows the frames that wait from the next tick on, without waiting for those that follow."""
        checked(self._library.servos_play(self._address), "play")

    @alone
    def skip(self, count: int = 1) -> None:
        """Passes over the next `count` frames, or as many as wait, whose time went by without a tick."""
        count = max(0, min(whole(count, "a number of frames"), AHEAD_MAX + 1))
        checked(self._library.servos_skip(self._address, count), "skip")

    @alone
    def cancel(self, milliseconds: float = 200) -> None:
        """Drops the frames that wait, where the sound stops; the servos go to rest over so many milliseconds, rounded
        up to whole frames, 1 to 1,000, or as their limits allow."""
        length = math.ceil(duration(milliseconds))
        checked(self._library.servos_cancel(self._address, length), "cancel")

    @alone
    def soft_start(self, ticks: int = 25) -> None:
        """Begins a soft start, after power-up: output k may be attached from tick k * `ticks` on, stays at rest, and
        follows frames from tick (k + 1) * `ticks` on; `ticks` is 1 to 255."""
        ticks = whole(ticks, "a number of ticks")
        if not 1 <= ticks <= 255:
            raise LabialError(f"a soft start takes 1 to 255 ticks for each output, not {ticks}")
        checked(self._library.servos_soft_start(self._address, ticks), "soft_start")

    @alone
    def place(self, values: Mapping[str, float]) -> None:
        """Says where all servos stand still, by name: they move on from there within their limits."""
        checked(self._library.servos_place(self._address, self._numbers(values)), "place")
        self._result = min(self._result, DONE - 1)

    def _numbers(self, values: Mapping[str, float]) -> ctypes.Array[ctypes.c_int32]:
        if set(values) != set(self.rig.outputs):
            raise LabialError(f"{self.rig.name} has the outputs {', '.join(self.rig.outputs)}, not "
                              f"{', '.join(map(str, values)) or 'none'}")
        scale, most = 1000 if self.rig.unit == "weight" else 1, 1 << 30
        found = (ctypes.c_int32 * len(values))()
        for place, name in enumerate(self.rig.outputs):
            value = number(values[name], f"the value of {name}")
            if math.isnan(value):
                raise LabialError(f"the value of {name} is not a number")
            found[place] = round(max(-most, min(scale * value, most)))
        return found

    def __repr__(self) -> str:
        return f"<labial.Face {self.rig.name}: {', '.join(self.rig.outputs)}>"
