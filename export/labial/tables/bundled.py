"""The bundled models, and models that are named by a bundled name or a file."""

from __future__ import annotations

import os
from pathlib import Path

from labial import BUNDLED
from labial.errors import LabialError, PathLike, did_you_mean

#: The bundled models by kind.
BY_KIND = dict(zip(("speech", "laughter"), BUNDLED))
#: Help of an argument that takes a model.
MODEL_HELP = f"a model's file (.npz), or the name of one that Labial comes with: {', '.join(BUNDLED)}"


def model_file(model: PathLike) -> Path:
    """The file of a model: `model` itself, or that of the bundled model of this name, in the package or in the source
    tree. For a file of the same name write ``./NAME``. Raises LabialError if a bundled model is not installed."""
    name = os.fspath(model)
    if name not in BUNDLED:
        if not Path(name).suffix and os.sep not in name and not os.path.exists(name):
            raise LabialError(f"{name!r} is neither a file nor a bundled model: {did_you_mean(name, BUNDLED)}")
        return Path(name)
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "models", package.parent / "models"):
        if (folder / f"{name}.npz").is_file():
            return folder / f"{name}.npz"
    raise LabialError(f"the model {name} is not installed with this package: name a model's file")


def is_model(path: PathLike) -> bool:
    """Whether `path` is a model: the name of a bundled one, or a file that ends in .npz."""
    return os.fspath(path) in BUNDLED or Path(path).suffix.lower() == ".npz"
