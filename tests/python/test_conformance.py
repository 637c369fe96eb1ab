"""The committed vectors of ``tests/conformance`` against ``streams.txt`` and the float64 reference."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Dict, List

import numpy as np
import pytest

from labial.errors import LabialError
from labial.quantise import ExportedModel
from labial.reference import units
from labial.reference.tables import ExportedTables

HERE = Path(__file__).resolve().parents[1] / "conformance"
sys.path.insert(0, str(HERE))

from motion import mixed_pieces  # noqa: E402
from regenerate import bundled_models, deviations  # noqa: E402
from scripts import Frames, Script, as_c, digest, read, read_frames  # noqa: E402


@pytest.fixture(scope="module")
def models() -> Dict[str, ExportedModel]:
    return bundled_models()


@pytest.fixture(scope="module")
def scripts(models: Dict[str, ExportedModel]) -> List[Script]:
    return read(HERE / "streams.txt", models)


@pytest.fixture(scope="module")
def frames() -> Frames:
    return read_frames((HERE / "frames.txt").read_text(encoding="ascii"))


def test_committed_frames_follow_the_reference(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """Every wrong decision, switch, fade or easing is far beyond the limits: these are no golden files."""
    report = deviations(models, scripts, frames)
    assert len(report.splitlines()) == len(scripts) + 1


def test_a_wrong_frame_is_not_accepted(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """The comparison above can fail: on one number, on a frame too many, on small errors everywhere."""
    one = {name: motion.copy() for name, motion in frames.items()}
    one["cancelled"][40, 3] += 3
    with pytest.raises(LabialError, match="cancelled: frame 40, channel 3"):
        deviations(models, scripts, one)
    longer = {**frames, "switch": np.concatenate([frames["switch"], frames["switch"][-1:]])}
    with pytest.raises(LabialError, match="switch: 88 frames, the reference has 87"):
        deviations(models, scripts, longer)
    with pytest.raises(LabialError, match="RMS|frame"):
        deviations(models, scripts, {name: motion + 1 for name, motion in frames.items()})


def test_vectors_are_those_of_the_streams_and_frames(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """Would catch a digest or a step that was edited by hand, and a stream added without regenerating."""
    assert (HERE / "vectors.c").read_text(encoding="ascii") == as_c(scripts, models, frames), "run regenerate.py"
    assert list(frames) == [script.name for script in scripts]


def test_streams_reach_the_edge_cases(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """What the streams are said to be for is really in them, whatever models are bundled."""
    by_name = {script.name: script for script in scripts}
    tables = {word: ExportedTables(model) for word, model in models.items()}

    def pushes(name: str) -> list:
        return [push for part in by_name[name].parts for push in part.pushes]

    def edges(name: str) -> List[bool]:
        return [bool(tables[push.model].boundary[push.phoneme]) for push in pushes(name)]

    assert {push.phoneme for push in pushes("phonemes")} == set(range(len(models["speech"].phonemes)))
    assert {push.phoneme for push in pushes("laugh")} == set(range(len(models["laughter"].phonemes)))
    assert all(edges("vowels")) and not any(edges("consonants")) and not any(edges("queue"))
    assert len(pushes("queue")) > units.WINDOW + 2 * 20 + units.OVERLAP + 4  # LABIAL_QUEUE
    assert not len(frames["silent_zeros"]) and not len(frames["nothing"]) and len(frames["pauses"]) > 5 * units.WINDOW
    assert max(push.milliseconds for push in pushes("saturated")) > 65535
    assert any(part.cancel and part.cancel[0] == 0 for part in by_name["cancelled"].parts)
    turns = pushes("turns")
    assert len(turns) > 132 and all(one.model != other.model for one, other in zip(turns, turns[1:]))
    counts = {"speech": set(), "laughter": set()}
    for push in turns:
        counts[push.model].add(push.milliseconds // 20)
    assert all(min(found) < units.OVERLAP // 2 and max(found) > units.OVERLAP for found in counts.values())
    again = [(script.name, at) for script in scripts for part in script.parts for at, _ in part.again]
    assert {name for name, _ in again} == {"cancelled_twice"} and {0, 6, 14} <= {at for _, at in again}


def test_a_second_cancel_starts_from_the_pose_reached(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """The frames differ widely from those of an easing that begins anew from the pose of the first cancel."""
    motion = frames["cancelled_twice"]
    pose = motion[8]  # the last frame before the cancel
    moved = np.abs(pose).max()
    assert moved > 100 and np.abs(motion[14]).max() < 0.9 * moved  # six frames of easing later
    assert np.abs(motion[15] - motion[14]).max() < 0.05 * moved  # no jump back
    assert motion[21].any() and not motion[22].any()  # three, then five more


def test_one_model_is_cut_as_ever() -> None:
    """The cutting of several models' phonemes is the reference's own where there is only one."""
    rng = np.random.default_rng(5)
    for _ in range(300):
        frames = rng.integers(0, rng.choice([2, 6, 30, 90]), rng.integers(1, 60)).tolist()
        boundary = (rng.random(len(frames)) < rng.random()).tolist()
        assert [piece for piece, _ in mixed_pieces(frames, boundary, ["speech"] * len(frames))] == (
            units.pieces(frames, boundary))


def test_no_frame_is_in_three_pieces_whatever_the_models() -> None:
    """Pieces of two models follow each other without a gap, within the window, and share no more than half of each."""
    rng = np.random.default_rng(7)
    for _ in range(300):
        frames = rng.integers(0, rng.choice([2, 6, 30, 90]), rng.integers(1, 60)).tolist()
        boundary = (rng.random(len(frames)) < rng.random()).tolist()
        laughs = rng.random(len(frames)) < rng.choice([0.1, 0.5])
        names = np.where(laughs, "laughter", "speech").tolist()
        own = np.repeat(names, frames)
        found = mixed_pieces(frames, boundary, names)
        assert (found[-1][0].end if found else 0) == len(own)
        for (piece, name), (before, _) in zip(found, [(units.Piece(0, 0, 0, 0), ""), *found]):
            length = piece.end - piece.begin
            assert 0 < length <= units.WINDOW and piece.begin == before.end - piece.fade_in
            assert piece.fade_in == before.fade_out <= units.OVERLAP
            assert 2 * piece.fade_out <= length and piece.fade_in + piece.fade_out <= length
            assert (own[piece.begin : piece.end - piece.fade_out] == name).all()


@pytest.mark.parametrize("line, complaint", [
    ("speech QQ 20", "'QQ 20' is not a phoneme of speech_en and milliseconds"),
    ("speech AY -1", "'AY -1' is not a phoneme"),
    ("cancel 3", "'cancel 3' is not understood"),
    ("again 3 40", "'again 3 40' is not understood"),
    ("cancel 0 100\nagain 5 40", "the easing over 100 ms is done before its frame 5"),
    ("cancel 0 100\nagain 0 40\nagain 2 40", "the easing over 40 ms is done before its frame 2"),
    ("cancel 0 100\nspeech AY 20\nagain 0 40", "'again 0 40' is not understood"),
    ("turns AY 20", "turns need a number and a list of phonemes for each model"),
    ("turns 3: AY 20 | AY 20", "'AY 20' is not a phoneme of laughter_synthetic"),
    ("stream sentence", "a stream needs a name of its own"),
    ("stream first: again", "a stream needs a name of its own"),
])
def test_faults_in_streams_are_located(
    tmp_path: Path, models: Dict[str, ExportedModel], line: str, complaint: str
) -> None:
    path = tmp_path / "streams.txt"
    path.write_text(f"stream first: a reason\nspeech AY 20\n{line}\n")
    with pytest.raises(LabialError, match=f"streams.txt:{3 + line.count(chr(10))}: {complaint}"):
        read(path, models)


def test_the_digest_is_the_standard_one() -> None:
    """CRC-32 of the bytes that any language can make of the frames: little-endian, whatever the host."""
    assert digest(np.array([[0x3231, 0x3433, 0x3635, 0x3837]])) == 0x9AE0DAAF  # "12345678"
