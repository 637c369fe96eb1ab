"""Units of a rig's outputs. Servos are described in microseconds; the tables contain the units of the hardware."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional

from labial.errors import LabialError

#: The PCA9685 divides its oscillator by its prescaler, and each period into 4096 ticks.
_PCA9685_OSCILLATOR, _PCA9685_TICKS = 25e6, 4096
_PCA9685_PRESCALE = (3, 255)


@dataclass(frozen=True)
class Unit:
    """The conversion of one microsecond (or weight, or plain unit) of the description to the tables."""

    name: str
    scale: float  #: table units per unit of the description
    servo: bool  #: whether values are pulses
    text: str  #: for comments
    limit: Optional[int] = None  #: largest value of the hardware
    prescale: Optional[int] = None  #: value of the PCA9685's prescale register


UNITS = ("us", "quarter_us", "pca9685", "counts", "weight", "plain")


def make_unit(name: str, parameter: float = 50.0) -> Unit:
    """The unit `name`; `parameter` is the update frequency, Hz, of pca9685 or the timer clock, Hz, of counts."""
    if name == "us":
        return Unit(name, 1.0, True, "microseconds")
    if name == "quarter_us":
        return Unit(name, 4.0, True, "quarter microseconds (Maestro)", 16383)
    if name == "pca9685":
        low, high = (_PCA9685_OSCILLATOR / _PCA9685_TICKS / (prescale + 1) for prescale in reversed(_PCA9685_PRESCALE))
        if not low <= parameter <= high:
            least, most = math.ceil(100 * low) / 100, math.floor(100 * high) / 100
            raise LabialError(f"{parameter:g} is not within {least:g} .. {most:g} Hz")
        # Uses the period that the register produces, not the requested one.
        prescale = round(_PCA9685_OSCILLATOR / (_PCA9685_TICKS * parameter)) - 1
        tick = (prescale + 1) / _PCA9685_OSCILLATOR * 1e6
        return Unit(name, 1.0 / tick, True, f"ticks of {tick:.2f} us (PCA9685 with prescale register {prescale}, "
                                            f"{1e6 / tick / _PCA9685_TICKS:.2f} Hz)", _PCA9685_TICKS - 1, prescale)
    if name == "counts":
        if not 1e4 <= parameter <= 1e9:
            raise LabialError(f"{parameter:g} is not within 1e4 .. 1e9 Hz")
        return Unit(name, parameter / 1e6, True, f"counts of a timer at {parameter:.15g} Hz")
    if name == "weight":
        return Unit(name, 1000.0, False, "weights, 1000 for 1", 1000)
    return Unit(name, 1.0, False, "plain units")
