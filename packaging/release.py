#!/usr/bin/env python3
"""Builds every package of a release from a tag.

    git tag v0.4.0
    packaging/release.py v0.4.0 -o DIR

DIR gets the sources, the two files, the folders for Arduino, PlatformIO, ESP-IDF and Zephyr as archives, the Python
package as source and as wheels for Linux, the npm packages, a bill of materials, and SHA256SUMS. Everything is built
from a fresh copy of the tag, so that the working folder has no effect. The tag's version must be that of the sources,
and CHANGELOG.md must have a section for it that no longer says "unreleased". ``--without python npm`` skips the
packages that need more than Python.

Needs git; the Python package cmake and what packaging/wheels.txt names, which is fetched; the npm packages clang, lld,
node and npm.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path
from typing import Callable, Dict, List, Optional

from bill import bill
from source import ROOT, PackError, exit_status, write_text

#: The kinds of ``pack.py`` that become archives.
FOLDERS = ("amalgamation", "arduino", "platformio", "esp-idf", "zephyr")


def run(command: List[object], folder: Path) -> str:
    """Standard output of a command. For a failing one, PackError has the last line of its output."""
    words = [str(part) for part in command]
    done = subprocess.run(words, cwd=folder, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines() or ["no reason given"]
        raise PackError(f"{' '.join(words)}: {said[-1]}")
    return done.stdout


def check(tree: Path, tag: str) -> str:
    """The version of the sources in `tree`. PackError where the tag or CHANGELOG.md names another."""
    version = run([sys.executable, tree / "packaging" / "pack.py", "version"], tree).strip()
    if tag != f"v{version}":
        raise PackError(f"{tag}: the sources are of version {version}, whose tag is v{version}")
    log = (tree / "CHANGELOG.md").read_text(encoding="utf-8")
    heading = re.search(rf"^## {re.escape(version)}\b(.*)$", log, re.MULTILINE)
    if heading is None or "unreleased" in heading[1]:
        raise PackError(f"CHANGELOG.md: no section for {version}, or one that says unreleased")
    return version


def folders(tree: Path, name: str, output: Path) -> None:
    """The packages that ``pack.py`` lays out, as archives."""
    with tempfile.TemporaryDirectory() as temporary:
        for kind in FOLDERS:
            folder = Path(temporary) / f"{name}-{kind}"
            run([sys.executable, tree / "packaging" / "pack.py", kind, "-o", folder], tree)
            shutil.make_archive(str(output / folder.name), "zip", temporary, folder.name)


def python(tree: Path, output: Path) -> None:
    """Source and wheels of the Python package; the files in them have the time of the release."""
    run([sys.executable, tree / "packaging" / "wheels.py", "-o", output], tree)
    sources = "from scikit_build_core.build import build_sdist; import sys; build_sdist(sys.argv[1])"
    with tempfile.TemporaryDirectory() as temporary:  # an environment with the build's own package
        run([sys.executable, "-m", "venv", temporary], tree)
        own = Path(temporary) / "bin" / "python"
        run([own, "-m", "pip", "install", "-q", "--require-hashes", "-r", tree / "packaging" / "wheels.txt"], tree)
        run([own, "-c", sources, output], tree)


def npm(tree: Path, output: Path) -> None:
    """The npm packages, whose tests run first."""
    run(["cmake", "--workflow", "--preset", "wasm"], tree)
    for path in (tree / "build" / "wasm").glob("labial-*.tgz"):
        shutil.copyfile(path, output / f"{path.stem}-npm.tgz")


def release(tag: str, output: Path, without: List[str]) -> List[Path]:
    """Builds the packages of `tag` into the new folder `output`; returns them."""
    output.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as temporary:
        archive = Path(temporary) / "sources.tar"
        run(["git", "archive", "--format=tar", f"--output={archive}", f"refs/tags/{tag}"], ROOT)
        tree = Path(temporary) / "tree"
        with tarfile.open(archive) as sources:
            sources.extractall(tree)
        name = f"labial-{check(tree, tag)}"
        archived = output / f"{name}-source.tar.gz"
        run(["git", "archive", f"--prefix={name}/", f"--output={archived}", f"refs/tags/{tag}"], ROOT)
        folders(tree, name, output)
        moment = run(["git", "log", "-1", "--format=%ct", f"refs/tags/{tag}"], ROOT).strip()
        os.environ["SOURCE_DATE_EPOCH"] = moment
        more: Dict[str, Callable[[Path, Path], None]] = {"python": python, "npm": npm}
        for kind in more:
            if kind not in without:
                more[kind](tree, output)
        document = bill(tree, sorted(output.iterdir()), int(moment))
        write_text(output / f"{name}.cdx.json", json.dumps(document, indent=1) + "\n")
    packages = sorted(output.iterdir())
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in packages]
    (output / "SHA256SUMS").write_text("".join(sums), encoding="ascii")
    return packages


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status: 0, or 1 when there is no release to be had."""
    parser = argparse.ArgumentParser(prog="release.py", description="Builds every package of a release from a tag.")
    parser.add_argument("tag", metavar="vX.Y.Z")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="new folder")
    parser.add_argument("--without", nargs="+", default=[], choices=("python", "npm"), help="packages to leave out")
    options = parser.parse_args(arguments)

    def work() -> None:
        for path in release(options.tag, Path(options.output).resolve(), options.without):
            print(path)

    return exit_status("release.py", work)


if __name__ == "__main__":
    sys.exit(main())
