"""Makes ``words_cases.h`` anew: how texts are read and how words share their time according to the exporter's
reference, for test_words.c.

    PYTHONPATH=export python3 tests/c/words.py >tests/c/words_cases.h
"""

from __future__ import annotations

import random
import sys
from pathlib import Path
from typing import List

from labial.words import text, times
from labial.words.dictionary import COMMON, PHONEMES, read_common
from labial.words.tables import WordTables, load

MODEL = Path(__file__).resolve().parents[2] / "export" / "models" / "words_en.npz"

TEXTS = """
Hello world. "Hello," (yes) don't don’t 'cause 'quoted' dogs' x' ' '' ' - -- ... !? café naïve Zürich Øre ß Æ
œuvre Łódź e\u0301te\u0301 co\u00adop a\u200bb ＡＢｃ１２ × ÷ a·b ½ donʼt \ufeffa heart\ufe0f a~b {x} A I a i X x Q
W iPhone eBay YouTube McDonald O'Neil A'B x'B I'm HTMLx TV HTTP PDF BBC ABCD BCDFG BCDFGH USA AI API URL OK IO
IT US NASA FAQ usb tv TVs hmm U.S. u.s U.S.A a.m. p.m. A.I. i.e i.e. e.g. E.G. e.g.x I.E. e.x i.x J.R.R.
U.S.based a.b1 x.yz a. I. B. Mr. Mrs Ms. MR dr. Dr St. prof Prof. jr Jr. sr vs. VS etc etc. etcetera Mrs.Smith
& @ % + = B&B 50% a@b.com C++ 1+1=2 0 1 2 3 10 11 12 13 19 20 21 30 99 100 101 110 111 120 199 200 999 1000
1001 1010 1100 9999 10000 12345 100000 123456 999999 1000000 1000001 1001000 2000002 999999999 1000000000
1,000 1,234,567 12,34 1,2345 1,234,56 0,123 999,999,999 1,000,000,000 123456789012 007 00 01 0.5 3.14 3. .5
1.2.3 1,234.5 12:30 1/2 2-3 1st 2nd 3rd 4th 5th 8th 9th 11th 12th 13th 20th 21st 22ND 40th 100th 101st 1000th
1000000th 0th 3Rd 1stx 2ndly 1st2 007th 5x x5 24h [laughs] [a]b a[b]c [open x<tag/>y <open ] > Привет 你好 日本語
한국어 ελ Привет! aПривет中 [中] 😀 😀! ♥ na\u036fme \u0180 a\u0180 \u07ff \u0800 \uffff \U00010000
\u0080 rock-n-roll and/or snake_case a.b,c;d (a)(b)
abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaab
Pneumonoultramicroscopicsilicovolcanoconiosis bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb'b don't-can't-won't
""".split()
LONG = ["111111111" * 30, "ab" * 150, "€" * 300 + "a", "WWWWW-WWWWW-WWWWW-WWWWW", "\u0301" * 260]
TIMED = """the a I computer banana strengths idea go tv's reiteration 21 we're asthma B&B hmm spaghetti queue onion boy
 Mississippi extraordinary rhythm""".split()


def shown(tables: WordTables, word: str) -> str:
    """How a text is read."""
    reading = text.read(tables, word)
    if reading.kind != "read":
        return reading.kind
    return " ".join(f"{'_' if first else ''}{PHONEMES[phoneme]}:{place}" for phoneme, place, first in reading.phonemes)


def durations(tables: WordTables, word: str, milliseconds: int, pause: bool) -> List[int]:
    """What the phonemes of a word last, milliseconds."""
    parts: List[List[int]] = []
    for phoneme, _, first in text.read(tables, word).phonemes:
        if first:
            parts.append([])
        parts[-1].append(phoneme)
    weights = [weight for number, part in enumerate(parts, 1)
               for weight in times.weights(part, pause and number == len(parts))]
    ends = times.ends(weights, milliseconds)
    return [end - start for start, end in zip([0, *ends], ends)]


def quoted(value: str) -> str:
    """A C string of UTF-8."""
    return '"' + "".join(chr(b) if 32 <= b < 127 and b not in (34, 92, 63) else f"\\{b:03o}"
                         for b in value.encode()) + '"'


def header() -> str:
    """The file's text."""
    tables = load(MODEL)
    common = read_common(COMMON)
    words = [*TEXTS, *LONG, *common[:60], *random.Random(0).sample(common, 300)]
    readings = "\n".join(f"    {{ {quoted(word)}, {quoted(shown(tables, word))} }}," for word in dict.fromkeys(words))
    rows = []
    for number, word in enumerate(TIMED):
        for pause in (0, 1):
            length = (90, 137, 400, 1001, 3600000)[(number + pause) % 5]
            found = durations(tables, word, length, bool(pause))
            rows.append(f"    {{ {quoted(word)}, {length}, {pause}, {{ {', '.join(map(str, found))} }} }},")
    return f"""/*
 * words_cases.h - what the exporter's reference makes of texts and words. Written by tests/c/words.py; do not edit.
 */
#ifndef LABIAL_TEST_WORDS_CASES_H
#define LABIAL_TEST_WORDS_CASES_H

#include <stdint.h>

/* A text, and its phonemes with the places of their characters; _ begins a spoken word. */
static const struct {{
    const char *text, *reading;
}} readings[] = {{
{readings}
}};

/* A word, its milliseconds, whether a pause follows, and what its phonemes last. */
static const struct {{
    const char *text;
    uint32_t length;
    int pause;
    uint32_t lasts[96];
}} timed[] = {{
{chr(10).join(rows)}
}};

#endif
"""


if __name__ == "__main__":
    sys.stdout.write(header())
