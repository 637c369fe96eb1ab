"""Number formats and limits of the exported tables."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from labial.errors import ModelError
from labial.fixed import PULL_MAX, WEIGHT_MIN, WEIGHT_SUM_MAX, WEIGHTS, gain, weight_code, weight_value, z_cost
from labial.loss import measure
from labial.quantise import quantise
from models import random_model, streams


def test_weights_are_ascending_and_codes_are_the_nearest() -> None:
    """A gap or an overlap between exponents, or rounding to the wrong side, would bias every precision."""
    assert (np.diff(WEIGHTS) > 0).all() and WEIGHTS[0] == 0 and WEIGHTS[255] == 507904
    assert np.array_equal(weight_code(WEIGHTS), np.arange(256))
    values = np.random.default_rng(0).uniform(0, 507904, 2000)
    nearest = np.abs(WEIGHTS[None, :] - values[:, None]).min(axis=1)
    assert np.allclose(np.abs(weight_value(weight_code(values)) - values), nearest)


@pytest.mark.parametrize("deviation", [10.0, 33.3, 400.0])
def test_gaussian_cost_is_the_exponent(deviation: float) -> None:
    """z^2 / 2^7 with z = x gain / 2^12 must be 32 x^2 / (2 s^2), to the resolution of z."""
    for distance in (0.0, 0.5 * deviation, deviation, 4 * deviation):
        z = (int(distance) * gain(np.array(deviation))) >> 12
        assert abs(z_cost(z) / 32 - (int(distance) / deviation) ** 2 / 2) < 0.06 + 0.02 * distance / deviation


@pytest.mark.parametrize("method", ["paper", "labial"])
def test_equation_3_stays_within_the_solvers_bounds(method: str) -> None:
    """Beyond them the library's 32-bit numbers overflow."""
    exported = quantise(random_model(3, method), "model")
    weight, anchor = weight_value(exported.state_weight), weight_value(exported.state_anchor)
    held = (weight[..., 0] + anchor).max(axis=1)
    pulls = (weight * np.abs(exported.state_mean)).max(axis=1)
    assert ((weight[..., 0] + anchor) >= WEIGHT_MIN).all()
    assert (held + 2 * weight[..., 1].max(axis=1) + 6 * weight[..., 2].max(axis=1) <= WEIGHT_SUM_MAX).all()
    assert (held * 16383 + 4 * pulls[:, 1] + 4 * pulls[:, 2] <= PULL_MAX).all()


def test_every_table_fits_its_c_type() -> None:
    """A value that wraps in C would be silently another one."""
    exported = quantise(random_model(4), "model")
    ranges = {
        "cost": (0, 65535), "duration_mean": (0, 65535), "duration_gain": (1, 65535), "contexts": (0, 255),
        "slopes": (-127, 127), "pairs": (-127, 127), "pair_scale": (0, 65535),
        "kernels": (-127, 127), "slope_scale": (0, 16383),
        "kernel_scale": (0, 65535), "centre": (-16383, 16383), "emission_mean": (-16383, 16383),
        "emission_gain": (1, 65535), "emission_cost": (0, 255), "initial": (0, 255), "state_mean": (-16383, 16383),
        "state_weight": (0, 255), "state_anchor": (0, 255), "shapes": (-127, 127), "shape_scale": (0, 32767),
    }  # fmt: skip
    for name, (low, high) in ranges.items():
        values = np.asarray(getattr(exported, name))
        assert values.min() >= low and values.max() <= high, name


def test_substitutes_share_components() -> None:
    """Phonemes that stand in for each other must not cost flash twice."""
    model = random_model(5)
    arrays = {}
    tables = "log_weight duration_mean duration_variance shape slope log_previous log_next"
    for name in tables.split():
        array = getattr(model, name).copy()
        array[3:6] = array[0:3]
        arrays[name] = array
    exported = quantise(dataclasses.replace(model, **arrays), "model")
    assert exported.first_component[1] == exported.first_component[0] == 0
    assert len(exported.cost) == 3 * (len(model.phonemes) - 1)


def test_keeps_the_asked_number_of_predecessors_and_always_the_state_itself() -> None:
    """Without its own state as predecessor a state could not be held."""
    exported = quantise(random_model(6), "model", predecessors=4)
    assert exported.edges.shape == (13, 12, 4) and not (exported.edges & 3).any()
    predecessor = (exported.edges & 255) >> 2
    assert (predecessor == np.arange(12)[:, None]).any(axis=2).all() and (np.diff(predecessor) > 0).all()


def test_fewer_predecessors_than_asked_for_are_repeated() -> None:
    """The library reads the same number for every state: what stands there must be a transition that exists."""
    model = random_model(6)
    rare = np.where(np.eye(12, dtype=bool) | np.eye(12, k=1, dtype=bool), model.log_transition, -np.inf)
    exported = quantise(dataclasses.replace(model, log_transition=rare), "model", predecessors=4)
    dense = exported.dense_transitions()
    assert (np.isfinite(dense) == np.isfinite(rare)).all()
    np.testing.assert_array_equal(exported.edges[:, 0, 1:], np.repeat(exported.edges[:, 0, :1], 3, axis=1))


def test_keeps_the_predecessors_that_are_used_most() -> None:
    """A likely transition from a state that never occurs is worth less than an unlikely one from where the chain is."""
    model = random_model(6, states=3)
    step = np.array([[0.98, 0.0, 0.02], [0.0, 0.1, 0.9], [0.5, 0.001, 0.499]])
    step /= step.sum(axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        logs = np.broadcast_to(np.log(step), (13, 3, 3))
    exported = quantise(dataclasses.replace(model, log_transition=logs), "model", predecessors=2)
    np.testing.assert_array_equal((exported.edges[0, 2] & 255) >> 2, [0, 2, 2, 2])


def test_quantisation_loss_is_small_where_paths_agree() -> None:
    """With every transition kept the exported tables must move as the float model does, median over all frames."""
    model = random_model(7)
    exported = quantise(model, "model", predecessors=12)
    loss = measure(model, exported, [streams(9, model.boundary, 7)["ordinary"]])
    assert (loss.path >= -1e-9).all() and loss.path.mean() < 0.2
    assert np.median(loss.share) < 3.0


@pytest.mark.parametrize(
    ("message", "change"),
    [
        ("kernel lags", {"kernel_lag": np.arange(-5, 8, 2)}),
        ("reach", {"kernel_lag": np.arange(-36, 37, 12)}),
        ("FAP units", {"state_mean": "far"}),
    ],
)
def test_refuses_what_the_library_cannot_hold(message: str, change: dict) -> None:
    """Such tables would be refused on the device, too late."""
    model = random_model(8)
    if change.get("state_mean") == "far":
        far = model.state_mean.copy()
        far[0, 0, 0] += 5000.0
        change = {"state_mean": far}
    with pytest.raises(ModelError, match=message):
        quantise(dataclasses.replace(model, **change), "model")
