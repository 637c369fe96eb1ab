"""A rig as the C table that ``labial/rig.h`` declares, and the float64 computation with which the C library is
compared."""

from __future__ import annotations

import math
import os
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Callable, List, Optional, Sequence, Tuple, Union

from labial import __version__
from labial.errors import DataError
from labial.faps import FAP_NAMES
from labial.outputs import folder
from labial.rig.description import Output, Rig
from labial.rig.gestures import Row

if TYPE_CHECKING:
    import numpy as np

#: Version and limits of include/labial/rig.h.
FORMAT = 2
TOUCHING, APART = 72, 136
WEIGHT_SUM_MAX, GAIN_MAX, VALUE_MAX = 65535, 268435455, 16777215
SLOPE_MAX, SEGMENTS, SIGHT = 1 << 25, 8, 32
_SLOPE_ONE = 1 << 20

#: FAPs up to which a table is kept within one unit of the description; faces stay well within.
FAP_MAX = 1000.0


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

    @property
    def rest(self) -> int:
        """The value of the face at rest."""
        return min(max(self.neutral if self.closed is None else self.closed, self.minimum), self.maximum)


def convert(rig: Rig) -> List[TableOutput]:
    """The rig's outputs as integers. Raises DataError naming the key of what the table cannot hold."""
    return [_convert(rig, output) for output in rig.outputs]


def _convert(rig: Rig, output: Output) -> TableOutput:
    def fail(key: str, message: str) -> DataError:
        return DataError(rig.path, None, f"output.{output.name}.{key}: {message}")

    scale = rig.unit.scale
    # Limits are rounded inwards: no servo goes beyond what its owner wrote.
    values = {"neutral": math.floor(output.neutral * scale + 0.5), "minimum": math.ceil(output.minimum * scale - 1e-9),
              "maximum": math.floor(output.maximum * scale + 1e-9),
              "slew": max(math.floor(output.slew * scale + 0.5), 1) if output.slew else 0,
              "acceleration": max(math.floor(output.acceleration * scale + 0.5), 1) if output.acceleration else 0,
              "deadband": math.floor(output.deadband * scale + 0.5)}
    if output.closed is not None:
        values["closed"] = math.floor(output.closed * scale + 0.5)
    for key, value in values.items():
        if abs(value) > VALUE_MAX:
            raise fail(key, f"{value} {rig.unit.text} is beyond {VALUE_MAX}")
        if rig.unit.limit is not None and key not in ("slew", "acceleration", "deadband") and value > rig.unit.limit:
            raise fail(key, f"{value} {rig.unit.text} is beyond {rig.unit.limit}")
    if values["minimum"] > values["maximum"]:
        raise fail("minimum", "no whole unit lies between minimum and maximum")
    if "closed" in values:
        values["closed"] = min(max(values["closed"], values["minimum"]), values["maximum"])
    if rig.unit.servo:
        values["neutral"] = min(max(values["neutral"], values["minimum"]), values["maximum"])
    found = _quantise(output.weights, output.gain * scale)
    if found is None:
        raise fail("from" if abs(output.gain * scale) < 4096 else "gain" if output.given_gain else "full",
                   "gain and weights are too large, or too far apart, to keep the motion within one unit")
    weights, gain = found
    return TableOutput(output.name, weights, gain, values["neutral"], values["minimum"],
                       values["maximum"], values["slew"], output.invert, values.get("closed"), values["deadband"],
                       values["acceleration"], _segments(output, scale, fail))


def _segments(output: Output, scale: float, fail: Callable[[str, str], DataError]) -> Tuple[Tuple[int, int, int], ...]:
    """An output's curve as the table has it. Each segment lies on the line that it is part of, so that rounding where
    it begins costs nothing but at its end."""
    segments: List[Tuple[int, int, int]] = []
    for (linear, value), (following, reached) in zip(output.curve, output.curve[1:]):
        slope = (reached - value) / (following - linear)
        first = math.floor(linear * scale + 0.5)
        to = math.floor((value * scale + slope * (first - linear * scale)) + 0.5)
        if abs(slope) * _SLOPE_ONE > SLOPE_MAX:
            raise fail("curve", f"between {value:g} and {reached:g} the output would move {abs(slope):.0f} times as "
                                f"far as evenly, {SLOPE_MAX // _SLOPE_ONE} times is the most")
        if max(abs(first), abs(to)) > VALUE_MAX:
            raise fail("curve", f"what lies at {value:g} is beyond {VALUE_MAX}")
        if segments and first <= segments[-1][0]:
            raise fail("curve", f"the points at {segments[-1][1] / scale:g} and {value:g} are too near for whole units")
        segments.append((first, to, math.floor(slope * _SLOPE_ONE + 0.5)))
    return tuple(segments)


def _quantise(weights: Row, gain: float) -> Optional[Tuple[Tuple[int, ...], int]]:
    """Q12 weights and Q16 gain whose product is nearest to what is asked, or None when nothing comes near.

    Weights times a power of two and the gain divided by it are the same output. Of the pairs that fit, the plainest is
    taken that errs by less than a twentieth unit for FAPs up to FAP_MAX, else the one that errs least.
    """
    best: Optional[Tuple[float, Tuple[int, ...], int]] = None
    for power in sorted(range(-12, 20), key=abs):
        rounded = tuple(math.floor(weight * 2.0**power * 4096 + 0.5) for weight in weights)
        whole = math.floor(gain / 2.0**power * 65536 + 0.5)
        sizes = [abs(weight) for weight in rounded]
        if sum(sizes) > WEIGHT_SUM_MAX or max(sizes) > 32767 or abs(whole) > GAIN_MAX:
            continue
        error = FAP_MAX * sum(abs(found / 4096 * (whole / 65536) - weight * gain)
                              for found, weight in zip(rounded, weights))
        if best is None or error < best[0]:
            best = (error, rounded, whole)
        if error < 0.05:
            break
    return None if best is None or best[0] > 0.49 else best[1:]


def expected(rig: Rig, table: List[TableOutput], frames: np.ndarray) -> np.ndarray:
    """(T, N) float64 values for (T, 13) FAPs, in units of the hardware, neither rounded nor limited in speed.

    Weights and gains are those of the description; neutral and limits are the table's whole units.
    """
    import numpy as np

    columns = []
    for output, whole in zip(rig.outputs, table):
        move = (frames @ output.weights) * (output.gain * rig.unit.scale)
        values = whole.neutral + (-move if output.invert else move)
        if output.curve:
            values = _bent(np.array(output.curve) * rig.unit.scale, values)
        values = np.clip(values, whole.minimum, whole.maximum)
        if whole.closed is not None:
            values = values + touching(frames) / 4096.0 * (whole.closed - values)
        columns.append(values)
    return np.stack(columns, axis=1)


def _bent(curve: np.ndarray, linear: np.ndarray) -> np.ndarray:
    """(T,) values of a curve through (K, 2) points; beyond its ends the first and the last part go on."""
    import numpy as np

    slopes = np.diff(curve[:, 1]) / np.diff(curve[:, 0])
    place = np.clip(np.searchsorted(curve[:, 0], linear, side="right") - 1, 0, len(slopes) - 1)
    return curve[place, 1] + slopes[place] * (linear - curve[place, 0])


def touching(frames: np.ndarray) -> np.ndarray:
    """(T,) how much the lips touch in (T, 13) frames, Q12: 0 apart, 4096 where they do (include/labial/rig.h)."""
    import numpy as np

    return np.clip((APART + frames[:, 3] + frames[:, 4]) * (4096 // (APART - TOUCHING)), 0, 4096)


def wanted(output: TableOutput, frames: np.ndarray) -> np.ndarray:
    """(T,) int64 values for (T, 13) whole FAPs, neither limited in speed nor kept by a deadband."""
    import numpy as np

    product = (frames @ np.array(output.weights, dtype=np.int64)) * output.gain
    move = np.clip((product + (1 << 27)) >> 28, -(1 << 30), 1 << 30)
    values = output.neutral + (-move if output.invert else move)
    if output.curve:
        first, to, slope = np.array(output.curve, dtype=np.int64).T
        linear = np.clip(values, -VALUE_MAX, VALUE_MAX)
        place = np.clip(np.searchsorted(first, linear, side="right") - 1, 0, None)
        values = to[place] + (((linear - first[place]) * slope[place] + _SLOPE_ONE // 2) // _SLOPE_ONE)
    values = np.clip(values, output.minimum, output.maximum)
    if output.closed is not None:
        values = values + (((output.closed - values) * touching(frames) + (1 << 11)) >> 12)
    return values


def moved(table: Sequence[TableOutput], frames: np.ndarray, ahead: int = 1) -> np.ndarray:
    """(T, N) int64 values for (T, 13) whole FAPs of 16 bits, from rest on, to the bit as labial_rig_apply_ahead has
    them with `ahead` frames in sight, this one included; with 1 and without accelerations as labial_rig_apply has
    them."""
    import numpy as np

    columns = []
    for output in table:
        values = wanted(output, frames)
        if output.acceleration:
            values = steered(output, values, ahead)
        elif output.slew or output.deadband:
            values = _slewed(output, values, touching(frames), ahead)
        columns.append(values)
    return np.stack(columns, axis=1)


def _slewed(output: TableOutput, values: np.ndarray, touch: np.ndarray, ahead: int) -> np.ndarray:
    import numpy as np

    until = np.full(len(values), len(values))  # frames to the next one in which the lips touch
    closed = np.flatnonzero(touch >= 4096)
    place = np.searchsorted(closed, np.arange(len(values)))
    seen = place < len(closed)
    until[seen] = closed[place[seen]] - np.flatnonzero(seen)
    last, out = output.rest, values.copy()
    for frame, value in enumerate(values):
        if output.closed is not None and output.slew and seen[frame] and until[frame] < ahead:
            room = until[frame] * output.slew
            value = min(max(value, output.closed - room), output.closed + room)
        if abs(value - last) < output.deadband:
            value = last
        elif output.slew:
            value = min(max(value, last - output.slew), last + output.slew)
        last = out[frame] = value
    return out


def steered(output: TableOutput, values: np.ndarray, ahead: int) -> np.ndarray:
    """(T,) int64 values that come as near to (T,) wanted ones as the output's limits of speed and acceleration let
    them, with `ahead` frames in sight.

    Seen from where the output rests, no value is further out than one from which it can still come to rest at each of
    those that are wanted in the frames in sight: the room above a target k frames ahead is that of a start from it,
    sum of min(speed, i * acceleration) for i = 1 .. k. Of the changes that leave it so, the one is taken that comes
    nearest to the value wanted now.
    """
    import numpy as np

    limit = output.acceleration
    speed = min(output.slew or VALUE_MAX, SIGHT * limit)
    count = min(ahead, SIGHT)
    room = np.concatenate([[0], np.cumsum(np.minimum(speed, limit * np.arange(1, count)))])
    length = count + speed // limit + 2
    slower = limit * np.arange(length)
    # (T, count) values of the frames in sight; where fewer follow, the last one stays.
    sight = np.lib.stride_tricks.sliding_window_view(np.pad(values, (0, count - 1), mode="edge"), count)

    def bounds(sight: np.ndarray, rest: int) -> np.ndarray:
        outer = np.maximum(sight, rest)
        found = np.repeat(outer[:, -1:], length, axis=1)
        for place in range(count):
            found[:, place] = (outer[:, place:] + room[: count - place]).min(axis=1)
        return found

    rest = output.rest
    highest = np.stack([bounds(sight, rest), bounds(-sight, -rest)])  # of the values, and of the mirrored ones

    def not_above(bound: np.ndarray, last: int, change: int, least: int) -> int:
        def stays(change: int) -> bool:
            return bool((last + np.cumsum(np.maximum(change - slower, -speed)) <= bound).all())

        if stays(change):
            return change
        low, high = least, change
        while high - low > 1 and stays(least):
            middle = (low + high) // 2
            low, high = (middle, high) if stays(middle) else (low, middle)
        return low

    last, change, out = rest, 0, values.copy()
    for frame in range(len(values)):
        flip = last < rest  # what keeps it from crossing the place of rest has the last word
        sign = -1 if flip else 1
        change *= sign
        least, most = max(change - limit, -speed), min(change + limit, speed)
        step = sign * (int(values[frame]) - last)
        step = min(max(0 if abs(step) < output.deadband else step, least), most)
        step = not_above(highest[int(flip), frame], sign * last, step, least)
        step = -not_above(highest[int(not flip), frame], -sign * last, -step, -most)
        before, last = last, min(max(last + sign * step, output.minimum), output.maximum)
        out[frame], change = last, last - before
    return out


def _comment(rig: Rig, what: str) -> str:
    text = f"{what}. Values are {rig.unit.text}. Written by labial rig {__version__}; do not edit."
    return "/*\n" + textwrap.fill(text, width=114, initial_indent=" * ", subsequent_indent=" * ") + "\n */\n"


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
    note = f"{output.name}: {output.gain * rig.unit.scale:.6g} per FAP unit of ({mixed}){rate}"
    lines = textwrap.fill(note, width=108, initial_indent="    /* ", subsequent_indent="     * ") + " */\n"
    return (lines + f"    {{ {{ {', '.join(map(str, whole.weights))} }},\n"
            f"      {int(whole.invert)}, {int(whole.closed is not None)}, {whole.gain}, {whole.neutral}, "
            f"{whole.minimum}, {whole.maximum}, {whole.slew}, {whole.closed or 0}, {whole.deadband}, "
            f"{whole.acceleration}, {f'&{output.name}_curve' if whole.curve else '0'} }}")


def _curve(whole: TableOutput) -> str:
    if not whole.curve:
        return ""
    rows = ", ".join(f"{{ {first}, {to}, {slope} }}" for first, to, slope in whole.curve)
    lines = textwrap.fill(rows, width=112, initial_indent="    ", subsequent_indent="    ")
    return (f"/* What the linkage of {whole.name} needs: from, to, slope. */\n"
            f"static const labial_rig_curve_t {whole.name}_curve = {{ {len(whole.curve)}, {{\n{lines}\n}} }};\n\n")


def source(rig: Rig, table: List[TableOutput]) -> str:
    """NAME.c: the table."""
    rows = ",\n".join(_row(rig, output, whole) for output, whole in zip(rig.outputs, table))
    curves = "".join(map(_curve, table))
    return f"""{_comment(rig, f"{rig.name}.c - what moves a face")}#include "{rig.name}.h"

{curves}/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve */
static const labial_rig_output_t outputs[{len(table)}] = {{
{rows}
}};

const labial_rig_t {rig.name} = {{ outputs, {len(table)} }};
"""


def write(rig: Rig, directory: Union[str, os.PathLike]) -> List[Path]:
    """Writes NAME.h and NAME.c into `directory`; returns their paths. Nothing is written when the rig has errors."""
    from labial.emit import check_name

    check_name(rig.name, "rig")
    table = convert(rig)
    files = {f"{rig.name}.h": header(rig), f"{rig.name}.c": source(rig, table)}
    with folder(directory) as made:
        for name, text in files.items():
            (made / name).write_bytes(text.encode("ascii"))
    return [Path(directory) / name for name in files]
