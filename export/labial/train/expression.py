"""Closures, how far the lips must come together in p, b, m, and the lower lip to the teeth in f, v; amplitude; and
protrusion (docs/method.md, Floors and contact, Amplitude, Scale, Protrusion).

A sum of learned curves does not guarantee contact: an open vowel on either side pulls the lips of a /b/ apart. In no
phoneme does the target fall below a value that people hardly ever reach: protrusion ends at lips at rest, which a sum
of curves does not respect. Where talkers are random effects the corners have no such value: it would be that of all
talkers brought to one scale, while `shared_gains` then widens the corners as far as each moves his own.

A model's corners do not move as those that teach FAP 17 do, but the table is asked for them: so it is stretched.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
from scipy.optimize import brentq
from sklearn.isotonic import IsotonicRegression

from labial.corpus.phonesets import PhoneSet
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.reference.stream import synthesise
from labial.reference.tables import FloatTables
from labial.tables.followers import CORNERS, FAP_17, FROM_CORNERS, VALUES, interpolated
from labial.tables.model import Model, widened
from labial.train.recordings import Recording, taught
from labial.train.workers import Workers

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


def floors(material: Sequence[Recording], phone_set: PhoneSet, fps: int,
           free_corners: bool = False) -> Tuple[np.ndarray, np.ndarray]:
    """(P, 13) FAP: the pose of contact in the phonemes and channels that make it, elsewhere the LEAST percentile, but
    -inf for `free_corners`; and (P, 13) bool: where it is contact, or lips are HELD. The pose is the mean, by weight,
    over the FIRMEST occurrences of the phoneme's class, each at its frame of closest contact."""
    least = np.array([np.percentile(taught(material, channel), LEAST) for channel in range(CHANNELS)])
    result = np.tile(least, (len(phone_set.phonemes), 1))
    if free_corners:
        result[:, CORNERS] = -np.inf
    contacts = np.zeros(result.shape, dtype=bool)
    margin = round(MARGIN * fps)

    def of_class(name: str) -> np.ndarray:
        return np.array([phone_set.classes[number] == name for number in phone_set.viseme_class])

    for name, faps in CONTACTS.items():
        channels, makes = _channels(faps), of_class(name)
        poses, weights = [], []
        for item in material:
            begins = np.cumsum(item.length) - item.length
            for i in np.flatnonzero(makes[item.phoneme] & item.learnt()):
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
            result[np.ix_(makes, channels)] = np.where(total > 0, mean, least[channels])
            contacts[np.ix_(makes, channels)] = total > 0
    if contacts.any():
        silence, channels = phone_set.phonemes.index(phone_set.silence), _channels(RESTING)
        result[silence, channels] = _rest(material, silence, round(AWAY * fps), least)[channels]
        contacts[silence, channels] = True
    for name, faps in HELD.items():
        place = np.ix_(of_class(name), _channels(faps))
        result[place], contacts[place] = -np.inf, True
    return result, contacts


def _channels(faps: Sequence[int]) -> np.ndarray:
    return np.array([FAP_NUMBERS.index(fap) for fap in faps])


def _rest(material: Sequence[Recording], silence: int, away: int, least: np.ndarray) -> np.ndarray:
    """(13,) FAP: the median pose of pauses, `away` frames from speech; `least` (13,) where there is none."""
    away_from = [np.convolve(item.sounds(silence), np.ones(2 * away + 1), mode="same") <= 0.5 for item in material]
    frames = np.concatenate([item.frames[of] for item, of in zip(material, away_from)])
    counts = np.concatenate([item.weights[of] for item, of in zip(material, away_from)]) > 0
    return np.array([np.median(values[of]) if of.any() else low for values, of, low in zip(frames.T, counts.T, least)])


# ---- Amplitude -------------------------------------------------------------------------------------------------------

#: Standard deviation of the synthetic over that of the human motion, on the training part, that every channel is
#: brought to. On held-out episodes it comes out at .85 in jaw and lower lip, .82 in the top lip's protrusion, .81 in
#: the corners, which get CORNERS_AMPLITUDE instead: where they rest in an utterance is learnt from it and not known of
#: another.
AMPLITUDE = 0.84
CORNERS_AMPLITUDE = 0.86
#: The same where talkers are random effects: the mean over talkers, each in his own units and on his own phonemes.
SHARED = 1.0
#: So many frames tell half of what a talker's recordings can tell of the scale that talkers share.
HALF = 500.0
#: Episodes of a talker for measuring it, and the range of gains where talkers are random effects.
OF_TALKER = 25
SHARED_GAINS = (0.25, 6.0)
#: Episodes for measuring it.
EPISODES = 160
#: The percentiles that the middle of a channel's range lies between.
RANGE = (5.0, 95.0)
#: Largest gain; the least is 1.
LARGEST_GAIN = 3.0


def gains(model: Model, material: Sequence[Recording], workers: Workers) -> Tuple[np.ndarray, np.ndarray]:
    """The gain of each channel (13,), with which the model's motion outside silence reaches AMPLITUDE, in the corners
    CORNERS_AMPLITUDE, and the pose (13,), FAP, about which it is to be widened."""
    goal = np.where(np.isin(FAP_NUMBERS, (53, 54)), CORNERS_AMPLITUDE, AMPLITUDE)
    items = chosen(material)
    silence = model.phonemes.index(model.silence)
    learnt = np.concatenate([item.learnt_sounds(silence) for item in items])
    frames = np.concatenate([item.frames for item in items])
    human, middle = deviation_of(frames, learnt), _middle(frames, learnt)
    gain = np.ones(human.shape)
    for _ in range(3):  # states and floors reduce the effect of a gain, so that one step is not enough
        current = widened(model, gain, middle)
        motion = np.concatenate(workers.run("amplitude", motion_of, [(current, item) for item in items]))
        reached = deviation_of(motion, learnt) / np.maximum(human, 1e-9)
        wanted = np.clip(gain * goal / np.maximum(reached, 1e-9), 1.0, LARGEST_GAIN)
        gain = np.where(learnt.any(axis=0), wanted, 1.0)
    return gain, middle


def _middle(frames: np.ndarray, learnt: np.ndarray) -> np.ndarray:
    """(13,) the middle of each channel's range, of the values of frames (T, 13) that are `learnt` (T, 13)."""
    return np.array([np.mean(np.percentile(values[of], RANGE)) if of.any() else 0.0
                     for values, of in zip(frames.T, learnt.T)])


def shared_gains(model: Model, material: Sequence[Recording], workers: Workers,
                 counts: Mapping[str, float]) -> Tuple[np.ndarray, np.ndarray]:
    """The gain of each channel (13,) with which the model moves SHARED times as far as talkers do, and the pose (13,),
    FAP, about which it is to be widened. How far is the standard deviation within utterances, outside silence; the
    model's on a talker's phonemes is divided by his own in his own units, and the quotients' geometric mean is taken
    over talkers, who count by `counts` and, the less there is of them, the less."""
    silence = model.phonemes.index(model.silence)
    items: List[Recording] = []
    for talker in dict.fromkeys(item.talker for item in material):
        own = [item for item in material if item.talker == talker]
        items += [own[i] for i in np.unique(np.linspace(0, len(own) - 1, min(len(own), OF_TALKER)).round().astype(int))]
    names = [item.talker for item in items]
    learnt = [item.learnt_sounds(silence) for item in items]
    middle = _middle(np.concatenate([item.frames for item in items]), np.concatenate(learnt))
    human = within([item.frames * item.own_scale for item in items], learnt, names)
    gain = np.ones(CHANNELS)
    for _ in range(3):  # states and floors reduce the effect of a gain, so that one step is not enough
        current = widened(model, gain, middle, contacts=False)
        made = within(workers.run("amplitude", motion_of, [(current, item) for item in items]), learnt, names)
        total, weight = np.zeros(CHANNELS), np.zeros(CHANNELS)
        for talker, (of_human, amount) in human.items():
            shown = np.maximum(made[talker][0], 1e-9) / np.maximum(of_human, 1e-9)
            weighs = np.where(of_human > 0, counts[talker] * amount / (amount + HALF), 0.0)
            total += weighs * np.log(np.clip(shown, 0.05, 20.0))
            weight += weighs
        reached = np.exp(total / np.maximum(weight, 1e-9))
        gain = np.where(weight > 0, np.clip(gain * SHARED / reached, *SHARED_GAINS), 1.0)
    return gain, middle


def within(motion: Sequence[np.ndarray], learnt: Sequence[np.ndarray],
           names: Sequence[str]) -> Dict[str, Tuple[np.ndarray, np.ndarray]]:
    """By talker, the standard deviations (13,) of his utterances' motion (T, 13) about their means, of the values that
    `learnt` (T, 13) selects, and how many (13,) they are."""
    squares: Dict[str, np.ndarray] = {}
    amounts: Dict[str, np.ndarray] = {}
    for frames, of, name in zip(motion, learnt, names):
        count = of.sum(axis=0)
        mean = (frames * of).sum(axis=0) / np.maximum(count, 1)
        squares[name] = squares.get(name, 0.0) + (((frames - mean) * of) ** 2).sum(axis=0)
        amounts[name] = amounts.get(name, 0.0) + count
    return {name: (np.sqrt(squares[name] / np.maximum(amounts[name], 1)), amounts[name]) for name in squares}


def deviation_of(frames: np.ndarray, learnt: np.ndarray) -> np.ndarray:
    """(13,) standard deviations of the values of frames (T, 13) that `learnt` (T, 13) selects; 0 if it selects none."""
    return np.array([values[of].std() if of.any() else 0.0 for values, of in zip(frames.T, learnt.T)])


def chosen(material: Sequence[Recording]) -> List[Recording]:
    """Those of the material, evenly spread, that amplitudes are measured on."""
    count = min(len(material), EPISODES)
    return [material[index] for index in np.linspace(0, len(material) - 1, count).round().astype(int)]


def motion_of(task: Tuple[Model, Recording]) -> np.ndarray:
    """(T, 13) FAP: what a model makes of a recording's phonemes."""
    model, item = task
    bounds = np.rint(np.cumsum(item.length) * 1000 / model.fps).astype(int)
    durations = np.diff(bounds, prepend=0)
    return synthesise(FloatTables(model), [(int(p), int(ms)) for p, ms in zip(item.phoneme, durations)])


#: Where the table explains less of FAP 17 than this correlation, that stays a channel.
LEAST_CORRELATION = 0.85
#: The percentiles of the corners' mean that the table spans: beyond there are too few values to tell.
SPAN = (0.1, 99.9)
#: How far the table is stretched at most.
STRETCH = (0.5, 2.0)


def table(corners: np.ndarray, protrusion: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The range (2,) of the corners' mean and the values (17,) over it that fit `protrusion` (T,) best for `corners`
    (T,), all FAP; they fall all along."""
    ends = np.percentile(corners, SPAN)
    smooth = IsotonicRegression(increasing=False, out_of_bounds="clip").fit(corners, protrusion)
    place = np.clip((corners - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0) * (VALUES - 1)
    share = np.maximum(1.0 - np.abs(place[:, None] - np.arange(VALUES)), 0.0)  # of each value in the interpolation
    count = share.sum(axis=0)
    prior = smooth.predict(np.linspace(ends[0], ends[1], VALUES))  # of values that next to nothing tells
    values = np.linalg.solve(share.T @ share + np.eye(VALUES), share.T @ smooth.predict(corners) + prior)
    values = IsotonicRegression(increasing=False).fit_transform(np.arange(VALUES), values, sample_weight=count + 1.0)
    return ends, values


def with_protrusion(model: Model, material: Sequence[Recording], workers: Workers) -> Model:
    """The model with FAP 17 computed of its corners, or as it is where `material` does not tell how."""
    tell = [(item.weights[:, [FAP_17, *CORNERS]] > 0).all(axis=1) for item in material]
    teaching = [item for item, of in zip(material, tell) if of.any()]
    if not teaching:
        return model
    human = np.concatenate([item.frames[of] for item, of in zip(material, tell)])
    mean = human[:, CORNERS].mean(axis=1)
    if min(mean.std(), human[:, FAP_17].std()) < 1e-6:
        return model
    ends, values = table(mean, human[:, FAP_17])
    told = interpolated(human[:, CORNERS], ends, values)
    if not np.corrcoef(told, human[:, FAP_17])[0, 1] >= LEAST_CORRELATION:
        return model
    own = _stretched(model, chosen(teaching), workers, ends, values)
    if own is None:
        return model
    source = model.source.copy()
    source[FAP_17] = FROM_CORNERS
    return replace(model, protrusion=np.round(values, 3), protrusion_range=np.round(own, 3), source=source)


def _stretched(model: Model, material: Sequence[Recording], workers: Workers, ends: np.ndarray,
               values: np.ndarray) -> Optional[np.ndarray]:
    """The range (2,) over which the model's FAP 17 moves by AMPLITUDE of the recordings', outside silence; it is
    stretched about the mean of the model's corners."""
    silence = model.phonemes.index(model.silence)
    learnt = np.concatenate([item.learnt_sounds(silence)[:, FAP_17] for item in material])
    if not learnt.any():
        return None
    human = np.concatenate([item.frames[:, FAP_17] for item in material])[learnt]
    motion = workers.run("protrusion", motion_of, [(model, item) for item in material])
    made = np.concatenate(motion)[learnt][:, CORNERS]
    middle = made.mean()

    def excess(stretch: float) -> float:
        moved = interpolated(made, middle + (ends - middle) * stretch, values)
        return float(moved.std() - AMPLITUDE * human.std())

    low, high = (excess(stretch) for stretch in STRETCH)
    stretch = brentq(excess, *STRETCH) if low * high < 0 else STRETCH[int(abs(high) < abs(low))]
    return middle + (ends - middle) * stretch
