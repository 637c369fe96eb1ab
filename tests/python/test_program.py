"""Programs with a command line: errors are one line, and statuses tell what happened."""

from __future__ import annotations

import errno
import subprocess
import sys
from typing import Callable, NoReturn

import pytest

from labial.errors import LabialError
from labial.program import Parser, number, os_error, run, whole


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
