"""Figures in pages: holds each against its source, or writes it.

A :class:`Sentence` is a piece of a page's text with `{}` in the place of each figure. White space in it matches line
breaks, so that pages may be wrapped anew.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from pathlib import Path
from typing import Iterable, List, Mapping, Tuple, Union

#: A figure in a page: a number, with commas between thousands or without a leading zero, or a word such as "fourteen".
_FIGURE = r"([-+]?\d[\d,]*(?:\.\d+)?|[-+]?\.\d+|\w+)"

#: Characters of a sentence that a complaint names.
_SHOWN = 70


@dataclass(frozen=True)
class Sentence:
    """Text of a page and its figures, formatted as the page shows them."""

    text: str
    figures: Tuple[str, ...]
    figure: str = _FIGURE

    def pattern(self) -> re.Pattern[str]:
        """What finds the text whatever its figures are."""
        parts = [re.sub(r"(\\?\s)+", r"\\s+", re.escape(part)) for part in self.text.split("{}")]
        if len(parts) != len(self.figures) + 1:
            raise ValueError(f"{len(self.figures)} figures for {self.text!r}")
        return re.compile(r"(?<![\w.])" * self.text.startswith("{}") + self.figure.join(parts))


def sentence(text: str, *figures: Union[str, float]) -> Sentence:
    """A sentence; `text` has a `{}` for each of the `figures`, of which numbers are shown whole."""
    return Sentence(text, tuple(one if isinstance(one, str) else count(one) for one in figures))


def row(head: str, *cells: Union[str, float]) -> Sentence:
    """A row of a table: its first cell, and the figures of all others."""
    return sentence(f"| {head} |" + " {} |" * len(cells), *cells)


def lines(before: str, found: Iterable[str]) -> Sentence:
    """Lines behind the line `before`, up to a blank one."""
    return Sentence(before + "{}\n", ("".join(f"\n{line}" for line in found),), r"((?:\n.+)*)")


def count(value: float) -> str:
    """A whole number with commas: 7,431."""
    return decimal(value, 0)


def decimal(value: float, digits: int) -> str:
    """With so many digits behind the point, halves rounded up, as a reader of the source would: 6.3."""
    return f"{Decimal(repr(value)).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_UP):,f}"


def share(value: float, digits: int = 2) -> str:
    """The same without a leading zero, as shares and correlations are written: .68."""
    return re.sub(r"^(-?)0\.", r"\1.", decimal(value, digits))


_WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
          "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty")


def word(value: int) -> str:
    """A small count in words: fourteen."""
    return _WORDS[value] if value < len(_WORDS) else count(value)


def updated(name: str, text: str, sentences: Iterable[Sentence]) -> Tuple[str, List[str]]:
    """A page's text with these figures, and a complaint with the line of each figure that was another. Raises
    ValueError if the page does not have one of the sentences exactly once."""
    complaints = []
    for one in sentences:
        matches = list(one.pattern().finditer(text))
        if len(matches) != 1:
            raise ValueError(f"{name}: found {len(matches)} times instead of once: {one.text}")
        (match,) = matches
        for group in range(len(one.figures), 0, -1):  # from the end, so that places stay where they are
            begin, end = match.span(group)
            found, wanted = match[group], one.figures[group - 1]
            if found != wanted:
                line = text.count("\n", 0, begin) + 1
                where = one.text if len(one.text) <= _SHOWN else one.text[:_SHOWN] + "..."
                complaints.append(f"{name}:{line}: {found} should be {wanted}, in: {where}")
                text = text[:begin] + wanted + text[end:]
    return text, complaints


def refresh(root: Path, figures: Mapping[str, Iterable[Sentence]], write: bool) -> List[str]:
    """Holds pages below `root` against their `figures`, and writes them if asked to; returns the complaints."""
    complaints: List[str] = []
    for name, sentences in figures.items():
        path = root / name
        before = path.read_text(encoding="utf-8")
        after, found = updated(name, before, sentences)
        complaints += found
        if write and after != before:
            path.write_text(after, encoding="utf-8")
    return complaints
