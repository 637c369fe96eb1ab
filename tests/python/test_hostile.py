"""What nobody vouches for: damaged, hostile and absurd files and arguments end in an exit status and one line."""

from __future__ import annotations

import dataclasses
import random
import struct
import subprocess
import sys
from pathlib import Path
from typing import Callable, Iterator, List

import numpy as np
import pytest

from labial.__main__ import main
from labial.errors import ModelError
from labial.files.faps import FAP_COLUMNS
from labial.rig.animation import FORMATS
from labial.tables import emit
from labial.tables.layout import check_fits
from labial.tables.model import load, save
from labial.tables.quantise import quantise
from models import archive, members_of, random_model, write_motion
from test_record import LAB as TALK
from test_record import talking, turned
from test_timings import damaged
from told import Told, limited

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits of memory and time are those of Linux")

#: Seconds that a command may take, and bytes of memory beyond what the tests have.
SECONDS, MEMORY = 60, 3_000_000_000
LAB = "0.00 0.20 SIL\n0.20 0.31 P1\n0.31 0.42 p1\n0.50 0.71 P4\n0.71 1.00 SIL\n"
FACE = '[output.jaw]\nfrom = "jaw"\nneutral = 1400\nfull = 1900\n'
SYLLABLES = "".join(f"{n / 10} {n / 10 + 0.1} {label}\n" for n, label in enumerate(4 * ["SIL", "AA", "M", "IY", "SIL"]))
ROW = ",".join(map(str, range(13)))
CSV = ",".join(("time", *FAP_COLUMNS)) + "\n" + "".join(f"{t / 50:.2f},{ROW}\n" for t in range(9))
FAP = "2.1 x 25 2\n" + "".join(" ".join(["0", "0", "1"] + 65 * ["0"]) + f"\n{n} 7\n" for n in range(2))


@pytest.fixture(autouse=True)
def limits() -> Iterator[None]:
    """Ends what takes too much memory or time."""
    with limited(SECONDS, MEMORY):
        yield


@pytest.fixture
def told(capsys: pytest.CaptureFixture) -> Told:
    return Told(capsys)


# ---- Models ----------------------------------------------------------------------------------------------------------


def npy(shape: str, kind: str = "<f8", content: bytes = b"") -> bytes:
    text = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text + content


def encrypted(data: bytes) -> bytes:
    """The archive with the bit set that says so, in every header."""
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        start = data.find(mark)
        while start >= 0:
            place = start + offset
            data = data[:place] + bytes([data[place] | 1]) + data[place + 1 :]
            start = data.find(mark, place)
    return data


@pytest.mark.parametrize(("name", "content", "complaint"), [
    ("model.json", b"5", "model.json: not an object"), ("model.json", b"[" * 200_000, "model.json: not JSON"),
    ("model.json", b"\xff", "model.json: not JSON"), ("model.json", b"{}", "format None"),
    ("model.json", b"9" * 5000, "model.json: not"), ("kernel.npy", b"", "kernel is no array"),
    ("kernel.npy", npy("(1000000, 1000000)"), "kernel has 0 bytes"),
    ("kernel.npy", npy("(" * 4000), "kernel is no array"), ("kernel.npy", npy("(-1,)"), "kernel"),
    ("kernel.npy", npy("(" + "9" * 400 + ",)"), "kernel has 0 bytes"),
    ("kernel.npy", npy("(1,)", "|O", b"12345678"), "kernel"),
    ("kernel.npy", npy("(1,)", "<c16", bytes(16)), "not real numbers"),
    ("kernel.npy", npy("()", content=bytes(8)), "kernel has shape ()"),
    ("kernel.npy", bytes(80_000_000), "more than the 1"), ("log_initial.npy", npy("(13, 0)"), "no states"),
    ("component_count.npy", npy("(9,)", "<i8", b"\xff" * 72), "component_count[0] is -1"),
], ids=lambda given: repr(given[:12]))  # fmt: skip
def test_models_that_are_none(tmp_path: Path, told: Told, name: str, content: bytes, complaint: str) -> None:
    """Would catch a traceback, or memory that a header of some bytes asks for."""
    path = tmp_path / "m.npz"
    save(random_model(1), path)
    path.write_bytes(archive({**members_of(path), name: content}))
    line = told("export", path, "--name", "m", "-o", tmp_path / "out")
    assert line.startswith(f"labial: {path}: ") and complaint in line and not (tmp_path / "out").exists()


@pytest.mark.slow
def test_archives_that_are_damaged(tmp_path: Path, told: Told) -> None:
    """Would catch a bit that nobody misses, an encrypted archive, and every other damage that is not foreseen."""
    path, chance = tmp_path / "m.npz", random.Random(1)
    save(random_model(1), path)
    data = path.read_bytes()
    path.write_bytes(encrypted(data))
    assert "is encrypted" in told("synth", path, path)
    refused = 0
    for n in range(80):
        place = chance.randrange(len(data))
        flipped = data[:place] + bytes([data[place] ^ 1 << chance.randrange(8)]) + data[place + 1 :]
        path.write_bytes(flipped if n % 2 else damaged(data, chance))
        try:
            load(path)
        except ModelError as error:
            refused += 1
            assert str(error).startswith(f"{path}: ") and "\n" not in str(error)
    assert refused > 40
    for other in (tmp_path, Path("/dev/null"), Path("/dev/zero"), tmp_path / "none"):
        assert told("synth", other, other).startswith(f"labial: {other}: ")


@pytest.mark.parametrize("value", [1e300, -1e300, np.nan, np.inf, 1e6])
def test_values_beyond_the_tables_are_named(tmp_path: Path, value: float) -> None:
    """Would catch -9223372036854775808 in a uint16: every value of every array is refused, or the tables hold it."""
    model = random_model(2)
    for item in dataclasses.fields(model):
        array = getattr(model, item.name)
        if not isinstance(array, np.ndarray) or array.dtype.kind != "f" or not array.size:
            continue
        wrong = array.copy()
        wrong[(-1,) * wrong.ndim] = value
        at = ", ".join(str(size - 1) for size in wrong.shape)
        try:
            exported = quantise(dataclasses.replace(model, **{item.name: wrong}), "m")
        except ModelError as error:
            named = f"{item.name}[{at}] is {value:g}" if not abs(value) <= 1e6 else "["
            assert named in str(error), error
        else:
            assert abs(value) <= 1e6, item.name
            emit.source(exported)


def test_tables_hold_what_is_written() -> None:
    """Would catch a table that the exporter packs without its C type's range."""
    exported = quantise(random_model(2), "m")
    for name in ("cost", "shapes", "slopes", "kernels", "pairs", "emission_gain", "initial", "state_mean",
                 "state_motion", "motion_scale", "transitions", "state_weight", "centre", "firm", "duration_mean",
                 "floors", "contexts", "shape_scale"):  # fmt: skip
        table = getattr(exported, name).astype(np.int64)
        for value in (-(2**63), 70000, -40000):
            wrong = table.copy()
            wrong.flat[-1] = value
            with pytest.raises(ModelError, match="cannot be written: .*not a whole number within"):
                emit.source(dataclasses.replace(exported, **{name: wrong}))
    check_fits("t", "b", np.array([-128, 127]))
    check_fits("t", "H", np.array([0, 65535]))
    for code, value in (("b", 128), ("b", -129), ("B", 256), ("B", -1), ("h", 32768), ("H", 65536), ("H", 0.5)):
        with pytest.raises(ModelError, match="row 1"):
            check_fits("t", code, np.array([0, value]))


@pytest.mark.parametrize("text", ["*/ int x; /*", "/**/", "a\nb\0c\r*\t/", "\u202e*/", "*" * 200 + "/", "/" * 200 + "*",
                                  "/*/*/*/", "??/"])  # fmt: skip
def test_attributions_stay_within_their_comment(text: str) -> None:
    """Would catch a comment that ends, or begins again, within what a model says of itself."""
    exported = dataclasses.replace(quantise(random_model(2), "m"), attribution=text)
    for written in (emit.header(exported), emit.source(exported), emit.names_source(exported)):
        inside = written[2 : written.index("*/")]
        assert "/*" not in inside and written.startswith("/*\n") and written[written.index("*/") :].startswith("*/\n#")
        assert all(c.isprintable() or c == "\n" for c in written)


# ---- Commands --------------------------------------------------------------------------------------------------------


def corpus(folder: Path, frames: Callable[[int], List[float]], lab: str, count: int) -> Path:
    folder.mkdir()
    for number in range(count):
        write_motion(folder / f"u{number}.csv", np.arange(100) / 50, np.array([frames(t) for t in range(100)]))
        (folder / f"u{number}.lab").write_text(lab)
    return folder


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in (("a.lab", LAB), ("f.csv", CSV), ("f.fap", FAP), ("face.toml", FACE), ("talk.lab", TALK)):
        (tmp_path / name).write_text(text)
    save(random_model(1), tmp_path / "m.npz")
    np.savez(tmp_path / "talk.npz", landmarks=turned(talking()[0]), fps=50.0)
    return tmp_path


#: The valid input that is damaged, how often, and the commands that read it.
COMMANDS = [
    ("a.lab", 60, ["timings", "a.lab"]), ("a.lab", 15, ["synth", "m.npz", "a.lab", "-o", "o.csv"]),
    ("a.lab", 6, ["bake", "a.lab", "--as", "phonemes", "-o", "o.h", "--model", "m.npz"]),
    ("a.lab", 15, ["page", "f.csv", "--phones", "a.lab", "-o", "o.html"]),
    ("f.csv", 40, ["page", "f.csv", "-o", "o.html"]), ("f.csv", 30, ["bake", "f.csv", "-o", "o.h"]),
    ("f.csv", 3, ["plot", "f.csv", "-o", "o.png"]), ("f.fap", 40, ["page", "f.fap", "-o", "o.html"]),
    ("face.toml", 60, ["rig", "face.toml", "-o", "o", "--no-figure"]),
    ("face.toml", 20, ["bake", "f.csv", "--rig", "face.toml", "-o", "o.h"]),
    ("m.npz", 12, ["export", "m.npz", "--name", "m", "-o", "o"]), ("m.npz", 20, ["check", "m.npz", "none.lab"]),
    ("talk.npz", 12, ["record", "talk.npz", "-o", "o"]), ("talk.lab", 6, ["record", "talk.npz", "-o", "o"]),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("name", "count", "arguments"), COMMANDS, ids=[f"{a[0]}-{n}" for n, _, a in COMMANDS])
def test_damaged_inputs(given: Path, told: Told, name: str, count: int, arguments: List[str]) -> None:
    """Would catch a traceback, a hang or memory without bound, whatever a file holds."""
    if arguments[0] == "plot":
        pytest.importorskip("matplotlib")
    if arguments[0] == "record":
        pytest.importorskip("scipy")
    chance = random.Random(name + arguments[0])
    data = (given / name).read_bytes()
    assert not told(*arguments) or "none.lab" in arguments, "what is not damaged is read"
    outcomes = set()
    for _ in range(count):
        (given / name).write_bytes(damaged(data, chance))
        for old in (given / "o").glob("*") if (given / "o").is_dir() else ():
            old.unlink()
        line = told(*arguments)
        assert not line or line.startswith("labial: "), line
        outcomes.add(bool(line))
    assert True in outcomes


@pytest.mark.parametrize(("frames", "lab", "count"), [
    (lambda t: [0.0] * 13, SYLLABLES, 3),
    pytest.param(lambda t: [t % 7.0] + [5.0] * 12, SYLLABLES, 3, marks=pytest.mark.slow),
    (lambda t: [1e300] * 13, "0 2 SIL\n", 2), (lambda t: [t * 1e4] * 13, SYLLABLES, 3),
    pytest.param(lambda t: [1e-300 * t] * 13, SYLLABLES, 3, marks=pytest.mark.slow),
    (lambda t: [float(t)] * 13, "0 2 SIL\n", 2),
    (lambda t: [float(t)] * 13, "0 .001 AA\n", 2), (lambda t: [float(t)] * 13, "0 86000 AA\n", 1),
], ids=["zeros", "constants", "1e300", "far", "1e-300", "silence", "short", "long"])  # fmt: skip
def test_absurd_corpora(tmp_path: Path, told: Told, frames: Callable, lab: str, count: int) -> None:
    """Would catch a traceback in training, and a model that is trained but cannot be read or exported."""
    pytest.importorskip("sklearn")
    folder = corpus(tmp_path / "c", frames, lab, count)
    model = tmp_path / "m.npz"
    for method in ("paper", "labial"):
        line = told("train", folder, "-o", model, "--method", method, "--jobs", 1, "--codebook", 4, "--components", 1)
        if line:
            assert line.startswith("labial: "), line
            return
        assert not told("export", model, "--name", "m", "-o", tmp_path / "out")


@pytest.mark.parametrize("arguments", [
    ["train", "c", "-o", "x.npz", "--seed", "-1"], ["train", "c", "-o", "x.npz", "--seed", "1_0"],
    ["train", "c", "-o", "x.npz", "--seed", str(2**32)], ["train", "c", "-o", "x.npz", "--seed", "\u0661"],
    ["train", "c", "-o", "x.npz", "--jobs", "9" * 30], ["train", "c", "-o", "x.npz", "--jobs", "0"],
    ["train", "c", "-o", "x.npz", "--fps", "\u00b2"], ["train", "c", "-o", "x.npz", "--look-ahead", "-1"],
    ["train", "c", "-o", "x.npz", "--look-ahead", "nan"], ["train", "c", "-o", "x.npz", "--talker-variance", "0"],
    ["train", "c", "-o", "x.npz", "--talker-variance", "nan"], ["train", "c", "-o", "x.npz", "--adapt", "none.npz"],
    ["train", "c", "-o", "x.npz", "--adapt", "m.npz"], ["evaluate", "c", "-o", "r", "--talker-variance", "-1"],
    ["train", "", "-o", "x.npz"], ["train", "a.lab", "-o", "x.npz"],
    ["laughter-corpus", "l", "--seed", "-1"], ["laughter-corpus", "a.lab"], ["laughter-corpus", ""],
    ["evaluate", "c", "-o", "r", "--seed", "-1"], ["evaluate", "none", "-o", "r"],
    ["evaluate", "c", "-o", "r", "--methods", ""], ["export", "m.npz", "--name", "", "-o", "o"],
    ["export", "m.npz", "--name", "m", "-o", "o", "--amplitude", "nan"],
    ["export", "m.npz", "--name", "m\n", "-o", "o"],
    ["export", "m.npz", "--name", "m", "-o", "o", "--amplitude", "1e400"],
    ["export", "m.npz", "--name", "m", "-o", "a.lab"], ["export", "m.npz", "--name", "m", "-o", "/dev/null"],
    ["record", "talk.npz", "-o", "o", "--fps", "nan"], ["record", "talk.npz", "-o", "o", "--offset", "1e300"],
    ["record", "talk.npz", "-o", "o", "--cutoff", "-1"], ["record", "talk.npz", "-o", "o", "--size", "1x1"],
    ["record", "talk.npz", "-o", "a.lab"], ["record", "", "-o", "o"], ["record", "f.csv", "-o", "o"],
    ["timings", ""], ["timings", "."], ["timings", "/dev/null"], ["timings", "/dev/zero"], ["timings", "none"],
    ["timings", "a.lab", "-o", "."], ["timings", "a.lab", "-o", "none/x"], ["timings", "a\nb"],
    ["timings", "\udcff.lab"],
    ["synth", "m.npz", "", "-o", "x"], ["synth", ".", "a.lab"], ["synth", "m.npz", "a.lab", "-o", "."],
    ["page", "f.csv", "-o", "."], ["page", ".", "-o", "x.html"], ["page", "f.csv", "-o", "x", "--audio", "/dev/null"],
    ["page", "f.csv", "-o", "x", "--audio", "."], ["plot", "f.csv", "-o", "x.png", "--channels", ","],
    ["plot", "f.csv", "-o", "none/x.png"], ["plot", "f.csv", "-o", ""], ["rig", "/dev/null", "-o", "o"],
    ["rig", ".", "-o", "o"], ["rig", "face.toml", "-o", "a.lab"], ["rig", "/dev/zero", "-o", "o", "--name", "x"],
    ["bake", "f.csv", "-o", ".h"], ["bake", "", "-o", "x.h"], ["bake", ".", "-o", "x.h"], ["nothing"], ["bake"],
    ["align", "a.lab"], ["align", "/dev/null"], ["align", "."], ["align", "", "--text", "a"],
    ["align", "none.wav", "--text-file", "/dev/zero"],
])  # fmt: skip
def test_absurd_arguments(given: Path, told: Told, arguments: List[str]) -> None:
    """Would catch an argument that no command foresees: whatever it is, it is refused in one line."""
    line = told(*arguments)
    assert line.startswith("labial"), line


def test_names_that_are_not_utf8(given: Path) -> None:
    """Would catch a name that cannot be printed, and a text that cannot be written because of it."""
    name = "\udcff\udcfe"
    for suffix, data in ((".lab", LAB.encode()), (".csv", CSV.encode()), (".npz", (given / "m.npz").read_bytes())):
        (given / (name + suffix)).write_bytes(data)
    script = "import sys\nfrom labial.__main__ import main\nsys.exit(any([main(a.split('|')) for a in sys.argv[1:]]))"
    asked = [["timings", f"{name}.lab"], ["bake", f"{name}.csv", "-o", "o.h"], ["page", f"{name}.csv", "-o", "o.html"],
             ["rig", "face.toml", "-o", name, "--no-figure"]]
    asked += [["synth", f"{name}.npz", "a.lab", "-o", f"{name}.{kind}", "--to", kind]
              for kind in FORMATS]
    for arguments, status in ((asked, 0), ([["timings", f"{name}.none"]], 1)):
        command = [sys.executable, "-c", script, *map("|".join, arguments)]
        done = subprocess.run(command, check=False, capture_output=True)
        said = [line for line in done.stderr.split(b"\n") if b"warning: " not in line]
        assert done.returncode == status and b"".join(said).startswith(b"labial: " * status), done.stderr
        assert len(said) == 1 + status, done.stderr
    assert said[0].startswith(b"labial: \\udcff\\udcfe.none: ")


def test_defects_are_told_apart(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """Would catch a net that hides defects: they have a status of their own and name their place."""
    def broken(*_: object) -> None:
        raise ZeroDivisionError("by nothing")

    monkeypatch.setattr("labial.corpus.formats.as_lab", broken)
    assert main(["timings", "x"]) == 3
    assert "ZeroDivisionError: by nothing (test_hostile.py, line" in capsys.readouterr().err
