"""A C header of baked motion or phonemes, and the player that plays the motion."""

from __future__ import annotations

import re
from pathlib import Path
from typing import List, Optional

from labial.bake import phonemes, track
from labial.bake.source import RATE, Source, read_phonemes, read_track
from labial.errors import LabialError
from labial.files.c import check_name
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
        files = {path: phonemes.header(name, Path(source.path).name, called, model.phonemes, stream)}
    else:
        face = read(rig, name) if rig is not None else track.JAW
        table = convert(face)
        track.check_names(face)
        motion = read_track(source)
        cut = None if parts is None else track.parts(motion.pauses, longest)
        text = track.header(name, Path(source.path).name, face, table, motion.frames, cut)
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
