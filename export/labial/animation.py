"""Frames as animation files: MPEG-4 .fap, Live Link Face CSV, JSON lines. CSV is in labial.frames.

The same formats as examples/say/frames.c writes, and the same blendshapes as examples/say/arkit.c.
"""

from __future__ import annotations

import json
import re
from typing import Callable, Dict, TextIO, Tuple

import numpy as np

from labial.faps import FAP_COLUMNS, FAP_NUMBERS
from labial.frames import write_csv

#: ARKit's blendshapes that lips and jaw move: weight at rest in thousandths, and FAP number to weight in millionths per
#: FAP unit. Weights are held to 0 .. 1.
ARKIT: Dict[str, Tuple[int, Dict[int, int]]] = {
    "jawOpen": (0, {3: 1250}),
    "mouthClose": (0, {3: 1250, 51: 1250, 52: 1250}),
    "mouthFunnel": (-400, {17: 4242, 51: -848, 52: -848, 53: -2121, 54: -2121}),
    "mouthPucker": (-100, {17: 3929, 51: 393, 52: 393, 53: -1964, 54: -1964}),
    "mouthSmileLeft": (-150, {3: 1278, 53: 3194, 59: 3194}),
    "mouthSmileRight": (-150, {3: 1278, 54: 3194, 60: 3194}),
    "mouthFrownLeft": (0, {3: -1600, 59: -4000}),
    "mouthFrownRight": (0, {3: -1600, 60: -4000}),
    "mouthStretchLeft": (0, {53: 4000, 59: -2000}),
    "mouthStretchRight": (0, {54: 4000, 60: -2000}),
    "mouthLowerDownLeft": (0, {3: -3000, 57: -3333}),
    "mouthLowerDownRight": (0, {3: -3000, 58: -3333}),
    "mouthUpperUpLeft": (0, {55: -5000}),
    "mouthUpperUpRight": (0, {56: -5000}),
}

#: Columns of a Live Link Face recording: ARKit's 52 blendshapes and 9 rotations.
LIVE_LINK = """
    EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft EyeBlinkRight
    EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight JawForward JawRight
    JawLeft JawOpen MouthClose MouthFunnel MouthPucker MouthRight MouthLeft MouthSmileLeft MouthSmileRight
    MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft MouthStretchRight
    MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft
    MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft
    BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw
    HeadPitch HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch RightEyeRoll
""".split()

#: FAPs of MPEG-4, each with an entry in the mask of a .fap file.
_FAPS = 68


def arkit(frames: np.ndarray) -> np.ndarray:
    """(T, 14) weights 0 .. 1 of the blendshapes in `ARKIT`, from (T, 13) frames in FAP units."""
    matrix, offsets = np.zeros((len(ARKIT), len(FAP_NUMBERS))), np.zeros(len(ARKIT))
    for row, (offset, weights) in enumerate(ARKIT.values()):
        offsets[row] = offset / 1e3
        for fap, weight in weights.items():
            matrix[row, FAP_NUMBERS.index(fap)] = weight / 1e6
    return np.clip(np.asarray(frames, dtype=np.float64) @ matrix.T + offsets, 0.0, 1.0)


def write_fap(out: TextIO, frames: np.ndarray, fps: int, name: str) -> None:
    """Writes (T, 13) frames as MPEG-4 text: a header, then per frame a mask of 68 and the values of the 23 FAPs of the
    mouth, inner lips (4 to 13) moving as the outer ones (51 to 60)."""
    columns = {fap: index for index, fap in enumerate(FAP_NUMBERS)}
    columns.update({fap: columns[fap + 47] for fap in range(4, 14)})
    used = sorted(columns)
    mask = " ".join("1" if fap in columns else "0" for fap in range(1, _FAPS + 1))
    out.write(f"2.1 {re.sub(r'[^0-9A-Za-z_.-]+', '_', name) or 'labial'} {fps} {len(frames)}\n")
    for number, frame in enumerate(np.rint(frames).astype(int)):
        out.write(f"{mask}\n{number} " + " ".join(str(frame[columns[fap]]) for fap in used) + "\n")


def write_live_link(out: TextIO, frames: np.ndarray, fps: int, name: str = "") -> None:
    """Writes (T, 13) frames as Live Link Face records them: timecode ``HH:MM:SS:FF.000``, 61, then the columns."""
    out.write(",".join(("Timecode", "BlendShapeCount", *LIVE_LINK)) + "\n")
    shapes = {shape[0].upper() + shape[1:]: index for index, shape in enumerate(ARKIT)}
    for number, weights in enumerate(arkit(frames)):
        seconds, frame = divmod(number, fps)
        values = [f"{weights[shapes[column]]:.3f}" if column in shapes else "0.000" for column in LIVE_LINK]
        timecode = f"{seconds // 3600:02}:{seconds // 60 % 60:02}:{seconds % 60:02}:{frame:02}.000"
        out.write(",".join((timecode, str(len(LIVE_LINK)), *values)) + "\n")


def write_json_lines(out: TextIO, frames: np.ndarray, fps: int, name: str = "") -> None:
    """Writes (T, 13) frames as one JSON object per line: frame, time in seconds, faps, arkit."""
    for number, (frame, weights) in enumerate(zip(frames, arkit(frames))):
        out.write(json.dumps({
            "frame": number,
            "time": round(number / fps, 3),
            "faps": dict(zip(FAP_COLUMNS, np.round(frame, 2).tolist())),
            "arkit": dict(zip(ARKIT, np.round(weights, 3).tolist())),
        }, separators=(",", ":")) + "\n")


#: How frames are written in each format: to a text file, (T, 13) frames in FAP units, frames per second, name.
WRITERS: Dict[str, Callable[[TextIO, np.ndarray, int, str], None]] = {
    "csv": lambda out, frames, fps, name: write_csv(out, frames, fps),
    "fap": write_fap,
    "livelink": write_live_link,
    "jsonl": write_json_lines,
}
