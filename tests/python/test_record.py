"""Recording a corpus: synthetic faces whose FAPs are known in closed form, moved about as heads are, in all file forms.

The face below is drawn up for these tests: y down, z away from the camera, lengths in its own unit. Its mouth-nose
separation is 20 and its mouth width 50, so that 1 unit is 1024/20 FAP units up and down and 1024/50 sideways.
"""

from __future__ import annotations

import numpy as np
import pytest

from labial.__main__ import main
from labial.capture.landmarks import USED, Given, parse_size, read_landmarks
from labial.capture.record import record
from labial.corpus import read_corpus
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError, LabialError
from labial.files.faps import FAP_NUMBERS

FACE = {
    33: (-45, -60, 40), 133: (-16, -58, 36), 362: (16, -58, 36), 263: (45, -60, 40), 168: (0, -64, 24), 6: (0, -56, 20),
    197: (0, -46, 13), 195: (0, -38, 8), 151: (0, -98, 26), 10: (0, -118, 30), 4: (0, -24, 0), 2: (0, -10, 12),
    0: (0, 2, 14), 13: (0, 9, 15), 14: (0, 11, 16), 17: (0, 22, 17), 61: (-25, 10, 28), 291: (25, 10, 28),
    39: (-13, 4, 18), 269: (13, 4, 18), 181: (-12, 20, 20), 405: (12, 20, 20), 152: (0, 62, 30),
}  # fmt: skip
UP, SIDE = 1024 / 20, 1024 / 50
FPS, FRAMES = 50, 150
LAB = "0.0 1.0 SIL\n1.0 1.4 AA1 1.2 hah\n1.4 1.5 P\n1.5 2.0 IY\n2.0 3.0 sil\n"
TALK = slice(50, 100)


def bump(scale: float, phase: float = 0.0) -> np.ndarray:
    """(FRAMES,) 0 in the silences, in between a wave of this height."""
    wave = np.zeros(FRAMES)
    wave[TALK] = scale * np.sin(np.linspace(0, 3 * np.pi, 50) + phase) * np.hanning(50)
    return wave


def seen(frames):
    """(T, 478, 3) landmarks of a still head with these (T, 13) FAPs; FAP 17 goes into the depth of the upper lip."""
    fap = dict(zip(FAP_NUMBERS, frames.T))
    points = np.zeros((len(frames), 478, 3))
    for landmark, place in FACE.items():
        points[:, landmark] = place
    for landmark, axis, moved in (
        (152, 1, fap[3] / UP), (17, 2, -fap[16] / UP), (0, 2, -fap[17] / UP), (0, 1, fap[51] / UP),
        (17, 1, -fap[52] / UP), (291, 0, fap[53] / SIDE), (61, 0, -fap[54] / SIDE), (269, 1, fap[55] / UP),
        (39, 1, fap[56] / UP), (405, 1, -fap[57] / UP), (181, 1, -fap[58] / UP), (291, 1, -fap[59] / UP),
        (61, 1, -fap[60] / UP),
    ):  # fmt: skip
        points[:, landmark, axis] += moved
    return points


def talking():
    """(FRAMES, 478, 3) landmarks of a head that is still, and their (FRAMES, 13) FAPs. Of FAP 17 they hold
    nothing; it follows from the corners."""
    order = (3, 52, 16, 51, 53, 54, 55, 56, 57, 58, 59, 60)
    fap = {number: (UP if number in (3, 51, 55, 56) else -UP) * bump(1 + 0.3 * k, 0.4 * k)
           for k, number in enumerate(order)}
    fap[17] = np.zeros(FRAMES)
    fap[53], fap[54] = SIDE * bump(-3.0, 2.0), -SIDE * bump(3.5, 2.5)  # narrow enough for the top lip to come forward
    points = seen(np.stack([fap[number] for number in FAP_NUMBERS], axis=1))
    others = [number for number in range(478) if number not in FACE]
    points[:, others] = np.random.default_rng(7).uniform(-80, 80, (len(others), 3))
    fap[17] = 2.6 * np.maximum(-(fap[53] + fap[54]) - 55, 0)
    return points, np.stack([fap[number] for number in FAP_NUMBERS], axis=1)


def turned(points: np.ndarray, flat: bool = False) -> np.ndarray:
    """The same face on a head that nods, shakes and rolls by some 15 degrees, drifts, and comes nearer. Pixels."""
    result = np.empty_like(points)
    for t in range(len(points)):
        yaw, pitch, roll = (0.25 * np.sin(0.05 * t + k) for k in range(3))
        about_y = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
        about_x = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
        about_z = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
        rotation = about_z if flat else about_z @ about_x @ about_y
        result[t] = (1.2 + 0.004 * t) * points[t] @ rotation.T + (320 + 0.5 * t, 240 - 0.3 * t, 10)
    return result


def write(folder, name="a", lab=LAB, **arrays):
    folder.mkdir(exist_ok=True)
    if lab is not None:
        (folder / f"{name}.lab").write_text(lab)
    path = folder / f"{name}.npz"
    np.savez(path, **{"fps": FPS, **arrays})
    return path


def made(tmp_path, *paths, given=Given(), cutoff=0.0):  # noqa: B008, a constant
    """(T, 13) FAPs of each episode of the corpus that is recorded from `paths`."""
    record(paths, tmp_path / "corpus", SPEECH, given, cutoff)
    return [episode.frames for episode in read_corpus(tmp_path / "corpus")]


@pytest.mark.parametrize("head", ["still", "moving", "flat"])
def test_landmarks_give_the_faps_of_the_closed_form(tmp_path, head):
    """Catches a wrong landmark, axis, sign or unit of any channel; rotation, scale or translation that leaks into the
    mouth, which a talking head would be trained to do; 2-D alignment that is not one, where FAP 16 follows FAP 52.
    Files hold two decimals."""
    points, faps = talking()
    assert (abs(faps).max(axis=0) > 5).all()
    if head != "still":
        points = turned(points, flat=head == "flat")
    if head == "flat":
        points = points[:, :468, :2]
        faps[:, FAP_NUMBERS.index(16)] = 0.52 * faps[:, FAP_NUMBERS.index(52)]
    assert abs(made(tmp_path, write(tmp_path / "in", landmarks=points))[0] - faps).max() < 0.006


@pytest.mark.parametrize("where", ["file", "option"])
def test_shares_of_the_image_need_its_size(tmp_path, where):
    """Catches an aspect ratio that is forgotten or applied to the wrong axis."""
    points, faps = talking()
    shares = turned(points) / (1280, 720, 1280)
    own = {"size": np.array([1280, 720])} if where == "file" else {}
    path = write(tmp_path / "in", landmarks=shares, **own)
    given = Given(size=None if own else parse_size("1280x720"))
    assert abs(made(tmp_path, path, given=given)[0] - faps).max() < 0.006
    if not own:
        with pytest.raises(DataError, match="a.npz: .*--size"):
            read_landmarks(path, Given())


def test_pucker_is_the_top_lips_protrusion(tmp_path):
    points, _ = talking()
    pucker = np.linspace(0, 1, FRAMES)
    frames = made(tmp_path, write(tmp_path / "in", landmarks=points, pucker=pucker))[0]
    assert abs(frames[:, 2] - 400 * pucker).max() < 0.006


def test_csv_and_npy_are_the_same_as_npz(tmp_path):
    """Catches columns that are taken for others, and times that are not the file's."""
    points, faps = talking()
    points = turned(points)
    folder = tmp_path / "in"
    folder.mkdir()
    columns = [f"{axis}{number}" for number in reversed(USED) for axis in "yxz"]
    rows = points[:, list(reversed(USED))][:, :, [1, 0, 2]].reshape(FRAMES, -1)
    lines = [",".join([f"{t / FPS:.3f}", *(f"{value:.9f}" for value in row)]) for t, row in enumerate(rows)]
    (folder / "a.csv").write_text("\n".join([",".join(["time", *columns]), *lines]) + "\n")
    np.save(folder / "b.npy", points)
    for name in "ab":
        (folder / f"{name}.lab").write_text(LAB)
    for frames in made(tmp_path, folder, given=Given(fps=FPS)):
        assert abs(frames - faps).max() < 0.006


def test_a_short_loss_of_the_face_is_bridged_a_long_one_left_out(tmp_path):
    """Catches NaN in the corpus, frames that move in time, and a mouth that is invented for a second."""
    points, faps = talking()
    lost = [0, 30, 31, 32, 120, 149]  # where nothing moves, so that the bridge is the truth
    short, long = points.copy(), points.copy()
    short[lost] = np.nan
    short[40, 17, 1] = np.nan  # one landmark
    long[60:71] = np.nan
    write(tmp_path / "in", "short", landmarks=short)
    write(tmp_path / "in", "long", landmarks=long)
    with pytest.warns(UserWarning, match=r"long.npz: left out: frames 60 to 70 have no face for 0.22 s"):
        frames = made(tmp_path, tmp_path / "in")
    assert len(frames) == 1 and abs(frames[0] - faps).max() < 0.006


def test_neutral_is_the_talkers_not_the_recordings(tmp_path):
    """Catches a neutral mouth per recording: one that holds no silence is measured by the others'."""
    points, faps = talking()
    write(tmp_path / "in", "a", landmarks=points)
    write(tmp_path / "in", "b", lab="0 1 AA\n", landmarks=points[TALK])
    first, second = made(tmp_path, tmp_path / "in")
    assert abs(first - faps).max() < 0.006 and abs(second - faps[TALK]).max() < 0.006


def test_without_silence_neutral_is_where_the_lips_are_closest(tmp_path):
    """Catches a talker whose pauses were cut off and whose neutral mouth would then be the mean of talking."""
    points, _ = talking()
    points[:] = points[0]
    points[:, 17, 1] += abs(bump(8.0))
    frames = made(tmp_path, write(tmp_path / "in", lab="0 3 AA\n", landmarks=points))[0]
    assert abs(frames[:, FAP_NUMBERS.index(52)] + UP * abs(bump(8.0))).max() < 0.006


def test_smoothing_takes_out_noise_and_keeps_time(tmp_path):
    """Catches a filter that delays: a mouth that is late looks wrong long before one that is soft does."""
    points, faps = talking()
    rng = np.random.default_rng(1)
    noisy = points + rng.normal(0, 0.05, points.shape)
    path = write(tmp_path / "in", landmarks=noisy)
    raw = made(tmp_path, path)[0]
    smooth = made(tmp_path / "in", path, cutoff=6.0)[0]
    jaw = faps[:, 0]
    assert abs(np.diff(smooth[:40, 0])).mean() < 0.5 * abs(np.diff(raw[:40, 0])).mean()
    lags = range(-5, 6)
    best = max(lags, key=lambda lag: float((jaw[10:-10] * np.roll(smooth[:, 0], lag)[10:-10]).sum()))
    assert best == 0 and np.corrcoef(jaw, smooth[:, 0])[0, 1] > 0.98


def test_the_corpus_keeps_words_and_apexes(tmp_path):
    """Round trip through the reader of corpora: labels in the phone set's spelling, times, apex and word."""
    points, _ = talking()
    record([write(tmp_path / "in", landmarks=points)], tmp_path / "corpus", SPEECH, Given(), 12.0)
    (episode,) = read_corpus(tmp_path / "corpus")
    assert episode.name == "a" and np.allclose(episode.times, np.arange(FRAMES) / FPS)
    assert [s.label for s in episode.segments] == ["SIL", "AA", "P", "IY", "SIL"]
    assert episode.segments[1].apex == 1.2 and episode.segments[1].word == "hah"
    assert [s.end for s in episode.segments] == [1.0, 1.4, 1.5, 2.0, 3.0]
    with pytest.warns(UserWarning, match="10 frames per second") as caught:
        record([write(tmp_path / "in", landmarks=points[::5], fps=10)], tmp_path / "few", SPEECH, Given(), 0.0)
    assert len(caught) == 1


def flip(points, axis):
    return points * np.where(np.arange(points.shape[-1]) == axis, -1, 1)


@pytest.mark.parametrize(("change", "message"), [
    (lambda p: {"landmarks": p[:, :400]}, r"shape \(150, 400, 3\)"),
    (lambda p: {"landmarks": p.reshape(150, -1)}, r"shape \(150, 1434\)"),
    (lambda p: {"landmarks": p.astype(complex)}, "not real numbers"),
    (lambda p: {"landmarks": np.where(np.arange(150)[:, None, None] == 17, np.inf, p)}, "frame 17: a coord"),
    (lambda p: {"landmarks": p * np.nan}, "no frame has a face"),
    (lambda p: {"landmarks": p[:1]}, "fewer than two frames"),
    (lambda p: {"faces": p}, "no array 'landmarks'"),
    (lambda p: {"landmarks": flip(p, 1)}, "y must grow downwards"),
    (lambda p: {"landmarks": flip(p, 0)}, "left and right"),
    (lambda p: {"landmarks": flip(p, 2)}, "z must grow away"),
    (lambda p: {"landmarks": p / (1, 1, 1000)}, "z must grow away"),
    (lambda p: {"landmarks": p, "times": np.arange(149) / 50}, r"times have the shape \(149,\)"),
    (lambda p: {"landmarks": p, "times": np.maximum(np.arange(150) - 1, 0) / 50}, "frame 1: time 0 does not follow"),
    (lambda p: {"landmarks": p, "fps": -3}, "fps"),
    (lambda p: {"landmarks": p, "pucker": np.zeros(3)}, r"pucker has the shape \(3,\)"),
    (lambda p: {"landmarks": p, "pucker": np.arange(150)}, "frame 2: the score pucker is 2"),
    (lambda p: {"landmarks": p, "size": np.array([0, 5])}, "size is not"),
    (lambda p: {"landmarks": p, "fps": 5}, "phonemes last from 0 to 3 s, motion from 0 to 29.8"),
])  # fmt: skip
def test_what_cannot_be_used_names_the_file(tmp_path, change, message):
    """Catches garbage that becomes a corpus: each of these would train without a word and move wrongly."""
    points, _ = talking()
    arrays = change(points)
    path = write(tmp_path / "in", lab=LAB, **arrays)
    if message.startswith("phonemes"):
        (tmp_path / "in" / "a.lab").write_text("0 3 AA\n3 90 B\n")
        message = r"a.lab: phonemes last from 0 to 90 s, motion from 0 to 29.8 s"
    with pytest.raises(LabialError, match=message) as caught:
        record([path], tmp_path / "corpus", SPEECH, Given(), 12.0)
    assert not (tmp_path / "corpus").exists()
    if "z must" not in message:  # that is seen on all recordings of a talker together
        assert str(tmp_path / "in") in str(caught.value)


@pytest.mark.parametrize(("text", "message"), [
    ("", "a.csv:1: no column x33"),
    ("time,x33\n", "a.csv:1: no column y33, "),
    ("{head}\n0,{row}\n0.1,{row},7\n", "a.csv:3: 48 columns, not 47"),
    ("{head}\n0,{row}\n0,{row}\n", "a.csv:3: time 0 does not follow"),
    ("{head}\n0,{row}\n0.1,{bad}\n", "a.csv:3: value 'x' is not a finite number"),
    ("{head}\n0,{row}\n\n0.1,{row}\n", "a.csv:3: empty line"),
    ("{head}\n0,{row}\n0.1,{inf}\n", "a.csv:3: value 'inf' is not a finite number"),
    ("{head},time\n", "a.csv:1: two columns"),
])  # fmt: skip
def test_malformed_csv_names_the_line(tmp_path, text, message):
    columns = [f"{axis}{number}" for number in USED for axis in "xy"]
    row = [str(FACE[number][axis]) for number in USED for axis in (0, 1)]
    path = tmp_path / "a.csv"
    path.write_text(text.format(head=",".join(["time", *columns]), row=",".join(row), bad=",".join(["x", *row[1:]]),
                                inf=",".join(["inf", *row[1:]])))
    with pytest.raises(DataError) as caught:
        read_landmarks(path, Given())
    assert message in str(caught.value)


def test_files_that_are_no_arrays(tmp_path):
    broken = {"a.npz": b"PK\x03\x04 broken", "b.npy": b"", "c.npz": b"x", "d.npy": b"\x93NUMPY\x01"}
    for name, content in broken.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(DataError, match=f"{name}: not a NumPy file"):
            read_landmarks(tmp_path / name, Given(fps=50))
    np.save(tmp_path / "e.npy", np.array([{}, {}], dtype=object))  # would run code if it were unpickled
    with pytest.raises(DataError, match="e.npy: not a NumPy file"):
        read_landmarks(tmp_path / "e.npy", Given(fps=50))
    with pytest.raises(DataError, match="f.npy: No such file"):
        read_landmarks(tmp_path / "f.npy", Given(fps=50))


def test_files_that_do_not_go_together(tmp_path, capsys):
    """Catches half an episode, two timings, two recordings of one name, a corpus that would be mixed with another."""
    points, _ = talking()
    folder, out = tmp_path / "in", tmp_path / "corpus"
    arguments = ["record", str(folder), "-o", str(out)]

    def fails(message):
        assert main(arguments) == 1 and message in capsys.readouterr().err

    folder.mkdir()
    fails("in: no landmarks")
    write(folder, lab=None, landmarks=points)
    fails("a.npz: no phoneme timings beside it: a.lab")
    (folder / "a.lab").write_text(LAB.replace("IY", "QQ"))
    fails("a.lab:4: no speech phoneme is called 'QQ'")
    (folder / "a.lab").write_text(LAB)
    (folder / "a.pho").write_text("_ 3000\n")
    fails("a.pho: there is also a.lab")
    (folder / "a.pho").unlink()
    np.save(folder / "a.npy", points)
    fails("a.npz: there is also")
    (folder / "a.npy").unlink()
    write(folder, "b", landmarks=points[:, :, :2])
    fails("b.npz: no depth")
    (folder / "b.npz").unlink()
    assert main(arguments) == 0
    assert "1 recordings, 0 min 3 s" in capsys.readouterr().out
    fails("corpus: not a folder that is new or empty")
