"""The Labial corpus folder: complete pairs of files, strict frames."""

from __future__ import annotations

import zipfile

import numpy as np
import pytest

from labial.corpus import read_corpus
from labial.corpus.folder import HEADER, read_frames
from labial.errors import DataError, LabialError
from packages import SOURCE

ROW = ",1" * 13


def frames(count=10, step=0.1):
    """Text of a frames file."""
    return HEADER + "\n" + "".join(f"{i * step:.2f}{ROW}\n" for i in range(count))


def fill(folder, names):
    """Writes pairs of files."""
    for name in names:
        (folder / f"{name}.csv").write_text(frames())
        (folder / f"{name}.lab").write_text("0 0.5 HH\n0.5 0.9 AH0\n")


def fails(call, start, words=""):
    """Asserts a DataError whose message begins with `start`."""
    with pytest.raises(DataError) as caught:
        call()
    assert str(caught.value).startswith(f"{start}: ") and words in str(caught.value)


def test_episodes_are_sorted_and_strangers_ignored(tmp_path):
    """Catches an order that depends on the file system, and a README taken for data."""
    fill(tmp_path, ["b", "a", "c.1"])
    (tmp_path / "README.md").write_text("x")
    (tmp_path / "._a.csv").write_text("x")
    episodes = read_corpus(tmp_path, "speech")
    assert [e.name for e in episodes] == ["a", "b", "c.1"]
    assert episodes[0].frames.shape == (10, 13) and episodes[0].times.shape == (10,)
    assert [s.label for s in episodes[0].segments] == ["HH", "AH"]


@pytest.mark.parametrize("lost", ["a.csv", "a.lab"])
def test_half_an_episode_is_an_error(tmp_path, lost):
    """Catches episodes that vanish because one of their files is missing."""
    fill(tmp_path, ["a", "b"])
    (tmp_path / lost).unlink()
    fails(lambda: read_corpus(tmp_path), tmp_path / ("a.lab" if lost == "a.csv" else "a.csv"), lost)


def test_two_timings_or_none_or_no_folder(tmp_path):
    """Catches a silent choice between two timings, and an empty corpus that trains on nothing."""
    fails(lambda: read_corpus(tmp_path), tmp_path, "no episodes")
    fails(lambda: read_corpus(tmp_path / "x"), tmp_path / "x", "no such folder")
    fill(tmp_path, ["a"])
    (tmp_path / "a.TextGrid").write_text("x")
    fails(lambda: read_corpus(tmp_path), tmp_path / "a.lab", "a.TextGrid")
    with pytest.raises(LabialError):
        read_corpus(tmp_path, "song")


@pytest.mark.parametrize("text, line", [
    ("", 1), (frames().replace("fap16", "fap61"), 1), (frames().replace("fap16,fap17", "fap17,fap16"), 1),
    (HEADER + "\n0" + ROW + "\n0.1" + ROW[:-2] + "\n", 3), (HEADER + "\n0" + ROW + ",1\n", 2),
    (HEADER + "\n0" + ROW + "\n0" + ROW + "\n", 3), (HEADER + "\n0" + ROW[:-1] + "nan\n", 2),
    (HEADER + "\n0" + ROW[:-1] + "\n", 2), (HEADER + "\n0" + ROW + "\n\n.1" + ROW + "\n", 3), (HEADER + "\n", None),
])  # fmt: skip
def test_malformed_frames_name_the_line(tmp_path, text, line):
    """Catches swapped or missing columns, ragged rows, time that stands still, and values that are not numbers."""
    path = tmp_path / "a.csv"
    path.write_text(text)
    fails(lambda: read_frames(path), f"{path}:{line}" if line else path)


def test_files_that_do_not_go_together(tmp_path):
    """Catches timings in milliseconds, or of another episode, which would train on a held mouth."""
    fill(tmp_path, ["a"])
    (tmp_path / "a.lab").write_text("0 0.5 HH\n0.5 90 AH0\n")
    fails(lambda: read_corpus(tmp_path), tmp_path / "a.lab", "motion")


def packed(folder, names=None):
    """Moves files of a folder into a zip file there."""
    archive = folder / "episodes.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for path in sorted(folder.iterdir()):
            if path != archive and (names is None or path.name in names):
                out.write(path, path.name)
                path.unlink()
    return archive


def test_packed_episodes_are_read_as_they_are(tmp_path):
    """Whole corpora and parts of one; would catch another order, names that are not the files' own."""
    fill(tmp_path, ["c", "a", "b"])
    loose = read_corpus(tmp_path)
    packed(tmp_path, ["a.csv", "a.lab", "c.csv"])
    for rest in (["b.csv", "b.lab", "c.lab"], []):
        found = read_corpus(tmp_path)
        assert [item.name for item in found] == ["a", "b", "c"]
        for one, other in zip(found, loose):
            assert one.segments == other.segments and np.array_equal(one.frames, other.frames)
        (tmp_path / "episodes.zip").rename(tmp_path / f"{len(rest)}.ZIP")
        packed(tmp_path, rest)


def test_errors_of_packed_files_name_archive_file_and_line(tmp_path):
    fill(tmp_path, ["a"])
    (tmp_path / "a.csv").write_text(HEADER + "\n0" + ROW + "\n1,2\n")
    archive = packed(tmp_path)
    fails(lambda: read_corpus(tmp_path), f"{archive}/a.csv:3", "2 columns")
    fill(tmp_path, ["a"])
    fails(lambda: read_corpus(tmp_path), f"{archive}/a.csv", "there is also a.csv")


def test_archives_that_cannot_be_read(tmp_path, monkeypatch):
    """Damaged, no archive at all, too large unpacked; what lies in folders of an archive is not looked at."""
    fill(tmp_path, ["a"])
    archive = packed(tmp_path)
    with zipfile.ZipFile(archive, "a") as out:
        out.writestr("folder/a.csv", "nothing")
        out.writestr(".hidden.csv", "nothing")
        out.writestr("README.md", "nothing")
    assert len(read_corpus(tmp_path)) == 1
    monkeypatch.setattr("labial.files.limits.CORPUS", 100)
    fails(lambda: read_corpus(tmp_path), archive, "more than the 100 that are read")
    monkeypatch.undo()
    archive.write_bytes(archive.read_bytes()[:200])
    fails(lambda: read_corpus(tmp_path), archive, "damaged")


def test_grid():
    """Catches whatever a corpus of real size and origin holds that the small files above do not."""
    episodes = read_corpus(SOURCE / "export" / "corpora" / "grid_s1")
    assert len(episodes) == 803 and sum(len(e.segments) for e in episodes) > 10000
    assert all(np.isfinite(e.frames).all() for e in episodes)
    assert all(segment.apex is not None for e in episodes for segment in e.segments if segment.label != "SIL")
