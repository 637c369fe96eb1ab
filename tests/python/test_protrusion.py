"""FAP 17 as a function of the corners: its table in floating point, in integers, in files; what it is fitted to."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Iterator

import numpy as np
import pytest

from labial.errors import ModelError
from labial.evaluate.check import device_frames
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.reference.protrusion import CORNERS, complete, in_integers, interpolated
from labial.reference.published import synthesise as published
from labial.reference.stream import in_parts, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.tables.layout import blob, table_bytes
from labial.tables.model import Model, load, save
from labial.tables.protrusion import VALUES, integer_range, solved
from labial.tables.quantise import quantise
from labial.train import protrusion
from labial.train.expression import AMPLITUDE
from labial.train.protrusion import table, with_protrusion
from labial.train.recordings import Recording
from labial.train.workers import Workers
from models import random_model, streams
from runtime import needs_runtime

FAP_17 = FAP_NUMBERS.index(17)
ENDS = np.array([-60.0, 40.0])


def computing(model: Model) -> Model:
    """The model with FAP 17 computed of its corners."""
    return replace(model, protrusion=np.linspace(200.0, -30.0, VALUES) + 20.0 * np.cos(np.arange(VALUES)),
                   protrusion_range=ENDS)


def test_integers_by_hand() -> None:
    """Intervals of 10 FAP units from -80 on, each 20 higher: would catch a range or a share that is off."""
    low, gain = integer_range(np.array([-80.0, 80.0]))
    values = np.arange(VALUES) * 20 * 16
    corners = 16 * np.array([[-500, -500], [-80, -80], [-70, -80], [0, 0], [-100, 105], [80, 80], [2000, 2000]])
    found = in_integers(corners, low, gain, values) / 16
    np.testing.assert_allclose(found, [0, 0, 10, 160, 165, 320, 320], atol=0.15)
    np.testing.assert_allclose(interpolated(corners / 16, np.array([-80.0, 80.0]), values / 16), found, atol=0.15)


def test_frames_have_their_order() -> None:
    """Would catch FAP 60, which stands in the place of FAP 17, left there, and corners taken from elsewhere."""
    motion = np.arange(24.0).reshape(2, 12)
    frames = complete(motion, lambda corners: corners.sum(axis=1))
    assert frames.shape == (2, CHANNELS)
    assert frames[0].tolist() == [0, 1, 5 + 6, 3, 4, 5, 6, 7, 8, 9, 10, 11, 2]
    assert solved(True).tolist() == [0, 1, 12, 3, 4, 5, 6, 7, 8, 9, 10, 11] and solved(False).tolist() == [*range(13)]


@needs_runtime
def test_library_follows_the_reference() -> None:
    """A model that computes FAP 17 has the motion of the one that does not in every channel that keeps its turn; FAP 17
    is the table's, of the frame's own corners."""
    seed = 2
    model = random_model(seed)
    exported = quantise(computing(model), "tested_model")
    tables, asked = ExportedTables(exported), list(streams(len(model.phonemes), model.boundary, seed).values())
    plain = ExportedTables(quantise(model, "tested_model"))
    kept = [k for k in range(CHANNELS) if k not in (FAP_17, CHANNELS - 1)]
    for stream, found in zip(asked, device_frames(exported, asked)):
        expected = synthesise(tables, stream)
        assert np.abs(found - np.floor(expected + 0.5)).max(initial=0) <= 1
        np.testing.assert_array_equal(expected[:, kept], synthesise(plain, stream)[:, kept])
        told = interpolated(expected[:, CORNERS], exported_ends(exported.protrusion), exported.protrusion[2:] / 16)
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
    """Models without it are written as they always were."""
    model = random_model(1)
    save(model, tmp_path / "plain.npz")
    assert not [name for name in zipfile.ZipFile(tmp_path / "plain.npz").namelist() if "protrusion" in name]
    assert len(load(tmp_path / "plain.npz").protrusion) == 0
    save(computing(model), tmp_path / "own.npz")
    found = load(tmp_path / "own.npz")
    np.testing.assert_array_equal(found.protrusion, computing(model).protrusion)
    np.testing.assert_array_equal(found.protrusion_range, ENDS)


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


def test_tables_are_a_channel_less() -> None:
    model = random_model(1)
    plain, own = quantise(model, "tested_model"), quantise(computing(model), "tested_model")
    assert own.shapes.shape[1] == own.transitions.shape[0] == own.floors.shape[1] == 12
    assert table_bytes(own)["protrusion"] == 38
    assert blob(own)[28] == blob(plain)[28] | 8
    assert len(blob(own)) < len(blob(plain)) * 12.3 / 13


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
    monkeypatch.setattr(protrusion, "motion_of", lambda task: 0.5 * task[1].frames)
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
