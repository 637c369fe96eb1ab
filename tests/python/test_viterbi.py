"""Viterbi search against hmmlearn and against trying every path."""

from __future__ import annotations

import itertools

import numpy as np
from hmmlearn.hmm import GaussianHMM

from labial.reference.viterbi import path_cost, viterbi


def random_tables(rng: np.random.Generator, frames: int, channels: int, states: int):
    transition = -np.log(rng.dirichlet(np.ones(states), (channels, states)))
    return rng.exponential(2.0, (frames, channels, states)), transition, rng.exponential(1.0, (channels, states))


def test_every_path_of_small_cases():
    # Catches transitions read [to, from], a forgotten start or last frame, channels that mix.
    rng = np.random.default_rng(0)
    for frames, states in ((1, 3), (2, 4), (5, 3)):
        emission, transition, initial = random_tables(rng, frames, 4, states)
        transition[rng.random(transition.shape) < 0.3] = np.inf
        transition[:, np.arange(states), np.arange(states)] = 1.0
        path = viterbi(emission, transition, initial)
        for channel in range(4):
            tables = emission[:, channel], transition[channel], initial[channel]
            every = itertools.product(range(states), repeat=frames)
            best = min(every, key=lambda states_, given=tables: float(path_cost(np.array(states_), *given)))
            assert tuple(path[:, channel]) == best


def test_agrees_with_hmmlearn():
    # Catches a wrong recursion over long sequences; hmmlearn's search is another program.
    rng = np.random.default_rng(1)
    states, frames = 12, 200
    model = GaussianHMM(states, covariance_type="diag")
    model.startprob_ = rng.dirichlet(np.ones(states))
    model.transmat_ = rng.dirichlet(np.full(states, 0.3), states)
    model.means_ = rng.normal(0, 50, (states, 1))
    model.covars_ = rng.uniform(50, 400, (states, 1))
    x, _ = model.sample(frames, random_state=2)
    likelihood, expected = model.decode(x)
    variance = model.covars_[:, 0, 0]
    emission = 0.5 * ((x - model.means_[:, 0]) ** 2 / variance + np.log(2 * np.pi * variance))
    with np.errstate(divide="ignore"):
        transition, initial = -np.log(model.transmat_), -np.log(model.startprob_)
    path = viterbi(emission, transition, initial)
    np.testing.assert_array_equal(path, expected)
    np.testing.assert_allclose(-path_cost(path, emission, transition, initial), likelihood)


def test_ties_go_to_the_lower_state():
    # Catches an order of comparison that would make equal paths depend on the platform.
    path = viterbi(np.zeros((6, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3)))
    assert not path.any()


def test_no_frames():
    # Catches a search that needs a first frame.
    assert viterbi(np.zeros((0, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).shape == (0, 2)
