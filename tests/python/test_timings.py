"""Phoneme timings as the exporter takes them. What the library's parser reads of lines is test_grammar.py's."""

from __future__ import annotations

import random
from pathlib import Path
from typing import List, Tuple

import pytest

from labial.corpus.formats import read_timings
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError, LabialError
from packages import SOURCE
from services import SAMPLES

SEEDS = SOURCE / "tests" / "fuzz" / "seeds" / "fuzz_timings"
FILES = {path.name: path.read_bytes() for path in sorted(SEEDS.iterdir())}
FILES.update({f"{name}.json": sample.text.encode("utf-8") for name, sample in SAMPLES.items()})
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
