"""``labial rig``: the generated C against a float64 rig, the drawing, the examples, and every error by file and key."""

from __future__ import annotations

import random
import subprocess
import sys
import xml.etree.ElementTree as ET
from array import array
from pathlib import Path
from typing import Callable, List

import numpy as np
import pytest

from labial.__main__ import main
from labial.errors import LabialError, ModelError
from labial.files.c import OWN_TABLES, check_name
from labial.rig import table
from labial.rig.description import SOURCES, read
from labial.rig.table import FAP_MAX, convert, expected
from labial.runtime.rig import Rig
from labial.tables.visemes import VISEMES
from packages import CC, CXX, SOURCE, needs_runtime, run, warnings

FACES = SOURCE / "examples" / "faces"
#: Descriptions whose tables are kept, with the tables' folder; Python reads those of examples/pi, beside and
#: esp32-beside, which have none.
EXAMPLES = {path: path.parent for path in sorted((SOURCE / "examples").glob("*/*.toml"))
            if path.parent.name not in ("pi", "beside", "esp32-beside")}
EXAMPLES.update(dict.fromkeys(sorted((SOURCE / "export" / "labial" / "rig").glob("*.toml")), FACES))

JAW = '[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 1900\n'

DRIVER = """
#include <stdio.h>
#include "@.h"
int main(void)
{
    int16_t faps[LABIAL_CHANNELS];
    int32_t values[@_OUTPUTS_];
    if (labial_rig_check(&@) != LABIAL_OK || @.count != @_OUTPUTS_) return 2;
    while (fread(faps, sizeof faps[0], LABIAL_CHANNELS, stdin) == LABIAL_CHANNELS) {
        labial_rig_rest(&@, values);
        labial_rig_apply(&@, faps, values);
        fwrite(values, sizeof values[0], @_OUTPUTS_, stdout);
    }
    return 0;
}
"""


def native(folder: Path, name: str, frames: np.ndarray, *flags: str) -> np.ndarray:
    """(T, N) values that the C library makes of the table NAME in `folder`, each frame from rest."""
    driver = DRIVER.replace("@_OUTPUTS_", f"{name.upper()}_OUTPUTS").replace("@", name)
    (folder / "driver.c").write_text(driver)
    program = folder / "driver"
    run(CC, "-std=c99", *warnings("c"), *flags, f"-I{SOURCE / 'include'}", f"-I{folder}", folder / "driver.c",
        folder / f"{name}.c", SOURCE / "lib" / "rig.c", "-o", program)
    done = subprocess.run([str(program)], input=frames.astype("<i2").tobytes(), capture_output=True, check=True)
    return np.frombuffer(done.stdout, "<i4").reshape(len(frames), -1)


def some_frames(seed: int) -> np.ndarray:
    """(T, 13) whole FAPs: ordinary, wide and every channel at its ends."""
    rng = np.random.default_rng(seed)
    ends = int(FAP_MAX) * np.concatenate([np.eye(13), -np.eye(13), np.ones((1, 13)), np.zeros((1, 13))])
    return np.concatenate([ends, rng.integers(-150, 151, (300, 13)), rng.integers(-1000, 1001, (300, 13))]).astype(int)


def made_up(seed: int) -> str:
    """A random description that is valid: all units, both ways to say how far, weights of all sizes."""
    rng = random.Random(seed)
    unit = rng.choice(["us", "quarter_us", "pca9685", "counts", "plain"])
    lines = [f'unit = "{unit}"']
    if unit == "pca9685":
        lines.append(f"frequency = {rng.uniform(40, 330):.3f}")
    if unit == "counts":
        lines.append(f"clock = {rng.choice([31250, 1e6, 16e6])}")
    for number in range(rng.randint(1, 6)):
        low, high = sorted(round(rng.uniform(500, 2500), rng.choice([0, 3])) for _ in range(2))
        high = max(high, low + 40)
        names = rng.sample(sorted(SOURCES), rng.randint(1, 5))
        mixed = ", ".join(f"{name} = {rng.uniform(-1.5, 1.5):.3f}" for name in names)
        lines += [f"[output.o{number}]", f"from = {{ {mixed} }}",
                  f"minimum = {low}", f"maximum = {high}", f"neutral = {rng.uniform(low, high):.2f}"]
        if rng.random() < 0.5:
            lines += [f"full = {rng.choice([low, high])}", f"reach = {rng.uniform(100, 900):.1f}"]
        else:
            lines += [f"gain = {rng.uniform(-3, 3):.4f}", f"invert = {rng.choice(['true', 'false'])}"]
    return "\n".join(lines)


def curved(seed: int) -> str:
    """One whose outputs bend, every other one with a value of closed lips."""
    rng = np.random.default_rng(seed)
    text = f'unit = "{["us", "quarter_us", "pca9685", "plain"][seed % 4]}"\n'
    for number in range(4):
        values = np.sort(rng.choice(np.arange(900, 2200, 40), rng.integers(2, 10), replace=False))
        openings = np.cumsum(rng.uniform(0.5, 3.0, len(values))) * rng.choice([-1, 1])
        neutral, full = rng.permutation([values[0], values[-1]])
        points = ", ".join(f"[{value}, {opening:.3f}]" for value, opening in zip(values, openings))
        rest = "closed" if number % 2 else "neutral"
        text += (f'[output.o{number}]\nfrom = "opening"\n{rest} = {neutral}\nfull = {full}\nminimum = 900\n'
                 f"maximum = 2200\ncurve = [{points}]\n")
    return text


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("description", [made_up, curved])
def test_generated_table_is_the_float_rig(tmp_path: Path, description: Callable[[int], str], seed: int) -> None:
    """Would catch a wrong Q format, unit, sign or channel: within one unit of a rig in float64, or as many as a curve
    is steep, with either product. Firmware is often C++: the table's initialisers must not narrow."""
    (tmp_path / "made.toml").write_text(description(seed))
    rig = read(tmp_path / "made.toml", "made")
    table.write(rig, tmp_path)
    frames, rows = some_frames(seed), convert(rig)
    found = native(tmp_path, "made", frames, f"-DLABIAL_NARROW_MULTIPLY={seed % 2}")
    wanted = expected(rig, rows, frames)
    assert found.shape == wanted.shape
    for column, values, row, output in zip(found.T, wanted.T, rows, rig.outputs):
        assert np.abs(column - values).max() <= 1.0 + max((slope for _, _, slope in row.curve), default=0) / 2**21
        assert column.min() >= output.minimum * rig.unit.scale - 1e-6  # no servo leaves what its owner wrote
        assert column.max() <= output.maximum * rig.unit.scale + 1e-6
    if CXX:
        run(CXX, "-x", "c++", "-std=c++11", *warnings("c++"), f"-I{SOURCE / 'include'}", "-fsyntax-only",
            tmp_path / "made.c")


def test_float_rig_by_hand(tmp_path: Path) -> None:
    """The reference itself: two servos worked out on paper, in Maestro's units."""
    (tmp_path / "hand.toml").write_text(
        'unit = "quarter_us"\n[output.jaw]\nfrom = "opening"\nneutral = 1400\nfull = 1900\n'
        "[output.corner]\nfrom = { fap53 = 0.5, fap3 = 0.1 }\nneutral = 1500\ngain = 2\ninvert = true\n"
        "minimum = 1300\nmaximum = 1600\n")
    rig = read(tmp_path / "hand.toml", "hand")
    frames = np.zeros((3, 13))
    frames[1, [0, 3, 4, 5]] = 200, 60, -360, 40  # opening 300; 0.5 * 40 + 0.1 * 200 = 40
    frames[2, [4, 5]] = -900, 1000
    assert expected(rig, convert(rig), frames).tolist() == [[5600, 6000], [6600, 5680], [7600, 5200]]


@pytest.mark.parametrize("path", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_examples_are_what_the_command_writes(tmp_path: Path, path: Path) -> None:
    """A description that was changed without its table would show."""
    name = path.stem
    assert main(["rig", str(path), "-o", str(tmp_path), "--no-figure"]) == 0
    for suffix in (".c", ".h"):
        assert (tmp_path / f"{name}{suffix}").read_bytes() == (EXAMPLES[path] / f"{name}{suffix}").read_bytes()


def test_another_format_does_not_compile(tmp_path: Path) -> None:
    """Tables of another version must not be linked by accident."""
    (tmp_path / "jaw.toml").write_text(JAW)
    table.write(read(tmp_path / "jaw.toml", "jaw"), tmp_path)
    header = tmp_path / "jaw.h"
    header.write_text(header.read_text().replace("LABIAL_RIG_FORMAT != 3", "LABIAL_RIG_FORMAT != 2"))
    assert "run labial rig again" in run(CC, f"-I{SOURCE / 'include'}", "-fsyntax-only", tmp_path / "jaw.c", status=1)


def played(path: Path, frames: np.ndarray, sight: int = 1) -> np.ndarray:
    """(T, N) values of a description's face, from rest on, for (T, 13) whole FAPs."""
    values = Rig(path).play(array("h", frames.astype(np.int16).tobytes()), sight)
    return np.array(values, dtype=np.int64).reshape(len(frames), -1)


CLOSING = '[output.jaw]\nfrom = "opening"\nclosed = 1400\nfull = 1900\n'


CURVED = """
[output.jaw]
from = "opening"
closed = 1400
full = 1900
curve = [[1400, 0], [1500, 12], [1650, 24], [1900, 30]]
"""


@needs_runtime
def test_a_linkage_opens_evenly(tmp_path: Path) -> None:
    """Half of what is wanted is half of the 30 mm that were measured, where the servo is at 1537.5; so in another unit,
    with openings that shrink with the pulse."""
    (tmp_path / "a.toml").write_text(CURVED)
    rig = read(tmp_path / "a.toml", "a")
    frames = np.zeros((5, 13))
    frames[:, 4] = [-600, -300, -240, -480, -540]
    assert expected(rig, convert(rig), frames)[:, 0].tolist() == [1900, 1537.5, 1500, 1650, 1775]
    assert played(tmp_path / "a.toml", frames)[:, 0].tolist() == [1900, 1538, 1500, 1650, 1775]
    (tmp_path / "b.toml").write_text('unit = "quarter_us"\n' + CURVED.replace("1400, 0", "1900, 0")
                                     .replace("1500, 12", "1800, 12").replace("1650, 24", "1650, 24")
                                     .replace("[1900, 30]", "[1400, 30]").replace("closed = 1400", "closed = 1900")
                                     .replace("full = 1900", "full = 1400"))
    rig = read(tmp_path / "b.toml", "b")
    assert expected(rig, convert(rig), frames)[:, 0].tolist() == [5600, 7050, 7200, 6600, 6100]


def test_degrees_are_pulses(tmp_path: Path) -> None:
    """90 degrees between 1000 and 2000 us are 1500; slew, deadband and gain are differences."""
    (tmp_path / "a.toml").write_text('unit = "degrees"\npulses = [1000, 2000]\n[output.jaw]\nfrom = "opening"\n'
                                     "closed = 90\nfull = 126\nslew = 9\ndeadband = 1.8\nacceleration = 3.6\n"
                                     "curve = [[90, 0], [108, 6], [126, 8]]\nvisemes = { TH = 9, PP = -1.8 }\n"
                                     '[output.lip]\nfrom = "fap51"\nneutral = 90\ngain = 0.18\nminimum = 72\n'
                                     "maximum = 108\n")
    jaw, lip = convert(read(tmp_path / "a.toml", "a"))
    assert (jaw.neutral, jaw.closed, jaw.minimum, jaw.maximum) == (1500, 1500, 1500, 1700)
    assert jaw.acceleration == 20 and [part[:2] for part in jaw.curve] == [(1500, 1500), (1650, 1600)]
    assert (jaw.slew, jaw.deadband, lip.neutral, lip.minimum, lip.maximum) == (50, 10, 1500, 1400, 1600)
    assert {name: amount for name, amount in zip(VISEMES, jaw.visemes) if amount} == {"TH": 50, "PP": -10}
    assert lip.weights[3] * lip.gain / 4096 / 65536 == pytest.approx(1.0)
    (tmp_path / "b.toml").write_text('unit = "degrees"\n[output.jaw]\nfrom = "opening"\nclosed = 0\nfull = 180\n')
    [jaw] = convert(read(tmp_path / "b.toml", "b"))
    assert (jaw.closed, jaw.maximum) == (544, 2400)


def test_pca9685_counts_in_ticks_of_its_prescaler(tmp_path: Path) -> None:
    """At 50 Hz the register holds 121, a tick is 122 periods of 25 MHz: 4.88 us, and 1500 us are 307 of them."""
    (tmp_path / "face.toml").write_text('unit = "pca9685"\n' + JAW.replace("1400", "1500").replace("1900", "2000")
                                        + "slew = 8\nacceleration = 2.5\n")
    rig = read(tmp_path / "face.toml", "face")
    assert "#define FACE_PCA9685_PRESCALE 121\n" in table.header(rig)
    [jaw] = convert(rig)
    # Minimum and maximum are rounded inwards (1500 / 4.88 = 307.4, 2000 / 4.88 = 409.8), and the neutral follows them.
    assert (jaw.neutral, jaw.minimum, jaw.maximum) == (308, 308, 409)
    assert (jaw.slew, jaw.acceleration) == (2, 1)  # the nearest ticks; less than half a tick is refused


#: What the host's stubs of Arduino do, for sketches that do not use the library.
STUB = SOURCE / "tests" / "packages" / "arduino_stub"


def calibrated(folder: Path, description: str, commands: str) -> List[str]:
    """What the sketch of a description's `--calibrate` prints, and does, when it is told the commands."""
    (folder / "face.toml").write_text(description)
    assert main(["rig", str(folder / "face.toml"), "--calibrate", "-o", str(folder)]) == 0
    run(CXX, "-std=gnu++11", *warnings("c++"), f"-I{STUB}", "-include", "Arduino.h", "-x", "c++",
        folder / "face_calibrate" / "face_calibrate.ino", STUB / "host.cpp", "-o", folder / "sketch")
    return run(folder / "sketch", 5005 + len(commands), text=commands).splitlines()


@pytest.mark.skipif(not CXX, reason="no C++ compiler")
def test_calibration_prints_what_was_set(tmp_path: Path) -> None:
    """The first pulse is no neutral until it is called so: pasted back, closed and full alone limit the jaw."""
    lines = calibrated(tmp_path, CLOSING, "+" * 20 + "c" + "-" * 40 + "f" + "gp")
    assert lines[-3:] == ["[output.jaw]", "closed = 1600", "full = 1200"] and lines[-4] == "jaw 1400"
    lines = calibrated(tmp_path, CLOSING, "+n+gp")
    assert lines[-3:] == ["jaw 1410", "[output.jaw]", "neutral = 1410"]


@pytest.mark.skipif(not CXX, reason="no C++ compiler")
def test_calibration_begins_one_servo_after_the_other(tmp_path: Path) -> None:
    """As docs/servos.md says: a first pulse before and after attach(), and half a second until the next."""
    lines = calibrated(tmp_path, CLOSING + '[output.lip]\nfrom = "upper_lip"\nneutral = 1500\nfull = 1700\n', "")
    assert lines[:6] == ["pulse 0 1400", "attach 0 9", "pulse 0 1400", "pulse 500 1500", "attach 500 10",
                         "pulse 500 1500"]


@pytest.mark.skipif(not CXX, reason="no C++ compiler")
def test_calibration_in_degrees(tmp_path: Path) -> None:
    """Of a description in degrees the sketch prints degrees, which it takes back, those at a servo's ends, too."""
    degrees = 'unit = "degrees"\n[output.jaw]\nfrom = "opening"\n'
    lines = calibrated(tmp_path, degrees + "closed = 60\nfull = 100\n",
                       "+cm0" + "+" * 50 + "fm12>" + "-" * 200 + "l" + "+" * 300 + "hp")
    assert lines[-6:] == ["[output.jaw]", "closed = 61.00", "full = 109.49", "minimum = -13.87", "maximum = 199.30",
                          "curve = [[61.00, 0], [109.49, 12]]"]
    assert "jaw closed = 61.00" in lines and "jaw 109.59" in lines
    (tmp_path / "pasted.toml").write_text(degrees + "\n".join(lines[-5:]))
    [jaw] = convert(read(tmp_path / "pasted.toml", "pasted"))
    assert (jaw.closed, jaw.minimum, jaw.maximum, jaw.curve[0][:2]) == (1173, 401, 2599, (1173, 1173))


def test_drawing_shows_every_output(tmp_path: Path) -> None:
    """An SVG with a title per output and a legend, the same bytes every time."""
    for folder in ("a", "b"):
        assert main(["rig", str(FACES / "servos.toml"), "-o", str(tmp_path / folder), "--name", "head"]) == 0
    assert sorted(path.name for path in (tmp_path / "a").iterdir()) == ["head.c", "head.h", "head.svg"]
    root = ET.fromstring((tmp_path / "a" / "head.svg").read_text())
    words = {"".join(item.itertext()).strip() for item in root.iter("{http://www.w3.org/2000/svg}text")}
    assert {"jaw", "upper_lip", "lower_lip", "corner_left", "corner_right"} <= words
    assert {"mouth open", "lips rounded", "smile", "lips closed", "percent of the pose"} <= words
    assert (tmp_path / "a" / "head.svg").read_bytes() == (tmp_path / "b" / "head.svg").read_bytes()


def test_without_matplotlib_the_way_out_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    """The tables need no drawing."""
    monkeypatch.delitem(sys.modules, "labial.see.plot", raising=False)  # which other tests may have imported
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["rig", str(FACES / "jaw.toml"), "-o", str(tmp_path)]) == 1
    assert "--no-figure" in capsys.readouterr().err
    assert main(["rig", str(FACES / "jaw.toml"), "-o", str(tmp_path), "--no-figure"]) == 0


GAIN = JAW.replace("full = 1900", "gain = 1\nminimum = 1000\nmaximum = 2000")
PLAIN, WEIGHT, DEGREES = 'unit = "plain"\n', 'unit = "weight"\n', 'unit = "degrees"\n'
IN_DEGREES = DEGREES + '[output.jaw]\nfrom = "opening"\nclosed = 60\nfull = 100\n'
#: Python refuses whole numbers of thousands of digits since its releases of September 2022.
TAKES_ANY_NUMBER = not hasattr(sys, "set_int_max_str_digits")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "output: at least one table [output.NAME] is needed"),
        ("\ufeff" + JAW, None),
        ("output = 3", "output: at least one table"),
        ("[output]\njaw = 3", "output.jaw: is not a table"),
        (JAW + "slew = = 2\n", ":5: not TOML: "),
        ("outputs = 3\n" + JAW, "outputs: unknown key; did you mean output?"),
        ("colour = 3\n" + JAW, "colour: unknown key; known are unit,"),
        (JAW + "neutrall = 2\n", "output.jaw.neutrall: unknown key; did you mean neutral?"),
        ('unit = "radians"\n' + JAW, "unit: 'radians' is none of us, quarter_us, pca9685, counts, weight, plain, degr"),
        (DEGREES + JAW, "output.jaw.neutral: 1400 is not within -13.96 .. 199.39 degrees, a servo's 400 .. 2600 micro"),
        (IN_DEGREES, None),
        (IN_DEGREES + "slew = 0.04\n", "output.jaw.slew: 0.04 is less than half a step of its values, microseconds"),
        (IN_DEGREES + "minimum = 70\n", "output.jaw.closed: 60 is not within 70 .. 100"),
        (IN_DEGREES + "curve = [[60, 0], [201, 9]]\n", "output.jaw.curve: 201 is not within -13.96 .. 199.39 degrees"),
        (IN_DEGREES + "curve = [[60, 0], [60.1, 1e-2], [100, 9]]\n", "the points at 60 and 60.1 are too near"),
        ('unit = "degrees"\npulses = [1000]\n' + JAW, "pulses: is two pulses in microseconds"),
        ('unit = "degrees"\npulses = [2000, 1000]\n' + JAW, "pulses: 2000, 1000 are not two pulses"),
        ("pulses = [1000, 2000]\n" + JAW, "pulses: goes with the unit degrees"),
        ("unit = []\n" + JAW, "unit: [] is none of"),
        ("frequency = 50\n" + JAW, "frequency: has no meaning for the unit us"),
        ('unit = "pca9685"\nfrequency = 23.84\n' + JAW, "frequency: 23.84 is not within 23.85 .. 1525.87 Hz"),
        ('unit = "pca9685"\nfrequency = 23.85\n' + JAW, None),
        ('unit = "pca9685"\nfrequency = 1525.87\n' + JAW, "output.jaw.neutral: 8750 ticks of 0.16 us"),
        ('unit = "pca9685"\n' + JAW + "slew = 2\n", "output.jaw.slew: 2 is less than half a step of its values, ticks"),
        ('unit = "pca9685"\n' + JAW + "acceleration = 2\n", "output.jaw.acceleration: 2 is less than half a step"),
        ('unit = "pca9685"\nfrequency = "x"\n' + JAW, "frequency: 'x' is not a number"),
        ('unit = "counts"\n' + JAW, "clock: is missing"),
        ('unit = "counts"\nclock = 5\n' + JAW, "clock: 5 is not within"),
        ('unit = "counts"\nclock = 1e9\n' + JAW.replace("1900", "1900.0"), None),
        (JAW.replace("[output.jaw]", '[output."j w"]'), "output.j w: an output's name is letters"),
        (JAW + JAW.replace("jaw", "Jaw"), "output.Jaw: is the same in capitals as output.jaw"),
        (JAW.replace("[output.jaw]", "[output.outputs]"), "output.outputs: this name is taken"),
        (JAW.replace('"opening"', '"openning"'), "no gesture or FAP is called 'openning'; did you mean opening?"),
        (JAW.replace('"opening"', "{}"), "output.jaw.from: is the name of a gesture"),
        (JAW.replace('"opening"', "{ jaw = true }"), "output.jaw.from.jaw: True is not a number"),
        (JAW.replace('"opening"', "{ jaw = 1e9 }"), "output.jaw.from.jaw: 1e+09 is not within -1000 .. 1000"),
        (JAW.replace('"opening"', "{ jaw = 0 }"), "output.jaw.from: all weights are zero"),
        (JAW.replace('"opening"', "{ jaw = 1 }"), "output.jaw.reach: is missing"),
        (JAW + "closed = 1399\n", None),
        (GAIN + "closed = 900\n", "output.jaw.closed: 900 is not within 1000 .. 2000"),
        (JAW.replace("neutral", "closed").replace("1400", "90"), "output.jaw.closed: 90 is not a servo's pulse"),
        (JAW.replace("neutral", "closed").replace("1900", "1400"), "output.jaw.full: is the same as closed"),
        (JAW.replace("neutral", "closed") + "curve = [[1500, 0], [1900, 9]]\n", "jaw.curve: closed, 1400, is not"),
        (WEIGHT + JAW.replace("1400", "0").replace("1900", "100"), "jaw.full: 100 is beyond 1: weights are 0 to 1"),
        (WEIGHT + JAW.replace("1400", "0").replace("1900", "1"), None),
        (JAW + "deadband = -1\n", "output.jaw.deadband: -1 is negative"),
        (JAW + "deadband = 501\n", "output.jaw.deadband: 501 is more than the travel from 1400 to 1900: the output"),
        (JAW + "reach = 0\n", "output.jaw.reach: 0 is not positive"),
        (JAW + "reach = nan\n", "output.jaw.reach: nan is not a finite number"),
        (JAW.replace("neutral = 1400\n", ""), "output.jaw.neutral: is missing"),
        (JAW.replace("1400", "9" * 400), "output.jaw.neutral: inf is not a finite number"),
        (JAW.replace("1400", "1e200"), "output.jaw.neutral: 1e+200 is not within"),
        (JAW.replace("1400", "9" * 5000), "output.jaw.neutral: inf" if TAKES_ANY_NUMBER else ": not TOML: "),
        (JAW.replace("1400", "150"), "output.jaw.neutral: 150 is not a servo's pulse, 400 .. 2600 microseconds"),
        (JAW.replace("1900", "1400"), "output.jaw.full: is the same as neutral"),
        (JAW.replace("full = 1900\n", ""), "output.jaw.full: either full (the value at full extent) or gain"),
        (JAW + "gain = 2\n", "FAP unit) is needed, not both"),
        (JAW + "invert = true\n", "output.jaw.invert: goes with gain"),
        (JAW + "invert = 1\n", "output.jaw.invert: 1 is neither true nor false"),
        (JAW + "slew = 0\n", "output.jaw.slew: 0 is not positive; leave it out for no limit"),
        (JAW + "acceleration = -1\n", "output.jaw.acceleration: -1 is not positive"),
        (JAW + "acceleration = 1e8\n", "output.jaw.acceleration: 100000000 microseconds is beyond 16777215"),
        (JAW + "curve = 3\n", "output.jaw.curve: is a list of 2 to 9 points [VALUE, OPENING]"),
        (JAW + "curve = [" + "[1400, 0]," * 10 + "]\n", "output.jaw.curve: is a list of 2 to 9 points"),
        (JAW + "curve = [[1400, 0], [1900]]\n", "output.jaw.curve: point 2 is not [VALUE, OPENING]"),
        (JAW + 'curve = [[1400, 0], [1900, "x"]]\n', "output.jaw.curve: 'x' is not a number"),
        (JAW + "curve = [[140, 0], [1900, 9]]\n", "output.jaw.curve: 140 is not a servo's pulse, 400 .. 2600"),
        (JAW + "curve = [[1400, 0], [1600, 9], [1900, 8]]\n", "output.jaw.curve: from each value to the next larger"),
        (JAW + "curve = [[1500, 0], [1900, 9]]\n", "output.jaw.curve: neutral, 1400, is not within 1500 .. 1900"),
        (JAW + "curve = [[1400, 0], [1800, 9]]\n", "output.jaw.curve: full, 1900, is not within 1400 .. 1800"),
        (JAW + "curve = [[1400, 0], [1700, 0.1], [1900, 90]]\n", "the output would move 540 times as far as evenly"),
        (JAW + "curve = [[1401, 1], [1402, 2], [1400, 0], [1900, 9]]\n", None),
        (GAIN + "curve = [[1400, 0], [1900, 9]]\n", "output.jaw.curve: goes with full, not with gain"),
        (PLAIN + JAW + "curve = [[0, 0], [2e7, 2e7], [3e7, 4e7]]\n", "output.jaw.curve: what lies at 2e+07 is beyond"),
        (JAW + "minimum = 1950\n", "output.jaw.minimum: 1950 is above the maximum, 1900"),
        (JAW + "visemes = { TH = 100, PP = -40 }\n", None),
        (JAW.replace('from = "opening"', "visemes = { TH = 100 }"), None),
        (JAW + "visemes = 3\n", "output.jaw.visemes: is a table { VISEME = AMOUNT, ... }"),
        (JAW + "visemes = { Th = 3 }\n", "output.jaw.visemes: no viseme is called 'Th'"),
        (JAW + "visemes = { TH = 4e4 }\n", "output.jaw.visemes.TH: 40000 microseconds is beyond 32767"),
        (JAW.replace('from = "opening"', "reach = 3\nvisemes = { TH = 100 }"), "output.jaw.reach: goes with from"),
        (GAIN.replace('from = "opening"', "visemes = { TH = 100 }"), "output.jaw.gain: goes with from"),
        (JAW.replace('from = "opening"', "visemes = { TH = 100 }").replace("full = 1900\n", ""),
         "output.jaw.full: is needed, the value that sounds move it to at most"),
        (JAW + "minimum = 1500\n", "output.jaw.neutral: 1400 is not within 1500 .. 1900"),
        (JAW + "maximum = 1800\n", "output.jaw.full: 1900 is not within 1400 .. 1800"),
        (JAW.replace("full = 1900", "gain = 1"), "output.jaw.minimum: is missing"),
        (GAIN.replace("gain = 1", "gain = 0"), "output.jaw.gain: is zero"),
        (GAIN + "reach = 3\n", "output.jaw.reach: goes with full"),
        (GAIN.replace("gain = 1", "gain = 99999"), "output.jaw.gain: gain and weights are too large"),
        (PLAIN + JAW.replace("1900", "1e7"), "output.jaw.full: gain and weights are too large"),
        (PLAIN + JAW.replace("1900", "1e9"), "output.jaw.maximum: 1000000000 plain units is beyond 16777215"),
        (PLAIN + JAW.replace("1400", "0.2").replace("1900", "0.8"), "output.jaw.minimum: no whole unit lies between"),
        (b"\xff\xfe", "not UTF-8 text"), (b"x = " + b"[" * 5000, "not TOML"),
    ],
)
def test_errors_name_file_and_key(
    tmp_path: Path, capsys: pytest.CaptureFixture, text: str | bytes, message: str
) -> None:
    """One line, no traceback, nothing written; a case without message is one that must pass."""
    path = tmp_path / "face.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    status = main(["rig", str(path), "-o", str(tmp_path / "out"), "--no-figure"])
    error = capsys.readouterr().err
    if message is None:
        assert status == 0 and error == ""
        return
    assert status == 1 and error.startswith(f"labial: {path}:") and message in error and error.count("\n") == 1, error
    assert not (tmp_path / "out").exists()


def test_names_of_the_library_are_all_known() -> None:
    """A model or a table of words whose header a rig of the same name could replace."""
    headers = [*(SOURCE / "lib" / "models").glob("*.h"), *(SOURCE / "lib" / "words").glob("*.h")]
    assert {path.stem for path in headers} == OWN_TABLES
    for name in sorted(OWN_TABLES):
        check_name(name)
        check_name(name, "table of words")
        with pytest.raises(ModelError, match="the library already uses it"):
            check_name(name, "header")


def test_names_that_c_cannot_use(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """A missing file, a file name that C cannot spell, and the way out of it."""
    assert main(["rig", str(tmp_path / "none.toml"), "-o", str(tmp_path)]) == 1
    assert "none.toml" in capsys.readouterr().err
    (tmp_path / "my face.toml").write_text(JAW)
    assert main(["rig", str(tmp_path / "my face.toml"), "-o", str(tmp_path), "--no-figure"]) == 1
    assert "'my face' is no name for a rig" in capsys.readouterr().err
    assert main(["rig", str(tmp_path / "my face.toml"), "-o", str(tmp_path), "--no-figure", "--name", "face"]) == 0


@pytest.mark.parametrize("name", ["outputs", "jaw_curve", "jaw_visemes", "stdint", "Math", "linux", "Servo", "Arduino",
                                  "speech_en"])
def test_names_with_which_c_does_not_compile(tmp_path: Path, capsys: pytest.CaptureFixture, name: str) -> None:
    """Names of the file's other tables, of other headers, and of macros. A name is free where there is no table."""
    (tmp_path / f"{name}.toml").write_text(CURVED + "visemes = { TH = 3 }\n")
    assert main(["rig", str(tmp_path / f"{name}.toml"), "-o", str(tmp_path / "out"), "--no-figure"]) == 1
    assert f"'{name}' is no name for a rig: " in capsys.readouterr().err and not (tmp_path / "out").exists()
    if name.startswith("jaw_"):
        (tmp_path / f"{name}.toml").write_text(CLOSING)
        assert main(["rig", str(tmp_path / f"{name}.toml"), "-o", str(tmp_path), "--no-figure"]) == 0
        run(CC, f"-I{SOURCE / 'include'}", "-fsyntax-only", tmp_path / f"{name}.c")


@pytest.mark.parametrize("seed", range(60))
def test_damaged_descriptions_are_refused_or_sound(tmp_path: Path, seed: int) -> None:
    """Whatever a slip makes of a description, it is an error with the file's name or a table within the limits."""
    rng = random.Random(seed)
    text = rng.choice([made_up(seed), (FACES / "servos.toml").read_text(), JAW])
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(text))
        text = text[:at] + rng.choice(["", "9", "-", "e9", '"', "\n", "=", "nan", "\x00", "é", "{", "1e308"]) + text[
            at + rng.randint(0, 3):]
    path = tmp_path / "face.toml"
    path.write_text(text, encoding="utf-8")
    try:
        outputs = convert(read(path, "face"))
    except LabialError as error:
        assert str(path) in str(error)
        return
    for output in outputs:
        assert sum(map(abs, output.weights)) <= table.WEIGHT_SUM_MAX and abs(output.gain) <= table.GAIN_MAX
        assert max(map(abs, output.weights)) <= 32767
        assert -table.VALUE_MAX <= output.minimum <= output.maximum <= table.VALUE_MAX
        assert abs(output.neutral) <= table.VALUE_MAX and 0 <= output.slew <= table.VALUE_MAX


def test_toml_parser_of_older_pythons_is_declared() -> None:
    """Python below 3.11 has no tomllib: the package that takes its place must be asked for."""
    project = (SOURCE / "pyproject.toml").read_text()
    assert "tomli>=1.1; python_version < \"3.11\"" in project
    assert sys.version_info < (3, 11) or "tomllib" in sys.modules
