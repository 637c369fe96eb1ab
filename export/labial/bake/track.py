"""``labial bake --as track``: a rig's outputs as bytes, 50 frames a second, which ``labial_player.h`` plays."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from labial.bake.source import RATE
from labial.bake.text import comment, rows
from labial.errors import DataError
from labial.rig.description import Output, Rig
from labial.rig.gestures import GESTURES
from labial.rig.table import TableOutput, moved
from labial.rig.units import make_unit

#: LABIAL_PLAYER_FORMAT of labial_player.h.
FORMAT = 1
#: Largest difference of an output's limits, for which the player's sums stay below 2^31.
SPAN_MAX = 8_000_000
#: Bytes that an array has at most on an AVR.
AVR_LARGEST = 32767

_OPENING = GESTURES["opening"]
#: A jaw and nothing else, as examples/faces/jaw.toml describes it: microseconds with the lips closed and wide open.
JAW = Rig("jaw", make_unit("us"), (Output("jaw", _OPENING.weights, 500.0 / (_OPENING.reach or 1.0), 1400.0, 1400.0,
                                          1900.0, False, 0.0, False, 1400.0),), "jaw")


def as_bytes(rig: Rig, table: Sequence[TableOutput], frames: np.ndarray) -> np.ndarray:
    """(T, N) uint8: the rig's outputs for (T, 13) FAPs, 0 for an output's minimum and 255 for its maximum.

    FAPs are rounded to whole units and go through the rig as ``labial_rig_apply_ahead`` has it with all frames in
    sight, from rest. Raises DataError for limits further apart than `SPAN_MAX`.
    """
    for output in table:
        if output.maximum - output.minimum > SPAN_MAX:
            raise DataError(rig.path, None, f"output.{output.name}.maximum: more than {SPAN_MAX} {rig.unit.text} above "
                            "the minimum, too far apart for bytes")
    values = moved(table, np.clip(np.floor(frames + 0.5), -32768, 32767).astype(np.int64), len(frames))
    low = np.array([output.minimum for output in table])
    span = np.array([max(output.maximum - output.minimum, 1) for output in table])
    return ((2 * 255 * (values - low) + span) // (2 * span)).astype(np.uint8)


def header(name: str, source: str, rig: Rig, table: Sequence[TableOutput], frames: np.ndarray) -> str:
    """NAME.h: the bytes, the constants of their units and the calls that play them. `source` is told in its comment."""
    upper, count = name.upper(), len(table)
    data = as_bytes(rig, table, frames)
    about = (f"{name}.h - {len(data) / RATE:.1f} s of motion from {source}, {RATE} frames a second, a byte for each of "
             f"{count} output{'s' * (count > 1)}. Values are {rig.unit.text}.")
    places = ",\n".join(f"    {upper}_{output.name.upper()} = {number}" for number, output in enumerate(table))
    return f"""{comment(about)}#ifndef LABIAL_BAKED_{upper}_H
#define LABIAL_BAKED_{upper}_H

#include "labial_player.h"

#if LABIAL_PLAYER_FORMAT != {FORMAT}
#error "{name} was written for another version of Labial: run labial bake again."
#endif

#define {upper}_FRAMES {len(data)}u
#define {upper}_OUTPUTS {count}u

/* Places of the outputs among a frame's bytes. */
enum {{
{places}
}};
{''.join(_limits(upper, output) for output in table)}{_avr_check(name, data)}
static const uint8_t {name}_bytes[{data.size}] LABIAL_PLAYER_FLASH = {{
{rows(data.ravel())}
}};

/* Goes to the beginning. */
static inline void {name}_begin(labial_player_t *player)
{{
    labial_player_begin(player, {name}_bytes, {upper}_FRAMES);
}}

/* The next frame, every 20 ms, or NULL when the motion is over. */
static inline const uint8_t *{name}_next(labial_player_t *player)
{{
    return labial_player_next(player, {upper}_OUTPUTS);
}}
{''.join(_reader(name, output, rig) for output in table)}
#endif
"""


def _limits(upper: str, output: TableOutput) -> str:
    name = f"{upper}_{output.name.upper()}"
    return f"""
/* What the bytes 0 and 255 of {output.name} stand for. A program may define both before it includes this file. */
#ifndef {name}_AT_0
#define {name}_AT_0 {output.minimum}
#define {name}_AT_255 {output.maximum}
#endif
"""


def _reader(name: str, output: TableOutput, rig: Rig) -> str:
    upper, own = name.upper(), output.name.upper()
    return f"""
/* What {output.name} is to do in a frame, {rig.unit.text}. */
static inline int32_t {name}_{output.name.lower()}(const uint8_t *frame)
{{
    return labial_player_value(frame, {upper}_{own}, {upper}_{own}_AT_0, {upper}_{own}_AT_255);
}}
"""


def _avr_check(name: str, data: np.ndarray) -> str:
    if data.size <= AVR_LARGEST:
        return ""
    return f"""
#if defined(__AVR__)
#error "{name} has {data.size} bytes; an array of an AVR holds {AVR_LARGEST}. Bake the sound in parts."
#endif
"""


def check_names(rig: Rig) -> None:
    """Raises DataError for an output that is called as one of the header's own calls and constants."""
    for output in rig.outputs:
        if output.name.lower() in ("begin", "next", "bytes", "frames"):
            raise DataError(rig.path, None, f"output.{output.name}: this name is taken by the generated header")
