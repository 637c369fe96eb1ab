"""Rigs for the run-time: a description (docs/servos.md) as a table of the C library, applied frame by frame."""

from __future__ import annotations

import ctypes
import os
from array import array
from functools import cache
from pathlib import Path
from typing import Dict, Iterable, Tuple, Union

from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.rig import FACES, description_of
from labial.runtime.guard import Guard, alone
from labial.runtime.library import RigOutput, RigTable, checked, library


class Rig:
    """What moves one face: servos, blendshapes, features of a drawn mouth.

    ``Rig("face.toml")`` reads a description, ``Rig("arkit")`` takes a built-in one; ``Rig.BUILTIN`` names those. The
    values are those of ``labial_rig_apply()``, bit for bit. A rig remembers the last frame's values, from which outputs
    with a limit of speed go on: each face has a rig of its own. Raises DataError, which names the
    file and the key, for what is wrong in a description.

    Attributes:
        name: the description's name without its suffix.
        outputs: names of the outputs.
        unit: what the values count: us, quarter_us, pca9685, counts, weight (thousandths) or plain.
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
        self._table = RigTable(self._rows, len(rows))
        checked(library().labial_rig_check(self._table), os.fspath(path))
        self._values = (ctypes.c_int32 * len(rows))()
        self._apply = library().labial_rig_apply
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
    def values(self) -> Dict[str, int]:
        """Value of each output now, by name."""
        return dict(zip(self.outputs, self._values))

    @alone
    def rest(self) -> Dict[str, int]:
        """Puts the face at rest; its values."""
        checked(library().labial_rig_rest(self._table, self._values))
        return self.values

    def apply(self, faps: Iterable[int]) -> Dict[str, int]:
        """Moves the face on by one frame of 13 FAPs, whole numbers of 16 bits; its values."""
        try:
            numbers = array("h", faps)
        except OverflowError:
            raise LabialError("a FAP is beyond 16 bits") from None
        except TypeError:
            raise TypeError("FAPs are whole numbers") from None
        if len(numbers) != CHANNELS:
            raise LabialError(f"a frame has {CHANNELS} FAPs, not {len(numbers)}")
        return self._moved(numbers)

    @alone
    def _moved(self, numbers: array) -> Dict[str, int]:
        checked(self._apply(self._table, numbers.buffer_info()[0], self._values))
        return self.values

    def __repr__(self) -> str:
        return f"<labial.Rig {self.name}: {', '.join(self.outputs)}>"
