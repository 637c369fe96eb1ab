"""A rig of weights as the JSON that `labial.rig()` of the npm package reads: the numbers of the C table, by name."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Union

from labial.errors import DataError
from labial.files.outputs import writing
from labial.rig.description import Rig
from labial.rig.table import convert


def text(rig: Rig) -> str:
    """The file's text. Raises DataError for a rig of servos, whose limits of speed a page does not apply."""
    if rig.unit.name != "weight":
        raise DataError(rig.path, None, f'unit: --json is for faces of weights, "weight", not {rig.unit.name!r}')
    outputs = {}
    for output in convert(rig):
        for key in ("slew", "deadband", "acceleration"):
            if getattr(output, key):
                raise DataError(rig.path, None, f"output.{output.name}.{key}: is for servos, not for --json")
        outputs[output.name] = {
            "weights": output.weights, "gain": output.gain, "neutral": output.neutral, "minimum": output.minimum,
            "maximum": output.maximum, "invert": int(output.invert), "contact": int(output.closed is not None),
            "closed": output.closed or 0, **({"curve": output.curve} if output.curve else {}),
            **({"visemes": output.visemes} if output.visemes else {})}  # fmt: skip
    rows = ",\n".join(f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in outputs.items())
    return f'{{"labial": "rig", "name": {json.dumps(rig.name)}, "outputs": {{\n{rows}\n}}}}\n'


def write(rig: Rig, directory: Union[str, os.PathLike[str]]) -> Path:
    """Writes NAME.json into `directory`; its path."""
    content = text(rig)
    path = Path(directory) / f"{rig.name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    with writing(path, "ascii") as out:
        out.write(content)
    return path
