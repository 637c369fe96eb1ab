"""Animation files, from labial-say and from labial synth, read back by readers that know nothing of either writer. And
what a viewer must see on an avatar that ARKit's, VRM's or Oculus LipSync's weights move: lips shut in p, b, m, the
lower lip at the teeth in f, v, vowels that differ, and a still mouth at rest.

``sentences.flite`` are the lines of ``sentences.txt`` as ``flite -t LINE -psdur -o none`` times them."""

from __future__ import annotations

import csv
import io
import json
import os
import random
import re
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.files.faps import FAP_COLUMNS, FAP_NUMBERS
from labial.reference.visemes import shares, tongue
from labial.rig import FACES, description_of
from labial.rig.animation import FORMATS, LIVE_LINK, arkit, face, outputs
from labial.rig.description import read
from labial.tables.model import save
from models import lab, random_model
from packages import run
from scripts import read_frames

SAY = os.environ.get("LABIAL_SAY", "")
needs_say = pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")
SENTENCE = "pau:0.220 m:0.290 ay:0.440 b:0.530 ey:0.730 th:0.810 iy:0.900 pau:1.120\n<laugh 1.5 1.0>\nuw:0.3 pau:0.4\n"
SPOKEN = [("SIL", 220), ("M", 70), ("AY", 150), ("B", 90), ("EY", 200), ("TH", 80), ("IY", 90), ("SIL", 220),
          ("laugh", 1500), ("UW", 300), ("SIL", 100)]

#: ARKit's blendshapes, as Apple lists them.
APPLE = """browDownLeft browDownRight browInnerUp browOuterUpLeft browOuterUpRight cheekPuff cheekSquintLeft
cheekSquintRight eyeBlinkLeft eyeBlinkRight eyeLookDownLeft eyeLookDownRight eyeLookInLeft eyeLookInRight eyeLookOutLeft
eyeLookOutRight eyeLookUpLeft eyeLookUpRight eyeSquintLeft eyeSquintRight eyeWideLeft eyeWideRight jawForward jawLeft
jawOpen jawRight mouthClose mouthDimpleLeft mouthDimpleRight mouthFrownLeft mouthFrownRight mouthFunnel mouthLeft
mouthLowerDownLeft mouthLowerDownRight mouthPressLeft mouthPressRight mouthPucker mouthRight mouthRollLower
mouthRollUpper mouthShrugLower mouthShrugUpper mouthSmileLeft mouthSmileRight mouthStretchLeft mouthStretchRight
mouthUpperUpLeft mouthUpperUpRight noseSneerLeft noseSneerRight tongueOut""".split()


def read_fap(text: str) -> Tuple[str, int, List[Dict[int, int]]]:
    """A strict reader of MPEG-4 text: name, rate and the FAPs of each frame; asserts where the format is not kept."""
    assert text.endswith("\n") and "\r" not in text
    lines = text.split("\n")[:-1]
    version, name, rate, count = re.fullmatch(r"(\S+) (\S+) (\d+) (\d+)", lines[0]).groups()
    assert version == "2.1" and len(lines) == 1 + 2 * int(count)
    frames = []
    for number in range(int(count)):
        mask, values = lines[1 + 2 * number], lines[2 + 2 * number]
        assert re.fullmatch(r"[01]( [01]){67}", mask)
        assert re.fullmatch(r"\d+( -?\d+)*", values)
        first, *rest = map(int, values.split(" "))
        assert first == number and len(rest) == mask.count("1")
        present = [fap for fap, bit in enumerate(mask.split(" "), 1) if bit == "1"]
        frames.append(dict(zip(present, rest)))
    return name, int(rate), frames


def read_live_link(text: str) -> Tuple[List[float], List[Dict[str, float]]]:
    """Seconds at 50 frames per second, and the columns of each row; asserts where the format is not kept."""
    rows = list(csv.reader(io.StringIO(text), strict=True))
    assert rows[0][:2] == ["Timecode", "BlendShapeCount"] and len(rows[0]) == 63
    names = rows[0][2:]
    assert {name[0].lower() + name[1:] for name in names[:52]} == set(APPLE)
    turns = ("Yaw", "Pitch", "Roll")
    assert names[52:] == [f"{part}{turn}" for part in ("Head", "LeftEye", "RightEye") for turn in turns]
    times, frames = [], []
    for row in rows[1:]:
        hours, minutes, seconds, frame, part = map(int, re.fullmatch(
            r"(\d\d):(\d\d):(\d\d):(\d\d)\.(\d\d\d)", row[0]).groups())
        assert row[1] == "61" and len(row) == 63 and frame < 50
        times.append(hours * 3600 + minutes * 60 + seconds + (frame + part / 1000) / 50)
        frames.append(dict(zip(names, map(float, row[2:]))))
        assert all(0.0 <= value <= 1.0 for value in frames[-1].values())
    return times, frames


def read_csv(text: str) -> np.ndarray:
    """(T, 13) FAPs of a table."""
    rows = list(csv.DictReader(io.StringIO(text), strict=True))
    return np.array([[float(row[name]) for name in FAP_COLUMNS] for row in rows]).reshape(-1, len(FAP_COLUMNS))


def check_all(texts: Dict[str, str], tolerance: float, phonemes: List[Tuple[str, int]], shared: float) -> None:
    """Asserts that the files of one motion say the same; weights may differ by `shared`, since shares of sounds are
    rounded in C."""
    faps = read_csv(texts["csv"])
    assert len(faps) > 20 and np.ptp(faps, axis=0).min() > 0
    name, rate, frames = read_fap(texts["fap"])
    assert name in ("speech_en", "a_model") and rate == 50 and len(frames) == len(faps)
    times, shapes = read_live_link(texts["livelink"])
    assert times == pytest.approx(np.arange(len(faps)) / 50)
    objects = [json.loads(line) for line in texts["jsonl"].splitlines()]
    assert len(objects) == len(shapes) == len(faps)
    known = shares(phonemes, 50, len(faps))
    weights, tongues = arkit(faps, known), tongue(known)
    assert np.ptp(tongues, axis=0)[1:4].min() > 20 or "TH" not in dict(phonemes)
    for t, frame in enumerate(faps):
        assert frames[t] == pytest.approx({**{fap: frames[t][fap + 47] for fap in range(4, 14)},
                                           **dict(zip(FAP_NUMBERS, frame)),
                                           **{43 + k: frames[t][43 + k] for k in range(5)}}, abs=0.5 + tolerance)
        assert [frames[t][43 + k] for k in range(5)] == pytest.approx(tongues[t], abs=0.5 + 500 * shared)
        expected = {name: column[t] for name, column in weights.items()}
        moved = {name[0].lower() + name[1:]: value for name, value in shapes[t].items() if value != 0}
        assert set(moved) <= set(weights)
        assert {name: moved.get(name, 0.0) for name in weights} == pytest.approx(
            expected, abs=0.0006 + shared + tolerance / 100)
        assert objects[t]["frame"] == t and objects[t]["time"] == pytest.approx(t / 50)
        assert objects[t]["faps"] == pytest.approx(dict(zip(FAP_COLUMNS, frame)), abs=tolerance)
        assert objects[t]["arkit"] == pytest.approx(expected, abs=0.0006 + shared + tolerance / 100)
    for name in FACES:  # weights alone; what they show is tested below
        rows = [json.loads(line) for line in texts[name].splitlines()]
        assert [row["frame"] for row in rows] == list(range(len(faps)))
        for key, column in outputs(face(name), faps, known).items():
            assert [row[name][key] for row in rows] == pytest.approx(
                column, abs=0.0011 + shared + tolerance / 50), (name, key)


@needs_say
def test_files_of_labial_say() -> None:
    """Catches a format that its readers refuse, and a blendshape that C and Python weigh differently."""
    check_all({name: say(SENTENCE, name) for name in FORMATS}, 0.0, SPOKEN, 0.02)


def test_files_of_labial_synth(tmp_path: Path) -> None:
    """Catches a format of the exporter that its readers refuse."""
    model = tmp_path / "a model.npz"
    save(random_model(3), model)
    (tmp_path / "a.lab").write_text("0 0.2 SIL\n0.2 0.5 P1\n0.5 0.8 P2\n0.8 1.2 P4\n")
    texts = {}
    for name in FORMATS:
        out = tmp_path / f"out.{name}"
        assert main(["synth", str(model), str(tmp_path / "a.lab"), "-o", str(out), "--to", name]) == 0
        texts[name] = out.read_text(encoding="ascii")
    check_all(texts, 0.011, [("SIL", 1200)], 0.0)


def test_fap_files_for_players_of_another_rate(tmp_path: Path) -> None:
    """Greta plays 25 frames per second: the file lasts as long as the sound, and each frame is the mean of two. Would
    catch frames that are dropped or repeated, and a header that keeps the model's rate."""
    (tmp_path / "hello.lab").write_text("0 0.1 SIL\n0.1 0.24 HH\n0.24 0.55 OW\n0.55 0.76 SIL\n")
    frames = {}
    for rate in (50, 25, 100):
        out = tmp_path / f"{rate}.fap"
        assert main(["synth", "speech_en", str(tmp_path / "hello.lab"), "--to", "fap", "--fps", str(rate), "-o",
                     str(out), "--exact"]) == 0
        name, found, faps = read_fap(out.read_text())
        frames[rate] = np.array([list(item.values()) for item in faps])
        assert (name, found) == ("speech_en", rate) and len(faps) == round(0.76 * rate)
    halves = frames[50].reshape(19, 2, -1).mean(axis=1)
    assert np.abs(frames[25] - halves).max() <= 0.25 * np.abs(np.diff(frames[50], 2, axis=0)).max() + 1
    assert np.abs(frames[100][1:-1:2] - frames[50][: len(frames[100][1:-1:2])]).max() > 0  # interpolated, not repeated


def test_blendshapes_of_a_face() -> None:
    """Catches a blendshape that moves with the wrong part of the face or the wrong way: each gesture, in FAP units, and
    what it must and must not move."""
    rest = dict.fromkeys(FAP_NUMBERS, 0.0)
    gestures = {
        "jaw": ({3: 400, 52: -400, 57: -400, 58: -400}, {"jawOpen"}, {"mouthPucker", "mouthRollLower"}),
        "closed": ({3: 400, 51: 200}, {"mouthClose"}, {"mouthUpperUpLeft", "mouthPucker"}),
        "lip to teeth": ({3: 260, 51: -35, 52: -100, 55: -35, 56: -35}, {"mouthRollLower"}, {"mouthPucker"}),
        "round": ({17: 150, 16: 150, 53: -150, 54: -150}, {"mouthPucker"}, {"jawOpen", "mouthSmileLeft", "mouthClose"}),
        "smile": ({53: 150, 54: 150, 59: 150, 60: 150}, {"mouthSmileLeft", "mouthSmileRight"},
                  {"mouthPucker", "jawOpen"}),
        "left": ({53: 150, 59: 150}, {"mouthSmileLeft"}, {"mouthSmileRight", "mouthStretchRight"}),
        "teeth": ({51: -150, 55: -150, 56: -150}, {"mouthUpperUpLeft", "mouthUpperUpRight"}, {"jawOpen"}),
    }  # fmt: skip
    assert not np.any(list(arkit(np.array([list(rest.values())])).values()))
    for name, (faps, moved, still) in gestures.items():
        weights = {name: column[0] for name, column in arkit(np.array([list({**rest, **faps}.values())])).items()}
        assert all(weights[shape] > 0.1 for shape in moved), (name, weights)
        assert all(weights[shape] <= 0.05 for shape in still), (name, weights)


def test_columns_are_apples() -> None:
    """Catches a blendshape that is described and that ARKit or Live Link do not know, so that it would go nowhere."""
    described = {output.name for output in read(description_of("arkit"), "arkit").outputs}
    assert len(described) == 17 and described <= set(APPLE) and len(LIVE_LINK) == 61
    assert set(arkit(np.zeros((1, len(FAP_NUMBERS))))) == described


@needs_say
def test_long_motion_has_good_timecodes() -> None:
    """Catches seconds that run past 59, and frames past the rate."""
    text = "".join(f"aa {random.Random(i).randint(300, 900)}\nb 100\n" for i in range(120))
    times, _ = read_live_link(say(text, "livelink"))
    assert times[-1] > 60 and times == pytest.approx(np.arange(len(times)) / 50)


@needs_say
def test_programs_write_the_same_formats() -> None:
    """Catches a format that only one of `labial synth` and labial-say has."""
    told = run(SAY, "--to", "?", status=2)
    names = re.fullmatch(r"labial-say: --to is (.*), not '\?'; see labial-say --help\n", told)
    assert names and set(re.split(", | or ", names[1])) == set(FORMATS), told


def test_a_format_is_no_rig() -> None:
    """Catches a rig that takes another format's name, and one whose values no avatar knows."""
    for name in {"csv", "fap", "livelink", "jsonl", "faps", "frame", "time"} & set(FACES):
        pytest.fail(f"export/labial/rig/{name}.toml: {name} is taken in what is written; name the file otherwise")
    for name in FACES:
        unit = face(name).unit.name
        assert unit == "weight", f"export/labial/rig/{name}.toml: the unit of a format of output is weight, not {unit}"


# ---- What a viewer sees ----------------------------------------------------------------------------------------------


HERE = Path(__file__).parent
CONFORMANCE = HERE.parent / "conformance"
FPS = 50
#: What opens the mouth.
VOWELS = {"vrm": "aa ih ou ee oh".split(), "oculus": "aa E ih oh ou".split()}


def say(timings: str, form: str) -> str:
    """What labial-say makes of timings."""
    return run(SAY, "--to", form, text=timings)


class Motion(NamedTuple):
    """FAPs and the weights of each rig, all from labial-say."""

    faps: np.ndarray
    weights: Dict[str, Dict[str, np.ndarray]]


def motion(timings: str) -> Motion:
    """Frames as whole FAPs, and each rig's weights."""
    faps = np.loadtxt(io.StringIO(say(timings, "csv")), delimiter=",", skiprows=1)[:, 1:]
    weights = {}
    for name in FACES:
        rows = [json.loads(line) for line in say(timings, name).splitlines()]
        assert [set(row) for row in rows] == [{"frame", "time", name}] * len(faps)
        assert [row["time"] for row in rows] == pytest.approx(np.arange(len(faps)) / FPS)
        weights[name] = {key: np.array([row[name][key] for row in rows]) for key in rows[0][name]}
    return Motion(faps, weights)


@pytest.fixture(scope="module")
def spoken() -> Tuple[Motion, List[Tuple[str, slice]]]:
    """The sentences' motion, and each phoneme with its frames, one more on either side."""
    text = (HERE / "sentences.flite").read_text(encoding="ascii")
    phonemes, begin = [], 0.0
    for line in text.splitlines():
        marks = [item.split(":") for item in line.split()]
        times = [0.0, *(float(end) for _, end in marks)]
        phonemes += [(label, slice(max(int((begin + start) * FPS) - 1, 0), int((begin + end) * FPS) + 2))
                     for (label, _), start, end in zip(marks, times, times[1:])]
        begin += times[-1]
    return motion(text), phonemes


def moments(spoken: Tuple[Motion, List[Tuple[str, slice]]], labels: str, score: np.ndarray) -> np.ndarray:
    """The frame of each phoneme of `labels` where `score` (T,) is highest."""
    return np.array([part.start + int(np.argmax(score[part])) for label, part in spoken[1] if label in labels.split()])


def share(condition: np.ndarray) -> float:
    """How much of an array of truths is true."""
    return float(np.mean(condition))


def streams() -> Iterator[np.ndarray]:
    """FAPs of the conformance streams."""
    for rows in read_frames((CONFORMANCE / "frames.txt").read_text(encoding="ascii")).values():
        yield np.array(rows, dtype=float).reshape(-1, 13)


@needs_say
def test_weights_are_weights(spoken: Tuple[Motion, List[Tuple[str, slice]]]) -> None:
    """Catches a weight outside 0 .. 1, one that never shows, and weights that add up to a torn mouth: engines add their
    morphs, so that the sum must stay near one whole mouth."""
    every = [spoken[0].faps, motion("<laugh 3 1.0>\n<laugh 2 0.2>\n").faps, *streams()]
    for name in FACES:
        shown = [np.stack(list(outputs(face(name), faps).values()), axis=1) for faps in every]
        assert all(((values >= 0.0) & (values <= 1.0)).all() for values in shown), name
        assert all(column.max() >= 0.05 for column in spoken[0].weights[name].values()), name
    for name in VOWELS:
        total = sum(column for key, column in spoken[0].weights[name].items() if key != "sil")
        assert np.percentile(total, 90) <= 1.3 and share(total <= 1.6) >= 0.98, name


@needs_say
def test_lips_close(spoken: Tuple[Motion, List[Tuple[str, slice]]]) -> None:
    """In every p, b, m of 32 sentences, where it is most closed: mouthClose makes up for the jaw, VRM's mouths are
    shut, PP is up and no vowel shows. test_fit.py has it in millimetres."""
    faps, weights = spoken[0]
    at = moments(spoken, "p b m", faps[:, 3] + faps[:, 4])
    assert len(at) > 100
    arkit, vrm, oculus = (weights[name] for name in ("arkit", "vrm", "oculus"))
    assert (np.abs(arkit["jawOpen"] - arkit["mouthClose"])[at] <= 0.09).all()
    assert share(arkit["mouthClose"][at] >= 0.03) >= 0.95
    for opening in (sum(vrm[key] for key in VOWELS["vrm"]), sum(oculus[key] for key in VOWELS["oculus"])):
        assert opening[at].max() <= 0.36 and share(opening[at] <= 0.1) >= 0.95
    assert share(oculus["PP"][at] >= 0.15) >= 0.95


@needs_say
def test_lower_lip_meets_the_teeth(spoken: Tuple[Motion, List[Tuple[str, slice]]]) -> None:
    """In f, v of 32 sentences, where the lower lip is highest: eight of ten show it plainly, and p, b, m are not taken
    for them. One v that opens a sentence is slack in the motion itself."""
    faps, weights = spoken[0]
    at = moments(spoken, "f v", faps[:, 0] + faps[:, 4])
    closed = moments(spoken, "p b m", faps[:, 3] + faps[:, 4])
    arkit, vrm, oculus = (weights[name] for name in ("arkit", "vrm", "oculus"))
    assert share(arkit["mouthRollLower"][at] >= 0.25) >= 0.8 and share(arkit["mouthRollLower"][closed] <= 0.1) >= 0.95
    assert share(oculus["FF"][at] >= 0.2) >= 0.8 and share(oculus["FF"][closed] <= 0.1) >= 0.95
    assert share(vrm["aa"][at] <= 0.1) >= 0.9
    others = [part for label, part in spoken[1] if label in "aa ae ay aw ow uw iy ey".split()]
    middle = np.array([(part.start + part.stop) // 2 for part in others])
    assert share(oculus["FF"][middle] <= 0.1) >= 0.95 and share(oculus["PP"][middle] <= 0.1) >= 0.95


#: A word, the vowel that is looked at, and for VRM and Oculus: what must show by how much, and what must show less.
WORDS = {
    "father": ("F 100 AA 250 DH 70 ER 200", "AA", {"aa": 0.4}, {"ou": 0.1}),
    "go": ("G 80 OW 350", "OW", {"oh": 0.4}, {"aa": 0.25, "ih": 0.05}),
    "do": ("D 80 UW 300", "UW", {"ou": 0.5}, {"aa": 0.1, "oh": 0.1, "ih": 0.05}),
    "see": ("S 120 IY 300", "IY", {"ih": 0.5}, {"ou": 0.05, "aa": 0.2, "oh": 0.05}),
    "sit": ("S 120 IH 150 T 100", "IH", {"ih": 0.4}, {"ou": 0.05, "aa": 0.2, "oh": 0.05}),
}


@needs_say
@pytest.mark.parametrize("word", WORDS)
def test_vowels_differ(word: str) -> None:
    """Catches vowels that look alike: wide in father, rounded and open in go, rounded and narrow in do, narrow and not
    rounded in see and sit."""
    text, vowel, shown, hidden = WORDS[word]
    items = text.split()
    lengths = [int(length) for length in items[1::2]]
    before = 300 + sum(lengths[: items[::2].index(vowel)])
    middle = (before + lengths[items[::2].index(vowel)] // 2) * FPS // 1000
    found = motion(lab([("SIL", 300), *zip(items[::2], lengths), ("SIL", 300)]))
    for name in VOWELS:
        for keys, keeps in ((shown, np.greater_equal), (hidden, np.less_equal)):
            for key, bound in keys.items():
                column = found.weights[name][key]
                assert keeps(column[middle], bound), (name, key, column[middle])


@needs_say
def test_the_mouth_rests() -> None:
    """Catches a mouth that is not still in silence: nothing but sil shows on the neutral face, and hardly anything
    in a pause, where a talker's lips are never quite at rest."""
    still = np.zeros((1, 13))
    assert not any(column.any() for name in ("arkit", "vrm") for column in outputs(face(name), still).values())
    weights = {key: column[0] for key, column in outputs(face("oculus"), still).items()}
    assert weights.pop("sil") == 1.0 and not any(weights.values())
    paused = motion(lab([("SIL", 300), ("AA", 200), ("SIL", 1500), ("M", 100), ("SIL", 1500)])).weights
    for part in (slice(0, 5), slice(50, 88), slice(130, None)):
        assert max(column[part].max() for column in paused["vrm"].values()) <= 0.06
        assert max(column[part].max() for key, column in paused["oculus"].items() if key not in ("sil", "PP")) <= 0.06
        assert paused["oculus"]["sil"][part].min() >= 0.85 and paused["arkit"]["jawOpen"][part].max() <= 0.05
        for key, column in paused["arkit"].items():  # the corners of a recorded mouth wander, its lips do not part
            assert column[part].max() <= (0.3 if key.startswith(("mouthSmile", "mouthStretch")) else 0.06), key


def test_faces_of_labial_synth(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """``--to vrm`` and ``--rig FACE.toml``: outputs by their names, in the description's unit, and errors that say what
    is wrong."""
    model, phones, rig = tmp_path / "a.npz", tmp_path / "a.lab", tmp_path / "puppet.toml"
    save(random_model(3), model)
    phones.write_text("0 0.2 SIL\n0.2 0.5 P1\n0.5 0.8 P2\n0.8 1.2 P4\n")
    rig.write_text('[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 1900\n')

    def synth(*options: str) -> List[Dict]:
        assert main(["synth", str(model), str(phones), *options]) == 0
        return [json.loads(line) for line in capsys.readouterr().out.splitlines()]

    assert all(list(row["vrm"]) == VOWELS["vrm"] and "faps" not in row for row in synth("--to", "vrm"))
    rows = synth("--to", "jsonl", "--rig", str(rig))
    opening = np.array([-row["faps"]["fap51"] - row["faps"]["fap52"] for row in rows])
    pulses = np.array([row["puppet"]["jaw"] for row in rows])
    assert pulses == pytest.approx(np.clip(1400 + opening * 500 / 600, 1400, 1900), abs=0.02) and np.ptp(pulses) > 1
    for options, message in ((["--to", "csv", "--rig", str(rig)], "--rig goes with --to jsonl"),
                             (["--to", "jsonl", "--rig", str(tmp_path / "none.toml")], "none.toml")):
        assert main(["synth", str(model), str(phones), *options]) == 1
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1
    (tmp_path / "faps.toml").write_text(rig.read_text())
    assert main(["synth", str(model), str(phones), "--to", "jsonl", "--rig", str(tmp_path / "faps.toml")]) == 1
    assert "'faps' is taken" in capsys.readouterr().err
