"""The command line: each sub-command end to end, and errors as one line with status 1."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import labial.commands
from labial.__main__ import main
from labial.commands import COMMANDS
from labial.tables.model import save
from models import random_model

LAB = "0.00 0.20 SIL\n0.20 0.31 P1\n0.31 0.42 p1\n0.50 0.71 P4\n0.71 1.00 SIL\n"


#: What a process runs that has no numpy and nothing else of what the extras bring.
WITHOUT_PACKAGES = """
import sys
sys.modules.update(dict.fromkeys(("numpy", "scipy", "sklearn", "tqdm", "matplotlib", "tomli", "soundfile")))
from labial.__main__ import main
for arguments in {arguments}:
    try:
        main(arguments)
    except SystemExit as end:
        assert end.code == 0, arguments
print(*sorted(name[16:] for name in sys.modules if name.startswith("labial.commands.")))
"""


def without_packages(arguments: list) -> str:
    """Runs commands one after another; their output, and a line of the modules of commands that they loaded."""
    done = subprocess.run([sys.executable, "-c", WITHOUT_PACKAGES.format(arguments=arguments)], check=False,
                          capture_output=True, encoding="utf-8")
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_help_needs_python_alone() -> None:
    """Would catch a module that imports at its top what only the work needs, and one that is not among the commands."""
    text = without_packages([["--help"], ["--version"], *([name, "--help"] for name in COMMANDS)])
    assert all(f"usage: labial {name} " in text for name in COMMANDS)
    modules = {path.stem for path in Path(labial.commands.__file__).parent.glob("*.py")} - {"__init__", "common"}
    assert modules == {name.replace("-", "_") for name in COMMANDS}


def test_one_command_is_loaded() -> None:
    """Would catch a start that takes longer with each command that there is."""
    assert without_packages([["--help"]]).splitlines()[-1] == ""
    assert without_packages([["timings", "--help"]]).splitlines()[-1] == "common timings"


@pytest.fixture
def given(tmp_path: Path) -> Path:
    save(random_model(1), tmp_path / "model.npz")
    (tmp_path / "phones.lab").write_text(LAB)
    return tmp_path


def test_synth_articulates(given: Path, capsys: pytest.CaptureFixture) -> None:
    """Half of each frame, and nothing of what is out of range."""
    frames = []
    for percent in ("100", "50"):
        assert main(["synth", str(given / "model.npz"), str(given / "phones.lab"), "-o", str(given / "a.csv"),
                     "--whole", "--articulation", percent]) == 0
        frames.append(np.loadtxt(given / "a.csv", delimiter=",", skiprows=1)[:, 1:])
    assert np.ptp(frames[0]) > 100 and np.abs(0.5 * frames[0] - frames[1]).max() <= 1
    with pytest.raises(SystemExit):
        main(["synth", "speech_en", str(given / "phones.lab"), "--articulation", "201"])
    assert "'201' is not a whole number within 0 .. 200" in capsys.readouterr().err


def test_export_prints_memory_and_loss(given: Path, capsys: pytest.CaptureFixture) -> None:
    """The files are there and the tables name what was measured."""
    assert main(["export", str(given / "model.npz"), "--name", "my_model", "-o", str(given / "out"), "--blob"]) == 0
    text = capsys.readouterr().out
    assert {path.name for path in (given / "out").iterdir()} == {
        "my_model.c", "my_model.h", "my_model_names.c", "my_model.lbm"}  # fmt: skip
    assert "flash, model" in text and "RAM, workspace" in text and "open_jaw" in text and "nats per" in text


def test_check_compares_with_both_references(given: Path, capsys: pytest.CaptureFixture) -> None:
    """The made-up model's paths flip at near ties, so the verdict is open; the comparison on the same tables is not."""
    status = main(["check", str(given / "model.npz"), str(given / "phones.lab"), "--predecessors", "12"])
    captured = capsys.readouterr()
    assert "50 frames" in captured.out and "open_jaw" in captured.out
    assert "same tables" not in captured.err
    assert status == (1 if captured.err else 0)


def test_options_of_one_method_are_not_silently_ignored(
    given: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An option that has no effect with the method is told so; others are passed on without a word."""
    asked = []
    monkeypatch.setattr("labial.train.train", lambda corpus, **options: asked.append(options) or random_model(3))
    monkeypatch.setattr("labial.train.backed_off", lambda model: [])
    monkeypatch.setattr("labial.corpus.corpora.read_corpus", lambda path, kind: [])
    for method, options, warned in (
        ("paper", [], False), ("labial", ["--look-ahead", "60", "--search-stride", "1"], False),
        ("paper", ["--search-stride", "1"], True), ("paper", ["--look-ahead", "60"], True),
        ("labial", ["--talker-variance", "0.5"], False), ("paper", ["--talker-variance", "0.5"], True),
        ("paper", ["--normalise"], False), ("labial", ["--normalise"], True),
    ):
        assert main(["train", "corpus", "-o", str(given / "m.npz"), "--method", method, *options]) == 0
        err = capsys.readouterr().err
        assert (f"--method {method}" in err) == warned and all(name in err for name in options[::2] if warned)
    assert asked[1]["look_ahead"] == 0.06 and asked[1]["search_stride"] == 1
    assert not {"look_ahead", "search_stride", "talker_variance"} & set(asked[0])
    assert asked[4]["talker_variance"] == 0.5
    assert [options["normalise"] for options in asked[-2:]] == [True, True] and not asked[0]["normalise"]


@pytest.mark.slow
def test_amplitude_widens_what_is_exported(given: Path) -> None:
    """Calmed to nothing the target stands still, so that kernels and slopes vanish from the tables."""
    for factor, moves in (("1", True), ("0", False)):
        out = given / f"out{factor}"
        assert main(["export", str(given / "model.npz"), "--name", "m", "-o", str(out), "--amplitude", factor]) == 0
        text = (out / "m.c").read_text()
        kernels = text[text.index(" kernels[") :]
        words = kernels[kernels.index("{") + 1 : kernels.index("}")].replace(",", " ").split()
        assert any(word != "0x80808080u" for word in words) == moves  # four channels, 128 more than each
    assert main(["export", str(given / "model.npz"), "--name", "m", "-o", str(given), "--amplitude", "-1"]) == 1
