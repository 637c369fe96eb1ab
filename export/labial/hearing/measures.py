"""How near the lips that a network hears are to those that Labial makes of the true times of phonemes.

- **opening**: the correlation of the outer lips' distance, the mean over clips; **channels**: that of all 13 channels.
- **closed**: the share of the runs of p, b, m in which the lips touch (`TOUCHING`) within `REACH` frames of the run.
- **false**: how often a second of speech the lips touch where neither p, b, m nor touching lips of Labial's are within
  `REACH` frames.
- **speech**: the correlation of the opening in frames of speech, without those before, after and in pauses.
- **jerk**: the RMS third difference over that of Labial's frames, the mean of the channels.

By them :func:`choose` decides how lips close by the scores of a trained network, on takes that were held out of its
training.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

from labial.files.faps import TOUCHING
from labial.files.frames import opening, spans
from labial.hearing.features import HOPS, normalise
from labial.hearing.model import CLASSES, CLOSED, HearingModel
from labial.hearing.network import closed, run, smoothed
from labial.hearing.prepared import Prepared

#: Frames that a closure may be early or late: 40 ms.
REACH = 2
#: Frames per second.
RATE = 50

_SILENCE, _CLOSED = CLASSES.index("SIL"), CLASSES.index(CLOSED)
#: Scores of closed lips at which they begin to close, and by how much more they are closed, to choose from.
_BEGIN = (-3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0)
_WIDTH = (0.8, 1.5, 2.5, 3.5)
#: What a choice is judged by: correlation, closures, false ones per second and jerk above that of Labial's frames.
_WEIGHTS = (1.0, 0.5, 0.5, 0.25)
#: False closures per second, and jerk relative to Labial's, that cost nothing.
_FALSE, _JERK = 0.05, 1.05


class Figures(NamedTuple):
    """See the top of this module; NaN where a clip has nothing to judge by."""

    opening: float
    channels: float
    closed: float
    false: float
    jerk: float
    speech: float = float("nan")

    def __str__(self) -> str:
        return (f"opening {self.opening:.3f}, channels {self.channels:.3f}, p b m closed {self.closed:.2f}, "
                f"falsely {self.false:.2f} a second, jerk {self.jerk:.2f}")


#: True frames (T, 13), heard ones (T, 13), and the true lip class of each frame (T,).
Judged = Tuple[np.ndarray, np.ndarray, np.ndarray]


def correlation(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(C,) Pearson's of the columns of two (T, C); NaN where one does not move."""
    first, second = (item - item.mean(axis=0) for item in (np.asarray(one, float), np.asarray(other, float)))
    scale = np.sqrt((first**2).sum(axis=0) * (second**2).sum(axis=0))
    return np.where(scale > 1e-9, (first * second).sum(axis=0) / np.maximum(scale, 1e-9), np.nan)


def near(where: np.ndarray) -> np.ndarray:
    """(T,) bool: within `REACH` frames of a true frame of `where`."""
    found = where.copy()
    for step in range(1, REACH + 1):
        found[step:] |= where[:-step]
        found[:-step] |= where[step:]
    return found


def closures(heard: np.ndarray, classes: np.ndarray) -> List[bool]:
    """For each run of p, b, m whether the lips of `heard` (T, 13) touch in it or nearby."""
    gap = opening(heard)
    return [bool(gap[max(begin - REACH, 0) : end + REACH].min() <= TOUCHING)
            for begin, end in spans(classes == _CLOSED)]


def false_closures(true: np.ndarray, heard: np.ndarray, classes: np.ndarray) -> int:
    """How many times the lips of `heard` touch in speech without a reason."""
    reason = near((classes == _CLOSED) | (opening(true) <= TOUCHING))
    touching = (opening(heard) <= TOUCHING) & ~reason & (classes != _SILENCE)
    return len(list(spans(touching)))


def measured(clips: Sequence[Judged]) -> Figures:
    """The figures of several clips together."""
    if not clips:
        return Figures(*[float("nan")] * len(Figures._fields))
    every: List[np.ndarray] = []
    seen: List[bool] = []
    false, speech = 0, 0
    third = np.zeros((2, clips[0][0].shape[1]))
    for true, heard, classes in clips:
        gaps, spoken = (opening(true)[:, None], opening(heard)[:, None]), classes != _SILENCE
        every.append(np.concatenate([correlation(*gaps), correlation(*(gap[spoken] for gap in gaps)),
                                     correlation(true, heard)]))
        seen += closures(heard, classes)
        false += false_closures(true, heard, classes)
        speech += int(spoken.sum())
        third += [(np.diff(np.asarray(frames, float), n=3, axis=0) ** 2).sum(axis=0) for frames in (true, heard)]
    each = list(map(_mean, np.array(every).T))
    moving = third[0] > 1e-9
    return Figures(each[0], _mean(each[2:]), _mean(seen), false * RATE / speech if speech else float("nan"),
                   _mean(np.sqrt(third[1][moving] / third[0][moving])), each[1])


def _mean(values: Sequence[float]) -> float:
    """The mean of those that are numbers; NaN without any."""
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known)]
    return float(known.mean()) if len(known) else float("nan")


def pooled(figures: Sequence[Figures], shares: Sequence[float]) -> Figures:
    """The mean of several, weighed by `shares`; what is NaN does not count."""
    values = np.array(figures, dtype=float)
    known = np.isfinite(values) * np.array(shares, dtype=float)[:, None]
    total = known.sum(axis=0)
    mean = (np.nan_to_num(values) * known).sum(axis=0) / np.where(total > 0, total, np.nan)
    return Figures(*mean.tolist())


def delay(clips: Sequence[Judged], most: int = 6) -> int:
    """By how many frames, `most` at most, the heard opening lags behind the true one, by the mean correlation."""
    def shifted(true: np.ndarray, heard: np.ndarray, lag: int) -> float:
        count = len(true) - abs(lag)
        one = opening(true)[max(-lag, 0) :][:count]
        return float(correlation(one[:, None], opening(heard)[max(lag, 0) :][:count][:, None])[0])

    means = []
    for lag in range(-most, most + 1):
        mean = _mean([shifted(true, heard, lag) for true, heard, _ in clips if len(true) > 2 * most])
        means.append(-2.0 if np.isnan(mean) else mean)
    return int(np.argmax(means)) - most


@dataclass(frozen=True)
class Choice:
    """The scores at which lips begin to close and are closed, and what a model reaches with them."""

    edges: Tuple[float, float]
    reached: Figures

    def figures(self) -> Dict[str, float]:
        """The figures by name, rounded."""
        return {name: round(value, 4) for name, value in self.reached._asdict().items()}

    def __str__(self) -> str:
        return f"closes from {self.edges[0]:g} to {self.edges[1]:g}: {self.reached}"


def choose(model: HearingModel, folders: Sequence[Prepared], shares: np.ndarray) -> Choice:
    """The best edges by the takes of `folders`, which count by their `shares`."""
    heard = []
    for item in folders:
        begins = np.cumsum(item.lengths)[:-1]
        energies = np.split(item.energies.astype(np.float32), HOPS * begins)
        takes = zip(energies, np.split(item.frames, begins), np.split(item.classes, begins))
        heard.append([(run(model, normalise(energy).reshape(len(frames), -1)), frames, classes)
                      for energy, frames, classes in takes if len(item.lengths)])
    choices = []
    for begin, width in itertools.product(_BEGIN, _WIDTH):
        tried = replace(model, close_from=begin, close_to=begin + width)
        reached = pooled([measured([(frames, smoothed(closed(tried, told).faps), classes)
                                    for told, frames, classes in item]) for item in heard], shares.tolist())
        if worth(reached) > -np.inf:
            choices.append(Choice((begin, begin + width), reached))
    if not choices:
        raise ValueError("no takes are held out")
    return max(choices, key=lambda choice: worth(choice.reached))


def worth(reached: Figures) -> float:
    """A number by which choices are compared; more is better."""
    correlation, closures, false, jerk = _WEIGHTS
    return (correlation * reached.opening + closures * reached.closed
            - false * max(reached.false - _FALSE, 0.0) - jerk * max(reached.jerk - _JERK, 0.0))
