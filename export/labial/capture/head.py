"""The direction of a head, and frames in which it is turned too far to see the mouth."""

from __future__ import annotations

from dataclasses import replace
from typing import Tuple

import numpy as np

from labial.capture.landmarks import INDEX, Landmarks
from labial.files.frames import spans_told

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
    return replace(landmarks, points=points), _said(landmarks, away, angles)


def _said(landmarks: Landmarks, away: np.ndarray, angles: np.ndarray) -> str:
    yaw, pitch = abs(angles[away]).max(axis=0)
    return (f"the head is turned too far from {spans_told(landmarks.times, away, 4)}: by up to {yaw:.0f} degrees to a "
            f"side and {pitch:.0f} up or down, {MOST_YAW:.0f} and {MOST_PITCH:.0f} at most; these frames count as lost")
