"""The command line: each sub-command end to end, errors as one line, and what the statuses mean."""

from __future__ import annotations

import errno
import subprocess
import sys
from pathlib import Path
from typing import Callable, NoReturn

import numpy as np
import pytest

import labial.commands
from labial.__main__ import main
from labial.commands import COMMANDS
from labial.errors import LabialError
from labial.program import Parser, number, os_error, run, whole
from labial.tables.model import save
from models import random_model

LAB = "0.00 0.20 SIL\n0.20 0.31 P1\n0.31 0.42 p1\n0.50 0.71 P4\n0.71 1.00 SIL\n"


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


@pytest.fixture
def given(tmp_path: Path) -> Path:
    save(random_model(1), tmp_path / "model.npz")
    (tmp_path / "phones.lab").write_text(LAB)
    return tmp_path


def test_synth_articulates(given: Path, capsys: pytest.CaptureFixture) -> None:
    """Half of each frame, and nothing of what is out of range."""
    frames = []
    for percent in ("100", "50"):
        assert main(["synth", str(given / "model.npz"), str(given / "phones.lab"), "-o", str(given / "a.csv"),
                     "--whole", "--articulation", percent]) == 0
        frames.append(np.loadtxt(given / "a.csv", delimiter=",", skiprows=1)[:, 1:])
    assert np.ptp(frames[0]) > 100 and np.abs(0.5 * frames[0] - frames[1]).max() <= 1
    with pytest.raises(SystemExit):
        main(["synth", "speech_en", str(given / "phones.lab"), "--articulation", "201"])
    assert "'201' is not a whole number within 0 .. 200" in capsys.readouterr().err


def test_a_closed_output_is_an_error(
    given: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Catches a command that fails as if by a defect, or passes although nobody gets its output."""
    phones = str(given / "phones.lab")
    for command in (["timings", phones], ["synth", str(given / "model.npz"), phones],
                    ["export", str(given / "model.npz"), "--name", "m", "-o", str(given)]):
        monkeypatch.setattr(sys, "stdout", None)
        assert main(command) == 1
        assert capsys.readouterr().err.splitlines()[-1] == "labial: standard output is closed"
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["timings", phones, "-o", str(given / "a.lab")]) == 0 and run("p", lambda: 0) == 0


def test_export_prints_memory_and_loss(given: Path, capsys: pytest.CaptureFixture) -> None:
    """The files are there and the tables name what was measured."""
    assert main(["export", str(given / "model.npz"), "--name", "my_model", "-o", str(given / "out"), "--blob"]) == 0
    text = capsys.readouterr().out
    assert {path.name for path in (given / "out").iterdir()} == {
        "my_model.c", "my_model.h", "my_model_names.c", "my_model.lbm"}  # fmt: skip
    assert "flash, model" in text and "RAM, workspace" in text and "open_jaw" in text and "nats per" in text


def test_check_compares_with_both_references(given: Path, capsys: pytest.CaptureFixture) -> None:
    """The made-up model's paths flip at near ties, so the verdict is open; the comparison on the same tables is not."""
    status = main(["check", str(given / "model.npz"), str(given / "phones.lab"), "--predecessors", "12"])
    captured = capsys.readouterr()
    assert "50 frames" in captured.out and "open_jaw" in captured.out
    assert "same tables" not in captured.err
    assert status == (1 if captured.err else 0)


def test_options_of_one_method_are_not_silently_ignored(
    given: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An option that has no effect with the method is told so; others are passed on without a word."""
    asked = []
    monkeypatch.setattr("labial.train.train", lambda corpus, **options: asked.append(options) or random_model(3))
    monkeypatch.setattr("labial.train.backed_off", lambda model: [])
    monkeypatch.setattr("labial.corpus.corpora.read_corpus", lambda path, kind: [])
    for method, options, warned in (
        ("paper", [], False), ("labial", ["--look-ahead", "60", "--search-stride", "1"], False),
        ("paper", ["--search-stride", "1"], True), ("paper", ["--look-ahead", "60"], True),
        ("labial", ["--talker-variance", "0.5"], False), ("paper", ["--talker-variance", "0.5"], True),
        ("paper", ["--normalise"], False), ("labial", ["--normalise"], True),
    ):
        assert main(["train", "corpus", "-o", str(given / "m.npz"), "--method", method, *options]) == 0
        err = capsys.readouterr().err
        assert (f"--method {method}" in err) == warned and all(name in err for name in options[::2] if warned)
    assert asked[1]["look_ahead"] == 0.06 and asked[1]["search_stride"] == 1
    assert not {"look_ahead", "search_stride", "talker_variance"} & set(asked[0])
    assert asked[4]["talker_variance"] == 0.5
    assert [options["normalise"] for options in asked[-2:]] == [True, True] and not asked[0]["normalise"]


@pytest.mark.slow
def test_amplitude_widens_what_is_exported(given: Path) -> None:
    """Calmed to nothing the target stands still, so that kernels and slopes vanish from the tables."""
    for factor, moves in (("1", True), ("0", False)):
        out = given / f"out{factor}"
        assert main(["export", str(given / "model.npz"), "--name", "m", "-o", str(out), "--amplitude", factor]) == 0
        text = (out / "m.c").read_text()
        kernels = text[text.index(" kernels[") :]
        words = kernels[kernels.index("{") + 1 : kernels.index("}")].replace(",", " ").split()
        assert any(word != "0x80808080u" for word in words) == moves  # four channels, 128 more than each
    assert main(["export", str(given / "model.npz"), "--name", "m", "-o", str(given), "--amplitude", "-1"]) == 1


# ---- Programs with a command line ------------------------------------------------------------------------------------


def parser() -> Parser:
    found = Parser(prog="p")
    found.add_argument("--share", type=number(0, 1))
    found.add_argument("--count", type=whole(1, 9))
    return found


@pytest.mark.parametrize("arguments", [["--share", "0"], ["--share", "1.0"], ["--count", "9"], ["--share", "1e-3"]])
def test_numbers_within_their_limits(arguments: list) -> None:
    """Catches limits that do not belong to the range, and whole numbers that are none."""
    found = parser().parse_args(arguments)
    assert found.share == float(arguments[1]) if arguments[0] == "--share" else found.count == int(arguments[1])
    assert not isinstance(found.count, float)


@pytest.mark.parametrize(("arguments", "message"), [
    (["--share", "1.1"], "argument --share: '1.1' is not a number from 0 to 1"),
    (["--share", "nan"], "argument --share: 'nan' is not a number from 0 to 1"),
    (["--share", "x"], "argument --share: 'x' is not a number from 0 to 1"),
    (["--count", "1.0"], "argument --count: '1.0' is not a whole number from 1 to 9"),
    (["--count", "10"], "argument --count: '10' is not a whole number from 1 to 9"),
    (["a\nb"], "unrecognized arguments: a\\nb"),
])
def test_errors_in_arguments_are_one_line(arguments: list, message: str, capsys: pytest.CaptureFixture) -> None:
    """Catches a usage in front of the message."""
    with pytest.raises(SystemExit) as ended:
        parser().parse_args(arguments)
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
])
def test_a_program_ends_with_a_line_and_a_status(main: Callable[[], int], status: int, message: str,
                                                 capsys: pytest.CaptureFixture) -> None:
    """Catches a traceback."""
    assert run("p", main) == status and capsys.readouterr().err == message


def test_other_errors_are_defects() -> None:
    """Catches a mistake in a program that is passed off as one of its user."""
    with pytest.raises(ZeroDivisionError):
        run("p", raises(ZeroDivisionError()))


def test_errors_of_names_keep_their_words() -> None:
    """Catches numbers that belong to another list than the operating system's."""
    assert os_error(OSError(-2, "Name or service not known")) == "Name or service not known"


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
