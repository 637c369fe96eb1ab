"""The npm package as the tests use it: LABIAL_NPM_PACKAGE names its folder, or it is built; scripts that node runs;
and the tools of npm that tests use."""

from __future__ import annotations

import atexit
import functools
import hashlib
import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any, Optional

import pytest

from packages import CMAKE, SOURCE, run

_BUILT = os.environ.get("LABIAL_NPM_PACKAGE", "")
#: What cannot be had, "" where all is there.
MISSING = "" if _BUILT or (CMAKE and shutil.which("clang") and shutil.which("wasm-ld")) else (
    "needs clang and wasm-ld: install the Debian packages clang and lld")
FOLDER = SOURCE / "tests" / "npm" / "bundlers"
NPM = shutil.which("npm") or ""
#: What the tools of npm lack: bundlers, two versions of node, a compiler of types, as FOLDER's package-lock.json names
#: them; "" where all is there.
TOOLS_MISSING = MISSING or ("" if NPM else "needs npm: install the Debian packages nodejs and npm")


def package(folder: Path) -> Path:
    """The folder of the package, built below `folder` unless it is there already."""
    if _BUILT:
        return Path(_BUILT)
    run(CMAKE, "-S", SOURCE, "-B", folder, f"-DCMAKE_TOOLCHAIN_FILE={SOURCE / 'boards' / 'toolchains' / 'wasm.cmake'}",
        "-DCMAKE_BUILD_TYPE=Release", "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF")
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


def tools() -> Path:
    """The folder whose node_modules has the tools; installed once, below LABIAL_BUNDLERS where that is set."""
    import fcntl  # which Windows lacks

    folder = Path(os.environ.get("LABIAL_BUNDLERS") or Path(tempfile.gettempdir()) / "labial-bundlers")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{folder}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        names = ("package.json", "package-lock.json", "build.mjs")
        stamp = folder / hashlib.sha256(b"".join((FOLDER / name).read_bytes() for name in names)).hexdigest()[:16]
        if not stamp.exists():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            for name in names:
                shutil.copyfile(FOLDER / name, folder / name)
            run(NPM, "ci", "--ignore-scripts", "--no-audit", "--no-fund", cwd=folder)  # which checks the hashes
            stamp.touch()
    return folder


def node(version: int) -> Path:
    """The program node of this major version."""
    return tools() / "node_modules" / f"node-{version}" / "bin" / "node"


def named(package: Path, name: str) -> Path:
    """The folder of the package of this name, beside that of labial."""
    return package.with_name(package.name + name[len("labial"):])


def lay(package: Path, folder: Path, *names: str) -> None:
    """Lays the packages of these names into `folder`/node_modules, without npm."""
    for name in names:
        shutil.copytree(named(package, name), folder / "node_modules" / name)


@functools.cache
def packed(package: Path) -> Path:
    """A folder with the packages as ``npm pack`` and ``npm install`` leave them."""
    folder = Path(tempfile.mkdtemp(prefix="labial-"))
    atexit.register(shutil.rmtree, folder)
    for name in ("labial", "labial-laughter", "labial-hearing", "labial-words"):
        archive = run(NPM, "pack", "--silent", "--pack-destination", folder, cwd=named(package, name))
        shutil.unpack_archive(folder / archive.strip().splitlines()[-1], folder)
        (folder / "package").rename(folder / name)
    return folder


def install(package: Path, folder: Path) -> None:
    """Lays the packages into `folder`/node_modules as ``npm install`` does."""
    shutil.copytree(packed(package), folder / "node_modules", ignore=shutil.ignore_patterns("*.tgz"))
