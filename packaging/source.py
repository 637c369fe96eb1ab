"""The source tree for packages: its version, its files and the models."""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path
from typing import Callable, Dict, List, Optional

#: The folder of the source tree.
ROOT = Path(__file__).resolve().parents[1]
#: Files with the version, each with a pattern whose group is the number; the public header has the parts.
VERSIONS: Dict[str, str] = {
    "export/labial/__init__.py": r'^__version__ = "([^"]*)"$',
    "idf_component.yml": r'^version: "([^"]*)"$',
    "library.json": r'^  "version": "([^"]*)",$',
}
#: The project's address, unless a release names another.
URL = "https://example.org/labial"
_HEADER = "include/labial/labial.h"
_PARTS = ("MAJOR", "MINOR", "PATCH")


class PackError(Exception):
    """An input cannot be packed; the message says what and where."""


def exit_status(program: str, work: Callable[[], None]) -> int:
    """Runs `work`; returns 0, or 1 after saying in one line, as `program`, what cannot be used."""
    try:
        work()
    except PackError as error:
        print(f"{program}: {error}", file=sys.stderr)
    except OSError as error:
        print(f"{program}: {error.filename or ''}: {error.strerror or error}", file=sys.stderr)
    else:
        return 0
    return 1


def write_text(path: Path, text: str) -> None:
    """Writes a file with line feeds on every system."""
    path.write_bytes(text.encode("utf-8"))


def _part(text: str, part: str) -> re.Match:
    found = re.search(rf"^#define LABIAL_VERSION_{part} (\d+)$", text, re.MULTILINE)
    if not found:
        raise PackError(f"{_HEADER}: does not define LABIAL_VERSION_{part}")
    return found


def version() -> str:
    """The version in the public header, ``X.Y.Z``; all other files follow it."""
    text = (ROOT / _HEADER).read_text(encoding="utf-8")
    return ".".join(_part(text, part)[1] for part in _PARTS)


def _set(path: Path, pattern: str, value: str) -> None:
    text = path.read_text(encoding="utf-8")
    found = re.search(pattern, text, re.MULTILINE)
    if not found:
        raise PackError(f"{path}: holds no version")
    write_text(path, text[: found.start(1)] + value + text[found.end(1) :])


def set_version(number: str) -> List[Path]:
    """Writes the version into every file that holds it and returns their paths."""
    if not re.fullmatch(r"(0|[1-9]\d*)(\.(0|[1-9]\d*)){2}", number):
        raise PackError(f"{number}: a version is three numbers, X.Y.Z")
    for part, value in zip(_PARTS, number.split(".")):
        _set(ROOT / _HEADER, rf"^#define LABIAL_VERSION_{part} (\d+)$", value)
    for name, pattern in VERSIONS.items():
        _set(ROOT / name, pattern, number)
    return [ROOT / name for name in (_HEADER, *VERSIONS)]


#: What the headers of models declare: those of phonemes, and those that hear.
_PHONEMES, _HEARING = "extern const labial_model_t", "extern const labial_hear_model_t"


class Model:
    """One model as ``labial export`` writes it: NAME.h and NAME.c, and NAME_names.c for one of phonemes."""

    def __init__(self, header: Path) -> None:
        self.name = header.stem
        self.files = [header, header.with_suffix(".c")]
        if _PHONEMES in header.read_text(encoding="utf-8"):
            self.files.append(header.with_name(f"{header.stem}_names.c"))
        for path in self.files:
            if not path.is_file():
                raise PackError(f"{path}: no such file, beside {header.name}; export the model again")


class Source:
    """The files of the library, in a fixed order, and the models to go with them.

    Args:
        models: folder of exported models; the bundled ones without it.
        url: where a person finds the project.
    """

    def __init__(self, models: Optional[Path] = None, url: str = URL) -> None:
        folder = models if models else ROOT / "lib" / "models"
        self.version = version()
        self.url = url
        self.public = sorted((ROOT / "include" / "labial").glob("*.h"))
        self.private = sorted((ROOT / "lib").glob("*.h"))
        self.sources = sorted((ROOT / "lib").glob("*.c"))
        headers = [path for path in sorted(folder.glob("*.h"))
                   if any(mark in path.read_text(encoding="utf-8") for mark in (_PHONEMES, _HEARING))]
        if not headers:
            raise PackError(f"{folder}: holds no exported model")
        self.models = [Model(path) for path in headers]
        self.words = sorted((ROOT / "lib" / "words").glob("*.[ch]"))
        self.tables = [path for model in self.models for path in model.files] + self.words

    def headers(self) -> List[Path]:
        """The headers of the models and of the tables of words, which name the data that these were made from."""
        return [path for path in self.tables if path.suffix == ".h"]

    def licence(self) -> str:
        """The text of a package's LICENSE: that of the code, then the attributions of the models and words."""
        return (ROOT / "LICENSE").read_text(encoding="utf-8") + "\n" + notices(self.headers())


# ---- Attributions that the licences of training data require, from the headers of models and words -------------------

#: The end of the sentence that a written header begins with; the attribution follows in the same comment.
_WRITTEN = re.compile(r"do not\s+\*?\s*edit\.(.*?)\*/", re.DOTALL)
_INTRODUCTION = """\
Labial's code is under the MIT License. Its models and tables were made from the data of others, whose licences ask for
these notices."""


def notice(header: Path) -> str:
    """The attribution in a header of lib/models or lib/words: paragraphs, each one line, with a blank line between."""
    (comment,) = _WRITTEN.findall(header.read_text(encoding="utf-8"))
    lines = [re.sub(r"^ ?\* ?", "", line).rstrip() for line in comment.strip().splitlines()]
    paragraphs = re.split(r"\n{2,}", "\n".join(lines))
    # A word that ends in a hyphen was broken there.
    return "\n\n".join(re.sub(r"(?<!-) ?\n\s*", " ", part.replace("-\n", "-")).strip() for part in paragraphs).strip()


def notices(headers: List[Path]) -> str:
    """The attributions of models and tables with these headers; those of several that share one stand once."""
    shared: Dict[str, List[str]] = {}
    for header in headers:
        shared.setdefault(notice(header), []).append(header.stem)
    parts = [textwrap.fill(_INTRODUCTION, 78)]
    for attribution, names in shared.items():
        body = "\n\n".join(textwrap.fill(part, 78, break_long_words=False, break_on_hyphens=False)
                           for part in attribution.split("\n\n"))
        parts.append(f"{', '.join(names)}:\n\n{textwrap.indent(body, '    ')}")
    return "\n\n".join(parts) + "\n"
