"""Phoneme timings as the exporter takes them, and the cases of tests/grammar in Python and the npm package."""

from __future__ import annotations

import math
import os
import random
import re
import threading
import warnings
from pathlib import Path
from typing import List, Sequence, Tuple

import pytest

import labial
from labial.__main__ import main
from labial.corpus.formats import read_timings
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import TOLERANCE, phoneme_segments
from labial.errors import DataError, LabialError
from labial.files.grammar import lines_of, read_bytes, read_text
from messages import SAMPLES
from packages import SOURCE, needs_runtime
from test_npm import read_by_node

SEEDS = SOURCE / "tests" / "fuzz" / "seeds" / "fuzz_timings"
FILES = {path.name: path.read_bytes() for path in sorted(SEEDS.iterdir())}
FILES.update({f"{name}.json": sample.text.encode("utf-8") for name, sample in SAMPLES.items()})
#: What a reader may trip over: signs of every format, numbers beyond any range, bytes that are no UTF-8.
TOKENS = [
    b"", b"\n", b"\r", b"\0", b" ", b"-", b"1e999", b"nan", b"9" * 30, b"-1", b"0.5", b'"', b"#", b"[", b"{", b"]",
    b"}", b":", b",", b"null", b"\xff\xfe", b"\xef\xbb\xbf", b"\xe2\x80\xa8", b"\x0b", b"item", b"<exists>", b"\xcc",
    b"[" * 5000,
]
DAMAGED = 30  # files made of each


def damaged(data: bytes, chance: random.Random) -> bytes:
    """A copy with up to four parts cut out, repeated, moved or replaced."""
    for _ in range(chance.randint(1, 4)):
        start = chance.randint(0, len(data))
        end = min(len(data), start + chance.choice([0, 1, 1, 4, 40]))
        repeated, byte = data[start:end] * chance.randint(0, 3), bytes([chance.randrange(256)])
        part = chance.choice([chance.choice(TOKENS), repeated, byte])
        data = data[:start] + part + data[end:]
    return data


@pytest.mark.parametrize("name", FILES)
def test_damaged_timings_are_read_or_refused_in_one_line(name: str, tmp_path: Path) -> None:
    """Would catch a traceback of Python's: whatever a file holds, it is phonemes in order or one sentence."""
    chance = random.Random(name)
    copy = tmp_path / name
    data = FILES[name]
    refused = 0
    for _ in range(DAMAGED):
        copy.write_bytes(damaged(data, chance))
        try:
            segments = read_timings(copy)
        except LabialError as error:
            refused += 1
            assert "\n" not in str(error) and name in str(error)
        else:
            assert all(0 <= segment.start <= segment.end for segment in segments)
    assert refused > 0


def put(folder: Path, name: str, text: str) -> Path:
    """Writes a file and returns its path."""
    path = folder / name
    path.write_text(text, encoding="utf-8", newline="")
    return path


def phonemes(path: Path) -> List[str]:
    """What a file says, as phonemes of speech."""
    return [item.label for item in phoneme_segments(path, read_timings(path), SPEECH)]


def test_lines_of_lab_are_whole(tmp_path: Path) -> None:
    """Catches swapped apex and word, and Windows line ends or a byte order mark that break the first line."""
    path = put(tmp_path, "a.lab", "\ufeff0 0.1 SIL\r\n0.1 0.25 B 0.2\r\n\r\n0.25 0.3 IH .27 bin\r\n")
    assert [(s.start, s.end, s.label, s.apex, s.word, s.line) for s in read_timings(path)] == [
        (0, 0.1, "SIL", None, None, 1), (0.1, 0.25, "B", 0.2, None, 2), (0.25, 0.3, "IH", 0.27, "bin", 4)]


@pytest.mark.parametrize("name, text, expected", [
    ("a.LAB", "0 1 aa\n", ["AA"]), ("a.txt", "0 .1 aa\n", ["AA"]), ("a.psdur", "hh:0.2 aa:0.3\n", ["HH", "AA"]),
    ("a.txt", "hh:0.2 aa:0.3\n", ["HH", "AA"]), ("a.pho", "_ 50\nT 50\nI 50\nN 50\n#\n", ["SIL", "TH", "IH", "NG"]),
    ("a.realised_durations", "#\n0.1 125 _\n0.25 125 S\n0.4 125 V\n", ["SIL", "SH", "AH"]),
    ("a.txt", "#\n0.1 125 _\n0.25 125 S\n0.4 125 V\n", ["SIL", "SH", "AH"]),
])  # fmt: skip
def test_format_is_told_by_suffix_then_content(tmp_path: Path, name: str, text: str, expected: List[str]) -> None:
    """Catches a format that is only found under its usual name, and X-SAMPA, which MBROLA and MARY write, read as
    ARPABET."""
    assert phonemes(put(tmp_path, name, text)) == expected


def test_gaps_become_silence_and_rounding_is_closed(tmp_path: Path) -> None:
    """Catches segments that do not tile: a late start, a gap, an overlap of rounding."""
    path = put(tmp_path, "a.lab", "0.1 0.2 hh\n0.1995 0.3 AH1 0.25\n0.3004 0.4 l\n0.5 0.6 OW\n")
    segments = phoneme_segments(path, read_timings(path), SPEECH)
    assert [s.label for s in segments] == ["SIL", "HH", "AH", "L", "SIL", "OW"]
    assert segments[0].start == 0 and all(a.end == b.start for a, b in zip(segments, segments[1:]))


def test_unknown_labels_are_named_with_their_place(tmp_path: Path) -> None:
    """Catches an unknown label that becomes silence or an error without a line."""
    path = put(tmp_path, "a.lab", "0 0.1 hh\n0.1 0.2 XX\n0.2 0.3 XX\n")
    with pytest.raises(DataError) as raised:
        phonemes(path)
    assert str(raised.value).startswith(f"{path}:2: ") and "'XX'" in str(raised.value)
    with pytest.warns(UserWarning) as caught:
        segments = phoneme_segments(path, read_timings(path), SPEECH, strict=False)
    assert [s.label for s in segments] == ["HH", "HH", "HH"] and len(caught) == 1
    assert f"{path}:2: " in str(caught[0].message) and "'XX'" in str(caught[0].message)


def test_times_of_another_unit_are_asked_about(tmp_path: Path) -> None:
    """Milliseconds in the place of seconds; not a long silence, nor a phoneme that is held for ten seconds."""
    path = put(tmp_path, "a.lab", "0 120 sil\n120 200 b\n200 350 aa\n")
    with pytest.warns(UserWarning) as caught:
        segments = phoneme_segments(path, read_timings(path), SPEECH)
    assert [str(one.message) for one in caught] == [f"{path}:2: 'b' lasts 80 s: is the unit of time right?"]
    assert segments[-1].end == 350
    path.write_text("0 120 sil\n120 130 b\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(phoneme_segments(path, read_timings(path), SPEECH)) == 2


@pytest.mark.parametrize(("text", "told"), [
    ("0 .09 sil\n.09 .0908 m\n.0908 .0928 b\n.0928 .3 aa\n", "every sound but the last"),
    ("0 .003 m\n", "every sound"), ("0 .003 m\n.003 .009 b\n.009 .3 aa\n", ""), ("0 .003 sil\n", ""),
])  # fmt: skip
def test_times_that_are_too_short_are_asked_about(tmp_path: Path, text: str, told: str) -> None:
    """Milliseconds that a reader takes for seconds, or ticks; the last one's length may be a guess."""
    path = put(tmp_path, "a.lab", text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        phonemes(path)
    assert [str(one.message) for one in caught] == (
        [f"{path}: {told} is shorter than 5 ms: is the unit of time right?"] if told else [])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no named pipes")
@pytest.mark.parametrize("name", ["a.txt", "a.json", "a.TextGrid"])
def test_timings_come_from_a_pipe(tmp_path: Path, name: str) -> None:
    """Catches a file that is opened twice: the second time a pipe is empty, or blocks."""
    content = {".json": SAMPLES["plain"].text.encode(), ".TextGrid": FILES["aligned.TextGrid"]}.get(
        Path(name).suffix, b"0 1 m\n")
    (tmp_path / "file").mkdir()
    (tmp_path / "file" / name).write_bytes(content)
    pipe = tmp_path / name
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_bytes, args=(content,), daemon=True)
    writer.start()
    assert read_timings(pipe) == read_timings(tmp_path / "file" / name)
    writer.join()


def test_a_tier_is_taken_by_name(tmp_path: Path) -> None:
    """Catches a tier that no command and no call can name."""
    path, out = str(SEEDS / "aligned.TextGrid"), tmp_path / "a.lab"
    words = read_timings(path, tier="words")
    assert '"baby"' in {item.label for item in words} and words != read_timings(path)
    assert labial.read_timings(path, tier="phones") == PHRASE
    assert main(["timings", path, "--tier", "phones", "-o", str(out)]) == 0
    assert [line.split()[2] for line in out.read_text().splitlines()] == [label for label, _ in PHRASE]
    for command in (["timings", path], ["synth", "speech_en", path], ["check", "speech_en", path],
                    ["page", "speech_en", "--phones", path, "-o", str(tmp_path / "a.html")],
                    ["bake", path, "-o", str(tmp_path / "a.h")]):
        assert main([*command, "--tier", "none"]) == 1, command


PHRASE = [("SIL", 220), ("M", 70), ("AY", 150), ("B", 90), ("EY", 200), ("B", 80), ("IY", 90), ("SIL", 220)]
#: Files of that phrase, one in every format.
SENTENCE = ["sentence.psdur", "sentence.lab", "sentence.pho", "sentence.realised_durations", "sentence.phseg",
            "htk.lab", "hts.lab", "aligned.TextGrid", "short.TextGrid", "utf16.TextGrid", "points.TextGrid"]


@pytest.mark.parametrize("name", SENTENCE)
def test_one_sentence_in_every_format(name: str) -> None:
    """Catches a unit, an inclusive end, a tier, an encoding or a phone set that is misread; test_say.py has the same of
    labial-say."""
    segments = phoneme_segments(SEEDS / name, read_timings(SEEDS / name), SPEECH)
    bounds: List[int] = [round(1000 * segment.end) for segment in segments]
    found: List[Tuple[str, int]] = [(s.label, end - begin) for s, begin, end in zip(segments, [0, *bounds], bounds)]
    assert found == PHRASE


# ---- The cases of tests/grammar, as Python and the npm package read them --------------------------------------------


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
