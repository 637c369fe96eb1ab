"""What the run-time in Python is given and gives back: timings of every kind, plain types, weights from 0 to 1."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.errors import DataError, LabialError
from labial.tables.phones import read_stream
from models import random_model
from runtime import needs_runtime

pytestmark = needs_runtime

SAMPLES = Path(__file__).with_name("services")
LAB = "0.00 0.12 sil\n0.12 0.20 m\n0.20 0.45 ay\n"


def test_timings_from_anything_that_holds_them(tmp_path: Path) -> None:
    """The same from a path, an open file, a text in memory, and JSON that a service's client has parsed."""
    path = tmp_path / "word.lab"
    path.write_text(LAB)
    expected = [("SIL", 120), ("M", 80), ("AY", 250)]
    assert labial.read_timings(path) == labial.read_timings(str(path)) == expected
    assert labial.read_timings(io.StringIO(LAB)) == labial.read_timings(io.BytesIO(LAB.encode())) == expected
    with open(path) as file:
        assert labial.read_timings(file, source="lab") == expected
    for name in ("piper.json", "piper_info.json", "kokoro.json", "azure.json", "headtts.json"):
        parsed = json.loads((SAMPLES / name).read_text(encoding="utf-8"))
        assert labial.read_timings(parsed) == labial.read_timings(SAMPLES / name)
    for given in (3, None, object()):
        with pytest.raises(TypeError, match="timings are a path, a file, a list or a dict"):
            labial.read_timings(given)  # type: ignore[arg-type]
    with pytest.raises(DataError, match="^timings:2: "):
        labial.read_timings(io.StringIO("0 1 sil\n1 x m\n"))


def chunks(name: str) -> list:
    """A sample of Piper's as its own objects, whose numbers are NumPy's."""
    return [SimpleNamespace(sample_rate=chunk["sample_rate"], audio_float_array=np.zeros(3), phoneme_alignments=[
        SimpleNamespace(phoneme=item["phoneme"], num_samples=np.int64(item["num_samples"]))
        for item in chunk["phoneme_alignments"]]) for chunk in json.loads((SAMPLES / name).read_text("utf-8"))]


def test_pipers_chunks_as_they_are() -> None:
    found = labial.read_timings(chunks("piper.json"), source="piper")
    assert found == labial.read_timings(SAMPLES / "piper.json") and len(labial.render(found)) > 50


def test_piper_without_alignments_says_what_to_do() -> None:
    """Whoever asked for them already is not told to ask for them alone."""
    silent = SimpleNamespace(sample_rate=22050, phoneme_alignments=None)
    with pytest.raises(DataError, match="piper.patch_voice_with_alignment VOICE.onnx adds them"):
        labial.read_timings([silent], source="piper")


@pytest.mark.parametrize("label", ["^", "$", "_", ",", ".", "...", " "])
def test_punctuation_is_silence(label: str) -> None:
    """Piper's characters, given as they come."""
    assert labial.render([("m", 80), (label, 200), ("m", 80)]) == labial.render([("m", 80), ("SIL", 200), ("m", 80)])
    with pytest.raises(LabialError, match="no phoneme of this name"):
        labial.render([("QQ", 80)])
    with pytest.raises(LabialError, match="no phoneme of this name"):
        labial.render([("", 80)])


def test_the_type_is_the_same_without_numpy() -> None:
    script = "import labial, sys\nsys.modules['numpy'] = None\nprint(labial.render([('AA', 100)]))\n"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    motion = labial.render([("AA", 100)])
    assert done.stdout == f"{motion}\n" and type(motion) is list and type(motion[0]) is tuple
    assert np.array(motion, "int16").shape == (5, 13)


def test_weights_are_from_0_to_1() -> None:
    """As in the page, in JSON and in the npm package."""
    face, open_wide = labial.Rig("arkit"), [700, 0, 0, -300, -500] + [0] * 8
    values = face.apply(open_wide)
    assert face.unit == "weight" and values == face.values == labial.Frame(0, tuple(open_wide)).rig("arkit")
    assert 0.3 < values["jawOpen"] <= 1 and all(type(value) is float for value in values.values())
    from labial.rig.animation import arkit

    expected = arkit(np.array([open_wide], dtype=float))
    assert all(abs(values[name] - expected[name][0]) <= 0.0011 for name in expected)


@pytest.mark.parametrize("line", ["neutral = 1e308", "neutral = 1500\nmaximum = -1e300", "neutral = 0\ngain = 1e200"])
@pytest.mark.parametrize("unit", ["us", "plain", "weight", "counts", "pca9685"])
def test_absurd_numbers_of_a_rig(tmp_path: Path, capsys: pytest.CaptureFixture, line: str, unit: str) -> None:
    """One line that names the file and the key, no traceback."""
    path = tmp_path / "face.toml"
    clock = "clock = 1e6\n" if unit == "counts" else ""
    path.write_text(f'unit = "{unit}"\n{clock}[output.jaw]\nfrom = "opening"\n{line}\n'
                    + ("full = 1800\n" if "gain" not in line and "full" not in line else "minimum = 0\nmaximum = 1\n"))
    assert main(["rig", str(path), "-o", str(tmp_path / "out"), "--no-figure"]) == 1
    said = capsys.readouterr().err
    assert said.startswith(f"labial: {path}: output.jaw.") and said.count("\n") == 1


def test_long_silences_are_split(tmp_path: Path) -> None:
    """Silences and gaps of hours; another phoneme of such a length is named with its file and line."""
    path = tmp_path / "night.lab"
    path.write_text("0 1 AA\n1 9000 SIL\n20000 20001 AA\n")
    found = labial.read_timings(path)
    assert sum(ms for _, ms in found) == 20_001_000 and max(ms for _, ms in found) <= 3_600_000
    assert [label for label, _ in found] == ["AA", *["SIL"] * 7, "AA"]
    assert len(labial.render(found)) == 50 * 20_001
    path.write_text("0 1 P1\n1 9000 SIL\n20000 20001 P1\n")
    assert sum(ms for _, ms in read_stream(path, random_model(1))) == 20_001_000
    path.write_text("0 1 SIL\n1 3602 AA\n")
    with pytest.raises(DataError, match=r"night.lab:2: 'AA' lasts 3601 s, more than the 3600 s"):
        labial.read_timings(path)


def test_types_are_told_to_type_checkers() -> None:
    assert Path(labial.__file__).with_name("py.typed").is_file()
