"""Closures: how far the lips must come together in p, b, m, and the lower lip to the teeth in f, v.

A sum of learned curves does not guarantee contact: an open vowel on either side pulls the lips of a /b/ apart. So the
target in such a phoneme does not fall below a *floor*, the mean pose of people. In no phoneme does the target fall
below a value that people hardly ever reach: protrusion ends at lips at rest, which a sum of curves does not respect.
"""

from __future__ import annotations

from typing import Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import PhoneSet
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.train.recordings import Recording, taught

#: Viseme classes that make contact, and their FAPs: those that lower the upper lip, and those that raise the lower lip.
CONTACTS = {"bilabial": (51, 52, 55, 56, 57, 58), "labiodental": (52, 57, 58)}

#: The same of laughter, where air goes through the nose. These lips rest on each other without pressure: they have no
#: floor, but follow their target alone, so that the memory of the states does not open them.
HELD = {"nose": (51, 52, 55, 56, 57, 58)}

#: Seconds around the segment in which contact is searched, the usual error of alignments.
MARGIN = 0.04

#: The percentile of all human frames that is the lowest target of any phoneme.
LEAST = 1.0

#: FAPs that come to rest in a pause, where a phone set makes contacts: all but protrusion.
RESTING = (3, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60)

#: The rest position comes from frames of pauses at least this far from speech, seconds.
AWAY = 0.2

#: The weight of a frame in contact: times the median over a channel's states.
FIRMNESS = 2.0

#: The share of a class's occurrences, those that close most, whose mean pose is the floor. Lips press in p, b, m, as in
#: the firmer half of people's; for the teeth in f, v all count but the tenth with the largest error of timing.
FIRMEST = {"bilabial": 0.5, "labiodental": 0.9}


def floors(material: Sequence[Recording], phone_set: PhoneSet, fps: int) -> Tuple[np.ndarray, np.ndarray]:
    """(P, 13) FAP: the pose of contact in the phonemes and channels that make it, elsewhere the LEAST percentile; and
    (P, 13) bool: where it is contact, or lips are HELD.

    The pose is the mean, by weight, over the FIRMEST occurrences of the phoneme's class, each at its frame of closest
    contact.
    """
    least = np.array([np.percentile(taught(material, channel), LEAST) for channel in range(CHANNELS)])
    result = np.tile(least, (len(phone_set.phonemes), 1))
    contacts = np.zeros(result.shape, dtype=bool)
    classes = np.array(phone_set.viseme_class)
    margin = round(MARGIN * fps)
    for name, faps in CONTACTS.items():
        if name not in phone_set.classes:
            continue
        channels = [FAP_NUMBERS.index(number) for number in faps]
        number = phone_set.classes.index(name)
        poses, weights = [], []
        for item in material:
            begins = np.cumsum(item.length) - item.length
            for i in np.flatnonzero((classes[item.phoneme] == number) & item.learnt()):
                near = slice(max(begins[i] - margin, 0), begins[i] + item.length[i] + margin)
                learnt = item.weights[near, channels].any(axis=1)
                closest = near.start + int(np.where(learnt, item.frames[near, channels].sum(axis=1), -np.inf).argmax())
                poses.append(item.frames[closest, channels])
                weights.append(item.weights[closest, channels])
        if poses:
            contact, weight = np.array(poses), np.array(weights)
            firm = np.argsort(-contact.sum(axis=1), kind="stable")[: max(round(FIRMEST[name] * len(poses)), 1)]
            total = weight[firm].sum(axis=0)
            mean = (weight[firm] * contact[firm]).sum(axis=0) / np.maximum(total, 1e-9)
            held = np.where(total > 0, mean, least[channels])
            result[np.ix_(classes == number, channels)] = held
            contacts[np.ix_(classes == number, channels)] = total > 0
    if contacts.any():
        silence = phone_set.phonemes.index(phone_set.silence)
        channels = [FAP_NUMBERS.index(number) for number in RESTING]
        result[silence, channels] = _rest(material, silence, round(AWAY * fps), least)[channels]
        contacts[silence, channels] = True
    for name, faps in HELD.items():
        if name in phone_set.classes:
            number = phone_set.classes.index(name)
            place = np.ix_(classes == number, [FAP_NUMBERS.index(fap) for fap in faps])
            result[place], contacts[place] = -np.inf, True
    return result, contacts


def _rest(material: Sequence[Recording], silence: int, away: int, least: np.ndarray) -> np.ndarray:
    """(13,) FAP: the median pose of pauses, `away` frames from speech; `least` (13,) where there is none."""
    poses, weights = [np.zeros((0, CHANNELS))], [np.zeros((0, CHANNELS))]
    for item in material:
        quiet = item.phoneme_at() == silence
        near = np.convolve(~quiet, np.ones(2 * away + 1), mode="same") > 0.5
        poses.append(item.frames[~near])
        weights.append(item.weights[~near])
    frames, counts = np.concatenate(poses), np.concatenate(weights) > 0
    return np.array([np.median(values[of]) if of.any() else low for values, of, low in zip(frames.T, counts.T, least)])
