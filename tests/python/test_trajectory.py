"""Equation 3 against a dense solution of its definition and against SPTK's mlpg; its window. Phonemes to frames, and
contacts: where they are, how long, and what they do to the targets and to equation 3, worked by hand. tests/c has these
steps once more, and test_conformance.py what the library and this reference make of them."""

from __future__ import annotations

import os
import subprocess
from typing import List, Tuple

import numpy as np
import pytest

from labial.reference import published
from labial.reference.contact import raised
from labial.reference.stream import aims, synthesise
from labial.reference.tables import Equation, ExportedTables, FloatTables
from labial.reference.trajectory import solve, solve_whole, starts
from labial.reference.units import Segment, frame_counts, segments, unit_ends
from labial.tables.quantise import quantise
from models import random_model, streams
from packages import sptk


def terms(rng: np.random.Generator, frames: int, channels: int = 2, anchors: bool = True) -> Equation:
    shape = (frames, channels)
    mean = np.stack([rng.normal(0, 50, shape), rng.normal(0, 3, shape), rng.normal(0, 1, shape)], axis=-1)
    weight = np.stack([rng.uniform(0.5, 2, shape), rng.uniform(1, 8, shape), rng.uniform(1, 40, shape)], axis=-1)
    anchor = rng.uniform(0, 3, shape) if anchors else np.zeros(shape)
    return Equation(weight, mean, anchor, rng.normal(0, 50, shape))


def dense(item: Equation, channel: int, kept: int = 0) -> np.ndarray:
    """The same solution from W written out row by row. With `kept` that of the first `kept` frames' equations alone, in
    which all frames beyond stand for the last of these."""
    frames = len(item.weight)
    rows, precision, mean = [], [], []
    for t in range(frames):
        windows = [{t: 1.0}]
        if 0 < t < frames - 1:
            windows += [{t - 1: -0.5, t + 1: 0.5}, {t - 1: 1.0, t: -2.0, t + 1: 1.0}]
        for i, window in enumerate(windows):
            rows.append([window.get(s, 0.0) for s in range(frames)])
            precision.append(item.weight[t, channel, i])
            mean.append(item.mean[t, channel, i])
        rows.append([1.0 if s == t else 0.0 for s in range(frames)])
        precision.append(item.anchor[t, channel])
        mean.append(item.target[t, channel])
    w, u = np.array(rows), np.diag(precision)
    matrix, right = w.T @ u @ w, w.T @ u @ np.array(mean)
    if not kept:
        return np.linalg.solve(matrix, right)
    tied = np.eye(frames)[:, :kept]
    tied[kept:, -1] = 1.0
    return np.linalg.solve(matrix[:kept] @ tied, right[:kept])


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 7, 40])
def test_solves_equation_3_as_it_is_defined(frames: int) -> None:
    """A wrong term of the running factorisation, or a delta row that is kept at an edge, shows against the matrix."""
    item = terms(np.random.default_rng(frames), frames)
    last = np.full((frames, 2), frames - 1)
    for channel in range(2):
        expected = dense(item, channel)
        for found in (solve_whole(item), solve(item, last), published.solve(item)):
            assert np.allclose(found[:, channel], expected, atol=1e-8)


def test_agrees_with_sptk() -> None:
    """An independent implementation of the published equation, without anchors."""
    program = sptk("mlpg")
    item = terms(np.random.default_rng(7), 120, channels=1, anchors=False)
    weight = item.weight.copy()
    weight[0, :, 1:] = weight[-1, :, 1:] = 0.0
    data = np.concatenate([item.mean[:, 0], weight[:, 0]], axis=1).astype("<f4").tobytes()
    command = [*program, "-l", "1", "-d", "-0.5", "0", "0.5", "-d", "1", "-2", "1", "-i", "1", "-s", "60"]
    done = subprocess.run(command, input=data, capture_output=True, check=True, env=os.environ)
    assert np.allclose(np.frombuffer(done.stdout, "<f4"), solve_whole(item)[:, 0], atol=1e-3)


@pytest.mark.parametrize("start", [0, 1, 2, 5, 12])
def test_the_way_back_takes_what_lies_beyond_to_equal_its_start(start: int) -> None:
    """The equations of the frames up to there, solved as a dense system with all beyond set equal: nothing else is
    assumed, and nothing of what comes later is seen but the weights of the row beside."""
    item = terms(np.random.default_rng(start), 20)
    found = solve(item, np.maximum(np.full((20, 2), start), np.arange(20)[:, None]))
    for channel in range(2):
        expected = dense(item, channel, start + 1)
        assert np.allclose(found[: start + 1, channel], expected, atol=1e-8)


def test_starts_by_hand() -> None:
    """Stride 3, window 4. Channel 0 delivers the frames -1 .. 1 and 2 .. 4 with its blocks that end with 6 and 9: frame
    1 comes back from frame 5, frames 2 .. 4 from frame 8. With 10 frames in all the last block is the end."""
    assert starts(20, 3, 4)[:8, 0].tolist() == [5, 5, 8, 8, 8, 11, 11, 11]
    assert starts(20, 3, 4)[:8, 4].tolist() == [6, 6, 6, 9, 9, 9, 12, 12]  # its blocks end with 1, 4, 7, 10, 13
    assert starts(10, 3, 4)[:, 0].tolist() == [5, 5, 9, 9, 9, 9, 9, 9, 9, 9]
    assert starts(11, 3, 4)[:, 0].tolist() == [5, 5, 8, 8, 8, 10, 10, 10, 10, 10, 10]
    assert starts(20, 3, 4, 2)[:8, 0].tolist() == starts(20, 3, 4)[:8, 4].tolist()  # blocks that end with 3 decide 1
    assert starts(20, 1, 4)[:4, 7].tolist() == [4, 5, 6, 7] and starts(1, 3, 4).tolist() == [[0] * 13]


# ---- Phonemes to frames ----------------------------------------------------------------------------------------------


SIL, OPEN, LIPS = 0, 1, 2


@pytest.mark.parametrize("fps", [25, 50, 60, 100])
def test_frames_amount_to_the_rounded_sum(fps: int) -> None:
    """Rounding each duration by itself would drift: 300 phonemes of 1 ms are 15 frames at 50 per second, not none."""
    rng = np.random.default_rng(fps)
    for durations in ([1] * 300, [0, 0, 3], [3_600_000, 1], list(rng.integers(0, 400, 500))):
        total = sum(int(d) for d in durations) * fps
        assert sum(frame_counts(durations, fps)) == (total + 500) // 1000


@pytest.mark.parametrize(("pushed", "ahead", "fps", "expected"), [
    # 500 ms are 25 frames; the last six, 120 ms, may depend on the vowel behind, the others must not wait for it.
    ([(OPEN, 100), (SIL, 500), (OPEN, 60)], 6, 50,
     [Segment(OPEN, 100, 5), Segment(SIL, 380, 19, 0), Segment(SIL, 120, 6, 1, 19), Segment(OPEN, 60, 3)]),
    # A pause that the kernels span is not cut, nor what is no pause, nor anything where nothing looks ahead.
    ([(SIL, 125), (OPEN, 500), (SIL, 140)], 6, 50,
     [Segment(SIL, 125, 6), Segment(OPEN, 500, 25), Segment(SIL, 20, 1, 0), Segment(SIL, 120, 6, 1, 1)]),
    ([(SIL, 140)], 0, 50, [Segment(SIL, 140, 7)]),
    # At 60 frames a second five frames are 83.3 ms: the tail has 83, the head the rest.
    ([(SIL, 200)], 5, 60, [Segment(SIL, 117, 7, 0), Segment(SIL, 83, 5, 1, 7)]),
    # The device keeps milliseconds in 16 bits; a head of 65,535 ms less its tail is what it sees of an hour.
    ([(SIL, 3_600_000)], 6, 50, [Segment(SIL, 65415, 179994, 0), Segment(SIL, 120, 6, 1, 179994)]),
    ([(OPEN, 70_000)], 6, 50, [Segment(OPEN, 65535, 3500)]),
    # 9 ms are no frame, but with 11 more they are one.
    ([(OPEN, 9), (LIPS, 11), (OPEN, 0)], 6, 50, [Segment(LIPS, 11, 1)]), ([(OPEN, 9)], 6, 50, []),
])  # fmt: skip
def test_segments_by_hand(pushed: List[Tuple[int, int]], ahead: int, fps: int, expected: List[Segment]) -> None:
    assert segments(pushed, SIL, ahead, fps) == expected


def test_a_unit_ends_with_its_boundary_phoneme_and_with_the_stream() -> None:
    """The boundary phoneme's last frame, not its first, and no frame of what follows."""
    boundary = np.array([False, True, False])
    held = [Segment(LIPS, 40, 2), Segment(OPEN, 60, 3), Segment(SIL, 20, 1), Segment(SIL, 20, 1), Segment(LIPS, 40, 2)]
    assert np.flatnonzero(unit_ends(held, boundary)).tolist() == [4, 8]
    assert unit_ends([], boundary).shape == (0,) and synthesise(FloatTables(random_model(1)), []).shape == (0, 13)


# ---- Contacts --------------------------------------------------------------------------------------------------------


FLOOR = np.array([[-np.inf, -np.inf], [-50.0, -np.inf], [40.0, 10.0]])  # lips meet in the first of two channels
CONTACT = np.array([[False, False], [False, False], [True, False]])


def shut(*spans: Tuple[int, int]) -> Tuple[List[int], List[int], List[bool]]:
    """The two channels' targets, 0 without floors, and where the first is in contact, of phonemes and their frames."""
    labels = np.repeat([phoneme for phoneme, _ in spans], [frames for _, frames in spans])
    length = np.array([frames for _, frames in spans])
    target, contact = raised(np.zeros((len(labels), 2)), labels, length, 0 * labels, SIL, FLOOR, CONTACT,
                             parted=np.array([55, 0]))
    assert not contact[:, 1].any()
    return target[:, 0].tolist(), target[:, 1].tolist(), contact[:, 0].tolist()


def test_contact_lasts_three_frames_at_least() -> None:
    """Three frames are a phoneme's own; two borrow the one before; one borrows that behind it too."""
    assert shut((OPEN, 3), (LIPS, 3), (OPEN, 2))[2] == [False] * 3 + [True] * 3 + [False] * 2
    assert shut((OPEN, 3), (LIPS, 2), (OPEN, 3))[2] == [False] * 2 + [True] * 3 + [False] * 3
    assert shut((OPEN, 3), (LIPS, 1), (OPEN, 3))[2] == [False] * 2 + [True] * 3 + [False] * 2
    assert shut((LIPS, 1), (OPEN, 2))[2] == [True, True, False]  # nothing lies before the first frame
    assert shut((OPEN, 2), (LIPS, 1))[2] == [False, True, True]


def test_lips_part_between_two_close_contacts() -> None:
    """Up to three frames between contacts are 55 below the floor, but for those that a contact borrows."""
    assert shut((LIPS, 3), (OPEN, 2), (LIPS, 3))[::2] == (
        [40.0] * 3 + [-15.0] * 2 + [40.0] * 3, [True] * 3 + [False] * 2 + [True] * 3)
    assert shut((LIPS, 3), (OPEN, 4), (LIPS, 3))[2] == [True] * 3 + [False] * 4 + [True] * 3
    assert shut((LIPS, 3), (OPEN, 1), (SIL, 1), (LIPS, 3))[0] == [40.0] * 3 + [0.0] * 2 + [40.0] * 3
    assert shut((LIPS, 3), (OPEN, 2), (LIPS, 2))[0] == [40.0] * 3 + [-15.0] + [40.0] * 3
    assert shut((LIPS, 3), (OPEN, 1), (LIPS, 2))[0] == [40.0] * 6


def test_whole_numbers_come_to_rest_as_c_divides() -> None:
    """Towards zero: 7 positions on the way to 0, and -7, lose as much."""
    floor, resting = np.array([[0, 0]]), np.array([[True, True]])
    aim, step = np.repeat([[7, -7]], 20, axis=0), np.minimum(np.arange(1, 21), 16)
    found = raised(aim, np.zeros(20, dtype=int), np.array([20]), step, SIL, floor, resting, parted=np.zeros(2))[0]
    assert found[:4].tolist() == [[7, -7], [7, -7], [6, -6], [6, -6]] and not found[15:].any()


@pytest.mark.parametrize("seed", range(4))
def test_frames_in_contact_are_held_by_their_target_alone(seed: int) -> None:
    """In contact equation 3 has no static mean to be drawn to, and the anchor is what the state holds with, or the
    model's firmness where that is more; all other frames are as without contacts."""
    model = random_model(seed)
    for tables, firm in ((FloatTables(model), model.firm), (ExportedTables(quantise(model, "model")), None)):
        target, contact, ends = aims(tables, streams(9, model.boundary, seed)["ordinary"])
        path = tables.search(target, ends)
        free, held = tables.equation(path, target), tables.equation(path, target, contact)
        hold = free.weight[..., 0] + free.anchor
        assert contact.any() and not contact.all()
        assert not held.weight[contact][:, 0].any() and (held.anchor[contact] >= hold[contact]).all()
        assert (held.anchor[contact] > hold[contact]).any()
        if firm is not None:
            np.testing.assert_array_equal(held.anchor[contact], np.maximum(hold, firm)[contact])
        for name in ("weight", "anchor"):
            np.testing.assert_array_equal(getattr(held, name)[~contact], getattr(free, name)[~contact])
        np.testing.assert_array_equal(held.weight[..., 1:], free.weight[..., 1:])
