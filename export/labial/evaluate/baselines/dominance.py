"""Baseline: dominance functions (Cohen and Massaro 1993), fitted to the training part.

Each segment pulls every channel to its target; its dominance is greatest at its centre and decays to both sides:

    D_i(t) = alpha_i exp(-theta_i |t - c_i|^p)        F(t) = sum_i D_i(t) T_i / sum_i D_i(t)

Targets T and strengths alpha belong to the phoneme and channel, rates theta to the viseme class, the side and the
channel. All are fitted together by quasi-Newton least squares with exact gradients; the exponent p and the strength of
the priors, which draw targets to the phoneme's mean and dominances to each other, are chosen by inner validation.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Callable, Sequence, Tuple

import numpy as np
from scipy.optimize import minimize

from labial.evaluate.material import Timeline, Utterance
from labial.evaluate.training import Training, choose
from labial.files.faps import CHANNELS

#: Segments to each side of a frame's own that have an effect.
NEIGHBOURS = 4
#: Exponents p, and priors in frames, that are tried.
EXPONENTS = (1.0, 1.5)
PRIORS = (3.0, 30.0)
#: Dominance falls to 1/e at this distance, in seconds, before it is fitted; |t - c| is measured in it.
DISTANCE = 0.1
#: The choice of settings fits on so many utterances, and only the channels of the labial parameters.
TUNING_UTTERANCES = 160
TUNING_CHANNELS = (1, 2, 3, 4, 5, 6)

ITERATIONS = 120


@dataclass(frozen=True)
class Near:
    """The W segments around each of T frames."""

    phoneme: np.ndarray  #: (T, W) int64
    distance: np.ndarray  #: (T, W) from the segment's centre over DISTANCE, positive after it
    present: np.ndarray  #: (T, W) bool


def near(timeline: Timeline, fps: int) -> Near:
    """The segments of a timeline around its frames."""
    held = timeline.held
    centre = timeline.start[held] + timeline.length[held] / 2.0
    own = np.repeat(np.arange(len(held)), timeline.length[held])
    at = own[:, None] + np.arange(-NEIGHBOURS, NEIGHBOURS + 1)
    present = (at >= 0) & (at < len(held))
    at = np.clip(at, 0, max(len(held) - 1, 0))
    seconds = (np.arange(timeline.frames)[:, None] + 0.5 - centre[at]) / fps
    return Near(timeline.phoneme[held][at], seconds / DISTANCE, present)


@dataclass(frozen=True)
class Parameters:
    """One channel's: `target` (P,) FAP, `strength` (P,) log alpha, `rate` (V, 2) log theta before and after."""

    target: np.ndarray
    strength: np.ndarray
    rate: np.ndarray


def _shares(around: Near, power: np.ndarray, parameters: Parameters, rate_at: np.ndarray) -> Tuple[np.ndarray, ...]:
    """Shares of the segments (T, W), that sum to 1, and theta |distance|^p, (T, W)."""
    decay = np.exp(parameters.rate.ravel())[rate_at] * power
    log = np.where(around.present, parameters.strength[around.phoneme] - decay, -np.inf)
    largest = log[:, :1]
    for k in range(1, log.shape[1]):  # four times as fast as the maximum along a short axis
        largest = np.maximum(largest, log[:, k : k + 1])
    share = np.exp(log - largest)
    return share / share.sum(axis=1, keepdims=True), decay


def _rate_index(around: Near, viseme_class: np.ndarray) -> np.ndarray:
    return 2 * viseme_class[around.phoneme] + (around.distance > 0)


def _unpack(x: np.ndarray, phonemes: int) -> Parameters:
    return Parameters(x[:phonemes], x[phonemes : 2 * phonemes], x[2 * phonemes :].reshape(-1, 2))


def objective(around: Near, wanted: np.ndarray, centre: np.ndarray, viseme_class: np.ndarray, exponent: float,
              prior: float) -> Tuple[Callable[[np.ndarray], Tuple[float, np.ndarray]], np.ndarray]:
    """The objective, which returns its value and gradient at a vector of parameters, and the starting point. `wanted`
    (T,) is one channel's motion, `centre` (P,) the phonemes' means, where the targets begin."""
    power = np.abs(around.distance) ** exponent
    rate_at = _rate_index(around, viseme_class)
    phonemes, rates = len(centre), 2 * (int(viseme_class.max()) + 1)
    flat_phoneme, flat_rate = around.phoneme.ravel(), rate_at.ravel()

    def loss(x: np.ndarray) -> Tuple[float, np.ndarray]:
        parameters = _unpack(x, phonemes)
        share, decay = _shares(around, power, parameters, rate_at)
        target = parameters.target[around.phoneme]
        found = (share * target).sum(axis=1)
        residual = found - wanted
        pull = residual[:, None] * share
        lift = pull * (target - found[:, None])  # by log D
        gradient = np.concatenate([
            np.bincount(flat_phoneme, pull.ravel(), phonemes) + prior * (parameters.target - centre),
            np.bincount(flat_phoneme, lift.ravel(), phonemes) + prior * parameters.strength,
            np.bincount(flat_rate, (-lift * decay).ravel(), rates) + prior * parameters.rate.ravel(),
        ])
        away = ((parameters.target - centre) ** 2).sum() + (x[phonemes:] ** 2).sum()
        return 0.5 * float((residual**2).sum() + prior * away) / len(wanted), gradient / len(wanted)

    return loss, np.concatenate([centre, np.zeros(phonemes + rates)])


def fit_channel(around: Near, motion: np.ndarray, start: np.ndarray, viseme_class: np.ndarray, exponent: float,
                prior: float) -> Parameters:
    """Fits one channel's motion (T,); `start` (P,) are the phonemes' means. Both FAP."""
    scale = max(float(motion.std()), 1e-9)
    loss, begin = objective(around, motion / scale, start / scale, viseme_class, exponent, prior)
    found = minimize(loss, begin, jac=True, method="L-BFGS-B", options={"maxiter": ITERATIONS}).x
    found = _unpack(found, len(start))
    return Parameters(found.target * scale, found.strength, found.rate)


@dataclass(frozen=True)
class Dominance:
    """Fitted dominance functions of the channels."""

    channels: Tuple[Parameters, ...]
    viseme_class: np.ndarray  #: (P,)
    exponent: float
    fps: int

    def __call__(self, timeline: Timeline) -> np.ndarray:
        """(T, 13) FAP."""
        around = near(timeline, self.fps)
        power = np.abs(around.distance) ** self.exponent
        rate_at = _rate_index(around, self.viseme_class)
        return np.stack([(_shares(around, power, channel, rate_at)[0] * channel.target[around.phoneme]).sum(axis=1)
                         for channel in self.channels], axis=1)


def _phoneme_means(utterances: Sequence[Utterance], phonemes: int) -> np.ndarray:
    """(P, 13) mean motion of each phoneme; the mean of all frames where it does not occur."""
    phoneme_at = np.concatenate([item.timeline.phoneme_at for item in utterances])
    motion = np.concatenate([item.human for item in utterances])
    count = np.bincount(phoneme_at, minlength=phonemes)[:, None]
    total = np.stack([np.bincount(phoneme_at, column, phonemes) for column in motion.T], axis=1)
    return (total + motion.mean(axis=0)) / (count + 1)


def _fit(utterances: Sequence[Utterance], training: Training, exponent: float, prior: float,
         channels: Sequence[int]) -> Dominance:
    viseme_class = np.array(training.phone_set.viseme_class, dtype=np.int64)
    speech = [item.timeline.phoneme_at != training.silence for item in utterances]
    parts = [near(item.timeline, training.fps) for item in utterances]
    around = Near(*(np.concatenate([getattr(part, name)[mask] for part, mask in zip(parts, speech)])
                    for name in ("phoneme", "distance", "present")))
    motion = np.concatenate([item.human[mask] for item, mask in zip(utterances, speech)])
    means = _phoneme_means(utterances, len(viseme_class))
    phonemes = len(viseme_class)
    still = Parameters(np.zeros(phonemes), np.zeros(phonemes), np.zeros((int(viseme_class.max()) + 1, 2)))
    fitted = [fit_channel(around, motion[:, k], means[:, k], viseme_class, exponent, prior) if k in channels else still
              for k in range(CHANNELS)]
    return Dominance(tuple(fitted), viseme_class, exponent, training.fps)


def fit(training: Training) -> Dominance:
    """Chooses exponent and priors on the inner validation part, then fits all channels on the whole."""
    exponent, prior = choose(training, list(itertools.product(EXPONENTS, PRIORS)), lambda part: lambda setting: _fit(
        part.utterances[:TUNING_UTTERANCES], training, *setting, TUNING_CHANNELS))
    return _fit(training.utterances, training, exponent, prior, range(CHANNELS))
