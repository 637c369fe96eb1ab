"""The network of hearing in floating point, over a whole sound: what ``lib/hear_network.c`` computes frame by frame.

A block is ``y = relu(W x + b)``, then ``z = memory(y)``, weighted frames of y around the present, for each unit its
own; all but the first block add their input x. A dense layer follows, then three heads: scores of lip classes, a score
of closed lips, and FAPs. Before the sound and a block's first input, y is zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from labial.hearing.convert import extended
from labial.hearing.features import BANDS, FRAME, HOPS, frames_of, log_energies, normalise
from labial.hearing.model import HearingModel


class Heard(NamedTuple):
    """What a network makes of T frames."""

    scores: np.ndarray  #: (T, C) float32
    closed: np.ndarray  #: (T,) float32, the score of closed lips: the log of the odds that they touch in p, b, m
    faps: np.ndarray  #: (T, 13) float32, FAP units


def remembered(y: np.ndarray, weight: np.ndarray, past: int, ahead: int, dilation: int) -> np.ndarray:
    """(T, H) a memory with weights (H, taps) over y (T, H), zeros before and after it."""
    padded = np.pad(y, ((past * dilation, ahead * dilation), (0, 0)))
    parts = [padded[k * dilation : k * dilation + len(y)] * weight[:, k] for k in range(past + ahead + 1)]
    return np.sum(parts, axis=0)


def run(model: HearingModel, heard: np.ndarray) -> Heard:
    """The three heads for the features (T, 48) of all frames, without closures."""
    x = np.asarray(heard, dtype=np.float32)
    for k, memory in enumerate(model.memories):
        y = np.maximum(x @ model.dense[k].T + model.bias[k], 0.0)
        z = remembered(y, model.memory[k], *memory)
        x = z + x if k else z
    x = np.maximum(x @ model.last.T + model.last_bias, 0.0)
    head = x @ model.fap_weight.T + model.fap_bias
    return Heard(x @ model.class_weight.T + model.class_bias, x @ model.closed_weight + model.closed_bias,
                 model.fap_mean + model.fap_scale * head)


def closed(model: HearingModel, heard: Heard) -> Heard:
    """The same with lips closed as far as their score says: each channel goes its share of the way to that pose."""
    share = np.clip((heard.closed - model.close_from) / (model.close_to - model.close_from), 0.0, 1.0)
    way = (model.closed - heard.faps) * model.closing
    return Heard(heard.scores, heard.closed, heard.faps + way * share[:, None])


#: Frames that a frame waits for after the network has told it.
SMOOTHING = 1


def smoothed(frames: np.ndarray) -> np.ndarray:
    """Frames (T, 13), each with a quarter of the one before and of the one after it; before the first and after the
    last they stay. What the network tells of single frames moves faster than lips."""
    padded = np.concatenate([frames[:1], frames, frames[-1:]])
    return (padded[:-2] + 2 * padded[1:-1] + padded[2:]) / 4


def hear(model: HearingModel, sound: np.ndarray) -> Heard:
    """Scores and frames of a sound: (N,) samples at 16 kHz, int16 or floats of the same scale; `frames_of(N)` frames,
    of which frame k shows the 20 ms from sample 320 k on. Silence follows the sound, its last sample, for as many
    frames as the network looks ahead and smoothing waits for."""
    sound = np.asarray(sound)
    count, ahead = frames_of(len(sound)), model.plan.ahead + SMOOTHING
    return hear_energies(model, log_energies(extended(sound, 0, (count + ahead) * FRAME - len(sound))), count)


def hear_energies(model: HearingModel, energies: np.ndarray, count: int) -> Heard:
    """The same for the first `count` frames of log energies (n, 24), which reach as far ahead as is looked."""
    result = closed(model, run(model, normalise(energies).reshape(len(energies) // HOPS, HOPS * BANDS)))
    return Heard(result.scores[:count], result.closed[:count], smoothed(result.faps[: count + SMOOTHING])[:count])
