"""What commands say of files of strangers: within limits of memory and time, one line of an error or nothing."""

from __future__ import annotations

import resource
import signal
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

import pytest

from labial.__main__ import main


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
