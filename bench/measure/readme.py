"""Updates README.md's figures from the baseline."""

from __future__ import annotations

import re
from typing import Dict, Sequence, Tuple

from measure.boards import BOARDS
from measure.core import Figure

#: Columns of README.md's table of instructions.
TARGETS = (*(board.preset for board in BOARDS), "host")


def updated(text: str, figures: Sequence[Figure]) -> str:
    """README.md's `text` with these figures. A ValueError names a missing line."""
    value: Dict[Tuple[str, str], float] = {(one.target, one.figure): one.value for one in figures}

    def number(figure: str, target: str = "m0") -> str:
        return f"{value[target, figure]:,.0f}"

    def cells(figure: str) -> str:
        return " | ".join(number(figure, target) for target in TARGETS) + " |"

    helpers = number("code -Os: compiler's helpers")
    worst = " | ".join(f"{value[target, 'speech: worst tick / mean']:.2f}" for target in TARGETS[:-1])
    shares = " | ".join(f"{value[target, 'speech: share of the core']:.1f} %" if (target, "speech: share of the core")
                        in value else "" for target in TARGETS[:-1])
    taken = f"{round(value['m0', 'speech: cycles'], -2):,.0f} cycles for the {number('speech: mean')}"
    stream = f"stream {number('labial_t')}, workspace {number('speech: workspace')};"
    binary = value["m0", "code -Os: blob.c"] + value["m0", "code -Os: model.c"]
    words = sum(value["m0", f"code -Os: {name}.c"] for name in ("words", "words_text", "words_time"))
    used = (f"rig {number('code -Os: rig.c')}; laughs {number('code -Os: laugh.c')}; speaking while laughing "
            f"{number('code -Os: blend.c')}; names {number('code -Os: names.c')} and speech's "
            f"{number('speech: names')}; binary models {binary:,.0f}; words {words:,.0f} and "
            f"their tables {number('words: tables')} |")
    for pattern, replacement in (
        (r"(\| code \| )[\d,]+( \|.*the compiler adds )[\d,]+",
         rf"\g<1>{number('code -Os: total')}\g<2>{helpers}"),
        (r"(\| speech model \| )[\d,]+", rf"\g<1>{number('speech: model')}"),
        (r"(\| laughter model \| )[\d,]+", rf"\g<1>{number('laughter: model')}"),
        (r"(\| RAM \| )[\d,]+( \| )stream [\d,]+, workspace [\d,]+;",
         rf"\g<1>{number('speech: workspace and labial_t')}\g<2>{stream}"),
        (r"(\| stack \| )[\d,]+( \| at most; )[\d,]+",
         rf"\g<1>{number('stack -Os: all of lib')}\g<2>{number('stack -O2: all of lib')}"),
        (r"(\| only if used \| \| ).*", rf"\g<1>{used}"),
        (r"(\| npm package \| )[\d,]+( \| compressed, fetched by a page that speaks; )[\d,]+( more when it laughs; )"
         r"[\d,]+",
         rf"\g<1>{number('a page that speaks, each script compressed', 'wasm')}"
         rf"\g<2>{number('laughter, compressed', 'wasm')}\g<3>{number('words, each script compressed', 'wasm')}"),
        (r"(\| speech, mean \| ).*", rf"\g<1>{cells('speech: mean')}"),
        (r"(\| laughter, mean \| ).*", rf"\g<1>{cells('laughter: mean')}"),
        (r"(\| worst tick, times the mean \| ).*", rf"\g<1>{worst} | |"),
        (r"(\| share of the core at 50 frames/s, speech \| )([^|]*\|){5}", rf"\g<1>{shares} |"),
        (r"(The Cortex-M0 takes )[\d,]+ cycles for the [\d,]+", rf"\g<1>{taken}"),
    ):
        text, count = re.subn("^" + pattern, replacement, text, flags=re.MULTILINE)
        if count != 1:
            raise ValueError(f"README.md has {count} lines of the form {pattern}")
    return text
