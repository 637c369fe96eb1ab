"""The tools of npm that tests use, as tests/npm/bundlers/package-lock.json names them: bundlers, two versions of node,
a compiler of types."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from pathlib import Path

from npm import MISSING as NO_PACKAGE
from packages import SOURCE, run

FOLDER = SOURCE / "tests" / "npm" / "bundlers"
NPM = shutil.which("npm") or ""
#: What cannot be had, "" where all is there.
MISSING = NO_PACKAGE or ("" if NPM else "needs npm: install the Debian packages nodejs and npm")


def tools() -> Path:
    """The folder whose node_modules has the tools; installed once, below LABIAL_BUNDLERS where that is set, whoever
    else asks for it meanwhile."""
    import fcntl  # which Windows lacks

    folder = Path(os.environ.get("LABIAL_BUNDLERS") or Path(tempfile.gettempdir()) / "labial-bundlers")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{folder}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        _install_tools(folder)
    return folder


def _install_tools(folder: Path) -> None:
    names = ("package.json", "package-lock.json", "build.mjs")
    stamp = folder / hashlib.sha256(b"".join((FOLDER / name).read_bytes() for name in names)).hexdigest()[:16]
    if not stamp.exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for name in names:
            shutil.copyfile(FOLDER / name, folder / name)
        run(NPM, "ci", "--ignore-scripts", "--no-audit", "--no-fund", cwd=folder)  # which checks the hashes
        stamp.touch()


def node(version: int) -> Path:
    """The program node of this major version."""
    return tools() / "node_modules" / f"node-{version}" / "bin" / "node"


def install(package: Path, folder: Path) -> None:
    """Packs the packages and lays them into `folder`/node_modules as ``npm install`` does."""
    own = folder / "node_modules"
    own.mkdir(parents=True)
    others = (package.with_name(f"{package.name}-{name}") for name in ("laughter", "hearing", "words"))
    for source in (package, *others):
        name = run(NPM, "pack", "--silent", "--pack-destination", folder, cwd=source).strip().splitlines()[-1]
        shutil.unpack_archive(folder / name, own)
        (own / "package").rename(own / name.rsplit("-", 1)[0])
