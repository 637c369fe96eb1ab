"""What people see, in millimetres: ARKit's weights on a head from light-stage scans.

``heads/ict_lips.csv`` has lip points of ICT-FaceKit's mean head and what ARKit's shapes add to them (USC Institute for
Creative Technologies, ``heads/LICENSE.ICT``). The sentences are those of test_mouths.py, which no rig was fitted to.
"""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import pytest

from labial.errors import DataError
from labial.fit.head import Head, read_table
from labial.fit.judge import judge, matrix, opening, shown
from labial.fit.meaning import bend, fap
from labial.fit.sentences import Motion, read_sentences
from labial.rig.animation import face, outputs
from runtime import needs_runtime

HERE = Path(__file__).parent
LIPS = HERE / "heads" / "ict_lips.csv"
pytestmark = needs_runtime


@pytest.fixture(scope="module")
def head() -> Head:
    """ICT's mean head."""
    return read_table(LIPS)


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


def test_mouths_round(head: Head, spoken: Motion) -> None:
    """Where the FAPs pull the corners in and push the lips out, as in "oo", the head is seen to do so."""
    points = shown(head, matrix(head, outputs(face("arkit"), spoken.frames)))
    width = (points["corner_left"] - points["corner_right"])[:, 0] - head.mw
    meant = (fap(spoken.frames, 53) + fap(spoken.frames, 54)) * head.mw / 1024
    round_ = meant < np.percentile(meant, 5)
    assert meant[round_].mean() < -4 and 0.4 <= width[round_].mean() / meant[round_].mean() <= 1.25
    forward = (points["outer_upper"] - head.rest["outer_upper"])[:, 2]
    pushed = fap(spoken.frames, 17) > np.percentile(fap(spoken.frames, 17), 95)
    assert forward[pushed].mean() > forward[~pushed].mean() + 1.0


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


def by_label(motion: Motion) -> Dict[str, List[Tuple[int, int]]]:
    """The phonemes' frames."""
    found: Dict[str, List[Tuple[int, int]]] = {}
    for name, begin, end in motion.phonemes:
        found.setdefault(name, []).append((begin, end))
    return found


def test_lower_lip_comes_near_in_f_and_v(head: Head, spoken: Motion) -> None:
    """In f and v the lower lip rolls in and comes within 3 mm of the upper one."""
    weights = outputs(face("arkit"), spoken.frames)
    gap = opening(head, matrix(head, weights))
    places = [span for label in "fv" for span in by_label(spoken)[label]]
    assert np.mean([gap[begin:end].min() <= 3.0 for begin, end in places]) >= 0.95
    assert np.mean([weights["mouthRollLower"][begin:end].max() >= 0.2 for begin, end in places]) >= 0.8
