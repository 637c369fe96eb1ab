"""``labial fit`` on heads whose shapes have names of their own: which are known, which are left and right ones, how a
description spells them, and whether a table holds what was solved."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import pytest

import labial
from avatars import document_of, glb, made_head
from labial.__main__ import main
from labial.fit.avatar import Mesh
from labial.fit.fit import describe, fit, output_name, output_names
from labial.fit.head import Head, of_head, plain
from labial.fit.kinds import known, shapes_for, unknown
from labial.fit.landmarks import read_head
from labial.fit.meaning import Figures
from labial.fit.solve import FEATURES, Group, Solution, groups_of
from labial.rig.animation import face, outputs
from labial.rig.description import read
from labial.rig.table import FAP_MAX, convert
from packages import needs_runtime

VERTICES, TRIANGLES, SHAPES = made_head()
#: How files spell sides.
SPELLINGS = ("{base}{Side}", "{base}_{S}", "{base}_{s}", "{base}_{side}", "{base}{S}", "{base}{SIDE}", "{base}.{S}",
             "{base}.{s}", "{base}-{S}", "{base} {S}", "{S}_{base}", "{s}_{base}", "{S}{Base}", "{Side}_{base}",
             "{side} {base}", "mouth{Side}{stem}", "mouth_{S}_{stem}", "blendShape1.{base}.{S}")


def spelled(name: str, spelling: str) -> str:
    """ARKit's name with its side spelled so."""
    side = name[-4:] if name.endswith("Left") else name[-5:]
    if side not in ("Left", "Right"):
        return name
    base = name[: -len(side)]
    return spelling.format(base=base, Base=base[0].upper() + base[1:], stem=base[len("mouth"):], Side=side,
                           side=side.lower(), SIDE=side.upper(), S=side[0], s=side[0].lower())


def head_of(shapes: Dict[str, np.ndarray]) -> Head:
    return read_head([Mesh("face", VERTICES, TRIANGLES, shapes)], "a.glb", {}).head


def file_of(path: Path, shapes: Dict[str, np.ndarray]) -> str:
    path.write_bytes(glb(*document_of(VERTICES, TRIANGLES, shapes)))
    return str(path)


# ---- Left and right --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_sides_however_they_are_spelled(spelling: str) -> None:
    """Catches a pair of which one, or both, are left out of ARKit's shapes, or that the solver moves each by itself:
    a crooked mouth."""
    own = {name: spelled(name, spelling) for name in SHAPES}
    head = head_of({own[name]: move for name, move in SHAPES.items()})
    assert known(head, "arkit") == {shape: name for name, shape in own.items()}
    assert set(of_head(head)) == {(own[f"{base}Left"], own[f"{base}Right"])
                                  for base in ("mouthSmile", "mouthStretch", "mouthUpperUp")}
    assert sorted(len(group.members) for group in groups_of(head.shapes)) == [1, 1, 1, 2, 2, 2]
    found = shapes_for(head, "arkit", [output.name for output in face("arkit").outputs])
    assert found["mouthSmileLeft"] == own["mouthSmileLeft"] and found["mouthSmileRight"] == own["mouthSmileRight"]


def test_letters_that_are_no_sides() -> None:
    """The phonemes L and R move both halves; a name may have another side's letters in it."""
    shapes = {"mouthOpen": SHAPES["jawOpen"], "v_L": 0.3 * SHAPES["jawOpen"],
              "v_R": 0.3 * SHAPES["jawOpen"] + SHAPES["mouthPucker"], "bright": 0.2 * SHAPES["jawOpen"]}
    assert of_head(head_of(shapes)) == []
    assert [len(group.members) for group in groups_of(["mouthRollLower", "RR", "nn", "U", "upright"])] == [1] * 5


def test_pairs_by_what_they_move() -> None:
    """Names in another language, the right one first: the left one is that which moves the left half."""
    names = {"mouthSmileRight": "sorriso_dx", "mouthSmileLeft": "sorriso_sx"}
    shapes = {"mouthOpen": SHAPES["jawOpen"], **{own: SHAPES[name] for name, own in names.items()}}
    assert of_head(head_of(shapes)) == [("sorriso_sx", "sorriso_dx")]
    groups = groups_of(["sorriso_dx", "mouthOpen", "sorriso_sx"], [("sorriso_sx", "sorriso_dx")])
    assert [group.members for group in groups] == [((2, "left"), (0, "right")), ((1, "middle"),)]


@needs_runtime
@pytest.mark.parametrize("lost", ["", "mouthStretchRight"])
def test_a_crooked_mouth_is_told(tmp_path: Path, lost: str) -> None:
    """A head of which one shape of a pair was lost: its mouth is wide on one side."""
    shapes = {"mouthOpen" if name == "jawOpen" else f"my_{name}": move for name, move in SHAPES.items()
              if name != lost and "Smile" not in name}
    told = [line for line in fit([file_of(tmp_path / "a.glb", shapes)], {}, None, "a").report if "in doubt" in line]
    assert len(told) == (1 if lost else 0), told
    assert not lost or ("mm sideways" in told[0] and "one of a pair is missing" in told[0])


@needs_runtime
def test_what_is_not_recognised_is_listed(tmp_path: Path) -> None:
    """Shapes that move the lips under names that ARKit, visemes and VRM do not have; none that is known and unused."""
    extra = {"mouthLeft": SHAPES["mouthStretchLeft"], "viseme_RR": 0.2 * SHAPES["jawOpen"], "blink": 0 * VERTICES}
    assert unknown(head_of({**SHAPES, **extra})) == []
    grins = {f"grin{number}": SHAPES["mouthSmileLeft"] + SHAPES["mouthSmileRight"] for number in range(9)}
    report = fit([file_of(tmp_path / "a.glb", {**SHAPES, **extra, **grins})], {}, None, "a").report
    assert [line for line in report if "not used" in line] == [
        "a: not used, though they move the lips: grin0, grin1, grin2, grin3, grin4, grin5 and 3 more; --shapes names "
        "those to use"]


# ---- Names of outputs ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("shape", "name"), [
    ("jawOpen", "jawOpen"), ("blendShape1.jawOpen", "jawOpen"), ("mouthSmile.L", "mouthSmile_L"),
    ("blendShape1.mouthSmile.L", "mouthSmile_L"), ("jawOpen.001", "jawOpen_001"), ("Lip O", "Lip_O"),
    ("1", "shape_1"), ("...", "shape_"), (".L", "shape__L"), ("x" * 40, "x" * 32),
])
def test_names_of_outputs(shape: str, name: str) -> None:
    """What C can spell; Blender's sides stay."""
    assert output_name(shape) == name and output_names([shape]) == {shape: name}


def test_names_for_comparing() -> None:
    assert [plain(name) for name in ("blendShape1.jaw_Open", "mouthSmile.L", "Jaw Open", "a.b.c")] == [
        "jawopen", "mouthsmilel", "jawopen", "c"]


def test_names_that_would_be_the_same() -> None:
    """Each is another one also in capitals, at most 32 long, and none that a description refuses. What can be spelled
    keeps its name, and long names keep what tells them apart."""
    group = "Character_Head_Mesh_BlendShapes_Group_"
    shapes = ["a.Smile", "Smile", "Lip_O", "lip_o", "LIP O", "Outputs", group + "jawOpen", group + "mouthSmileLeft",
              "y" * 40, "y" * 41, "y" * 42]
    names = output_names(shapes)
    assert names == {"Smile": "Smile", "a.Smile": "Smile_2", "Lip_O": "Lip_O", "lip_o": "lip_o_2", "LIP O": "LIP_O_3",
                     "Outputs": "Outputs_2", group + "jawOpen": "jawOpen",
                     group + "mouthSmileLeft": "mouthSmileLeft", "y" * 40: "y" * 32, "y" * 41: "y" * 30 + "_2",
                     "y" * 42: "y" * 30 + "_3"}
    many = output_names([f"{'z' * 40}{number}" for number in range(300)])
    assert len({name.upper() for name in many.values()}) == 300 and max(map(len, many.values())) == 32


@needs_runtime
def test_both_of_a_pair_have_their_name_beside_them(tmp_path: Path) -> None:
    text = fit([file_of(tmp_path / "a.glb", {spelled(name, "{base}.{S}"): move for name, move in SHAPES.items()})],
               {}, None, "a").text
    for side in "LR":
        assert f"[output.mouthStretch_{side}]    # in the file: mouthStretch.{side}\n" in text


# ---- What is solved is held ------------------------------------------------------------------------------------------


@needs_runtime
def test_vowels_are_fitted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Five shapes that follow all FAPs, steeply: the table holds them, and the C library shows what was solved."""
    wide, smile = (SHAPES[f"{name}Left"] + SHAPES[f"{name}Right"] for name in ("mouthStretch", "mouthSmile"))
    jaw, round_ = SHAPES["jawOpen"], SHAPES["mouthPucker"]
    shapes = {"A": 0.6 * jaw, "E": 0.3 * jaw + 0.4 * wide, "I": 0.12 * jaw + 0.5 * smile,
              "O": 0.35 * jaw + 0.5 * round_, "U": 0.15 * jaw + 0.8 * round_}
    path = tmp_path / "vowels.toml"
    assert main(["fit", file_of(tmp_path / "a.glb", shapes), "-o", str(path), "--no-figure"]) == 0
    assert "of the kind other" in capsys.readouterr().out
    frames = np.random.default_rng(1).integers(-600, 601, (300, 13))
    shown, wanted = labial.Rig(path), outputs(read(path, "vowels"), frames)
    for number, frame in enumerate(frames.tolist()):
        for name, weight in shown.apply(frame).items():
            assert weight == pytest.approx(wanted[name][number], abs=0.001 + 1e-9)


def solution(*slopes: float) -> str:
    """The description of one shape with these slopes."""
    made = Solution([Group("Kiss", ((0, "middle"),))], np.array([slopes]), np.array([-0.0123]), np.array([1.0]))
    return describe(made, ["Kiss"], ["made"], {}, {"Kiss": "Kiss"})


@pytest.mark.parametrize("steepness", [1.0, 4.0, 30.0, 900.0])
def test_a_table_holds_every_description(tmp_path: Path, steepness: float) -> None:
    """However steep and uneven. A table is within half a unit of the description up to FAP_MAX; where it cannot be, the
    least coefficients are missing, and the greatest is there."""
    rng = np.random.default_rng(int(steepness))
    for _ in range(20):
        slopes = steepness * rng.uniform(0.1, 1.0, len(FEATURES)) * rng.choice([-1.0, 1.0], len(FEATURES))
        path = tmp_path / "kiss.toml"
        path.write_text(solution(*slopes))
        [output], [row] = read(path, "kiss").outputs, convert(read(path, "kiss"))
        assert "1.000" in path.read_text()
        wanted = np.array(output.weights) * output.gain * 1000.0
        error = np.abs(np.array(row.weights) / 4096.0 * row.gain / 65536.0 - wanted).sum() * FAP_MAX
        assert error <= 0.49 and np.count_nonzero(row.weights) >= (9 if steepness <= 4.0 else 1)


def test_a_chin_that_is_not_known() -> None:
    """Its error is no number."""
    figures: Tuple[float, ...] = (1.0,) * len(Figures._fields)
    line: List[str] = [Figures(*figures)._replace(jaw=jaw).text() for jaw in (0.5, float("nan"))]
    assert "jaw 0.50," in line[0] and "jaw unmeasured (no chin)," in line[1] and "nan" not in line[1]
