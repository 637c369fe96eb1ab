"""IEMOCAP: 53 facial and 2 head markers at 120 frames/s and CMU Sphinx phone segmentations, per utterance.

The corpus needs a licence from its makers. Expected under its root::

    SessionN/sentences/MOCAP_rotated/<dialog>/<utterance>.txt
    SessionN/sentences/ForcedAlignment/<dialog>/<utterance>.phseg
    SessionN/sentences/wav/<dialog>/<utterance>.wav

The sound shows the apex of each phoneme; without sound the middle of each phoneme is used.

Axes of the markers: X lateral (the subject's right is negative), Y depth (larger is further back), Z up. From markers
to FAPs: (1) each frame is aligned rigidly with the dialog's mean head, on markers that skin and lips do not move, since
"rotated" data still contain some head motion; (2) the neutral mouth is the median over the dialog's silences; (3) lip
and chin displacements from it are scaled by the neutral face's mouth-nose separation and mouth width. Markers are
attached again for each session, so the neutral mouth is estimated per dialog.

In a dialog ``Ses01F_...`` only speaker F has markers: utterances ``..._M...`` show a listener and are omitted.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import numpy as np

from labial.corpus.apex import read_wave, with_apexes
from labial.corpus.episode import Episode, Segment
from labial.corpus.folder import LARGEST, check_span
from labial.corpus.phonesets import SPEECH, PhoneSet
from labial.corpus.timings import phoneme_segments, read_segments
from labial.errors import DataError, PathLike
from labial.files.faps import CHANNELS
from labial.files.grammar import fields_of, number_or_nan, read_lines

RATE = 120.0  #: frames per second of the corpus
LONGEST_GAP = 0.2  #: seconds that a marker may be missing and is interpolated or held
MOST_MISSING = 0.2  #: share of an utterance's frames in which any lip or chin marker may be missing
#: Mouth markers from the right corner over the upper lip to the left one and back over the lower lip; the chin.
MOUTH = ("Mou1", "Mou2", "Mou3", "Mou4", "Mou5", "Mou6", "Mou7", "Mou8", "CH2")
#: Markers that follow the skull, and how far to trust them: the forehead's move with the brows.
HEAD = {"MH": 1.0, "LHD": 1.0, "RHD": 1.0, "MNOSE": 1.0, "TNOSE": 1.0, "FH1": 0.1, "FH2": 0.1, "FH3": 0.1}
#: Nostrils, the upper end of the mouth-nose separation.
NOSTRILS = ("LNSTRL", "RNSTRL")
#: Channel -> marker, axis, sign, face unit. Positive: jaw and top lip down, bottom lip and corners up, lips forward,
#: corners outward.
_X, _Y, _Z = 0, 1, 2
CHANNEL_MARKERS = (
    ("CH2", _Z, -1, "MNS"),  # 3 open_jaw
    ("Mou7", _Y, -1, "MNS"), ("Mou3", _Y, -1, "MNS"),  # 16 push_b_lip, 17 push_t_lip
    ("Mou3", _Z, -1, "MNS"), ("Mou7", _Z, +1, "MNS"),  # 51 lower_t_midlip_o, 52 raise_b_midlip_o
    ("Mou5", _X, +1, "MW"), ("Mou1", _X, -1, "MW"),  # 53 and 54 stretch_*_cornerlip_o, left and right
    ("Mou4", _Z, -1, "MNS"), ("Mou2", _Z, -1, "MNS"),  # 55 and 56 lower_t_lip_*m_o
    ("Mou6", _Z, +1, "MNS"), ("Mou8", _Z, +1, "MNS"),  # 57 and 58 raise_b_lip_*m_o
    ("Mou5", _Z, +1, "MNS"), ("Mou1", _Z, +1, "MNS"),  # 59 and 60 raise_*_cornerlip_o
)

_MARKERS = (*MOUTH, *NOSTRILS, *HEAD)
_INDEX = {name: number for number, name in enumerate(_MARKERS)}


@dataclass(frozen=True)
class _Utterance:
    path: Path
    times: np.ndarray  # (T,) seconds from the utterance's first frame
    markers: np.ndarray  # (T, len(_MARKERS), 3), NaN where missing
    segments: Tuple[Segment, ...]


def read_markers(path: PathLike) -> Tuple[np.ndarray, np.ndarray]:
    """Reads a motion file: (T,) times in seconds from its first frame, and (T, len(MOUTH + NOSTRILS + HEAD), 3)
    positions of those markers, NaN where missing."""
    lines = read_lines(path)
    names = fields_of(lines[0]) if lines else []
    if names[:2] != ["Frame#", "Time"]:
        raise DataError(path, 1, "the header does not begin with 'Frame# Time'")
    missing = [name for name in _MARKERS if name not in names]
    if missing:
        raise DataError(path, 1, f"no marker {', '.join(missing)}")
    columns = [1] + [2 + 3 * (names.index(name) - 2) + axis for name in _MARKERS for axis in range(3)]
    width = 2 + 3 * (len(names) - 2)
    if len(lines) < 2 or "X01" not in fields_of(lines[1]):
        raise DataError(path, 2, "expected the axis labels 'X01 Y01 Z01 ...'")
    rows = []
    for line, text in enumerate(lines[2:], 3):
        fields = fields_of(text)
        if not fields:
            continue
        if len(fields) != width:
            raise DataError(path, line, f"{len(fields)} columns, not {width}")
        rows.append([number_or_nan(path, line, fields[column]) for column in columns])
        if math.isnan(rows[-1][0]):
            raise DataError(path, line, "the time is missing")
        if any(abs(value) > LARGEST for value in rows[-1]):
            raise DataError(path, line, f"a value is beyond {LARGEST:.0f}")
        if len(rows) > 1 and rows[-1][0] <= rows[-2][0]:
            raise DataError(path, line, f"time {rows[-1][0]:g} does not follow {rows[-2][0]:g}")
    if len(rows) < 2:
        raise DataError(path, None, "fewer than two frames")
    table = np.array(rows)
    return table[:, 0] - table[0, 0], table[:, 1:].reshape(len(rows), len(_MARKERS), 3)


def bridge_gaps(times: np.ndarray, markers: np.ndarray) -> np.ndarray:
    """`markers` (T, M, 3) with gaps of up to `LONGEST_GAP` interpolated linearly in time, and held at the ends. Raises
    ValueError, which says which marker, for a longer gap or more than `MOST_MISSING` of the frames."""
    missing = ~np.isfinite(markers).all(axis=2)  # (T, M)
    share = missing.any(axis=1).mean()
    if share > MOST_MISSING:
        raise ValueError(f"in {share:.0%} of the frames a lip or chin marker or the head is missing")
    result, step = markers.copy(), float(np.median(np.diff(times)))
    for number in np.flatnonzero(missing.any(axis=0)):
        known = ~missing[:, number]
        gap = float(np.diff(times[known], prepend=times[0] - step, append=times[-1] + step).max()) - step
        if gap > LONGEST_GAP + 1e-6:
            raise ValueError(f"marker {_MARKERS[number]} is missing for {gap:.2f} s")
        for axis in range(3):
            result[:, number, axis] = np.interp(times, times[known], markers[known, number, axis])
    return result


def markers_to_faps(markers: np.ndarray, neutral: np.ndarray) -> np.ndarray:
    """(T, 13) FAPs of aligned markers (T, M, 3) relative to the `neutral` face (M, 3), markers as :func:`read_markers`.
    MNS is the height of the nostrils over the line where the lips meet, between the two lips' centres; MW the lateral
    distance of the corners. Raises ValueError when either is not positive, as with other axes."""
    mouth_line = (neutral[_INDEX["Mou3"], _Z] + neutral[_INDEX["Mou7"], _Z]) / 2
    nostrils = neutral[[_INDEX[name] for name in NOSTRILS], _Z]
    units = {"MNS": float(np.nanmean(nostrils) - mouth_line) if np.isfinite(nostrils).any() else np.nan,
             "MW": float(neutral[_INDEX["Mou5"], _X] - neutral[_INDEX["Mou1"], _X])}
    for name, unit in units.items():
        if not unit > 0:
            raise ValueError(f"the neutral face's {name} is {unit:g}; is X to the subject's left and Z up?")
    return np.stack([sign * 1024 / units[of] * (markers[:, _INDEX[name], axis] - neutral[_INDEX[name], axis])
                     for name, axis, sign, of in CHANNEL_MARKERS], axis=1)


def neutral_face(utterances: List[_Utterance], silence: str) -> np.ndarray:
    """(M, 3) median position of each marker in the inner part of the silences of aligned utterances. With under half a
    second of silence: over the fifth of all frames in which the lips are closest to each other."""
    everything = np.concatenate([item.markers for item in utterances])
    pool = np.concatenate([everything[:0], *(
        item.markers[(item.times >= segment.start + 0.05) & (item.times < segment.end - 0.05)]
        for item in utterances for segment in item.segments if segment.label == silence)])
    if np.isfinite(pool[:, : len(MOUTH)]).all(axis=(1, 2)).sum() < RATE / 2:
        aperture = everything[:, _INDEX["Mou3"], _Z] - everything[:, _INDEX["Mou7"], _Z]
        if not np.isfinite(aperture).any():
            raise ValueError("no frame has both lips")
        pool = everything[aperture <= np.nanquantile(aperture, 0.2)]
    face = _median(pool)
    for number, name in enumerate(MOUTH):
        if not np.isfinite(face[number]).all():
            raise ValueError(f"marker {name} is never seen while the mouth is at rest")
    return face


def read_iemocap(path: PathLike, phone_set: PhoneSet = SPEECH,
                 refused: Optional[List[DataError]] = None) -> List[Episode]:
    """Reads the corpus under `path`, episodes sorted by name (times from the utterance's start, 120 frames/s).
    Malformed files raise DataError. Utterances whose motion has too many gaps, or that have motion but no phoneme
    timings, are omitted, with the reasons appended to `refused` if it is given."""
    reasons: List[DataError] = [] if refused is None else refused
    dialogs: Dict[str, List[Path]] = {}
    for file in sorted(Path(path).glob("Session*/sentences/MOCAP_rotated/*/*.txt")):
        names = re.match(r"Ses\d+([FM])_.*_([FM])[^_]*$", file.stem)
        is_listener = names is not None and names[1] != names[2]
        if not file.name.startswith(".") and not is_listener:
            dialogs.setdefault(file.parent.name, []).append(file)
    episodes = [episode for _, files in sorted(dialogs.items()) for episode in _read_dialog(files, phone_set, reasons)]
    if not episodes:
        reason = f"; the first reason is {reasons[0]}" if reasons else ""
        raise DataError(path, None, f"no usable utterance in Session*/sentences/MOCAP_rotated{reason}")
    return sorted(episodes, key=lambda episode: episode.name)


def _read_dialog(files: List[Path], phone_set: PhoneSet, refused: List[DataError]) -> List[Episode]:
    utterances = []
    for file in files:
        sentences, dialog = file.parents[2], file.parent.name
        alignment = sentences / "ForcedAlignment" / dialog / f"{file.stem}.phseg"
        if not alignment.is_file():
            refused.append(DataError(file, None, "no .phseg in ForcedAlignment"))
            continue
        segments = phoneme_segments(alignment, read_segments(alignment, "phseg"), phone_set)
        sound = sentences / "wav" / dialog / f"{file.stem}.wav"
        if sound.is_file():
            segments = with_apexes(segments, *read_wave(sound))
        times, markers = read_markers(file)
        check_span(alignment, Episode(file.stem, times, np.empty((len(times), CHANNELS)), segments))
        utterances.append(_Utterance(file, times, markers, segments))
    if not utterances:
        return []
    weights = np.array([HEAD.get(name, 0.0) for name in _MARKERS])
    reference = _median(np.concatenate([item.markers for item in utterances]))
    for _ in range(3):  # the mean head becomes more accurate as the frames are aligned
        aligned = [replace(item, markers=align_head(item.markers, reference, weights)) for item in utterances]
        reference = _median(np.concatenate([item.markers for item in aligned]))
    episodes = []
    try:
        neutral = neutral_face(aligned, phone_set.silence)
    except ValueError as error:
        refused.append(DataError(files[0].parent, None, str(error)))
        return []
    for item in aligned:
        try:
            mouth = item.markers.copy()
            mouth[:, : len(MOUTH)] = bridge_gaps(item.times, mouth[:, : len(MOUTH)])
            episodes.append(Episode(item.path.stem, item.times, markers_to_faps(mouth, neutral), item.segments))
        except ValueError as error:
            refused.append(DataError(item.path, None, str(error)))
    return episodes


def _median(markers: np.ndarray) -> np.ndarray:
    """(M, 3) median over the frames where each marker is present; NaN for markers that never are."""
    present = [item[np.isfinite(item).all(axis=1)] for item in np.moveaxis(markers, 1, 0)]
    return np.array([np.median(item, axis=0) if len(item) else np.full(3, np.nan) for item in present])


def align_head(markers: np.ndarray, reference: np.ndarray, weights: np.ndarray, scale: bool = False) -> np.ndarray:
    """Rotates and shifts each frame of `markers` (T, M, D) so that its head fits `reference` (M, D) best; D is 2 or 3.
    Weighted least squares over the markers with `weights` (M,) above 0 (Kabsch), with `scale` also a scale for each
    frame (Umeyama); frames with fewer than three such markers, or with all on a line, become NaN."""
    present = np.isfinite(markers).all(axis=2) & np.isfinite(reference).all(axis=1)  # (T, M)
    weight = present * weights
    usable = (present & (weights > 0)).sum(axis=1) >= 3
    total = np.where(usable, weight.sum(axis=1), 1.0)[:, None]
    points, target = np.where(present[..., None], markers, 0.0), np.where(np.isfinite(reference), reference, 0.0)
    centre = np.einsum("tm,tmi->ti", weight, points) / total
    target_centre = np.einsum("tm,mi->ti", weight, target) / total
    a, b = points - centre[:, None], target[None] - target_centre[:, None]
    u, s, vt = np.linalg.svd(np.einsum("tm,tmi,tmj->tij", weight, a, b))
    usable &= s[:, 1] > 1e-6 * np.maximum(s[:, 0], 1e-12)
    flip = np.ones_like(s)
    flip[:, -1] = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    rotation = np.einsum("tij,tj,tjk->tik", u, flip, vt)  # row vectors: aligned = (m - centre) @ rotation
    factor = np.ones(len(markers))
    if scale:
        spread = np.einsum("tm,tmi->t", weight, a**2)
        factor = (s * flip).sum(axis=1) / np.where(spread > 0, spread, 1.0)
    turned = np.einsum("tmi,tij->tmj", markers - centre[:, None], rotation)
    aligned = factor[:, None, None] * turned + target_centre[:, None]
    aligned[~usable] = np.nan
    return aligned
