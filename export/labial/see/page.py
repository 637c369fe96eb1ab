"""``labial page``: one HTML file that plays motion, with its phonemes and its sound. It needs no network."""

from __future__ import annotations

import base64
import json
import math
import os
import re
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

from labial.errors import DataError, LabialError
from labial.files import limits
from labial.files.faps import FAP_COLUMNS
from labial.files.frames import even
from labial.see.motion import Band, Motion, laughs

PathLike = Union[str, os.PathLike[str]]

#: The template of the player and its drawing, shared with the C demo; motion and drawing replace the words below.
PLAYER = Path(__file__).with_name("player.html")
MOUTH = Path(__file__).with_name("mouth.js")
DATA_PLACE, MOUTH_PLACE = "@LABIAL_DATA@", "@LABIAL_MOUTH@"

#: First bytes of sounds that browsers play, their place, and the media type.
_SOUNDS = (
    (0, rb"RIFF....WAVE", "audio/wav"),
    (0, rb"ID3|\xff[\xe2-\xe7\xf2-\xf7\xfa-\xff]", "audio/mpeg"),
    (0, rb"OggS", "audio/ogg"),
    (0, rb"fLaC", "audio/flac"),
    (0, rb"\xff[\xf0\xf1\xf8\xf9]", "audio/aac"),
    (4, rb"ftyp", "audio/mp4"),
    (0, rb"\x1a\x45\xdf\xa3", "audio/webm"),
)


def page(motion: Motion, bands: Sequence[Band], audio: Optional[PathLike] = None, title: Optional[str] = None) -> str:
    """The page as text; `title` is the motion's name unless given.

    `audio` is a sound file that browsers play (WAV, MP3, Ogg, FLAC, AAC, M4A, WebM), of at most `limits.PAGE` bytes,
    whose time 0 is that of the motion's file. Raises DataError, which names it, when it is none, and LabialError for a
    motion whose frames are too uneven in time to be played.
    """
    try:
        fps, frames = even(motion.times, motion.frames)
    except ValueError as error:
        raise LabialError(f"{motion.name}: {error}") from None
    start = float(motion.times[0])
    data: Dict[str, Any] = {
        "title": title or motion.name,
        "fps": fps,
        "start": round(start, 6),
        "channels": list(FAP_COLUMNS),
        "phonemes": _phonemes(bands, start, fps, len(frames)),
        "frames": np.rint(frames).astype(int).tolist(),
    }
    player = PLAYER.read_text(encoding="utf-8")
    before, between, after = re.split(f"{DATA_PLACE}|{MOUTH_PLACE}", player)
    return before + script_data(data, audio) + between + MOUTH.read_text(encoding="utf-8") + after


def script_data(data: Dict[str, Any], audio: Optional[PathLike]) -> str:
    """The data and the sound, if one is given, as JSON that may stand in a script element. Raises as `sound` does."""
    whole = data if audio is None else {**data, "audio": sound(audio)}
    text = json.dumps(whole, separators=(",", ":"))
    # Within a script element `</` and `<!--` have a meaning, so that no such character may stand there as it is.
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def _phonemes(bands: Sequence[Band], start: float, fps: float, count: int) -> List[Dict[str, Any]]:
    """The bands in frames of the page, cut to the motion; bands shorter than a frame are omitted."""
    def frame(seconds: float) -> int:
        return min(max(math.floor((seconds - start) * fps + 0.5 + 1e-6), 0), count)  # halves up, as the library does

    sounding = "laughter" if laughs(bands) else "speech"
    phonemes = []
    for band in bands:
        first, last = frame(band.start), frame(band.end)
        if last > first:
            phonemes.append({"label": band.label, "start_frame": first, "frames": last - first,
                             "kind": "silence" if band.kind == "silence" else sounding})
    return phonemes


def sound(path: PathLike) -> str:
    """A sound file as a data URL."""
    try:
        size = os.path.getsize(path)
        content = b"" if size > limits.PAGE else Path(path).read_bytes()
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    if size > limits.PAGE:
        most = limits.PAGE // 1_000_000
        raise DataError(path, None, f"a page takes a sound of {most} MB at most, and this one has {size / 1e6:.1f} MB; "
                                    "as MP3 or Ogg it is shorter")  # fmt: skip
    for offset, start, kind in _SOUNDS:
        if re.match(start, content[offset : offset + 16], re.DOTALL):
            return f"data:{kind};base64," + base64.b64encode(content).decode("ascii")
    raise DataError(path, None, "not a sound that browsers play: a WAV, MP3, Ogg, FLAC, AAC, M4A or WebM file")
