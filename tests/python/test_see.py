"""Plots and pages of motion files, from outside; the page is held to what the demo's is."""

from __future__ import annotations

import base64
import json
import re
import struct
from pathlib import Path
from typing import Any, Dict, List

import numpy as np
import pytest

from labial.__main__ import main
from labial.errors import DataError
from labial.files import limits
from labial.files.faps import FAP_COLUMNS, FAP_NUMBERS
from labial.files.frames import even
from labial.see.motion import read_bands, read_fap, read_motion, read_motions
from labial.see.page import DATA_PLACE, MOUTH, MOUTH_PLACE, PLAYER, page

HEADER = ",".join(("time", *FAP_COLUMNS))
LAB = "0 0.1 sil\n0.1 0.2 M\n0.2 0.3 ah0\n0.3 0.4 v\n0.4 0.5 t\n"


def frames(count: int = 25, fps: float = 50.0, start: float = 0.0) -> str:
    lines = [HEADER]
    for t in range(count):
        lines.append(",".join([f"{start + t / fps:.3f}", *(f"{10 * np.sin(t / 5 + k):.2f}" for k in range(13))]))
    return "\n".join(lines) + "\n"


def wav() -> bytes:
    samples = struct.pack("<100h", *range(100))
    head = struct.pack("<4sI4s4sIHHIIHH4sI", b"RIFF", 36 + len(samples), b"WAVE", b"fmt ", 16, 1, 1, 8000, 16000, 2, 16,
                       b"data", len(samples))
    return head + samples


def fap(mask: List[int], rows: List[List[int]], header: str = "2.1 x 25 {count}", entries: int = 68) -> str:
    lines = [header.format(count=len(rows))]
    for number, row in enumerate(rows):
        lines += [" ".join("1" if bit in mask else "0" for bit in range(1, entries + 1)),
                  " ".join(map(str, [number, *row]))]
    return "\n".join(lines) + "\n"


@pytest.fixture
def given(tmp_path: Path) -> Path:
    (tmp_path / "a.csv").write_text(frames())
    (tmp_path / "a.lab").write_text(LAB)
    (tmp_path / "a.wav").write_bytes(wav())
    return tmp_path


def data_of(text: str) -> Dict[str, Any]:
    found = re.findall(r'<script type="application/json" id="labial-data">(.*?)</script>', text, re.S)
    assert len(found) == 1
    return json.loads(found[0])


def test_bands_are_what_the_mouth_does(given: Path) -> None:
    bands = read_bands(given / "a.lab")
    assert [(b.label, b.kind) for b in bands] == [
        ("SIL", "silence"), ("M", "closed"), ("AH", "vowel"), ("V", "labiodental"), ("T", "other")]  # fmt: skip
    (given / "laugh.lab").write_text("0 .1 fricative\n.1 .2 a\n.2 .3 xyz\n.3 .4 silence\n")
    kinds = [(b.label, b.kind) for b in read_bands(given / "laugh.lab")]
    assert kinds == [("fricative", "other"), ("a", "vowel"), ("xyz", "other"), ("silence", "silence")]


@pytest.mark.parametrize("entries", [68, 69])
def test_fap_files_hold_the_same_motion(tmp_path: Path, entries: int) -> None:
    """Catches values that go to the next FAP, masks in which the 13 are not alone, and FAPs that a frame leaves out."""
    mask = [4, *FAP_NUMBERS]
    numbers = sorted(mask)
    rows = [[100 * t + number for number in numbers] for t in range(3)]
    text = fap(mask, rows, entries=entries).splitlines()
    text[5] = " ".join("1" if bit == 3 else "0" for bit in range(1, entries + 1))
    text[6] = "2 -7"
    (tmp_path / "a.fap").write_text("\n".join(text) + "\n")
    times, values = read_fap(tmp_path / "a.fap")
    assert times.tolist() == [0, 0.04, 0.08]
    assert values[1].tolist() == [100 + number for number in FAP_NUMBERS]
    assert values[2].tolist() == [-7, *(100 + number for number in FAP_NUMBERS[1:])]


@pytest.mark.parametrize(("text", "message"), [
    ("", "1: the header"), ("2.1 x fast 1\n", "1: the header"), ("2.1 x 25 0\n", "1: the header"),
    (fap([3], [[1]], header="2.1 x 25 2"), "3: 2 frames need 4 lines"),
    (fap([3], [[1, 2]]), "3: expected the frame's number and 1 values"),
    (fap([3], [[1]]).replace("0 0", "0 2", 1), "2: expected a mask"),
    (fap([3], [[1]], entries=60), "2: expected a mask"),
    (fap([3], [[1]]).replace("0 1\n", "0 x\n"), "3: not a whole number"),
    (fap([3], [[10**400]]), "3: not a whole number"), (fap([3], [[-2000000]]), "3: the value -2e+06 is beyond"),
])  # fmt: skip
def test_malformed_fap_names_the_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.fap"
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        read_motion(path)
    assert f"a.fap:{message}" in str(caught.value)


def test_times_make_an_even_grid() -> None:
    """Catches a rate that rounded times spoil, and a page that runs faster where frames are missing."""
    rounded = np.round(np.arange(200) / 29.97, 3)
    rate, same = even(rounded, np.zeros((200, 13)))
    assert rate == pytest.approx(29.97, abs=0.05) and len(same) == 200
    assert even(np.round(np.arange(100) / 60, 3), np.zeros((100, 13)))[0] == 60
    times = np.delete(np.arange(51) / 50, [20, 21, 22])
    rate, filled = even(times, np.outer(times, np.ones(13)))
    assert rate == pytest.approx(50) and np.allclose(filled[:, 0], np.arange(51) / 50)
    assert even(np.array([3.0]), np.zeros((1, 13)))[0] == 25


def test_times_that_are_no_grid_are_refused(given: Path, capsys) -> None:
    """Catches two frames a nanosecond apart that ask for more frames in between than there is memory for."""
    lines = frames(4).splitlines()
    lines[2:] = [f"{time},{line.split(',', 1)[1]}" for time, line in zip(("1e-9", "2e-9", "1000"), lines[2:])]
    (given / "a.csv").write_text("\n".join(lines) + "\n")
    assert main(["page", str(given / "a.csv"), "-o", str(given / "a.html")]) == 1
    assert "a: its times are too uneven: 4 frames" in capsys.readouterr().err and not (given / "a.html").exists()


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_plot_writes_the_asked_format(given: Path, suffix: str) -> None:
    pytest.importorskip("matplotlib")
    out = given / f"out.{suffix}"
    assert main(["plot", str(given / "a.csv"), "--phones", str(given / "a.lab"), "-o", str(out)]) == 0
    assert out.read_bytes().startswith({"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[suffix])


def test_plot_shows_files_phonemes_and_bands(given: Path) -> None:
    """Catches a file, a phoneme or a channel that is missing from the picture, and bytes that differ between runs."""
    pytest.importorskip("matplotlib")
    (given / "b").mkdir()
    (given / "b" / "a.csv").write_text(frames(fps=25))
    arguments = ["plot", str(given / "a.csv"), str(given / "b" / "a.csv"), "--phones", str(given / "a.lab"),
                 "--channels", "3,raise_b_midlip_o,fap60,stretch,opening", "-o", str(given / "out.svg")]  # fmt: skip
    assert main(arguments) == 0
    text = (given / "out.svg").read_text()
    words = re.findall(r"<text[^>]*>(.*?)</text>", text)
    assert {"SIL", "M", "AH", "V", "T"} <= set(words)
    assert {str(given / "a.csv"), str(given / "b" / "a.csv"), "vowel", "silence"} <= set(words)
    assert sum(word.startswith(("FAP 3", "FAP 52", "FAP 60")) for word in words) == 3
    assert {"corner stretch", "lip opening"} <= set(words)
    for colour in ("#fdf0d2", "#f6c9c9", "#d9cdf0", "#e4e7eb"):
        assert text.count(f"fill: {colour}") >= 5  # in each panel
    assert main(arguments) == 0 and (given / "out.svg").read_text() == text


@pytest.mark.parametrize(("arguments", "message"), [
    (["plot", "a.csv", "-o", "a.bmp"], "a.bmp: the name of a plot ends in"),
    (["plot", "a.csv", "-o", "a.png", "--channels", "jaw"], "no channel is called 'jaw'"),
    (["plot", "a.csv", "-o", "a.png", "--channels", ","], "no channel to plot"),
    (["plot", "a.lab", "-o", "a.png"], "a.lab:1: the header"),
    (["page", "a.csv", "--phones", "none.lab", "-o", "a.html"], "none.lab"),
    (["page", "a.csv", "--audio", "a.lab", "-o", "a.html"], "a.lab: not a sound that browsers play: a WAV, MP3, Ogg"),
    (["page", "a.csv", "--audio", "empty.wav", "-o", "a.html"], "empty.wav: not a sound that browsers play"),
    (["page", "a.csv", "--audio", "large.wav", "-o", "a.html"],
     "large.wav: a page takes a sound of 24 MB at most, and this one has 24.1 MB; as MP3 or Ogg it is shorter"),
    (["page", "a.csv", "--audio", ".", "-o", "a.html"], ".: Is a directory"),
    (["page", "a.csv", "--audio", "none.wav", "-o", "a.html"], "none.wav"),
])  # fmt: skip
def test_errors_are_one_line(given: Path, capsys, monkeypatch, arguments: List[str], message: str) -> None:
    monkeypatch.chdir(given)
    Path("empty.wav").touch()
    with open("large.wav", "wb") as large:
        large.write(wav())
        large.truncate(limits.PAGE + 100_000)
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1 and not (given / "a.html").exists()


def test_page_plays_what_the_file_says(given: Path) -> None:
    """Catches frames, phonemes or sound that are lost or out of step."""
    out = given / "a.html"
    assert main(["page", str(given / "a.csv"), "--phones", str(given / "a.lab"), "--audio", str(given / "a.wav"),
                 "--title", "</script><b>&", "-o", str(out)]) == 0  # fmt: skip
    text = out.read_text(encoding="utf-8")
    data = data_of(text)
    assert data["title"] == "</script><b>&" and "</script><b>" not in text
    assert data["fps"] == 50 and data["start"] == 0 and data["channels"] == list(FAP_COLUMNS)
    assert np.abs(np.array(data["frames"]) - read_motion(given / "a.csv").frames).max() <= 0.5
    assert [(p["label"], p["start_frame"], p["frames"], p["kind"]) for p in data["phonemes"]] == [
        ("SIL", 0, 5, "silence"), ("M", 5, 5, "speech"), ("AH", 10, 5, "speech"), ("V", 15, 5, "speech"),
        ("T", 20, 5, "speech")]  # fmt: skip
    kind, _, content = data["audio"].partition(",")
    assert kind == "data:audio/wav;base64" and base64.b64decode(content) == wav()


@pytest.mark.parametrize(("options", "kind"), [
    ({"format": "WAV", "subtype": "PCM_16"}, "audio/wav"), ({"format": "FLAC"}, "audio/flac"),
    ({"format": "MP3"}, "audio/mpeg"), ({"format": "OGG", "subtype": "VORBIS"}, "audio/ogg"),
    ({"format": "OGG", "subtype": "OPUS"}, "audio/ogg"),
])  # fmt: skip
def test_page_takes_what_encoders_write(given: Path, options: Dict[str, str], kind: str) -> None:
    """A format that is taken for another one, which some browsers then refuse."""
    soundfile = pytest.importorskip("soundfile")
    soundfile.write(given / "sound", np.zeros(4800), 48000, **options)
    address = data_of(page(read_motion(given / "a.csv"), [], given / "sound"))["audio"]
    assert address == f"data:{kind};base64," + base64.b64encode((given / "sound").read_bytes()).decode()


def test_page_begins_where_the_motion_does(tmp_path: Path) -> None:
    """Phonemes before the first frame are cut, and the sound is told where the first frame lies in it."""
    (tmp_path / "a.csv").write_text(frames(start=0.15))
    (tmp_path / "a.lab").write_text(LAB)
    data = data_of(page(read_motion(tmp_path / "a.csv"), read_bands(tmp_path / "a.lab")))
    assert data["start"] == 0.15 and "audio" not in data
    assert [(p["label"], p["start_frame"], p["frames"]) for p in data["phonemes"]] == [
        ("M", 0, 3), ("AH", 3, 5), ("V", 8, 5), ("T", 13, 5)]  # fmt: skip


def test_player_requests_nothing() -> None:
    """The template of both `labial page` and the demo: sound may only be in the page itself."""
    text = PLAYER.read_text(encoding="utf-8")
    assert text.count(DATA_PLACE) == text.count(MOUTH_PLACE) == 1 and text.index(DATA_PLACE) < text.index(MOUTH_PLACE)
    policy = re.search(r'http-equiv="Content-Security-Policy"\s+content="([^"]*)"', text)
    assert policy and policy.group(1) == ("default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
                                          "img-src data:; media-src data:")  # fmt: skip
    drawing = MOUTH.read_text(encoding="utf-8")
    assert "</script" not in drawing and "<!--" not in drawing
    for part in (text, drawing.replace("http://www.w3.org/2000/svg", "")):  # a name, which nothing fetches
        assert not re.search(r"https?://|@import|\bfetch\(|XMLHttpRequest|WebSocket|sendBeacon|\bimport\b", part)


def test_names_tell_files_apart(given: Path) -> None:
    assert [motion.name for motion in read_motions([given / "a.csv"])] == ["a"]
    names = [motion.name for motion in read_motions([given / "a.csv", given / "a.csv"])]
    assert names == [str(given / "a.csv")] * 2
