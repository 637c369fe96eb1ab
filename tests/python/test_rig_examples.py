"""The example programs of examples/rig: what a face would do with their output, on the bundled models."""

from __future__ import annotations

import os
import re
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

from labial.rig.description import read
from labial.rig.table import convert
from packages import SOURCE

FOLDER = os.environ.get("LABIAL_RIG_EXAMPLES", "")
pytestmark = pytest.mark.skipif(not FOLDER, reason="LABIAL_RIG_EXAMPLES does not name the folder of the programs")



def output(name: str) -> List[str]:
    """The lines that an example prints."""
    program = Path(FOLDER) / f"labial-rig-{name}"
    return subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout.splitlines()


def script() -> List[Tuple[str, int, int]]:
    """Label, first frame and end of each phoneme of examples/rig/script.c, 50 frames per second."""
    text = (SOURCE / "examples" / "rig" / "script.c").read_text()
    phonemes, begin = [], 0
    for model, label, length in re.findall(r"\{ (SPEECH|LAUGHTER), \w+?_(?:EN|SYNTHETIC)_(\w+), (\d+) \}", text):
        end = begin + int(length)
        phonemes.append((label if model == "SPEECH" else label.lower(), (begin + 10) // 20, (end + 10) // 20))
        begin = end
    return phonemes


CLOSURES = [(begin, end) for label, begin, end in script() if label in ("P", "B", "M")]
SPEECH_END = max(end for label, _, end in script() if label.isupper())
EASE = 12  # of the way to rest, after the last phoneme
FRAMES = script()[-1][2] + EASE


def test_script_is_found() -> None:
    """The tests below would say nothing about a script that they cannot read."""
    assert len(script()) == 34 + 23 and len(CLOSURES) == 6 and SPEECH_END == 187 and FRAMES == 314 + EASE


def test_jaw_opens_wide_and_closes() -> None:
    """The default gain must use the servo's range, and p, b, m must close a mouth that has nothing but a jaw."""
    rows = np.array([[int(x) for x in line.split(",")] for line in output("jaw")])
    assert rows[:, 0].tolist() == list(range(len(rows))) and FRAMES < len(rows) < FRAMES + 40
    pulse = rows[:, 1]
    assert pulse[-1] == 1400
    assert pulse.min() >= 1400 and pulse.max() <= 1900 and pulse.max() >= 1800
    for begin, end in CLOSURES:
        assert pulse[begin:end].min() < 1400 + 0.2 * 500
    assert np.ptp(pulse[SPEECH_END:]) > 80  # the laugh's pulses are smaller than speech, but seen


def test_servos_are_written_to_the_chip() -> None:
    """Set-up in the order the chip needs; servo after servo, half a second each; then 20 bytes per frame, within each
    servo's limits and its slew, and rest at the end."""
    rig = read(SOURCE / "examples" / "faces" / "servos.toml", "servos")
    outputs = convert(rig)
    lines = [[int(x, 16) for x in line.split()] for line in output("servos")]
    assert lines[:3] == [[0x00, 0x10], [0xFE, rig.unit.prescale], [0x00, 0x20]]
    start, lines = lines[3:3 + 25 * len(outputs)], lines[3 + 25 * len(outputs):]
    assert [len(line) for line in start] == [1 + 4 * min(1 + tick // 25, 5) for tick in range(1, 126)]
    begin = next(number for number, line in enumerate(lines) if line != start[-1])
    frames = np.array(lines)
    assert frames.shape[1] == 1 + 4 * len(outputs) and (frames[:, 0] == 0x06).all()
    assert all(line == start[-1][:len(line)] for line in start) and lines[-1] == start[-1]
    assert FRAMES <= len(frames) < FRAMES + 60
    pairs = frames[:, 1:].reshape(len(frames), len(outputs), 4)
    assert (pairs[:, :, :2] == 0).all()
    ticks = pairs[:, :, 2] + 256 * pairs[:, :, 3]
    for column, servo in zip(ticks.T, outputs):
        assert column.min() >= servo.minimum and column.max() <= servo.maximum
        assert np.ptp(column) > 0.5 * (servo.maximum - servo.minimum), servo.name
        if servo.slew:
            assert np.abs(np.diff(column)).max() <= servo.slew
    # The corners are mirror images: in the laugh one goes up as the other goes down.
    left, right = ticks[begin + SPEECH_END + 10:begin + FRAMES - 20, 3:].T
    assert left.min() > outputs[3].neutral and right.max() < outputs[4].neutral


def test_blendshapes_are_weights() -> None:
    """Every shape is used and stays a weight; lips close over the open jaw; the laugh smiles and speech hardly does."""
    header, *rows = output("arkit")
    names = header.split(",")[1:]
    assert names == [item.name for item in read(SOURCE / "export" / "labial" / "rig" / "arkit.toml", "arkit").outputs]
    values = np.array([[float(x) for x in row.split(",")] for row in rows])
    assert np.allclose(values[:, 0], np.arange(FRAMES) / 50)
    weights = dict(zip(names, values[:, 1:].T))
    for name, column in weights.items():
        assert column.min() >= 0 and column.max() <= 1 and column.max() > (0.04 if name == "mouthClose" else 0.1), name
    for begin, end in CLOSURES:
        gap = (weights["jawOpen"] - weights["mouthClose"])[begin:end]
        assert gap.min() < 0.05
    smile = (weights["mouthSmileLeft"] + weights["mouthSmileRight"]) / 2
    assert smile[SPEECH_END + 15:].mean() > 0.2 and smile[:SPEECH_END - 15].mean() < 0.09


def test_pictures_are_chosen() -> None:
    """An animation of one picture per frame: closed in p, b, m, smiling in the laugh, without flicker."""
    text = "\n".join(output("sprites"))
    root = ET.fromstring(text)
    space = "{http://www.w3.org/2000/svg}"
    animation = next(root.iter(f"{space}animateTransform"))
    shown = np.array([-int(x) // 120 for x in animation.attrib["values"].split(";")])
    names = [item.text for item in root.iter(f"{space}text")]
    assert len(names) == 12 and len(shown) == FRAMES and 0 <= shown.min() and shown.max() < 12
    assert animation.attrib["dur"] == f"{20 * FRAMES}ms"
    for begin, end in CLOSURES:
        assert "p b m" in {names[number] for number in shown[begin:end]}
    assert {names[number] for number in shown[SPEECH_END + 15:-EASE]} <= {"smile", "laugh"}
    assert names[shown[-1]] == "rest"
    assert len(set(shown)) >= 7
    runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[-1], shown, [-1]]))))
    assert runs[:-1].min() >= 2 and len(runs) < FRAMES / 4
