#!/usr/bin/env python3
"""Packs Labial for other build systems. Needs only Python 3.9 or newer.

    pack.py amalgamation -o DIR    labial.h, labial.c and the models, to drop into any project
    pack.py arduino -o DIR         a library for the Arduino IDE; --zip for "Add .ZIP Library"
    pack.py platformio -o DIR      what a PlatformIO project needs in its lib/ folder
    pack.py esp-idf -o DIR         what an ESP-IDF project needs in its components/ folder
    pack.py zephyr -o DIR          a Zephyr module
    pack.py notice                 writes NOTICE, the attributions of the bundled models, which every package carries
    pack.py version [X.Y.Z]        prints the version, or sets it in every file that holds it

PlatformIO, ESP-IDF and Zephyr can also use the source tree directly. ``--models FOLDER`` takes models that ``labial
export`` wrote instead of the bundled ones.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import arduino
from source import ROOT, URL, PackError, Source, exit_status, notices, set_version, version, write_text

#: The files that each needs besides include/ and lib/.
_MANIFESTS: Dict[str, Tuple[str, ...]] = {
    "platformio": ("library.json",),
    "esp-idf": ("CMakeLists.txt", "idf_component.yml"),
    "zephyr": ("zephyr/module.yml", "zephyr/CMakeLists.txt", "zephyr/Kconfig"),
}


def _empty_folder(path: Path) -> Path:
    """`path` as a folder to write to, which must be new or empty."""
    if path.exists() and (not path.is_dir() or any(path.iterdir())):
        raise PackError(f"{path}: exists and is not an empty folder")
    path.mkdir(parents=True, exist_ok=True)
    return path


def _write_tree(source: Source, folder: Path, kind: str) -> None:
    """Copies the library, the models and the manifests of `kind` into `folder`, each to its own place."""
    library = [*source.public, *source.private, *source.sources, *source.words, ROOT / "LICENSE"]
    targets = {path: path.relative_to(ROOT) for path in [*library, *(ROOT / name for name in _MANIFESTS[kind])]}
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


def _amalgamate(source: Source, folder: Path) -> None:
    """Writes labial.h, labial.c, the models and words, which include nothing else of Labial, and the licence into
    `folder`."""
    write_text(folder / "labial.h", _joined(source, source.public, "Labial's public headers", []))
    text = _joined(source, source.sources, "Labial's code", source.public)
    write_text(folder / "labial.c", '#include "labial.h"\n' + text)
    for path in source.tables:
        text = re.sub(r'^#include "labial/[^"]+"$', '#include "labial.h"', path.read_text("utf-8"), flags=re.MULTILINE)
        write_text(folder / path.name, text)
    write_text(folder / "LICENSE", source.licence())


# ---- Commands --------------------------------------------------------------------------------------------------------


def _pack(options: argparse.Namespace) -> None:
    source = Source(Path(options.models) if options.models else None, getattr(options, "url", URL))
    folder = _empty_folder(Path(options.output))
    if options.kind == "amalgamation":
        _amalgamate(source, folder)
    elif options.kind == "arduino":
        arduino.write(source, folder)
        if options.zip:
            print(arduino.archive(source, folder))
    else:
        _write_tree(source, folder, options.kind)
    print(folder)


def _version(options: argparse.Namespace) -> None:
    if options.number:
        for path in set_version(options.number):
            print(path)
    else:
        print(version())


def _notice(options: argparse.Namespace) -> None:
    write_text(ROOT / "NOTICE", notices(Source().headers()))
    print(ROOT / "NOTICE")


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status: 0, or 1 when something given cannot be used."""
    parser = argparse.ArgumentParser(prog="pack.py", description="Lays Labial out for other build systems.")
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="KIND")
    for kind, text in (("amalgamation", "two files and the models"),
                       ("arduino", "library for the Arduino IDE"),
                       ("platformio", "folder for lib/ of a PlatformIO project"),
                       ("esp-idf", "folder for components/ of an ESP-IDF project"),
                       ("zephyr", "Zephyr module")):
        command = kinds.add_parser(kind, help=text)
        command.add_argument("-o", "--output", required=True, metavar="DIR", help="new or empty folder")
        command.add_argument("--models", metavar="FOLDER", help="exported models instead of the bundled ones")
        if kind == "arduino":
            command.add_argument("--zip", action="store_true", help="also write DIR.zip")
            command.add_argument("--url", default=URL, help=f"where the project is to be found ({URL})")
    command = kinds.add_parser("version", help="print or set the version")
    command.add_argument("number", nargs="?", metavar="X.Y.Z")
    kinds.add_parser("notice", help="write NOTICE, the attributions of the bundled models")
    options = parser.parse_args(arguments)
    work = {"version": _version, "notice": _notice}.get(options.kind, _pack)
    return exit_status("pack.py", lambda: work(options))


if __name__ == "__main__":
    sys.exit(main())
