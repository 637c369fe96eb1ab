"""Writes packed tables of words as C: NAME.c and NAME.h."""

from __future__ import annotations

from pathlib import Path
from typing import Iterable, List

from labial.files.c import check_name, rows, written_by
from labial.files.outputs import PathLike, folder
from labial.words.dictionary import NOTICE, PHONEMES
from labial.words.packing import PackedWords
from labial.words.times import CLASSES, MILLISECONDS

#: What alternates in words that cannot be read: it moves the lips and closes nothing.
FILLER = ("AH", "L")
#: LABIAL_WORDS_FORMAT of include/labial/words.h.
FORMAT = 2


def _table(kind: str, name: str, values: Iterable[object]) -> str:
    items = list(values)
    return f"static const {kind} {name}[{len(items)}] = {{\n{rows(items)}\n}};\n"


def _head(name: str, what: str) -> str:
    notice = "".join(f" * {line}".rstrip() + "\n" for line in NOTICE.splitlines())
    return written_by("export", what).replace(" */\n", f" *\n{notice} */\n")


def header(packed: PackedWords, name: str) -> str:
    """NAME.h: the tables' symbol."""
    guard = f"LABIAL_WORDS_{name.upper()}_H"
    return f"""{_head(name, f"{name}.h - how words sound, for labial/words.h.")}#ifndef {guard}
#define {guard}

#include "labial/words.h"

#if LABIAL_WORDS_FORMAT != {FORMAT}
#error "{name} was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {{
#endif

/* The tables, {packed.size + len(MILLISECONDS) + len(CLASSES)} bytes and the structure that points to them. */
extern const labial_words_model_t {name};

#ifdef __cplusplus
}}
#endif

#endif
"""


def source(packed: PackedWords, name: str) -> str:
    """NAME.c: the tables."""
    labels = "".join(f'    "{label}\\0"\n' for label in PHONEMES)
    parts = [_head(name, f"{name}.c - how words sound, for labial/words.h."), f'#include "{name}.h"\n\n',
             "/* Phonemes: labels, milliseconds, and whether each is a vowel (1) or voiceless (2). */\n",
             f"static const char phonemes[] =\n{labels.rstrip()};\n", _table("uint8_t", "milliseconds", MILLISECONDS),
             _table("uint8_t", "classes", CLASSES), "\n", _table("uint16_t", "roots", packed.roots),
             _table("uint16_t", "bases", packed.bases), _table("uint8_t", "leaves", packed.leaves),
             _table("uint8_t", "labels", (part for label in packed.labels for part in label)),
             _table("uint8_t", "trees", packed.trees), "\n", _table("uint16_t", "buckets", packed.buckets),
             _table("uint8_t", "patches", packed.patches or b"\0")]
    members = ["LABIAL_WORDS_FORMAT", str(len(PHONEMES)), f"{packed.multiplier}u", "roots", "bases", "leaves", "labels",
               "trees", "buckets", "patches", "phonemes", "milliseconds", "classes",
               f"{{ {', '.join(str(PHONEMES.index(label)) for label in FILLER)} }}"]
    listed = ",\n".join(f"    {member}" for member in members)
    parts.append(f"\nconst labial_words_model_t {name} = {{\n{listed}\n}};\n")
    return "".join(parts)


def write(packed: PackedWords, name: str, directory: PathLike) -> List[Path]:
    """Writes both files into `directory`; returns their paths."""
    check_name(name, "table of words")
    files = {f"{name}.c": source(packed, name), f"{name}.h": header(packed, name)}
    with folder(directory) as made:
        for file, text in files.items():
            (made / file).write_bytes(text.encode("ascii"))
    return [Path(directory) / file for file in files]
