"""Text of C headers that ``labial bake`` writes."""

from __future__ import annotations

import textwrap
from typing import Iterable

from labial import __version__
from labial.emit import block_comment


def comment(text: str) -> str:
    """A header's first comment."""
    return block_comment(f"{text} Written by labial bake {__version__}; do not edit.", width=118)


def rows(values: Iterable[object]) -> str:
    """Values of an array, comma-separated, in lines of at most 120 columns."""
    return textwrap.fill(", ".join(str(value).replace(" ", "\u00a0") for value in values), width=118,
                         initial_indent="    ", subsequent_indent="    ",
                         break_on_hyphens=False).replace("\u00a0", " ")
