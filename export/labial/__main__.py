"""The command ``labial``, also ``python -m labial``. `labial.commands` lists its commands and their modules."""

from __future__ import annotations

import argparse
import io
import os
import signal
import sys
import traceback
import warnings
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import Iterator, List, Optional, Sequence

from labial import __version__
from labial.commands import COMMANDS
from labial.errors import LabialError, did_you_mean, needs
from labial.program import Parser, check_output, complain, drop_output


def parser(arguments: Sequence[str]) -> argparse.ArgumentParser:
    """The parser of a command line. It imports only the module of the command that `arguments` name."""
    top = Parser(prog="labial", description="Trains lip-motion models and exports them for the C library.")
    top.add_argument("--version", action="version", version=f"labial {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, (module, text) in COMMANDS.items():
        command = commands.add_parser(name, help=text)
        if name in arguments:
            functions, suffix = vars(import_module(f"labial.commands.{module}")), name.replace("-", "_")
            functions[f"add_{suffix}"](command)
            command.set_defaults(run=functions[f"run_{suffix}"])
    return top


class _Ended(BaseException):
    """Raised by a signal that ends the command; handlers of the exception remove temporary files."""


@contextmanager
def _ending() -> Iterator[None]:
    """Within the block, SIGTERM and SIGHUP raise `_Ended` instead of ending the process at once."""
    def end(number: int, _: Optional[FrameType]) -> None:
        raise _Ended(number)

    before = {}
    for name in ("SIGTERM", "SIGHUP"):
        with suppress(AttributeError, ValueError):  # Windows has no SIGHUP; only the main thread may set handlers
            number = getattr(signal, name)
            if signal.getsignal(number) is signal.SIG_DFL:
                before[number] = signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command and returns its exit status: 0; 1 when an input cannot be used; 3 for an internal error; 128
    plus the signal's number when a signal ended it."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given[:1] == ["help"]:
        given = [*given[1:2], "--help"]
    top = parser(given)
    if not given:
        top.print_help()
        return 0
    if not given[0].startswith("-") and given[0] not in COMMANDS:
        top.error(f"{given[0]!r} is no command: {did_you_mean(given[0], COMMANDS)}")
    options = top.parse_args(given)
    check_output()
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # file names are written unchanged
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: _complain(f"warning: {message}")
        try:
            with _ending(), needs(f"labial {options.command}", "tools"):
                status = int(options.run(options) or 0)
                sys.stdout.flush()
                return status
        except LabialError as error:
            _complain(str(error))
        except BrokenPipeError:  # the reader of the output closed the pipe
            drop_output()
        except OSError as error:
            named = isinstance(error.filename, (str, bytes, os.PathLike))
            _complain(f"{os.fsdecode(error.filename) if named else 'the output'}: {error.strerror or error}")
            drop_output()
        except MemoryError:
            _complain("there is not enough memory for this")
        except KeyboardInterrupt:
            _complain("interrupted")
            return 130
        except _Ended as ended:
            _complain(f"ended by {signal.Signals(ended.args[0]).name}")
            return 128 + int(ended.args[0])
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            _complain(f"this is a defect of labial, please report it: {type(error).__name__}: {error} "
                      f"({Path(place.filename).name}, line {place.lineno})")
            return 3
    return 1


def _complain(text: str) -> None:
    complain("labial", text)


if __name__ == "__main__":
    sys.exit(main())
