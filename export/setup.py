"""Packs the C library with the exporter, so that ``labial check`` finds it wherever the package is installed."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

_HERE = Path(__file__).resolve().parent

#: Where the library's files lie: beside this folder in the source tree, inside the package in a source distribution.
_TREES = (_HERE.parent, _HERE / "labial" / "library")


def _copy_library(target: Path) -> None:
    tree = next((tree for tree in _TREES if (tree / "include" / "labial" / "labial.h").is_file()), None)
    if tree is None:
        raise SystemExit(f"{_HERE.parent}: the C library, include/ and lib/, is not beside the exporter")
    for pattern in ("LICENSE", "include/labial/*.h", "lib/*.c", "lib/*.h"):
        for path in tree.glob(pattern):
            copy = target / path.relative_to(tree)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)


class _BuildWithLibrary(build_py):
    def run(self) -> None:
        super().run()
        if not getattr(self, "editable_mode", False):  # there the source tree itself is used
            _copy_library(Path(self.build_lib) / "labial" / "library")


class _SourcesWithLibrary(sdist):
    def make_release_tree(self, base_dir: str, files: list) -> None:
        super().make_release_tree(base_dir, files)
        _copy_library(Path(base_dir) / "labial" / "library")


setup(cmdclass={"build_py": _BuildWithLibrary, "sdist": _SourcesWithLibrary})
