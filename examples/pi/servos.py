"""Servos on a PCA9685 on the I2C bus, or a printed line for each frame without one."""

from __future__ import annotations

import sys
import time
from typing import Any, Dict, Optional, TextIO

import labial
from labial.errors import LabialError, apt, missing


class Printer:
    """Prints the time in milliseconds and the values of each frame."""

    def __init__(self, out: Optional[TextIO] = None) -> None:
        self._out = out or sys.stdout

    def start(self, face: labial.Face) -> None:
        """Does nothing."""

    def show(self, milliseconds: int, values: Dict[str, int]) -> None:
        """Shows one frame."""
        line = " ".join(f"{name} {value}" for name, value in values.items())
        print(f"{milliseconds:6d} ms: {line}", file=self._out)

    def close(self) -> None:
        """Does nothing."""


class PCA9685:
    """The servos of a rig whose unit is pca9685, on the channels 0, 1, ... in the order of its outputs."""

    MODE1, FIRST_CHANNEL, ALL_OFF_HIGH, PRESCALE = 0x00, 0x06, 0xFD, 0xFE
    ASLEEP, AWAKE, FULLY_OFF = 0x10, 0x20, 0x10  # awake: registers follow one another

    def __init__(self, rig: labial.Rig, bus: Any, address: int = 0x40) -> None:
        if rig.unit != "pca9685":
            raise LabialError(f'{rig.name} is made for {rig.unit}: write unit = "pca9685" in its description')
        self._bus, self._address = bus, address
        bus.write_byte_data(address, self.MODE1, self.ASLEEP)  # the prescaler can only be set asleep
        bus.write_byte_data(address, self.PRESCALE, rig.prescale)
        bus.write_byte_data(address, self.MODE1, self.AWAKE)
        time.sleep(0.001)

    def start(self, face: labial.Face) -> None:
        """Attaches the servos at rest, one after the other, half a second each: a channel has no pulses before its
        first value."""
        face.soft_start(25)
        for _ in range(25 * len(face.rig.outputs)):
            values = face.tick()
            self.show(0, {name: values[name] for name in face.attached})
            time.sleep(0.02)

    def show(self, milliseconds: int, values: Dict[str, int]) -> None:
        """Shows one frame, of the first servos or of all: each pulse begins at 0 and ends at its tick."""
        for channel, ticks in enumerate(values.values()):
            self._bus.write_i2c_block_data(self._address, self.FIRST_CHANNEL + 4 * channel,
                                           [0, 0, ticks & 0xFF, ticks >> 8])

    def close(self) -> None:
        """Stops all pulses, so that the servos neither hum nor hold."""
        self._bus.write_byte_data(self._address, self.ALL_OFF_HIGH, self.FULLY_OFF)


def open_servos(rig: labial.Rig, bus: int = 1) -> Any:
    """The PCA9685 on /dev/i2c-`bus`; else a :class:`Printer`, and a message that says why."""
    try:
        from smbus2 import SMBus

        return PCA9685(rig, SMBus(bus))
    except ImportError:
        why = missing("a PCA9685", "smbus2", apt("python3-smbus2"))
    except OSError as error:
        why = LabialError(f"no PCA9685 answers on I2C bus {bus} ({error})")
    print(f"{why}: the servos are printed", file=sys.stderr)
    return Printer()
