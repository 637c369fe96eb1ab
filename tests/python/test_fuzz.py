"""Python's readers of timings on damaged files."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from labial.corpus.formats import read_timings
from labial.errors import LabialError

TESTS = Path(__file__).resolve().parents[1]
FILES = [*sorted((TESTS / "fuzz" / "seeds" / "fuzz_timings").iterdir()),
         *sorted((TESTS / "python" / "services").glob("*.[jm]*"))]
#: What a reader may trip over: signs of every format, numbers beyond any range, bytes that are no UTF-8.
TOKENS = [
    b"", b"\n", b"\r", b"\0", b" ", b"-", b"1e999", b"nan", b"9" * 30, b"-1", b"0.5", b'"', b"#", b"[", b"{", b"]",
    b"}", b":", b",", b"null", b"\xff\xfe", b"\xef\xbb\xbf", b"\xe2\x80\xa8", b"\x0b", b"item", b"<exists>", b"\xcc",
    b"[" * 5000,
]
DAMAGED = 60  # files made of each


def damaged(data: bytes, chance: random.Random) -> bytes:
    """A copy with up to four parts cut out, repeated, moved or replaced."""
    for _ in range(chance.randint(1, 4)):
        start = chance.randint(0, len(data))
        end = min(len(data), start + chance.choice([0, 1, 1, 4, 40]))
        repeated, byte = data[start:end] * chance.randint(0, 3), bytes([chance.randrange(256)])
        part = chance.choice([chance.choice(TOKENS), repeated, byte])
        data = data[:start] + part + data[end:]
    return data


@pytest.mark.parametrize("path", FILES, ids=[path.name for path in FILES])
def test_damaged_timings_are_read_or_refused_in_one_line(path: Path, tmp_path: Path) -> None:
    """Would catch a traceback of Python's: whatever a file holds, it is segments in order or one sentence."""
    chance = random.Random(path.name)
    copy = tmp_path / path.name
    data = path.read_bytes()
    refused = 0
    for _ in range(DAMAGED):
        copy.write_bytes(damaged(data, chance))
        try:
            segments = read_timings(copy)
        except LabialError as error:
            refused += 1
            assert "\n" not in str(error) and path.name in str(error)
        else:
            assert all(0 <= segment.start <= segment.end for segment in segments)
    assert refused > 0
