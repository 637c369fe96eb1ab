"""Makes ``laughs.h`` anew: what the exporter's laughs are, for test_laugh.c.

    PYTHONPATH=export python3 tests/c/known_laughs.py >tests/c/laughs.h
"""

from __future__ import annotations

import struct
import sys
import zlib

from labial.corpus.phonesets import LAUGHTER
from labial.reference.laughs import pieces

HEAD = """/* Written by known_laughs.py from export/labial/reference/laughs.py; do not edit: milliseconds, intensity,
 * seed; number of phonemes, CRC-32. */
static const struct {
    uint32_t milliseconds, intensity, seed, count, crc;
} laughs[] = {
"""
COUNT = 240
#: Lengths in milliseconds by turns: of a breath, of a pulse, of one and of several trains, of several bouts.
LENGTHS = (0, 19, 45, 130, 300, 520, 777, 1100, 1850, 4000, 9000, 60000)


def table() -> str:
    """The file: for each laugh what was asked for, its phonemes' number, and their CRC-32 as bytes and uint16."""
    rows = []
    for number in range(COUNT):
        length = LENGTHS[number % len(LENGTHS)] + number
        intensity, seed = number * 37 % 257, number * 2654435761 % 2**32
        laugh = [(LAUGHTER.phonemes.index(label), ms) for label, ms in pieces(length, intensity, seed)]
        crc = zlib.crc32(b"".join(struct.pack("<BH", *piece) for piece in laugh))
        rows.append(f"    {{ {length}, {intensity}, {seed}u, {len(laugh)}, 0x{crc:08x}u }},\n")
    return HEAD + "".join(rows) + "};\n"


if __name__ == "__main__":
    sys.stdout.write(table())
