"""Face landmarks of a video, as MediaPipe's Face Landmarker or Face Mesh numbers them, from .npz, .npy and .csv files.

=======  ==========================================================================================================
.npz     ``landmarks`` (T, 468 or 478, 2 or 3); ``fps`` or ``times`` (T,) in seconds; ``size`` (width, height) in
         pixels where coordinates are shares of it; ``pucker`` (T,), the tracker's mouthPucker score, if it has one
.npy     the array of landmarks alone
.csv     a header, then a line per frame: ``time`` in seconds (or no such column), ``xN,yN`` and, for all or none,
         ``zN`` of each landmark N of `USED` (others are ignored), and ``pucker`` if there is one
=======  ==========================================================================================================

x grows to the right of the image, y down, z away from the camera in the unit of x. A frame without a face is NaN (in a
.csv an empty field or ``nan``).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import numpy as np

from labial.corpus.timings import LONGEST
from labial.errors import DataError, LabialError, PathLike
from labial.files import limits
from labial.files.arrays import ArrayError, array, read_zip
from labial.files.grammar import columns_of, number_or_nan, read_bytes, read_lines, table_rows

#: Landmarks that follow the skull: the corners of both eyes, the bridge of the nose, the forehead.
HEAD = (33, 133, 362, 263, 168, 6, 197, 195, 151, 10)
#: Middle and half-way points of the outer lip's contour, its corners, the middle of the inner lips.
MOUTH = (0, 17, 61, 291, 39, 269, 181, 405, 13, 14)
#: All used landmarks: head and mouth, chin, the nose's tip and the point below the nose.
USED = (*HEAD, *MOUTH, 152, 4, 2)
#: Where a landmark stands in `USED`.
INDEX = {number: place for place, number in enumerate(USED)}

_ARRAYS = ("landmarks", "fps", "times", "size", "pucker")
_COUNTS = (468, 478)
_SIDES = (16, 100000)  # pixels
_RATES = (1.0, 1000.0)  # frames per second
_LARGEST_COORDINATE = 1e6  # pixels


@dataclass(frozen=True)
class Given:
    """Properties from the user that files do not state."""

    fps: Optional[float] = None  #: frames per second
    size: Optional[Tuple[int, int]] = None  #: width and height of the video, pixels


@dataclass(frozen=True)
class Landmarks:
    """The landmarks of one recording."""

    path: Path
    times: np.ndarray  #: (T,) seconds, strictly increasing
    points: np.ndarray  #: (T, len(USED), 2 or 3), one unit for all axes; all NaN in a frame that lacks any of them
    pucker: Optional[np.ndarray]  #: (T,) the tracker's score, 0 .. 1; NaN in a frame without a face


def parse_size(text: str) -> Tuple[int, int]:
    """Width and height from "1280x720"; raises LabialError."""
    match = re.fullmatch(r"([0-9]{1,6})[xX]([0-9]{1,6})", text.strip())
    if not match:
        raise LabialError(f"the size {text!r} is not WIDTHxHEIGHT in pixels, such as 1280x720")
    size = int(match.group(1)), int(match.group(2))
    if not all(_SIDES[0] <= side <= _SIDES[1] for side in size):
        raise LabialError(f"the size {text!r} is not within {_SIDES[0]} .. {_SIDES[1]} pixels a side")
    return size


def read_landmarks(path: PathLike, given: Given) -> Landmarks:
    """Reads one recording. Raises DataError, which names the frame (counted from 0) or the line where there is one."""
    if given.fps is not None and not _RATES[0] <= given.fps <= _RATES[1]:
        raise LabialError(f"{given.fps:g} frames per second are not within {_RATES[0]:g} .. {_RATES[1]:g}")
    suffix = Path(path).suffix.lower()
    if suffix == ".csv":
        times, points, pucker = _read_csv(path)
        size = given.size
    elif suffix in (".npy", ".npz"):
        table = _load(path)
        points, pucker = _array(path, table), _scores(path, table)
        times = _times(path, table, len(points), given)
        size = _size(path, table, given)
    else:
        raise DataError(path, None, "landmarks are .npz, .npy or .csv files")
    if times is None:
        if given.fps is None:
            raise DataError(path, None, "the file does not tell the frame rate: give --fps")
        times = np.arange(len(points)) / given.fps
    if len(points) < 2:
        raise DataError(path, None, "fewer than two frames")
    lost = ~np.isfinite(points).all(axis=(1, 2))
    points = points.copy()
    points[lost] = np.nan
    if lost.all():
        raise DataError(path, None, "no frame has a face")
    _check_orientation(path, points)
    return Landmarks(Path(path), times, points * _pixels(path, points, size), pucker)


def _pixels(path: PathLike, points: np.ndarray, size: Optional[Tuple[int, int]]) -> np.ndarray:
    """Factors of x, y and z that bring `points` to one unit."""
    eyes = np.nanmedian(np.abs(points[:, INDEX[263], 0] - points[:, INDEX[33], 0]))
    if not eyes < 1:
        return np.ones(points.shape[2])
    if size is None:  # eyes less than a pixel apart: coordinates are shares of the image
        raise DataError(path, None, "coordinates are shares of the image, whose size the file does not tell: "
                        "give --size WIDTHxHEIGHT")
    return np.array([*size, size[0]], dtype=float)[: points.shape[2]]


def _check_orientation(path: PathLike, points: np.ndarray) -> None:
    eyes = points[:, [INDEX[33], INDEX[263]]]
    mouth = points[:, [INDEX[61], INDEX[291]]]
    if not np.nanmedian(mouth[:, :, 1].mean(axis=1) - eyes[:, :, 1].mean(axis=1)) > 0:
        raise DataError(path, None, "the mouth is not below the eyes: y must grow downwards, and the head be upright")
    if not np.nanmedian(eyes[:, 1, 0] - eyes[:, 0, 0]) > 0:
        raise DataError(path, None, "left and right are exchanged: landmark 33 must lie left of 263 in the image")


def _load(path: PathLike) -> Dict[str, np.ndarray]:
    try:
        if Path(path).suffix.lower() == ".npy":
            return {"landmarks": array("the array", read_bytes(path, limits.LANDMARKS))}
        members = read_zip(path, [f"{name}.npy" for name in _ARRAYS], limits.LANDMARKS)
        return {name[:-4]: array(name[:-4], data) for name, data in members.items()}
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    except ArrayError as error:
        raise DataError(path, None, f"not a NumPy file: {error}") from None


def _array(path: PathLike, table: Dict[str, np.ndarray]) -> np.ndarray:
    if "landmarks" not in table:
        raise DataError(path, None, "no array 'landmarks'")
    points = table["landmarks"]
    if points.ndim != 3 or points.shape[1] not in _COUNTS or points.shape[2] not in (2, 3):
        raise DataError(path, None, f"landmarks have the shape {points.shape}, not (frames, 468 or 478, 2 or 3)")
    points = _numbers(path, "landmarks", points[:, list(USED)])
    wrong = (np.abs(points) > _LARGEST_COORDINATE).any(axis=(1, 2))
    if wrong.any():
        raise DataError(path, None, f"frame {int(np.argmax(wrong))}: a coordinate is beyond {_LARGEST_COORDINATE:g}")
    return points


def _scores(path: PathLike, table: Dict[str, np.ndarray]) -> Optional[np.ndarray]:
    if "pucker" not in table:
        return None
    pucker = _numbers(path, "pucker", table["pucker"])
    count = len(table["landmarks"])
    if pucker.shape != (count,):
        raise DataError(path, None, f"pucker has the shape {pucker.shape}, but there are {count} frames")
    wrong = (pucker < 0) | (pucker > 1)
    if wrong.any():
        frame = int(np.argmax(wrong))
        raise DataError(path, None, f"frame {frame}: the score pucker is {pucker[frame]:g}, not within 0 .. 1")
    return pucker


def _times(path: PathLike, table: Dict[str, np.ndarray], count: int, given: Given) -> Optional[np.ndarray]:
    if "times" in table:
        times = _numbers(path, "times", table["times"])
        if times.shape != (count,):
            raise DataError(path, None, f"times have the shape {times.shape}, but there are {count} frames")
        for frame in range(count):
            if not abs(times[frame]) <= LONGEST or (frame and times[frame] <= times[frame - 1]):
                raise DataError(path, None, f"frame {frame}: time {times[frame]:g} does not follow the one before")
        return times
    if "fps" not in table:
        return None
    rate = _numbers(path, "fps", table["fps"])
    fps = rate.item() if rate.size == 1 else np.nan
    if not _RATES[0] <= fps <= _RATES[1]:
        raise DataError(path, None, f"fps is not one number within {_RATES[0]:g} .. {_RATES[1]:g}")
    if given.fps is not None and abs(given.fps - fps) > 0.01:
        raise DataError(path, None, f"--fps says {given.fps:g} frames per second, the file {fps:g}")
    return np.arange(count) / fps


def _size(path: PathLike, table: Dict[str, np.ndarray], given: Given) -> Optional[Tuple[int, int]]:
    if "size" not in table:
        return given.size
    size = _numbers(path, "size", table["size"])
    if size.shape != (2,) or not ((size >= _SIDES[0]) & (size <= _SIDES[1])).all():
        raise DataError(path, None, "size is not width and height in pixels")
    own = int(size[0]), int(size[1])
    if given.size is not None and given.size != own:
        raise DataError(path, None, f"--size says {given.size[0]}x{given.size[1]}, the file {own[0]}x{own[1]}")
    return own


def _numbers(path: PathLike, name: str, array: np.ndarray) -> np.ndarray:
    if array.dtype.kind not in "fiu":
        raise DataError(path, None, f"{name} are {array.dtype}, not real numbers")
    return array.astype(np.float64)


def _read_csv(path: PathLike) -> Tuple[Optional[np.ndarray], np.ndarray, Optional[np.ndarray]]:
    lines = read_lines(path)
    names = columns_of(lines[0]) if lines else []
    if len(set(names)) != len(names):
        raise DataError(path, 1, "two columns have the same name")
    axes = "xyz" if any(re.fullmatch(r"z[0-9]+", name) for name in names) else "xy"
    wanted = [f"{axis}{number}" for number in USED for axis in axes]
    missing = [name for name in wanted if name not in names]
    if missing:
        raise DataError(path, 1, f"no column {', '.join(missing[:4])}{', ...' if len(missing) > 4 else ''}")
    columns = [names.index(name) for name in wanted]
    extra = [names.index(name) if name in names else None for name in ("time", "pucker")]
    rows: List[List[float]] = []
    times: List[float] = []
    scores: List[float] = []
    for line, fields in table_rows(path, lines, len(names)):
        rows.append([number_or_nan(path, line, fields[column]) for column in columns])
        if any(abs(value) > _LARGEST_COORDINATE for value in rows[-1]):
            raise DataError(path, line, f"a coordinate is beyond {_LARGEST_COORDINATE:g}")
        if extra[0] is not None:
            times.append(number_or_nan(path, line, fields[extra[0]]))
            if not abs(times[-1]) <= LONGEST or (len(times) > 1 and times[-1] <= times[-2]):
                raise DataError(path, line, f"time {fields[extra[0]]} does not follow the one before")
        if extra[1] is not None:
            scores.append(number_or_nan(path, line, fields[extra[1]]))
            if scores[-1] < 0 or scores[-1] > 1:
                raise DataError(path, line, f"the score pucker is {scores[-1]:g}, not within 0 .. 1")
    points = np.array(rows, dtype=np.float64).reshape(len(rows), len(USED), len(axes))
    return np.array(times) if times else None, points, np.array(scores) if scores else None
