"""The search against hmmlearn, against trying every path, and against its rules written out state by state."""

from __future__ import annotations

import itertools
from typing import List, Optional

import numpy as np
import pytest
from hmmlearn.hmm import GaussianHMM

from labial import BUNDLED
from labial.evaluate.search import units_path
from labial.reference.published import path_cost
from labial.reference.stream import aims
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.viterbi import Chains, block_at, block_ends, decode, looked_at, normal_chains, window
from labial.tables.fixed import LEAP, SEARCHED
from labial.tables.model import load
from labial.tables.phones import drawn_streams
from labial.tables.quantise import ExportedModel, quantise
from models import random_model, streams

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


def test_a_lag_is_a_look_at_what_the_search_knows_by_then() -> None:
    """The state of frame b with a lag of L is that of the best path through the frames up to b + L alone."""
    model = hidden_markov_model(5, 8, 0.5)
    chains, ends = chains_of([model]), ends_of(30, 11)
    targets = np.repeat(np.random.default_rng(5).normal(0, 60, (30, 1)), 13, axis=1)
    by_lag = {lag: decode(chains, [targets], [ends], 1, lag=lag, searched=ALL)[0] for lag in (0, 1, 2, 5, ALL)}
    for lag in (0, 1, 2, 5):
        for b in range(30):
            known = min(b + lag, 11 if b <= 11 else 29) + 1
            until = ends[:known].copy()
            until[-1] = True
            best = decode(chains, [targets[:known]], [until], 1, lag=ALL, searched=ALL)[0]
            assert (by_lag[lag][b] == best[b]).all()
    assert len({path.tobytes() for path in by_lag.values()}) > 2  # lags matter here


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


# ---- The rules of the exported tables, written out once more.


def scalar_search(model: ExportedModel, channel: int, target: np.ndarray, ends: np.ndarray, lag: int) -> List[int]:
    """The state of every frame of one channel, from the tables as they are stored, in whole numbers alone."""
    stride, frames = model.search_stride, len(target)
    mean = [int(v) for v in model.emission_mean[channel]]
    states = len(mean)
    width = min(SEARCHED, states)
    scores: Optional[dict] = None
    rows, spans, closed = [], [], []
    begin = 0
    for k in range(frames):
        if k % stride != channel % stride and k != frames - 1:
            continue
        end = k
        while end % stride != channel % stride:
            end += 1  # the grid's, where the utterance ends before
        x = int(target[min(max(end - stride + 1 + stride // 2, 0), frames - 1)])
        below, above = [q for q in range(states) if mean[q] < x], [q for q in range(states) if mean[q] >= x]
        is_above = above and (not below or mean[above[0]] - x < x - mean[below[-1]])
        nearest = above[0] if is_above else below[-1]
        first = min(max(nearest - width // 2, 0), states - width)
        total, origin = {}, {}
        best = min(scores, key=lambda q: (scores[q], q)) if scores else None
        for q in range(first, first + width):
            short = int(model.emission_gain[channel, q])
            z = min(abs(x - mean[q]) * (16 + short % 16) // 2 ** (short // 16), 1023)
            if scores is None:
                enter, origin[q] = int(model.initial[channel, q]), None
            else:
                enter, origin[q] = 255, best
                for edge in model.transitions[channel, q]:
                    p, cost = (int(value) for value in edge)
                    if p in scores and scores[p] + cost < enter:
                        enter, origin[q] = scores[p] + cost, p
            total[q] = enter + (z * z >> 7) + int(model.emission_cost[channel, q])
        least = min(total.values())
        scores = {q: min(value - least, 255) for q, value in total.items()}
        winner = min(q for q, value in total.items() if value == least)
        closed.append(bool(ends[begin : k + 1].any()))
        if closed[-1]:
            scores = {q: 0 if q == winner else 255 for q in scores}
        rows.append((origin, winner))
        spans.append(k + 1 - begin)
        begin = k + 1
    found: List[int] = []
    block = [b for b, span in enumerate(spans) for _ in range(span)]
    for frame, b in enumerate(block):
        last = b
        while last < block[min(frame + lag, frames - 1)] and not closed[last]:
            last += 1
        state = rows[last][1]
        for later in range(last, b, -1):
            state = rows[later][0][state]
        found.append(state)
    return found


@pytest.mark.parametrize(("seed", "states", "lag"), [
    (0, 12, 0), (2, 50, 0), (2, 9, 7),
    *(pytest.param(*numbers, marks=pytest.mark.slow) for numbers in ((1, 30, 0), (3, 50, 3), (4, 20, 5), (5, 5, 3))),
])  # fmt: skip
def test_exported_decisions_are_those_of_the_rules(seed: int, states: int, lag: int) -> None:
    """The library takes the same ones: a tie, a clamp, an edge from outside the window or a grid that differs would
    show. Few states and coarse costs make ties frequent."""
    model = quantise(random_model(seed, states=states), "model")
    tables = ExportedTables(model)
    for name in ("ordinary", "one frame each", "with zeros"):
        target, _, ends = aims(tables, streams(9, tables.boundary, seed)[name])
        target, ends = target[:90] // 64 * 64, ends[:90].copy()  # coarse, so that states tie
        ends[-1] = True
        path = tables.search(target, ends, lag)
        for channel in range(13):
            assert path[:, channel].tolist() == scalar_search(model, channel, target[:, channel], ends, lag)


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


# ---- Blocks and windows.


def test_every_channel_has_a_grid_of_its_own() -> None:
    """Channel 4 of stride 3 ends its blocks with the frames 1, 4, 7; its neighbours take their steps in other ticks."""
    assert block_at(8, 3)[:, 4].tolist() == [0, 0, 1, 1, 1, 2, 2, 2]
    assert block_at(8, 3)[:, 3].tolist() == [0, 1, 1, 1, 2, 2, 2, 3]
    assert block_at(8, 3)[:, 5].tolist() == [0, 0, 0, 1, 1, 1, 2, 2]
    assert block_ends(8, 3, 3).tolist() == [0, 3, 6, 7] and block_ends(8, 3, 4).tolist() == [1, 4, 7]
    assert block_ends(1, 3, 2).tolist() == [0] and block_ends(5, 1, 7).tolist() == [0, 1, 2, 3, 4]
    for stride in range(1, 9):
        for frames in (1, 2, 7, 20):
            for k in range(13):
                ends = block_ends(frames, stride, k)
                assert (np.diff(block_at(frames, stride)[:, k]) == np.isin(np.arange(frames - 1), ends)).all()


def test_a_block_sees_its_middle() -> None:
    """Of three frames the middle one, of two the later, also where the stream's ends cut the block."""
    assert looked_at(8, 3, 4)[:, 3].tolist() == [0, 2, 5, 7]  # the first of -2 .. 0, the last of 7 .. 9
    assert looked_at(8, 3, 3)[:, 4].tolist() == [0, 3, 6]
    assert looked_at(6, 2, 3)[:, 1].tolist() == [1, 3, 5] and looked_at(6, 2, 4)[:, 0].tolist() == [0, 2, 4, 5]
    assert looked_at(4, 1, 4)[:, 0].tolist() == [0, 1, 2, 3]


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
