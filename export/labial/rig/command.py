"""The sub-command ``labial rig``."""

from __future__ import annotations

from pathlib import Path
from typing import List, Optional

from labial.emit import check_name
from labial.rig import figure, table
from labial.rig.description import read


def run(description: str, directory: str, *, name: Optional[str] = None, drawing: bool = True) -> List[Path]:
    """Writes NAME.h, NAME.c and, with `drawing`, NAME.svg; NAME is the description's file name unless given."""
    name = name or Path(description).stem
    check_name(name, "rig")
    rig = read(description, name)
    paths = table.write(rig, directory)
    if drawing:
        path = Path(directory) / f"{name}.svg"
        figure.draw(rig, path)
        paths.append(path)
    return paths
