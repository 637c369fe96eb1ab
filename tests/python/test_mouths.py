"""What a viewer must see on an avatar that ARKit's, VRM's or Oculus LipSync's weights move: lips shut in p, b, m, the
lower lip at the teeth in f, v, vowels that differ, and a still mouth at rest.

``sentences.flite`` are the lines of ``sentences.txt`` as ``flite -t LINE -psdur -o none`` times them.
"""

from __future__ import annotations

import io
import json
import os
import subprocess
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.rig import FACES
from labial.rig.animation import face, outputs
from labial.tables.model import save
from models import lab, random_model
from scripts import read_frames

HERE = Path(__file__).parent
CONFORMANCE = HERE.parent / "conformance"
SAY = os.environ.get("LABIAL_SAY", "")
pytestmark = pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")
FPS = 50
#: What opens the mouth.
VOWELS = {"vrm": "aa ih ou ee oh".split(), "oculus": "aa E ih oh ou".split()}


def say(timings: str, form: str) -> str:
    """What labial-say makes of timings."""
    done = subprocess.run([SAY, "--to", form], input=timings.encode(), capture_output=True, timeout=60, check=True)
    return done.stdout.decode("ascii")


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
