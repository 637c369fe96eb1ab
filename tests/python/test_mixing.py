"""Frames of phonemes and of their sound, mixed: labial.with_sound() and `labial hear` with a text or phonemes."""

from __future__ import annotations

import importlib.util
import wave
from pathlib import Path
from types import SimpleNamespace
from typing import Any, List

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.corpus.episode import Segment
from labial.errors import LabialError
from packages import SOURCE


def pose(gap: float, corner: float = 0.0) -> List[float]:
    """A pose whose lips are `gap` apart."""
    found = [0.0] * 13
    found[3] = found[4] = -gap / 2
    found[5] = corner
    return found


def test_by_hand() -> None:
    """Catches a share that closed lips do not resist, one of the wrong motion, and numbers that are cut off."""
    spoken, heard = [pose(400, 10), pose(60, 10), pose(136, 10)], [pose(200, 31), pose(200, 31), pose(236, 31)]
    found = labial.with_sound(spoken, heard)
    assert [-frame[3] - frame[4] for frame in found] == [340, 60, 150]  # 151 is -75.5 for each lip
    assert {frame[5] for frame in found} == {16} and {len(frame) for frame in found} == {13}
    assert labial.with_sound(spoken, heard, 0.0) == [tuple(map(round, frame)) for frame in spoken]
    assert labial.with_sound(spoken, heard, 1) == [tuple(map(round, frame)) for frame in heard]
    assert labial.with_sound(spoken, heard, [0, 1, 0]) == [tuple(map(round, frame)) for frame in
                                                           (spoken[0], heard[1], spoken[2])]


def test_what_is_longer_goes_on_alone() -> None:
    """And nothing is a motion, too."""
    one, two = [pose(400)] * 3, [pose(200)]
    assert [frame[3] for frame in labial.with_sound(one, two)] == [-170, -200, -200]
    assert [frame[3] for frame in labial.with_sound(two, one)] == [-130, -200, -200]
    assert labial.with_sound([], []) == []
    assert labial.with_sound(np.array(one), np.array(one)) == labial.with_sound(one, one)


def test_frames_are_mixed_as_their_faps() -> None:
    """Catches frames of a stream or of hearing that only their FAPs could stand for."""
    spoken, heard = [pose(400, 10), pose(60, 10)], [pose(200, 31), pose(200, 31)]
    frames = [[labial.Frame(k, tuple(map(int, row))) for k, row in enumerate(rows)] for rows in (spoken, heard)]
    assert labial.with_sound(*frames) == labial.with_sound(spoken, heard)


@pytest.mark.parametrize("arguments, message", [
    (([pose(1)], [pose(1)], 1.5), "a share of 1.5 is not within 0 .. 1"),
    (([pose(1)[1:]], [pose(1)]), "a frame has 12 numbers, not 13"),
    (([pose(1)], [pose(1)], []), "there are 0 shares for 1 frames"),
    (([pose(1)], [pose(1)], float("nan")), "nan"),
])
def test_wrong_arguments(arguments: Any, message: str) -> None:
    """Catches a motion that a wrong number spoils silently."""
    with pytest.raises(LabialError, match=message):
        labial.with_sound(*arguments)


# ---- The command -----------------------------------------------------------------------------------------------------

PHONES = "0 .2 SIL\n.2 .4 M\n.4 .8 AA\n.8 1 SIL\n"


@pytest.fixture(name="sound")
def fixture_sound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """A buzz of .4 s in a second, in the folder in which commands run as a.wav, with a.lab; (16000,) int16."""
    monkeypatch.chdir(tmp_path)
    time = np.arange(16000) / 16000
    samples = (8000 * np.sign(np.sin(2 * np.pi * 150 * time)) * ((time > 0.4) & (time < 0.8))).astype("<i2")
    with wave.open("a.wav", "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes(samples.tobytes())
    Path("a.lab").write_text(PHONES)
    return samples


def heard(sound: np.ndarray, model: str = "hear_host") -> List[Any]:
    """The frames of the sound alone, at its level."""
    with labial.Hearing(16000, model=model, exact=True) as hearing:
        hearing.measure(sound)
        return [frame.faps for frame in hearing.frames([sound])]


def shown(*options: str) -> np.ndarray:
    """(T, 13) what the command writes."""
    assert main(["hear", "a.wav", "-o", "a.csv", *options]) == 0
    return np.loadtxt("a.csv", delimiter=",", skiprows=1)[:, 1:]


def near(one: np.ndarray, other: List[Any]) -> bool:
    """Whether motions are the same but for what a last bit rounds to."""
    return one.shape == (len(other), 13) and bool(np.abs(one - np.array(other)).max() <= 1)


def test_the_command_mixes_known_phonemes(sound: np.ndarray) -> None:
    """Catches another share, and a face that does not come to rest."""
    said = labial.render([("SIL", 200), ("M", 200), ("AA", 400), ("SIL", 1220)], exact=True)[:50]
    found = labial.with_sound(said, heard(sound))
    exact = shown("--phones", "a.lab", "--exact")
    assert near(exact, found)
    whole = shown("--phones", "a.lab")
    assert whole[:50].tolist() == exact.tolist()
    assert len(whole) == 50 if np.abs(exact[-1]).max() <= 8 else not whole[-1].any()


def test_the_command_looks_for_words(sound: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    """Catches words of low confidence that move the mouth, and words that are looked for in vain."""
    align = pytest.importorskip("labial.sound.align")
    asked: List[Any] = []

    def aligned(path: str, text: Any = None) -> Any:
        asked.append(text)
        segments = (Segment(0, 0.4, "SIL"), Segment(0.4, 0.8, "AA"), Segment(0.8, 1.0, "SIL"))
        return SimpleNamespace(segments=segments,
                               stretches=[SimpleNamespace(start=0.4, end=0.8, confidence=confidence)])

    monkeypatch.setattr(align, "aligned", aligned)
    own = heard(sound)
    said = labial.render([("SIL", 400), ("AA", 400), ("SIL", 1220)], exact=True)[:50]
    confidence = 0.9
    half = labial.with_sound(said, own, 0.5)
    assert near(shown("--exact"), half)
    assert shown("--exact", "--text", "Ah").tolist() != shown("--exact").tolist() and asked[1] == "Ah"
    confidence = 0.0
    alone = [list(map(float, frame)) for frame in own]
    assert shown("--exact").tolist() == alone
    count = len(asked)
    assert shown("--exact", "--sound-alone").tolist() == alone and len(asked) == count
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert shown("--exact").tolist() == alone and len(asked) == count


@pytest.mark.parametrize("arguments, message", [
    (["-", "--text", "a"], "--text does not go with -"),
    (["a.wav", "--phones", "a.lab", "--sound-alone"], "--phones does not go with --sound-alone"),
    (["a.wav", "--phones", "a.lab", "--text", "a"], "--phones does not go with --text"),
    (["a.wav", "--phones", "none.lab"], "none.lab: No such file"),
])
def test_the_command_says_what_is_wrong(arguments: List[str], message: str, sound: np.ndarray,
                                        capsys: pytest.CaptureFixture) -> None:
    """Catches an option that is passed over."""
    assert main(["hear", *arguments]) == 1
    assert message in capsys.readouterr().err


def test_the_server_mixes_lips(sound: np.ndarray) -> None:
    """examples/beside/server.py: catches sound that is heard at another level than a file's."""
    place = SOURCE / "examples/beside/server.py"
    spec = importlib.util.spec_from_file_location("server", place)
    assert spec is not None and spec.loader is not None
    server = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(server)
    timings = [("SIL", 400.0), ("AA", 400.0), ("SIL", 200.0)]
    spoken, said = server.Spoken(sound.tobytes(), 16000, timings), labial.render(timings, exact=True)
    assert spoken.frames(False) == said
    assert spoken.frames(True) == labial.with_sound(said, heard(sound)[: len(said)]) != said
