"""Rigs: readable descriptions of faces, as C tables for ``labial/rig.h`` and as drawings.

The descriptions in this folder, NAME.toml, are the built-in rigs. Each is an output format of the same name in ``labial
synth --to``, ``labial-say --to``, and ``render()`` in JavaScript. The C programs read them from this folder, too
(examples/faces/CMakeLists.txt).
"""

from __future__ import annotations

from pathlib import Path
from typing import Tuple

_FOLDER = Path(__file__).resolve().parent
#: Names of the built-in rigs.
FACES: Tuple[str, ...] = tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def description_of(face: str) -> Path:
    """The file that describes one of `FACES`."""
    return _FOLDER / f"{face}.toml"
