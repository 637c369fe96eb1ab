"""Models of ``--method paper``: every command moves them by the published method, and says where the device differs."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from labial.__main__ import main
from labial.bake.source import Source, read_track
from labial.corpus.folder import read_frames
from labial.reference import published, stream
from labial.reference.fade import delivered
from labial.reference.tables import FloatTables
from labial.rig.animation import FORMATS
from labial.see import motion
from labial.tables.model import load, save
from labial.tables.phones import read_stream
from models import random_model

LAB = "0 0.2 SIL\n0.2 0.3 P1\n0.3 0.42 P2\n0.42 0.5 P3\n0.5 0.9 P4\n0.9 1.3 P1\n1.3 1.8 SIL\n"


@pytest.fixture
def given(tmp_path: Path) -> Path:
    save(random_model(1, "paper"), tmp_path / "paper.npz")
    save(random_model(1), tmp_path / "labial.npz")
    (tmp_path / "phones.lab").write_text(LAB)
    return tmp_path


def frames_of(given: Path, name: str, module) -> np.ndarray:
    """The motion by one of the references, which differ by more than rounding."""
    model = load(given / f"{name}.npz")
    return module.synthesise(FloatTables(model), read_stream(given / "phones.lab", model))


@pytest.fixture
def wanted(given: Path) -> np.ndarray:
    frames = frames_of(given, "paper", published)
    assert np.abs(frames - frames_of(given, "paper", stream)).max() > 1
    return frames


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_has_the_published_motion(given: Path, wanted: np.ndarray, name: str) -> None:
    """Would catch a format that takes its frames from another reference."""
    out = given / "out"
    assert main(["synth", str(given / "paper.npz"), str(given / "phones.lab"), "--to", name, "-o", str(out)]) == 0
    text = io.StringIO()
    FORMATS[name].write(text, [wanted], 50, "paper", len(wanted))
    assert out.read_text() == text.getvalue()


def test_whole_utterances_and_labials_models_are_as_they_were(given: Path) -> None:
    """The published method's `--whole` is one unit; Labial's models move as the run-time does."""
    for name, option, expected in (
        ("paper", ["--whole"], published.synthesise(
            FloatTables(load(given / "paper.npz")), read_stream(given / "phones.lab", load(given / "paper.npz")),
            whole=True)),
        ("labial", [], delivered(frames_of(given, "labial", stream))),
        ("labial", ["--exact"], delivered(frames_of(given, "labial", stream), exact=True)),
    ):
        out = given / f"{name}.csv"
        assert main(["synth", str(given / f"{name}.npz"), str(given / "phones.lab"), "-o", str(out), *option]) == 0
        np.testing.assert_allclose(read_frames(out)[1], expected, atol=0.00501)


def test_page_plot_and_bake_have_the_published_motion(given: Path, wanted: np.ndarray) -> None:
    """What is looked at, and what a board plays back that does not compute, is the published method's too; on a board
    it begins and ends at rest."""
    [read] = motion.read_motions([given / "paper.npz"], given / "phones.lab")
    np.testing.assert_array_equal(read.frames, wanted)
    track = read_track(Source(str(given / "phones.lab"), str(given / "paper.npz"))).frames
    np.testing.assert_array_equal(track, delivered(wanted))


def test_check_says_what_the_device_does_differently(given: Path, capsys: pytest.CaptureFixture) -> None:
    """One sentence, and no defect where the device differs by design."""
    assert main(["check", str(given / "paper.npz"), str(given / "phones.lab"), "--predecessors", "12"]) == 0
    captured = capsys.readouterr()
    found = re.search(r"differs from the published method by ([0-9.]+) FAP units RMS, by design", captured.out)
    assert found and float(found[1]) > 1 and captured.err == ""
    assert "published method: rms" in captured.out and captured.out.count("by design") == 1
    main(["check", str(given / "labial.npz"), str(given / "phones.lab"), "--predecessors", "12"])
    assert "published" not in capsys.readouterr().out


def test_the_figure_of_check_is_measured_from_the_published_method(given: Path, wanted, capsys) -> None:
    """Held against the frames of the library's own reference on the exported tables, with the rounding of frames."""
    from labial.reference.tables import ExportedTables
    from labial.tables.quantise import quantise

    model = load(given / "paper.npz")
    device = stream.synthesise(ExportedTables(quantise(model, "m")), read_stream(given / "phones.lab", model))
    rms = float(np.sqrt(np.mean((device - wanted) ** 2)))
    main(["check", str(given / "paper.npz"), str(given / "phones.lab")])
    assert f"published method by {rms:.1f} FAP units" in capsys.readouterr().out


def test_export_says_it_too(given: Path, capsys: pytest.CaptureFixture) -> None:
    assert main(["export", str(given / "paper.npz"), "--name", "m", "-o", str(given / "out")]) == 0
    text = capsys.readouterr().out
    assert "from the published method, FAP" in text and "by design" in text and "quantisation loss" not in text


def test_bundled_models_by_name(given: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """In every command that takes a model; a file of the same name is another thing."""
    monkeypatch.chdir(given)
    (given / "hello.lab").write_text("0 0.2 SIL\n0.2 0.3 B\n0.3 0.5 AY\n0.5 0.8 SIL\n")
    (given / "laugh.lab").write_text("0 0.2 silence\n0.2 0.3 a\n0.3 0.5 silence\n")
    assert main(["synth", "speech_en", "hello.lab", "--to", "jsonl", "-o", "hello.jsonl"]) == 0
    assert len([json.loads(line) for line in (given / "hello.jsonl").read_text().splitlines()]) == 52
    assert main(["synth", "laughter_synthetic", "laugh.lab", "-o", "laugh.csv"]) == 0
    assert main(["page", "speech_en", "--phones", "hello.lab", "-o", "hello.html"]) == 0
    assert main(["bake", "hello.lab", "--model", "speech_en", "-o", "hello.h"]) == 0
    assert "speech_en" in capsys.readouterr().out or (given / "hello.h").exists()
    assert main(["export", "speech_en", "--name", "own", "-o", "own"]) == 0
    assert main(["synth", "./speech_en", "hello.lab"]) == 1
    assert "speech_en: No such file" in capsys.readouterr().err
    assert main(["page", "speech_en", "-o", "hello.html"]) == 1
    assert "speech_en: a model speaks phoneme timings: give --phones" in capsys.readouterr().err
