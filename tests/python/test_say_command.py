"""``labial say`` and what a first user meets: pages, notebooks, unknown outputs, names that are nearly right; ``labial
hear`` with a text or phonemes, whose frames are mixed with those of the sound."""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any, List

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.commands import COMMANDS
from labial.corpus.episode import Segment
from labial.errors import LabialError
from models import random_model, write_wav
from packages import SOURCE, needs_runtime, run
from test_see import data_of

pytestmark = needs_runtime


def test_a_text_is_said_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    """Every word in its order, signs as pauses, no gaps; as fast as people speak."""
    assert main(["say", "Hello there, how are you?", "--voice", "none"]) == 0
    said = capsys.readouterr().out
    starts, ends, labels = zip(*(line.split() for line in said.splitlines()))
    assert list(labels) == "SIL HH EH L OW DH EH R SIL HH AW AA R Y UW SIL".split()
    assert ends[:-1] == starts[1:] and 1.0 < float(ends[-1]) < 3.0
    assert main(["say", "Hello", "there,", "how are", "you?", "--voice", "none"]) == 0  # without quotes
    assert capsys.readouterr().out == said


@pytest.mark.parametrize("suffix", ["html", "csv", "fap", "jsonl", "lab"])
def test_outputs_by_their_names(suffix: str, tmp_path: Path) -> None:
    """What each holds is read back by the commands that take it."""
    path = tmp_path / f"a.{suffix}"
    assert main(["say", "Maybe people hum.", "--voice", "none", "-o", str(path)]) == 0
    text = path.read_text(encoding="utf-8")
    if suffix == "html":
        data = data_of(text)
        assert data["title"] == "Maybe people hum." and max(frame[0] for frame in data["frames"]) > 100
        assert [item["label"] for item in data["phonemes"]][:4] == ["SIL", "M", "EY", "B"]
    elif suffix in ("csv", "fap"):
        assert main(["page", str(path), "-o", str(tmp_path / "b.html")]) == 0
    elif suffix == "jsonl":
        assert "jawOpen" in json.loads(text.splitlines()[20])["arkit"]
    else:
        assert labial.read_timings(path)[1][0] == "M"


WITHOUT_NUMPY = ("import sys; sys.modules['numpy'] = None\n"
                 "from labial.__main__ import main; sys.exit(main(['say', *sys.argv[1:]]))")


def test_it_needs_nothing_but_python(tmp_path: Path) -> None:
    """Right after `pip install`: without numpy, and without a synthesiser."""
    run(sys.executable, "-c", WITHOUT_NUMPY, "Hello there", "-o", tmp_path / "a.html", env={"PATH": ""})
    assert "labial-mouth" in (tmp_path / "a.html").read_text(encoding="utf-8")


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="espeak-ng is not installed")
def test_another_language_needs_no_numpy(tmp_path: Path) -> None:
    """Right after `pip install`, with espeak-ng: it tells the phonemes, and its sound is left out."""
    run(sys.executable, "-c", WITHOUT_NUMPY, "--language", "de", "Guten Morgen", "-o", "x.lab", cwd=tmp_path)
    assert [label for label, _ in labial.read_timings(tmp_path / "x.lab")][1] == "G"


def test_a_recording_is_heard(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its sound is in the page; where it is cut off or empty, that is said."""
    sound, page = tmp_path / "a.wav", tmp_path / "a.html"
    write_wav(sound, np.zeros(32000))
    assert main(["say", "Hello", "--audio", str(sound), "-o", str(page)]) == 0
    assert "data:audio/wav;base64," in page.read_text(encoding="utf-8") and not capsys.readouterr().err
    sound.write_bytes(sound.read_bytes()[:32044])
    assert main(["hear", str(sound), "-o", str(tmp_path / "a.csv")]) == 0
    assert "warning: " in (said := capsys.readouterr().err) and "the file is cut off: 1.00 of 2.00 s are there" in said
    sound.write_bytes(sound.read_bytes()[:44])
    assert main(["hear", str(sound), "-o", str(tmp_path / "a.csv")]) == 1
    assert "a.wav: the sound is empty: it has no samples" in capsys.readouterr().err


@pytest.mark.parametrize("arguments, problem", [
    (["say", " \n"], "there is nothing to say: the text is empty"),
    (["say", "...", "--voice", "none"], "'...' has no word that can be said"),
    (["say", "Привет", "--voice", "none"], "has no word that can be said; for a text that is not English, name its"),
    (["say", "a", "-o", "a.txt"], "a.txt: the name of the output ends in .html or .lab or .csv"),
    (["say", "a", "--voice", "siri"], "'siri' is not a voice"),
    (["say", "a", "--audio", "a.wav"], "labial align finds the phonemes"),
    (["timings", "a.json", "-o", "a.txt"], "a.txt: the name of the output ends in .lab"),
    (["page", "a.csv", "-o", "a.png"], "a.png: the name of the output ends in .html or .htm"),
    (["synth", "speech_en", "a.lab", "-o", "a.xyz"], "a.xyz: the name of the output ends in .csv or .fap or .jsonl"),
    (["synth", "speech-en", "a.lab", "-o", "a.csv"], "a bundled model: did you mean speech_en?"),
])
def test_errors_say_what_to_do(arguments: List[str], problem: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                               capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.lab").write_text("0 0.1 M\n")
    assert main(arguments) == 1
    assert problem in capsys.readouterr().err and sorted(path.name for path in tmp_path.iterdir()) == ["a.lab"]


def test_names_that_are_nearly_right(capsys: pytest.CaptureFixture[str]) -> None:
    for given, meant in (("trian", "train"), ("hera", "hear"), ("Page", "page"), ("sya", "say")):
        with pytest.raises(SystemExit):
            main([given])
        assert f"{given!r} is no command: did you mean {meant}?" in capsys.readouterr().err
    with pytest.raises(LabialError, match="did you mean elevenlabs?"):
        labial.Voice("eleven-labs")
    with pytest.raises(LabialError, match="did you mean hear_small?"):
        labial.Hearing(model="hear-small")


def test_alone_it_prints_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    said = capsys.readouterr().out
    assert all(re.search(rf"^    {name}\b", said, re.MULTILINE) for name in COMMANDS)
    for arguments, usage in ((["help"], "usage: labial [-h]"), (["help", "say"], "usage: labial say")):
        with pytest.raises(SystemExit, match="0"):
            main(arguments)
        assert capsys.readouterr().out.startswith(usage)


def test_a_notebook_shows_motion() -> None:
    """A page within the notebook's, in which nothing of it can end the attribute; and still a list of frames."""
    motion = labial.render([("HH", 70), ("AY", 230)])
    html = motion._repr_html_()
    assert re.fullmatch(r'<iframe srcdoc="[^"<>]*" style="[^"]*"></iframe>', html) and "labial-mouth" in html
    assert motion == list(motion) and motion.fps == 50 and isinstance(motion[0], tuple)


def test_eight_seconds_are_too_little_to_train_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                  capsys: pytest.CaptureFixture[str]) -> None:
    """Such a model's mouth stays shut: it is refused before the time that it takes. Of little more is warned."""
    episode, trained = SimpleNamespace(times=[0.0, 8.0], segments=[]), random_model(3)
    monkeypatch.setattr("labial.corpus.read_corpora", lambda *_, **__: [[episode]])
    monkeypatch.setattr("labial.train.train", lambda *_, **__: trained)
    monkeypatch.setattr("labial.train.without_apex", lambda _: [])
    monkeypatch.setattr("labial.train.backed_off", lambda _: [])
    assert main(["train", "c", "-o", str(tmp_path / "m.npz")]) == 1
    assert "8.0 s of motion are too little to train on: 15 s are the least" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
    for seconds, warned in ((60.0, True), (600.0, False)):
        episode.times = [0.0, seconds]
        assert main(["train", "c", "-o", str(tmp_path / "m.npz")]) == 0
        assert ("60 s of motion are little" in capsys.readouterr().err) == warned


# ---- Phonemes and their sound, mixed: labial.with_sound() and `labial hear` with a text or phonemes ------------------


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
    frame = labial.Frame(0, tuple(map(int, pose(400))))  # of a stream or of hearing
    assert labial.with_sound([frame], [frame]) == labial.with_sound([pose(400)], [pose(400)])


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

@pytest.fixture(name="sound")
def fixture_sound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """A buzz of .4 s in a second, in the folder in which commands run as a.wav, with a.lab; (16000,) int16."""
    monkeypatch.chdir(tmp_path)
    time = np.arange(16000) / 16000
    samples = (8000 * np.sign(np.sin(2 * np.pi * 150 * time)) * ((time > 0.4) & (time < 0.8))).astype("<i2")
    write_wav(Path("a.wav"), samples)
    Path("a.lab").write_text("0 .2 SIL\n.2 .4 M\n.4 .8 AA\n.8 1 SIL\n")
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
    server = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(server)
    timings = [("SIL", 400.0), ("AA", 400.0), ("SIL", 200.0)]
    spoken, said = server.Spoken(sound.tobytes(), 16000, timings), labial.render(timings, exact=True)
    assert spoken.frames(False) == said
    assert spoken.frames(True) == labial.with_sound(said, heard(sound)[: len(said)]) != said
