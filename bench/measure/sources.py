"""Where the figures of pages come from: bench/baseline.json, export/RESULTS.md, bench/records.json, the headers."""

from __future__ import annotations

import json
import os
import re
import tempfile
from pathlib import Path
from statistics import fmean, stdev
from typing import Any, Dict, List, Mapping, Sequence, Tuple

from measure.core import Figure, run
from measure.pages import share

#: Cells of a row by the head of the column, and the rows of a table by their first cell.
Row = Dict[str, str]
Table = Dict[str, Row]
#: Talkers of RESULTS.md who speak freely; all others say commands.
FREE = ("a", "b")


def cells(line: str) -> List[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def rows(text: str) -> List[List[Row]]:
    """The rows of each table of a Markdown text. Of equal column heads the first has its name, the next ones #2, ..."""
    found: List[List[Row]] = []
    heads: List[str] = []
    lines = text.splitlines()
    for line, after in zip(lines, [*lines[1:], ""]):
        if not line.startswith("|"):
            heads = []
        elif re.fullmatch(r"\|(\s*:?-+:?\s*\|)+", after) and not heads:
            names = cells(line)
            heads = [name if names[:i].count(name) == 0 else f"{name} #{names[:i].count(name) + 1}"
                     for i, name in enumerate(names)]
            found.append([])
        elif heads and not re.fullmatch(r"\|(\s*:?-+:?\s*\|)+", line):
            found[-1].append(dict(zip(heads, cells(line))))
    return found


def tables(text: str) -> List[Table]:
    """The tables of a Markdown text, whose rows have different first cells."""
    return [{next(iter(row.values())): row for row in table} for table in rows(text)]


def number(cell: str) -> float:
    """The number of a cell, without the deviation in brackets behind it."""
    return float(cell.split(" (")[0].replace(",", ""))


class Results:
    """Tables of export/RESULTS.md, by the heading above them."""

    def __init__(self, text: str) -> None:
        parts = re.split(r"^## (.*)$", text, flags=re.MULTILINE)
        self._sections = dict(zip(parts[1::2], parts[2::2]))

    def table(self, section: str, place: int = 0) -> Table:
        """A table of a section, by its place there."""
        found = tables(self._sections.get(section, ""))
        if place >= len(found):
            raise ValueError(f"export/RESULTS.md: no table {place + 1} under {section!r}")
        return found[place]

    def rows(self, section: str) -> List[Row]:
        """The rows of the only table of a section."""
        (table,) = rows(self._sections[section])
        return table


class Talkers:
    """Correlations of a row of the tables of talkers left out, in export/RESULTS.md."""

    def __init__(self, table: Table, method: str) -> None:
        heads = list(table[method])
        self.each = {head: number(table[method][head]) for head in heads[1 : heads.index("mean")]}

    def of(self, free: bool) -> List[float]:
        """Those of the talkers who speak freely, or of the others."""
        return [value for talker, value in self.each.items() if (talker in FREE) == free]

    def cells(self) -> List[str]:
        """Mean of those who speak freely; mean and standard error of the others; of all."""
        free, others, everyone = self.of(True), self.of(False), list(self.each.values())
        return [share(fmean(free)), *mean_and_error(others), *mean_and_error(everyone)]


def mean_and_error(values: Sequence[float]) -> List[str]:
    return [share(fmean(values)), share(stdev(values) / len(values) ** 0.5)]


class Sources:
    """Everything that figures are taken from, below the folder of the sources. Figures that were `measured` just now
    take the place of the baseline's."""

    def __init__(self, root: Path, baseline: Sequence[Figure], measured: Sequence[Figure] = (),
                 records: Mapping[str, Mapping[str, object]] = {}) -> None:
        self.root = root
        self._bench: Dict[Tuple[str, str], Figure] = {(one.target, one.figure): one for one in baseline}
        for one in measured:
            before = self._bench.get((one.target, one.figure))
            if before is not None and before.tool == one.tool:
                self._bench[one.target, one.figure] = one
        self._records = records
        self.results = Results((root / "export" / "RESULTS.md").read_text(encoding="utf-8"))
        path = root / "export" / "labial" / "corpus" / "services.json"
        self.services: Dict[str, Dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["services"]

    def bench(self, figure: str, target: str = "m0") -> float:
        try:
            return self._bench[target, figure].value
        except KeyError:
            raise ValueError(f"bench/baseline.json: no figure {figure!r} of {target}") from None

    def record(self, name: str) -> Dict[str, float]:
        """The figures of a command of :mod:`measure.records`."""
        try:
            return dict(self._records[name]["figures"])  # type: ignore[call-overload]
        except KeyError:
            raise ValueError(f"bench/records.json: no {name}; run python3 bench/figures.py --measure {name}") from None

    def limit(self, name: str) -> int:
        return self.constant("include/labial/config.h", name)

    def latency(self) -> str:
        """Milliseconds from the begin of a frame until the bundled models of hearing know it, as their headers say: all
        but hear_ahead."""
        found = {said for path in (self.root / "lib" / "models").glob("hear_*.h") if path.stem != "hear_ahead"
                 for said in re.findall(r"\b(\d+)\s(?:\* )?ms from a frame's begin", path.read_text(encoding="utf-8"))}
        if len(found) != 1:
            raise ValueError("lib/models/hear_*.h: the models do not name one latency")
        return found.pop()

    def constant(self, header: str, name: str) -> int:
        text = (self.root / header).read_text(encoding="utf-8")
        found = re.search(rf"^\s*#\s*define {name} \(?(\d+)", text, re.MULTILINE)
        if not found:
            raise ValueError(f"{header}: no number {name}")
        return int(found[1])

    def workspace(self, **limits: int) -> int:
        """Bytes of the bundled speech model's workspace in a build with these limits."""
        options = [*(f"-I{self.root / folder}" for folder in ("include", "lib/models")),
                   *(f"-D{name}={value}" for name, value in limits.items())]
        with tempfile.TemporaryDirectory(prefix="labial-figures-") as folder:
            program = Path(folder) / "size.c"
            program.write_text('#include <stdio.h>\n#include "speech_en.h"\nint main(void)\n{\n'
                               '    printf("%u", (unsigned)SPEECH_EN_WORKSPACE_SIZE);\n    return 0;\n}\n', "ascii")
            run([os.environ.get("LABIAL_CC", "cc"), *options, program, "-o", program.with_suffix("")])
            return int(run([program.with_suffix("")]).stdout)
