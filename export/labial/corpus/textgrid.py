"""Praat's TextGrid, long or short: numbers that stand alone, texts in quotes and flags in angle brackets count, in
their order; whatever else stands between them does not."""

from __future__ import annotations

import re
from typing import Dict, Iterator, List, NamedTuple, Optional

from labial.corpus.timings import PathLike, SourceSegment, checked
from labial.errors import DataError
from labial.grammar import is_whole, number, read_text, shown

_TOKEN = re.compile(r'"(?:[^"]|"")*"|<[^>]*>|![^\n]*|[^ \t\r\n]+')


class _Token(NamedTuple):
    line: int
    kind: str  #: "number", "text" or "flag"
    value: str


def read_textgrid(path: PathLike, tier: Optional[str] = None) -> List[SourceSegment]:
    """Reads an interval tier of a TextGrid, UTF-8 or UTF-16.

    The tier is the one named `tier`; else "phones", "phonemes", "phone" or "phoneme" in any case (also after
    "speaker - "); else the only or the first interval tier. Unlabelled intervals are kept with the label "".
    """
    tiers = read_textgrid_tiers(path)
    if tier is not None:
        if tier not in tiers:
            raise DataError(path, None, f"no interval tier {tier!r}; there are {', '.join(map(repr, tiers)) or 'none'}")
        return tiers[tier]
    if not tiers:
        raise DataError(path, None, "no interval tier")
    plain = {name.lower().split(" - ")[-1].strip(): name for name in reversed(list(tiers))}
    for name in ("phones", "phonemes", "phone", "phoneme"):
        if name in plain:
            return tiers[plain[name]]
    return next(iter(tiers.values()))


def read_textgrid_tiers(path: PathLike) -> Dict[str, List[SourceSegment]]:
    """Reads all interval tiers of a TextGrid, in order. A second tier of the same name is called "name_2"."""
    reader = _Reader(path)
    tiers: Dict[str, List[SourceSegment]] = {}
    names: List[str] = []
    for _ in range(reader.tiers()):
        intervals = reader.text("a tier's class", ("IntervalTier", "TextTier")).value == "IntervalTier"
        name = reader.text("a tier's name").value
        reader.time("a tier's start")
        reader.time("a tier's end")
        found = [reader.interval() if intervals else reader.point() for _ in range(reader.count())]
        if intervals:
            names.append(name)
            alone = names.count(name) == 1
            tiers[name if alone else f"{name}_{names.count(name)}"] = checked(path, [item for item in found if item])
    reader.end()
    return tiers


class _Reader:
    """The tokens of a file, one after the other. Each call raises DataError where something else stands there."""

    def __init__(self, path: PathLike) -> None:
        self._path = path
        text = read_text(path)
        if "ooTextFile" not in text[:200] or "TextGrid" not in text[:200]:
            raise DataError(path, 1, "not a TextGrid in text form")
        self._tokens = self._all(text)

    def _all(self, text: str) -> Iterator[_Token]:
        line, counted = 1, 0
        for match in _TOKEN.finditer(text):
            line, counted = line + text.count("\n", counted, match.start()), match.start()
            word = match[0]
            if word[0] in '"<':
                if len(word) < 2 or word[-1] != {'"': '"', "<": ">"}[word[0]]:
                    raise DataError(self._path, line, "the TextGrid ends within a text or flag")
                yield _Token(line, "text" if word[0] == '"' else "flag", word[1:-1].replace('""', '"'))
            elif word[0] in "-+." or word[0].isdecimal():
                yield _Token(line, "number", word)

    def _next(self, kind: str, what: str) -> _Token:
        token = next(self._tokens, None)
        if token is None:
            raise DataError(self._path, None, "the TextGrid ends before its last tier does")
        if token.kind != kind:
            raise DataError(self._path, token.line, f"{shown(token.value)} stands where {what} should be")
        return token

    def text(self, what: str, known: tuple = ()) -> _Token:
        """A text in quotes, one of those `known` if there are any."""
        token = self._next("text", what)
        if known and token.value not in known:
            raise DataError(self._path, token.line, f"{shown(token.value)} stands where {what} should be")
        return token

    def time(self, what: str) -> float:
        """Seconds from 0 on."""
        token = self._next("number", what)
        value = number(self._path, token.line, token.value, "time")
        if value < 0:
            raise DataError(self._path, token.line, f"the time {shown(token.value)} is negative")
        return value

    def count(self) -> int:
        """How many of something follow."""
        token = self._next("number", "a count")
        if not is_whole(token.value):
            raise DataError(self._path, token.line, f"{shown(token.value)} is not a number of tiers or intervals")
        return int(token.value)

    def tiers(self) -> int:
        """The header; how many tiers follow it."""
        if not self.text("the file type").value.startswith("ooTextFile"):
            raise DataError(self._path, 1, "not a TextGrid in text form")
        self.text("the object class", ("TextGrid",))
        self.time("the start of the grid")
        self.time("the end of the grid")
        return self.count() if self._next("flag", "<exists>").value == "exists" else 0

    def interval(self) -> Optional[SourceSegment]:
        """An interval; its label is one line."""
        start, end, token = self.time("an interval's start"), self.time("an interval's end"), self.text("a label")
        label = re.sub("[\t\r\n]", " ", token.value.strip(" \t\r\n"))
        return SourceSegment(start, end, label, line=token.line)

    def point(self) -> None:
        """A point of a tier of points, which nobody needs."""
        self.time("a point's time")
        self.text("a point's mark")

    def end(self) -> None:
        """Nothing may follow."""
        token = next(self._tokens, None)
        if token is not None:
            raise DataError(self._path, token.line, f"{shown(token.value)} stands where the file should end")
