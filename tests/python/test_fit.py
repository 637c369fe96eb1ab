"""``labial fit``: avatars are read, their lips found, and a rig solved that shows what the FAPs mean.

``heads/ict_lips.csv`` has lip points of ICT-FaceKit's mean head, from light-stage scans, and what ARKit's shapes add to
them (USC Institute for Creative Technologies, ``heads/LICENSE.ICT``). The sentences are those of test_animation.py,
which no rig was fitted to.
"""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Callable, Dict

import numpy as np
import pytest

from avatars import TRUE, document_of, glb, made_head
from labial.__main__ import main
from labial.errors import DataError
from labial.fit.avatar import Mesh
from labial.fit.avatar import read as read_avatar
from labial.fit.head import Head, read_table
from labial.fit.kinds import shapes_for
from labial.fit.landmarks import read_head
from labial.fit.meaning import bend, judge, matrix, opening, shown
from labial.fit.solve import Motion, read_sentences
from labial.rig.animation import face, outputs
from labial.rig.description import read
from packages import needs_runtime

HERE = Path(__file__).parent


def write(path: Path, **options: object) -> Path:
    """The made head as a file."""
    path.write_bytes(glb(*document_of(*made_head(), **options)))
    return path


@pytest.mark.slow
@needs_runtime
def test_a_fitted_head_shows_what_is_meant(tmp_path: Path, capsys: pytest.CaptureFixture[str], head: Head,
                                           spoken: Motion) -> None:
    """ICT's head in sentences that were not solved for; catches a solver that stalls, and a rig that the text of the
    description does not hold."""
    assert main(["fit", str(HERE / "heads" / "ict_lips.csv"), "-o", str(tmp_path / "ict.toml")]) == 0
    printed = capsys.readouterr().out
    assert "21.2 mm from nose to mouth" in printed and "p, b, m closed 1.000" in printed
    rig = read(tmp_path / "ict.toml", "ict")
    found = judge(head, matrix(head, outputs(rig, spoken.frames)), spoken.frames, spoken.closures)
    assert 0.9 <= found.ratio <= 1.1 and found.opening <= 1.0 and found.width <= 1.0, found.text()
    assert found.closed >= 0.98 and found.through == 0.0 and found.deepest >= -2.5, found.text()
    assert all(column[0] == 0.0 for column in outputs(rig, np.zeros((1, 13))).values())
    left, right = (next(item for item in rig.outputs if item.name == f"mouthSmile{side}") for side in ("Left", "Right"))
    assert left.gain == right.gain and left.weights[5] == right.weights[6] and left.weights[6] == 0.0


@pytest.mark.parametrize("unit", [0.001, 0.1, 1.0, 0.004])
def test_points_are_found(tmp_path: Path, unit: float) -> None:
    """In metres, centimetres, millimetres and a unit that nobody knows."""
    path = write(tmp_path / "head.glb", unit=unit, sparse=unit == 0.1)
    found = read_head(read_avatar(path), str(path), {})
    sized = found.head.mns / 19.7
    assert sized == pytest.approx(1.0 if unit != 0.004 else 21.2 / 19.7, abs=0.12)
    scale = 1.0 / (unit * found.scale)
    for point, (x, y) in TRUE.items():
        assert found.head.rest[point][:2] * scale == pytest.approx((x, y), abs=2.6), point
    assert 40 < -found.head.rest["chin"][1] * scale < 56
    assert ("no human size" in " ".join(found.doubts)) == (unit == 0.004)


def test_where_a_mesh_stands_changes_nothing(tmp_path: Path) -> None:
    """A node that turns, stretches and moves its mesh, below another one."""
    head = read_head(read_avatar(write(tmp_path / "a.glb")), "a", {}).head
    document, binary = document_of(*made_head(), unit=0.0005)
    document["nodes"] = [{"mesh": 0, "name": "head", "scale": [2, 2, 2]},
                         {"children": [0], "translation": [0.1, 1.6, 0.3]}]
    (tmp_path / "b.glb").write_bytes(glb(document, binary))
    moved = read_head(read_avatar(tmp_path / "b.glb"), "b", {}).head
    assert moved.mns == pytest.approx(head.mns, abs=1e-3)
    assert moved.moves["chin"] == pytest.approx(head.moves["chin"], abs=1e-3)


def test_a_head_that_faces_away_is_doubted() -> None:
    vertices, triangles, shapes = made_head()
    for sign in (1.0, -1.0):
        turn = np.array([sign, 1.0, sign])
        mesh = Mesh("face", vertices * turn, triangles, {name: move * turn for name, move in shapes.items()})
        assert ("seems to face -z" in " ".join(read_head([mesh], "a.glb", {}).doubts)) == (sign < 0)


@pytest.mark.slow
@needs_runtime
def test_an_avatar_is_fitted_and_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str], spoken: Motion) -> None:
    """From a file to a rig and a picture, with names that a description cannot spell; the rig reaches on this head what
    is asked of fitted heads."""
    path = tmp_path / "my head.glb"
    path.write_bytes(glb(*document_of(*made_head("blendShape1."))))
    assert main(["fit", str(path), "-o", str(tmp_path / "mine.toml")]) == 0
    printed = capsys.readouterr().out
    assert "of the kind arkit" in printed and str(tmp_path / "mine.png") in printed
    assert (tmp_path / "mine.png").read_bytes()[:4] == b"\x89PNG"
    text = (tmp_path / "mine.toml").read_text()
    assert "[output.jawOpen]    # in the file: blendShape1.jawOpen" in text
    head = read_head(read_avatar(path), str(path), {}).head
    weights = outputs(read(tmp_path / "mine.toml", "mine"), spoken.frames)
    named = {f"blendShape1.{name}": column for name, column in weights.items()}
    found = judge(head, matrix(head, named), spoken.frames, spoken.closures)
    assert 0.9 <= found.ratio <= 1.1 and found.opening <= 1.0, found.text()
    assert found.closed >= 0.98 and found.deepest >= -2.5, found.text()


def test_a_mouth_that_is_open_at_rest_is_told() -> None:
    """Its lips stay apart in p, b, m whatever is solved for."""
    vertices, triangles, shapes = made_head()
    apart = vertices - np.where(vertices[:, 1] < -0.2, 1.4, 0.0)[:, None] * np.eye(3)[1]
    for rest, told in ((vertices, False), (apart, True)):
        found = read_head([Mesh("face", rest, triangles, shapes)], "a.glb", {})
        assert ("the inner lips are 2.0 mm apart at rest" in " ".join(found.doubts)) == told


@needs_runtime
@pytest.mark.parametrize("version", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_vrm(tmp_path: Path, version: int, capsys: pytest.CaptureFixture[str]) -> None:
    """The expressions of either version are the shapes; VRM 0 faces the other way, and weighs in percent."""
    vertices, triangles, shapes = made_head(mouth="vrm")
    turn = np.diag([-1.0, 1.0, -1.0]) if version == 0 else np.eye(3)
    moved = {f"M_{name}": 2.0 * move @ turn for name, move in shapes.items()}
    document, binary = document_of(vertices @ turn, triangles, moved)
    names = dict(zip("AUI", ("a u i" if version == 0 else "aa ou ih").split()))
    if version == 0:
        document["extensions"] = {"VRM": {"blendShapeMaster": {"blendShapeGroups": [
            {"presetName": names[key], "binds": [{"mesh": 0, "index": place, "weight": 50}]}
            for place, key in enumerate("AUI")]}}}
    else:
        document["extensions"] = {"VRMC_vrm": {"expressions": {"preset": {
            names[key]: {"morphTargetBinds": [{"node": 0, "index": place, "weight": 0.5}]}
            for place, key in enumerate("AUI")}}}}
    path = tmp_path / "avatar.vrm"
    path.write_bytes(glb(document, binary))
    found = read_head(read_avatar(path), str(path), {})
    at = [found.head.shapes.index(name) for name in ("aa", "M_A")]
    assert found.head.moves["inner_lower"][at[0], 1] == pytest.approx(-17.6, abs=0.5)
    assert found.head.moves["inner_lower"][at[1], 1] == pytest.approx(-35.2, abs=1.0)
    assert found.head.rest["corner_left"][0] > 20
    assert main(["fit", str(path), "-o", str(tmp_path / "a.toml"), "--no-figure"]) == 0
    assert "of the kind vrm" in capsys.readouterr().out and not (tmp_path / "a.png").exists()
    assert {item.name for item in read(tmp_path / "a.toml", "a").outputs} <= {"aa", "ou", "ih"}


@needs_runtime
def test_points_that_are_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """--point decides; what is no point or no vertex is an error that says what there is."""
    path, out = str(write(tmp_path / "head.glb")), str(tmp_path / "a.toml")
    assert main(["fit", path, "-o", out, "--no-figure", "--point", "chin=77"]) == 0
    assert "chin=77" in capsys.readouterr().out
    for given, message in (("chin", "--point is NAME=INDEX"), ("chin=-1", "--point is NAME=INDEX"),
                           ("ear=3", "no point is called 'ear'"), ("chin=999999", "999999 is no vertex")):
        assert main(["fit", path, "-o", out, "--point", given]) == 1
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1


BROKEN: Dict[str, Callable[[Dict], None]] = {
    "its meshes are compressed (EXT_meshopt_compression); unpack them first: npx @gltf-transform/cli copy '":
        lambda d: d.update(extensionsRequired=["EXT_meshopt_compression"]),
    "needs extensions that are not known here: ACME_mesh": lambda d: d.update(extensionsRequired=["ACME_mesh"]),
    "has no mesh with shapes": lambda d: d["meshes"][0]["primitives"][0].pop("targets"),
    "or aa is needed; there are b, c, d, e, f, g, h, i, j. Rename the one that does":
        lambda d: d["meshes"][0]["extras"].update(targetNames=list("bcdefghij")),
    "moves nothing down, towards -y: in glTF y is up":
        lambda d: d["nodes"][0].update(rotation=[0.5**0.5, 0, 0, 0.5**0.5]),
    "goes beyond its buffer": lambda d: d["accessors"][0].update(count=10**6),
    "its accessors unpack to 25,770,": lambda d: d["accessors"][0].update(count=1 << 30),
    "the triangles of mesh 0 are broken": lambda d: d["accessors"][1].update(count=5),
    "the nodes are no tree": lambda d: d["nodes"][0].update(children=[0]),
    "lies outside the file's folder": lambda d: d["buffers"][0].update(uri="../../etc/passwd"),
    "is not a whole .glb": lambda d: d.pop("accessors"),
}


@pytest.mark.parametrize("message", BROKEN)
def test_broken_files(tmp_path: Path, capsys: pytest.CaptureFixture[str], message: str) -> None:
    """One line that names the file and what is wrong; nothing is written."""
    document, binary = document_of(*made_head())
    document = copy.deepcopy(document)
    BROKEN[message](document)
    path = tmp_path / "my head" / "a.glb"
    path.parent.mkdir()
    path.write_bytes(glb(document, binary))
    assert main(["fit", str(path), "-o", str(tmp_path / "b.toml")]) == 1
    error = capsys.readouterr().err
    assert message in error and str(path) in error and error.count("\n") == 1
    assert "npx" not in error or f"copy '{path}' '{path.parent}/a-plain.glb'" in error
    assert not (tmp_path / "b.toml").exists()


@pytest.mark.parametrize("content, message", [
    (b"version https://git-lfs.github.com/spec/v1\noid sha256:0", "a pointer of Git LFS: git lfs pull"),
    (b"Kaydara FBX Binary  \0", "it begins neither with glTF nor with JSON"), (b"", "neither with glTF nor with JSON")])
def test_files_of_other_kinds(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "a.glb").write_bytes(content)
    with pytest.raises(DataError, match=message):
        read_avatar(tmp_path / "a.glb")


def test_any_bytes(tmp_path: Path) -> None:
    """Files cut anywhere, and with bytes changed at random, are read or refused, and nothing else."""
    whole = glb(*document_of(*made_head()))
    rng = np.random.default_rng(5)
    path = tmp_path / "a.glb"
    texts = [b"", b"glTF", b"{}", json.dumps([1]).encode(), whole[:20], whole[: len(whole) // 2]]
    for _ in range(40):
        changed = bytearray(whole)
        for place in rng.integers(12, 5000, 4):
            changed[place] = rng.integers(256)
        texts.append(bytes(changed))
    for text in texts:
        path.write_bytes(text)
        try:
            read_avatar(path)
        except DataError as error:
            assert str(path) in str(error)


# ---- What people see, in millimetres: ARKit's weights on a head from scans


@pytest.fixture(scope="module")
def head() -> Head:
    """ICT's mean head."""
    return read_table(HERE / "heads" / "ict_lips.csv")


@pytest.fixture(scope="module")
def spoken() -> Motion:
    """32 sentences."""
    return read_sentences(HERE / "sentences.flite")


def mean_opening(gap: np.ndarray, motion: Motion, label: str) -> float:
    """Millimetres, over the whole of each phoneme of that label."""
    return float(np.mean([gap[begin:end].mean() for name, begin, end in motion.phonemes if name == label]))


def test_the_head_is_read(head: Head) -> None:
    """Catches another unit, a point that is another one's, and left for right, against what the table's source says."""
    assert head.mns == pytest.approx(21.2, abs=0.05) and head.mw == pytest.approx(50.7, abs=0.05)
    assert head.rest["corner_left"][0] > 25 > -25 > head.rest["corner_right"][0]
    jaw = head.shapes.index("jawOpen")
    assert head.moves["chin"][jaw, 1] < -20 and abs(head.moves["nose"][jaw, 1]) < 1.5
    smile = head.shapes.index("mouthSmileLeft")
    assert head.moves["corner_left"][smile, 0] > 3 and abs(head.moves["corner_right"][smile, 0]) < 1


def test_figures_are_those_of_a_case_by_hand() -> None:
    """Two shapes, one frame open and one closed, every figure worked out on paper."""
    up = np.array([0.0, 1.0, 0.0])
    rest = {"nose": 20.48 * up, "inner_upper": 0.0 * up, "inner_lower": 0.0 * up, "corner_left": np.array([25.6, 0, 0]),
            "corner_right": np.array([-25.6, 0, 0]), "chin": -40.0 * up}
    still = np.zeros((2, 3))
    moves = {point: still for point in rest}
    moves["inner_lower"] = np.stack([-20.0 * up, np.zeros(3)])  # jaw: 20 mm down
    moves["corner_left"] = np.stack([np.zeros(3), np.array([5.0, 0, 0])])
    made = Head("made", ("jaw", "wide"), rest, moves)
    frames = np.zeros((2, 13))
    frames[0, 4] = -500  # 10 mm of opening: a unit is 20.48 / 1024 mm
    frames[0, 5] = 100  # 5 mm of width: a unit is 51.2 / 1024 mm
    found = judge(made, np.array([[0.6, 0.4], [0.2, 0.0]]), frames, [(1, 2)])
    assert found.opening == pytest.approx(np.sqrt((2.0**2 + 4.0**2) / 2))
    assert found.width == pytest.approx(np.sqrt((3.0**2 + 0.0) / 2))
    assert found.shown == pytest.approx(np.percentile([12.0, 4.0], 95)) and found.closed == 0.0
    assert found.meant == pytest.approx(np.percentile([10.0, 0.0], 95)) and found.deepest == pytest.approx(4.0)
    through = judge(made, np.array([[0.6, 0.4], [-0.2, 0.0]]), frames, [(1, 2)])
    assert (through.closed, through.through, through.deepest) == (1.0, 1.0, pytest.approx(-4.0))
    assert shown(made, np.array([[0.5, 1.0]]))["corner_left"][0] == pytest.approx([30.6, 0, 0])
    assert bend(np.array([-1.0, 0.0, 1.0, 8.0, 20.0])) == pytest.approx([0.0, 0.0, 0.0, 8.0, 20.0])


def test_shapes_of_built_in_rigs() -> None:
    """Catches an output of a built-in rig that a head has under another spelling, and that would move nothing."""
    names = ("mouthPress_L", "mouthPress_R", "tongueOut", "viseme_I", "viseme_CH", "Fcl_MTH_E", "v_aa", "aa")
    still = {point: np.zeros((len(names), 3)) for point in ("nose",)}
    made = Head("made", names, {"nose": np.zeros(3)}, still)
    assert shapes_for(made, "arkit", ["mouthPressLeft", "mouthPressRight", "tongueOut", "jawOpen"]) == {
        "mouthPressLeft": "mouthPress_L", "mouthPressRight": "mouthPress_R", "tongueOut": "tongueOut"}
    assert shapes_for(made, "oculus", ["ih", "CH", "oh", "aa"]) == {"ih": "viseme_I", "CH": "viseme_CH", "aa": "aa"}
    assert shapes_for(made, "vrm", ["ee", "aa", "ou"]) == {"ee": "Fcl_MTH_E", "aa": "aa"}


@needs_runtime
def test_arkit_on_a_real_head(head: Head, spoken: Motion) -> None:
    """Catches a default that a viewer would see as a mouth torn open, lips that pass through each other, and an "oo"
    that is the widest vowel of all: all of which 0.3's first rig did, with figures of its own that were right."""
    weights = matrix(head, outputs(face("arkit"), spoken.frames))
    found = judge(head, weights, spoken.frames, spoken.closures)
    assert len(spoken.closures) > 100 and 0.8 <= found.ratio <= 1.25, found.text()
    assert found.opening <= 2.0 and found.width <= 1.5 and found.corners <= 1.5 and found.upper <= 1.0, found.text()
    assert found.jaw <= 2.0 and found.forward <= 1.5 and found.lower <= 2.0, found.text()
    assert found.closed >= 0.98 and found.through == 0.0 and found.deepest >= -2.5, found.text()
    gap = opening(head, weights)
    assert mean_opening(gap, spoken, "uw") < 0.85 * mean_opening(gap, spoken, "aa")


@pytest.mark.parametrize(("lines", "message"), [
    ("shape,nose_x\n", ":1: the first line must name the columns"),
    ("shape,nose_x,nose_y,nose_z\nneutral,0,0,x\n", ":2: a value is no number"),
    ("shape,nose_x,nose_y,nose_z\nneutral,0,0,nan\n", ":2: 4 columns of finite numbers"),
    ("shape,nose_x,nose_y,nose_z\nneutral,0,0,0\nneutral,0,0,0\n", ":3: duplicate shape 'neutral'"),
    ("shape,nose_x,nose_y,nose_z\nneutral,0,0,0\n", "a row `neutral` and at least one shape"),
    ("shape,nose_x,nose_y,nose_z\nneutral,0,0,0\njawOpen,0,0,0\n", "missing: corner_left, corner_right, inner"),
])
def test_broken_tables(tmp_path: Path, lines: str, message: str) -> None:
    """Each is an error that names the file and, where there is one, the line."""
    path = tmp_path / "head.csv"
    path.write_text(lines)
    with pytest.raises(DataError) as caught:
        read_table(path)
    assert message in str(caught.value) and str(path) in str(caught.value)


@needs_runtime
def test_lower_lip_comes_near_in_f_and_v(head: Head, spoken: Motion) -> None:
    """In f and v the lower lip rolls in, and comes within 3 mm of the upper one where only FAPs are known; where the
    sounds are, the upper teeth show above it."""
    places = [(begin, end) for label, begin, end in spoken.phonemes if label in ("f", "v")]
    gap = opening(head, matrix(head, outputs(face("arkit"), spoken.frames)))
    assert np.mean([gap[begin:end].min() <= 3.0 for begin, end in places]) >= 0.95
    weights = outputs(face("arkit"), spoken.frames, spoken.shares)
    gap = opening(head, matrix(head, weights))
    least = [gap[begin:end].min() for begin, end in places]
    assert np.median(least) > 2.0 and np.percentile(least, 95) <= 5.0
    assert np.mean([weights["mouthRollLower"][begin:end].max() >= 0.2 for begin, end in places]) >= 0.8
