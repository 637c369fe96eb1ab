"""Pulses of laughter: the opening of the mouth in each vowel-like phoneme."""

from __future__ import annotations

from typing import List, Optional, Tuple

import numpy as np

from labial.corpus.phonesets import PhoneSet
from labial.evaluate.material import Utterance
from labial.evaluate.trajectories import labial_parameters

#: A pulse's peak is searched in its phoneme and this many seconds to both sides.
REACH = 0.04

#: A pulse is visible if it rises further than this percentile of the original's pulses in the training part.
SEEN_PERCENTILE = 20.0

#: Vowel-like phonemes whose beginnings are further apart than this are of two trains, milliseconds.
TRAIN_GAP = 400


def has_pulses(phone_set: PhoneSet) -> bool:
    """Whether this kind of motion is judged by pulses."""
    return phone_set.kind == "laughter"


def rises(item: Utterance, frames: np.ndarray, mask: np.ndarray, phone_set: PhoneSet, fps: int) -> np.ndarray:
    """(n,) FAP: the rise of openness in each vowel-like phoneme that has a judged frame.

    That is the greatest openness within REACH of the phoneme over the least before it, back to the middle of the
    vowel-like phoneme that came last or to the beginning. `frames` (T, 13) FAP, `mask` (T,) bool.
    """
    openness = labial_parameters(frames)[:, 0]
    reach, given = round(REACH * fps), item.timeline
    found = []
    since = 0
    for segment in given.held:
        if not phone_set.boundary[given.phoneme[segment]]:
            continue
        begin = int(given.start[segment])
        end = begin + int(given.length[segment])
        if mask[begin:end].any():
            first = max(begin - reach, since)
            peak = first + int(openness[first : end + reach].argmax())
            found.append(openness[peak] - openness[since : peak + 1].min())
        since = (begin + end) // 2
    return np.array(found)


def longest_train(item: Utterance, phone_set: PhoneSet) -> Optional[Tuple[int, int]]:
    """First and last segment of the train with the most pulses, the first of equals, with the phonemes beside it."""
    given = item.timeline
    begin = np.cumsum(given.milliseconds) - given.milliseconds
    trains: List[List[int]] = []
    for segment in np.flatnonzero(np.array(phone_set.boundary)[given.phoneme]):
        if trains and begin[segment] - begin[trains[-1][-1]] <= TRAIN_GAP:
            trains[-1].append(int(segment))
        else:
            trains.append([int(segment)])
    longest = max(trains, key=len, default=None)
    return (max(longest[0] - 1, 0), min(longest[-1] + 1, len(given.phoneme) - 1)) if longest else None
