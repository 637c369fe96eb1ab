"""Hearing judged by lips that were measured in video: figures worked by hand, synthetic sound and lips, wrong files,
and the clips in the repository."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.errors import DataError
from labial.evaluate import real_lips
from labial.evaluate.real_lips import Clip, Group
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.files.frames import write_csv
from labial.hearing.features import FLOOR, RATE, log_energies
from labial.hearing.model import load, save
from models import random_hearing
from packages import SOURCE, needs_runtime

pytestmark = needs_runtime

JAW, UPPER, LOWER, LEFT, RIGHT = (FAP_NUMBERS.index(number) for number in (3, 51, 52, 53, 54))
LAB = "0 0.5 SIL\n0.5 0.7 M\n0.7 1.5 AA\n1.5 2 SIL\n"
CORPORA = SOURCE / "export" / "corpora"


def lips(one: List[float], talker: str, speech: List[int]) -> Clip:
    """A clip whose channels all follow the same values."""
    frames = np.zeros((len(one), CHANNELS))
    frames[:, JAW] = frames[:, LEFT] = frames[:, RIGHT] = frames[:, UPPER] = one
    frames[:, LOWER] = np.array(one) ** 2
    energies = np.full((2 * len(one), 24), FLOOR, np.float32)
    return Clip(talker, energies, frames, [("AA", 20 * len(one))], np.array(speech, dtype=bool))


def test_figures_by_hand() -> None:
    """Only frames of speech count, each clip is centred, a talker's frames are pooled and talkers count alike."""
    clips = [lips([1, 2, 3, 90], "a", [1, 1, 1, 0]), lips([5, 7], "a", [1, 1]), lips([1, 2, 3], "b", [1, 1, 1])]
    shown = {id(clips[0]): [4.0, 5.0, 6.0, 0.0], id(clips[1]): [9.0, 5.0], id(clips[2]): [6.0, 4.0, 2.0]}

    def method(clip: Clip) -> np.ndarray:
        return lips(shown[id(clip)], "", []).real

    (row,) = real_lips.evaluated([Group("two", clips)], {"made up": method})
    # a: products 1 + 0 + 1 - 2 - 2, squares 2 + 2 and 2 + 8; b: the other way round
    a, b = -2 / np.sqrt(4 * 10), -1.0
    assert (row.talkers, row.clips, row.seconds, row.method) == (2, 3, pytest.approx(8 / 50), "made up")
    assert (row.jaw, row.upper, row.corners) == pytest.approx([(a + b) / 2] * 3)
    real, heard = ([np.array(x) ** 2.0 for x in side] for side in (([1, 2, 3], [5, 7]), ([4, 5, 6], [9, 5])))
    pooled = [np.concatenate([x - x.mean() for x in side]) for side in (real, heard)]
    third = np.corrcoef([1.0, 4.0, 9.0], [36.0, 16.0, 4.0])[0, 1]
    assert row.lower == pytest.approx((np.corrcoef(*pooled)[0, 1] + third) / 2)
    assert row.five == pytest.approx(np.mean([row.opening, row.jaw, row.upper, row.lower, row.corners]))
    lines = real_lips.table([row]).splitlines()
    assert len(lines) == 3 and all(line.count("|") == 12 for line in lines) and f"{row.jaw:.3f}" in lines[2]


def test_the_opening_grows_as_lips_part() -> None:
    """The upper lip's FAP is how far it is lowered, the lower one's how far it is raised. What does not move has no
    correlation."""
    frames = np.zeros((1, CHANNELS))
    frames[0, [UPPER, LOWER, JAW, LEFT, RIGHT]] = -10, -30, 5, 2, 3
    assert real_lips.channels(frames).tolist() == [[40, 5, -10, -30, 5]]
    assert np.isnan(real_lips.correlations([(np.ones((4, 2)), np.ones((4, 2)))])).all()


# ---- Folders


def voice(seed: int) -> np.ndarray:
    """(32000,) int16: 2 s of noise that swells."""
    random = np.random.default_rng(seed)
    swell = 1 + np.sin(np.arange(2 * RATE) * 2 * np.pi * 2.5 / RATE)
    return (random.normal(size=2 * RATE) * swell * 2000).astype(np.int16)


def write_episode(folder: Path, name: str, seed: int) -> np.ndarray:
    """An episode without its sound, whose opening follows the loudness of :func:`voice`; the sound."""
    folder.mkdir(exist_ok=True)
    level = np.sin(np.arange(100) * 2 * np.pi * 2.5 / 50)
    frames = np.random.default_rng(seed).normal(scale=3, size=(100, CHANNELS))
    frames[:, JAW] += 100 * level
    frames[:, LOWER] -= 100 * level
    with open(folder / f"{name}.csv", "w") as out:
        write_csv(out, frames, 50, 0.01)
    (folder / f"{name}.lab").write_text(LAB)
    return voice(seed)


def write_energies(path: Path, members: Dict[str, Any]) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for name, value in members.items():
            data = io.BytesIO()
            if isinstance(value, bytes):
                data.write(value)
            else:
                np.save(data, value)
            archive.writestr(name, data.getvalue())


def test_loudness_follows_lips_that_follow_loudness(tmp_path: Path) -> None:
    """From energies; an episode without sound is left out; what lies on the other side has the other sign."""
    folder = tmp_path / "corpus"
    sound = write_episode(folder, "a", 1)
    write_episode(folder, "unheard", 2)
    write_energies(folder / "energies.npz", {"a.npy": log_energies(sound).astype(np.float16)})
    found = real_lips.group([folder])
    (clip,) = found.clips
    assert found.name == "corpus" and clip.talker == "corpus" and clip.real.shape == (100, 13)
    assert np.flatnonzero(clip.speech).tolist() == list(range(25, 75))
    rows = {row.method: row for row in real_lips.evaluated([found], real_lips.methods(random_hearing(3)))}
    assert set(rows) == {"network", "integers", "loudness", "phonemes", "phonemes and sound"}
    loud = rows["loudness"]
    assert min(loud.opening, loud.jaw, loud.lower) > 0.9 and max(abs(loud.upper), abs(loud.corners)) < 0.3
    assert rows["integers"][5:] == pytest.approx(rows["network"][5:], abs=0.03)
    assert abs(rows["network"].opening) < 0.9
    other = found._replace(clips=[clip._replace(real=-clip.real)])
    (row,) = real_lips.evaluated([other], {"loudness": real_lips.methods(random_hearing(3))["loudness"]})
    assert row.opening == pytest.approx(-loud.opening)


def test_sounds_beside_episodes_are_heard_as_their_energies(tmp_path: Path) -> None:
    """The figures are the same from a sound and from its energies: silence follows both."""
    soundfile = pytest.importorskip("soundfile")
    pytest.importorskip("soxr")
    heard, kept = tmp_path / "heard", tmp_path / "kept"
    for folder in (heard, kept):
        sound = write_episode(folder, "a", 1)
    soundfile.write(str(heard / "a.wav"), sound, RATE, subtype="PCM_16")
    write_energies(kept / "energies.npz", {"a.npy": log_energies(sound)})
    methods = real_lips.methods(random_hearing(3))
    one, other = real_lips.evaluated([real_lips.group([heard]), real_lips.group([kept])],
                                     {"integers": methods["integers"]})
    assert one[5:] == pytest.approx(other[5:], abs=2e-3) and np.isfinite(one.opening)


GOOD = np.full((200, 24), 9.0, np.float16)


@pytest.mark.parametrize("members, message", [
    ({"b.npy": GOOD}, "'b.npy' is not the energies of an episode"),
    ({"a.txt": GOOD}, "'a.txt' is not the energies of an episode"),
    ({"a.npy": GOOD[:, :5]}, r"a.npy has shape \(200, 5\)"),
    ({"a.npy": GOOD.astype(np.int16)}, "type int16"),
    ({"a.npy": GOOD[:198]}, "a.npy has 198 rows; a takes an even number, at least 200"),
    ({"a.npy": np.full((201, 24), 9.0, np.float16)}, "201 rows"),
    ({"a.npy": np.full((200, 24), np.nan, np.float16)}, "not within 1 .. 48"),
    ({"a.npy": np.full((200, 24), np.inf, np.float16)}, "not within 1 .. 48"),
    ({"a.npy": GOOD * 0}, "not within 1 .. 48"),
    ({"a.npy": np.array([None])}, "a.npy"),
    ({"a.npy": b"text"}, "a.npy is no array"),
    ({}, "no episode has its sound"),
])
def test_wrong_energies_are_refused(tmp_path: Path, members: Dict[str, Any], message: str) -> None:
    folder = tmp_path / "corpus"
    write_episode(folder, "a", 1)
    write_energies(folder / "energies.npz", members)
    with pytest.raises(DataError, match=message) as error:
        real_lips.group([folder])
    assert str(error.value).startswith(str(folder))


def test_errors_name_the_file_and_the_line(tmp_path: Path) -> None:
    folder = tmp_path / "corpus"
    write_episode(folder, "a", 1)
    with pytest.raises(DataError, match="corpus: no episode has its sound"):
        real_lips.group([folder])
    (folder / "energies.npz").write_text("text")
    with pytest.raises(DataError, match="energies.npz: .*damaged"):
        real_lips.group([folder])
    lines = (folder / "a.csv").read_text().splitlines(keepends=True)
    (folder / "a.csv").write_text("".join([*lines[:7], "0.13,x\n", *lines[8:]]))
    with pytest.raises(DataError, match="a.csv:8: "):
        real_lips.group([folder])
    with pytest.raises(DataError, match="none: no such folder"):
        real_lips.group([tmp_path / "none"])


# ---- The command


def cells(text: str) -> List[List[str]]:
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()[2:]]


def test_the_command_judges_by_lips(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Groups and methods in their order, and what does not go together."""
    for name in ("one", "two"):
        sound = write_episode(tmp_path / name, "a", 1)
        write_energies(tmp_path / name / "energies.npz", {"a.npy": log_energies(sound)})
    save(random_hearing(3), tmp_path / "hear.npz")
    given = ["evaluate-hear", str(tmp_path / "hear.npz"), "--methods", "loudness,phonemes"]
    one, two = (str(tmp_path / name) for name in ("one", "two"))
    assert main([*given, "--lips", one, two, "--lips", two, "-o", str(tmp_path / "table.md")]) == 0
    found = cells((tmp_path / "table.md").read_text())
    assert [row[:2] for row in found] == [[group, name] for group in ("one+two", "two") for name in
                                          ("loudness", "phonemes")]
    assert [row[-3:-1] for row in found] == [["2", "2"], ["2", "2"], ["1", "1"], ["1", "1"]]
    for more, message in ((["--conditions", "clean"], "--conditions does not go with --lips"),
                          (["--most", "3"], "--most does not go with --lips"),
                          (["--methods", "headaudio"], "'headaudio' is not one of network")):
        assert main([*given, "--lips", one, *more]) == 1 and message in capsys.readouterr().err
    assert main([given[0], given[1], one, "--lips", one]) == 1
    assert "FOLDER does not go with --lips" in capsys.readouterr().err


# ---- The clips in the repository


@pytest.fixture(scope="module")
def groups() -> Tuple[Group, Group]:
    return (real_lips.group([CORPORA / "grid_singles", CORPORA / "grid_more"]),
            real_lips.group([CORPORA / "addresses"]))


def test_the_clips_are_complete(groups: Tuple[Group, Group]) -> None:
    """81 clips of 11 people; their speech is louder than the rest of the sound, which a sound that belongs to another
    clip, or lies elsewhere, is not."""
    assert [(len(item.clips), len({clip.talker for clip in item.clips})) for item in groups] == [(65, 9), (16, 2)]
    for clip in (clip for item in groups for clip in item.clips):
        loud = clip.energies[: 2 * len(clip.speech)].mean(axis=1).reshape(-1, 2).mean(axis=1)
        assert loud[clip.speech].mean() > loud[~clip.speech].mean() + 1.0


@pytest.mark.slow
def test_bundled_networks_are_nearer_to_real_lips_than_loudness(groups: Tuple[Group, Group]) -> None:
    """Catches sound and lips that are out of step, and lips upside down: 100 ms later the correlation falls by a
    third."""
    for name in ("hear_large", "hear_small"):
        own = real_lips.methods(load(SOURCE / "export" / "models" / f"{name}.npz"))
        judged = {"integers": own["integers"], "loudness": own["loudness"],
                  "late": lambda clip, heard=own["integers"]: np.roll(heard(clip), 5, axis=0)}
        for item in groups:
            rows = {row.method: row for row in real_lips.evaluated([item], judged)}
            assert rows["integers"].opening > 0.6 and rows["integers"].five > 0.58
            assert rows["integers"].five > 2 * rows["loudness"].five
            assert rows["late"].opening < 0.67 * rows["integers"].opening
