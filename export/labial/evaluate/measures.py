"""The measures of a method's motion against the human's, as named numbers (docs/method.md, How it is judged)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import PhoneSet
from labial.evaluate.material import Utterance
from labial.files.faps import FAP_NAMES
from labial.reference.published import pieces

#: Lips count as closed below this percentile of the openness of all training frames but silence.
CLOSED_PERCENTILE = 20.0
#: In speech they are firmly closed below this percentile of people's least openness in the training part's p, b, m.
FIRM_PERCENTILE = 50.0
#: A closure is searched in its segment and this many seconds to both sides.
CLOSURE_REACH = 0.04
#: Seams are searched where units meet; short units are joined until they have so many frames.
JOINED_FRAMES = 16
#: The viseme classes whose phonemes close the lips, of speech and of laughter; without them there are no closure rates.
CLOSED_CLASSES = ("bilabial", "nose")


@dataclass(frozen=True)
class Scale:
    """Scales from the training part."""

    maximum: np.ndarray  #: (4,) largest absolute value of each labial parameter but in silence, FAP
    closed: float  #: openness below which lips count as closed, FAP
    firm: float  #: and as firmly closed, FAP; NaN without phonemes that close the lips
    pulse: float = float("nan")  #: least rise of openness of a visible pulse, FAP; NaN in speech


def silence_of(phone_set: PhoneSet) -> int:
    """The number of the silence phoneme."""
    return phone_set.phonemes.index(phone_set.silence)


def groups(phone_set: PhoneSet) -> Tuple[str, Tuple[str, ...], np.ndarray]:
    """The grouping of errors: its name, the groups' names, and each phoneme's group (P,). Viseme classes for speech;
    the phonemes themselves for laughter, which has few."""
    if phone_set.kind == "laughter":
        return "phoneme", phone_set.phonemes, np.arange(len(phone_set.phonemes))
    return "class", phone_set.classes, np.array(phone_set.viseme_class)


def least_openness(item: Utterance, frames: np.ndarray, mask: np.ndarray, phone_set: PhoneSet, fps: int) -> np.ndarray:
    """(n,) FAP: the least openness within CLOSURE_REACH of each phoneme that closes the lips and has a judged frame."""
    openness = labial_parameters(frames)[:, 0]
    reach, given = round(CLOSURE_REACH * fps), item.timeline
    closing = np.array([phone_set.classes[c] in CLOSED_CLASSES for c in phone_set.viseme_class], dtype=bool)
    found = []
    for segment in given.held[closing[given.phoneme[given.held]]]:
        begin = int(given.start[segment])
        end = begin + int(given.length[segment])
        if mask[begin:end].any():
            found.append(openness[max(begin - reach, 0) : end + reach].min())
    return np.array(found)


def measure_scale(training: Sequence[Utterance], phone_set: PhoneSet, fps: int) -> Scale:
    """The scale of a training part, from human motion outside silence."""
    silence = silence_of(phone_set)
    masks = [item.timeline.phoneme_at != silence for item in training]
    speech = np.concatenate([labial_parameters(item.human)[mask] for item, mask in zip(training, masks)])
    least, risen = (np.concatenate([found(item, item.human, mask, phone_set, fps)
                                    for item, mask in zip(training, masks)]) for found in (least_openness, rises))
    pulses = risen if has_pulses(phone_set) else risen[:0]
    return Scale(maximum=np.maximum(np.abs(speech).max(axis=0), 1e-9),
                 closed=float(np.percentile(speech[:, 0], CLOSED_PERCENTILE)),
                 firm=float(np.percentile(least, FIRM_PERCENTILE)) if len(least) else float("nan"),
                 pulse=float(np.percentile(pulses, SEEN_PERCENTILE)) if len(pulses) else float("nan"))


def mean_difference(scale: Scale, human: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(4,) the paper's diff, |ori - syn| / maximum, of frames (T, 13)."""
    return np.abs(labial_parameters(human) - labial_parameters(motion)).mean(axis=0) / scale.maximum


class Judge:
    """Judges methods by the human motion of a test part."""

    def __init__(self, test: Sequence[Utterance], masks: Sequence[np.ndarray], scale: Scale, phone_set: PhoneSet,
                 fps: int) -> None:
        """`masks`: per utterance (T,) bool, the frames that are judged."""
        self._test, self._masks, self._scale = list(test), list(masks), scale
        self._phone_set, self._fps = phone_set, fps
        self._pulsing = has_pulses(phone_set)
        self._human = self._pooled([item.human for item in test])
        self._grouping, self._groups, group_of = groups(phone_set)
        self._group_at = np.concatenate([group_of[item.timeline.phoneme_at][mask] for item, mask in zip(test, masks)])
        self._at_joins = np.concatenate([self._unit_joins(item)[_throughout(mask, 3)]
                                         for item, mask in zip(test, masks)])
        self._human_jerk = self._jerk([item.human for item in test])

    @property
    def frames(self) -> int:
        """The number of judged frames."""
        return len(self._human)

    def _pooled(self, motion: Sequence[np.ndarray]) -> np.ndarray:
        return np.concatenate([frames[mask] for frames, mask in zip(motion, self._masks)])

    def _unit_joins(self, item: Utterance) -> np.ndarray:
        """(T - 2,) bool: see :func:`joins`. Methods without units are judged at the same frames."""
        given = item.timeline
        boundary = [self._phone_set.boundary[p] for p in given.phoneme]
        cut = pieces([int(count) for count in given.length], boundary, JOINED_FRAMES)
        return joins([piece.begin for piece in cut[1:]], [piece.fade_in for piece in cut[1:]], given.frames)

    def _differences(self, motion: Sequence[np.ndarray], order: int) -> np.ndarray:
        """(n, 4) differences of the judged channels over the windows that are judged throughout."""
        return np.concatenate([differences(f[:, JUDGED], mask, order) for f, mask in zip(motion, self._masks)])

    def _jerk(self, motion: Sequence[np.ndarray]) -> np.ndarray:
        """(4,) RMS third difference of the judged channels, FAP per frame cubed."""
        third = self._differences(motion, 3)
        return np.sqrt((third**2).mean(axis=0)) if len(third) else np.full(len(JUDGED), np.nan)

    def _seams(self, motion: Sequence[np.ndarray]) -> Dict[str, float]:
        size = np.abs(self._differences(motion, 2))
        here, there = size[self._at_joins], size[~self._at_joins]
        if not len(here) or not len(there):
            return {"seam/mean": float("nan"), "seam/largest": float("nan")}
        return {"seam/mean": _mean_ratio(here.mean(axis=0), there.mean(axis=0)),
                "seam/largest": _mean_ratio(here.max(axis=0), there.max(axis=0))}

    def _both(self, found: Callable[..., np.ndarray], motion: Sequence[np.ndarray]) -> List[np.ndarray]:
        """What `least_openness` or `rises` is in the whole test part: in `motion`, and in the human's."""
        return [np.concatenate([found(item, frames, mask, self._phone_set, self._fps)
                                for item, frames, mask in zip(self._test, made, self._masks)])
                for made in (motion, [item.human for item in self._test])]

    def _closures(self, motion: Sequence[np.ndarray]) -> Dict[str, float]:
        """Share of the phonemes that close the lips where they do, and do so firmly; its ratio to the human's."""
        found = self._both(least_openness, motion)
        result: Dict[str, float] = {}
        names = ("closure",) if self._pulsing else ("closure", "firm closure")  # laughter does not press lips
        for name, limit in zip(names, (self._scale.closed, self._scale.firm)):
            own, human = (float((least < limit).mean()) if len(least) else float("nan") for least in found)
            result[f"{name}/rate"] = own
            result[f"{name}/of human"] = own / human if human > 0 else float("nan")
        return result

    def _pulses(self, motion: Sequence[np.ndarray]) -> Dict[str, float]:
        """Share of visible pulses, its ratio to the human's, and the mean rise over the human's."""
        own, human = self._both(rises, motion)
        if not len(own):
            return {}
        seen, by_human = float((own > self._scale.pulse).mean()), float((human > self._scale.pulse).mean())
        of_human = seen / by_human if by_human > 0 else float("nan")
        height = float(own.mean() / human.mean()) if human.mean() > 1e-9 else float("nan")
        return {"pulses/seen": seen, "pulses/of human": of_human, "pulses/height": height}

    def measure(self, motion: Sequence[np.ndarray]) -> Dict[str, float]:
        """All measures of a method's motion, one (T, 13) per utterance of the test part, by name."""
        found = self._pooled(motion)
        human, judged = self._human[:, JUDGED], found[:, JUDGED]
        apart = np.abs(labial_parameters(self._human) - labial_parameters(found)) / self._scale.maximum
        result = _named("diff", PARAMETERS, apart.mean(axis=0))
        result.update(_named("correlation", JUDGED_NAMES, correlation(human, judged)))
        result.update(_named("amplitude", JUDGED_NAMES, amplitude(human, judged)))
        result.update(_named("lips", LIPS, correlation(lips(self._human), lips(found))))
        result.update(self._closures(motion))
        if self._pulsing:
            result.update(self._pulses(motion))
        result["jitter"] = _mean_ratio(self._jerk(motion), self._human_jerk)
        result.update(self._seams(motion))
        for index, name in enumerate(self._groups):
            own = self._group_at == index
            if own.any():
                result[f"{self._grouping}/{name}"] = float(apart[own].mean())
        return result


def _named(what: str, names: Sequence[str], values: np.ndarray) -> Dict[str, float]:
    result = {f"{what}/{name}": float(value) for name, value in zip(names, values)}
    result[f"{what}/mean"] = float(np.mean(values))
    return result


def _mean_ratio(own: np.ndarray, other: np.ndarray) -> float:
    """Mean over the channels of own / other; channels in which `other` is still are omitted, NaN if all are."""
    moving = other > 1e-9
    return float((own[moving] / other[moving]).mean()) if moving.any() else float("nan")


def judged_frames(test: Sequence[Utterance], phone_set: PhoneSet, words: Sequence[str] = ()) -> List[np.ndarray]:
    """Per utterance (T,) bool: all frames but silence, of `words` alone where any are given."""
    silence = silence_of(phone_set)
    masks = [item.timeline.phoneme_at != silence for item in test]
    return [mask & item.in_words(words) for item, mask in zip(test, masks)] if words else masks


# ---- Measures of one trajectory against another ----------------------------------------------------------------------

#: Names of the labial parameters of the paper's Table 1.
PARAMETERS = ("openness", "extension", "top", "bottom")
#: The channels of correlation, amplitude, jitter and seams.
JUDGED_NAMES = ("open_jaw", "raise_b_midlip_o", "stretch_l_cornerlip_o", "push_t_lip")
JUDGED = tuple(FAP_NAMES.index(name) for name in JUDGED_NAMES)
#: The measures of connected speech, which need no common scale of talkers: jaw, lips, a corner, and openness.
LIPS = ("open_jaw", "lower_t_midlip_o", "raise_b_midlip_o", "stretch_l_cornerlip_o", "openness")


def lips(frames: np.ndarray) -> np.ndarray:
    """(T, 5) the LIPS of frames (T, 13)."""
    return np.column_stack([frames[:, [FAP_NAMES.index(name) for name in LIPS[:-1]]], labial_parameters(frames)[:, 0]])


def labial_parameters(frames: np.ndarray) -> np.ndarray:
    """(T, 4) openness -(fap51 + fap52), extension fap53 + fap54, top protrusion fap17, bottom protrusion fap16."""
    channel = {name: frames[:, index] for index, name in enumerate(FAP_NAMES)}
    return np.stack([-(channel["lower_t_midlip_o"] + channel["raise_b_midlip_o"]),
                     channel["stretch_l_cornerlip_o"] + channel["stretch_r_cornerlip_o"], channel["push_t_lip"],
                     channel["push_b_lip"]], axis=1)


def correlation(human: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(K,) Pearson correlation over the frames (T, K); 0 where either does not move."""
    a, b = human - human.mean(axis=0), motion - motion.mean(axis=0)
    scale = np.sqrt((a**2).sum(axis=0) * (b**2).sum(axis=0))
    still = scale < 1e-9 * len(a)
    return np.where(still, 0.0, (a * b).sum(axis=0) / np.where(still, 1.0, scale))


def amplitude(human: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(K,) standard deviation of the motion over that of the human's; NaN where that does not move."""
    spread = human.std(axis=0)
    moves = spread > 1e-9
    return np.where(moves, motion.std(axis=0) / np.where(moves, spread, 1.0), np.nan)


def _throughout(mask: np.ndarray, length: int) -> np.ndarray:
    """(T - length + 1,) bool: the windows of `length` frames in which `mask` (T,) is true throughout."""
    if len(mask) < length:
        return np.zeros(0, dtype=bool)
    return np.asarray(np.lib.stride_tricks.sliding_window_view(mask, length).all(axis=1))


def differences(frames: np.ndarray, mask: np.ndarray, order: int) -> np.ndarray:
    """(n, K) differences of this order over every window of order + 1 frames that is judged throughout."""
    return np.diff(frames, n=order, axis=0)[_throughout(mask, order + 1)]


def joins(begin: Sequence[int], fade: Sequence[int], frames: int) -> np.ndarray:
    """(T - 2,) bool: second differences, of frames t, t + 1 and t + 2, that a unit's join touches. A join is where a
    cross-fade begins (between begin - 1 and begin) and where it ends (between begin + fade - 1 and begin + fade); it
    touches the two second differences that span it."""
    touched = np.zeros(max(frames - 2, 0), dtype=bool)
    for first, count in zip(begin, fade):
        for edge in (first, first + count):
            touched[max(edge - 2, 0) : max(edge, 0)] = True
    return touched


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
    """(n,) FAP: the rise of openness in each vowel-like phoneme that has a judged frame. That is the greatest openness
    within REACH of the phoneme over the least before it, back to the middle of the vowel-like phoneme that came last or
    to the beginning. `frames` (T, 13) FAP, `mask` (T,) bool."""
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
    pulses = np.flatnonzero(np.array(phone_set.boundary)[given.phoneme])
    trains = np.split(pulses, np.flatnonzero(np.diff(begin[pulses]) > TRAIN_GAP) + 1)
    longest = max(map(np.ndarray.tolist, trains), key=len)
    return (max(longest[0] - 1, 0), min(longest[-1] + 1, len(given.phoneme) - 1)) if longest else None
