"""Closures and amplitude: what keeps averaged lips from mumbling."""

from __future__ import annotations

import dataclasses

import numpy as np

from labial.corpus.phonesets import SPEECH
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.reference.stream import synthesise, targets
from labial.reference.tables import FloatTables
from labial.tables.amplitude import mean_pose, widened
from labial.train.closures import floors
from labial.train.expression import AMPLITUDE, gains
from labial.train.recordings import Recording
from labial.train.workers import Workers
from models import random_model, without_floors


def sequence(phonemes: list, frames: np.ndarray, length: int) -> Recording:
    count = len(phonemes)
    return Recording(
        name="made up",
        phoneme=np.array(phonemes),
        duration=np.full(count, length / 50),
        length=np.full(count, length),
        apex=np.arange(count) * length,
        frames=frames,
    )


def test_floors_are_the_mean_pose_of_closures() -> None:
    """B closes firmly (to 40) three times in ten, hardly (to -60) otherwise; vowels hang at -300, nothing below. The
    firmer half counts; those of a recording that counts three times count three times."""
    b, vowel = SPEECH.phonemes.index("B"), SPEECH.phonemes.index("AA")
    lower = FAP_NUMBERS.index(52)
    frames = np.full((200, CHANNELS), -300.0)
    for i in range(10):  # vowels and closures of ten frames each in turn; contact in the middle of the closure
        frames[20 * i + 15, lower] = 40.0 if i % 4 == 1 else -60.0
    found, contact = floors([sequence([vowel, b] * 10, frames, 10)], SPEECH, 50)
    assert contact[b, lower] and not contact[b, FAP_NUMBERS.index(3)] and not contact[vowel].any()
    assert np.isclose(found[b, lower], (3 * 40.0 + 2 * -60.0) / 5)
    assert np.array_equal(found[b], found[SPEECH.phonemes.index("P")])
    other = np.where(frames > 0, 20.0, frames)  # three of ten
    heavy = dataclasses.replace(sequence([vowel, b] * 10, other, 10), weight=np.full(frames.shape, 3.0))
    both, _ = floors([sequence([vowel, b] * 10, frames, 10), heavy], SPEECH, 50)
    assert np.isclose(both[b, lower], (3 * 40.0 + 9 * 20.0 + 4 * -60.0) / 16)
    ignored = dataclasses.replace(heavy, weight=np.zeros(frames.shape))
    assert np.array_equal(floors([sequence([vowel, b] * 10, frames, 10), ignored], SPEECH, 50)[0], found)
    assert (found[vowel] == -300.0).all() and found[b, FAP_NUMBERS.index(3)] == -300.0


def test_widening_scales_targets_about_the_mean_pose() -> None:
    """Every term of the target has to be scaled; one that is forgotten bends the motion instead of widening it."""
    model = without_floors(random_model(4, knots=2))
    gain = np.linspace(0.5, 2.0, CHANNELS)
    asked = ([1, 4, 2, 7, 3], [120, 60, 200, 90, 70], [6, 3, 10, 5, 3])
    before = targets(FloatTables(model), *asked)
    after = targets(FloatTables(widened(model, gain)), *asked)
    centre = mean_pose(model)
    assert np.allclose(after, centre + (before - centre) * gain)
    assert np.ptp(before, axis=0).min() > 1


def test_amplitude_is_brought_to_its_goal() -> None:
    """The human here moves 1.4 times as far as the model: every channel must end at AMPLITUDE of that, within 2 %."""
    model = without_floors(random_model(5))
    rng = np.random.default_rng(5)
    material = []
    for _ in range(4):
        phonemes = rng.integers(1, 9, 30).tolist()
        motion = synthesise(FloatTables(model), [(p, 120) for p in phonemes])
        material.append(sequence(phonemes, 1.4 * motion, 6))
    with Workers(1, False) as workers:
        wide = widened(model, *gains(model, material, workers))
    found = np.concatenate([synthesise(FloatTables(wide), [(int(p), 120) for p in item.phoneme]) for item in material])
    human = np.concatenate([item.frames for item in material])
    assert np.abs(found.std(axis=0) / human.std(axis=0) - AMPLITUDE).max() < 0.06


def test_a_channel_is_widened_about_the_middle_of_its_range() -> None:
    """A pose that stays where it is under the gain lies between the 5th and the 95th percentile of human motion, not at
    the mean, which in a skewed channel is near the end that it rests at."""
    model = without_floors(random_model(6))
    rng = np.random.default_rng(6)
    phonemes = rng.integers(1, 9, 200).tolist()
    motion = 2.0 * synthesise(FloatTables(model), [(p, 120) for p in phonemes])
    motion[:, 2] = 4.0 * np.maximum(motion[:, 2], np.percentile(motion[:, 2], 80))
    with Workers(1, False) as workers:
        wide = widened(model, *gains(model, [sequence(phonemes, motion, 6)], workers))
    asked = ([1, 4, 2, 7, 3], [120, 60, 200, 90, 70], [6, 3, 10, 5, 3])
    before, after = (targets(FloatTables(item), *asked) for item in (model, wide))
    gain = np.ptp(after, axis=0) / np.ptp(before, axis=0)
    still = (after - gain * before)[0] / (1 - gain)
    low, high = np.percentile(motion, [5, 95], axis=0)
    assert (gain > 1.2).all() and np.allclose(still, (low + high) / 2)


def test_floats_interpolate_between_the_knots_of_pairs() -> None:
    """One knot is two equal ones; of two, the middle frame of an odd number has the mean."""
    one, two = random_model(8), random_model(8, knots=2)
    same = dataclasses.replace(one, pair_shape=np.repeat(one.pair_shape, 2, axis=1))
    asked = ([1, 4, 2, 7, 3], [120, 60, 200, 90, 70], [6, 3, 10, 5, 3])
    assert np.allclose(targets(FloatTables(one), *asked), targets(FloatTables(same), *asked))
    bare = without_floors(dataclasses.replace(two, kernel=np.zeros_like(two.kernel)))
    found = targets(FloatTables(bare), *asked)[9:19]  # the third phoneme's ten frames
    steps = np.diff(found, axis=0)
    assert np.allclose(steps, steps[0]) and np.abs(steps).max() > 1
    ends = FloatTables(bare).select(*(np.array([value]) for value in (2, 200, 4, 7)))[0]
    assert np.allclose(found[0], ends[0] + 0.05 * (ends[1] - ends[0]))
    assert np.allclose(found[9], ends[0] + 0.95 * (ends[1] - ends[0]))
