"""The command line: each sub-command end to end, errors as one line whatever it is given, and what statuses mean."""

from __future__ import annotations

import errno
import resource
import shlex
import signal
import subprocess
import sys
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Callable, Iterator, List, NoReturn

import numpy as np
import pytest

import labial.commands
from labial.__main__ import main
from labial.commands import COMMANDS
from labial.errors import LabialError
from labial.files.grammar import whole
from labial.program import Parser, number, run
from labial.rig.animation import FORMATS
from labial.tables.model import save
from models import random_model, write_motion
from test_record import LAB as TALK
from test_record import talking, turned

LAB = "0.00 0.20 SIL\n0.20 0.31 P1\n0.31 0.42 p1\n0.50 0.71 P4\n0.71 1.00 SIL\n"
FACE = '[output.jaw]\nfrom = "jaw"\nneutral = 1400\nfull = 1900\n'


#: What a process runs that has no numpy and nothing else of what the extras bring.
WITHOUT_PACKAGES = """
import sys
sys.modules.update(dict.fromkeys(("numpy", "scipy", "sklearn", "tqdm", "matplotlib", "tomli", "soundfile")))
from labial.__main__ import main
for arguments in {arguments}:
    try:
        main(arguments)
    except SystemExit as end:
        assert end.code == 0, arguments
print(*sorted(name[16:] for name in sys.modules if name.startswith("labial.commands.")))
"""


def without_packages(arguments: list) -> str:
    """Runs commands one after another; their output, and a line of the modules of commands that they loaded."""
    done = subprocess.run([sys.executable, "-c", WITHOUT_PACKAGES.format(arguments=arguments)], check=False,
                          capture_output=True, encoding="utf-8")
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_help_needs_python_alone() -> None:
    """Would catch a module that imports at its top what only the work needs, and one that is not among the commands."""
    text = without_packages([["--help"], ["--version"], *([name, "--help"] for name in COMMANDS)])
    assert all(f"usage: labial {name} " in text for name in COMMANDS)
    modules = {path.stem for path in Path(labial.commands.__file__).parent.glob("*.py")} - {"__init__", "common"}
    assert modules == {module for module, _ in COMMANDS.values()}


def test_one_command_is_loaded() -> None:
    """Would catch a start that takes longer with each command that there is."""
    assert without_packages([["--help"]]).splitlines()[-1] == ""
    assert without_packages([["timings", "--help"]]).splitlines()[-1] == "common corpora"


def test_synth_articulates(files: Path, capsys: pytest.CaptureFixture) -> None:
    """Half of each frame, and nothing of what is out of range."""
    frames = []
    for percent in ("100", "50"):
        assert main(["synth", "m.npz", "a.lab", "-o", "a.csv", "--whole", "--articulation", percent]) == 0
        frames.append(np.loadtxt("a.csv", delimiter=",", skiprows=1)[:, 1:])
    assert np.ptp(frames[0]) > 100 and np.abs(0.5 * frames[0] - frames[1]).max() <= 1
    with pytest.raises(SystemExit):
        main(["synth", "speech_en", "a.lab", "--articulation", "201"])
    assert "'201' is not a whole number within 0 .. 200" in capsys.readouterr().err


def test_a_closed_output_is_an_error(files: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch,
                                     few_streams: None) -> None:
    """Catches a command that fails as if by a defect, or passes although nobody gets its output."""
    for command in ("timings a.lab", "synth m.npz a.lab", "export m.npz --name m -o o"):
        monkeypatch.setattr(sys, "stdout", None)
        assert main(command.split()) == 1
        assert capsys.readouterr().err.splitlines()[-1] == "labial: standard output is closed"
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["timings", "a.lab", "-o", "b.lab"]) == 0 and run("p", lambda: 0) == 0


def test_export_prints_memory_and_loss(files: Path, capsys: pytest.CaptureFixture, few_streams: None) -> None:
    """The files are there and the tables name what was measured."""
    assert main("export m.npz --name mine -o out --blob".split()) == 0
    text = capsys.readouterr().out
    assert {path.name for path in Path("out").iterdir()} == {"mine.c", "mine.h", "mine_names.c", "mine.lbm"}
    assert "flash, model" in text and "RAM, workspace" in text and "open_jaw" in text and "nats per" in text


def test_options_of_one_method_are_not_silently_ignored(files: Path, capsys: pytest.CaptureFixture,
                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    """An option that has no effect with the method is told so; others are passed on without a word."""
    asked = []
    monkeypatch.setattr("labial.train.train", lambda corpus, **options: asked.append(options) or random_model(3))
    monkeypatch.setattr("labial.train.backed_off", lambda model: [])
    monkeypatch.setattr("labial.corpus.read_corpora", lambda *_, **__: [])
    for method, options, warned in (
        ("paper", [], False), ("labial", ["--look-ahead", "60", "--search-stride", "1"], False),
        ("paper", ["--search-stride", "1"], True), ("paper", ["--look-ahead", "60"], True),
        ("labial", ["--talker-variance", "0.5"], False), ("paper", ["--talker-variance", "0.5"], True),
        ("paper", ["--normalise"], False), ("labial", ["--normalise"], True),
    ):
        assert main(["train", "corpus", "-o", "m.npz", "--method", method, *options]) == 0
        err = capsys.readouterr().err
        assert (f"--method {method}" in err) == warned and all(name in err for name in options[::2] if warned)
    assert asked[1]["look_ahead"] == 0.06 and asked[1]["search_stride"] == 1
    assert not {"look_ahead", "search_stride", "talker_variance"} & set(asked[0])
    assert asked[4]["talker_variance"] == 0.5
    assert [options["normalise"] for options in asked[-2:]] == [True, True] and not asked[0]["normalise"]


@pytest.mark.slow
def test_amplitude_widens_what_is_exported(files: Path, few_streams: None) -> None:
    """Calmed to nothing the target stands still, so that kernels and slopes vanish from the tables."""
    for factor, moves in (("1", True), ("0", False)):
        assert main(["export", "m.npz", "--name", "m", "-o", factor, "--amplitude", factor]) == 0
        text = Path(factor, "m.c").read_text()
        kernels = text[text.index(" kernels[") :]
        words = kernels[kernels.index("{") + 1 : kernels.index("}")].replace(",", " ").split()
        assert any(word != "0x80808080u" for word in words) == moves  # four channels, 128 more than each
    assert main("export m.npz --name m -o o --amplitude -1".split()) == 1


# ---- Programs with a command line ------------------------------------------------------------------------------------


PARSER = Parser(prog="p")
PARSER.add_argument("--share", type=number(0, 1))
PARSER.add_argument("--count", type=partial(whole, 1, 9))


@pytest.mark.parametrize("arguments", [["--share", "0"], ["--share", "1.0"], ["--count", "9"], ["--share", "1e-3"]])
def test_numbers_within_their_limits(arguments: list) -> None:
    """Catches limits that do not belong to the range, and whole numbers that are none."""
    found = PARSER.parse_args(arguments)
    assert found.share == float(arguments[1]) if arguments[0] == "--share" else found.count == int(arguments[1])
    assert not isinstance(found.count, float)


@pytest.mark.parametrize(("arguments", "message"), [
    (["--share", "1.1"], "argument --share: '1.1' is not a number from 0 to 1"),
    (["--share", "nan"], "argument --share: 'nan' is not a number from 0 to 1"),
    (["--share", "x"], "argument --share: 'x' is not a number from 0 to 1"),
    (["--count", "1.0"], "argument --count: '1.0' is not a whole number within 1 .. 9"),
    (["--count", "10"], "argument --count: '10' is not a whole number within 1 .. 9"),
    (["a\nb"], "unrecognized arguments: a\\nb"),
])
def test_errors_in_arguments_are_one_line(arguments: list, message: str, capsys: pytest.CaptureFixture) -> None:
    """Catches a usage in front of the message."""
    with pytest.raises(SystemExit) as ended:
        PARSER.parse_args(arguments)
    assert ended.value.code == 2 and capsys.readouterr().err == f"p: {message}\n"


def raises(error: BaseException) -> Callable[[], int]:
    def main() -> NoReturn:
        raise error

    return main


@pytest.mark.parametrize(("main", "status", "message"), [
    (lambda: 0, 0, ""), (lambda: 7, 7, ""), (raises(KeyboardInterrupt()), 130, ""),
    (raises(LabialError("a.wav: two\nlines")), 1, "p: a.wav: two\\nlines\n"),
    (raises(FileNotFoundError(errno.ENOENT, "any", "a.toml")), 1, "p: a.toml: No such file or directory\n"),
    (raises(OSError(errno.EADDRINUSE, "long words about it")), 1, "p: Address already in use\n"),
    (raises(OSError("in words")), 1, "p: in words\n"),
    # Its number belongs to another list than the operating system's.
    (raises(OSError(-2, "Name or service not known")), 1, "p: Name or service not known\n"),
])
def test_a_program_ends_with_a_line_and_a_status(main: Callable[[], int], status: int, message: str,
                                                 capsys: pytest.CaptureFixture) -> None:
    """Catches a traceback."""
    assert run("p", main) == status and capsys.readouterr().err == message


def test_other_errors_are_defects() -> None:
    """Catches a mistake in a program that is passed off as one of its user."""
    with pytest.raises(ZeroDivisionError):
        run("p", raises(ZeroDivisionError()))


def test_a_reader_that_goes_is_no_error() -> None:
    """Catches a complaint about a closed pipe, by the program or by Python at its end."""
    source = ("import sys\nfrom labial.program import run\n"
              "sys.exit(run('p', lambda: [print('x' * 99) for _ in range(100000)] and 0))\n")
    with subprocess.Popen([sys.executable, "-c", source], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout and process.stderr
        process.stdout.read(10)
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(30) == 1


# ---- Whatever it is given --------------------------------------------------------------------------------------------

SYLLABLES = "".join(f"{n / 10} {n / 10 + 0.1} {label}\n" for n, label in enumerate(4 * ["SIL", "AA", "M", "IY", "SIL"]))


@contextmanager
def limited(seconds: float, memory: int) -> Iterator[None]:
    """Ends what takes more processor time than `seconds`, or more bytes than `memory` on top of what is in use."""
    def late(*_: object) -> None:
        raise RuntimeError("it takes too long")

    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + memory, before[1]))
    previous = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous)
        resource.setrlimit(resource.RLIMIT_AS, before)


class Told:
    """Runs the command and holds it to its promise: status 0, 1 or 2, and of an error one line."""

    def __init__(self, capsys: pytest.CaptureFixture) -> None:
        self._capsys = capsys

    def __call__(self, *arguments: object) -> str:
        """The line of the error, or nothing."""
        self._capsys.readouterr()
        try:
            status = main([str(argument) for argument in arguments])
        except SystemExit as error:
            status = int(error.code or 0)
        said = [line for line in self._capsys.readouterr().err.splitlines() if "labial: warning: " not in line]
        assert status in (0, 1, 2) and len(said) == (1 if status else 0), (arguments, status, said)
        return said[0] if said else ""


@pytest.fixture
def told(capsys: pytest.CaptureFixture) -> Iterator[Told]:
    """Runs commands within limits of memory and time."""
    if sys.platform != "linux":
        pytest.skip("limits of memory and time are those of Linux")
    with limited(60, 3_000_000_000):
        yield Told(capsys)


def corpus(folder: Path, lab: str = "0 2 SIL\n", count: int = 1,
           frames: Callable[[int], List[float]] = lambda t: [0.0] * 13) -> Path:
    """Writes episodes of two seconds."""
    folder.mkdir()
    for k in range(count):
        write_motion(folder / f"u{k}.csv", np.arange(100) / 50, np.array([frames(t) for t in range(100)]))
        (folder / f"u{k}.lab").write_text(lab)
    return folder


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a file of each kind."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("a.lab", LAB), ("face.toml", FACE), ("talk.lab", TALK)):
        (tmp_path / name).write_text(text)
    write_motion(tmp_path / "f.csv", np.arange(9) / 50, np.tile(np.arange(13.0), (9, 1)))
    save(random_model(1), tmp_path / "m.npz")
    np.savez(tmp_path / "talk.npz", landmarks=turned(talking()[0]), fps=50.0)
    return tmp_path


@pytest.mark.parametrize(("frames", "lab", "count"), [
    (lambda t: [0.0] * 13, SYLLABLES, 3),
    pytest.param(lambda t: [t % 7.0] + [5.0] * 12, SYLLABLES, 3, marks=pytest.mark.slow),
    (lambda t: [1e300] * 13, "0 2 SIL\n", 2), (lambda t: [t * 1e4] * 13, SYLLABLES, 3),
    pytest.param(lambda t: [1e-300 * t] * 13, SYLLABLES, 3, marks=pytest.mark.slow),
    (lambda t: [float(t)] * 13, "0 2 SIL\n", 2),
    (lambda t: [float(t)] * 13, "0 .001 AA\n", 2), (lambda t: [float(t)] * 13, "0 86000 AA\n", 1),
], ids=["zeros", "constants", "1e300", "far", "1e-300", "silence", "short", "long"])
def test_absurd_corpora(tmp_path: Path, told: Told, frames: Callable, lab: str, count: int) -> None:
    """Would catch a traceback in training, and a model that is trained but cannot be read or exported."""
    pytest.importorskip("sklearn")
    folder = corpus(tmp_path / "c", lab, count, frames)
    model = tmp_path / "m.npz"
    for method in ("paper", "labial"):
        line = told("train", folder, "-o", model, "--method", method, "--jobs", 1, "--codebook", 4, "--components", 1)
        if line:
            assert line.startswith("labial: "), line
            return
        assert not told("export", model, "--name", "m", "-o", tmp_path / "out")


@pytest.mark.parametrize("arguments", [
    "train c -o x.npz --seed -1", "train c -o x.npz --seed 1_0", "train c -o x.npz --seed 4294967296",
    "train c -o x.npz --seed '\u0661'", "train c -o x.npz --jobs 999999999999999999999999999999",
    "train c -o x.npz --jobs 0", "train c -o x.npz --fps '\xb2'", "train c -o x.npz --look-ahead -1",
    "train c -o x.npz --look-ahead nan", "train c -o x.npz --talker-variance 0",
    "train c -o x.npz --talker-variance nan", "train c -o x.npz --adapt none.npz", "train c -o x.npz --adapt m.npz",
    "evaluate c -o r --talker-variance -1", "train '' -o x.npz", "train a.lab -o x.npz", "laughter-corpus l --seed -1",
    "laughter-corpus a.lab", "laughter-corpus ''", "evaluate c -o r --seed -1", "evaluate none -o r",
    "evaluate c -o r --methods ''", "export m.npz --name '' -o o", "export m.npz --name m -o o --amplitude nan",
    "export m.npz --name 'm\n' -o o", "export m.npz --name m -o o --amplitude 1e400", "export m.npz --name m -o a.lab",
    "export m.npz --name m -o /dev/null", "record talk.npz -o o --fps nan", "record talk.npz -o o --offset 1e300",
    "record talk.npz -o o --cutoff -1", "record talk.npz -o o --size 1x1", "record talk.npz -o a.lab",
    "record '' -o o", "record f.csv -o o", "timings ''", "timings .", "timings /dev/null", "timings /dev/zero",
    "timings none", "timings a.lab -o .", "timings a.lab -o none/x", "timings 'a\nb'", "timings '\udcff.lab'",
    "synth m.npz '' -o x", "synth . a.lab", "synth m.npz a.lab -o .", "synth /dev/null a.lab", "synth /dev/zero a.lab",
    "synth none a.lab", "page f.csv -o .", "page . -o x.html", "page f.csv -o x --audio /dev/null",
    "page f.csv -o x --audio .", "plot f.csv -o x.png --channels ,", "plot f.csv -o none/x.png", "plot f.csv -o ''",
    "rig /dev/null -o o", "rig . -o o", "rig face.toml -o a.lab", "rig /dev/zero -o o --name x", "bake f.csv -o .h",
    "bake '' -o x.h", "bake . -o x.h", "nothing", "bake", "align a.lab", "align /dev/null", "align .",
    "align '' --text a", "align none.wav --text-file /dev/zero",
])
def test_absurd_arguments(files: Path, told: Told, arguments: str) -> None:
    """Would catch an argument that no command foresees: whatever it is, it is refused in one line."""
    line = told(*shlex.split(arguments))
    assert line.startswith("labial"), line


def test_names_that_are_not_utf8(files: Path) -> None:
    """Would catch a name that cannot be printed, and a text that cannot be written because of it."""
    name = "\udcff\udcfe"
    for file in ("a.lab", "f.csv", "m.npz"):
        (files / file).rename(files / (name + file[1:]))
    (files / "a.lab").write_text(LAB)
    script = "import sys\nfrom labial.__main__ import main\nsys.exit(any([main(a.split('|')) for a in sys.argv[1:]]))"
    asked = [["timings", f"{name}.lab"], ["bake", f"{name}.csv", "-o", "o.h"], ["page", f"{name}.csv", "-o", "o.html"],
             ["rig", "face.toml", "-o", name, "--no-figure"]]
    asked += [["synth", f"{name}.npz", "a.lab", "-o", f"{name}.{kind}", "--to", kind] for kind in FORMATS]
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
    assert "ZeroDivisionError: by nothing (test_cli.py, line" in capsys.readouterr().err
