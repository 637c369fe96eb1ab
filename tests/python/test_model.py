"""The model file: what is written is read back, and nothing else is accepted."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from labial.errors import ModelError
from labial.tables.model import load, save
from models import archive, members_of, random_model


def test_round_trip_and_same_bytes(tmp_path: Path) -> None:
    """A lost field, or a time stamp in the archive, shows."""
    model = random_model(1)
    save(model, tmp_path / "a.npz")
    save(load(tmp_path / "a.npz"), tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    again = load(tmp_path / "b.npz")
    for item in dataclasses.fields(model):
        assert np.array_equal(getattr(model, item.name), getattr(again, item.name)), item.name


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("shape", np.nan),
        ("kernel", np.inf),
        ("duration_variance", 0.0),
        ("state_precision", -1.0),
        ("state_anchor", -1e-9),
        ("log_transition", 0.5),
        ("viseme_class", 99),
        ("component_count", 0),
    ],
)
def test_refuses_values_out_of_range(field: str, value: float) -> None:
    """Each would otherwise come out as tables that mean nothing."""
    model = random_model(2)
    array = getattr(model, field).copy()
    array.flat[0] = value
    with pytest.raises(ModelError):
        dataclasses.replace(model, **{field: array})


def test_refuses_a_state_that_cannot_be_reached() -> None:
    """The library's Viterbi search relies on a predecessor for every state."""
    model = random_model(2)
    transition = model.log_transition.copy()
    transition[3, :, 5] = -np.inf
    with pytest.raises(ModelError, match="predecessor"):
        dataclasses.replace(model, log_transition=transition)


def test_names_the_file_that_is_no_model(tmp_path: Path) -> None:
    """Missing, truncated and foreign files end in a message with their name, not in a traceback."""
    path = tmp_path / "model.npz"
    with pytest.raises(ModelError, match="model.npz: No such file"):
        load(path)
    save(random_model(1), path)
    data, members = path.read_bytes(), members_of(path)
    lacking = archive({name: content for name, content in members.items() if name != "kernel.npy"})
    for damaged in (b"", b"junk", data[: len(data) // 2], lacking, archive({**members, "model.json": b"{}"})):
        path.write_bytes(damaged)
        with pytest.raises(ModelError, match="model.npz"):
            load(path)


def test_says_that_a_model_is_of_another_format(tmp_path: Path) -> None:
    """Whoever has a file of another version is told so, and not that an array is missing in it."""
    path = tmp_path / "model.npz"
    save(random_model(1), path)
    members = {**members_of(path), "model.json": b'{"format": 6}'}
    del members["emission_mean.npy"]
    path.write_bytes(archive(members))
    with pytest.raises(ModelError, match="format 6, but this version of labial reads formats 3 to 5"):
        load(path)


def test_a_model_of_format_3_is_read(tmp_path: Path) -> None:
    """Three arrays had other names; a model that somebody trained then is the same model."""
    path, former = tmp_path / "model.npz", tmp_path / "former.npz"
    model = random_model(1)
    save(model, path)
    names = {"viseme_class": "phoneme_class", "emission_mean": "decode_mean", "emission_variance": "decode_variance"}
    members = {name[: -len(".npy")]: content for name, content in members_of(path).items() if name.endswith(".npy")}
    former.write_bytes(archive({
        "model.json": members_of(path)["model.json"].replace(b'"format": 5', b'"format": 3'),
        **{f"{names.get(name, name)}.npy": content for name, content in members.items()}}))
    save(load(former), former)
    assert former.read_bytes() == path.read_bytes()
