"""The npm package as the tests use it: LABIAL_NPM_PACKAGE names its folder, or it is built; scripts that node runs."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any, Optional

import pytest

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


NODE = shutil.which("node") or ""
#: What scripts begin with: the package, and what they are given.
_PROLOGUE = r"""
const url = process.argv[1];
const { Labial, timings } = await import(url);
const more = (name) => () => import(url.replace(/\/index\.js$/, `-${name}/index.js`));
const labial = await Labial.load({ laughter: more("laughter"), words: more("words") });
let input = "";
for await (const piece of process.stdin) input += piece;
const given = JSON.parse(input);
const answer = (value) => process.stdout.write(JSON.stringify(value));
"""


def answered(script: str, given: Any, folder: Optional[Path] = None) -> Any:
    """What a script answers to `given`; the package is built below `folder`, if there is one. Skips the test where
    anything is missing."""
    if not NODE:
        pytest.skip("needs node: install the Debian package nodejs")
    if MISSING or not (_BUILT or folder):
        pytest.skip(MISSING or "LABIAL_NPM_PACKAGE does not name the built package")
    url = (package(folder or Path()) / "index.js").as_uri()
    return json.loads(run(NODE, "--input-type=module", "-e", _PROLOGUE + script, url, text=json.dumps(given)))
