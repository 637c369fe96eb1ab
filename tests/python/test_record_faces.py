"""Which face is the talker's, and heads that are turned too far: made-up tracks, whose truth is known; sound and
picture apart: known shifts of recorded motion are found, told, and undone by labial record --offset; the apex of a
phoneme, from the envelope of its sound: by itself, in `labial record` and in the reader of IEMOCAP."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import List, Optional

import numpy as np
import pytest

from labial.__main__ import main
from labial.capture.faces import head_angles, talker
from labial.capture.landmarks import USED, Given
from labial.capture.record import SURE, Lag, advice, estimate, record
from labial.corpus import Episode, Segment, read_corpus
from labial.corpus.apex import STEP, WINDOW, envelope, read_wave, with_apexes
from labial.corpus.iemocap import read_iemocap
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError
from labial.train import without_apex
from models import write_wav
from packages import SOURCE
from test_corpora import PHSEG
from test_corpora import face as captured
from test_corpora import write as write_utterance
from test_record import FACE, FRAMES, LAB, seen, talking, write

TIMES = np.arange(100) / 50


def face(x: float, height: float = 100.0, wobble: float = 0.0) -> np.ndarray:
    """(478, 3) landmarks of a face around (x, 200)."""
    points = np.zeros((478, 3), np.float32)
    for number, place in FACE.items():
        points[number] = place
    points[[n for n in range(478) if n not in FACE]] = (0, -28, 20)
    return points * (height / 180) + np.array([x + wobble, 200, 0], np.float32)


def tracked(seen: List[List[np.ndarray]], which: Optional[str] = None) -> np.ndarray:
    """(T,) where the face is that was taken, NaN without one."""
    points = talker("v.mp4", TIMES, seen, which)
    assert points.shape == (100, 478, 3)
    return np.asarray(points[:, 4, 0])


@pytest.mark.parametrize(("seen", "message"), [
    # A mouth that changes its owner in the middle of a sentence, and a voice that is trained on two people.
    ([[face(100)] + ([face(400)] if t >= 30 else []) for t in range(100)],
     "two faces, the second from 0.60 to 1.98 s: say with --face"),
    ([[face(100 if t < 60 else 400)] for t in range(100)], "two faces"),
    ([[] for _ in range(100)], "no face is found in any frame"),
], ids=["two", "a cut", "none"])  # fmt: skip
def test_faces_that_are_not_one_are_an_error(seen: List[List[np.ndarray]], message: str) -> None:
    with pytest.raises(DataError, match=f"v.mp4: {message}"):
        tracked(seen)


@pytest.mark.parametrize("seen", [
    [[face(100 + t)] if not 40 <= t < 50 else [] for t in range(100)],
    [[face(100), face(400, 40)] + ([face(300)] if t in (3, 4) else []) for t in range(100)],
    [[face(100), face(104)] for _ in range(100)],
], ids=["alone", "background and glimpses", "found twice"])  # fmt: skip
def test_one_face_is_taken_and_its_absence_kept(seen: List[List[np.ndarray]]) -> None:
    places = tracked(seen)
    assert np.isnan(places).tolist() == [not faces for faces in seen]
    for place, faces in zip(places, seen):
        assert not faces or abs(place - faces[0][4, 0]) <= 5


@pytest.mark.parametrize(("which", "place"), [("left", 100), ("right", 400), ("largest", 400)])
def test_the_face_that_was_asked_for_stays_itself(which: str, place: float) -> None:
    """In whatever order the tracker has them, and where one of them is lost for a while."""
    frames = []
    for t in range(100):
        faces = [face(100, 100), face(400, 120)]
        if 20 <= t < 25 or 60 <= t < 95:  # longer than a track lasts
            faces = faces[1:] if place == 100 else faces[:1]
        frames.append(faces[:: 1 if t % 2 else -1])
    places = tracked(frames, which)
    lost = np.isnan(places)
    assert lost[20:25].all() and lost[60:95].all() and lost.sum() == 40
    assert np.allclose(places[~lost], place, atol=1)


# ---- Turned heads --------------------------------------------------------------------------------------------------


def shaken(points: np.ndarray, yaw: np.ndarray, pitch: np.ndarray) -> np.ndarray:
    result = np.empty_like(points)
    for t, (a, b) in enumerate(np.radians(np.stack([yaw, pitch], axis=1))):
        about_y = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
        about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
        result[t] = points[t] @ (about_x @ about_y).T
    return result


def test_turns_are_those_of_the_head() -> None:
    """Catches axes that are exchanged: yaw turns x into z, pitch y into z; the face has no pitch of its own."""
    points = seen(np.zeros((3, 13)))
    found = head_angles(shaken(points, np.array([0, 25.0, 0]), np.array([0, 0, -15.0]))[:, list(USED)])
    assert np.allclose(abs(found[:, 0]), [0, 25, 0], atol=0.1) and np.allclose(abs(found[:, 1]), [0, 0, 15], atol=2)


def test_a_glance_aside_is_bridged_and_told_a_long_one_left_out(tmp_path) -> None:
    """Catches lips that are learnt from a profile: frames beyond the limit count as lost, those within do not."""
    points, faps = talking()
    flat = np.zeros(FRAMES)
    aside, away, nodding = flat.copy(), flat.copy(), flat.copy()
    aside[20:26] = 35.0
    away[20:60] = -35.0
    nodding[20:60] = 15.0
    write(tmp_path / "in", "a", LAB, landmarks=shaken(points, aside, nodding))
    write(tmp_path / "in", "b", LAB, landmarks=shaken(points, away, flat))
    with pytest.warns(UserWarning) as caught:
        said = record([tmp_path / "in"], tmp_path / "corpus", SPEECH, Given(), 0.0)
    texts = [str(item.message) for item in caught]
    assert any("a.npz: the head is turned too far from 0.40 to 0.50 s: by up to 3" in text for text in texts)
    assert any("b.npz: left out" in text for text in texts) and "1 left out" in said
    assert [file.name for file in sorted((tmp_path / "corpus").glob("*.csv"))] == ["a.csv"]


# ---- Sound and picture

ADDRESSES = SOURCE / "export" / "corpora" / "addresses"
#: What docs/record.md promises, seconds.
TOLERANCE = 0.010


def recording(name: str) -> List[Episode]:
    return [episode for episode in read_corpus(ADDRESSES) if f"_{name}_" in episode.name]


@pytest.mark.parametrize("name", ["gulf", "diwali", "weekly", "farewell"])
def test_a_known_shift_of_recorded_motion_is_found(name: str) -> None:
    """Catches a wrong sign or scale, a search that stops short, and closures that are lost among vowels."""
    episodes = recording(name)
    for shift in (-0.4, -0.12, 0.0, 0.08, 0.25):
        lag = estimate([replace(episode, times=episode.times + shift) for episode in episodes])
        assert abs(lag.seconds - shift) < TOLERANCE and lag.confidence >= SURE


def test_phonemes_of_another_sentence_are_not_trusted() -> None:
    """Catches a confidence that is there whatever the motion: each sentence's phonemes with the next one's lips."""
    episodes = recording("weekly")
    strangers = []
    for own, other in zip(episodes, [*episodes[1:], episodes[0]]):
        scale = (own.times[-1] - own.times[0]) / (other.times[-1] - other.times[0])
        strangers.append(replace(own, times=other.times * scale, frames=other.frames))
    assert estimate(strangers).confidence < SURE


def test_few_closures_tell_nothing() -> None:
    episode = recording("gulf")[0]
    vowels = [segment if segment.label not in "PBM" else replace(segment, label="T") for segment in episode.segments]
    lag = estimate([replace(episode, segments=tuple(vowels))])
    assert lag.closures == 0 and lag.confidence == 0.0
    assert advice(lag, 0.0) == ["sound and picture: 0 p, b, m are too few to tell whether they are together"]


def test_a_mouth_that_does_not_move_tells_nothing() -> None:
    """Catches a division by the opening's spread."""
    still = Episode("a", np.arange(100) / 50, np.zeros((100, 13)), tuple(
        Segment(k / 10, (k + 1) / 10, ("P", "AA")[k % 2]) for k in range(20)))
    lag = estimate([still])
    assert np.isfinite(lag.seconds) and "not to be relied on" in advice(replace(lag, confidence=0.0), 0.0)[0]


@pytest.mark.parametrize(("lag", "offset", "lines"), [
    (Lag(0.084, 0.99, 40), 0.0, ["the picture is 84 ms late", "--offset 84 brings"]),
    (Lag(-0.05, 0.95, 40), 0.02, ["the picture is 50 ms early", "--offset -30 brings"]),
    (Lag(0.001, 1.0, 40), 0.0, ["together, by 40 p, b, m"]),
    (Lag(0.012, 1.0, 40), 0.0, ["12 ms late"]),
    (Lag(0.2, 0.5, 6), 0.0, ["confidence 50%: not to be relied on"]),
])  # fmt: skip
def test_what_is_said(lag: Lag, offset: float, lines: List[str]) -> None:
    """Catches advice that forgets the offset that was already given, or follows what is not sure."""
    said = advice(lag, offset)
    assert len(said) == len(lines)
    for text, part in zip(said, lines):
        assert part in text


def test_record_tells_the_offset_and_undoes_it(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """The whole way: landmarks that are 84 ms late, what is said of them, and the corpus with what was said."""
    folder = tmp_path / "in"
    for episode in recording("gulf"):
        with zipfile.ZipFile(ADDRESSES / "episodes.zip") as packed:
            packed.extract(f"{episode.name}.lab", folder)
        np.savez(folder / f"{episode.name}.npz", landmarks=seen(episode.frames), times=episode.times + 0.084)
    assert main(["record", str(folder), "-o", str(tmp_path / "late")]) == 0
    said = capsys.readouterr().out.splitlines()[-1]
    assert said.startswith("--offset ")
    offset = float(said.split()[1])
    assert abs(offset - 84) < 1000 * TOLERANCE
    assert main(["record", str(folder), "-o", str(tmp_path / "right"), "--offset", str(offset)]) == 0
    assert "--offset" not in capsys.readouterr().out
    late, right = (read_corpus(tmp_path / name)[0] for name in ("late", "right"))
    assert np.allclose(late.times[-1] - right.times[-1], offset / 1000, atol=0.002) and right.times[0] >= 0
    assert main(["record", str(folder), "-o", str(tmp_path / "far"), "--offset", "9000"]) == 1
    short = folder / "talker_a_gulf_04.npz"
    assert main(["record", str(short), "-o", str(tmp_path / "far"), "--offset", "4999"]) == 1
    error = capsys.readouterr().err
    assert "an offset of 9000 ms is not within -5000 .. 5000" in error and "shorter than the offset" in error


# ---- Apexes ----------------------------------------------------------------------------------------------------------


RATE = 16000


def sound(*loud: float, seconds: float = 3.0) -> np.ndarray:
    """A tone that swells within 60 ms around each of the moments `loud`, over a faint one."""
    times = np.arange(int(seconds * RATE)) / RATE
    swell = sum(np.exp(-(((times - moment) / 0.02) ** 2)) for moment in loud)
    return (0.02 + swell) * np.sin(2 * np.pi * 150 * times)


def save(path: Path, samples: np.ndarray, channels: int = 1, width: int = 2) -> Path:
    whole = np.rint(samples / 1.1 * 32767 * 256 ** (width - 2))
    return write_wav(path, np.stack([whole] * channels, axis=1), RATE, width)


def test_the_envelope_is_the_moving_root_mean_square() -> None:
    """Against the definition, sample by sample; would catch a window that is shifted, or not divided by its sum."""
    samples = np.random.default_rng(1).normal(0, 1, 2000)
    found = envelope(samples, RATE)
    half = round(WINDOW * RATE) // 2
    window = np.hanning(2 * half + 2)[1:-1]
    for i in range(len(found)):
        at = round(i * STEP * RATE)
        square = [samples[at + j] ** 2 * window[j + half] for j in range(-half, half) if 0 <= at + j < len(samples)]
        assert found[i] == pytest.approx(np.sqrt(np.sum(square) / window.sum()), rel=0.02)
    assert len(found) == 25


def test_the_loudest_moment_of_each_segment_is_its_apex() -> None:
    """Within its own bounds; what has an apex keeps it; where nothing sounds, or nothing changes, there is none."""
    segments = (Segment(0.0, 0.5, "SIL"), Segment(0.5, 0.8, "AA"), Segment(0.8, 1.0, "P", 0.9), Segment(1.0, 1.5, "IY"),
                Segment(1.5, 1.501, "T"), Segment(2.5, 4.0, "SIL"), Segment(4.0, 5.0, "K"))
    samples = sound(0.6, 1.02)
    samples[int(2.5 * RATE):] = 0.0
    found = [segment.apex for segment in with_apexes(segments, samples, RATE)]
    assert found[1] == pytest.approx(0.6, abs=0.0051) and found[2] == 0.9
    assert found[3] == pytest.approx(1.02, abs=0.0051)
    assert found[5] == pytest.approx(2.5, abs=WINDOW) and found[6] is None
    assert with_apexes(segments[:1], np.zeros(RATE), RATE) == segments[:1]


def test_waves_are_read_or_named(tmp_path: Path) -> None:
    for channels in (1, 2):
        samples, rate = read_wave(save(tmp_path / "a.wav", sound(0.5), channels))
        assert rate == RATE and np.abs(samples / 32767 * 1.1 - sound(0.5)).max() < 1e-3
    path = save(tmp_path / "a.wav", sound(0.5), width=4)
    for content, message in ((path.read_bytes(), "32 bits"), (b"RIFF", "not a WAV file"), (b"", "not a WAV file")):
        path.write_bytes(content)
        with pytest.raises(DataError, match=f"a.wav: .*{message}"):
            read_wave(path)
    with pytest.raises(DataError, match="missing.wav: No such file"):
        read_wave(tmp_path / "missing.wav")


def test_record_takes_the_apex_from_the_sound_beside(tmp_path: Path) -> None:
    """A sound of the recording's name; without one the middle is taken, and the summary says so."""
    points, _ = talking()
    lab = "0 1 SIL\n1 1.4 AA\n1.4 1.5 P\n1.5 2 IY\n2 3 SIL\n"
    path = write(tmp_path / "in", landmarks=points, lab=lab)
    summary = record([path], tmp_path / "without", SPEECH, Given(), 12.0)
    assert "apex: the loudest moment of 0 of 5 phonemes; of the others, whose sound is not known, the middle" in summary
    (episode,) = read_corpus(tmp_path / "without")
    assert without_apex([episode]) == ["apex: not known of 5 of 5 phonemes, which are learnt from their middle"]
    save(tmp_path / "in" / "a.wav", sound(1.1, 1.9))
    summary = record([path], tmp_path / "with", SPEECH, Given(), 12.0)
    assert "apex: the loudest moment of 5 of 5 phonemes" in summary and "not known" not in summary
    (episode,) = read_corpus(tmp_path / "with")
    assert episode.segments[1].apex == pytest.approx(1.1, abs=0.0051)
    assert episode.segments[3].apex == pytest.approx(1.9, abs=0.0051)
    assert without_apex([episode]) == []


def test_iemocap_takes_the_apex_from_its_sounds(tmp_path: Path) -> None:
    """The utterance's own; one without a sound has none."""
    for utterance in ("Ses01F_impro01_F000", "Ses01F_impro01_F001"):
        write_utterance(tmp_path, utterance, captured([]), PHSEG)
    folder = tmp_path / "Session1" / "sentences" / "wav" / "Ses01F_impro01"
    folder.mkdir(parents=True)
    save(folder / "Ses01F_impro01_F000.wav", sound(1.3, seconds=2.0))
    first, second = read_iemocap(tmp_path)
    assert first.segments[1].label == "AA" and first.segments[1].apex == pytest.approx(1.3, abs=0.0051)
    assert [segment.apex for segment in second.segments] == [None] * len(second.segments)
