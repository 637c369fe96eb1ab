"""Shared by all measurements: figures, running tools, and reporting skipped measurements."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import List, Optional, Sequence, Union


class LeftOut(Exception):
    """The reason why a figure cannot be measured on this machine."""


@dataclass(frozen=True)
class Figure:
    """One measured number. `tool` is what it depends on besides the sources: a compiler and its version."""

    target: str
    figure: str
    value: float
    unit: str
    command: str
    tool: str

    @property
    def timed(self) -> bool:
        """Whether it depends on the machine and its load."""
        return self.unit in ("frames/s", "times real time", "us/frame")

    @property
    def versus_others(self) -> bool:
        """Whether it is the ratio of another program's figure to Labial's."""
        return self.unit.startswith("times Labial's ")

    @property
    def checked(self) -> bool:
        """Whether a baseline holds it: timings and what is measured on somebody's corpus are not for every machine, and
        of ratios to what others need, which :attr:`versus_others` tells, more is better."""
        return not self.timed and not self.versus_others and "corpus" not in self.figure


@dataclass
class Bench:
    source: Path
    build: Path
    figures: List[Figure] = field(default_factory=list)
    left_out: List[str] = field(default_factory=list)

    def add(self, target: str, figure: str, value: float, unit: str, command: Sequence[Union[str, Path]],
            tool: str) -> None:
        """Stores a figure with its command, as formatted by :meth:`shown`."""
        self.figures.append(Figure(target, figure, value, unit, self.shown(command), tool))

    def shown(self, command: Sequence[Union[str, Path]]) -> str:
        """A command as a user would type it in the source folder after the preset `bench`."""
        parts = [str(part).replace(f"{self.build}/", "build/bench/").replace(f"{self.source}/", "") for part in command]
        if parts[0].startswith("/"):
            parts[0] = Path(parts[0]).name
        return " ".join(map(_quoted, parts))

    def value(self, target: str, figure: str) -> Optional[float]:
        return next((one.value for one in self.figures if (one.target, one.figure) == (target, figure)), None)


def _quoted(part: str) -> str:
    return part if part in ("&&", "|", "<", ">", "#") or "*" in part else shlex.quote(part)


def tool(name: str, package: str, what: str) -> str:
    """The path of a program; LeftOut names `what` cannot be measured without it and its Debian package."""
    path = shutil.which(name)
    if not path:
        raise LeftOut(f"{what} is left out, it needs {name}: install the Debian package {package}.")
    return name


def run(command: Sequence[Union[str, Path]], **options: object) -> subprocess.CompletedProcess:
    """Runs a command to its end; RuntimeError with its output when it fails."""
    parts = [str(part) for part in command]
    done = subprocess.run(parts, capture_output=True, **options)  # type: ignore[call-overload]
    if done.returncode:
        output = done.stdout.decode(errors="replace") + done.stderr.decode(errors="replace")
        raise RuntimeError(f"{shlex.join(parts)} ended with {done.returncode}:\n{output}")
    return done


def version(compiler: str) -> str:
    """A compiler and its version, as figures that depend on it name it."""
    text = run([compiler, "--version"]).stdout.decode(errors="replace")
    first = text.splitlines()[0]
    name = Path(compiler).name
    if name in ("cc", "c99"):
        name = "clang" if "clang" in first else "gcc" if "Free Software Foundation" in text else name
    numbers = re.findall(r"\d+\.\d+\.\d+", first)  # the last: packages put their own before it
    return f"{name} {numbers[-1] if numbers else first}"
