"""Rigs for the run-time: a description (docs/servos.md) as a table of the C library, applied frame by frame."""

from __future__ import annotations

import ctypes
import os
from array import array
from collections import deque
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Deque, Dict, Iterable, Iterator, List, Tuple, Union

from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.rig import FACES, description_of
from labial.runtime.guard import Guard, alone
from labial.runtime.library import RigCurve, RigOutput, RigTable, checked, library

#: Value of each output by name: an int, or a float where the unit is weight.
Values = Dict[str, Union[int, float]]


class Rig:
    """What moves one face: servos, blendshapes, features of a drawn mouth.

    ``Rig("face.toml")`` reads a description, ``Rig("arkit")`` takes a built-in one; ``Rig.BUILTIN`` names those. The
    values are those of ``labial_rig_apply_ahead()``, bit for bit, weights divided by 1,000. A rig remembers the last
    frame's values and how they changed, from which outputs with limits of speed and acceleration go on: each face has a
    rig of its own. Raises DataError, which names the file and the key, for what is wrong in a description.

    Attributes:
        name: the description's name without its suffix.
        outputs: names of the outputs.
        unit: what the values count: us, quarter_us, pca9685, counts or plain, all of them whole numbers, or weight,
            whose values are floats from 0 to 1 in steps of a thousandth.
        prescale: what the PCA9685's prescale register must hold, where the unit is its ticks; else None.
        values: value of each output now, by name; the face at rest before the first frame.
    """

    BUILTIN: Tuple[str, ...] = FACES

    def __init__(self, description: Union[str, os.PathLike]) -> None:
        from labial.rig.description import read  # with a TOML parser, which older Pythons lack
        from labial.rig.table import convert

        path = Path(description)
        if isinstance(description, str) and description in self.BUILTIN:
            path = description_of(description)
        rig = read(path, path.stem)
        rows = convert(rig)
        self.name, self.unit, self.prescale = rig.name, rig.unit.name, rig.unit.prescale
        self.outputs = tuple(row.name for row in rows)
        if ctypes.sizeof(RigOutput) != library().labial_python_output_size():
            raise LabialError("the library's rigs are laid out in another way than this package knows")
        self._rows = (RigOutput * len(rows))()
        for place, row in zip(self._rows, rows):
            place.weights[:] = row.weights
            place.invert, place.gain, place.neutral = row.invert, row.gain, row.neutral
            place.minimum, place.maximum, place.slew = row.minimum, row.maximum, row.slew
            place.contact, place.closed, place.deadband = row.closed is not None, row.closed or 0, row.deadband
            place.acceleration = row.acceleration
            if row.curve:
                curve = RigCurve(len(row.curve))
                for segment, numbers in zip(curve.segments, row.curve):
                    segment.first, segment.to, segment.slope = numbers
                place.curve = ctypes.pointer(curve)  # which keeps it alive
        self._table = RigTable(self._rows, len(rows))
        checked(library().labial_rig_check(self._table), os.fspath(path))
        self._values, self._changes = (ctypes.c_int32 * len(rows))(), (ctypes.c_int32 * len(rows))()
        self._apply = library().labial_rig_apply_ahead
        self._guard = Guard(whole=True)  # from moving the values until they are read
        self.rest()

    @classmethod
    @cache
    def builtin(cls, name: str) -> Rig:
        """A built-in rig that is kept: right for rigs without limits of speed, which have no memory."""
        if name not in cls.BUILTIN:
            raise LabialError(f"no built-in rig is called {name!r}, there are {', '.join(cls.BUILTIN)}; "
                              f'labial.Rig("FACE.toml") reads a description')
        return cls(name)

    @property
    def values(self) -> Values:
        """Value of each output now, by name."""
        if self.unit == "weight":
            return {name: value / 1000 for name, value in zip(self.outputs, self._values)}
        return dict(zip(self.outputs, self._values))

    @alone
    def rest(self) -> Values:
        """Puts the face at rest; its values."""
        checked(library().labial_rig_rest(self._table, self._values))
        ctypes.memset(self._changes, 0, ctypes.sizeof(self._changes))
        return self.values

    def apply(self, faps: Iterable[int], following: Iterable[int] = ()) -> Values:
        """Moves the face on by one frame of 13 FAPs, whole numbers of 16 bits; its values. `following` are the FAPs of
        frames that come after it, one frame after the other: with them a servo that says where it is closed sets out
        early enough to be closed in p, b, m (``labial_rig_apply_ahead``); `ahead()` keeps them for a stream."""
        try:
            numbers = array("h", faps)
            ahead = array("h", following)
        except OverflowError:
            raise LabialError("a FAP is beyond 16 bits") from None
        except TypeError:
            raise TypeError("FAPs are whole numbers") from None
        if len(numbers) != CHANNELS:
            raise LabialError(f"a frame has {CHANNELS} FAPs, not {len(numbers)}")
        if len(ahead) % CHANNELS or len(ahead) > CHANNELS * 65534:
            raise LabialError(f"frames that follow have {CHANNELS} FAPs each, at most 65,534 frames, not {len(ahead)} "
                              "numbers in all")
        return self._moved(numbers + ahead)

    def ahead(self, frames: Iterable[Iterable[int]], count: int) -> Iterator[Values]:
        """Moves the face by the frames of a stream, each when the `count` that follow it are there: so it is late by as
        many. Gives the values of each frame; those of the last ones when the frames end."""
        if not 0 <= count < 65535:
            raise LabialError(f"a face looks 0 to 65,534 frames ahead, not {count}")
        waiting: Deque[List[int]] = deque()
        for frame in frames:
            waiting.append(list(frame))
            if len(waiting) > count:
                yield self.apply(waiting.popleft(), chain.from_iterable(waiting))
        while waiting:
            yield self.apply(waiting.popleft(), chain.from_iterable(waiting))

    @alone
    def _moved(self, numbers: array) -> Values:
        checked(self._apply(self._table, numbers.buffer_info()[0], len(numbers) // CHANNELS, self._values,
                            self._changes))
        return self.values

    def __repr__(self) -> str:
        return f"<labial.Rig {self.name}: {', '.join(self.outputs)}>"
