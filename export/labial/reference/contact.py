"""Contact: lips that meet in p, b, m, the lower lip at the teeth in f, v, however short these are; and rest in pauses
(docs/method.md, Floors and contact, and Rest; ``lib/shape.c``). A phoneme in contact that is shorter than FRAMES
borrows the frame before it and, if it has only one frame, the frame after it as well."""

from __future__ import annotations

from typing import Sequence, Tuple, Union

import numpy as np

from labial.files.faps import FAP_NUMBERS
from labial.tables.fixed import CONTACT_FRAMES, POSITION_MAX

#: Frames (``include/labial/model.h``).
FRAMES = CONTACT_FRAMES
OPEN = 7
REST = 16
#: Farther than contacts are looked for, frames.
FAR = 2 * FRAMES
#: (13,) FAP, by how much lips part between two contacts: half a standard deviation of the lips in speech.
PARTED = np.array([{51: 28, 52: 100, 55: 25, 56: 25, 57: 86, 58: 86}.get(number, 0) for number in FAP_NUMBERS])


def raised(target: np.ndarray, labels: np.ndarray, length: np.ndarray, rest: np.ndarray, silence: int,
           floor: np.ndarray, contact: np.ndarray, begin: int = 0,
           parted: np.ndarray = PARTED) -> Tuple[np.ndarray, np.ndarray]:
    """Targets (N, C) that keep the floors, and where they are in contact, (N, C) bool; they are those of N frames from
    frame `begin` on. `labels` (T,) are the phonemes of all frames, `length` (S,) the frames of each phoneme, `rest`
    (T,) how far the mouth has come to rest, of REST. `floor` (P, C) is what a phoneme's targets do not fall below, in
    the unit of `target`; `contact` (P, C) bool says where it is contact, or for silence where the mouth comes to rest;
    `parted` (C,) is :data:`PARTED` in that unit."""
    frames = len(target)
    here = slice(begin, begin + frames)
    padded = np.concatenate([np.full(FRAMES, silence), labels, np.full(FRAMES, silence)])

    def label(lag: Union[int, np.ndarray]) -> np.ndarray:
        return padded[np.arange(FRAMES + begin, FRAMES + begin + frames) + lag]

    whole = np.repeat(length, length)[here]
    left = np.repeat(np.cumsum(length), length)[here] - np.arange(here.start, here.stop)
    labels, rest = labels[here], rest[here]
    makes = np.asarray(contact.any(axis=1))
    makes[silence] = False
    behind, ahead = (_distance([label(sign * lag) for lag in range(1, FRAMES + 1)], makes, silence) for sign in (-1, 1))
    between = np.where(makes[labels] | (labels == silence), FAR, behind + ahead - 1)  # frames between two contacts
    closing = _in_the_middle(whole - left, whole) & (labels != silence)
    short = (label(1) != labels) & (label(1) != silence) & ~((label(1) == label(2)) & (label(2) == label(3)))
    single = (label(-1) != labels) & (label(-1) != silence) & (label(-1) != label(-2))
    own = contact[labels] & closing[:, None]
    before = contact[label(1)] & short[:, None]
    after = contact[label(-1)] & single[:, None]
    last, following = label(-np.minimum(behind, FRAMES)), label(np.minimum(ahead, FRAMES))
    apart = (between <= FRAMES) & ~(before | after).any(axis=1)
    lower = np.minimum(floor[last], floor[following])
    parting = contact[last] & contact[following] & (lower >= -POSITION_MAX) & (parted > 0) & apart[:, None]
    target = np.where(contact[labels] & ~own, target, np.maximum(target, floor[labels]))
    target = np.where(contact[silence] & (rest > 0)[:, None], _part_of_way(target, floor[silence], rest), target)
    target = np.where(before, np.maximum(target, floor[label(1)]), target)
    target = np.where(after, np.maximum(target, floor[label(-1)]), target)
    most = lower - parted
    if np.issubdtype(target.dtype, np.integer):
        most = np.maximum(most, -POSITION_MAX)
    target = np.where(parting, np.minimum(target, most), target)
    return target, own | before | after


def _distance(labels: Sequence[np.ndarray], makes: np.ndarray, silence: int) -> np.ndarray:
    """(T,) how far away the nearest phoneme is that makes contact, (P,) bool, of those 1, 2, ... frames away, `labels`
    (T,) each; FAR where there is none, or silence is nearer."""
    found = np.full(len(labels[0]), FAR)
    for distance in range(len(labels), 0, -1):
        there = labels[distance - 1]
        found = np.where(makes[there], distance, np.where(there == silence, FAR, found))
    return found


def _in_the_middle(frame: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """(T,) bool: whether frame (T,) of a phoneme of `whole` (T,) frames is one of those in its middle."""
    held = np.maximum(np.maximum((whole + 1) // 2, whole - OPEN), FRAMES)
    first = (whole - held) // 2
    return (frame >= first) & (frame < first + held)


def _part_of_way(target: np.ndarray, pose: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """(T, C) `rest` (T,) of REST of the way from targets (T, C) to a pose (C,); integers are divided as in C."""
    with np.errstate(invalid="ignore"):
        way = (pose - target) * rest[:, None]
    whole = np.issubdtype(target.dtype, np.integer)
    return target + (np.sign(way) * (np.abs(way) // REST) if whole else way / REST)
