"""Viterbi search against hmmlearn and against trying every path."""

from __future__ import annotations

import itertools

import numpy as np
from hmmlearn.hmm import GaussianHMM

from labial.reference.viterbi import decode, looked_at, path_cost, viterbi


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


def test_leaps_and_beam_by_every_path():
    # Catches a leap from a state that was passed over, or into one by its predecessors, and a beam in the first step.
    rng = np.random.default_rng(2)
    beam, leap, states = 1.5, 1.0, 4
    for _ in range(40):
        every_emission, every_transition, every_initial = random_tables(rng, 4, 1, states)
        emission, transition, initial = every_emission[:, 0], every_transition[0], every_initial[0]
        transition[rng.random(transition.shape) < 0.5] = np.inf
        passed = emission > emission.min(axis=1, keepdims=True) + beam
        passed[0] = False
        cost, paths = initial + emission[0], [(q,) for q in range(states)]
        for t in range(1, 4):
            best = min((q for q in range(states) if not passed[t - 1, q]), key=lambda q: cost[q])
            entered, grown = [], []
            for q in range(states):
                ways = [(cost[best] + leap, best)]
                if not passed[t, q]:
                    ways += [(cost[p] + transition[p, q], p) for p in range(states)]
                least, origin = min(ways)
                entered.append(least + emission[t, q])
                grown.append((*paths[origin], q))
            cost, paths = np.array(entered), grown
        found = viterbi(emission[:, None], transition[None], initial[None], beam=beam, leap=leap)
        assert tuple(found[:, 0]) == paths[int(cost.argmin())]


def test_a_state_is_held_for_a_stride_and_sees_its_middle():
    # Catches a search that sees the first frame of each stride, or a last one beyond the end.
    assert looked_at(7, 3).tolist() == [1, 4, 6] and looked_at(4, 2).tolist() == [1, 3]
    assert looked_at(1, 3).tolist() == [0]
    targets = np.array([9.0, 0, 9, 9, 1, 9, 0])[:, None]
    free = np.zeros((1, 2, 2))
    path = decode(lambda seen: np.abs(seen[:, :, None] - [0.0, 1.0]), targets, free, np.zeros((1, 2)), 3)
    assert path[:, 0].tolist() == [0, 0, 0, 1, 1, 1, 0]


def test_ties_go_to_the_lower_state():
    # Catches an order of comparison that would make equal paths depend on the platform.
    path = viterbi(np.zeros((6, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3)))
    assert not path.any()


def test_no_frames():
    # Catches a search that needs a first frame.
    assert viterbi(np.zeros((0, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).shape == (0, 2)
