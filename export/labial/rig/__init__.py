"""Rigs: readable descriptions of what moves a face, as C tables for ``labial/rig.h`` and as drawings.

The descriptions in this folder, NAME.toml, are the rigs that Labial comes with. Each is a format of output of the same
name wherever motion is written: ``labial synth --to``, ``labial-say --to``, ``render()`` in JavaScript. The C programs
take them from this folder, too (examples/faces/CMakeLists.txt).
"""

from __future__ import annotations

from pathlib import Path
from typing import Tuple

_FOLDER = Path(__file__).resolve().parent

#: Names of the rigs that Labial comes with.
FACES: Tuple[str, ...] = tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def description_of(face: str) -> Path:
    """The file that describes one of `FACES`."""
    return _FOLDER / f"{face}.toml"
