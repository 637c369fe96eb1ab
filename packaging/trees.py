"""The parts of the source tree that PlatformIO, ESP-IDF and Zephyr read, without the rest."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Dict, Tuple

from notices import notices
from source import ROOT, Source, write_text

#: The files that each needs besides include/ and lib/.
MANIFESTS: Dict[str, Tuple[str, ...]] = {
    "platformio": ("library.json",),
    "esp-idf": ("CMakeLists.txt", "cmake/EspIdfComponent.cmake", "idf_component.yml"),
    "zephyr": ("zephyr/module.yml", "zephyr/CMakeLists.txt", "zephyr/Kconfig"),
}


def write(source: Source, folder: Path, kind: str) -> None:
    """Copies the library, the models and the manifests of `kind` into `folder`, each to its own place."""
    library = [*source.public, *source.private, *source.sources, *source.words, ROOT / "LICENSE"]
    targets = {path: path.relative_to(ROOT) for path in [*library, *(ROOT / name for name in MANIFESTS[kind])]}
    for model in source.models:
        targets.update((path, Path("lib", "models", path.name)) for path in model.files)
    for path, name in targets.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / name)
    write_text(folder / "NOTICE", notices(source.headers()))
