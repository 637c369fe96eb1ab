"""Talkers as random effects: against the regression with all of them as columns, and what follows for a model."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import List

import numpy as np
import pytest

from labial.__main__ import main
from labial.corpus import Source
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.tables.followers import solved
from labial.tables.model import load, save
from labial.train import adapted, train
from labial.train.expression import motion_of
from labial.train.kernels import Penalties, _design, fit_kernels, regression
from labial.train.recordings import Recording, recordings
from labial.train.talkers import SHARED, fit_talkers, weights_of
from packages import SOURCE
from test_kernels import CLASS, FPS, PHONEMES, choice_of, episode, tables
from test_train import OPTIONS, motion_error, symmetric
from test_train import episode as spoken

CORPORA = SOURCE / "export" / "corpora"
VARIANCE = 0.5


def material_of(talkers: str) -> List[Recording]:
    """An utterance of random motion for each letter, its talker's."""
    rng = np.random.default_rng(6)
    items = [replace(episode(rng, 25), talker=talker) for talker in talkers]
    return [replace(item, frames=rng.normal(0, 50, item.frames.shape)) for item in items]


def test_equals_the_regression_with_each_talkers_deviation_as_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    # Catches a marginal that is not that of the model, another prior for what is shared, a talker whose utterances are
    # not together, an own part that is another talker's.
    monkeypatch.setattr("labial.train.kernels.PAIR_COUNT", 9)
    material = material_of("abacab")
    choice = choice_of(material)
    asked = regression(material, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties(intercept=np.inf))
    shared, own = fit_talkers(asked, material, choice, VARIANCE)

    rows = _design(material, choice, asked.deviation, PHONEMES, asked.lag, 0, asked.pairs, asked.knots).toarray()
    talker = np.repeat([item.talker for item in material], [len(item.frames) for item in material])
    silent = np.concatenate([item.phoneme_at() for item in material]) == 0
    weight = np.where(silent, asked.penalties.silence, 1.0)
    base, prior, width = asked.base(material, choice), asked.prior(), rows.shape[1]
    columns = np.concatenate([rows, *((talker == name)[:, None] * rows for name in "abc")], axis=1)
    penalty = np.zeros((4 * width, 4 * width))
    for part, strength in enumerate([SHARED, *[SHARED / VARIANCE] * 3]):
        place = slice(part * width, (part + 1) * width)
        penalty[place, place] = strength * prior
    motion = np.concatenate([item.frames for item in material]) - base
    weighted = columns.T * weight
    solution = np.linalg.solve(weighted @ columns + penalty, weighted @ motion)
    parts = dict(zip(["", *"abc"], np.split(solution, 4)))
    assert list(own) == ["a", "b", "c"]
    for name, found in [("", shared), *own.items()]:
        wanted = asked.kernels(parts[""] + (parts[name] if name else 0.0), base)
        np.testing.assert_allclose(found.kernel, wanted.kernel, atol=1e-6)
        np.testing.assert_allclose(found.tables.shape, wanted.tables.shape, atol=1e-6)
        np.testing.assert_allclose(found.tables.slope, wanted.tables.slope, atol=1e-4)
        np.testing.assert_allclose(found.pair_shape, wanted.pair_shape, atol=1e-6)


def test_a_channel_that_one_talker_teaches_is_fitted_as_without_talkers() -> None:
    # Catches a channel that is shrunk twice for having one talker alone, and one that is learnt from those who leave
    # it out.
    material = material_of("aabb")
    left_out = np.ones(13)
    left_out[1] = 0.0
    material = [item if item.talker == "a" else replace(item, weight=np.ones(item.frames.shape) * left_out)
                for item in material]
    asked = regression(material, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties())
    shared, own = fit_talkers(asked, material, choice_of(material), VARIANCE)
    alone = fit_kernels(asked, material[:2], choice_of(material[:2]))
    np.testing.assert_allclose(shared.kernel[..., 1], alone.kernel[..., 1], atol=1e-8)
    np.testing.assert_allclose(own["b"].kernel[..., 1], alone.kernel[..., 1], atol=1e-8)
    assert np.abs(shared.kernel[..., 2] - alone.kernel[..., 2]).max() > 0.1


def test_much_of_one_talker_says_no_more_than_one_person_can() -> None:
    # Catches a talker who counts by his frames: here one speaks ten times as much as each of three others, who all
    # stray the other way.
    rng = np.random.default_rng(2)
    items = [replace(episode(rng, 30), talker=name) for name in "a" * 30 + "bcd" * 3]
    sign = {talker: 1.0 if talker == "a" else -1.0 for talker in "abcd"}
    items = [replace(item, frames=np.outer(100.0 * sign[item.talker] * (item.phoneme_at() == 1), np.ones(13)))
             for item in items]
    asked = regression(items, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties())
    shared, own = fit_talkers(asked, items, choice_of(items), 1.0)
    pooled = fit_kernels(asked, items, choice_of(items))

    def at_its_middle(found) -> float:
        return float((found.tables.shape[1] + found.kernel[1][list(found.lag).index(0)])[0])

    assert at_its_middle(pooled) > 20.0 > at_its_middle(shared) and at_its_middle(own["a"]) > 50.0
    assert at_its_middle(own["b"]) < -15.0


def test_a_talker_who_counts_twice_is_two_talkers_alike() -> None:
    # Catches a weight that is lost, that reaches a talker's own part, or weighs the prior.
    material = material_of("abc")
    twins = [*material, *(replace(item, talker=item.talker.upper()) for item in material)]
    asked = regression(twins, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties())
    wanted, own = fit_talkers(asked, twins, choice_of(twins), VARIANCE)
    heavy = [replace(item, weight=np.full(item.frames.shape, 2.0)) for item in material]
    assert weights_of([*heavy, replace(material[0], talker="d")]) == {"a": 2.0, "b": 2.0, "c": 2.0, "d": 1.0}
    found, parts = fit_talkers(asked, material, choice_of(material), VARIANCE, weights_of(heavy))
    np.testing.assert_allclose(found.kernel, wanted.kernel, atol=1e-6)
    np.testing.assert_allclose(parts["a"].kernel, own["a"].kernel, atol=1e-6)
    alike, _ = fit_talkers(asked, material, choice_of(material), VARIANCE)
    assert np.abs(alike.kernel - wanted.kernel).max() > 0.1


def two_talkers(talkers: str = "xy") -> list:
    """Episodes of test_train's talker, and of others whose motion is partly turned over, so that each has his own."""
    result = []
    for number, talker in enumerate(talkers):
        sign = np.random.default_rng(number).choice([1.0, -1.0], 13, p=[0.6, 0.4]) if number else np.ones(13)
        result += [symmetric(replace(item, frames=item.frames * sign, source=Source(talker=talker, recording=talker)))
                   for item in map(spoken, range(100 * number, 100 * number + 6))]
    return result


@pytest.fixture(scope="module")
def shared():
    return train(two_talkers(), method="labial", jobs=1, talker_variance=1.0, **OPTIONS)


@pytest.mark.slow
def test_a_model_is_adapted_to_a_talker(shared, tmp_path) -> None:
    # Catches a deviation of the wrong sign, scale or place, and pairs in another order than the file's.
    own = [item for item in two_talkers("xyz") if item.source.talker == "z"]
    mine = adapted(shared, own[:4], "z's face")
    before, after = (np.mean([motion_error(model, item) for item in own[4:]]) for model in (shared, mine))
    assert after < 0.8 * before
    assert mine.attribution == "synthetic z's face" and mine.training["adapted"]["episodes"] == 4
    order = np.random.default_rng(0).permutation(len(shared.pair_key))
    mixed = adapted(replace(shared, pair_key=shared.pair_key[order], pair_shape=shared.pair_shape[order]), own[:4])
    np.testing.assert_allclose(mixed.pair_shape, mine.pair_shape[order], atol=1e-9)
    np.testing.assert_allclose(mixed.kernel, mine.kernel, atol=1e-9)
    save(mine, tmp_path / "mine.npz")
    kept, before = load(tmp_path / "mine.npz").training["talkers"], shared.training["talkers"]
    assert all(kept[name] == before[name] for name in ("variance", "deviation", "middle"))
    again = adapted(mine, own[:4])  # what was learnt of him once is not learnt twice
    assert motion_error(again, own[4]) < 1.1 * motion_error(mine, own[4])


def test_an_adapted_model_moves_as_far_as_its_talker(shared, monkeypatch: pytest.MonkeyPatch) -> None:
    # Catches the scale of the talkers who taught the shared model, and one that a second widening multiplies.
    monkeypatch.setattr("labial.train.adapt.HALF", 0.0)  # or seconds of him would count for little
    own = [item for item in two_talkers() if item.source.talker == "y"]
    channels = solved(shared.source)
    for scale in (0.5, 1.5):
        scaled = [replace(item, frames=item.frames * scale) for item in own]
        model = adapted(shared, scaled[:4])
        (human,) = recordings(scaled[5:], SPEECH, FPS)
        reached = motion_of((model, human))[:, channels].std(axis=0) / human.frames[:, channels].std(axis=0)
        assert 0.8 < np.median(reached) < 1.25 and 0.6 < reached.min() and reached.max() < 1.7


def test_what_cannot_be_adapted_is_refused(shared) -> None:
    own = two_talkers("x")
    with pytest.raises(LabialError, match="one talker, but there are x, y"):
        adapted(shared, two_talkers())
    with pytest.raises(LabialError, match="not trained with --talker-variance"):
        adapted(replace(shared, training={}), own)
    for name, value in (("gain", [1.0]), ("gain", [0.0] * 13), ("middle", None), ("variance", 1e9), ("deviation", "x")):
        with pytest.raises(LabialError, match="damaged"):
            adapted(replace(shared, training={"talkers": {**shared.training["talkers"], name: value}}), own)
    for variance in (0.0, -1.0, 1e4):
        with pytest.raises(LabialError, match="talker variance"):
            train(own, method="labial", jobs=1, talker_variance=variance, **OPTIONS)


@pytest.mark.slow
def test_the_command_adapts(shared, tmp_path, capsys) -> None:
    model, out = tmp_path / "shared.npz", tmp_path / "mine.npz"
    save(shared, model)
    folder = CORPORA / "addresses"
    assert main(["train", str(folder), "--adapt", str(model), "-o", str(out), "--quiet"]) == 1
    assert "there are a, b" in capsys.readouterr().err
    assert not out.exists()
    mine = write(tmp_path / "corpus", folder)
    assert main(["train", str(mine), "--adapt", str(model), "-o", str(out), "--quiet"]) == 0
    assert "adapted to 2 episodes, 6 s" in capsys.readouterr().out
    assert np.abs(load(out).kernel - shared.kernel).max() > 1.0


def write(folder: Path, source: Path) -> Path:
    """A corpus of two of the addresses."""
    with zipfile.ZipFile(source / "episodes.zip") as packed:
        packed.extractall(folder, [f"talker_b_farewell_{name}" for name in ("01.csv", "01.lab", "03.csv", "03.lab")])
    return folder
