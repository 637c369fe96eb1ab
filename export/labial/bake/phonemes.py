"""``labial bake --as phonemes``: phoneme numbers and milliseconds for boards that run Labial itself."""

from __future__ import annotations

from typing import Sequence, Tuple

from labial.files.c import check_name, constants_of, rows, written_by

#: An entry is milliseconds times this, and the phoneme's number; no phoneme lasts longer than an hour, 2^22 ms.
_SHIFT = 8


def header(name: str, source: str, model: str, labels: Sequence[str], phonemes: Sequence[Tuple[int, int]]) -> str:
    """NAME.h: an array of phonemes of the model that ``MODEL.h`` declares, with `labels`, and the call that pushes
    them. Raises ModelError for a model whose file's name C cannot use."""
    check_name(model)
    upper, names = name.upper(), constants_of(model, labels)
    seconds = sum(milliseconds for _, milliseconds in phonemes) / 1000.0
    about = f"{name}.h - {len(phonemes)} phonemes, {seconds:.1f} s, of {source}, for the model {model}."
    entries = rows(f"{names[phoneme]} | {milliseconds}ul << {_SHIFT}" for phoneme, milliseconds in phonemes)
    return f"""{written_by("bake", about, 118)}#ifndef LABIAL_PHONEMES_{upper}_H
#define LABIAL_PHONEMES_{upper}_H

#include "{model}.h"

#if {model.upper()}_PHONEMES != {len(labels)}
#error "{name} was written for another {model}: run labial bake again."
#endif

#define {upper}_PHONEMES {len(phonemes)}u
#define {upper}_MILLISECONDS {sum(milliseconds for _, milliseconds in phonemes)}ul

/* A phoneme of {model} in the low byte, its milliseconds above it. */
static const uint32_t {name}[{len(phonemes)}] = {{
{entries}
}};

/*
 * Pushes as many phonemes as the stream has room for, from number *next on, which it moves on; 0 to begin with. Call it
 * before each labial_tick(). It ends the stream behind the last one. Returns LABIAL_OK, or what labial_push() and
 * labial_end() do not accept.
 */
static inline int {name}_feed(labial_t *stream, uint32_t *next)
{{
    while (*next < {upper}_PHONEMES && labial_room(stream) > 0) {{
        const int result = labial_push(stream, {name}[*next] & 255u, {name}[*next] >> {_SHIFT});
        if (result < 0)
            return result;
        if (++*next == {upper}_PHONEMES)
            return labial_end(stream);
    }}
    return LABIAL_OK;
}}

#endif
"""
