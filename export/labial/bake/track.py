"""``labial bake --as track``: a rig's outputs as bytes, 50 frames a second, which ``labial_player.h`` plays; and
``labial bake``, which writes them or phonemes as a C header, with the player.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.bake.source import RATE, Motion, Source, read_phonemes, read_track
from labial.errors import DataError, LabialError
from labial.files.c import check_name, constants_of, rows, written_by
from labial.files.frames import spans, whole_faps, whole_shares
from labial.files.grammar import is_number
from labial.files.outputs import check_folder, folder
from labial.rig.description import GESTURES, Output, Rig, make_unit, read
from labial.rig.table import TableOutput, convert
from labial.runtime.beside import SPAN_MAX
from labial.runtime.rig import Rig as Face

#: LABIAL_PLAYER_FORMAT of labial_player.h.
FORMAT = 2
#: Most bytes of an array on an AVR, and of its flash that a pointer of 16 bits reaches.
AVR_LARGEST = 32767
AVR_FLASH = 65535
#: Frames before the end of a pause in which a part may begin: the mouth prepares for what follows.
BEFORE = 15

_OPENING = GESTURES["opening"]
#: A jaw alone: microseconds with the lips closed and wide open, as in examples/faces/jaw.toml, and the most in a frame
#: that a slow one of the common servos follows (docs/servos.md), so that it closes in every p, b, m.
JAW = Rig("jaw", make_unit("us"), (Output("jaw", _OPENING.weights, 500.0 / (_OPENING.reach or 1.0), 1400.0, 1400.0,
                                          1900.0, False, 60.0, False, 1400.0),), "jaw")


def as_bytes(rig: Rig, table: Sequence[TableOutput], frames: np.ndarray,
             shares: Optional[np.ndarray] = None) -> np.ndarray:
    """(T, N) uint8: the rig's outputs for (T, 13) FAPs and, if known, (T, 15) shares of sounds, 0 for an output's
    minimum and 255 for its maximum. FAPs are rounded to integers and converted like ``labial_rig_apply_visemes_ahead``
    with all frames in sight, from rest. Raises DataError for limits further apart than `SPAN_MAX`."""
    for output in table:
        if output.maximum - output.minimum > SPAN_MAX:
            raise DataError(rig.path, None, f"output.{output.name}.maximum: more than {SPAN_MAX} {rig.unit.text} above "
                            "the minimum, too far apart for bytes")
    played = Face.of(rig).play(whole_faps(frames), 65535, None if shares is None else whole_shares(shares))
    values = np.array(played, dtype=np.int64).reshape(len(frames), len(table))
    low = np.array([output.minimum for output in table])
    span = np.array([max(output.maximum - output.minimum, 1) for output in table])
    return ((2 * 255 * (values - low) + span) // (2 * span)).astype(np.uint8)


@dataclass(frozen=True)
class Part:
    """A part of a track, with its own array."""

    begin: int  #: their first
    end: int  #: the one behind their last


def parts_of(pauses: np.ndarray, longest: Optional[int]) -> List[Part]:
    """Parts of a track, cut in the middle of a pause, or `BEFORE` its end where that is later. `pauses` (T,) bool are
    the frames in pauses. Each part has at most `longest` frames and as many as it can, or ends with the first pause
    where `longest` is None; a stretch without a pause that is longer is cut where it has to be."""
    cuts = [max((begin + end) // 2, end - BEFORE) for begin, end in spans(pauses) if begin and end < len(pauses)]
    found: List[Part] = []
    begin = 0
    while begin < len(pauses):
        ahead = [cut for cut in cuts if begin < cut]
        if longest is None:
            end = ahead[0] if ahead else len(pauses)
        elif len(pauses) - begin <= longest:
            end = len(pauses)
        else:
            end = max((cut for cut in ahead if cut - begin <= longest), default=begin + longest)
        found.append(Part(begin, end))
        begin = end
    return found


def header(name: str, source: str, rig: Rig, table: Sequence[TableOutput], motion: Motion,
           cut: Optional[Sequence[Part]] = None) -> str:
    """NAME.h: the bytes, the constants of their units and the calls that play them. Its comment names `source`.
    With `cut` the track has parts, one or more, each of which can be begun with."""
    upper, count = name.upper(), len(table)
    data = as_bytes(rig, table, motion.frames, motion.shares)
    about = (f"{name}.h - {len(data) / RATE:.1f} s of motion from {source}, {RATE} frames a second, a byte for each of "
             f"{count} output{'s' * (count > 1)}. Values are {rig.unit.text}.")
    places = ",\n".join(f"    {upper}_{output.name.upper()} = {number}" for number, output in enumerate(table))
    return f"""{written_by("bake", about, 118)}#ifndef LABIAL_BAKED_{upper}_H
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
{''.join(_limits(upper, output) for output in table)}{_avr_check(name, data, cut)}
{_whole(name, data) if cut is None else _in_parts(name, data, cut)}
/* The next frame, every 20 ms, or NULL when the motion is over. */
static inline const uint8_t *{name}_next(labial_player_t *player)
{{
    return labial_player_next(player, {upper}_OUTPUTS);
}}
{''.join(_reader(name, output, rig) for output in table)}
#endif
"""


def _whole(name: str, data: np.ndarray) -> str:
    return f"""static const uint8_t {name}_bytes[{data.size}] LABIAL_PLAYER_FLASH = {{
{rows(data.ravel())}
}};

/* Goes to the beginning. */
static inline void {name}_init(labial_player_t *player)
{{
    labial_player_init(player, {name}_bytes, {name.upper()}_FRAMES);
}}
"""


def _in_parts(name: str, data: np.ndarray, cut: Sequence[Part]) -> str:
    values = [data[part.begin : part.end].ravel() for part in cut]
    arrays = "".join(f"""static const uint8_t {name}_bytes_{number}[{item.size}] LABIAL_PLAYER_FLASH = {{
{rows(item)}
}};

""" for number, item in enumerate(values))
    begins = "".join(f"""    case {number}:
        labial_player_init(player, {name}_bytes_{number}, {part.end - part.begin}u);
        break;
""" for number, part in enumerate(cut))
    times = "".join(f"    case {number}:\n        return {part.begin * 1000 // RATE}ul;\n"
                    for number, part in enumerate(cut))
    return f"""/* The track's parts follow each other without a gap. */
#define {name.upper()}_PARTS {len(cut)}u

{arrays}/* Goes to the beginning of a part, the first of which is 0; there is no frame in one that is not there. */
static inline void {name}_init(labial_player_t *player, unsigned part)
{{
    switch (part) {{
{begins}    default:
        labial_player_init(player, {name}_bytes_0, 0u);
        break;
    }}
}}

/* Milliseconds of the whole track at which a part begins, or at which the last one ends. */
static inline uint32_t {name}_milliseconds(unsigned part)
{{
    switch (part) {{
{times}    default:
        return {len(data) * 1000 // RATE}ul;
    }}
}}
"""


def _limits(upper: str, output: TableOutput) -> str:
    name = f"{upper}_{output.name.upper()}"
    return f"""
/* What the bytes 0 and 255 of {output.name} stand for. A program may define them before it includes this file. */
#ifndef {name}_AT_0
#define {name}_AT_0 {output.minimum}
#endif
#ifndef {name}_AT_255
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


def _avr_check(name: str, data: np.ndarray, cut: Optional[Sequence[Part]]) -> str:
    largest = max(part.end - part.begin for part in cut or [Part(0, len(data))]) * data.shape[1]
    if data.size > AVR_FLASH:
        problem = f"{name} has {data.size} bytes; a player of an AVR reads the first {AVR_FLASH} of its flash."
    elif largest > AVR_LARGEST:
        seconds = AVR_LARGEST // data.shape[1] // RATE
        problem = f"{name} has {largest} bytes; an array of an AVR holds {AVR_LARGEST}: bake it with --parts {seconds}."
    else:
        return ""
    return f"""
#if defined(__AVR__)
#error "{problem}"
#endif
"""


#: The player, which is written beside each track.
PLAYER = "labial_player.h"


def bake(source: Source, output: str, kind: str, rig: Optional[str] = None, name: Optional[str] = None,
         parts: Optional[str] = None) -> List[str]:
    """Writes a header of `kind`, "track" or "phonemes", and beside a track its player; returns a line for each and for
    each part of a track. `rig` is a rig's description, for a track; a jaw without it. `name` is what C calls it, the
    file's name without it. `parts` cuts a track in pauses: into parts of so many seconds at most, or in all of them
    ("pauses")."""
    path = Path(output)
    if path.suffix.lower() != ".h":
        raise LabialError(f"{output}: what is written is a C header, whose name ends with .h")
    if path.name == PLAYER:
        raise LabialError(f"{output}: this is the name of the player")
    name = name or re.sub(r"[^0-9A-Za-z]+", "_", path.stem)
    check_name(name, "header")
    check_folder(path.parent, path)
    longest = _longest(parts)
    told: List[str] = []
    if kind == "phonemes":
        if parts is not None:
            raise LabialError("--parts goes with --as track; phonemes need no parts")
        if rig is not None:
            raise LabialError("--rig goes with --as track; a board that is given phonemes applies the rig itself")
        model, called, stream = read_phonemes(source)
        files = {path: phonemes_header(name, Path(source.path).name, called, model.phonemes, stream)}
    else:
        face = read(rig, name) if rig is not None else JAW
        table = convert(face)
        for row in table:
            if row.name.lower() in ("begin", "next", "bytes", "frames", "parts", "milliseconds"):
                raise DataError(face.path, None, f"output.{row.name}: this name is taken by the generated header")
        motion = read_track(source)
        still = [row.name for row in table if row.visemes]
        if still and motion.shares is None:
            warnings.warn(f"{source.path}: frames do not tell their sounds, which {', '.join(still)} of {rig} "
                          f"follow{'s' * (len(still) == 1)}; phoneme timings do", stacklevel=2)
        cut = None if parts is None else parts_of(motion.pauses, longest)
        text = header(name, Path(source.path).name, face, table, motion, cut)
        told = [f"part {number}: {part.begin / RATE:.2f} to {part.end / RATE:.2f} s"
                for number, part in enumerate(cut or [])]
        files = {path: text, path.with_name(PLAYER): Path(__file__).with_name(PLAYER).read_text(encoding="ascii")}
    with folder(path.parent, path) as made:
        for file, content in files.items():
            (made / file.name).write_bytes(content.encode("ascii", errors="replace"))
    return [*map(str, files), *told]


def _longest(parts: Optional[str]) -> Optional[int]:
    """Frames of a part at most; None for parts between pauses."""
    if parts is None or parts == "pauses":
        return None
    seconds = float(parts) if is_number(parts) else 0.0
    if not 1.0 <= seconds <= 86400.0:
        raise LabialError(f"--parts: {parts!r} is neither a number of seconds within 1 .. 86400 nor the word pauses")
    return int(seconds * RATE)


# ---- labial bake --as phonemes ---------------------------------------------------------------------------------------

#: An entry is milliseconds times this, and the phoneme's number; no phoneme lasts longer than an hour, 2^22 ms.
_SHIFT = 8


def phonemes_header(name: str, source: str, model: str, labels: Sequence[str],
                    phonemes: Sequence[Tuple[int, int]]) -> str:
    """NAME.h: an array of phonemes of the model that ``MODEL.h`` declares, with `labels`, and the call that pushes
    them. Raises ModelError for a model whose file's name C cannot use."""
    check_name(model)
    upper, names = name.upper(), constants_of(model, labels)
    seconds = sum(milliseconds for _, milliseconds in phonemes) / 1000.0
    about = f"{name}.h - {len(phonemes)} phonemes, {seconds:.1f} s, of {source}, for the model {model}."
    entries = rows(f"{names[phoneme]} | {milliseconds}ul << {_SHIFT}" for phoneme, milliseconds in phonemes)
    return f"""{written_by("bake", about, 118)}#ifndef LABIAL_PHONEMES_{upper}_H
#define LABIAL_PHONEMES_{upper}_H

#include "{model}.h"

#if {model.upper()}_PHONEMES != {len(labels)}
#error "{name} was written for another {model}: run labial bake again."
#endif

#define {upper}_PHONEMES {len(phonemes)}u
#define {upper}_MILLISECONDS {sum(milliseconds for _, milliseconds in phonemes)}ul

/* A phoneme of {model} in the low byte, its milliseconds above it. */
static const uint32_t {name}[{len(phonemes)}] = {{
{entries}
}};

/*
 * Pushes as many phonemes as the stream has room for, from number *next on, which it moves on; 0 to begin with. Call it
 * before each labial_tick(). It ends the stream behind the last one. Returns LABIAL_OK, or what labial_push() and
 * labial_end() do not accept.
 */
static inline int {name}_feed(labial_t *stream, uint32_t *next)
{{
    while (*next < {upper}_PHONEMES && labial_room(stream) > 0) {{
        const int result = labial_push(stream, {name}[*next] & 255u, {name}[*next] >> {_SHIFT});
        if (result < 0)
            return result;
        if (++*next == {upper}_PHONEMES)
            return labial_end(stream);
    }}
    return LABIAL_OK;
}}

#endif
"""
