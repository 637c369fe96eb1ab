"""The figure that draws several models' motion for one stream of phonemes."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from labial.evaluate import side_by_side
from labial.evaluate.trajectories import labial_parameters
from labial.reference import published, stream
from labial.reference.tables import FloatTables
from labial.reference.units import frame_counts
from labial.tables.model import save
from models import random_model

TIMINGS = "0.000 0.200 SIL\n0.200 0.300 P1\n0.300 0.400 P2\n0.400 0.520 P1\n0.520 0.900 P4\n"


@pytest.fixture
def files(tmp_path) -> Path:
    classes = ("silence", "bilabial", "class 2", "class 3")  # P1 and P5 close the lips
    for name, method in (("old", "paper"), ("new", "labial")):
        model = replace(random_model(1, method), classes=classes)
        if method == "labial":
            floor = model.floor.copy()
            floor[1] = floor[5] = np.arange(13.0)
            model = replace(model, floor=floor)
        save(model, tmp_path / f"{name}.npz")
    save(replace(random_model(1), fps=25), tmp_path / "slow.npz")
    (tmp_path / "timings.lab").write_text(TIMINGS)
    return tmp_path


def run(files: Path, output: str, *models: str) -> int:
    return side_by_side.main([str(files / "timings.lab"), "-o", str(files / output),
                              *(f"{name}={files / name}.npz" for name in models)])  # fmt: skip


def test_the_same_figure_every_time_with_all_models_and_phonemes(files, capsys) -> None:
    # Catches dates and random names in the file, a model or a phoneme that is left out.
    assert run(files, "one.svg", "old", "new") == 0 and run(files, "two.svg", "old", "new") == 0
    text = (files / "one.svg").read_text(encoding="utf-8")
    assert text == (files / "two.svg").read_text(encoding="utf-8")
    written = re.findall(r">([^<>]+)</text>", text)
    assert {"old", "new", "SIL", "P2", "P4"} <= set(written) and written.count("P1") == 2
    assert "firm contact: -7" in capsys.readouterr().out  # FAP 51 and 52 are channels 3 and 4
    assert run(files, "one.png", "new") == 0 and (files / "one.png").read_bytes()[:4] == b"\x89PNG"


def test_the_least_distance_is_that_of_the_closures_own_frames(files) -> None:
    models = {name: side_by_side.load(files / f"{name}.npz") for name in ("old", "new")}
    drawn = side_by_side.synthesise_all(files / "timings.lab", models)
    assert [item.label for item in drawn.closing] == ["P1", "P1"]
    begin = sum(frame_counts([200], 50))
    assert drawn.motion["new"].shape == (45, 4)
    first, second = side_by_side.least(drawn, "new")
    assert first == drawn.motion["new"][begin : begin + 5, 0].min()
    assert second == drawn.motion["new"][20:26, 0].min()


def test_each_method_moves_in_its_own_way(files) -> None:
    """The published method unit by unit, to the letter; Labial as the run-time does."""
    models = {name: side_by_side.load(files / f"{name}.npz") for name in ("old", "new")}
    drawn = side_by_side.synthesise_all(files / "timings.lab", models)
    given = [(0, 200), (1, 100), (2, 100), (1, 120), (4, 380)]
    for name, synthesise in (("old", published.synthesise), ("new", stream.synthesise)):
        motion = synthesise(FloatTables(models[name]), given)
        np.testing.assert_array_equal(drawn.motion[name], labial_parameters(motion))
    other = labial_parameters(stream.synthesise(FloatTables(models["old"]), given))
    assert np.abs(drawn.motion["old"] - other).max() > 1


def test_models_that_cannot_be_compared_are_told(files, capsys) -> None:
    assert run(files, "x.svg", "new", "slow") == 1
    assert "slow: its phonemes or its frame rate" in capsys.readouterr().err
    for wrong in (["new.npz"], ["a=x.npz", "a=y.npz"], ["=x.npz"]):
        assert side_by_side.main([str(files / "timings.lab"), "-o", str(files / "x.svg"), *wrong]) == 1
        assert "NAME=MODEL.npz" in capsys.readouterr().err
    assert not (files / "x.svg").exists()
