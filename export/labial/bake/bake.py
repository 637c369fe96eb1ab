"""A C header of baked motion or phonemes, and the player that plays the motion."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

from labial.bake import track
from labial.bake.source import RATE, Source, read_phonemes, read_track
from labial.errors import LabialError
from labial.files.c import check_name, constants_of, rows, written_by
from labial.files.grammar import is_number
from labial.files.outputs import check_folder, folder
from labial.rig.description import read
from labial.rig.table import convert

#: The player, which is written beside each track.
PLAYER = "labial_player.h"


def bake(source: Source, output: str, kind: str, rig: Optional[str] = None, name: Optional[str] = None,
         parts: Optional[str] = None) -> List[str]:
    """Writes a header of `kind`, "track" or "phonemes", and beside a track its player; returns a line for each and for
    each part of a track.

    `rig` is a rig's description, for a track; a jaw without it. `name` is what C calls it, the file's name without it.
    `parts` cuts a track in pauses: into parts of so many seconds at most, or in all of them ("pauses").
    """
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
        face = read(rig, name) if rig is not None else track.JAW
        table = convert(face)
        track.check_names(face)
        motion = read_track(source)
        still = [output.name for output in face.outputs if output.visemes]
        if still and motion.shares is None:
            warnings.warn(f"{source.path}: frames do not tell their sounds, which {', '.join(still)} of {rig} "
                          f"follow{'s' * (len(still) == 1)}; phoneme timings do", stacklevel=2)
        cut = None if parts is None else track.parts(motion.pauses, longest)
        text = track.header(name, Path(source.path).name, face, table, motion, cut)
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
