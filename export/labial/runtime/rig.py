"""Rigs of the run-time: a description (docs/servos.md) as a table of the C library, applied frame by frame."""

from __future__ import annotations

import ctypes
import os
from array import array
from collections import deque
from functools import cache
from itertools import chain
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Protocol, Sequence, Tuple, Union

from labial.core.guard import Guard, alone
from labial.core.library import VISEMES, checked, library, memory
from labial.errors import LabialError, PathLike
from labial.files.faps import CHANNELS
from labial.rig import FACES, description_of

if TYPE_CHECKING:
    from labial.rig.description import Rig as Description


class HasFaps(Protocol):
    """A frame, such as :class:`labial.Frame`; it may have the shares of its sounds as `visemes`, too."""

    @property
    def faps(self) -> Sequence[int]:
        """Its 13 FAPs."""


#: A frame of a stream or of hearing, or its 13 FAPs.
Faps = Union[HasFaps, Iterable[int]]
#: Value of each output by name: an int, or a float where the unit is weight.
Values = Dict[str, Union[int, float]]


def _whole_faps(faps: Iterable[int]) -> array[int]:
    try:
        return array("h", faps)
    except OverflowError:
        raise LabialError("a FAP is beyond 16 bits") from None
    except TypeError:
        raise TypeError("FAPs are whole numbers") from None


def faps_of(frame: Any) -> Iterable[Any]:
    """The FAPs of a frame, or of what is its FAPs."""
    found: Iterable[Any] = getattr(frame, "faps", frame)
    return found


def one_frame(frame: Faps) -> array[int]:
    """The 13 FAPs of a frame as 16-bit integers. Raises LabialError for others than 13, and for FAPs beyond that."""
    numbers = _whole_faps(faps_of(frame))
    if len(numbers) != CHANNELS:
        raise LabialError(f"a frame has {CHANNELS} FAPs, not {len(numbers)}")
    return numbers


def shares_of(frame: Any) -> bytes:
    """The 15 shares of a frame's sounds; zeros if unknown. Raises LabialError for others than 15."""
    return _shares(getattr(frame, "visemes", ())) or bytes(VISEMES)


def _shares(visemes: Iterable[int]) -> bytes:
    shares = bytes(visemes)
    if len(shares) not in (0, VISEMES):
        raise LabialError(f"a frame has {VISEMES} shares of sounds, not {len(shares)}")
    return shares


def _frames_after(following: Iterable[Union[int, Faps]]) -> Tuple[array[int], bytes]:
    """The FAPs of frames, or FAPs that are one after the other already, in one row; and the shares of their sounds."""
    items: List[Any] = list(following)
    if items and isinstance(faps_of(items[0]), Iterable):
        return array("h", chain.from_iterable(map(one_frame, items))), b"".join(map(shares_of, items))
    return _whole_faps(items), bytes(len(items) // CHANNELS * VISEMES)


class Rig:
    """A rig of one face: servos, blendshapes, or features of a drawn mouth.

    ``Rig("face.toml")`` reads a description, ``Rig("arkit")`` uses a built-in one; ``Rig.BUILTIN`` lists their names.
    The values are those of ``labial_rig_apply_ahead()``, bit for bit, with weights divided by 1,000. A rig stores the
    last frame's values and their changes, from which outputs with limits of speed and acceleration continue: use a
    separate rig for each face. Raises DataError, which names the file and the key, for errors in a description.

    Attributes:
        name: the description's name without its suffix.
        outputs: names of the outputs.
        unit: the unit of the values: us, quarter_us, pca9685, counts or plain, all integers, or weight, whose values
        are floats from 0 to 1 in steps of a thousandth. prescale: the value for the PCA9685's prescale register, if the
        unit is its ticks; else None. limits: the least and the greatest value of each output, in the unit's whole
        numbers. resting: the value of each output of the face at rest, likewise. values: current value of each output,
        by name; the face at rest before the first frame.
    """

    BUILTIN: Tuple[str, ...] = FACES

    def __init__(self, description: PathLike) -> None:
        from labial.rig.description import read  # with a TOML parser, which older Pythons lack

        path = Path(description)
        if isinstance(description, str) and description in self.BUILTIN:
            path = description_of(description)
        self._lay_out(read(path, path.stem))

    @classmethod
    def of(cls, description: Description) -> Rig:
        """The rig of a description that was read."""
        rig = cls.__new__(cls)
        rig._lay_out(description)
        return rig

    def _lay_out(self, rig: Description) -> None:
        from labial.rig.table import SEGMENTS, convert

        rows = convert(rig)
        self.name, self.unit, self.prescale = rig.name, rig.unit.name, rig.unit.prescale
        self.outputs = tuple(row.name for row in rows)
        self.limits = tuple((row.minimum, row.maximum) for row in rows)
        self.resting = tuple(row.rest for row in rows)
        core = library()
        size, curve = core.rig_output_size(), core.rig_curve_size()
        self._rows = memory((size + curve) * len(rows))  # the outputs, then their curves
        self._table = ctypes.addressof(self._rows), len(rows)
        at, most = self._table[0], CHANNELS + 12 + 3 * SEGMENTS + VISEMES  # numbers of an output, FLAT_OUTPUT
        for place, row in enumerate(rows):
            numbers = [*row.weights, row.gain, row.neutral, row.minimum, row.maximum, row.invert,
                       row.closed is not None, row.closed or 0, row.slew, row.deadband, row.acceleration,
                       len(row.curve or ()), *chain.from_iterable(row.curve or ())]
            numbers += [0] * (most - 1 - VISEMES - len(numbers)) + [len(row.visemes) > 0, *row.visemes]
            core.rig_output(at + size * place, at + size * len(rows) + curve * place,
                            (ctypes.c_int32 * most)(*map(int, numbers)))
        checked(core.rig_check(*self._table), os.fspath(rig.path))
        self._values, self._changes = (ctypes.c_int32 * len(rows))(), (ctypes.c_int32 * len(rows))()
        self._apply = core.rig_apply
        self._guard = Guard(whole=True)  # held from updating the values until they are read
        self.rest()

    @classmethod
    @cache
    def builtin(cls, name: str) -> Rig:
        """A cached built-in rig: these have no limits of speed, and so no state."""
        if name not in cls.BUILTIN:
            raise LabialError(f"no built-in rig is called {name!r}, there are {', '.join(cls.BUILTIN)}; "
                              f'labial.Rig("FACE.toml") reads a description')
        return cls(name)

    @property
    def values(self) -> Values:
        """Current value of each output, by name."""
        return self._named(self._values)

    def _named(self, values: Iterable[int]) -> Values:
        """Whole numbers of the unit, one for each output, as its values by name."""
        scale = 1000 if self.unit == "weight" else 0
        return {name: value / scale if scale else value for name, value in zip(self.outputs, values)}

    @alone
    def rest(self) -> Values:
        """Resets the face to rest; returns its values."""
        checked(library().rig_rest(*self._table, self._values))
        ctypes.memset(self._changes, 0, ctypes.sizeof(self._changes))
        return self.values

    def apply(self, faps: Faps, following: Iterable[Union[int, Faps]] = (), *, visemes: Iterable[int] = ()) -> Values:
        """Applies one frame, or its 13 FAPs, integers of 16 bits; returns the values. `following` are the frames after
        it, or their FAPs in one list: with them a servo with a `closed` position starts early enough to be closed in p,
        b, m (``labial_rig_apply_ahead``); `ahead()` stores them for a stream. Outputs that follow sounds show a tongue,
        teeth and pressed lips, too, where frames bring the shares of their sounds, as those of a stream and of hearing
        do; `visemes` are those of 13 FAPs, ``Frame.visemes``."""
        numbers, (ahead, after) = one_frame(faps), _frames_after(following)
        if len(ahead) % CHANNELS or len(ahead) > CHANNELS * 65534:
            raise LabialError(f"frames that follow have {CHANNELS} FAPs each, at most 65,534 frames, not {len(ahead)} "
                              "numbers in all")
        return self._moved(numbers + ahead, (_shares(visemes) or shares_of(faps)) + after)

    def ahead(self, frames: Iterable[Faps], count: int) -> Iterator[Values]:
        """Applies the frames of a stream, each when the `count` frames after it have come: the face is late by as many.
        Yields the values of each frame; those of the last ones when the frames end."""
        if not 0 <= count < 65535:
            raise LabialError(f"a face looks 0 to 65,534 frames ahead, not {count}")
        waiting: deque[Any] = deque()  # copies
        for frame in frames:
            waiting.append(SimpleNamespace(faps=one_frame(frame), visemes=shares_of(frame)))
            if len(waiting) > count:
                yield self.apply(waiting.popleft(), waiting)
        while waiting:
            yield self.apply(waiting.popleft(), waiting)

    @alone
    def play(self, faps: array[int], sight: int, shares: Union[bytes, bytearray, None] = None) -> array[int]:
        """Moves the face by T frames of 13 FAPs, 16 bits each, one after the other, each with up to `sight` frames in
        sight, itself included, 1 .. 65535: T times N numbers of 32 bits, all outputs of each frame in the unit's whole
        numbers. `shares` are 15 of the sounds of each frame, if you have them."""
        first, count = faps.buffer_info()[0], len(faps) // CHANNELS
        known = array("B", shares or b"")
        at = known.buffer_info()[0]
        found = array("i")
        for frame in range(count):
            place = first + frame * CHANNELS * faps.itemsize
            sounds = at + frame * VISEMES if shares else None
            checked(self._apply(*self._table, place, sounds, min(sight, count - frame), self._values, self._changes))
            found.extend(self._values)
        return found

    @alone
    def _moved(self, numbers: array[int], shares: bytes) -> Values:
        checked(self._apply(*self._table, numbers.buffer_info()[0], shares, len(numbers) // CHANNELS, self._values,
                            self._changes))
        return self.values

    def __repr__(self) -> str:
        return f"<labial.Rig {self.name}: {', '.join(self.outputs)}>"
