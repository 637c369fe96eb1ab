"""Writes a model of hearing as C, and the tables of the front end, which are the same for all models."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import List, Tuple

import numpy as np

from labial import __version__
from labial.errors import PathLike, expect
from labial.files.c import array, block_comment, check_name, constants_of, exported_header, rows
from labial.files.outputs import write_files
from labial.hearing import integer
from labial.hearing.convert import RATES
from labial.hearing.network import SMOOTHING
from labial.hearing.quantise import FORMAT, Dense, HearingTables

#: Bytes that the descriptors take on a 32-bit target: of the model, and of a block.
_MODEL, _BLOCK = 60, 24
#: LABIAL_HEAR_UNITS_MAX by default.
_UNITS_MAX = 128


# ---- The tables of the front end -------------------------------------------------------------------------------------


def _table_header(name: str, what: str, body: str) -> str:
    guard = f"LABIAL_{name.upper()}_H"
    comment = block_comment(f"{name}.h - {what} Written by export/labial/hearing/emit.py; do not edit.")
    return f"{comment}#ifndef {guard}\n#define {guard}\n\n#include <stdint.h>\n\n{body}\n#endif\n"


def features_table() -> str:
    """lib/hear_features_table.h."""
    bins = slice(integer.FIRST_BIN, integer.LAST_BIN + 1)
    return _table_header("hear_features_table", "what turns samples into energies of bands.", "\n".join([
        "/* A turn in 256 steps, Q15. */\n" + array("int16_t", "sine", integer.sine_table()),
        f"/* Where bins {integer.FIRST_BIN} to {integer.LAST_BIN} lie between the bands' edges, in 1/256. */\n"
        + array("uint16_t", "bin_places", integer.place_table()[bins]),
        "/* log2 of 1 to 2, Q8. */\n" + array("int16_t", "logarithms", integer.log_table()),
    ]))


def convert_table() -> str:
    """lib/hear_convert_table.h."""
    ways = ",\n".join(f"    {{ {rate}u, {0 if way.stride == way.step else way.reach}, {way.stride // 10}, {way.step} }}"
                      for rate, way in RATES.items())
    return _table_header("hear_convert_table", "the rates of sound, and the filter that converts them.", "\n".join([
        "/* Samples on each side that the filter takes; grid points between them; tenths between converted ones. */\n"
        "static const struct {\n    uint32_t samples_per_second;\n    uint8_t reach, spacing;\n    uint16_t step;\n"
        f"}} conversions[{len(RATES)}] = {{\n{ways}\n}};\n",
        "/* The filter from its middle on, Q15, and zeros after it. */\n"
        + array("int16_t", "filter", integer.tap_table()),
    ]))


def write_tables(directory: PathLike) -> None:
    """Writes both headers into `directory`, which is lib."""
    write_files(directory, {"hear_features_table.h": features_table(), "hear_convert_table.h": convert_table()})


# ---- A model ---------------------------------------------------------------------------------------------------------


def check_limits(tables: HearingTables) -> None:
    """Raises ModelError for a model whose memory is longer than the library's."""
    for block in tables.blocks:
        expect(2 <= block.memory.taps <= 16, f"a memory has {block.memory.taps} taps, not 2 to 16")
    expect(tables.rows <= 255, f"the memories have {tables.rows} rows together, not up to 255")


def grouped(dense: Dense) -> Dense:
    """The layer with its rows filled up to fours, and its weights as a row for each group, in the order that
    ``hear_model.h`` states: for each pair of columns those of the first two rows, then those of the other two."""
    count, columns = dense.weight.shape
    extra = -count % 4
    padded = np.pad(dense.weight, ((0, extra), (0, 0)))
    parts = padded.reshape(-1, 2, 2, columns // 2, 2)  # groups, halves of them, their rows, pairs, their columns
    weight = parts.transpose(0, 3, 1, 4, 2).reshape(-1, 4 * columns)
    return Dense(weight, np.pad(dense.bias, (0, extra)), np.pad(dense.shift, (0, extra)))


def _layer(name: str, dense: Dense) -> List[str]:
    table = grouped(dense)
    return [array("int8_t", f"{name}_weights", table.weight.ravel()),
            array("int16_t", f"{name}_biases", table.bias), array("uint8_t", f"{name}_shifts", table.shift)]


def _layer_member(name: str) -> str:
    return f"{{ {name}_weights, {name}_biases, {name}_shifts }}"


def flash_bytes(tables: HearingTables) -> int:
    """Bytes of the model on a 32-bit target, without the names of its classes."""
    total = _MODEL + _BLOCK * len(tables.blocks) + 4 * 2 * len(tables.mean)
    for dense in (*(block.dense for block in tables.blocks), tables.last, tables.heads):
        table = grouped(dense)
        total += table.weight.size + 3 * table.bias.size
    return total + sum(block.taps.size + block.shift.size for block in tables.blocks)


def workspace_bytes(tables: HearingTables) -> int:
    """LABIAL_HEAR_WORKSPACE_SIZE of the model."""
    return 2 * tables.units * tables.rows


def _comment(tables: HearingTables, what: str) -> str:
    text = (f"{what} model of hearing, {tables.units} units in {len(tables.blocks)} blocks, "
            f"{20 * (tables.ahead + SMOOTHING + 1)} ms from a frame's begin until it is known. "
            f"Written by labial export {__version__}; do not edit.")
    return block_comment(f"{text} {tables.attribution}" if tables.attribution else text)


def _limit(tables: HearingTables) -> Tuple[str, str, str]:
    """What goes around the tables of a model that is larger than LABIAL_HEAR_UNITS_MAX is by default, so that a project
    which compiles every model leaves it out; and what its header has instead. All builds compile its source, so it is
    no error before a program uses the model: then the compiler's message has the name that tells what is missing."""
    if tables.units <= _UNITS_MAX:
        return "", "", ""
    return ("/* For builds that have room for it (labial/config.h). */\n"
            f"#if LABIAL_HEAR_UNITS_MAX >= {tables.units}\n\n", "\n#endif\n",
            "\n#else\n\n/* Any use is an error that says what the model needs. */\n" + "".join(
                f"#define {name} {tables.name}_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_{tables.units}\n"
                for name in (tables.name, f"{tables.name}_classes")))


def header(tables: HearingTables) -> str:
    """NAME.h: the model's symbol, its workspace and its classes."""
    upper = tables.name.upper()
    constants = ",\n".join(f"    {name} = {number}"
                           for number, name in enumerate(constants_of(tables.name, tables.classes)))
    opens, closes, instead = _limit(tables)
    body = f"""#define {upper}_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE({tables.units}, {tables.rows})
#define {upper}_CLASSES {len(tables.classes)}

/* Lip classes, each named by a phoneme that stands for it. */
enum {{
{constants}
}};

{opens}/* The model, {flash_bytes(tables)} bytes on a 32-bit target. */
extern const labial_hear_model_t {tables.name};

/* The names of the classes; linked only when used. */
extern const char *const {tables.name}_classes[{upper}_CLASSES];
{instead}{closes}"""
    return exported_header(_comment(tables, f"{tables.name}.h - the"), tables.name, "LABIAL_MODEL", "labial/hear.h",
                           ("LABIAL_HEAR_MODEL_FORMAT", FORMAT), body)


def source(tables: HearingTables) -> str:
    """NAME.c: the tables. Raises ModelError where the name of a class cannot be a C string as it is."""
    for name in tables.classes:
        expect(name.isascii() and name.replace("_", "").isalnum(),
               f"the class {name!r:.40} has other characters than letters, digits and underscores")
    opens, closes, _ = _limit(tables)
    parts = [_comment(tables, f"{tables.name}.c - the"), f'#include "{tables.name}.h"\n']
    parts += [f"\n{opens}"[:-1]] if opens else []
    blocks = []
    for k, block in enumerate(tables.blocks):
        name = f"block_{k}"
        arrays = [*_layer(name, block.dense), array("int8_t", f"{name}_taps", block.taps.ravel()),
                  array("uint8_t", f"{name}_tap_shifts", block.shift)]
        parts.append(f"\n/* Block {k}. */\n" + "".join(arrays))
        blocks.append(f"    {{ {_layer_member(name)}, {name}_taps, {name}_tap_shifts, "
                      f"{', '.join(map(str, block.memory))} }}")
    parts.append("\nstatic const labial_hear_block_t blocks[] = {\n" + ",\n".join(blocks) + "\n};\n")
    parts.append("\n/* The last layer, and the heads. */\n" + "".join(_layer("last", tables.last)))
    parts.append("".join(_layer("heads", tables.heads)))
    parts.append("\n/* Frames: mean, scale and closed lips, Q4, and how far each channel follows those, Q8. */\n")
    parts += [array("int16_t", name, value) for name, value in (
        ("mean", tables.mean), ("scale", tables.scale), ("closed", tables.closed), ("closing", tables.closing))]
    numbers = (("LABIAL_HEAR_MODEL_FORMAT", "format"), (tables.units, "units"), (len(tables.blocks), "blocks"),
               (len(tables.classes), "classes"), (tables.ahead, "ahead"), (tables.rows, "rows"),
               (tables.close_from, "close_from"), (tables.close_width, "close_width"))
    members = [f"    {value}, /* {name} */" for value, name in numbers]
    members += [f"    {member}," for member in ("mean", "scale", "closed", "closing", "blocks", _layer_member("last"))]
    members += [f"    {_layer_member('heads')}"]
    parts.append(f"\nconst labial_hear_model_t {tables.name} = {{\n" + "\n".join(members) + "\n};\n")
    names = [f'"{name}"' for name in tables.classes]
    parts.append(f"\nconst char *const {tables.name}_classes[] = {{\n{rows(names)}\n}};\n")
    return "".join([*parts, closes])


def write(tables: HearingTables, directory: PathLike) -> List[Path]:
    """Writes NAME.h and NAME.c into `directory`; returns their paths."""
    check_name(tables.name)
    check_limits(tables)
    return write_files(directory, {f"{tables.name}.h": header(tables), f"{tables.name}.c": source(tables)})


if __name__ == "__main__":
    write_tables(sys.argv[1])
