"""Text of C headers that ``labial bake`` writes."""

from __future__ import annotations

import textwrap
from typing import Iterable

from labial import __version__


def comment(text: str) -> str:
    """A header's first comment."""
    whole = f"{text} Written by labial bake {__version__}; do not edit.".replace("*/", "* /")
    return "/*\n" + textwrap.fill(whole, width=118, initial_indent=" * ", subsequent_indent=" * ") + "\n */\n"


def rows(values: Iterable[object]) -> str:
    """Values of an array, comma-separated, in lines of at most 120 columns."""
    return textwrap.fill(", ".join(str(value).replace(" ", "\u00a0") for value in values), width=118,
                         initial_indent="    ", subsequent_indent="    ",
                         break_on_hyphens=False).replace("\u00a0", " ")
