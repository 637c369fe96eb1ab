"""Amplitude: the gain of each channel that makes the trained model move as far as people do.

The channel is widened about the middle of its range, not about its mean: protrusion rests at 0 for most of the time and
goes far in a few phonemes, in which widening about the mean would exceed human motion.
"""

from __future__ import annotations

from typing import List, Sequence, Tuple

import numpy as np

from labial.files.faps import FAP_NUMBERS
from labial.reference.stream import synthesise
from labial.reference.tables import FloatTables
from labial.tables.amplitude import widened
from labial.tables.model import Model
from labial.train.recordings import Recording
from labial.train.workers import Workers

#: Standard deviation of the synthetic over that of the human motion, on the training part, that every channel is
#: brought to. On held-out episodes it comes out at .85 in jaw and lower lip, .82 in the top lip's protrusion, .81 in
#: the corners, which get CORNERS instead: where they rest in an utterance is learnt from it and not known of another.
AMPLITUDE = 0.84
CORNERS = 0.86

#: The same where talkers are random effects: what they share rounds and spreads the lips less than each of them does.
SHARED_CORNERS = 0.95

#: Episodes for measuring it.
EPISODES = 160

#: The percentiles that the middle of a channel's range lies between.
RANGE = (5.0, 95.0)

#: Largest gain; the least is 1.
LARGEST_GAIN = 3.0


def gains(
    model: Model, material: Sequence[Recording], workers: Workers, corners: float = CORNERS
) -> Tuple[np.ndarray, np.ndarray]:
    """The gain of each channel (13,), with which the model's motion outside silence reaches AMPLITUDE, in the corners
    `corners`, and the pose (13,), FAP, about which it is to be widened."""
    goal = np.where(np.isin(FAP_NUMBERS, (53, 54)), corners, AMPLITUDE)
    items = chosen(material)
    silence = model.phonemes.index(model.silence)
    sounding = np.concatenate([item.phoneme_at() != silence for item in items])
    learnt = sounding[:, None] & (np.concatenate([item.weights for item in items]) > 0)
    frames = np.concatenate([item.frames for item in items])
    human = deviation_of(frames, learnt)
    taught = learnt.any(axis=0)  # by the episodes chosen
    middle = np.array([np.mean(np.percentile(values[of], RANGE)) if of.any() else 0.0
                       for values, of in zip(frames.T, learnt.T)])
    gain = np.ones(human.shape)
    for _ in range(3):  # states and floors reduce the effect of a gain, so that one step is not enough
        current = widened(model, gain, middle)
        motion = np.concatenate(workers.run("amplitude", motion_of, [(current, item) for item in items]))
        reached = deviation_of(motion, learnt) / np.maximum(human, 1e-9)
        wanted = np.clip(gain * goal / np.maximum(reached, 1e-9), 1.0, LARGEST_GAIN)
        gain = np.where(taught, wanted, 1.0)
    return gain, middle


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
