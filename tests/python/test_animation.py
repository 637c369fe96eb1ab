"""Animation files, from labial-say and from labial synth, read back by readers that know nothing of either writer."""

from __future__ import annotations

import csv
import io
import json
import os
import random
import re
import subprocess
from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.files.faps import FAP_COLUMNS, FAP_NUMBERS
from labial.reference.visemes import shares, tongue
from labial.rig import FACES, description_of
from labial.rig.animation import FORMATS, LIVE_LINK, arkit, face, outputs
from labial.rig.description import read
from labial.tables.model import save
from models import random_model

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
    for name in FACES:  # weights alone; tests of what they show are test_mouths.py's
        rows = [json.loads(line) for line in texts[name].splitlines()]
        assert [row["frame"] for row in rows] == list(range(len(faps)))
        for key, column in outputs(face(name), faps, known).items():
            assert [row[name][key] for row in rows] == pytest.approx(
                column, abs=0.0011 + shared + tolerance / 50), (name, key)


@needs_say
def test_files_of_labial_say() -> None:
    """Catches a format that its readers refuse, and a blendshape that C and Python weigh differently."""
    texts = {}
    for name in FORMATS:
        done = subprocess.run([SAY, "--to", name], input=SENTENCE.encode(), capture_output=True, timeout=60, check=True)
        texts[name] = done.stdout.decode("ascii")
    check_all(texts, 0.0, SPOKEN, 0.02)


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
    done = subprocess.run([SAY, "--to", "livelink"], input=text.encode(), capture_output=True, timeout=60, check=True)
    times, _ = read_live_link(done.stdout.decode())
    assert times[-1] > 60 and times == pytest.approx(np.arange(len(times)) / 50)


@needs_say
def test_programs_write_the_same_formats() -> None:
    """Catches a format that only one of `labial synth` and labial-say has."""
    told = subprocess.run([SAY, "--to", "?"], capture_output=True, encoding="utf-8", timeout=60, check=False).stderr
    names = re.fullmatch(r"labial-say: --to is (.*), not '\?'; see labial-say --help\n", told)
    assert names and set(re.split(", | or ", names[1])) == set(FORMATS), told


def test_a_format_is_no_rig() -> None:
    """Catches a rig that takes another format's name, and one whose values no avatar knows."""
    for name in {"csv", "fap", "livelink", "jsonl", "faps", "frame", "time"} & set(FACES):
        pytest.fail(f"export/labial/rig/{name}.toml: {name} is taken in what is written; name the file otherwise")
    for name in FACES:
        unit = face(name).unit.name
        assert unit == "weight", f"export/labial/rig/{name}.toml: the unit of a format of output is weight, not {unit}"
