"""Programs with a command line, ``labial`` and those of `examples`: an error of their user's is one line on standard
error and a status other than 0, never a traceback."""

from __future__ import annotations

import argparse
import io
import math
import os
import sys
from contextlib import suppress
from typing import Callable, NoReturn, TextIO, cast

from labial.errors import LabialError

#: Characters of the beginning and of the end of a long message that remain: names in a file may be of any length.
_SHOWN = 1500, 400


class Parser(argparse.ArgumentParser):
    """Prints an error in the arguments in one line, and ends with status 2."""

    def error(self, message: str) -> NoReturn:
        """Called by `parse_args`."""
        self.exit(2, f"{self.prog}: {one_line(message)}\n")


def number(least: float, most: float) -> Callable[[str], float]:
    """The `type` of a number from `least` to `most`; :func:`labial.files.grammar.whole` is that of whole ones."""
    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number from {least:g} to {most:g}")
        return value

    return read


class _Closed(io.TextIOBase):
    """Standard output that the program was started without."""

    def write(self, text: str) -> int:
        raise LabialError("standard output is closed")


def check_output() -> None:
    """Makes it an error to write to standard output where it is closed; Python has None there."""
    sys.stdout = sys.stdout or cast(TextIO, _Closed())


def run(name: str, main: Callable[[], int]) -> int:
    """The exit status of a program: what `main` returns, 1 after a line about a LabialError or an OSError, or quietly
    where the reader of its output has gone, 130 after Ctrl-C."""
    check_output()
    try:
        status = main()
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        drop_output()
    except LabialError as error:
        complain(name, error)
    except OSError as error:
        complain(name, os_error(error))
    except KeyboardInterrupt:
        return 130
    return 1


def complain(name: str, problem: object) -> None:
    """A line of the program `name` on standard error."""
    text, (begin, end) = one_line(str(problem)), _SHOWN
    shown = text if len(text) <= begin + end else f"{text[:begin]} ... {text[-end:]}"
    print(f"{name}: {shown}", file=sys.stderr, flush=True)


def one_line(text: str) -> str:
    """`text` as one printable line: control characters and bytes that are not UTF-8 are escaped."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def os_error(error: OSError) -> str:
    """The file of an error of the operating system, if it has one, and what is wrong."""
    code = error.errno or 0
    why = os.strerror(code) if code > 0 else error.strerror or str(error)
    named = isinstance(error.filename, (str, bytes, os.PathLike))
    return f"{os.fsdecode(error.filename)}: {why}" if named else why


def drop_output() -> None:
    """Discards unwritten standard output, so that Python does not try to write it again at exit."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
