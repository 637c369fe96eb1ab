"""The published method unit by unit: its parts, and the whole against other programs and dense algebra."""

from __future__ import annotations

import numpy as np
import pytest
from hmmlearn.hmm import GaussianHMM

from labial.reference.published import (
    OVERLAP,
    PIECE_MAX,
    Piece,
    join,
    looked_at,
    path_cost,
    pieces,
    synthesise,
    viterbi,
    whole_piece,
)
from labial.reference.tables import Equation, FloatTables
from labial.reference.units import frame_counts
from models import random_model, streams
from test_trajectory import dense
from test_viterbi import hidden_markov_model, likeliest


def unit_by_other_means(tables: FloatTables, target: np.ndarray, channel: int) -> np.ndarray:
    """(T,) one channel of a unit: hmmlearn's path for its targets (T, 13), and the dense solution of equation 3."""
    model = tables.model
    hidden = GaussianHMM(model.emission_mean.shape[1], covariance_type="diag")
    hidden.n_features = 1
    hidden.startprob_ = np.exp(model.log_initial[channel])
    hidden.transmat_ = np.exp(model.log_transition[channel])
    hidden.means_, hidden.covars_ = model.emission_mean[channel][:, None], model.emission_variance[channel][:, None]
    path = hidden.decode(target[:, channel : channel + 1])[1]
    states = model.state_precision[channel, path][:, None], model.state_mean[channel, path][:, None]
    anchor, aim = model.state_anchor[channel, path][:, None], target[:, channel : channel + 1]
    return dense(Equation(*states, anchor, aim), 0)


def test_the_whole_method_by_other_programs() -> None:
    """V-CC-V-C-V: two units that share a vowel of five frames. Each phoneme holds the mean of its likeliest component,
    each unit is hmmlearn's path and equation 3's matrix written out, and the shared vowel passes over in even steps."""
    model = random_model(4, "paper")
    tables = FloatTables(model)
    stream = [(1, 80), (2, 60), (3, 100), (4, 100), (5, 60), (7, 80)]  # 1, 4 and 7 are boundaries
    shapes = []
    for phoneme, milliseconds in stream:
        own = slice(3 * phoneme, 3 * phoneme + 3)
        z = (milliseconds / 1000 - model.duration_mean[own]) ** 2 / model.duration_variance[own]
        score = model.log_weight[own] - 0.5 * (z + np.log(model.duration_variance[own]))
        shapes.append(model.shape[own][int(score.argmax())])
    target = np.repeat(shapes, [4, 3, 5, 5, 3, 4], axis=0)
    found = synthesise(tables, stream)
    assert found.shape == (24, 13)
    for k in range(13):
        first, second = unit_by_other_means(tables, target[:17], k), unit_by_other_means(tables, target[12:], k)
        share = np.arange(1, 6) / 6
        expected = [first[:12], first[12:] + (second[:5] - first[12:]) * share, second[5:]]
        np.testing.assert_allclose(found[:, k], np.concatenate(expected), atol=1e-8)
        whole = synthesise(tables, stream, whole=True)[:, k]
        np.testing.assert_allclose(whole, unit_by_other_means(tables, target, k), atol=1e-8)


def test_nothing_in_is_nothing_out() -> None:
    """A stream may end before it began."""
    assert synthesise(FloatTables(random_model(1, "paper")), [(1, 9)]).shape == (0, 13)


def test_units_run_from_boundary_to_boundary_inclusive() -> None:
    """V-C-V: each vowel belongs to the unit that it ends and to the one that it begins; V-CC-V is one unit."""
    assert pieces([4, 9, 5, 2, 6], [True, False, True, False, True]) == [Piece(0, 18, 0, 5), Piece(13, 26, 5, 0)]
    assert pieces([4, 3, 3, 5], [True, False, False, True]) == [Piece(0, 15, 0, 0)]
    found = pieces([4, 3, 4, 3, 4], [True, False, True, False, True])
    assert found == [Piece(0, 11, 0, 4), Piece(7, 18, 4, 0)]


def test_short_units_can_be_taken_together() -> None:
    """Where seams are measured: a piece ends with the first unit that gives it so many frames, if that fits."""
    assert pieces([4, 3, 4, 3, 4, 3, 5, 20], [True, False] * 4, 16) == [Piece(0, 18, 0, 4), Piece(14, 46, 4, 0)]
    found = pieces([4, 3, 4, 35, 5], [True, False, True, False, True], 16)
    assert found[0] == Piece(0, 11, 0, 4) and found[1].begin == 7


def test_edges() -> None:
    """A stream's first and last phoneme are boundaries; long units are cut and chained; no frames are no piece."""
    assert pieces([4, 3, 3], [False, False, False]) == [Piece(0, 10, 0, 0)]
    assert pieces([100], [False]) == [Piece(0, 40, 0, 8), Piece(32, 72, 8, 8), Piece(64, 100, 8, 0)]
    assert pieces([2, 30, 4, 5], [False, True, False, True])[0] == Piece(0, 32, 0, OVERLAP)
    assert pieces([4, 0, 3, 0], [False, True, False, True]) == [Piece(0, 7, 0, 0)]
    assert pieces([0, 0], [True, True]) == [] and whole_piece([0]) == []
    assert whole_piece([3, 0, 4]) == [Piece(0, 7, 0, 0)]


@pytest.mark.parametrize("seed", range(8))
def test_pieces_cover_every_frame_once_or_twice(seed: int) -> None:
    """For any stream: no gap, no frame in three pieces, no piece that is too long, shared frames agree."""
    model = random_model(seed)
    for stream in streams(len(model.phonemes), model.boundary, seed).values():
        counts = frame_counts([ms for _, ms in stream], 50)
        cut = pieces(counts, [bool(model.boundary[p]) for p, _ in stream])
        cover = np.zeros(sum(counts), dtype=int)
        for before, after in zip([None, *cut], cut):
            cover[after.begin : after.end] += 1
            assert 0 < after.end - after.begin <= PIECE_MAX
            assert after.fade_in + after.fade_out <= after.end - after.begin
            assert after.fade_in == (before.end - after.begin if before else 0)
            assert after.fade_in == (before.fade_out if before else 0) <= OVERLAP
        assert cover.size == 0 or (cover.min() >= 1 and cover.max() <= 2)


def random_tables(rng: np.random.Generator, frames: int, channels: int, states: int):
    transition = -np.log(rng.dirichlet(np.ones(states), (channels, states)))
    return rng.exponential(2.0, (frames, channels, states)), transition, rng.exponential(1.0, (channels, states))


def test_search_by_every_path_of_small_cases() -> None:
    """Catches transitions read [to, from], a forgotten start or last frame, channels that mix."""
    rng = np.random.default_rng(0)
    for frames, states in ((1, 3), (2, 4), (5, 3)):
        emission, transition, initial = random_tables(rng, frames, 4, states)
        transition[rng.random(transition.shape) < 0.3] = np.inf
        transition[:, np.arange(states), np.arange(states)] = 1.0
        path = viterbi(emission, transition, initial)
        for k in range(4):
            assert tuple(path[:, k]) == likeliest(emission[:, k], transition[k], initial[k])


def test_search_agrees_with_hmmlearn() -> None:
    """hmmlearn's search is another program."""
    model = hidden_markov_model(1, 12, 0.3)
    x, _ = model.sample(200, random_state=2)
    likelihood, expected = model.decode(x)
    variance = model.covars_[:, 0, 0]
    emission = 0.5 * ((x - model.means_[:, 0]) ** 2 / variance + np.log(2 * np.pi * variance))
    with np.errstate(divide="ignore"):
        transition, initial = -np.log(model.transmat_), -np.log(model.startprob_)
    path = viterbi(emission, transition, initial)
    np.testing.assert_array_equal(path, expected)
    np.testing.assert_allclose(-path_cost(path, emission, transition, initial), likelihood)


def test_ties_and_edges() -> None:
    """Equal paths must not depend on the platform; the middle frame of a stride is looked at; no frames are no path."""
    assert not viterbi(np.zeros((6, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).any()
    assert viterbi(np.zeros((0, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).shape == (0, 2)
    assert looked_at(7, 3).tolist() == [1, 4, 6] and looked_at(4, 2).tolist() == [1, 3]


def test_join_crosses_shared_frames_linearly() -> None:
    """Frames of one unit are its own; shared ones go from the old to the new in even steps, as it is published."""
    pieces = [Piece(0, 6, 0, 3), Piece(3, 9, 3, 0)]
    joined = join(pieces, [np.zeros((6, 1)), np.full((6, 1), 4.0)])
    assert joined[:, 0].tolist() == [0, 0, 0, 1, 2, 3, 4, 4, 4]
