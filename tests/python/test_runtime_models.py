"""Models from files and rigs in the Python run-time."""

from __future__ import annotations

import gc
from dataclasses import replace
from pathlib import Path
from typing import Any, List, Tuple

import pytest

import labial
from labial.errors import DataError, LabialError, ModelError, StreamError
from labial.tables.emit import blob
from labial.tables.model import load
from labial.tables.quantise import ExportedModel, quantise
from packages import SOURCE
from runtime import needs_runtime

pytestmark = needs_runtime

WORD: List[Tuple[Any, float]] = [("M", 70), ("AY", 160), ("B", 60), ("EY", 110), ("SIL", 100)]


@pytest.fixture(scope="module")
def exported() -> ExportedModel:
    return quantise(load(str(SOURCE / "export" / "models" / "speech_en.npz")), "speech_en")


@pytest.fixture(scope="module")
def voice(exported: ExportedModel, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bundled speech model as a file."""
    path = tmp_path_factory.mktemp("voice") / "voice.lbm"
    path.write_bytes(blob(exported))
    return path


# ---- Models


def test_own_model_is_read_and_lives_with_its_stream(voice: Path) -> None:
    """The same frames as compiled in; the file's bytes stay for as long as the stream, not only as the Model."""
    wanted = labial.render(WORD * 20)
    stream = labial.Stream(labial.Model(voice))
    gc.collect()
    trash = [bytearray(70000) for _ in range(50)]  # would lie where the model lay
    for timing in WORD * 20:
        stream.push(*timing)
    stream.end()
    assert [frame.faps for frame in stream] == wanted and trash
    model = labial.Model(str(voice))
    assert (model.fps, model.silence, len(model.phonemes), model.name) == (50, 0, 40, str(voice))
    assert model.phonemes == labial.speech_en.phonemes and not model.is_laughter
    assert labial.laughter_synthetic.is_laughter and labial.laughter_synthetic.phonemes[0] == "silence"


def test_damaged_models_are_refused(voice: Path, tmp_path: Path) -> None:
    """Every cut and a flip in every part; the file is named, nothing is overrun."""
    good = voice.read_bytes()
    path = tmp_path / "bad.lbm"
    bad = [good[:size] for size in (0, 3, 31, 32, 1000, len(good) - 1)] + [good + b"\0", b"RIFF" + good[4:]]
    bad += [good[:at] + bytes([good[at] ^ 1]) + good[at + 1:] for at in range(4, len(good), 1499)]
    for content in bad:
        path.write_bytes(content)
        with pytest.raises(ModelError, match="bad.lbm: the model"):
            labial.Model(path)
    with pytest.raises(FileNotFoundError):
        labial.Model(tmp_path / "missing.lbm")
    for other in (None, 3, b"x", ""):
        with pytest.raises(TypeError):
            labial.Model(other)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a model is a labial.Model, not str"):
        labial.Stream("speech_en")  # type: ignore[arg-type]


def test_models_of_one_stream_have_one_rate(exported: ExportedModel, tmp_path: Path) -> None:
    path = tmp_path / "slow.lbm"
    path.write_bytes(blob(replace(exported, fps=25)))
    slow = labial.Model(path)
    with labial.Stream() as stream:
        with pytest.raises(StreamError, match="the model's frame rate or search stride is not the stream's") as raised:
            stream.use(slow)
        assert raised.value.result == -9
        stream.push("AA", 40)  # as before
    with labial.Stream(slow) as stream:
        with pytest.raises(StreamError, match="frame rate"):
            stream.laugh(1)
        stream.push("AA", 400)
        stream.end()
        assert len(list(stream)) == 10 and stream.fps == 25


def test_models_may_change_at_every_phoneme(voice: Path) -> None:
    """More models at a time than a stream in C holds by default: none is refused."""
    models = [labial.Model(voice) for _ in range(20)]
    with labial.Stream() as stream:
        for number in range(300):
            stream.use(models[number % 20])
            stream.push("AA" if number % 2 else "M", 20)
        stream.end()
        assert len(list(stream)) == 300


# ---- Rigs


def test_rig_moves_as_its_description_says(tmp_path: Path) -> None:
    """Against the description's own arithmetic: opening, direction, limits, and the most that a frame may change."""
    path = tmp_path / "face.toml"
    path.write_text('[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 2000\nslew = 50\n'
                    '[output.lip]\nfrom = "fap51"\nneutral = 1500\ngain = 2\nminimum = 1400\nmaximum = 1550\n'
                    "invert = true\n")
    face = labial.Rig(path)
    assert face.values == {"jaw": 1400, "lip": 1500} and (face.name, face.unit, face.prescale) == ("face", "us", None)
    jaw = 1400
    for opening, raised in ((600, 0), (600, 10), (600, -100), (0, 100), (300, 0), (300, 0)):
        faps = [0] * 13
        faps[3], faps[4] = raised, -opening - raised
        wanted = min(max(1400 + opening, 1400), 2000)
        jaw = min(max(wanted, jaw - 50), jaw + 50)
        lip = min(max(1500 - 2 * raised, 1400), 1550)
        assert labial.Frame(0, tuple(faps)).rig(face) == {"jaw": jaw, "lip": lip} == face.values
    assert face.rest() == {"jaw": 1400, "lip": 1500}


def test_built_in_rigs() -> None:
    """Known by name, each value within its limits; a PCA9685's rig tells its prescaler."""
    assert "arkit" in labial.Rig.BUILTIN
    motion = labial.render(WORD)
    for name in labial.Rig.BUILTIN:
        for row in motion:
            values = labial.Frame(0, row).rig(name)
            assert all(isinstance(value, float) and 0 <= value <= 1 for value in values.values())
            assert values == labial.Rig(name).apply(row)  # what is kept under a name has no memory
    assert 0.1 < max(labial.Frame(0, row).rig("arkit")["jawOpen"] for row in motion) <= 1
    servos = labial.Rig(SOURCE / "examples" / "faces" / "servos.toml")
    assert servos.unit == "pca9685" and servos.prescale == 121


def test_what_is_no_rig(tmp_path: Path) -> None:
    path = tmp_path / "face.toml"
    path.write_text('[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 9000\n')
    with pytest.raises(DataError, match="face.toml: output.jaw.maximum: 9000 is not a servo's pulse"):
        labial.Rig(path)
    with pytest.raises(DataError, match="nothing.toml: No such file"):
        labial.Rig("nothing.toml")
    frame = labial.Frame(0, (0,) * 13)
    with pytest.raises(LabialError, match="no built-in rig is called 'nothing.toml'"):
        frame.rig("nothing.toml")
    face = labial.Rig("arkit")
    for faps, error in (((0,) * 12, LabialError), ((40000,) * 13, LabialError), ((0.5,) * 13, TypeError)):
        with pytest.raises(error):
            face.apply(faps)
