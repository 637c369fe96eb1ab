"""Finds the talker's face among the faces of a video, follows it, and leaves out where the head is turned too far."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.capture.landmarks import INDEX, Landmarks
from labial.defaults import WHICH_FACE
from labial.errors import DataError, PathLike
from labial.files.frames import spans_told

#: A face that is lost for longer, in seconds, starts a new track, joined to the old one if both are in one place.
_LINK = 0.5
#: Two faces are one where their middles are less than this share of the height apart, from frame to frame and at all.
_STEP, _PLACE = 0.5, 1.0
#: Faces of less than this share of the talker's height are background.
_BACKGROUND = 0.5
#: Seconds that another face may be seen: a tracker may mistake something for a face this long.
_GLIMPSE = 0.2
#: Share of the frames in which a face is seen that may be asked for.
_LASTING = 0.2
_TOP, _CHIN = 10, 152  # landmarks


@dataclass
class Track:
    """A face, followed over the frames."""

    frames: List[int] = field(default_factory=list)  #: numbers of the frames in which it is seen
    points: List[np.ndarray] = field(default_factory=list)  #: (478, 3) landmarks in each, pixels

    @property
    def middle(self) -> np.ndarray:
        """(2,) median of the face's middle, pixels."""
        return np.median([_middle(points) for points in self.points], axis=0)

    @property
    def height(self) -> float:
        """Median from forehead to chin, pixels."""
        return float(np.median([_height(points) for points in self.points]))


def talker(path: PathLike, times: np.ndarray, seen: Sequence[Sequence[np.ndarray]], face: Optional[str]) -> np.ndarray:
    """(T, 478, 3) landmarks of the talker's face, NaN where it is not seen. `seen` has the landmarks (478, 3), pixels,
    of every face in each of the frames at `times` (T,), seconds. `face` is one of `WHICH_FACE`; without, there must be
    one face only, smaller ones in the background aside. Raises DataError where there is none or more than one."""
    tracks = _tracks(times, seen)
    if not tracks:
        raise DataError(path, None, "no face is found in any frame")
    main = _chosen(tracks, len(times), face)
    step = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    result = np.full((len(times), *main.points[0].shape), np.nan, np.float32)
    result[main.frames] = main.points
    taken = set(main.frames)
    for track in tracks:
        if track is main:
            continue
        apart = float(np.hypot(*(track.middle - main.middle)))
        if apart < _PLACE * main.height and taken.isdisjoint(track.frames):
            result[track.frames] = track.points
            taken.update(track.frames)
        elif face is None and track.height >= _BACKGROUND * main.height and len(track.frames) * step > _GLIMPSE:
            first, last = times[track.frames[0]], times[track.frames[-1]]
            raise DataError(path, None, f"two faces, the second from {first:.2f} to {last:.2f} s: say with --face "
                            f"{', '.join(WHICH_FACE[:-1])} or {WHICH_FACE[-1]} which is the talker's")
    return result


def _tracks(times: np.ndarray, seen: Sequence[Sequence[np.ndarray]]) -> List[Track]:
    """Faces linked over the frames: each is the one that was nearest to its place a moment ago."""
    tracks: List[Track] = []
    for number, faces in enumerate(seen):
        live = [track for track in tracks if times[number] - times[track.frames[-1]] <= _LINK]
        pairs = sorted((apart, i, j) for i, points in enumerate(faces) for j, track in enumerate(live)
                       if (apart := _apart(points, track.points[-1])) < _STEP)
        free = set(range(len(faces)))
        for _, i, j in pairs:
            if i in free and live[j].frames[-1] != number:
                live[j].frames.append(number)
                live[j].points.append(faces[i])
                free.remove(i)
        here = [track.points[-1] for track in live if track.frames[-1] == number]
        for i in sorted(free):  # a tracker may find one face twice
            if all(_apart(faces[i], other) >= _STEP for other in here):
                tracks.append(Track([number], [faces[i]]))
                here.append(faces[i])
    return tracks


def _apart(points: np.ndarray, other: np.ndarray) -> float:
    """The distance of a face from another one, in the other's heights."""
    return float(np.hypot(*(_middle(points) - _middle(other))) / _height(other))


def _chosen(tracks: Sequence[Track], count: int, face: Optional[str]) -> Track:
    """The talker's longest track."""
    if face is None:
        return max(tracks, key=lambda track: track.height * len(track.frames))
    lasting = [track for track in tracks if len(track.frames) >= _LASTING * count] or list(tracks)
    tallest = max(lasting, key=lambda track: track.height)
    if face == "largest":
        return tallest
    near = [track for track in lasting if track.height >= _BACKGROUND * tallest.height]
    return (min if face == "left" else max)(near, key=lambda track: float(track.middle[0]))


def _middle(points: np.ndarray) -> np.ndarray:
    return np.asarray(points[:, :2].mean(axis=0))


def _height(points: np.ndarray) -> float:
    return float(np.hypot(*(points[_CHIN, :2] - points[_TOP, :2])))


# ---- The direction of a head, and frames in which it is turned too far to see the mouth ------------------------------

#: Degrees to a side, and up or down from where the talker's head mostly is. Drawn faces that were turned as far as
#: MediaPipe then said (docs/record.md) kept their closures to a third of a lip's way within; beyond, a side of closed
#: lips was seen open, or openings were seen half.
MOST_YAW, MOST_PITCH = 20.0, 20.0


def head_angles(points: np.ndarray) -> np.ndarray:
    """(T, 2) yaw and pitch in degrees of landmarks (T, len(USED), 3): by the outer corners of the eyes, and by forehead
    and chin, which lie about upright in a head that looks straight ahead."""
    across = points[:, INDEX[263]] - points[:, INDEX[33]]
    down = points[:, INDEX[152]] - points[:, INDEX[10]]
    turned = [np.arctan2(across[:, 2], across[:, 0]), np.arctan2(down[:, 2], down[:, 1])]
    return np.asarray(np.degrees(np.stack(turned, axis=1)))


def facing(landmarks: Landmarks) -> Tuple[Landmarks, str]:
    """The landmarks with NaN in the frames in which the head is turned too far, and a message about these frames, empty
    if there are none or if landmarks have no depth."""
    if landmarks.points.shape[2] < 3:
        return landmarks, ""
    angles = head_angles(landmarks.points)
    angles[:, 1] -= np.nanmedian(angles[:, 1])
    seen = np.isfinite(angles).all(axis=1)
    away = seen & (abs(np.where(seen[:, None], angles, 0.0)) > (MOST_YAW, MOST_PITCH)).any(axis=1)
    if not away.any():
        return landmarks, ""
    points = landmarks.points.copy()
    points[away] = np.nan
    yaw, pitch = abs(angles[away]).max(axis=0)
    return replace(landmarks, points=points), (
        f"the head is turned too far from {spans_told(landmarks.times, away, 4)}: by up to {yaw:.0f} degrees to a side "
        f"and {pitch:.0f} up or down, {MOST_YAW:.0f} and {MOST_PITCH:.0f} at most; these frames count as lost")
