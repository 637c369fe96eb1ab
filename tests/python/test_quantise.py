"""Number formats and limits of the exported tables."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pytest

from labial.corpus.phonesets import LABEL_SETS
from labial.errors import ModelError
from labial.evaluate.loss import loosened, measure
from labial.files.faps import CHANNELS, TOUCHING
from labial.reference import contact
from labial.reference.stream import DURATION_MAX
from labial.reference.trajectory import WINDOW
from labial.reference.viterbi import LAG
from labial.rig import table
from labial.rig.description import CURVE_POINTS, SOURCES
from labial.tables import emit, fixed
from labial.tables.fixed import (
    PULL_MAX,
    STIFFNESS_MAX,
    WEIGHT_MIN,
    WEIGHT_SUM_MAX,
    WEIGHTS,
    share_code,
    share_value,
    weight_code,
    weight_code_below,
    weight_value,
)
from labial.tables.layout import check_fits
from labial.tables.model import Model
from labial.tables.quantise import FORMAT, LIMITS, ExportedModel, quantise
from models import random_model, streams
from packages import SOURCE


def test_limits_are_the_librarys() -> None:
    """The exporter and the reference write numbers down that the headers define; one that is changed there alone makes
    models that the library refuses, or another motion."""
    headers = ("model.h", "config.h", "labial.h", "names.h", "rig.h")
    sources = [SOURCE / "include" / "labial" / name for name in headers]
    sources += [SOURCE / "lib" / name for name in ("shape.c", "viterbi.h")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    pattern = r"^(?:#define )? *(?:LABIAL_)?(\w+)(?: =)? \(?(-?(?:0x[0-9a-f]+|\d+))u?\)?[,\s]"
    defined = {name: int(value, 0) for name, value in re.findall(pattern, text, re.M)}
    known = {
        "MODEL_FORMAT": FORMAT, "POSITION_MAX": fixed.POSITION_MAX, "NO_FLOOR": fixed.NO_FLOOR,
        "WEIGHT_SUM_MAX": WEIGHT_SUM_MAX, "WEIGHT_MIN": WEIGHT_MIN, "STIFFNESS_MAX": STIFFNESS_MAX,
        "PULL_MAX": PULL_MAX, "SEARCHED": fixed.SEARCHED, "WINDOW": WINDOW, "LAG": LAG, "DURATION_MAX": DURATION_MAX,
        "PHONEMES_MAX": LIMITS["phonemes"], "CLASSES_MAX": LIMITS["classes"], "STATES_MAX": LIMITS["states"],
        "PHONEME_COMPONENTS_MAX": LIMITS["components"], "KERNEL_TAPS_MAX": LIMITS["taps"],
        "SEARCH_STRIDE_MAX": LIMITS["stride"], "REACH": LIMITS["reach"], "CHANNELS": CHANNELS,
        "CONTACT_FRAMES": contact.FRAMES, "CONTACT_OPEN": contact.OPEN,
        "REST_FRAMES": contact.REST, "DURATION_Z_MAX": fixed.DURATION_Z_MAX, "EMISSION_Z_MAX": fixed.EMISSION_Z_MAX,
        "NAMES_FORMAT": emit.NAMES_FORMAT, "RIG_FORMAT": table.FORMAT,
        "RIG_WEIGHT_SUM_MAX": table.WEIGHT_SUM_MAX, "RIG_GAIN_MAX": table.GAIN_MAX,
        "RIG_VALUE_MAX": table.VALUE_MAX, "RIG_SLOPE_MAX": table.SLOPE_MAX, "RIG_SEGMENTS": table.SEGMENTS,
        "RIG_TOUCHING": TOUCHING, "RIG_APART": table.APART, "RIG_OPENING": SOURCES["opening"].reach,
        **{f"LABELS_{name.upper()}": bit for name, bit in LABEL_SETS.items()},
    }  # fmt: skip
    assert {name: defined.get(name) for name in known} == known and table.SEGMENTS == CURVE_POINTS[1] - 1


def test_weights_are_ascending_and_codes_are_the_nearest() -> None:
    """A gap or an overlap between exponents, or rounding to the wrong side, would bias every precision; what is lowered
    to a bound must not be rounded up beyond it."""
    assert (np.diff(WEIGHTS) > 0).all() and WEIGHTS[0] == 0 and WEIGHTS[255] == 507904
    assert np.array_equal(weight_code(WEIGHTS), np.arange(256))
    values = np.random.default_rng(0).uniform(0, 507904, 2000)
    nearest = np.abs(WEIGHTS[None, :] - values[:, None]).min(axis=1)
    assert np.allclose(np.abs(weight_value(weight_code(values)) - values), nearest)
    values = np.concatenate([WEIGHTS, WEIGHTS[1:] - 0.5, WEIGHTS + 0.5])
    assert np.array_equal(weight_value(weight_code_below(values)), [WEIGHTS[WEIGHTS <= v].max() for v in values])


def test_share_codes_are_the_nearest_and_reach_both_ends() -> None:
    """All of the anchor and none of it must be exact: the published method has no anchors."""
    meant = share_value(np.arange(256))
    assert meant[0] == 0 and meant[255] == 256 and (np.diff(meant) >= 1).all()
    assert np.array_equal(share_code(meant / 256.0), np.arange(256))
    values = np.random.default_rng(1).uniform(0, 1, 3000)
    found = share_value(share_code(values)) / 256.0
    assert np.allclose(np.abs(found - values), np.abs(meant[None, :] / 256.0 - values[:, None]).min(axis=1))


def used(exported: ExportedModel) -> dict:
    """How much of each of equation 3's bounds every channel uses, (13,) by name; above 1 the library refuses it."""
    hold, moving = weight_value(exported.state_hold), weight_value(exported.state_weight)
    pull = 4 * (moving * np.abs(exported.means()[..., 1:])).max(axis=1).sum(axis=1)
    return {
        "least": WEIGHT_MIN / hold.min(axis=1),
        "sum": (hold.max(axis=1) + 2 * moving[..., 0].max(axis=1) + 6 * moving[..., 1].max(axis=1)) / WEIGHT_SUM_MAX,
        "order": (moving[..., 0] > moving[..., 1]).any(axis=1) * 2.0,
        "stiffness": (moving[..., 1] / (STIFFNESS_MAX * hold)).max(axis=1),
        "pull": pull / (PULL_MAX * hold.min(axis=1)),
    }


def assert_within(exported: ExportedModel) -> None:
    for name, share in used(exported).items():
        assert (share <= 1.0).all(), name


@pytest.mark.parametrize("method", ["paper", "labial"])
@pytest.mark.parametrize("seed", range(4))
def test_equation_3_stays_within_the_solvers_bounds(method: str, seed: int) -> None:
    """Beyond them the library's 32-bit numbers overflow. Of the sum no more than a step of the codes is given away."""
    exported = quantise(random_model(seed, method), "model")
    assert_within(exported)
    assert used(exported)["sum"].min() > 0.9


def plain(**tables: np.ndarray) -> Model:
    """A model of four states whose channels are all alike: hold 100, half of it the anchor's; deltas 20 and 40."""
    return dataclasses.replace(random_model(2, states=4), **{
        "state_precision": np.tile([50.0, 4 * 20.0, 40.0], (CHANNELS, 4, 1)),
        "state_anchor": np.full((CHANNELS, 4), 50.0), "state_mean": np.zeros((CHANNELS, 4, 3)), **tables})


def weights_of(model: Model) -> np.ndarray:
    """(4, 4) hold, the anchor's share, a quarter of delta's and delta-delta's weight of channel 5 as exported."""
    exported = quantise(model, "model")
    assert_within(exported)
    hold, share = weight_value(exported.state_hold[5]), share_value(exported.state_share[5]) / 256.0
    return np.concatenate([np.stack([hold, share], axis=1), weight_value(exported.state_weight[5])], axis=1)


def test_what_is_within_all_bounds_only_changes_its_scale() -> None:
    """100 + 2 * 20 + 6 * 40 is 380, scaled to 16383: 43 times, and the nearest codes."""
    expected = WEIGHT_SUM_MAX / 380 * np.array([100, 20, 40])
    for found in weights_of(plain()):
        np.testing.assert_allclose(found[[0, 2, 3]], expected, rtol=1 / 16)
        assert abs(found[1] - 0.5) <= 1 / 256


def test_a_state_that_is_too_stiff_is_loosened_alone() -> None:
    """Delta-delta at 100 times what holds the state becomes 16 times that; delta goes with it, the others stay."""
    model = plain()
    precision, anchor = model.state_precision.copy(), model.state_anchor.copy()
    precision[:, 2, 0], anchor[:, 2] = 0.2, 0.2  # hold .4 of 100
    found = weights_of(dataclasses.replace(model, state_precision=precision, state_anchor=anchor))
    assert loosened(model, quantise(model, "model")) == 0
    stiff = dataclasses.replace(model, state_precision=precision, state_anchor=anchor)
    assert loosened(stiff, quantise(stiff, "model")) == CHANNELS  # and the exporter says so
    hold, _, delta, bend = found[2]
    assert 15.0 * hold <= bend <= 16.0 * hold and delta == pytest.approx(bend / 2, rel=1 / 8)
    np.testing.assert_allclose(found[[0, 1, 3]], weights_of(model)[[0, 1, 3]])


def test_a_state_that_is_hardly_held_is_held_by_the_least() -> None:
    """Hold of a hundred-thousandth would be rounded to nothing, and the system would have no solution."""
    model = plain()
    precision, anchor = model.state_precision.copy(), model.state_anchor.copy()
    precision[:, 1, 0], anchor[:, 1] = 1e-3, 0.0
    found = weights_of(dataclasses.replace(model, state_precision=precision, state_anchor=anchor))
    assert found[1, 0] == WEIGHT_MIN and found[1, 1] == 0.0 and found[1, 3] == 16 * WEIGHT_MIN
    np.testing.assert_allclose(found[[0, 2, 3]], weights_of(model)[[0, 2, 3]])


@pytest.mark.parametrize("feature", [1, 2])
def test_means_that_pull_too_far_lose_weight(feature: int) -> None:
    """One state's delta or delta-delta mean of 900 FAP units, 14,400 positions: 4 weights times that may be PULL_MAX
    times what holds the least held state."""
    model = plain()
    mean, precision = model.state_mean.copy(), model.state_precision.copy()
    mean[:, 1, feature] = 900.0
    precision[:, 1, 1:] = [4 * 300.0, 600.0]
    found = weights_of(dataclasses.replace(model, state_mean=mean, state_precision=precision))
    others = weights_of(dataclasses.replace(model, state_precision=precision))
    pull = 4 * found[1, 1 + feature] * 14400
    assert 0.85 * PULL_MAX * found[:, 0].min() < pull <= PULL_MAX * found[:, 0].min()
    assert found[1, 2] <= found[1, 3] and found[1, 3] / found[1, 0] < 0.9 * others[1, 3] / others[1, 0]
    rest = [0, 2, 3]  # by another scale, as they were
    np.testing.assert_allclose(found[rest, 3] / found[rest, 0], others[rest, 3] / others[rest, 0], rtol=1 / 8)


@pytest.mark.parametrize("seed", [*range(5), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(5, 20))])
def test_wild_models_are_brought_within_all_bounds_together(seed: int) -> None:
    """Precisions over nine decades and any means: each rule by itself could push a state beyond another's bound."""
    model = random_model(seed)
    rng = np.random.default_rng(seed)
    mean = model.state_mean.copy()
    mean[..., 1:] = rng.uniform(-1000, 1000, mean[..., 1:].shape)
    wild = dataclasses.replace(
        model,
        state_mean=mean,
        state_precision=10 ** rng.uniform(-5, 4, model.state_precision.shape),
        state_anchor=10 ** rng.uniform(-5, 4, model.state_anchor.shape),
    )
    assert_within(quantise(wild, "model"))


def test_states_must_be_sorted() -> None:
    """The search looks for the nearest state by halves."""
    model = random_model(6)
    mean = model.emission_mean.copy()
    mean[4, [2, 3]] = mean[4, [3, 2]]
    with pytest.raises(ModelError, match="emission_mean is not ascending"):
        dataclasses.replace(model, emission_mean=mean)
    assert (np.diff(quantise(model, "model").emission_mean, axis=1) >= 0).all()


def test_what_no_check_of_the_library_refuses_is_within_its_range() -> None:
    """Other values are refused when they are written, or by labial_model_check()."""
    exported = quantise(random_model(4), "model")
    assert exported.duration_gain.min() >= 1
    for name in ("slopes", "pairs", "kernels", "state_motion", "shapes"):
        assert np.abs(getattr(exported, name)).max() <= 127, name


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
    assert quantise(random_model(6), "model").transitions.shape == (13, 12, 4, 2)  # the default
    exported = quantise(random_model(6), "model", predecessors=5)
    assert exported.transitions.shape == (13, 12, 8, 2)  # in fours
    predecessor = exported.transitions[..., 0]
    assert (predecessor == np.arange(12)[:, None]).any(axis=2).all() and (np.diff(predecessor[..., :5]) > 0).all()
    assert (exported.transitions[..., 5:, :] == exported.transitions[..., 4:5, :]).all()


def test_fewer_predecessors_than_asked_for_are_repeated() -> None:
    """The library reads the same number for every state: what stands there must be a transition that exists."""
    model = random_model(6)
    rare = np.where(np.eye(12, dtype=bool) | np.eye(12, k=1, dtype=bool), model.log_transition, -np.inf)
    exported = quantise(dataclasses.replace(model, log_transition=rare), "model", predecessors=4)
    dense = exported.dense_transitions()
    assert (np.isfinite(dense) == np.isfinite(rare)).all()
    np.testing.assert_array_equal(exported.transitions[:, 0, 1:], np.repeat(exported.transitions[:, 0, :1], 3, axis=1))


def test_keeps_the_predecessors_that_are_used_most() -> None:
    """A likely transition from a state that never occurs is worth less than an unlikely one from where the chain is."""
    model = random_model(6, states=3)
    step = np.array([[0.98, 0.0, 0.02], [0.0, 0.1, 0.9], [0.5, 0.001, 0.499]])
    step /= step.sum(axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        logs = np.broadcast_to(np.log(step), (13, 3, 3))
    exported = quantise(dataclasses.replace(model, log_transition=logs), "model", predecessors=2)
    np.testing.assert_array_equal(exported.transitions[0, 2, :, 0], [0, 2, 2, 2])


def test_quantisation_loss_is_small_where_paths_agree() -> None:
    """With every transition kept the exported tables must move as the float model does, median over all frames."""
    model = random_model(7)
    exported = quantise(model, "model", predecessors=12)
    loss = measure(model, exported, [streams(9, model.boundary, 7)["ordinary"]])
    assert (loss.path >= -1e-9).all() and loss.path.mean() < 0.4  # .27, of which deciding at once takes most
    assert np.median(loss.share) < 3.0


def test_refuses_what_the_library_cannot_hold() -> None:
    """Such tables would be refused on the device, too late."""
    model = random_model(8)
    far = model.state_mean.copy()
    far[0, 0, 0] += 5000.0
    for message, change in (("kernel lags", {"kernel_lag": np.arange(-5, 8, 2)}),
                            ("reach", {"kernel_lag": np.arange(-36, 37, 12)}), ("FAP units", {"state_mean": far})):
        with pytest.raises(ModelError, match=message):
            quantise(dataclasses.replace(model, **change), "model")


# ---- What a model may hold -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [1e300, -1e300, np.nan, np.inf, 1e6])
def test_values_beyond_the_tables_are_named(value: float) -> None:
    """Would catch -9223372036854775808 in a uint16: every value of every array is refused, or the tables hold it."""
    model = random_model(2)
    for item in dataclasses.fields(model):
        array = getattr(model, item.name)
        if not isinstance(array, np.ndarray) or array.dtype.kind != "f" or not array.size:
            continue
        wrong = array.copy()
        wrong[(-1,) * wrong.ndim] = value
        at = ", ".join(str(size - 1) for size in wrong.shape)
        try:
            exported = quantise(dataclasses.replace(model, **{item.name: wrong}), "m")
        except ModelError as error:
            named = f"{item.name}[{at}] is {value:g}" if not abs(value) <= 1e6 else "["
            assert named in str(error), error
        else:
            assert abs(value) <= 1e6, item.name
            emit.source(exported)


def test_tables_hold_what_is_written() -> None:
    """Would catch a table that the exporter packs without its C type's range."""
    exported = quantise(random_model(2), "m")
    for name in ("cost", "shapes", "slopes", "kernels", "pairs", "emission_gain", "initial", "state_mean",
                 "state_motion", "motion_scale", "transitions", "state_weight", "centre", "firm", "duration_mean",
                 "floors", "contexts", "shape_scale"):  # fmt: skip
        table = getattr(exported, name).astype(np.int64)
        for value in (-(2**63), 70000, -40000):
            wrong = table.copy()
            wrong.flat[-1] = value
            with pytest.raises(ModelError, match="cannot be written: .*not a whole number within"):
                emit.source(dataclasses.replace(exported, **{name: wrong}))
    check_fits("t", "b", np.array([-128, 127]))
    check_fits("t", "H", np.array([0, 65535]))
    for code, value in (("b", 128), ("b", -129), ("B", 256), ("B", -1), ("h", 32768), ("H", 65536), ("H", 0.5)):
        with pytest.raises(ModelError, match="row 1"):
            check_fits("t", code, np.array([0, value]))


@pytest.mark.parametrize("text", ["*/ int x; /*", "/**/", "a\nb\0c\r*\t/", "\u202e*/", "*" * 200 + "/", "/" * 200 + "*",
                                  "/*/*/*/", "??/"])  # fmt: skip
def test_attributions_stay_within_their_comment(text: str) -> None:
    """Would catch a comment that ends, or begins again, within what a model says of itself."""
    exported = dataclasses.replace(quantise(random_model(2), "m"), attribution=text)
    for written in (emit.header(exported), emit.source(exported), emit.names_source(exported)):
        inside = written[2 : written.index("*/")]
        assert "/*" not in inside and written.startswith("/*\n") and written[written.index("*/") :].startswith("*/\n#")
        assert all(c.isprintable() or c == "\n" for c in written)
