"""A rig as the C table that ``labial/rig.h`` declares and as JSON for pages, and the float64 computation to compare the
C library with."""

from __future__ import annotations

import json
import math
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Callable, List, Optional, Tuple

from labial.errors import DataError, ModelError, PathLike
from labial.files.c import check_name, written_by
from labial.files.faps import FAP_NAMES, TOUCHING
from labial.files.outputs import folder, writing
from labial.rig.description import Output, Rig, Row
from labial.tables.visemes import VISEMES

if TYPE_CHECKING:
    import numpy as np

#: Version and limits of include/labial/rig.h.
FORMAT = 3
APART = 136  # the opening at which lips no longer touch at all
WEIGHT_MAX, WEIGHT_SUM_MAX, GAIN_MAX, VALUE_MAX = 32767, 65535, 268435455, 16777215
SLOPE_MAX, SEGMENTS, VISEME_MAX = 1 << 25, 8, 32767
_SLOPE_ONE = 1 << 20
#: FAPs up to which a table is within one unit of the description; faces stay well below.
FAP_MAX = 1000.0
#: Most units by which weights and gain may miss the description; factors tried where no power of two comes so near.
_NEAR, _GAINS = 0.49, 256


@dataclass(frozen=True)
class TableOutput:
    """One output as integers, in units of the hardware."""

    name: str
    weights: Tuple[int, ...]  #: 13, Q12
    gain: int  #: Q16
    neutral: int
    minimum: int
    maximum: int
    slew: int
    invert: bool
    closed: Optional[int] = None
    deadband: int = 0
    acceleration: int = 0
    curve: Tuple[Tuple[int, int, int], ...] = ()  #: segments: where each begins, its value there, its slope, Q20
    visemes: Tuple[int, ...] = ()  #: 15 amounts, or none

    @property
    def rest(self) -> int:
        """The value of the face at rest."""
        return min(max(self.neutral if self.closed is None else self.closed, self.minimum), self.maximum)


def convert(rig: Rig) -> List[TableOutput]:
    """The rig's outputs as integers. Raises DataError naming the key of a value that the table cannot hold."""
    return [_convert(rig, output) for output in rig.outputs]


def _convert(rig: Rig, output: Output) -> TableOutput:
    def fail(key: str, message: str) -> DataError:
        return DataError(rig.path, None, f"output.{output.name}.{key}: {message}")

    scale = rig.unit.scale
    # Minimum and maximum are rounded inwards: no servo leaves them. All else is rounded to the nearest whole number.
    values = {"neutral": _nearest(output.neutral * scale), "minimum": math.ceil(output.minimum * scale - 1e-9),
              "maximum": math.floor(output.maximum * scale + 1e-9), "slew": _nearest(output.slew * scale),
              "acceleration": _nearest(output.acceleration * scale), "deadband": _nearest(output.deadband * scale)}
    for key, limit in (("slew", output.slew), ("acceleration", output.acceleration)):
        if limit and not values[key]:  # zero would be no limit, and one would be more than twice as much
            raise fail(key, f"{limit / rig.numbers.each:g} is less than half a step of its values, {rig.unit.text}")
    if output.closed is not None:
        values["closed"] = _nearest(output.closed * scale)
    for key, value in values.items():
        if abs(value) > VALUE_MAX:
            raise fail(key, f"{value} {rig.unit.text} is beyond {VALUE_MAX}")
        if rig.unit.limit is not None and key not in ("slew", "acceleration", "deadband") and value > rig.unit.limit:
            raise fail(key, f"{value} {rig.unit.text} is beyond {rig.unit.limit}")
    if values["minimum"] > values["maximum"]:
        raise fail("minimum", "no whole unit lies between minimum and maximum")
    for key in ("closed", "neutral"):
        if key in values and (rig.unit.servo or key == "closed"):
            values[key] = min(max(values[key], values["minimum"]), values["maximum"])
    found = _quantise(output.weights, output.gain * scale)
    if found is None:
        raise fail("from" if abs(output.gain * scale) < 4096 else "gain" if output.given_gain else "full",
                   "gain and weights are too large, or too far apart, to keep the motion within one unit")
    segments = _segments(rig, output, fail)
    amounts = tuple(_nearest(amount * scale) for amount in output.visemes)
    for name, amount in zip(VISEMES, amounts):
        if abs(amount) > VISEME_MAX:
            raise fail(f"visemes.{name}", f"{amount} {rig.unit.text} is beyond {VISEME_MAX}")
    weights, gain = found
    return TableOutput(output.name, weights, gain, invert=output.invert, curve=segments, visemes=amounts,
                       closed=values.pop("closed", None), **values)


def _nearest(value: float) -> int:
    return math.floor(value + 0.5)


def _segments(rig: Rig, output: Output, fail: Callable[[str, str], DataError]) -> Tuple[Tuple[int, int, int], ...]:
    """An output's curve in the table. Each segment lies on its original line, so that rounding its beginning has no
    effect except at its end."""
    scale, number = rig.unit.scale, rig.numbers.number
    segments: List[Tuple[int, int, int]] = []
    for (linear, value), (following, reached) in zip(output.curve, output.curve[1:]):
        slope = (reached - value) / (following - linear)
        first = _nearest(linear * scale)
        to = _nearest(value * scale + slope * (first - linear * scale))
        if abs(slope) * _SLOPE_ONE > SLOPE_MAX:
            raise fail("curve", f"between {number(value):g} and {number(reached):g} the output would move "
                                f"{abs(slope):.0f} times as far as evenly, {SLOPE_MAX // _SLOPE_ONE} times is the most")
        if max(abs(first), abs(to)) > VALUE_MAX:
            raise fail("curve", f"what lies at {number(value):g} is beyond {VALUE_MAX}")
        if segments and first <= segments[-1][0]:
            before = output.curve[len(segments) - 1][1]
            raise fail("curve", f"the points at {number(before):g} and {number(value):g} are too near for whole units")
        segments.append((first, to, _nearest(slope * _SLOPE_ONE)))
    return tuple(segments)


def _quantise(weights: Row, gain: float) -> Optional[Tuple[Tuple[int, ...], int]]:
    """Q12 weights and Q16 gain whose product is nearest to the given one, or None if none is near enough. Weights times
    a power of two and the gain divided by it give the same output. The result is the simplest pair with an error below
    a twentieth unit for FAPs up to FAP_MAX, else the pair with the least error. If that is not near enough, other
    factors are tried, the largest weights first."""
    best: Tuple[float, Tuple[int, ...], int] = (math.inf, (), 0)
    for power in sorted(range(-12, 20), key=abs):
        rounded = tuple(_nearest(weight * 2.0**power * 4096) for weight in weights)
        whole = _nearest(gain / 2.0**power * 65536)
        best = min(best, (_error(weights, gain, rounded, whole), rounded, whole), key=lambda pair: pair[0])
        if best[0] < 0.05:
            break
    if _NEAR < best[0] < math.inf:
        moves = [weight * gain * 4096 * 65536 for weight in weights]
        least = max(max(map(abs, moves)) / WEIGHT_MAX, sum(map(abs, moves)) / WEIGHT_SUM_MAX)
        for step in range(_GAINS):
            whole = math.ceil(least * (1.0 + step / _GAINS)) * (1 if gain > 0 else -1)
            rounded = tuple(_nearest(move / whole) for move in moves)
            best = min(best, (_error(weights, gain, rounded, whole), rounded, whole), key=lambda pair: pair[0])
    return None if best[0] > _NEAR else best[1:]


def _error(weights: Row, gain: float, rounded: Tuple[int, ...], whole: int) -> float:
    """Units by which Q12 weights and a Q16 gain miss the given ones at most, for FAPs up to FAP_MAX; infinite for what
    a table cannot hold."""
    sizes = [abs(weight) for weight in rounded]
    if sum(sizes) > WEIGHT_SUM_MAX or max(sizes) > WEIGHT_MAX or abs(whole) > GAIN_MAX:
        return math.inf
    return FAP_MAX * sum(abs(found / 4096 * (whole / 65536) - weight * gain) for found, weight in zip(rounded, weights))


def holds(weights: Row, gain: float) -> bool:
    """Whether a table can hold an output that moves by so many of its units per FAP unit."""
    return _quantise(weights, gain) is not None


def expected(rig: Rig, table: List[TableOutput], frames: np.ndarray, shares: Optional[np.ndarray] = None) -> np.ndarray:
    """(T, N) float64 values for (T, 13) FAPs and, if known, (T, 15) shares of sounds, 0 .. 1, in units of the hardware,
    neither rounded nor limited in speed. Weights and gains are those of the description; neutral and limits are the
    table's whole units."""
    import numpy as np

    columns = []
    for output, whole in zip(rig.outputs, table):
        move = (frames @ output.weights) * (output.gain * rig.unit.scale)
        values = whole.neutral + (-move if output.invert else move)
        if output.visemes and shares is not None:
            values = values + shares @ (np.array(output.visemes) * rig.unit.scale)
        if output.curve:
            values = _bent(np.array(output.curve) * rig.unit.scale, values)
        values = np.clip(values, whole.minimum, whole.maximum)
        if whole.closed is not None:
            values = values + touching(frames) / 4096.0 * (whole.closed - values)
        columns.append(values)
    return np.stack(columns, axis=1)


def _bent(curve: np.ndarray, linear: np.ndarray) -> np.ndarray:
    """(T,) values of a curve through (K, 2) points; the first and the last part extend beyond its ends."""
    import numpy as np

    slopes = np.diff(curve[:, 1]) / np.diff(curve[:, 0])
    place = np.clip(np.searchsorted(curve[:, 0], linear, side="right") - 1, 0, len(slopes) - 1)
    return curve[place, 1] + slopes[place] * (linear - curve[place, 0])


def touching(frames: np.ndarray) -> np.ndarray:
    """(T,) contact of the lips in (T, 13) frames, Q12: 0 apart, 4096 touching (include/labial/rig.h)."""
    import numpy as np

    return np.clip((APART + frames[:, 3] + frames[:, 4]) * (4096 // (APART - TOUCHING)), 0, 4096)


def _comment(rig: Rig, what: str) -> str:
    return written_by("rig", f"{what}. Values are {rig.unit.text}.")


def header(rig: Rig) -> str:
    """NAME.h: the rig's symbol and the numbers of its outputs."""
    upper = rig.name.upper()
    constants = ",\n".join(f"    {upper}_{output.name.upper()} = {number}" for number, output in enumerate(rig.outputs))
    names = textwrap.fill(", ".join(f'"{output.name}"' for output in rig.outputs), width=110, initial_indent="    ",
                          subsequent_indent="    ").replace("\n", " \\\n")
    prescale = "" if rig.unit.prescale is None else (
        f"\n/* What the PCA9685's prescale register must hold for these ticks. */\n"
        f"#define {upper}_PCA9685_PRESCALE {rig.unit.prescale}\n")
    return f"""{_comment(rig, f"{rig.name}.h - what moves a face")}#ifndef LABIAL_RIG_{upper}_H
#define LABIAL_RIG_{upper}_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != {FORMAT}
#error "{rig.name} was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {{
#endif

#define {upper}_OUTPUTS {len(rig.outputs)}

/* What initialises an array of the outputs' names. */
#define {upper}_OUTPUT_NAMES {{ \\
{names} \\
}}
{prescale}
/* Places of the outputs among the values. */
enum {{
{constants}
}};

extern const labial_rig_t {rig.name};

#ifdef __cplusplus
}}
#endif

#endif
"""


def _row(rig: Rig, output: Output, whole: TableOutput) -> str:
    mixed = " ".join(f"{weight:+g} {FAP_NAMES[k]}" for k, weight in enumerate(output.weights) if weight)
    rate = f", at most {whole.slew} per frame" if whole.slew else ""
    rate += f", {whole.closed} where lips touch" if whole.closed is not None else ""
    rate += f", {whole.acceleration} more or less per frame" if whole.acceleration else ""
    rate += "".join(f", {amount:+d} {name}" for name, amount in zip(VISEMES, whole.visemes) if amount)
    note = f"{output.name}: {output.gain * rig.unit.scale:.6g} per FAP unit of ({mixed}){rate}"
    lines = textwrap.fill(note, width=108, initial_indent="    /* ", subsequent_indent="     * ") + " */\n"
    return (lines + f"    {{ {{ {', '.join(map(str, whole.weights))} }},\n"
            f"      {int(whole.invert)}, {int(whole.closed is not None)}, {whole.gain}, {whole.neutral}, "
            f"{whole.minimum}, {whole.maximum}, {whole.slew}, {whole.closed or 0}, {whole.deadband}, "
            f"{whole.acceleration}, {f'&{output.name}_curve' if whole.curve else '0'}, "
            f"{f'{output.name}_visemes' if whole.visemes else '0'} }}")


def _tables(whole: TableOutput) -> str:
    """The tables that an output refers to."""
    found = ""
    if whole.curve:
        rows = ", ".join(f"{{ {first}, {to}, {slope} }}" for first, to, slope in whole.curve)
        lines = textwrap.fill(rows, width=112, initial_indent="    ", subsequent_indent="    ")
        found = (f"/* What the linkage of {whole.name} needs: from, to, slope. */\n"
                 f"static const labial_rig_curve_t {whole.name}_curve = {{ {len(whole.curve)}, {{\n{lines}\n}} }};\n\n")
    if whole.visemes:
        visemes = ", ".join(map(str, whole.visemes))
        found += f"static const int16_t {whole.name}_visemes[LABIAL_VISEMES] = {{ {visemes} }};\n\n"
    return found


def source(rig: Rig, table: List[TableOutput]) -> str:
    """NAME.c: the table."""
    rows = ",\n".join(_row(rig, output, whole) for output, whole in zip(rig.outputs, table))
    tables = "".join(map(_tables, table))
    columns = ("weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, "
               "curve, visemes")
    return f"""{_comment(rig, f"{rig.name}.c - what moves a face")}#include "{rig.name}.h"

{tables}/* {columns} */
static const labial_rig_output_t outputs[{len(table)}] = {{
{rows}
}};

const labial_rig_t {rig.name} = {{ outputs, {len(table)} }};
"""


def write(rig: Rig, directory: PathLike) -> List[Path]:
    """Writes NAME.h and NAME.c into `directory`; returns their paths. Nothing is written when the rig has errors."""
    check_name(rig.name, "rig")
    table = convert(rig)
    own = ["outputs", *(f"{output.name}_curve" for output in table if output.curve),
           *(f"{output.name}_visemes" for output in table if output.visemes)]
    if rig.name in own:
        raise ModelError(f"{rig.name!r} is no name for a rig: {rig.name}.c has another table of this name")
    files = {f"{rig.name}.h": header(rig), f"{rig.name}.c": source(rig, table)}
    with folder(directory) as made:
        for name, text in files.items():
            (made / name).write_bytes(text.encode("ascii"))
    return [Path(directory) / name for name in files]


def write_json(rig: Rig, directory: PathLike) -> Path:
    """Writes NAME.json into `directory`, a rig of weights as `labial.rig()` of the npm package reads it: the numbers of
    the C table, by name; its path. Raises DataError for a rig of servos, whose limits of speed a page does not
    apply."""
    if rig.unit.name != "weight":
        raise DataError(rig.path, None, f'unit: --json is for faces of weights, "weight", not {rig.unit.name!r}')
    outputs = {}
    for output in convert(rig):
        for key in ("slew", "deadband", "acceleration"):
            if getattr(output, key):
                raise DataError(rig.path, None, f"output.{output.name}.{key}: is for servos, not for --json")
        outputs[output.name] = {"weights": output.weights, "gain": output.gain, "neutral": output.neutral,
                                "minimum": output.minimum, "maximum": output.maximum, "invert": int(output.invert),
                                "contact": int(output.closed is not None), "closed": output.closed or 0,
                                **({"curve": output.curve} if output.curve else {}),
                                **({"visemes": output.visemes} if output.visemes else {})}
    rows = ",\n".join(f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in outputs.items())
    path = Path(directory) / f"{rig.name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    with writing(path, "ascii") as out:
        out.write(f'{{"labial": "rig", "name": {json.dumps(rig.name)}, "outputs": {{\n{rows}\n}}}}\n')
    return path
