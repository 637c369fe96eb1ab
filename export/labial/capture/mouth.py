"""From face landmarks to FAPs, by the method of the corpus that the bundled speech model is trained on.

(1) Each frame is turned, scaled and shifted so that eye corners, nose bridge and forehead lie on the talker's mean
head: what is left is the mouth's own motion. (2) The head's axes are its own: x from eye to eye, y from the forehead to
the chin at rest, z at right angles to both. (3) The neutral mouth is the median over the talker's silences. (4) FAPs
are displacements from it in 1/1024 of the neutral face's mouth-nose separation (MNS) or mouth width (MW).

Two channels are estimated. FAP 17, the top lip's protrusion, is 400 times the tracker's mouthPucker score, since the
trackers' depth of the top lip has the wrong sign; where no score was kept, it is estimated from the corners' narrowing.
FAP 16, the bottom lip's, is the tracker's depth, which is weak; from landmarks without depth it is estimated from FAP
52. Both estimates were fitted on the 803 utterances of GRID's talker s1: FAP 17 with a correlation of .91 and an RMS
error of 12 (standard deviation 27), FAP 16 with .91 and 46 (106).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.capture.landmarks import HEAD, INDEX, USED, Landmarks
from labial.corpus.episode import Segment
from labial.corpus.iemocap import align_head
from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.files.frames import spans

#: Seconds that a face may be lost and is interpolated, or held at the ends.
LONGEST_GAP = 0.2
#: Share of a recording's frames that may be lost.
MOST_LOST = 0.2
#: Seconds of silence that make a neutral mouth; with less, it is that of the frames whose lips are closest.
_LEAST_SILENCE = 0.5
_EDGE = 0.05  # seconds at a silence's ends that still belong to its neighbours

_X, _Y, _Z = 0, 1, 2
#: FAP -> landmark, axis, sign, face unit. The image's y grows down, its z away from the camera.
_TABLE = {
    3: (152, _Y, +1, "MNS"),
    16: (17, _Z, -1, "MNS"),
    51: (0, _Y, +1, "MNS"),
    52: (17, _Y, -1, "MNS"),
    53: (291, _X, +1, "MW"),
    54: (61, _X, -1, "MW"),
    55: (269, _Y, +1, "MNS"),
    56: (39, _Y, +1, "MNS"),
    57: (405, _Y, -1, "MNS"),
    58: (181, _Y, -1, "MNS"),
    59: (291, _Y, -1, "MNS"),
    60: (61, _Y, -1, "MNS"),
}
assert sorted([*_TABLE, 17]) == sorted(FAP_NUMBERS)
_CHANNEL = {number: channel for channel, number in enumerate(FAP_NUMBERS)}

_PUCKER = 400.0  # FAP 17 of the score 1
_NARROW, _NARROW_FROM = 2.6, 55.0  # FAP 17 per MW/1024 of narrowing beyond the second figure
_ROLL = 0.52  # FAP 16 per FAP 52


@dataclass(frozen=True)
class Recording:
    """Landmarks and phonemes."""

    landmarks: Landmarks
    segments: Tuple[Segment, ...]


def faps(recordings: Sequence[Recording], silence: str) -> List[np.ndarray]:
    """(T, 13) FAPs of each of one talker's recordings; `silence` is its label in the segments. NaN where no face is
    seen. Raises LabialError when the landmarks are not those of a face."""
    aligned = _aligned([item.landmarks.points for item in recordings])
    neutral = _neutral(recordings, aligned, silence)
    axes = _axes(neutral)
    face = neutral @ axes
    units = _units(face)
    result = []
    for item, points in zip(recordings, aligned):
        moved = points @ axes - face
        values = np.empty((len(moved), CHANNELS))
        for number, (landmark, axis, sign, unit) in _TABLE.items():
            if axis < moved.shape[2]:
                values[:, _CHANNEL[number]] = sign * 1024 / units[unit] * moved[:, INDEX[landmark], axis]
        if moved.shape[2] == 2:
            values[:, _CHANNEL[16]] = _ROLL * values[:, _CHANNEL[52]]
        pucker, narrowing = item.landmarks.pucker, -(values[:, _CHANNEL[53]] + values[:, _CHANNEL[54]])
        values[:, _CHANNEL[17]] = (_NARROW * np.maximum(narrowing - _NARROW_FROM, 0.0) if pucker is None
                                   else _PUCKER * pucker)
        result.append(values)
    return result


def fill(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """`values` (T, 13) with lost frames, which are NaN, interpolated linearly in time, and held at the ends. Raises
    ValueError, which says where, for a gap over `LONGEST_GAP` and for more than `MOST_LOST` of the frames."""
    lost = ~np.isfinite(values).all(axis=1)
    if not lost.any():
        return values
    if lost.mean() > MOST_LOST:
        raise ValueError(f"{lost.mean():.0%} of the frames have no face that can be used, at most {MOST_LOST:.0%} may")
    step = float(np.median(np.diff(times)))
    for first, end in spans(lost):
        length = float(times[end - 1] - times[first]) + step
        if length > LONGEST_GAP + 1e-6:
            raise ValueError(f"frames {first} to {end - 1} have no face for {length:.2f} s, "
                             f"from {times[first]:.2f} s on; at most {LONGEST_GAP:g} s can be filled")
    known = ~lost
    return np.stack([np.interp(times, times[known], channel[known]) for channel in values.T], axis=1)


def _aligned(every: Sequence[np.ndarray]) -> List[np.ndarray]:
    weights = np.zeros(len(USED))
    weights[[INDEX[number] for number in HEAD]] = 1.0
    everything = np.concatenate(every)
    reference = everything[int(np.argmax(np.isfinite(everything[:, 0, 0])))]
    for _ in range(3):  # the mean head becomes more accurate as the frames are aligned
        aligned = [align_head(points, reference, weights, scale=True) for points in every]
        reference = np.nanmedian(np.concatenate(aligned), axis=0)
    return aligned


def _neutral(recordings: Sequence[Recording], aligned: Sequence[np.ndarray], silence: str) -> np.ndarray:
    """(M, D) median face over the inner part of the silences."""
    still, seconds = [], 0.0
    for item, points in zip(recordings, aligned):
        times, seen = item.landmarks.times, np.isfinite(points[:, 0, 0])
        step = float(np.median(np.diff(times)))
        for segment in item.segments:
            if segment.label == silence:
                inner = seen & (times >= segment.start + _EDGE) & (times < segment.end - _EDGE)
                still.append(points[inner])
                seconds += inner.sum() * step
    if seconds >= _LEAST_SILENCE:
        return np.asarray(np.median(np.concatenate(still), axis=0))
    pool = np.concatenate(aligned)
    pool = pool[np.isfinite(pool[:, 0, 0])]
    aperture = np.linalg.norm(pool[:, INDEX[17]] - pool[:, INDEX[0]], axis=1)
    return np.asarray(np.median(pool[aperture <= np.quantile(aperture, 0.2)], axis=0))


def _axes(neutral: np.ndarray) -> np.ndarray:
    """(D, D) columns: the head's x, y and z."""
    right = (neutral[INDEX[33]] + neutral[INDEX[133]]) / 2
    left = (neutral[INDEX[263]] + neutral[INDEX[362]]) / 2
    x, down = left - right, neutral[INDEX[152]] - neutral[INDEX[10]]
    x = x / np.linalg.norm(x)
    y = down - (down @ x) * x
    y = y / np.linalg.norm(y)
    return np.stack([x, y] if len(x) == 2 else [x, y, np.cross(x, y)], axis=1)


def _units(face: np.ndarray) -> Dict[str, float]:
    """MNS and MW of a neutral face in its own axes; refuses impossible faces."""
    eyes = face[INDEX[263], _X] - face[INDEX[33], _X]
    mouth_line = (face[INDEX[13], _Y] + face[INDEX[14], _Y]) / 2
    units = {"MNS": mouth_line - face[INDEX[2], _Y], "MW": face[INDEX[291], _X] - face[INDEX[61], _X]}
    for name, unit in units.items():
        if not 0.08 * eyes < unit < 2.0 * eyes:
            raise LabialError(f"the neutral face's {name} is {unit / eyes:.2f} of the distance of its eyes: "
                              "these are not the landmarks of a face")
    if face.shape[1] == 3:
        nose = (face[[INDEX[33], INDEX[263]], _Z].mean() - face[INDEX[4], _Z]) / eyes
        if not 0.1 < nose < 1.5:
            raise LabialError(f"the nose's tip stands out {nose:.2f} of the distance of the eyes: "
                              "z must grow away from the camera, in the unit of x")
    return units
