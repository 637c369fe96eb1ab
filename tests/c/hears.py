"""Makes anew what test_hear*.c and the device tests hear: a small model of random weights, ``hear_fixture.c`` and
``hear_fixture.h``, and what the exporter's integers make of sounds, ``hears.h``; and what the exporter's laughs are,
``laughs.h`` for test_laugh.c.

    PYTHONPATH=export python3 tests/c/hears.py tests/c
"""

from __future__ import annotations

import struct
import sys
import zlib
from pathlib import Path
from typing import Dict, List

import numpy as np

from labial.corpus.phonesets import LAUGHTER
from labial.files.faps import CHANNELS
from labial.hearing import emit, integer
from labial.hearing.convert import RATES
from labial.hearing.model import HearingModel, Memory
from labial.hearing.quantise import HearingTables, quantise
from labial.reference.laughs import pieces

UNITS = 8
MEMORIES = (Memory(2, 1, 1), Memory(2, 0, 1), Memory(1, 1, 2))
CLASSES = ("SIL", "M", "AA", "S", "IY")

#: Sounds by number: what a sample is made of. test_hear.c has the same in C.
SOUNDS = ("silence", "constant", "square", "noise", "quiet", "buzz", "faint voice")


def model() -> HearingModel:
    """A model of random weights whose outputs move, and whose lips close at times."""
    rng = np.random.default_rng(7)

    def drawn(*shape: int, scale: float = 1.0) -> np.ndarray:
        return (rng.normal(size=shape) * scale / np.sqrt(shape[-1])).astype(np.float32)

    blocks = range(len(MEMORIES))
    return HearingModel(
        MEMORIES,
        tuple(drawn(UNITS, UNITS if k else 48, scale=2.5) for k in blocks),
        tuple(drawn(UNITS) for _ in blocks),
        tuple(drawn(UNITS, memory.taps, scale=1.5) for memory in MEMORIES),
        drawn(UNITS, UNITS, scale=2.0), drawn(UNITS),
        drawn(len(CLASSES), UNITS, scale=2.0), drawn(len(CLASSES), scale=3.0),
        drawn(UNITS, scale=2.0), drawn(1),
        drawn(CHANNELS, UNITS), drawn(CHANNELS),
        CLASSES, drawn(CHANNELS, scale=200.0), np.abs(drawn(CHANNELS, scale=400.0)) + 20,
        drawn(CHANNELS, scale=100.0), np.linspace(1.0, 0.0, CHANNELS, dtype=np.float32), -0.5, 0.3,
    )  # fmt: skip


def tables() -> HearingTables:
    """Its integer tables, named as in C."""
    return quantise(model(), "hear_fixture")


def sound(number: int, count: int, seed: int = 1) -> np.ndarray:
    """(count,) int64 samples of a sound, by its number in `SOUNDS`."""
    name = SOUNDS[number]
    at = np.arange(count)
    if name == "silence":
        return np.zeros(count, dtype=np.int64)
    if name == "constant":
        return np.full(count, 8520)
    if name == "square":
        return np.where(at // 40 % 2 == 0, 32767, -32768)
    state, noise = seed, np.zeros(count, dtype=np.int64)
    for k in range(count):
        state = (state * 1664525 + 1013904223) % 2**32
        noise[k] = (state >> 16) - 32768
    if name == "noise":
        return noise >> (at // 2500 % 4 * 4)
    if name == "faint voice":
        return noise >> np.where(at < 5000, 9, 4 + at // 1500 % 3)
    if name == "quiet":
        return 8000 + (noise >> 12)
    saw = ((at * 420 % 65536 - 32768) * (at * 77 % 16384)) >> 15
    return (saw * (at // 3000 % 3) >> 1) + (noise >> 7)


HEAD = """/* Written by hears.py from export/labial/hearing/integer.py; do not edit: rate, channels, number of a sound,
 * samples; number of frames and of stretches of one class, CRC-32 of the FAPs and of classes with their frames. */
static const struct {
    uint32_t rate, channels, sound, samples, frames, stretches, faps_crc, classes_crc;
} hears[] = {
"""


def stretches(scores: np.ndarray) -> List[List[int]]:
    """Class, first frame and number of frames of each stretch of frames (T, C) with the same leading class."""
    leading = scores.argmax(axis=1)
    first = [k for k in range(len(leading)) if k == 0 or leading[k] != leading[k - 1]]
    return [[int(leading[a]), a, b - a] for a, b in zip(first, [*first[1:], len(leading)])]


def cases() -> List[Dict[str, int]]:
    """The sounds that are heard: every rate, and at 16 kHz every length that ends a frame early or not at all."""
    found = [{"rate": rate, "channels": 1 + number % 2, "sound": number, "samples": rate * (3 + number) // 10 + number}
             for rate in RATES for number in range(len(SOUNDS))]
    found += [{"rate": 16000, "channels": 1, "sound": 5, "samples": samples}
              for samples in (1, 159, 160, 161, 319, 320, 321, 960)]
    return found


#: Level that is set, 0 for none, and numbers and samples of a sound and of the next one, at 16 kHz.
AGAIN = ((0, 5, 8000, 6, 12000), (0, 6, 9001, 5, 7000), (4000, 5, 4000, 3, 8000), (9000, 6, 16000, 6, 16000))

HEAD_AGAIN = """};

/* The same of two sounds of 16 kHz, one after the other: the level that is set, 0 for none, numbers and samples of
 * both; levels when they were heard; frames, and CRC-32 of those of the second. */
static const struct {
    uint32_t set, sound, samples, next, next_samples, level, next_level, frames, next_frames, next_crc;
} hears_again[] = {
"""


def again() -> str:
    """The rows of sounds that follow others."""
    rows, own, scale = [], tables(), integer.LEVEL_ONE // integer.LOG
    for level, *sounds in AGAIN:
        begin, numbers, frames = level * scale or integer.BEGIN, [], []
        for number, count in (sounds[:2], sounds[2:]):
            samples = sound(number, count)
            frames.append(integer.delivered(own, samples, begin=begin).faps)
            begin = integer.level_after(own, samples, begin=begin)
            numbers.append(begin // scale)
        crc = zlib.crc32(frames[1].astype("<i2").tobytes())
        values = (level, *sounds, *numbers, *map(len, frames))
        rows.append(f"    {{ {', '.join(map(str, values))}, 0x{crc:08x}u }},\n")
    return "".join(rows)


def table() -> str:
    """The file hears.h."""
    rows, own = [], tables()
    for case in cases():
        samples = sound(case["sound"], case["samples"])
        if case["channels"] == 2:
            samples = np.stack([samples, -(samples >> 1)], axis=1)
        heard = integer.delivered(own, samples, case["rate"])
        told = stretches(heard.scores)
        faps = zlib.crc32(heard.faps.astype("<i2").tobytes())
        classes = zlib.crc32(np.array(told, dtype="<u4").tobytes())
        numbers = ", ".join(str(value) for value in case.values())
        rows.append(f"    {{ {numbers}, {len(heard.faps)}, {len(told)}, 0x{faps:08x}u, 0x{classes:08x}u }},\n")
    return HEAD + "".join(rows) + HEAD_AGAIN + again() + "};\n"


HEAD_LAUGHS = """/* Written by hears.py from export/labial/reference/laughs.py; do not edit: milliseconds, intensity,
 * seed; number of phonemes, CRC-32. */
static const struct {
    uint32_t milliseconds, intensity, seed, count, crc;
} laughs[] = {
"""
LAUGHS = 240
#: Lengths in milliseconds by turns: of a breath, of a pulse, of one and of several trains, of several bouts.
LAUGH_LENGTHS = (0, 19, 45, 130, 300, 520, 777, 1100, 1850, 4000, 9000, 60000)


def laughs() -> str:
    """The file: for each laugh what was asked for, its phonemes' number, and their CRC-32 as bytes and uint16."""
    rows = []
    for number in range(LAUGHS):
        length = LAUGH_LENGTHS[number % len(LAUGH_LENGTHS)] + number
        intensity, seed = number * 37 % 257, number * 2654435761 % 2**32
        laugh = [(LAUGHTER.phonemes.index(label), ms) for label, ms in pieces(length, intensity, seed)]
        crc = zlib.crc32(b"".join(struct.pack("<BH", *piece) for piece in laugh))
        rows.append(f"    {{ {length}, {intensity}, {seed}u, {len(laugh)}, 0x{crc:08x}u }},\n")
    return HEAD_LAUGHS + "".join(rows) + "};\n"


def files() -> Dict[str, str]:
    """The files by their names."""
    own = tables()
    return {"hear_fixture.h": emit.header(own), "hear_fixture.c": emit.source(own), "hears.h": table(),
            "laughs.h": laughs()}


if __name__ == "__main__":
    for name, text in files().items():
        (Path(sys.argv[1]) / name).write_text(text, encoding="ascii")
