"""Reads a rig's description, a TOML file such as ``examples/faces/jaw.toml``; docs/servos.md explains its keys.

Outputs have units, and inputs: the 13 FAPs by name, and a few named gestures. Servos are described in microseconds; the
tables contain the units of the hardware.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from labial.errors import LabialError, PathLike
from labial.files import limits
from labial.files.faps import CHANNELS, FAP_COLUMNS, FAP_NAMES
from labial.files.toml import Table, meant, read_toml
from labial.tables.visemes import VISEMES

#: Range of a servo's pulses, microseconds: wider than that of any common servo, narrow enough to detect typing errors.
PULSE_MIN, PULSE_MAX = 400.0, 2600.0
#: Default pulses at 0 and 180 degrees: those of Arduino's library Servo.
DEGREES = (544.0, 2400.0)
_PLACES = ("neutral", "full", "minimum", "maximum", "closed")

_TOP_KEYS = ("unit", "frequency", "clock", "pulses", "output")
_OUTPUT_KEYS = ("from", "neutral", "full", "reach", "gain", "minimum", "maximum", "invert", "slew", "closed",
                "deadband", "acceleration", "curve", "visemes")
#: Points of a linkage's curve.
CURVE_POINTS = (2, 9)
#: A weight or a value for each of the 13 channels. Not an array, since the run-time reads rigs without numpy.
Row = Tuple[float, ...]
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


_UNITS = {unit.name: unit for unit in (
    Unit("us", 1.0, True, "microseconds"), Unit("quarter_us", 4.0, True, "quarter microseconds (Maestro)", 16383),
    Unit("weight", 1000.0, False, "weights, 1000 for 1", 1000), Unit("plain", 1.0, False, "plain units"))}
UNITS = ("us", "quarter_us", "pca9685", "counts", "weight", "plain")


def make_unit(name: str, parameter: float = 50.0) -> Unit:
    """The unit `name`; `parameter` is the update frequency, Hz, of pca9685 or the timer clock, Hz, of counts."""
    if name in _UNITS:
        return _UNITS[name]
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
    if not 1e4 <= parameter <= 1e9:
        raise LabialError(f"{parameter:g} is not within 1e4 .. 1e9 Hz")
    return Unit(name, parameter / 1e6, True, f"counts of a timer at {parameter:.15g} Hz")


class Gesture(NamedTuple):
    """A weighted sum of FAPs, and how far it goes in ordinary speech and laughter."""

    weights: Row
    reach: Optional[float]  #: FAP units of the sum at its full extent; None without a usual one


def _weights(**named: float) -> Row:
    return tuple(float(named.get(name, 0.0)) for name in FAP_COLUMNS)


#: Named sums. The reaches are round numbers near the extremes of a spoken sentence and a laugh. The corners of a mouth
#: sink as its jaw opens; `smile` compensates for this, so that open vowels do not look sad.
GESTURES: Dict[str, Gesture] = {
    "opening": Gesture(_weights(fap51=-1, fap52=-1), 600.0),
    "jaw": Gesture(_weights(fap3=1), 400.0),
    "upper_lip": Gesture(_weights(fap51=-1), 90.0),
    "lower_lip": Gesture(_weights(fap52=-1), 560.0),
    "smile": Gesture(_weights(fap53=0.25, fap54=0.25, fap59=0.25, fap60=0.25, fap3=0.2), 120.0),
    "spread": Gesture(_weights(fap53=0.5, fap54=0.5), 100.0),
    "rounding": Gesture(_weights(fap17=1, fap53=-0.5, fap54=-0.5), 200.0),
}
#: All names for ``from``: gestures, MPEG-4's names of FAPs, columns of a frames file.
SOURCES: Mapping[str, Gesture] = {
    **{name: Gesture(_weights(**{column: 1.0}), None)
       for names in (FAP_NAMES, FAP_COLUMNS) for name, column in zip(names, FAP_COLUMNS)},
    **GESTURES,
}
#: Faces to draw a rig with, FAP units: an open vowel, a rounded one, a smile that shows the teeth, and lips pressed on
#: each other over a jaw that is half open, which shows whether a face can close in p, b, m.
POSES: Dict[str, Row] = {
    "mouth open": _weights(fap3=400, fap16=-240, fap52=-600, fap53=-15, fap54=-15, fap57=-490, fap58=-490, fap59=-120,
                           fap60=-120),
    "lips rounded": _weights(fap3=180, fap16=-100, fap17=150, fap51=50, fap52=-250, fap53=-55, fap54=-55, fap55=65,
                             fap56=65, fap57=-210, fap58=-210, fap59=-150, fap60=-150),
    "smile": _weights(fap3=40, fap16=-35, fap17=-35, fap51=-50, fap52=-30, fap53=105, fap54=105, fap55=-65, fap56=-65,
                      fap59=130, fap60=130),
    "lips closed": _weights(fap3=250, fap16=-130, fap51=85, fap52=-125, fap55=60, fap56=60, fap57=-105, fap58=-105,
                            fap59=-50, fap60=-50),
}


class Numbers(NamedTuple):
    """The numbers of a description: those in degrees are converted to microseconds, all others are values already."""

    degrees: bool = False
    start: float = 0.0  #: the value that 0 stands for
    each: float = 1.0  #: the difference in value that 1 stands for

    def value(self, number: float) -> float:
        """The value that a number of the description stands for."""
        return number * self.each + self.start

    def number(self, value: float) -> float:
        """The number that stands for a value."""
        return (value - self.start) / self.each


@dataclass(frozen=True)
class Output:
    """One output, in the unit of the description, but servos always in microseconds."""

    name: str
    weights: Row
    gain: float  #: units per FAP unit
    neutral: float
    minimum: float
    maximum: float
    invert: bool
    slew: float  #: units per frame; 0 for no limit
    given_gain: bool  #: whether the description has a gain, not a value at full extent
    closed: Optional[float] = None  #: the value where lips touch; None without it
    deadband: float = 0.0  #: units; smaller changes are skipped
    acceleration: float = 0.0  #: units per frame, per frame; 0 for no limit
    #: Curve of a linkage: values for an even linkage, and the values that have the same effect.
    curve: Tuple[Tuple[float, float], ...] = ()
    #: What a share of one of each of `labial.tables.visemes.VISEMES` adds; empty for an output of FAPs alone.
    visemes: Row = ()


@dataclass(frozen=True)
class Rig:
    """A valid description."""

    name: str
    unit: Unit
    outputs: Tuple[Output, ...]
    path: str
    numbers: Numbers = Numbers()


def read(path: PathLike, name: str) -> Rig:
    """The rig that the file describes, called `name`. Raises DataError naming the file and the line or key."""
    where = os.fspath(path)
    content = read_toml(path)
    top = Table(where, "", content, _TOP_KEYS)
    unit = _unit(top)
    numbers = _numbers(top)
    outputs: Any = content.get("output")
    top.refuse(not isinstance(outputs, dict) or not outputs, "output", "at least one table [output.NAME] is needed")
    limits.refuse(path, "it has", len(outputs), limits.OUTPUTS, "outputs")
    return Rig(name, unit, tuple(_output(where, key, table, unit, numbers) for key, table in _named(top, outputs)),
               where, numbers)


def _numbers(top: Table) -> Numbers:
    """The numbers of a description; of one in degrees with its pulses at 0 and 180 degrees."""
    if top.content.get("unit") != "degrees":
        top.refuse("pulses" in top.content, "pulses", "goes with the unit degrees")
        return Numbers()
    given = top.content.get("pulses", list(DEGREES))
    top.refuse(not isinstance(given, list) or len(given) != 2, "pulses",
               "is two pulses in microseconds, those at 0 and 180 degrees")
    low, high = (top.as_number("pulses", value) for value in given)
    top.refuse(not PULSE_MIN <= low < high <= PULSE_MAX, "pulses",
               f"{low:g}, {high:g} are not two pulses from {PULSE_MIN:g} to {PULSE_MAX:g}, the shorter one first")
    return Numbers(True, low, (high - low) / 180.0)


def _unit(top: Table) -> Unit:
    name = top.content.get("unit", "us")
    top.refuse(name not in (*UNITS, "degrees"), "unit", f"{name!r} is none of {', '.join(UNITS)}, degrees")
    if name == "degrees":  # for readers: the tables contain microseconds, which are finer
        name = "us"
    wanted = {"pca9685": "frequency", "counts": "clock"}.get(str(name))
    for key in ("frequency", "clock"):
        top.refuse(key in top.content and key != wanted, key, f"has no meaning for the unit {name}")
    given = wanted == "clock" or wanted in top.content
    parameter = top.number(str(wanted)) if given else 50.0
    try:
        return make_unit(str(name), parameter)
    except LabialError as error:
        raise top.error(wanted or "unit", str(error)) from None


def _named(top: Table, outputs: Mapping[str, object]) -> List[Tuple[str, Mapping[str, Any]]]:
    spelled: Dict[str, str] = {}
    for name, table in outputs.items():
        top.refuse(not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,31}", name), f"output.{name}",
                   "an output's name is letters, digits and underscores, a letter first, at most 32")
        top.refuse(name.upper() in spelled, f"output.{name}",
                   f"is the same in capitals as output.{spelled.get(name.upper())}")
        top.refuse(name.upper() in ("OUTPUTS", "OUTPUT_NAMES", "PCA9685_PRESCALE"), f"output.{name}",
                   "this name is taken by the generated header")
        top.refuse(not isinstance(table, dict), f"output.{name}", "is not a table")
        spelled[name.upper()] = name
    return list(outputs.items())  # type: ignore[arg-type]


def _source(table: Table) -> Tuple[Row, Optional[float]]:
    """The weights of ``from`` and, if it is one name, the reach that is usual for it."""
    given: Any = table.content.get("from")
    alone = isinstance(given, str)
    if alone:
        given = {given: 1.0}
    table.refuse(not isinstance(given, dict) or not given, "from",
                 "is the name of a gesture or a FAP, or a table { NAME = WEIGHT, ... }")
    weights, reach = (0.0,) * CHANNELS, None
    for name, weight in given.items():
        if name not in SOURCES:
            raise table.error("from", f"no gesture or FAP is called {name!r}{meant(name, SOURCES)}")
        number = table.as_number(f"from.{name}", weight)
        table.refuse(abs(number) > 1000, f"from.{name}", f"{number:g} is not within -1000 .. 1000")
        weights = tuple(total + number * weight for total, weight in zip(weights, SOURCES[name].weights))
        reach = SOURCES[name].reach if alone else None
    table.refuse(not any(weights), "from", "all weights are zero")
    return weights, reach


def _output(path: str, name: str, content: Mapping[str, Any], unit: Unit, numbers: Numbers) -> Output:
    """An output. Its numbers are checked as the description has them, so that errors quote what its author wrote."""
    table = Table(path, f"output.{name}.", content, _OUTPUT_KEYS)
    alone = "from" not in content and "visemes" in content  # it follows sounds, not FAPs
    weights, reach = ((0.0,) * CHANNELS, None) if alone else _source(table)
    closed = table.number("closed") if "closed" in content else None
    rest = "closed" if closed is not None and "neutral" not in content else "neutral"  # the key of the neutral value
    neutral = table.number(rest)
    table.refuse(alone and "gain" in content, "gain", "goes with from: how many units is a FAP unit?")
    table.refuse(alone and "full" not in content, "full", "is needed, the value that sounds move it to at most")
    table.refuse(("full" in content) == ("gain" in content), "full", "either full (the value at full extent) or gain "
                 "(units per FAP unit) is needed" + (", not both" if "full" in content else ""))
    invert = table.flag("invert", False)
    if "full" in content:
        full, gain = _full(table, neutral, rest, reach, alone)
        ends = (neutral, full) if closed is None else (neutral, full, closed)
        minimum = table.number("minimum") if "minimum" in content else min(ends)
        maximum = table.number("maximum") if "maximum" in content else max(ends)
    else:
        table.refuse("reach" in content, "reach", "goes with full, not with gain")
        gain, minimum, maximum = table.number("gain"), table.number("minimum"), table.number("maximum")
        table.refuse(gain == 0, "gain", "is zero: the output would not move")
    slew, acceleration, deadband = _movement(table, minimum, maximum)
    _check_values(table, unit, numbers, minimum, maximum)
    of, each = numbers.value, numbers.each
    return Output(name, weights, gain * each, of(neutral), of(minimum), of(maximum), invert, slew * each,
                  "gain" in content, None if closed is None else of(closed), deadband * each, acceleration * each,
                  tuple((of(linear), of(bent)) for linear, bent in _curve(table, unit, numbers, rest)),
                  tuple(amount * each for amount in _visemes(table)))


def _full(table: Table, neutral: float, rest: str, reach: Optional[float], alone: bool) -> Tuple[float, float]:
    """The value at full extent, and the units per FAP unit that lead there from the neutral value, which the key `rest`
    has: none for an output that follows sounds alone. `reach` is the usual one, where there is one."""
    table.refuse(table.flag("invert", False), "invert", "goes with gain; with full, say where full lies instead")
    full = table.number("full")
    table.refuse(full == neutral, "full", f"is the same as {rest}: the output would not move")
    if alone:
        table.refuse("reach" in table.content, "reach", "goes with from: how many FAP units is full?")
        return full, 0.0
    if "reach" in table.content:
        reach = table.number("reach")
    if reach is None:
        raise table.error("reach", "is missing: how many FAP units is full? Only gestures know it by themselves")
    table.refuse(not reach > 0, "reach", f"{reach:g} is not positive")
    return full, (full - neutral) / reach


def _movement(table: Table, minimum: float, maximum: float) -> Tuple[float, float, float]:
    """Slew, acceleration and deadband; 0 for those that are not given."""
    slew, acceleration, deadband = (table.number(key) if key in table.content else 0.0
                                    for key in ("slew", "acceleration", "deadband"))
    for key, value in (("slew", slew), ("acceleration", acceleration)):
        table.refuse(key in table.content and value <= 0, key, f"{value:g} is not positive; leave it out for no limit")
    table.refuse(deadband < 0, "deadband", f"{deadband:g} is negative")
    table.refuse(minimum > maximum, "minimum", f"{minimum:g} is above the maximum, {maximum:g}")
    table.refuse(deadband > maximum - minimum, "deadband",
                 f"{deadband:g} is more than the travel from {minimum:g} to {maximum:g}: the output would not move")
    return slew, acceleration, deadband


def _visemes(table: Table) -> Row:
    """What sounds add, in the order of `VISEMES`."""
    given = table.content.get("visemes")
    if given is None:
        return ()
    table.refuse(not isinstance(given, dict) or not given, "visemes", "is a table { VISEME = AMOUNT, ... }")
    for name in given:
        if name not in VISEMES:
            raise table.error("visemes", f"no viseme is called {name!r}{meant(name, VISEMES)}")
    return tuple(table.as_number(f"visemes.{name}", given[name]) if name in given else 0.0 for name in VISEMES)


def _curve(table: Table, unit: Unit, numbers: Numbers, rest: str) -> Tuple[Tuple[float, float], ...]:
    """The curve that makes a linkage open evenly, from measured points [VALUE, OPENING]: the values of an even linkage,
    from neutral, which the key `rest` has, to full, and the values that open this linkage equally far."""
    if "curve" not in table.content:
        return ()
    given, (least, most) = table.content["curve"], CURVE_POINTS
    table.refuse(not isinstance(given, list) or not least <= len(given) <= most, "curve",
                 f"is a list of {least} to {most} points [VALUE, OPENING]")
    points: List[Tuple[float, float]] = []
    for number, point in enumerate(given, 1):
        table.refuse(not isinstance(point, list) or len(point) != 2, "curve", f"point {number} is not [VALUE, OPENING]")
        points.append((table.as_number("curve", point[0]), table.as_number("curve", point[1])))
        if unit.servo:
            _check_pulse(table, "curve", points[-1][0], numbers)
    table.refuse("full" not in table.content, "curve", "goes with full, not with gain")
    points.sort()
    steps = [(after[0] - before[0], after[1] - before[1]) for before, after in zip(points, points[1:])]
    if any(value <= 0 for value, _ in steps) or not (all(opening > 0 for _, opening in steps)
                                                     or all(opening < 0 for _, opening in steps)):
        raise table.error("curve", "from each value to the next larger one the opening must grow, or from each shrink")
    neutral, full = table.number(rest), table.number("full")
    for name, value in ((rest, neutral), ("full", full)):
        table.refuse(not points[0][0] <= value <= points[-1][0], "curve", f"{name}, {value:g}, is not within "
                     f"{points[0][0]:g} .. {points[-1][0]:g}, where the opening was measured")
    shut, wide = (_between(points, value) for value in (neutral, full))
    return tuple(sorted((neutral + (full - neutral) * (opening - shut) / (wide - shut), value)
                        for value, opening in points))


def _between(points: Sequence[Tuple[float, float]], value: float) -> float:
    """The opening at a value within those of the points."""
    place = next(place for place in range(1, len(points)) if value <= points[place][0])
    (low, start), (high, end) = points[place - 1:place + 1]
    return start + (end - start) * (value - low) / (high - low)


def _check_pulse(table: Table, key: str, number: float, numbers: Numbers) -> None:
    """Checks that a number stands for a servo's pulse."""
    if PULSE_MIN <= numbers.value(number) <= PULSE_MAX:
        return
    pulses = f"{PULSE_MIN:g} .. {PULSE_MAX:g} microseconds"
    if numbers.degrees:
        low, high = math.ceil(100 * numbers.number(PULSE_MIN)) / 100, math.floor(100 * numbers.number(PULSE_MAX)) / 100
        raise table.error(key, f"{number:g} is not within {low:g} .. {high:g} degrees, a servo's {pulses}")
    raise table.error(key, f"{number:g} is not a servo's pulse, {pulses}")


def _check_values(table: Table, unit: Unit, numbers: Numbers, minimum: float, maximum: float) -> None:
    """Checks the values that the description gives an output: of servos and weights their range, of servos and of
    `closed` that they lie within the limits."""
    given = {key: table.number(key) for key in _PLACES if key in table.content}
    for key, value in given.items():
        table.refuse(unit.name == "weight" and round(value * unit.scale) > unit.scale, key,
                     f"{value:g} is beyond 1: weights are 0 to 1")
        if unit.servo:
            _check_pulse(table, key, value, numbers)
    for key, value in given.items():
        table.refuse((unit.servo or key == "closed") and not minimum <= value <= maximum, key,
                     f"{value:g} is not within {minimum:g} .. {maximum:g}")
