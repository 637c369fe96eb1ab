"""The page of a motion as text: the player, its data and its sound. It needs no numpy."""

from __future__ import annotations

import base64
import json
import os
import re
from html import escape
from pathlib import Path
from typing import Any, Dict, Optional, Sequence

from labial.errors import DataError, PathLike
from labial.files import limits
from labial.files.faps import FAP_COLUMNS

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


def player(title: str, fps: float, frames: Sequence[Sequence[int]], phonemes: Sequence[Dict[str, Any]] = (),
           start: float = 0.0, audio: Optional[PathLike] = None) -> str:
    """The page as text. `frames` are (T, 13) FAP units, the first one at `start` seconds; `phonemes` have `label`,
    `start_frame`, `frames` and `kind`, "speech", "laughter" or "silence"; `audio` is a file, as for :func:`sound`."""
    data: Dict[str, Any] = {"title": title, "fps": fps, "start": round(start, 6), "channels": list(FAP_COLUMNS),
                            "phonemes": list(phonemes), "frames": [list(frame) for frame in frames]}
    before, between, after = re.split(f"{DATA_PLACE}|{MOUTH_PLACE}", PLAYER.read_text(encoding="utf-8"))
    return before + script_data(data, audio) + between + MOUTH.read_text(encoding="utf-8") + after


def framed(page: str) -> str:
    """A page within another one, such as a notebook."""
    return f'<iframe srcdoc="{escape(page)}" style="width: 100%; height: 640px; border: 0"></iframe>'


def script_data(data: Dict[str, Any], audio: Optional[PathLike]) -> str:
    """The data and the sound, if one is given, as JSON that may stand in a script element. Raises as `sound` does."""
    text = json.dumps(data if audio is None else {**data, "audio": sound(audio)}, separators=(",", ":"))
    # Within a script element `</` and `<!--` have a meaning, so that no such character may stand there as it is.
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


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
                                    "as MP3 or Ogg it is shorter")
    for offset, start, kind in _SOUNDS:
        if re.match(start, content[offset : offset + 16], re.DOTALL):
            return f"data:{kind};base64," + base64.b64encode(content).decode("ascii")
    raise DataError(path, None, "not a sound that browsers play: a WAV, MP3, Ogg, FLAC, AAC, M4A or WebM file")
