"""Timings as Python and the npm package read them, against tests/grammar/cases.tsv, to which tests/c/test_timings.c
holds the library's parser; and the grammar of the exporter's other files."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import List, Sequence, Tuple

import pytest

from labial.corpus.formats import read_timings
from labial.corpus.timings import TOLERANCE
from labial.errors import DataError
from labial.files.grammar import is_number, is_whole, lines_of, number, number_or_nan, read_bytes, read_text
from packages import SOURCE
from runtime import needs_runtime
from test_npm import read_by_node

CASES = SOURCE / "tests" / "grammar" / "cases.tsv"
GRID = '"ooTextFile"\n"TextGrid"\n0\n{0}\n<exists>\n1\n"IntervalTier"\n"phones"\n0\n{0}\n1\n0\n{0}\n"m"\n'
#: What a row of a number is in each format.
NUMBERS = {"lab": "0 {} m\n", "flite": "m:{}\n", "mary": "#\n{} 1 m\n", "textgrid": "File type =\n" + GRID}
Case = Tuple[int, str, bytes, str]


def plain(column: str) -> bytes:
    """A column without its escapes."""
    known = {"n": b"\n", "t": b"\t", "r": b"\r", "\\": b"\\"}
    parts = re.split(r"\\(x[0-9a-f]{2}|.)", column)
    return b"".join(part.encode() if n % 2 == 0 else known.get(part) or bytes.fromhex(part[1:])
                    for n, part in enumerate(parts))


def cases() -> List[Case]:
    """The line of the file, the format, the text and what it means, of every row and format."""
    found: List[Case] = []
    for line, row in enumerate(CASES.read_text(encoding="ascii").split("\n"), 1):
        if not row or row.startswith("#"):
            continue
        name, text, expected = row.split("\t")
        if name != "number":
            found.append((line, name, plain(text), plain(expected).decode()))
            continue
        meaning = expected if expected == "refused" else f"m:{expected}"
        found += [(line, kind, form.format(plain(text).decode()).encode(), meaning) for kind, form in NUMBERS.items()]
    return found


def told(rows: Sequence[Tuple[float, float, str]]) -> str:
    """Segments as the last column has them: gaps are silence, times are rounded, durations are what is between."""
    parts, previous = [], 0.0
    for start, end, label in rows:
        for name, until in (("-", start if start - previous > TOLERANCE else previous), (label or "-", end)):
            if name != "-" or until > previous:
                parts.append(f"{name}:{math.floor(1000 * until + 0.5) - math.floor(1000 * previous + 0.5)}")
            previous = max(previous, until)
    return " ".join(parts)


def is_text(data: bytes) -> bool:
    """Whether it is UTF-8, which these readers are certain of before they parse."""
    return data.decode("utf-8", "replace").encode() == data


def differs(expected: str, found: str) -> bool:
    """Whether a reader made something else of a text; one that has no timings is refused by these, which also say how
    loud a laugh is."""
    expected, found = (re.sub(r"<laugh:[0-9.]+>", "<laugh>", text) for text in (expected, found))
    return not found.startswith("refused") if expected in ("", "refused") else found != expected


@needs_runtime
def test_exporter_reads_by_the_grammar(tmp_path: Path) -> None:
    """Would catch a label, a time, a line or a sentence that is lost between the library and Python."""
    wrong = []
    for line, name, text, expected in filter(lambda case: is_text(case[2]), cases()):
        path = tmp_path / "timings.txt"
        path.write_bytes(text)
        try:
            found = told([(item.start, item.end, item.label)
                          for item in read_timings(path, None if name == "auto" else name)])
        except DataError as error:
            assert "\n" not in str(error) and str(error).startswith(f"{path}:")
            found = "refused: " + str(error)[len(f"{path}:"):]
        if differs(expected, found):
            wrong.append(f"cases.tsv:{line}, {name}: {found}, not {expected}")
    assert not wrong, "\n".join(wrong)


def test_npm_package_reads_by_the_grammar() -> None:
    """Would catch the same between the library and JavaScript."""
    own = [case for case in cases() if is_text(case[2])]
    answers = read_by_node([(name, text.decode()) for _, name, text, _ in own])
    wrong = []
    for (line, name, _, expected), answer in zip(own, answers):
        found = f"refused: {answer}".replace(": line ", ": ") if isinstance(answer, str) else told(
            [row[:3] for row in answer])
        if differs(expected, found):
            wrong.append(f"cases.tsv:{line}, {name}: {found}, not {expected}")
    assert not wrong, "\n".join(wrong)


def test_numbers(tmp_path: Path) -> None:
    """Would catch a number that is read although it is none, and an error without its place."""
    assert number("f", 3, "-2.5e1") == -25.0 and math.isnan(number_or_nan("f", 3, "NaN"))
    assert is_number("1e999") and not is_number("1\n") and is_whole("0" * 30 + "7") and not is_whole("9" * 19)
    for text in ("1e999", "nan", "", "1_0", "+1", "\u0661"):
        with pytest.raises(DataError, match="^f:3: the time .* is not a finite number$"):
            number("f", 3, text, "the time")


def test_text(tmp_path: Path) -> None:
    """Would catch UTF-16 that is taken for text without its mark, a control character or a file without end."""
    path = tmp_path / "a"
    for data, problem in (("a\nb\n".encode("utf-16-le"), ":1: byte 0x00"), (b"a\n\xff\n", ":2: not UTF-8"),
                          (b"a\n\n\x0b", ":3: byte 0x0b"), (b"\xff\xfea", ": not UTF-16")):
        path.write_bytes(data)
        with pytest.raises(DataError, match=re.escape(f"{path}{problem}")):
            read_text(path)
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        path.write_bytes("ä\r\n\u2028b".encode(encoding))
        assert lines_of(read_text(path)) == ["ä\r", "\u2028b"]
    with pytest.raises(DataError, match="more than the 1,000 bytes"):
        read_bytes("/dev/zero", 1000)
