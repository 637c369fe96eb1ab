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
import sys
from pathlib import Path
from typing import List, Optional

import arduino
import trees
from source import ROOT, URL, PackError, Source, exit_status, notices, set_version, version, write_text


def _empty_folder(path: Path) -> Path:
    """`path` as a folder to write to, which must be new or empty."""
    if path.exists() and (not path.is_dir() or any(path.iterdir())):
        raise PackError(f"{path}: exists and is not an empty folder")
    path.mkdir(parents=True, exist_ok=True)
    return path


def _pack(options: argparse.Namespace) -> None:
    source = Source(Path(options.models) if options.models else None, getattr(options, "url", URL))
    folder = _empty_folder(Path(options.output))
    if options.kind == "amalgamation":
        trees.amalgamate(source, folder)
    elif options.kind == "arduino":
        arduino.write(source, folder)
        if options.zip:
            print(arduino.archive(source, folder))
    else:
        trees.write(source, folder, options.kind)
    print(folder)


def _version(options: argparse.Namespace) -> None:
    if options.number:
        for path in set_version(options.number):
            print(path)
    else:
        print(version())


def _notice(options: argparse.Namespace) -> None:
    source = Source()
    write_text(ROOT / "NOTICE", notices(source.headers()))
    print(ROOT / "NOTICE")


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status: 0, or 1 when something given cannot be used."""
    parser = argparse.ArgumentParser(prog="pack.py", description="Lays Labial out for other build systems.")
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="KIND")
    for kind, text in (
        ("amalgamation", "two files and the models"),
        ("arduino", "library for the Arduino IDE"),
        ("platformio", "folder for lib/ of a PlatformIO project"),
        ("esp-idf", "folder for components/ of an ESP-IDF project"),
        ("zephyr", "Zephyr module"),
    ):
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
