"""The npm package as the tests use it: LABIAL_NPM_PACKAGE names its folder, or it is built."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from packages import CMAKE, SOURCE, run

_BUILT = os.environ.get("LABIAL_NPM_PACKAGE", "")
#: What cannot be had, "" where all is there.
MISSING = "" if _BUILT or (CMAKE and shutil.which("clang") and shutil.which("wasm-ld")) else (
    "needs clang and wasm-ld: install the Debian packages clang and lld")  # fmt: skip


def package(folder: Path) -> Path:
    """The folder of the package, built below `folder` unless it is there already."""
    if _BUILT:
        return Path(_BUILT)
    run(CMAKE, "-S", SOURCE, "-B", folder, f"-DCMAKE_TOOLCHAIN_FILE={SOURCE / 'boards' / 'toolchains' / 'wasm.cmake'}",
        "-DCMAKE_BUILD_TYPE=Release", "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF")  # fmt: skip
    run(CMAKE, "--build", folder, "--target", "npm")
    return folder / "npm"
