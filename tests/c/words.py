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
#: Texts that were read wrongly once: the last part of the list of texts and what a voice reads.
REPORTED = [line.split("\t")[0] for line in (Path(__file__).resolve().parents[1] / "python" / "spoken.tsv").read_text(
    encoding="utf-8").rstrip().split("\n\n")[-1].splitlines()]

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
hi\u0964 a\u060cb x\u05bey \u061f\u0964 5\u06d4
한국어 ελ Привет! aПривет中 [中] 😀 😀! ♥ na\u036fme \u0180 a\u0180 \u07ff \u0800 \uffff \U00010000
\u0080 rock-n-roll and/or snake_case a.b,c;d (a)(b)
Zoë Noël Citroën résumé fiancée façade ﬁne ﬂow ﬀ œuf Æon 1999 2005 1905 1900 2000 2100 1990s 80s 80's 2000s 20s
2024-03-05 3/5/2024 13/5/2024 3/5/24 5.3.2024 12-25-2024 2024-13-05 0/0/2024 555-1234 1-800-555-0199 10-20 1914–1918
3:30 3:05 9:00 15:00 0:30 24:61 10:30:15 10:00:00 7:45am 5pm 5p.m. 3/4 1/2 2/3 7/16 5/12 10/3 5'10" 6'2 9'x
$5 $1 $5.50 $0.99 $.50 $1.5 $1.01 $00.50 $2M $10k $3bn $5k- $5/hour €20 £3.20 £1.01 ¥500 ¥5.50 ₹1,000 5€ 1€ 50¢
$1,250 $1234567890123456 $5-$10 $5million 5km 1km 5kmx 100km/h 16GB 5M 2bn 6in 1in 3A 20C 25°C 98.6°F 1° 5m² 20m/s
60mph 3ft 1ft 3½ ½ ¼ ¾ 3x4 3×4 -5 −5 -$5 (-5) a-5 #1 #a <3 <b>x</b> 50 999,999,999,999,999 9999999999999999
FBI NBA CIA VIP PhD PhDs TVs FBI's FBIs CEO's NASA's USAs MHz
Ghz's Xiv's XIV's II's STOP WHO IRS SUV NYPD HELLO X's A's As As' H's DVDs AT&T
Q&A A+ A-1 B2B MP3 YMCA UNESCO ESPN JPEG json Wi-Fi WiFi Jan. Sept Tues. Mar approx. www.example.com x@b.io .com
https://a.org/b-c_d node.js a.b.c end.Start wait...what (sighs) (pause) (pauses) (yes) *smiles* *leans *really*
**bold** [a]b (laughing)x *x ok Ok OK omg IDK btw fyi TBH pls plz thx NATO uber haha Hahaha hehe ugh Whoa eww yuck lemme
abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaab
Pneumonoultramicroscopicsilicovolcanoconiosis bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb'b don't-can't-won't
""".split()
PHRASES = [*"""
    1/200 3/1000 a1/2 1/2x 1/0 100/3 12/34/5 1/2/ 2/3/2024x 2024-3 2024-3-4x 2024-003-4 32/12/2024 5-6-24 5.6.24
    111/2/2024 1/222/2024 1.2/2024 12345-67-89 555-12345 555-123- 555-1234x 55-1234 12-34-5 10:5 10:60 10:30:5
    10:30:15: 100:30 10:30x 0:00 13:00 10:00:05 5'100 5'x 555'1 5'10x 1990sx 1990'sx 15s 1995s 3000s 1000s 19s
    2100s 1066 2000 2009x 1984% 1984.5 1984x 1stx 1sx 5x 5xx 5×a 5- 5-a 5-$ 5-$1 5– $k5 $5kx $5kn $5mn $5bnx $5t
    $5.5.5 $1,00 $007 $007.5 $00 $0 $0.00 $1.00 ¥1 ¥1.50 ₹1.01 ₹2.05 £0.01 £0.02 €1 $.5k $12345678901
    $1234567890123456.50 $1234567890123456k 1234567890123456th 007th 1000000000000th 000 1,234th 1/3 9/10 31/32
    99/100 50/64 13/16 2/4 1/4 2/2 5/4 x's 's s's Xs Ss Hs' O'S OS' A's AB'S ABs' ABx ABC'x ABCDEFs a&b AT& &AT AM
    am US us CO co.uk a.co a.go a.me a.xyz a.b-c a.tx9 a.it's a://b a:/b a:b 1://2 .a .A -.5 -a (- (-a [ [] < <1
    <! <? </ <é *a* *** *1 (1) (sigh (sighs1 (sigh1) (sighx) (pausing) (clapping) *grins* *glass a* *Leans a*
    *this a* *thisisverylongwords a* *as a* (abcdefghijklmn) C. c.C ° °C °Cx °F °K 5°x ¢ 5¢ 1¢ 1€ x€ € #a # ½x 5½
    5¼ 5¾ ² 5m² 5x² 5/32/2024 5/0/2024 0/5/2024 2024-3-2024 2024/3/5 2024.3.5 0/5 3/5/2100 3/5/1000 555-123 $007,x
    $007,1
    $1M OBEV TABQS BINDS SUVS +A &A ABs& &ABs .:/ :// a.{ *word 5mi' $1M $1.50M $1.5M 5cmx 5cm's 5mi's 5° 1inx
    5A's /a 5km/ 5km/1 5km/h 5km/x $5/ $5/1 é è ë ê à ï î í ô ó û ú ç ñ ö né née nëe ée e\u0300 e\u0302 e\u0308
    c\u0327 n\u0303 a\u0301 u\u0301 o\u0302 i\u0308 x\u0301 Zoë's NoëL \ufb03x \ufb05 µm \u2028 \u3000a \u0085a
    \u205fa \u202fa \u2005a GYM YES NYC QUEUE EYE AAAA TRY HMM STRNG STRENG WRLDS ABBS TSK DIYS
    No.5 No.x No5 no. NO. Nos. Nos 2023/10/05 2023/10-05 2023/13/05 .5 -.5 a.5 ..5 x.5.5 5÷2 ÷ x² ² w/o w/ w/x W/x w/ox
    w o C# C#x # 5# A. A, A/B A' AB/C 16:9 1:2:3 9am-5pm 9am-x 5km-10km 5km- (555) (155) (555 555) (5555) 5ft. 5m. II
    iii VII viii XII XIV pp vol 2tbsp 1tsp 3yrs 1yr 5sq 5sqft 31 32
    """.split(),
           *"1-80-A 1-80-a 12-80-A 12-A 1-A XX XXX XXI XIX VX IIII X5 Ja Janu Satu Septem Mar,5 Mar/5 Mar-5".split(),
           *"Mar!5 www.Mar-x 5s 12s 12345s 120s 747s 747sx 101st a5s a5sx x747 no.x NO.5 CA.5 www.a.no.5 Gen.x".split(),
           *"aaab soooo's xiii iiii vooov ooo oooo oOo sOOo SOOo ooo5 hooo'o loooL lOOOl goo aaa'a gooo9 eeel".split(),
           *"w-w w-W W-w-what xw-w d-day d-days d-day's t-tests1 a-a- a-á e-e5 b-boy- n-no-no i-ii".split(),
           *"A's Xs &Xs aXs aX's &X ;dr &dr 5dL 5fl 1fl a.m.-x 5a.m.-6 5p.m.-x 5a.m-6 a.m.-6 5a.m.:x 5a.b.-6".split(),
           *"5a.m.s.-6 3:00p.m.-$5 1p.m.-2".split(),
           *"gen.x GEN.x 5m³ x³ 1⁄2 ½x a½ 5½ 5⅐ ⅒ `a` a`b 5% 5%-x 5%-6 80s-90s 80s-x A/A 5₂".split(),
           "2 1/3", "2 1/4", "1/4", "Mar -5", "Mar 5", "Mar x", "5 Mar", "5 Mar.", "Mar. 5", "Sat. 5", "Sat.",
           "Sat May", "Sun, May", "Mon-May", "Friday-Sat", "Fri, Sun.", "Mon Dr", "no. x", "no. 5", "ca. 5", "Fig. 5m",
           "fig 5m", "seat 5m", "seat 5mx", "seat 5 m", "seat 5ml", "seat A or 5m", "seat A and B to 5m",
           "seat A but 5m", "seat 5A, 5A", "seat 5A. 5A", "a5A 5A", "Elm VI", "part VI", "part vi", "elm VI", "Elm Vi",
           "Elm ave", "Elm LN.",
           "No. 5", "No. a", "No., 5", "Nos. 5 and 6", "No. 5th", "No. $5", "No. 2023/10/05", "5 March", "1 Mar. 5",
           "31 May 1990", "32 May", "0 May", "5 may", "5 MAY", "5, May", "5.5 May", "5½ May", "5 ½ May", "5M May",
           "5-7 May", "5th May", "$5 May", "1/2 May", "05 May", "5 km May", "5 million May", "x5 May", "6 ft 2 in",
           "6 ft. 2 in.", "6 ft 2", "6 ft 2 May", "6 ft, 2 in", "6 ft x 2 in", "6 ft 2 3 in", "1h 30m", "1 hr 30 m",
           "1h x 30m", "1h 5km", "1 pound 3 in", "5 sq ft", "w/ x", "w/ o", "w/. o", "5 % May", "5 . 5 May",
           "a\u0085b", "a\u2028b", "a\u2029b", "a\u205fb", "a\u202fb", "a\u2005b", "a\u3000b", "a\xa0b", "a\tb",
           "March 5/x", "March 5:x", "*word a*", "*glass a*",
           "March 5.a", "March 5,a", "March 5x", "March 5:30", "March 5/6", "March 32", "March 0", "March 123",
           "March 5,5", "march 5", "MARCH 5",
           "3 in", "3 A", "3 M", "3 kmx", "1 am", "5 am", "5 Am", "5 aM", "3:00 AM", "3:00 o'clocks", "o'clock",
           "$5 billion",
           "$5 bill", "5 million", "1 °F", "1 ½", "1 3/4", "5 ¢", "1 ¢", "5 p.m.s", "3:00 p.m.x", "3:00 b.m.",
           "3:00 a.b.",
           "3:00 a.m.s.", "I US", "NO US", "no US", "A US", "*leans", "*leans x y z a b c d e f g", "<a b",
           "(sighs a) b",
           "[a] b", "www. a", "a.com b-c", "a.com/b a/b", "$5 million", "3:00 pm", "9:00 a.m.", "9:00 o'clock",
           "March 5", "Dec. 25", "May 5-7", "March 5.5", "5 km",
           "1 h", "10 AM", "I AM", "IS IT", "IT is", "(laughs softly) yes", "<break time='1s'/> go", "[a b] c",
           "[a b c d e f g h i j", "*leans in* yes", "*really* no", "2 1/2", "1 1/4", "20 €", "20 °C", "$20 / hour",
           "5 km / h", "5 in 6", "$5. Million",
           "$5-10", "$5–10k", "$5k-10", "$1-1", "$.50-1", "$5.50-6.00", "$5-10 million", "$5-$10", "$5-10-15", "$5-x",
           "+1 555 123 4567", "+15551234567", "+44 20-7946 0958", "+40.712776", "+44.20.7946.0958", "+1 2.3 4",
           "+1 555 1234", "+1234 567 890", "+1 555 123 4567x", "+1234567890123456", "555 123 4567", "555.123.4567",
           "155 123 4567", "555 123 4567 8", "555.123 4567", "555 123 4567x", "555 123 4567-8", "5 555 123",
           "+55-66-77", "+555-666-7777", "Main St.", "Elm Dr, x", "Elm Dr. Foo", "Elm St x", "the St. x", "Our Dr. is",
           "42nd St.", "42nd St. Louis", "In St. Louis", "St. x", "Elm  St.", "Elm ST", "A St.", "Elm. St.", "Elm-St",
           "Elm 5 St", "Elm St. The", "Elm St., Foo", "Elm St Dr Foo", "Elm St. $5", "Elm $5 St", "Elm St. a Foo",
           "Elm. Dr x", "iPhone St.", "Ave St. x Dr", "tv html mp3 css dvds abc tv's x.php",
           "hm grrr shhh xxx bzz ll'd", "Tv Html nfl's usb's id ids", "xbox y'all x's Latte openai's", "abcdef ghjklm",
           "[Click here](https://a.b/c) x", "[click](a b) c", "[1](a) b", "[a][1] b", "[a][b] c", "[a][] b", "[](a) b",
           "[![a](b)](c) d", "[a [b] c", "[Your Name] a", "[Sighs deeply] a", "[Music plays] a", "[I am", "[Click",
           "[a", "[Abc5 d", "[ABC d", "[\u4e2d](a) b", "[laughs](softly) a", "a](b) c", "a] (b)", "[5 a](b)", "[Music",
           '24" 5\'11" 5\'11"x', '"24" 6"', '"I am 24" a 6" b', '"', 'a" 6"', '6"x', '6" 6 x 4 5 x', "5 x 4", "5x 4",
           "5 X 4", "5 km x 4", "1 x 4", "a x 4", "5 x", "5 in. 5 in 5in. 5 A. 5 km.", "p. 5", "p. a", "P. 5", "ch. 5",
           "Op. 5", "est. 1990", "p.5", "hahahaha Hehe hoho hihi hahah hahe huhu hah haaha hahahahahahahahahaha",
           "a&amp;b it&#39;s &quot;a&quot; &lt;a&gt; a&nbsp;b &amp &ampx; &am &a; &", "~5 ~a ^5 ^a >5 >a",
           "\u22645 \u2265a \u22485 \xb15 5\u203211\u2033", "1-1/2 1-1/x 1-a",
           "1-2-3 1-2-3-4 1-2-3-a 1-2 1-2-3-45 9-1-1 1-2-3-A",
           "2024-03-05T09:30:00Z 2024-03-05T5 2024-03-05Tx 2024-03-05X 3/5/2024T5 10:30:00 10:00:00 10:00:05",
           "call 555 123 4567", "call 911 24 7", "call us at 5 800 555 x", "Call: (555) 123 4567", "dial +44 20 555",
           "call 500 a", "call 0500 a", "call 0100000000", "call 555-1234", "call 5.5", "call 555, 555", "call 555,5",
           "call 12:30", "call 50%", "call 5/6", "call 5'6",
           "call 5x", "call 5-6", "[A{b c", "call 1234567890123456", "call me 5 km", "call a 555", "&call 555",
           "+44 555 66", "+4444 555", "a+44 555", "+44.5 555", "0800 555", "08 555", "a0800 555", "(800) 555 66 km",
           "5-km 12-oz. 5-in. 2-in-1 5-m 5-x 40-min 5-xx 5-12 5-", "$1M/yr", "$5M million", "$ 5", "R$ 20 million",
           "€ 20-30 x", "$ x 5", "$ x5", "5 $ 5", "£", "Rs. 500", "Rs 500", "7:00-9:00 PM",
           "15:00-16:00", "7:00-x", "7:00:05-9", "a&mdash;b &rsquo;&hellip;", "appt. qty",
           "a.b .NET .Net .a ..A", "I call. 555", "call) 555"]
LONG = ["111111111" * 30, "." * 250 + "&amp;a", "." * 251 + "&amp;", "a" * 40 + "b",
        "ab" * 15 + "o" * 40 + "kk", "ab" * 150, "€" * 300 + "a", "WWWWW-WWWWW-WWWWW-WWWWW", "\u0301" * 260]
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
    numbers = random.Random(1)

    def piece() -> str:
        return numbers.choice(["", "", " "]) + numbers.choice(TEXTS)

    joined = ["".join(piece() for _ in range(numbers.randint(2, 4))).strip() for _ in range(400)]
    words = [*TEXTS, *PHRASES, *REPORTED, *LONG, *joined, *common[:60], *random.Random(0).sample(common, 300)]
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
