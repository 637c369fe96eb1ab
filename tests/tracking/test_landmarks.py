"""labial landmarks with MediaPipe itself, on a photographed face whose mouth and head are drawn frame by frame."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Sequence, Tuple

import av
import cv2
import mediapipe
import numpy as np
import pytest
import skimage
import soundfile
from scipy.spatial import Delaunay

from labial.__main__ import main
from labial.capture.landmarks import INDEX, Given, read_landmarks
from labial.corpus import read_corpus
from labial.sound.samples import RATE, read_sound
from labial.sound.video import pictures

# The photograph is scikit-image's astronaut (NASA, public domain). MediaPipe's landmarks of it are a mesh in depth,
# which is turned, whose lower lip and chin are moved, and on which the photograph is drawn again triangle by triangle.

SIZE = 512  # pixels of a picture's sides
_LOWER_INNER = (95, 88, 178, 87, 14, 317, 402, 318, 324)
_UPPER = 13


@cache
def mesh() -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Photograph, (N, 3) vertices in pixels of which 468 are landmarks, (M, 3) triangles, and (N,) how far a vertex
    goes with the jaw, 0 .. 1."""
    picture = cv2.imread(str(Path(skimage.__file__).parent / "data" / "astronaut.png"))[0:256, 128:384]
    picture = cv2.resize(picture, (SIZE, SIZE), interpolation=cv2.INTER_CUBIC)
    with mediapipe.solutions.face_mesh.FaceMesh(static_image_mode=True) as tracker:
        found = tracker.process(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB)).multi_face_landmarks[0]
    points = np.array([(p.x, p.y, p.z) for p in found.landmark]) * SIZE
    middle = points.mean(axis=0)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = [(middle[0] + 1.0 * 130 * np.cos(a), middle[1] + 1.25 * 130 * np.sin(a), middle[2] + 60) for a in angles]
    edge = [(x, y, 0) for x in np.linspace(0, SIZE - 1, 5) for y in np.linspace(0, SIZE - 1, 5)
            if x in (0, SIZE - 1) or y in (0, SIZE - 1)]
    vertices = np.concatenate([points, ring, edge])
    left, right = points[78], points[308]
    line = left[1] + (vertices[:, 0] - left[0]) / (right[0] - left[0]) * (right[1] - left[1])
    across = (vertices[:, 0] - (left[0] + right[0]) / 2) / (right[0] - left[0])
    jaw = np.clip((vertices[:, 1] - line - 4) / 12, 0, 1) * np.exp(-(across**2) / 0.5)
    profile = np.clip(1 - (2 * across) ** 2, 0, 1)
    jaw[list(_LOWER_INNER)] = profile[list(_LOWER_INNER)]
    jaw[468:] = 0
    return picture, vertices, Delaunay(vertices[:, :2]).simplices, jaw


@cache
def draw(opening: float, yaw: float = 0.0) -> np.ndarray:
    """(SIZE, SIZE, 3) BGR: the face with its lips `opening` pixels apart, 0 closed, turned aside by degrees."""
    picture, rest, triangles, jaw = mesh()
    moved = rest.copy()
    moved[:, 1] += jaw * (opening - (rest[14, 1] - rest[_UPPER, 1]))
    head = slice(0, len(rest) - 16)
    a = np.radians(yaw)
    about_y = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    pivot = rest[:468].mean(axis=0) + (0, 0, 80)
    moved[head] = (moved[head] - pivot) @ about_y.T + pivot
    result = picture.copy()
    for corners in triangles[np.argsort(-moved[triangles, 2].mean(axis=1))]:  # the farthest first
        source, target = rest[corners, :2].astype(np.float32), moved[corners, :2].astype(np.float32)
        x, y, width, height = cv2.boundingRect(target)
        x, y = max(x, 0), max(y, 0)
        width, height = min(width, SIZE - x), min(height, SIZE - y)
        if width <= 0 or height <= 0:
            continue
        shift = np.float32([x, y])
        matrix = cv2.getAffineTransform(source, target - shift)
        patch = cv2.warpAffine(picture, matrix, (width, height), borderMode=cv2.BORDER_REPLICATE)
        mask = np.zeros((height, width), np.uint8)
        cv2.fillConvexPoly(mask, np.int32(np.round((target - shift) * 16)), 1, shift=4)
        result[y : y + height, x : x + width][mask > 0] = patch[mask > 0]
    return result


def write(path: Path, pictures: Sequence[np.ndarray], fps: int, codec: str = "", samples: Sequence[int] = (),
          rate: int = 16000, late: float = 0.0) -> Path:
    """A video of these pictures (BGR), with a sound that begins so many seconds later if it has a codec."""
    path.parent.mkdir(exist_ok=True)
    with av.open(str(path), "w") as out:
        stream = out.add_stream("mpeg4", rate=Fraction(fps))
        stream.height, stream.width = pictures[0].shape[:2]
        stream.bit_rate, stream.pix_fmt = 8_000_000, "yuv420p"
        sound = out.add_stream(codec, rate=rate, layout="mono") if codec else None
        for picture in pictures:
            out.mux(stream.encode(av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="bgr24")))
        out.mux(stream.encode())
        if sound:
            frame = av.AudioFrame.from_ndarray(np.array(samples, np.int16)[None], format="s16", layout="mono")
            frame.sample_rate, frame.pts = rate, round(late * rate)
            out.mux(sound.encode(frame))
            out.mux(sound.encode())
    return path


# ---- The tests -------------------------------------------------------------------------------------------------------


SECONDS = 2.4
STILL = 0.6  # seconds with closed lips, at both ends


def openings(fps: int) -> np.ndarray:
    """Pixels in each frame: closed lips, which open and close four times, and closed lips."""
    times = np.arange(round(SECONDS * fps)) / fps
    talk = (times >= STILL) & (times < SECONDS - STILL)
    return np.where(talk, 14 * (1 - np.cos(2 * np.pi * (times - STILL) / 0.3)), 0).round().astype(int)


def tracked(path: Path, *options: str) -> int:
    return main(["landmarks", str(path), "-o", str(path.with_suffix(".npz")), "--quiet", *options])


def lips(path: Path) -> Tuple[np.ndarray, np.ndarray]:
    """Times, and pixels between the outer lips."""
    found = read_landmarks(path.with_suffix(".npz"), Given())
    return found.times, found.points[:, INDEX[17], 1] - found.points[:, INDEX[0], 1]


@pytest.mark.parametrize("fps", [25, 60])
def test_the_lips_are_found_where_they_were_drawn(tmp_path: Path, fps: int) -> None:
    """Catches pictures in wrong colours, order or time, axes that are exchanged, and a tracker that lags."""
    path = write(tmp_path / "a.mp4", [draw(o) for o in openings(fps)], fps)
    assert tracked(path) == 0
    times, found = lips(path)
    assert len(times) == round(SECONDS * fps) and np.allclose(times, np.arange(len(times)) / fps, atol=1e-3)
    told = openings(fps)
    assert np.corrcoef(found, told)[0, 1] > 0.97
    lags = range(-round(fps / 10), round(fps / 10) + 1)
    assert max(lags, key=lambda lag: np.corrcoef(np.roll(found, -lag), told)[0, 1]) == 0
    assert found[told == 28].mean() - found[told == 0].mean() > 14  # of 28 pixels; the tracker holds lips together


def test_a_corpus_comes_of_it(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """landmarks, then record: FAPs at the video's own rate, closed where the lips were drawn closed."""
    path = write(tmp_path / "in" / "a.mp4", [draw(o) for o in openings(25)], 25)
    assert tracked(path) == 0
    end = SECONDS - STILL
    path.with_suffix(".lab").write_text(f"0 {STILL} SIL\n{STILL} {end} AA\n{end} {SECONDS} SIL\n")
    assert main(["record", str(tmp_path / "in"), "-o", str(tmp_path / "corpus"), "--cutoff", "0"]) == 0
    (episode,) = read_corpus(tmp_path / "corpus")
    opening = -episode.frames[:, 3] - episode.frames[:, 4]
    told = openings(25)
    assert len(opening) == len(told) and np.corrcoef(opening, told)[0, 1] > 0.97
    assert abs(opening[told == 0]).max() < 0.25 * opening.max()


def test_a_turned_head_is_told_by_record(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """What MediaPipe says of a head that was drawn turned by 40 degrees is beyond the limit, of 10 degrees within."""
    plan = [0] * 30 + [10] * 8 + [0] * 12 + [40] * 4 + [0] * 6
    path = write(tmp_path / "in" / "a.mp4", [draw(0, yaw) for yaw in plan], 25)
    assert tracked(path) == 0
    path.with_suffix(".lab").write_text("0 2.4 SIL\n")
    assert main(["record", str(tmp_path / "in"), "-o", str(tmp_path / "corpus")]) == 0
    error = capsys.readouterr().err
    assert "turned too far from 2.00 to 2.1" in error and error.count(" to ") <= 3


def test_two_faces_and_none(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """The talker on the left opens its mouth, the face on the right does not; for half a second both are gone."""
    told = openings(25)
    empty = np.full((512, 1024, 3), 128, np.uint8)
    both = [np.concatenate([draw(o), draw(0)], axis=1) if not 20 <= t < 32 else empty for t, o in enumerate(told)]
    path = write(tmp_path / "a.mp4", both, 25)
    assert tracked(path) == 1
    assert "a.mp4: two faces, the second from 0.00 to" in capsys.readouterr().err
    assert not path.with_suffix(".npz").exists()
    for face, moves in (("left", True), ("right", False)):
        assert tracked(path, "--face", face) == 0
        assert "12 without the face, from 0.80 to 1.24 s" in capsys.readouterr().out
        _, found = lips(path)
        there = np.isfinite(found)
        assert np.ptp(found[there]) > 14 if moves else np.ptp(found[there]) < 6


def test_what_is_no_video_or_has_no_face(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    def fails(message: str, *options: str) -> None:
        assert tracked(path, *options) == 1
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1, error

    path = tmp_path / "a.mp4"
    fails("a.mp4: not a video")
    path.write_bytes(b"\0\0\0\x20ftypisom" + os.urandom(400))
    fails("a.mp4: not a video")
    soundfile.write(tmp_path / "a.wav", np.zeros(1000), 8000)
    path = tmp_path / "a.wav"
    fails("a.wav: no picture, only sound")
    grey = [np.full((128, 128, 3), 128, np.uint8)] * 5
    path = write(tmp_path / "b.mp4", grey, 25)
    fails("b.mp4: no face is found in any frame")
    path = write(tmp_path / "c.mp4", grey[:1], 25)
    fails("c.mp4: fewer than two frames")
    fails("no.task: no such file", "--task", "no.task")
    (tmp_path / "bad.task").write_bytes(b"x" * 99)
    fails("bad.task: not a model of MediaPipe", "--task", str(tmp_path / "bad.task"))


def test_sound_and_picture_are_on_one_clock(tmp_path: Path) -> None:
    """A video whose sound begins later than its picture, as some cameras write them: catches a sound from its own
    first sample on, which would be early."""
    rate, late = 16000, 0.3
    click = np.zeros(rate, np.int16)
    click[rate // 2 : rate // 2 + 160] = 20000
    levels = [np.full((64, 64, 3), 200 if number == 20 else 20, np.uint8) for number in range(40)]
    path = write(tmp_path / "a.mkv", levels, 25, "pcm_s16le", click, rate, late)
    samples = read_sound(path)
    assert abs(np.argmax(samples) / RATE - (0.5 + late)) < 0.005 and abs(len(samples) / RATE - 1.3) < 0.01
    flash = max(pictures(path), key=lambda item: item[1].mean())[0]
    assert abs(flash - 0.8) < 0.001


SENTENCES = ("My baby may be happy when we play by the pool.",
             "Put the butter on the table, and pour me a cup of coffee.",
             "Thank you very much for your visit, and have a pleasant journey home.",
             "Bob may bring a map of the village and five more apples.",
             "Every Friday my father makes a warm bowl of soup for the family.")


def speaking(path: Path, sentence: str) -> None:
    """A video of the face that says `sentence`, its mouth as open as flite is loud, and the sentence beside it."""
    sound = path.with_suffix(".wav")
    subprocess.run(["flite", "-t", sentence, "-o", str(sound)], check=True)
    samples, rate = soundfile.read(sound, dtype="int16")
    loud = np.array([np.abs(part.astype(float)).mean() for part in np.array_split(samples, len(samples) * 25 // rate)])
    write(path, [draw(2 * round(13 * level)) for level in np.sqrt(loud / loud.max())], 25, "aac", samples, rate)
    sound.unlink()
    path.with_suffix(".txt").write_text(sentence)


@pytest.mark.skipif(not shutil.which("flite"), reason="needs the Debian package flite")
def test_the_five_commands_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first block of docs/record.md as it stands there, the first two lines for each of the videos."""
    page = (Path(os.environ["LABIAL_SOURCE"]) / "docs" / "record.md").read_text(encoding="utf-8")
    lines = page.split("```sh\n")[1].split("```")[0].splitlines()
    assert [line.split()[1] for line in lines] == ["landmarks", "align", "record", "train", "page"]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "recordings").mkdir()
    names = [f"s{number:02}" for number in range(1, 1 + len(SENTENCES))]
    for name, sentence in zip(names, SENTENCES):
        speaking(tmp_path / "recordings" / f"{name}.mp4", sentence)
    for line in lines[:2]:
        for name in names:
            assert main(shlex.split(line.replace("s01", name))[1:]) == 0
    for line in lines[2:]:
        assert main(shlex.split(line)[1:]) == 0
    assert "data:audio/mp4" in (tmp_path / "me.html").read_text(encoding="utf-8")
    assert len(read_corpus(tmp_path / "corpus")) == len(SENTENCES)
