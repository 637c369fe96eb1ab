"""``labial page``: one HTML file that plays motion, with its phonemes and its sound. It needs no network."""

from __future__ import annotations

import base64
import json
import math
import os
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

from labial.errors import DataError, LabialError
from labial.faps import FAP_COLUMNS
from labial.frames import even
from labial.see.motion import Band, Motion, laughs

PathLike = Union[str, os.PathLike]

#: The player, also that of the C demo; the motion takes the place of the words below.
PLAYER = Path(__file__).with_name("player.html")
PLACEHOLDER = "@LABIAL_DATA@"


def page(motion: Motion, bands: Sequence[Band], audio: Optional[PathLike] = None, title: Optional[str] = None) -> str:
    """The page as text; `title` is the motion's name unless given.

    `audio` is a WAV file whose time 0 is that of the motion's file. Raises DataError, which names it, when it is none,
    and LabialError for a motion whose frames are too uneven in time to be played.
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
    if audio is not None:
        data["audio"] = "data:audio/wav;base64," + base64.b64encode(_wav(audio)).decode("ascii")
    # Within a script element `</` and `<!--` have a meaning, so that no such character may stand there as it is.
    text = json.dumps(data, separators=(",", ":"))
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    before, after = PLAYER.read_text(encoding="utf-8").split(PLACEHOLDER)
    return before + text + after


def _phonemes(bands: Sequence[Band], start: float, fps: float, count: int) -> List[Dict[str, Any]]:
    """The bands in frames of the page, cut to the motion; what is shorter than a frame is left out."""
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


def _wav(path: PathLike) -> bytes:
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    if content[:4] != b"RIFF" or content[8:12] != b"WAVE":
        raise DataError(path, None, "not a WAV file")
    return content
