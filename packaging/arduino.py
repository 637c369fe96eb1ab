"""The library in the layout of the Arduino IDE: src/, examples/, extras/, library.properties, keywords.txt.

A sketch includes <speech_en.h>, or <Labial.h> for all public headers. Private sources lie in src/lib, which is not on
the include path of sketches. The IDE offers examples for the architectures of the library, so that a sketch for others,
which does not use the library, is in extras/.
"""

from __future__ import annotations

import re
import shutil
import zipfile
from pathlib import Path
from typing import List

from source import ROOT, PackError, Source, write_text

#: Cores that keep constant tables in flash and have the RAM. Not avr, megaavr and esp8266: they copy them into RAM.
ARCHITECTURES = (
    "esp32", "mbed", "mbed_edge", "mbed_giga", "mbed_nano", "mbed_nicla", "mbed_opta", "mbed_portenta", "mbed_rp2040",
    "nrf52", "renesas_portenta", "renesas_uno", "rp2040", "sam", "samd", "stm32", "zephyr",
)
#: Sketches for an Uno: they play baked motion, without the library.
WITHOUT_LIBRARY = ("UnoJaw",)
#: Where the headers lie that sketches share with other examples. A sketch's folder holds copies of them.
SHARED = (ROOT / "examples" / "talk", ROOT / "examples" / "faces", ROOT / "export" / "labial" / "bake")


def _fits(header: Path) -> bool:
    """Whether a sketch can use a model: the IDE has no options of the compiler, by which a larger one fits."""
    return "#if LABIAL_HEAR_UNITS_MAX >=" not in header.read_text(encoding="utf-8")


def properties(source: Source) -> str:
    """library.properties."""
    values = {
        "name": "Labial",
        "version": source.version,
        "author": "Labial contributors",
        "maintainer": "Labial contributors",
        "sentence": "Moves lips: phonemes with their durations in, lip and jaw parameters per frame out.",
        "paragraph": "13 MPEG-4 facial animation parameters per frame for robots, dolls and avatars, for speech and "
        "for laughter, in integers and fixed memory.",
        "category": "Device Control",
        "url": source.url,
        "architectures": ",".join(ARCHITECTURES),
        "includes": ",".join(["Labial.h", *(path.name for path in source.headers() if _fits(path))]),
        "license": "MIT AND CC-BY-4.0 AND BSD-2-Clause",
    }
    return "".join(f"{key}={value}\n" for key, value in values.items())


def keywords(source: Source) -> str:
    """keywords.txt: what the editor colours. The IDE wants tabs between the columns."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in source.public)
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)
    types = re.findall(r"^\} (labial_\w+);|^typedef .*\(\*(labial_\w+)\)", text, re.MULTILINE)
    functions = re.findall(r"^(?!typedef)\w[\w \t*]*?[ *](labial_\w+)\(", text, re.MULTILINE)
    literals = re.findall(r"\b(LABIAL_[A-Z0-9_]+)\b(?!_H\b)", text)
    rows = [*((name, "KEYWORD1") for pair in types for name in pair if name),
            *((name, "KEYWORD2") for name in functions),
            *((name, "LITERAL1") for name in literals if not name.endswith("_H")),
            *((model.name, "KEYWORD1") for model in source.models)]
    return "".join(f"{name}\t{kind}\n" for name, kind in sorted(set(rows), key=lambda row: (row[1], row[0])))


def umbrella(source: Source) -> str:
    """Labial.h, which the IDE's menu inserts."""
    includes = "".join(f'#include "labial/{path.name}"\n' for path in source.public)
    return (
        "/*\n * Labial.h - all public headers of the library. A sketch includes its models' headers as well.\n */\n"
        f"#ifndef LABIAL_ARDUINO_H\n#define LABIAL_ARDUINO_H\n\n{includes}\n#endif\n"
    )


def _included(file: Path) -> List[Path]:
    """What of the folders in SHARED a sketch or a header includes in quotes, and what that includes, with the sources
    of the same name."""
    found: List[Path] = []
    for name in re.findall(r'^#include "([^"/]+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
        for path in (folder / name for folder in SHARED if (folder / name).is_file()):
            table = path.with_suffix(".c")
            found += [path, *([table] if table.is_file() else []), *_included(path)]
    return list(dict.fromkeys(found))


def write(source: Source, folder: Path) -> None:
    """Lays the library out in `folder`."""
    src = folder / "src"
    for target, paths in ((src / "labial", source.public), (src / "lib", [*source.private, *source.sources]),
                          (src, source.tables)):
        target.mkdir(parents=True, exist_ok=True)
        for path in paths:
            shutil.copyfile(path, target / path.name)
    for name, text in (("LICENSE", source.licence()),
                       ("src/Labial.h", umbrella(source)),
                       ("library.properties", properties(source)),
                       ("keywords.txt", keywords(source))):
        write_text(folder / name, text)
    for sketch in sorted((ROOT / "examples" / "arduino").glob("*/*.ino")):
        name = sketch.parent.name
        target = folder / ("extras" if name in WITHOUT_LIBRARY else "examples") / name
        target.mkdir(parents=True)
        for path in [sketch, *_included(sketch)]:
            shutil.copyfile(path, target / path.name)


def archive(source: Source, folder: Path) -> Path:
    """Writes FOLDER.zip beside `folder`, with one folder "Labial" in it; the same files give the same bytes."""
    path = folder.with_name(folder.name + ".zip")
    if path.exists():
        raise PackError(f"{path}: exists already")
    files: List[Path] = sorted(file for file in folder.rglob("*") if file.is_file())
    with zipfile.ZipFile(path, "w") as out:
        for file in files:
            name = zipfile.ZipInfo(f"Labial/{file.relative_to(folder).as_posix()}")
            name.compress_type = zipfile.ZIP_DEFLATED
            name.external_attr = 0o644 << 16
            out.writestr(name, file.read_bytes())
    return path
