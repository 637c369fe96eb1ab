"""Channels that follow others: sides that mirror each other, and FAP 17 as a function of the corners: its table in
floating point, in integers, in files; what it is fitted to."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Callable, Iterator

import numpy as np
import pytest

from labial.corpus.episode import Episode, Segment, Source, with_even_sides
from labial.errors import ModelError
from labial.evaluate.check import device_frames
from labial.files.faps import CHANNELS, SIDES
from labial.reference.fade import delivered
from labial.reference.published import synthesise as published
from labial.reference.stream import in_parts, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.tables.followers import (
    CORNERS,
    FAP_17,
    FROM_CORNERS,
    VALUES,
    every,
    interpolated,
    is_symmetric,
    mirrored,
)
from labial.tables.layout import blob, sources, table_bytes
from labial.tables.model import Model, load, save
from labial.tables.quantise import quantise
from labial.train import expression
from labial.train.expression import AMPLITUDE, table, with_protrusion
from labial.train.recordings import Recording
from labial.train.workers import Workers
from models import random_model, streams
from packages import needs_runtime

ENDS = np.array([-60.0, 40.0])


def computing(model: Model) -> Model:
    """The model with FAP 17 computed of its corners."""
    return replace(model, protrusion=np.linspace(200.0, -30.0, VALUES) + 20.0 * np.cos(np.arange(VALUES)),
                   protrusion_range=ENDS, source=np.where(every() == FAP_17, FROM_CORNERS, model.source))


def symmetric(model: Model) -> Model:
    """The model with its right side after its left one."""
    return replace(model, source=mirrored())


@needs_runtime
def test_library_follows_the_reference() -> None:
    """Of models that solve all, twelve, nine and eight channels: would catch targets, floors or turns of another.
    What follows moves as its source does, and FAP 17 as the table says of the frame's own corners."""
    seed = 2
    model = random_model(seed)
    asked = list(streams(len(model.phonemes), model.boundary, seed).values())
    for own in (model, computing(model), symmetric(model), computing(symmetric(model))):
        exported = quantise(own, "tested_model")
        tables = ExportedTables(exported)
        for stream, found in zip(asked, device_frames(exported, asked)):
            expected = synthesise(tables, stream)
            assert np.abs(found - np.floor(delivered(expected, exact=True) + 0.5)).max(initial=0) <= 1
            for left, right in SIDES:
                assert (found[:, left] == found[:, right]).all() == is_symmetric(own.source)
            if exported.protrusion is not None:
                ends = exported_ends(exported.protrusion)
                told = interpolated(expected[:, CORNERS], ends, exported.protrusion[2:] / 16)
                np.testing.assert_allclose(expected[:, FAP_17], told, atol=0.3)


def exported_ends(row: np.ndarray) -> np.ndarray:
    return np.array([row[0], row[0] + 2**23 / row[1]]) / 16


def test_parts_are_the_whole() -> None:
    model = computing(random_model(2))
    stream = max(streams(len(model.phonemes), model.boundary, 2).values(), key=len)
    for tables in (FloatTables(model), ExportedTables(quantise(model, "tested_model"))):
        np.testing.assert_array_equal(np.concatenate(list(in_parts(tables, stream, 40))), synthesise(tables, stream))
    whole = published(FloatTables(model), stream, whole=True)
    np.testing.assert_allclose(whole[:, FAP_17], interpolated(whole[:, CORNERS], ENDS, model.protrusion))


def test_files_hold_the_table(tmp_path: Path) -> None:
    """And the sources, which files of earlier versions do not have."""
    model = random_model(1)
    save(model, tmp_path / "plain.npz")
    assert not [name for name in zipfile.ZipFile(tmp_path / "plain.npz").namelist() if "protrusion" in name]
    assert len(load(tmp_path / "plain.npz").protrusion) == 0
    save(computing(model), tmp_path / "own.npz")
    found = load(tmp_path / "own.npz")
    np.testing.assert_array_equal(found.protrusion, computing(model).protrusion)
    np.testing.assert_array_equal(found.protrusion_range, ENDS)
    np.testing.assert_array_equal(found.source, computing(model).source)


@pytest.mark.parametrize("changed", [computing, lambda model: model])
def test_files_of_earlier_versions_are_read(tmp_path: Path, changed: Callable[[Model], Model]) -> None:
    """They solve every channel that they have no table for. Would catch a table that is there and not used."""
    model = changed(random_model(1))
    save(model, tmp_path / "now.npz")
    with zipfile.ZipFile(tmp_path / "now.npz") as now, zipfile.ZipFile(tmp_path / "then.npz", "w") as then:
        for name in now.namelist():
            if name != "source.npy":
                then.writestr(name, now.read(name).replace(b'"format": 5', b'"format": 4'))
    np.testing.assert_array_equal(load(tmp_path / "then.npz").source, model.source)


def test_damaged_tables_are_refused() -> None:
    model = computing(random_model(1))
    with pytest.raises(ModelError, match="protrusion has 16 values, not 17"):
        replace(model, protrusion=model.protrusion[1:])
    with pytest.raises(ModelError, match="protrusion_range has shape"):
        replace(model, protrusion_range=np.zeros(0))
    with pytest.raises(ModelError, match="protrusion_range does not ascend"):
        replace(model, protrusion_range=ENDS[::-1].copy())
    with pytest.raises(ModelError, match="protrusion_range is narrower"):
        quantise(replace(model, protrusion_range=np.array([0.0, 8.0])), "tested_model")
    with pytest.raises(ModelError, match="protrusion reaches beyond"):
        quantise(replace(model, protrusion=model.protrusion + 1000.0), "tested_model")


@pytest.mark.parametrize("channel, of, message", [
    (5, FROM_CORNERS, "only FAP 17 can be computed"), (6, 8, "source.6. is 8, a channel that follows another"),
    (2, 2, "contradict each other"), (3, 13, "source.3. is 13, not within -1 .. 12"),
])
def test_impossible_sources_are_refused(channel: int, of: int, message: str) -> None:
    source = computing(symmetric(random_model(1))).source.copy()
    source[channel] = of
    with pytest.raises(ModelError, match=message):
        replace(computing(random_model(1)), source=source)


def test_tables_hold_what_is_solved() -> None:
    model = random_model(1)
    plain, own = quantise(model, "tested_model"), quantise(computing(symmetric(model)), "tested_model")
    assert own.shapes.shape[1] == own.transitions.shape[0] == own.floors.shape[1] == 8
    assert table_bytes(own)["protrusion"] == 38
    assert blob(own)[28] == blob(plain)[28] | 8
    assert blob(own)[32:48] == bytes([8, 0, 1, 255, 2, 3, 4, 4, 5, 5, 6, 6, 7, 7, 0, 0])
    assert sources(plain) == [*range(13)] and blob(plain)[32] == 13
    assert len(blob(own)) < len(blob(plain)) * 8.6 / 13


def test_even_sides() -> None:
    """Would catch a side that is left out and counts all the same, and other channels that change."""
    rng = np.random.default_rng(4)
    frames = rng.normal(size=(5, CHANNELS))
    (left, right), (one, other) = SIDES[0], SIDES[1]
    item = Episode("made up", np.arange(5.0), frames, (Segment(0.0, 5.0, "AA"),), Source(left_out=frozenset({0, one})))
    (found,) = with_even_sides([item])
    middle = [k for k in range(CHANNELS) if k not in np.ravel(SIDES)]
    np.testing.assert_array_equal(found.frames[:, middle], frames[:, middle])
    np.testing.assert_allclose(found.frames[:, left], (frames[:, left] + frames[:, right]) / 2)
    np.testing.assert_array_equal(found.frames[:, left], found.frames[:, right])
    np.testing.assert_array_equal(found.frames[:, [one, other]], frames[:, [other, other]])
    assert found.source.left_out == frozenset({0})
    (again,) = with_even_sides([found])
    np.testing.assert_array_equal(again.frames, found.frames)


def test_table_is_fitted() -> None:
    """To a curve that falls, with noise: would catch intervals that are off by one, and values that rise somewhere."""
    rng = np.random.default_rng(5)
    corners = rng.normal(0, 20, 20000)
    curve = 100.0 / (1.0 + np.exp(corners / 8.0))
    ends, values = table(corners, curve + rng.normal(0, 10, len(corners)))
    assert (np.diff(values) <= 0).all() and len(values) == VALUES
    inside = np.abs(corners) < 40
    found = interpolated(np.stack([corners, corners], axis=1), ends, values)
    assert np.sqrt(np.mean((found - curve)[inside] ** 2)) < 1.5


@pytest.fixture
def workers() -> Iterator[Workers]:
    with Workers(1, False) as found:
        yield found


def recording(rng: np.random.Generator, noise: float) -> Recording:
    frames = np.zeros((400, CHANNELS))
    frames[:, CORNERS] = rng.normal(0, 20, 400)[:, None]
    frames[:, FAP_17] = 100.0 / (1.0 + np.exp(frames[:, CORNERS[0]] / 8.0)) + rng.normal(0, noise, 400)
    return Recording(name="made up", phoneme=np.full(40, 1), duration=np.full(40, 0.2), length=np.full(40, 10),
                     apex=np.arange(40) * 10, frames=frames)


def test_model_protrudes_as_far_as_wanted(monkeypatch: pytest.MonkeyPatch, workers: Workers) -> None:
    """Of a model whose corners move half as far, FAP 17 reaches AMPLITUDE of the recordings'. What leaves FAP 17 out
    teaches nothing, and where the corners do not tell it, it stays a channel."""
    rng = np.random.default_rng(6)
    model, material = random_model(1), [recording(rng, 3.0) for _ in range(3)]
    monkeypatch.setattr(expression, "motion_of", lambda task: 0.5 * task[1].frames)
    found = with_protrusion(model, material, workers)
    made = interpolated(0.5 * np.concatenate([item.frames for item in material])[:, CORNERS], found.protrusion_range,
                        found.protrusion)
    human = np.concatenate([item.frames for item in material])[:, FAP_17]
    assert abs(made.std() / human.std() - AMPLITUDE) < 0.01 and (np.diff(found.protrusion) <= 0).all()

    left_out = np.ones(CHANNELS)
    left_out[FAP_17] = 0.0
    other = replace(recording(rng, 500.0), weight=np.broadcast_to(left_out, (400, CHANNELS)))
    again = with_protrusion(model, [*material, other], workers)
    np.testing.assert_array_equal(again.protrusion, found.protrusion)
    assert with_protrusion(model, [recording(rng, 500.0)], workers) is model
    assert with_protrusion(model, [other], workers) is model
