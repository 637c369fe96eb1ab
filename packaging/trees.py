"""The parts of the source tree that PlatformIO, ESP-IDF and Zephyr read, without the rest; the library as two files."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Dict, List, Tuple

from source import ROOT, Source, notices, write_text

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


# ---- The library as two files ----------------------------------------------------------------------------------------

# labial.h has the public headers, labial.c everything else, each file whole and unchanged. A header is placed where it
# is first included. File-scope names and macros of lib/ differ from file to file, which tests/python/test_packages.py
# checks by compiling the result.
_INCLUDE = re.compile(r'^#include "(?:labial/)?([^"]+)"\n', re.MULTILINE)


def _joined(source: Source, files: List[Path], title: str, above: List[Path]) -> str:
    """`files` one after the other, without the headers `above`, which the result requires."""
    headers = {path.name: path for path in source.public + source.private}
    done = list(above)

    def section(path: Path) -> str:
        if path in done:
            return ""
        done.append(path)
        text = _INCLUDE.sub(lambda match: section(headers[match[1]]), path.read_text(encoding="utf-8"))
        return f"/* ---- {path.parent.name}/{path.name} ---- */\n\n{text}\n"

    notice = f"{title}; Labial {source.version}. Written by packaging/pack.py; do not edit.\n\n"
    notice += (ROOT / "LICENSE").read_text(encoding="utf-8")
    return f"/*\n{notice}*/\n\n" + "".join(map(section, files))


def amalgamate(source: Source, folder: Path) -> None:
    """Writes labial.h, labial.c, the models and words, which include nothing else of Labial, and the licence into
    `folder`."""
    write_text(folder / "labial.h", _joined(source, source.public, "Labial's public headers", []))
    text = _joined(source, source.sources, "Labial's code", source.public)
    write_text(folder / "labial.c", '#include "labial.h"\n' + text)
    for path in [*(path for model in source.models for path in model.files), *source.words]:
        text = re.sub(r'^#include "labial/[^"]+"$', '#include "labial.h"', path.read_text("utf-8"), flags=re.MULTILINE)
        write_text(folder / path.name, text)
    write_text(folder / "LICENSE", source.licence())
