"""The attributions that the licences of training data require, from the headers of models and of tables of words."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path
from typing import Dict, List

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
