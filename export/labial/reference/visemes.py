"""The shares of sounds in each frame (docs/method.md, Sounds that lips do not tell; ``lib/visemes.c``)."""

from __future__ import annotations

from typing import Sequence, Tuple

import numpy as np

from labial.reference.fade import EASE
from labial.reference.units import frame_counts
from labial.tables.visemes import AROUND, DOMINANCES, TONGUES, VISEME_OF, VISEMES

_PLACE = {viseme: place for place, viseme in enumerate(VISEMES)}


def shares(phonemes: Sequence[Tuple[str, int]], fps: int, count: int) -> np.ndarray:
    """(count, 15) the share of each of `VISEMES` in each frame, 0 .. 1, of ARPABET phonemes and their milliseconds;
    labels that are no phonemes of speech, such as those of laughter, are silence. In frames beyond the last the face
    comes to rest."""
    spoken = [label for (label, _), frames in zip(phonemes, frame_counts([ms for _, ms in phonemes], fps))
              for _ in range(frames)]
    known = min(len(spoken), count)
    spoken = [*spoken, *["SIL"] * count][:count]
    sounds = np.array([-1 if label == "HH" else _PLACE[VISEME_OF.get(label, "sil")] for label in spoken], dtype=int)
    period = max(1000 // fps, 1)
    dominance = np.zeros((count, len(VISEMES)))
    for place, row in enumerate(DOMINANCES.values()):
        own = np.where(sounds == place, float(row.strength), 0.0)
        for k in range((AROUND - 1) // period + 1):
            # k frames after a frame of the sound, and k frames before one
            dominance[k:, place] = np.maximum(dominance[k:, place], _left(own[: count - k], k * period * row.release))
            dominance[: count - k, place] = np.maximum(dominance[: count - k, place],
                                                       _left(own[k:], k * period * row.onset))
    total = dominance.sum(axis=1, keepdims=True)
    result: np.ndarray = np.divide(dominance, total, out=np.zeros_like(dominance), where=total > 0)
    result[total[:, 0] == 0, _PLACE["sil"]] = 1.0
    for step in range(count - known if known else 0):
        left = max(EASE - 2 - step, 0) / EASE
        result[known + step] = left * result[known - 1]
        result[known + step, _PLACE["sil"]] += 1.0 - left
    return result


def _left(strength: np.ndarray, lost: float) -> np.ndarray:
    return np.where(strength > lost, strength - lost, 0.0)


def tongue(shares: np.ndarray) -> np.ndarray:
    """(T, 5) FAPs 43 to 47 of (T, 15) shares."""
    result = np.zeros((len(shares), 5))
    result[:, 1:4] = shares @ np.array([TONGUES[viseme] for viseme in VISEMES], dtype=np.float64)
    return result
