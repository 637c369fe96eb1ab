"""The models that Labial comes with, and models that are given by the name of one or by a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Union

from labial.errors import LabialError
from labial.runtime import BUNDLED

PathLike = Union[str, os.PathLike]

#: The bundled models by kind.
BY_KIND = dict(zip(("speech", "laughter"), BUNDLED))

#: What help says of an argument that takes a model.
MODEL_HELP = f"a model's file (.npz), or the name of one that Labial comes with: {', '.join(BUNDLED)}"


def model_file(model: PathLike) -> Path:
    """The file of a model: `model` itself, or that of the bundled model of this name, in the package or in the source
    tree. A file of the same name is given as ``./NAME``. Raises LabialError where a bundled model is not installed."""
    name = os.fspath(model)
    if name not in BUNDLED:
        return Path(name)
    package = Path(__file__).resolve().parent
    for folder in (package / "models", package.parent / "models"):
        if (folder / f"{name}.npz").is_file():
            return folder / f"{name}.npz"
    raise LabialError(f"the model {name} is not installed with this package: name a model's file")


def is_model(path: PathLike) -> bool:
    """Whether `path` is a model: the name of a bundled one, or a file that ends in .npz."""
    return os.fspath(path) in BUNDLED or Path(path).suffix.lower() == ".npz"
