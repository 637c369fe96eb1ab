"""Frames as animation files: MPEG-4 .fap, Live Link Face CSV, JSON lines. CSV is in labial.files.frames.

`FORMATS` lists them, with the names of tools/say/frames.c. The descriptions in this folder, which say how FAPs move
ARKit's blendshapes, VRM's mouths and the visemes of Oculus LipSync, are formats, too. Functions import numpy and the
parser of TOML themselves, since the command line needs only the names of formats.
"""

from __future__ import annotations

import functools
import json
import re
from typing import TYPE_CHECKING, Callable, Dict, Iterable, NamedTuple, Optional, Sequence, TextIO, Tuple, Union

from labial.files.faps import CHANNELS, FAP_COLUMNS, FAP_NUMBERS
from labial.rig import FACES, description_of

if TYPE_CHECKING:
    import numpy as np

    from labial.rig.description import Rig

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


@functools.cache
def face(name: str) -> Rig:
    """A built-in rig: `name` is one of `labial.rig.FACES`."""
    from labial.rig.description import read

    return read(description_of(name), name)


def outputs(rig: Rig, frames: np.ndarray, shares: Optional[np.ndarray] = None) -> Dict[str, np.ndarray]:
    """(T,) values of each output of a rig from (T, 13) frames in FAP units and, if known, (T, 15) shares of sounds
    (:mod:`labial.reference.visemes`), in the unit of the description: for weights 0 .. 1, for servos microseconds.
    Limits of values apply, limits of speed do not."""
    import numpy as np

    from labial.rig.table import convert, expected

    values = expected(rig, convert(rig), np.asarray(frames, dtype=np.float64), shares) / rig.unit.scale
    return {output.name: column for output, column in zip(rig.outputs, values.T)}


def with_shares(frames: np.ndarray, phonemes: Sequence[Tuple[str, int]], fps: int) -> np.ndarray:
    """(T, 28) frames with the shares of the sounds that they show, of (T, 13) frames that `phonemes`, ARPABET and
    milliseconds, lead to. Every format takes either."""
    import numpy as np

    from labial.reference.visemes import shares

    return np.concatenate([frames, shares(phonemes, fps, len(frames))], axis=1)


#: ARKit's blendshapes by the columns of `LIVE_LINK`.
_ARKIT = {column: column[0].lower() + column[1:] for column in LIVE_LINK}


def arkit(frames: np.ndarray, shares: Optional[np.ndarray] = None) -> Dict[str, np.ndarray]:
    """(T,) weights 0 .. 1 of each of ARKit's blendshapes of the mouth that the rig moves, in the order of `LIVE_LINK`,
    from (T, 13) frames in FAP units and, if known, (T, 15) shares of sounds."""
    found = outputs(face("arkit"), frames, shares)
    return {name: found[name] for name in _ARKIT.values() if name in found}


#: Gives values by output for frames (n, 13), shares of their sounds (n, 15) if there are any, and the number of the
#: first frame, like `outputs`.
Mover = Callable[["np.ndarray", Optional["np.ndarray"], int], Dict[str, "np.ndarray"]]


def _parts_of(frames: np.ndarray) -> Tuple[np.ndarray, Optional[np.ndarray]]:
    """The FAPs of frames, and the shares of their sounds if there are any."""
    return frames[:, :CHANNELS], frames[:, CHANNELS:] if frames.shape[1] > CHANNELS else None


def _fap_rows(out: TextIO, frames: np.ndarray, first: int, fps: int) -> None:
    """MPEG-4 text: per frame a mask of 68 and the values of the 23 FAPs of the mouth, inner lips (4 to 13) moving as
    the outer ones (51 to 60), and those of the tongue (43 to 47) where there are sounds."""
    import numpy as np

    from labial.reference.visemes import tongue

    frames, shares = _parts_of(frames)
    columns = {fap: index for index, fap in enumerate(FAP_NUMBERS)}
    if shares is not None:
        columns.update({43 + k: CHANNELS + k for k in range(5)})
        frames = np.concatenate([frames, tongue(shares)], axis=1)
    columns.update({fap: columns[fap + 47] for fap in range(4, 14)})
    used = sorted(columns)
    mask = " ".join("1" if fap in columns else "0" for fap in range(1, _FAPS + 1))
    for number, frame in enumerate(np.rint(frames).astype(int), first):
        out.write(f"{mask}\n{number} " + " ".join(str(frame[columns[fap]]) for fap in used) + "\n")


def _live_link_rows(out: TextIO, frames: np.ndarray, first: int, fps: int) -> None:
    """Like a recording of Live Link Face: timecode ``HH:MM:SS:FF.000``, 61, then the columns."""
    weights = arkit(*_parts_of(frames))
    columns = [weights.get(name, [0.0] * len(frames)) for name in _ARKIT.values()]
    for number, row in enumerate(zip(*columns), first):
        seconds, frame = divmod(number, fps)
        timecode = f"{seconds // 3600:02}:{seconds // 60 % 60:02}:{seconds % 60:02}:{frame:02}.000"
        out.write(",".join((timecode, str(len(LIVE_LINK)), *(f"{value:.3f}" for value in row))) + "\n")


def _json_rows(out: TextIO, frames: np.ndarray, first: int, fps: int, *, rig: Union[Rig, str] = "arkit",
               with_faps: bool = True, move: Optional[Mover] = None) -> None:
    """One JSON object per line: frame, time in seconds, faps unless `with_faps` is False, and under the rig's name its
    outputs, as `outputs` gives them, or `move`. `rig` may be the name of a built-in one."""
    import numpy as np

    rig = face(rig) if isinstance(rig, str) else rig
    frames, shares = _parts_of(frames)
    values = move(frames, shares, first) if move else outputs(rig, frames, shares)
    for number, (frame, row) in enumerate(zip(frames, np.stack(list(values.values()), axis=1)), first):
        out.write(json.dumps({"frame": number, "time": round(number / fps, 3),
                              **({"faps": dict(zip(FAP_COLUMNS, np.round(frame, 2).tolist()))} if with_faps else {}),
                              rig.name: dict(zip(values, np.round(row, 3).tolist()))}, separators=(",", ":")) + "\n")


def _csv_head(name: str, fps: int, count: int) -> str:
    from labial.files.frames import CSV_HEAD

    return CSV_HEAD


def _csv_rows(out: TextIO, frames: np.ndarray, first: int, fps: int) -> None:
    from labial.files.frames import write_csv_rows

    write_csv_rows(out, frames[:, :CHANNELS], first, fps)


class Format(NamedTuple):
    """A format of output."""

    about: str  #: its text in ``--help``
    #: Writes to a text file: (n, 13) frames in FAP units, or (n, 28) with shares, the number of the first, frames per
    #: second.
    rows: Callable[[TextIO, np.ndarray, int, int], None]
    #: The header, from the motion's name, frames per second and number of frames.
    head: Callable[[str, int, int], str] = lambda *_: ""

    def write(self, out: TextIO, parts: Iterable[np.ndarray], fps: int, name: str, count: int) -> None:
        """Writes a motion of `count` frames, which come in parts (n, 13) in FAP units."""
        out.write(self.head(name, fps, count))
        first = 0
        for part in parts:
            self.rows(out, part, first, fps)
            first += len(part)

    def of_rig(self, rig: Rig, move: Optional[Mover] = None) -> Format:
        """Lines of JSON with another rig than ARKit's, which moves as `outputs` or as `move` has it."""
        return self._replace(rows=functools.partial(_json_rows, rig=rig, move=move))


#: Every format by its name, which ``--to`` takes.
FORMATS: Dict[str, Format] = {
    "csv": Format("FAPs, a line per frame", _csv_rows, _csv_head),
    "fap": Format("MPEG-4 text", _fap_rows, lambda name, fps, count:
                  f"2.1 {re.sub(r'[^0-9A-Za-z_.-]+', '_', name) or 'labial'} {fps} {count}\n"),
    "livelink": Format("Live Link Face CSV, ARKit's blendshapes", _live_link_rows,
                       lambda *_: ",".join(("Timecode", "BlendShapeCount", *LIVE_LINK)) + "\n"),
    "jsonl": Format("FAPs and ARKit's blendshapes, a line of JSON per frame", _json_rows),
    **{name: Format("weights alone, a line of JSON per frame",
                    functools.partial(_json_rows, rig=name, with_faps=False)) for name in FACES},
}
