"""The search against hmmlearn, against trying every path, and by hand. tests/c/test_viterbi.c has its rules once more,
and test_conformance.py what the library and this reference make of them."""

from __future__ import annotations

import itertools
from typing import List

import numpy as np
import pytest
from hmmlearn.hmm import GaussianHMM

from labial import BUNDLED
from labial.evaluate.search import units_path
from labial.reference.published import path_cost
from labial.reference.stream import aims
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.viterbi import Chains, block_ends, decode, looked_at, normal_chains, window
from labial.tables.fixed import LEAP, SEARCHED
from labial.tables.model import load
from labial.tables.phones import drawn_streams
from labial.tables.quantise import quantise

ALL = 1000  # a lag and a window that leave nothing out


def ends_of(frames: int, *units: int) -> np.ndarray:
    ends = np.zeros(frames, dtype=bool)
    ends[[*units, frames - 1]] = True
    return ends


def hidden_markov_model(seed: int, states: int, concentration: float) -> GaussianHMM:
    rng = np.random.default_rng(seed)
    model = GaussianHMM(states, covariance_type="diag")
    model.n_features = 1
    model.startprob_ = rng.dirichlet(np.ones(states))
    model.transmat_ = rng.dirichlet(np.full(states, concentration), states)
    model.means_ = np.sort(rng.normal(0, 50, (states, 1)), axis=0)
    model.covars_ = rng.uniform(50, 400, (states, 1))
    return model


def chains_of(models: List[GaussianHMM]) -> Chains:
    """The chains of 13 channels, of each model in turn."""
    each = [models[k % len(models)] for k in range(13)]
    with np.errstate(divide="ignore"):
        return normal_chains(
            np.stack([item.means_[:, 0] for item in each]), np.stack([item.covars_[:, 0, 0] for item in each]),
            np.log([item.transmat_ for item in each]), np.log([item.startprob_ for item in each]),
        )  # fmt: skip


def likeliest(emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> tuple:
    """The path of least cost among all, the first of equals."""
    every = itertools.product(range(emission.shape[1]), repeat=len(emission))
    return min(every, key=lambda path: float(path_cost(np.array(path), emission, transition, initial)))


# ---- A lag as long as the utterance, with all states in the window, is Viterbi's algorithm.


def test_a_long_lag_agrees_with_hmmlearn() -> None:
    """Another program's search over a long sequence: catches a recursion or a trace that errs far from its end."""
    models = [hidden_markov_model(seed, 9, 4.0) for seed in (1, 2)]
    assert all(-np.log(item.transmat_).max() < LEAP / 32 for item in models)  # so that nothing needs a leap
    samples = [item.sample(150, random_state=3)[0] for item in models]
    targets = np.concatenate([samples[k % 2] for k in range(13)], axis=1)
    path = decode(chains_of(models), [targets], [ends_of(150)], 1, lag=ALL, searched=ALL)[0]
    for k in range(13):
        np.testing.assert_array_equal(path[:, k], models[k % 2].decode(samples[k % 2])[1])


@pytest.mark.parametrize("seed", range(5))
def test_a_long_lag_is_the_best_of_all_paths_with_leaps(seed: int) -> None:
    """Where transitions are rare the search leaps: as if each cost LEAP at most, whichever state it leaves."""
    model = hidden_markov_model(seed, 4, 0.08)
    chains = chains_of([model])
    target = np.random.default_rng(seed).normal(0, 60, (6, 1))
    path = decode(chains, [np.repeat(target, 13, axis=1)], [ends_of(6)], 1, lag=ALL, searched=ALL)[0]
    distance = (target - model.means_[:, 0]) ** 2 / model.covars_[:, 0, 0]
    emission = 0.5 * (distance + np.log(model.covars_[:, 0, 0]))
    transition = np.minimum(chains.transition[0], LEAP / 32)
    assert (chains.transition[0] > LEAP / 32).any()
    assert tuple(path[:, 0]) == likeliest(emission, transition, chains.initial[0])


def test_a_units_end_decides_it() -> None:
    """Each unit is the best of all its paths from the last state of the unit before, whatever comes after it."""
    for seed in range(8):
        model = hidden_markov_model(seed, 3, 0.3)
        chains = chains_of([model])
        target = np.random.default_rng(seed).normal(0, 60, (9, 1))
        path = decode(chains, [np.repeat(target, 13, axis=1)], [ends_of(9, 3)], 1, lag=ALL, searched=ALL)[0][:, 0]
        distance = (target - model.means_[:, 0]) ** 2 / model.covars_[:, 0, 0]
        emission = 0.5 * (distance + np.log(model.covars_[:, 0, 0]))
        transition = np.minimum(chains.transition[0], LEAP / 32)
        first = likeliest(emission[:4], transition, chains.initial[0])
        assert tuple(path[:4]) == first
        assert tuple(path[4:]) == likeliest(emission[4:], transition, transition[first[-1]])


def costs(chains: Chains, stride: int, target: np.ndarray, path: np.ndarray) -> List[float]:
    """The costs of each channel's path (T, C) for targets (T, C)."""
    found = []
    transition, every = np.minimum(chains.transition, chains.leap), np.arange(chains.mean.shape[1])
    for k in range(len(chains.mean)):
        last = block_ends(len(target), stride, k)
        seen = target[looked_at(len(target), stride, len(last), channels=len(chains.mean))[:, k]]
        emission = chains.emission(seen, np.broadcast_to(every, (len(last), *chains.mean.shape)))[:, k]
        found.append(float(path_cost(path[last, k], emission, transition[k], chains.initial[k])))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", BUNDLED)
@pytest.mark.parametrize("width", [SEARCHED, 64])
def test_with_a_long_lag_units_are_searched_as_wholes(name: str, width: int) -> None:
    """On the bundled models' own tables, float and exported: scores that are cut off, leaps from the best state
    alone and decisions as the frames come leave nothing out but what lies beyond the window. Longer units than the
    library's longest lag, 40 frames, are decided before they end."""
    model = load(name)
    for tables in (FloatTables(model), ExportedTables(quantise(model, name))):
        for stream in drawn_streams(model, 6):
            target, _, ends = aims(tables, stream)
            whole = units_path(tables, target, ends, width)
            path = tables.search(target, ends, len(target), searched=width)
            assert np.mean(path == whole) > 0.99
            np.testing.assert_allclose(costs(tables.chains, tables.stride, target, path),
                                       costs(tables.chains, tables.stride, target, whole), rtol=1e-12)  # but for ties
            late = tables.search(target, ends, 40, searched=width)
            spans = np.diff([0, *(np.flatnonzero(ends) + 1)])
            short = np.repeat(spans <= 40 - tables.stride, spans)
            np.testing.assert_array_equal(late[short], path[short])


def test_a_step_by_hand() -> None:
    """Two states, at 0 and 100: the emission prefers the second by 30, the transition costs 40, then the search stays;
    then it prefers it by 50 more, and goes."""
    def emission(targets: np.ndarray, states: np.ndarray) -> np.ndarray:
        return np.where(states == 1, 0, targets[..., None])

    transition = np.broadcast_to([[0.0, 40.0], [40.0, 0.0]], (13, 2, 2))
    chains = Chains(np.tile([0.0, 100.0], (13, 1)), transition, np.tile([0.0, 90.0], (13, 1)), 255.0, emission)
    targets = np.repeat([[0.0], [30.0], [9.0], [20.0], [0.0]], 13, axis=1)
    # Scores of the second, relative to the first: 90 -> 40 - 30 = 10 -> 1 -> -19 -> -19
    path = decode(chains, [targets], [ends_of(5)], 1)[0]
    assert path[:, 0].tolist() == [0, 0, 0, 1, 1]
    assert decode(chains, [targets], [ends_of(5)], 1, lag=1)[0][:, 0].tolist() == [0, 0, 1, 1, 1]
    # A unit that ends with the second frame leaves its best alone: the second state is entered anew, for 40.
    assert decode(chains, [targets], [ends_of(5, 1)], 1)[0][:, 0].tolist() == [0, 0, 0, 0, 0]


def test_a_leap_goes_before_an_edge_that_costs_as_much() -> None:
    """The third state is entered from the second for 100 + 155, or from the best, the first, for 255: at once it is the
    same, but not for who asks where it came from. An edge that costs one less wins."""
    costs = np.array([[0, 100, 300], [900, 900, 0]])

    def emission(targets: np.ndarray, states: np.ndarray) -> np.ndarray:
        return costs[targets.astype(int)[..., None], states]

    transition = np.full((13, 3, 3), np.inf)
    mean, initial = np.tile([0.0, 100.0, 200.0], (13, 1)), np.zeros((13, 3))
    targets = np.repeat([[0.0], [1.0]], 13, axis=1)
    for edge, origin in ((155.0, 0), (154.0, 1)):
        transition[:, 1, 2] = edge
        path = decode(Chains(mean, transition, initial, 255.0, emission), [targets], [ends_of(2)], 1, lag=1)[0]
        assert path[:, 0].tolist() == [origin, 2]


def test_the_window_lies_around_the_nearest_state() -> None:
    """Ties go to the lower state, equal means to the first above and the last below; the ends push the window in."""
    mean = np.tile([0, 10, 20, 20, 20, 30, 40, 50], (13, 1))
    expected = {-5: 0, 4: 0, 5: 0, 6: 0, 15: 0, 16: 1, 20: 1, 24: 3, 25: 3, 26: 4, 36: 5, 99: 5}
    for x, first in expected.items():
        assert (window(np.full(13, x), mean, 3) == first).all(), x
    assert (window(np.full(13, 20), mean, 8) == 0).all()


def test_utterances_are_searched_as_if_alone() -> None:
    """Training decodes many at once: a shorter one must not feel what pads it."""
    chains = chains_of([hidden_markov_model(3, 15, 0.4)])
    rng = np.random.default_rng(3)
    targets = [rng.normal(0, 60, (frames, 13)) for frames in (1, 30, 7, 31)]
    ends = [ends_of(len(item), 0, len(item) // 2) for item in targets]
    for lag in (0, 4):
        together = decode(chains, targets, ends, 3, lag=lag)
        for target, end, path in zip(targets, ends, together):
            np.testing.assert_array_equal(path, decode(chains, [target], [end], 3, lag=lag)[0])
