"""Writes an exported model as C: NAME.c and NAME.h with the tables, NAME_names.c with the phonemes' names."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import List, Sequence

import numpy as np

from labial import __version__
from labial.corpus.labels import LABEL_SETS
from labial.errors import ModelError, PathLike
from labial.files.c import block_comment, check_name, constants_of, rows
from labial.files.faps import FAP_NAMES
from labial.files.outputs import folder
from labial.tables import layout
from labial.tables.fixed import CONTACT_FRAMES
from labial.tables.followers import solved
from labial.tables.quantise import FORMAT, ExportedModel


def phoneme_constants(model: ExportedModel) -> List[str]:
    """The C constant of each phoneme of a model."""
    return constants_of(model.name, model.phonemes)


def _table(table: layout.Table) -> str:
    values = np.asarray(table.rows)
    if values.ndim == 1:
        body = rows(map(int, values))
    else:
        body = rows(table.pattern % tuple(row) for row in values.tolist())
    return f"static const {table.kind} {table.name}[{len(values)}] = {{\n{body}\n}};\n"


def _comment(model: ExportedModel, what: str) -> str:
    text = (f"{what} {model.kind} model, method {model.method}, {model.fps} frames per second. "
            f"Written by labial export {__version__}; do not edit.")
    if model.attribution:
        text += f" {model.attribution}"
    return block_comment(text)


def _reach_check(model: ExportedModel) -> str:
    """An ``#error`` for builds whose LABIAL_REACH is too short for the model's kernels."""
    reach = model.kernel_stride * max(model.kernel_behind, model.kernels.shape[1] - 1 - model.kernel_behind)
    reach = max(reach, CONTACT_FRAMES if len(model.floors) > 1 else 0)
    if reach <= 0:
        return ""
    return f"""
#if LABIAL_REACH < {reach}
#error "{model.name} needs LABIAL_REACH of {reach} at least: its targets depend on what is so far away."
#endif
"""


def header(model: ExportedModel) -> str:
    """NAME.h: the model's symbol, sizes and phoneme numbers."""
    upper = model.name.upper()
    constants = ",\n".join(f"    {name} = {number}" for number, name in enumerate(phoneme_constants(model)))
    return f"""{_comment(model, f"{model.name}.h - the")}#ifndef LABIAL_MODEL_{upper}_H
#define LABIAL_MODEL_{upper}_H

#include "labial/labial.h"
#include "labial/names.h"

#if LABIAL_MODEL_FORMAT != {FORMAT}
#error "{model.name} was exported for another version of Labial: run labial export again."
#endif
{_reach_check(model)}
#ifdef __cplusplus
extern "C" {{
#endif

#define {upper}_FPS {model.fps}
#define {upper}_PHONEMES {len(model.phonemes)}
#define {upper}_STATES {model.transitions.shape[1]}
#define {upper}_WORKSPACE_SIZE LABIAL_WORKSPACE_SIZE({model.search_stride}, {len(model.centre)})

/* Phoneme numbers. */
enum {{
{constants}
}};

/* The model, {sum(layout.table_bytes(model).values())} bytes on a 32-bit target. */
extern const labial_model_t {model.name};

/* Its labels and aliases; linked only when used. */
extern const labial_names_t {model.name}_names;

#ifdef __cplusplus
}}
#endif

#endif
"""


def source(model: ExportedModel) -> str:
    """NAME.c: the tables."""
    parts = [_comment(model, f"{model.name}.c - the"), f'#include "{model.name}.h"\n\n#include <stddef.h>\n\n']
    tables = layout.shared_tables(model)
    parts.append("\n".join(_table(table) for table in tables if len(table.rows)))
    channels = []
    for k, channel in enumerate(solved(model.source)):
        own = layout.channel_tables(model, k)
        parts.append(f"\n/* {FAP_NAMES[channel]} */\n" + "".join(_table(table) for table in own))
        *scales, motion, motion2, firm = map(str, layout.channel_scalars(model, k))
        members = [*scales, f"{{ {motion}, {motion2} }}", firm, *(table.name for table in own)]
        channels.append(f"    {{ {', '.join(members)} }}")
    parts.append(f"\nstatic const labial_channel_t channels[{len(channels)}] = {{\n" + ",\n".join(channels) + "\n};\n")
    counts = [*layout.scalars(model), ("floor_count", len(model.floors) - 1, ""),
              ("pair_knots", model.pairs.shape[1], ""), ("pair_count", len(model.pair_keys), ""),
              ("channel_count", len(channels), "")]
    members = [f"    {value}, /* {name} */" for name, value, _ in counts]
    members.append(f"    {{ {', '.join(map(str, layout.sources(model)))} }}, /* sources */")
    members += [f"    {table.name}," if len(table.rows) else f"    NULL, /* {table.name} */" for table in tables]
    parts.append(f"\nconst labial_model_t {model.name} = {{\n" + "\n".join(members) + "\n    channels\n};\n")
    return "".join(parts)


def _string(text: str) -> str:
    """A C string literal of UTF-8; bytes beyond ASCII are octal, which no following character can lengthen."""
    return '"' + "".join(
        chr(b) if 32 <= b < 127 and b not in (34, 92, 63) else f"\\{b:03o}" for b in text.encode()) + '"'


#: Format of the names in these files: LABIAL_NAMES_FORMAT of include/labial/names.h.
NAMES_FORMAT = 2
#: A name's length and its sets of labels share a byte.
_LENGTH_MAX = 31


def _packed(name: str, phoneme: int, sets: Sequence[str]) -> str:
    """An entry of the names: the phoneme, the name's length and sets of labels, and its bytes."""
    data = name.encode()
    spelled = [f"'{chr(b)}'" if 32 < b < 127 and b not in (39, 92) else str(b) for b in data]
    return ", ".join([str(phoneme), f"0x{len(data) + sum(LABEL_SETS[item] for item in sets):02x}", *spelled])


def names_bytes(model: ExportedModel) -> int:
    """Flash bytes of the names on a 32-bit target."""
    return _entries_bytes(model) + sum(4 + len(label.encode()) + 1 for label in model.phonemes) + 12


def _entries_bytes(model: ExportedModel) -> int:
    return sum(2 + len(name.encode()) for name, *_ in model.names)


def names_source(model: ExportedModel) -> str:
    """NAME_names.c: labels and aliases in the order of their bytes. Raises ModelError for an entry without 1 to 31
    bytes and at least one set of labels, which lib/names.c assumes, and for too many entries."""
    size = _entries_bytes(model)
    if size > 65535 or not all(0 < len(name.encode()) <= _LENGTH_MAX and sets for name, _, sets in model.names):
        raise ModelError(f"names must have 1 to {_LENGTH_MAX} bytes, and 65,535 together with 2 more for each")
    entries = "\n".join(f"    {_packed(*entry)}," for entry in model.names).rstrip(",")
    labels = textwrap.fill(", ".join(_string(label) for label in model.phonemes), width=118, initial_indent="    ",
                           subsequent_indent="    ")
    return f"""{_comment(model, f"{model.name}_names.c - names of the phonemes of the")}#include "{model.name}.h"

#if LABIAL_NAMES_FORMAT != {NAMES_FORMAT}
#error "{model.name} was exported for another version of Labial: run labial export again."
#endif

/* Phoneme, bytes of the name and its sets of labels, name. */
static const uint8_t entries[{size}] = {{
{entries}
}};

static const char *const labels[{len(model.phonemes)}] = {{
{labels}
}};

const labial_names_t {model.name}_names = {{ {size}, {len(model.phonemes)}, entries, labels }};
"""


def write(model: ExportedModel, directory: PathLike, *, binary: bool = False) -> List[Path]:
    """Writes the C files, and with `binary` NAME.lbm, into `directory`; returns their paths."""
    check_name(model.name)
    files = {f"{model.name}.h": header(model).encode(), f"{model.name}.c": source(model).encode(),
             f"{model.name}_names.c": names_source(model).encode()}
    if binary:
        files[f"{model.name}.lbm"] = layout.blob(model)
    with folder(directory) as made:
        for file, data in files.items():
            (made / file).write_bytes(data)
    return [Path(directory) / file for file in files]
