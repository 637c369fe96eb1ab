"""Plots and pages of motion files, avatars on pages."""

from __future__ import annotations

import base64
import json
import re
import struct
from pathlib import Path
from typing import Any, Callable, Dict, List

import numpy as np
import pytest

from avatars import TRUE, document_of, glb, made_head
from browser import CHROMIUM, REASON, THREE_D, Browser
from labial.__main__ import main
from labial.errors import DataError
from labial.files import limits
from labial.files.faps import FAP_COLUMNS, FAP_NUMBERS
from labial.files.frames import even
from labial.rig.animation import face, outputs
from labial.see.motion import read_bands, read_fap, read_motion
from labial.see.page import page
from labial.see.player import DATA_PLACE, MOUTH, MOUTH_PLACE, PLAYER
from models import write_motion
from npm import NPM, tools

HEADER = ",".join(("time", *FAP_COLUMNS))
#: A description of one weight.
MINE = 'unit = "weight"\n[output.jawOpen]\nfrom = "opening"\nneutral = 0\nfull = 1\n'
THREE = ["--three", "three"]
LAB = "0 0.1 sil\n0.1 0.2 M\n0.2 0.3 ah0\n0.3 0.4 v\n0.4 0.5 t\n"


def frames(count: int = 25, fps: float = 50.0, start: float = 0.0) -> str:
    rows = (",".join([f"{start + t / fps:.3f}", *(f"{10 * np.sin(t / 5 + k):.2f}" for k in range(13))])
            for t in range(count))
    return "\n".join([HEADER, *rows]) + "\n"


def wav() -> bytes:
    samples = struct.pack("<100h", *range(100))
    head = struct.pack("<4sI4s4sIHHIIHH4sI", b"RIFF", 36 + len(samples), b"WAVE", b"fmt ", 16, 1, 1, 8000, 16000, 2, 16,
                       b"data", len(samples))
    return head + samples


def fap(mask: List[int], rows: List[List[int]], header: str = "2.1 x 25 {count}", entries: int = 68) -> str:
    bits = " ".join("1" if bit in mask else "0" for bit in range(1, entries + 1))
    frames = (f"{bits}\n" + " ".join(map(str, [number, *row])) for number, row in enumerate(rows))
    return "\n".join([header.format(count=len(rows)), *frames]) + "\n"


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text(frames())
    (tmp_path / "a.lab").write_text(LAB)
    (tmp_path / "a.wav").write_bytes(wav())
    return tmp_path


def data_of(text: str, name: str = "labial-data") -> Dict[str, Any]:
    found = re.findall(rf'<script type="application/json" id="{name}">(.*?)</script>', text, re.S)
    assert len(found) == 1
    return json.loads(found[0])


def test_bands_are_what_the_mouth_does(given: Path) -> None:
    bands = read_bands(given / "a.lab")
    assert [(b.label, b.kind) for b in bands] == [
        ("SIL", "silence"), ("M", "closed"), ("AH", "vowel"), ("V", "labiodental"), ("T", "other")]
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
])
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


@pytest.mark.parametrize("suffix", ["png", *(pytest.param(name, marks=pytest.mark.slow) for name in ("svg", "pdf"))])
def test_plot_writes_the_asked_format(given: Path, suffix: str) -> None:
    pytest.importorskip("matplotlib")
    out = given / f"out.{suffix}"
    assert main(["plot", str(given / "a.csv"), "--phones", str(given / "a.lab"), "-o", str(out)]) == 0
    assert out.read_bytes().startswith({"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[suffix])


def test_plot_shows_files_phonemes_and_bands(given: Path) -> None:
    """Catches a file, a phoneme or a channel that is missing from the picture, and bytes that differ between runs."""
    pytest.importorskip("matplotlib")
    Path("b").mkdir()
    Path("b/a.csv").write_text(frames(fps=25))
    arguments = ["plot", "a.csv", "b/a.csv", "--phones", "a.lab", "--channels",
                 "3,raise_b_midlip_o,fap60,stretch,opening", "-o", "out.svg"]
    assert main(arguments) == 0
    text = (given / "out.svg").read_text()
    words = re.findall(r"<text[^>]*>(.*?)</text>", text)
    assert {"SIL", "M", "AH", "V", "T"} <= set(words)
    assert {"a.csv", "b/a.csv", "vowel", "silence"} <= set(words)
    assert sum(word.startswith(("FAP 3", "FAP 52", "FAP 60")) for word in words) == 3
    assert {"corner stretch", "lip opening"} <= set(words)
    for colour in ("#fdf0d2", "#f6c9c9", "#d9cdf0", "#e4e7eb"):
        assert text.count(f"fill: {colour}") >= 5  # in each panel
    assert main(arguments) == 0 and (given / "out.svg").read_text() == text


def test_plot_says_how_far_lips_close(given: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Catches frames that are mostly of the phonemes beside a p, b, m: its own are 5 to 9."""
    pytest.importorskip("matplotlib")
    shown = np.zeros((20, 13))
    shown[:, [FAP_COLUMNS.index("fap51"), FAP_COLUMNS.index("fap52")]] = 3.0, 4.0
    shown[5:10, FAP_COLUMNS.index("fap52")] = -50.0, -40.0, -23.0, -40.0, -50.0
    write_motion(given / "a.csv", np.arange(20) / 50, shown)
    (given / "a.lab").write_text("0 0.108 sil\n0.108 0.192 M\n0.192 0.4 ah0\n0.4 0.5 P\n")
    assert main(["plot", str(given / "a.csv"), "--phones", str(given / "a.lab"), "-o", str(given / "out.png")]) == 0
    assert capsys.readouterr().out == "a: least opening in each p, b, m: M 20\n"


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
    (["page", "a.csv", "-o", "a.html", "--head", "head.glb"], "`npm install three` brings it"),
    (["page", "a.csv", "-o", "a.html", "--head", "head.glb", "--three", "."], "is not the npm package three"),
    (["page", "a.csv", "-o", "a.html", "--head", "a.csv", *THREE], "is not a whole .glb"),
    (["page", "a.csv", "-o", "a.html", "--head", "head.glb", "--rig", "rig.toml", *THREE],
     "none of the rig's shapes, beak"),
    (["page", "a.csv", "-o", "a.html", *THREE], "--rig, --point and --three go with --head"),
    (["page", "a.csv", "-o", "a.html", "--point", "chin=1"], "--rig, --point and --three go with --head"),
    (["page", "a.csv", "-o", "a.html", "--head", "head.glb", "--point", "ear=3", *THREE],
     "no point is called 'ear'"),
])
def test_errors_are_one_line(given: Path, avatar: Path, stand_in: Path, capsys, arguments: List[str],
                             message: str) -> None:
    Path("rig.toml").write_text(MINE.replace("jawOpen", "beak"))
    Path("empty.wav").touch()
    with open("large.wav", "wb") as large:
        large.write(wav())
        large.truncate(limits.PAGE + 100_000)
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1 and not (given / "a.html").exists()


def test_page_plays_what_the_file_says(given: Path) -> None:
    """Catches frames, phonemes or sound that are lost or out of step."""
    assert main([*"page a.csv --phones a.lab --audio a.wav -o a.html --title".split(), "</script><b>&"]) == 0
    text = Path("a.html").read_text(encoding="utf-8")
    data = data_of(text)
    assert data["title"] == "</script><b>&" and "</script><b>" not in text
    assert data["fps"] == 50 and data["start"] == 0 and data["channels"] == list(FAP_COLUMNS)
    assert np.abs(np.array(data["frames"]) - read_motion(given / "a.csv").frames).max() <= 0.5
    assert [(p["label"], p["start_frame"], p["frames"], p["kind"]) for p in data["phonemes"]] == [
        ("SIL", 0, 5, "silence"), ("M", 5, 5, "speech"), ("AH", 10, 5, "speech"), ("V", 15, 5, "speech"),
        ("T", 20, 5, "speech")]
    kind, _, content = data["audio"].partition(",")
    assert kind == "data:audio/wav;base64" and base64.b64decode(content) == wav()


@pytest.mark.parametrize(("options", "kind"), [
    ({"format": "WAV", "subtype": "PCM_16"}, "audio/wav"), ({"format": "FLAC"}, "audio/flac"),
    ({"format": "MP3"}, "audio/mpeg"), ({"format": "OGG", "subtype": "VORBIS"}, "audio/ogg"),
    ({"format": "OGG", "subtype": "OPUS"}, "audio/ogg"),
])
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
        ("M", 0, 3), ("AH", 3, 5), ("V", 8, 5), ("T", 13, 5)]


def test_player_requests_nothing() -> None:
    """The template of both `labial page` and the demo: sound may only be in the page itself."""
    text = PLAYER.read_text(encoding="utf-8")
    assert text.count(DATA_PLACE) == text.count(MOUTH_PLACE) == 1 and text.index(DATA_PLACE) < text.index(MOUTH_PLACE)
    policy = re.search(r'http-equiv="Content-Security-Policy"\s+content="([^"]*)"', text)
    assert policy and policy.group(1) == ("default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
                                          "img-src data:; media-src data:")
    drawing = MOUTH.read_text(encoding="utf-8")
    assert "</script" not in drawing and "<!--" not in drawing
    text += drawing.replace("http://www.w3.org/2000/svg", "")  # a name, which nothing fetches
    assert not re.search(r"https?://|@import|\bfetch\(|XMLHttpRequest|WebSocket|EventSource", text)
    assert not re.search(r"sendBeacon|\bimport\b", text)
    for value in re.findall(r"""<[^>]*\b(?:src|srcset|href|data|poster|action)=["']?([^"'\s>]*)""", text):
        assert value.startswith(("data:", "#")), value
    assert not re.search(r"url\((?!#)", text)


def test_controls_have_names() -> None:
    """Drawing, button and scrubber have labels for those who do not see them."""
    labels = re.findall(r'aria-label="([^"]*)"', PLAYER.read_text(encoding="utf-8"))
    assert "Play" in labels and "Speed" in labels and any(label.startswith("Position") for label in labels)
    assert re.search(r'<svg [^>]*aria-label="[^"]*mouth', MOUTH.read_text(encoding="utf-8"))


# ---- ``labial page --head`` ------------------------------------------------------------------------------------------


BROWSER = THREE_D
in_a_browser = pytest.mark.skipif(not (NPM and CHROMIUM), reason=f"{REASON}; and npm")
#: Frames of which the third is wide open.
OPENING = (0, 200, 600, 200, 0)
FAPS = np.zeros((5, 13))
FAPS[:, 0], FAPS[:, 4] = [x // 2 for x in OPENING], [-x for x in OPENING]


@pytest.fixture
def opening(tmp_path: Path) -> Path:
    return write_motion(tmp_path / "opens.csv", np.arange(5) / 50, FAPS)


@pytest.fixture
def avatar(tmp_path: Path) -> Path:
    """The made head, below a node that moves it."""
    document, binary = document_of(*made_head(), node={"translation": [0.3, 1.5, -0.2]})
    path = tmp_path / "head.glb"
    path.write_bytes(glb(document, binary))
    return path


@pytest.fixture
def stand_in(tmp_path: Path) -> Path:
    """What looks like the npm package three."""
    files = {"build/three.core.js": "export const core = 1;",
             "build/three.module.js": "import { core } from './three.core.js';\nexport { core };",
             "examples/jsm/loaders/GLTFLoader.js": "import { a } from '../utils/BufferGeometryUtils.js';\n"
                                                   "import { b } from '../utils/SkeletonUtils.js';",
             "examples/jsm/utils/BufferGeometryUtils.js": "import { core } from 'three';",
             "examples/jsm/utils/SkeletonUtils.js": ""}
    for name, text in files.items():
        (tmp_path / "three" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "three" / name).write_text(text)
    return tmp_path / "three"


Shown = Callable[..., Dict[str, Any]]


@pytest.fixture
def shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opening: Path, stand_in: Path) -> Shown:
    """What the page of a head has: `shown(content, *options)`. Commands run in the folder that mine.toml is in."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(MINE)

    def shown(head: bytes, *options: str) -> Dict[str, Any]:
        (tmp_path / "a.glb").write_bytes(head)
        assert main(["page", "opens.csv", "--head", "a.glb", "--three", "three", "-o", "page.html", *options]) == 0
        return data_of((tmp_path / "page.html").read_text(encoding="utf-8"), "data")

    return shown


@pytest.mark.parametrize("core", [True, False])
def test_everything_is_in_the_page(avatar: Path, stand_in: Path, shown: Shown, core: bool) -> None:
    """The avatar, the weights by its names, modules that ask for nothing. Before 0.172 three had no three.core.js."""
    if not core:
        (stand_in / "build" / "three.core.js").unlink()
        (stand_in / "build" / "three.module.js").write_text("export const core = 1;")
    data = shown(avatar.read_bytes())
    text = Path("page.html").read_text(encoding="utf-8")
    assert base64.b64decode(data["head"]) == avatar.read_bytes()
    expected = outputs(face("arkit"), FAPS)
    weights = np.array(data["weights"])
    assert "jawOpen" in data["shapes"] and set(data["shapes"]) <= set(made_head()[2])
    for name, column in zip(data["shapes"], weights.T):
        assert column == pytest.approx(expected[name], abs=0.0006)
    assert np.mean(data["corners"], axis=0)[1] == pytest.approx(1.5, abs=0.01)
    imports = json.loads(re.search(r'<script type="importmap">(.*?)</script>', text, re.DOTALL)[1])["imports"]
    for address in imports.values():
        kind, _, content = address.partition(",")
        assert kind == "data:text/javascript;base64"
        for module in re.findall(r"from '(.*?)'", base64.b64decode(content).decode()):
            assert module in imports


@pytest.mark.parametrize(("jaw", "told"), [(1.0, ""), (0.25, "its mouth opens 0."), (3.0, "its mouth opens 2.")])
def test_heads_that_the_built_in_weights_do_not_suit_are_told(shown: Shown, jaw: float, told: str,
                                                              capsys: pytest.CaptureFixture[str]) -> None:
    """A jaw that goes a quarter as far as the made head's, or three times; of a rig of one's own nothing is said."""
    vertices, triangles, shapes = made_head()
    for name in ("jawOpen", "mouthClose"):
        shapes[name] = jaw * shapes[name]
    head = glb(*document_of(vertices, triangles, shapes))
    shown(head)
    said = capsys.readouterr().err
    assert told in said and ("warning: a.glb: with the built-in weights" in said) == bool(told), said
    shown(head, "--rig", "mine.toml")
    assert capsys.readouterr().err == ""


def test_expressions_of_vrm_move_their_shapes(shown: Shown) -> None:
    """three.js knows the mesh's shapes alone, not the expressions that are made of them."""
    vertices, triangles, shapes = made_head(mouth="vrm")
    document, binary = document_of(vertices, triangles, {f"M_{name}": 2.0 * move for name, move in shapes.items()})
    document["extensions"] = {"VRMC_vrm": {"expressions": {"preset": {
        name: {"morphTargetBinds": [{"node": 0, "index": place, "weight": 0.5}]}
        for place, name in enumerate(("aa", "ou", "ih"))}}}}
    data = shown(glb(document, binary))
    assert set(data["shapes"]) == {"M_A", "M_U", "M_I"} and data["facing"] == 1.0
    opened = np.array(data["weights"])[:, data["shapes"].index("M_A")]
    assert opened == pytest.approx(0.5 * outputs(face("vrm"), FAPS)["aa"], abs=0.001) and opened.max() > 0.2


def test_points_that_are_not_found_are_named(shown: Shown, capsys: pytest.CaptureFixture[str]) -> None:
    """A jaw that tears no seam: what `labial fit` needs to be told, a page is told likewise."""
    vertices, triangles, shapes = made_head()
    down = np.clip((20.0 - vertices[:, 1]) / 60.0, 0.0, 1.0)
    shapes["jawOpen"] = -20.0 * down[:, None] * np.eye(3)[1]
    Path("a.glb").write_bytes(head := glb(*document_of(vertices, triangles, shapes)))
    assert main(["page", "opens.csv", "--head", "a.glb", "--rig", "mine.toml", "--three", "three", "-o", "p.html"]) == 1
    assert not Path("p.html").exists()
    error = capsys.readouterr().err
    names = re.search(r"the seam of the lips was not found: name (.*) with --point", error)[1].split(", ")
    nearest = {point: int(np.argmin(np.linalg.norm(vertices[:, :2] - place, axis=1))) for point, place in TRUE.items()}
    data = shown(head, "--rig", "mine.toml", *(item for name in names
                                               for item in ("--point", f"{name}={nearest[name]}")))
    assert data["shapes"] == ["jawOpen"]
    assert np.mean(data["corners"], axis=0) == pytest.approx([0.0, 0.0, data["corners"][0][2]], abs=0.002)


def test_shapes_whose_names_clash_are_told_apart(shown: Shown) -> None:
    """A fitted rig numbers what a description cannot tell apart; a page moves the shape that is meant."""
    vertices, triangles, shapes = made_head()
    named = {"mouthOpen": shapes["jawOpen"], "Lip O": shapes["mouthPucker"], "lip_o": shapes["mouthClose"]}
    Path("mine.toml").write_text(MINE.replace("jawOpen", "Lip_O_2"))
    assert shown(glb(*document_of(vertices, triangles, named)), "--rig", "mine.toml")["shapes"] == ["Lip O"]


@pytest.mark.slow
@in_a_browser
def test_the_head_moves_in_a_browser(avatar: Path, shown: Shown, browser: Browser) -> None:
    """With the real three.js: the camera looks at the mouth, weights reach the mesh, and what is drawn changes."""
    shown(avatar.read_bytes(), "--three", str(tools() / "node_modules" / "three"))
    page = browser.page(Path("page.html").absolute().as_uri())
    page.wait_for("!!window.labialHead", 60)
    assert not page.errors()
    middle = page.evaluate("labialHead.middle.toArray()")
    assert middle[0] == pytest.approx(0.3, abs=0.003) and middle[1] == pytest.approx(1.5, abs=0.003)
    drawn = []
    for frame in range(len(OPENING)):
        page.evaluate(f"labialHead.show({frame})")
        drawn.append(page.evaluate("document.querySelector('canvas').toDataURL()"))
        jaw = page.evaluate("(([mesh]) => mesh.morphTargetInfluences[mesh.morphTargetDictionary.jawOpen])"
                            "(labialHead.meshes[0])")
        assert (jaw > 0.05) == (OPENING[frame] > 100)
    assert drawn[0] == drawn[4] and drawn[1] == drawn[3] and len(set(drawn)) == 3
    page.evaluate("document.querySelector('button').click()")
    page.wait_for("document.querySelector('input').value === '4'", 20)


@pytest.mark.slow
@in_a_browser
@pytest.mark.parametrize("sound", [wav(), wav()[:20] + b"\x63\0" + wav()[22:]], ids=["short", "unknown"])
def test_the_head_moves_on_without_a_sound(avatar: Path, shown: Shown, browser: Browser, sound: bytes) -> None:
    """Behind the end of a shorter sound, and where it is not played. On a phone the whole width is seen."""
    Path("a.wav").write_bytes(sound)
    shown(avatar.read_bytes(), "--three", str(tools() / "node_modules" / "three"), "--audio", "a.wav")
    page = browser.page(Path("page.html").absolute().as_uri())
    page.command("Emulation.setDeviceMetricsOverride", {"width": 375, "height": 667, "deviceScaleFactor": 1,
                                                        "mobile": True})
    page.wait_for("window.labialHead && labialHead.camera.aspect < 1", 60)
    across = page.evaluate("""(([mesh], camera) => {
        const { count } = mesh.geometry.attributes.position;
        const point = labialHead.middle.clone();
        return Math.max(...Array.from({ length: count }, (_, i) => Math.abs(
            mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).project(camera).x)));
    })(labialHead.meshes[0], labialHead.camera)""")
    assert 0.5 < across < 1
    for _ in range(2):
        page.evaluate("labialHead.show(0); document.querySelector('button').click()")
        page.wait_for("document.querySelector('input').value === '4'", 20)
        page.wait_for("document.querySelector('button').textContent === 'Play'", 20)
    assert page.evaluate("document.querySelector('input').ariaValueText") == "0.08 s"
    assert page.evaluate("document.querySelector('output').hidden") == (sound == wav())
    assert not page.errors()
