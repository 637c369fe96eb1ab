"""Readers of phoneme timings: right times from right files, and file and line of what is wrong."""

from __future__ import annotations

import functools

import pytest

from labial.corpus.formats import read_timings
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError

read_flite, read_htk, read_lab, read_mary, read_pho, read_phseg, read_textgrid = (
    functools.partial(read_timings, source=name)
    for name in ("flite", "htk", "lab", "mary", "pho", "phseg", "textgrid"))

LONG = """File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 1
tiers? <exists>
size = 2
item []:
    item [1]:
        class = "IntervalTier"
        name = "words"
        xmin = 0
        xmax = 1
        intervals: size = 1
        intervals [1]:
            xmin = 0
            xmax = 1
            text = "a ""b"" c"
    item [2]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 1
        intervals: size = 3
        intervals [1]:
            xmin = 0
            xmax = 0.25
            text = "AH0"
        intervals [2]:
            xmin = 0.25
            xmax = 0.75
            text = "B"
        intervals [3]:
            xmin = 0.75
            xmax = 1
            text = ""
"""
SHORT = """File type = "ooTextFile"
Object class = "TextGrid"

0
1
<exists>
1
"IntervalTier"
"phones"
0
1
3
0
0.25
"AH0"
0.25
0.75
"B"
0.75
1
""
"""
PHSEG = "  SFrm  EFrm  SegAScr Phone\n    0    11    -1234 SIL\n   12    19   -99 HH SIL AY b\n Total score:   -1333\n"


def put(folder, name, text, encoding="utf-8"):
    """Writes a file and returns its path."""
    path = folder / name
    path.write_bytes(text.encode(encoding))
    return path


def rows(segments):
    """Start, end and label of each."""
    return [(round(s.start, 6), round(s.end, 6), s.label) for s in segments]


def fails(reader, path, line, words):
    """Asserts a DataError that names the file, `line` and `words`."""
    with pytest.raises(DataError) as caught:
        reader(path)
    where = f"{path}:{line}: " if line else f"{path}: "
    assert str(caught.value).startswith(where) and words in str(caught.value)


def test_lab_with_three_to_five_columns(tmp_path):
    """Catches swapped apex and word, and Windows line ends or a byte order mark that break the first line."""
    path = put(tmp_path, "a.lab", "\ufeff0 0.1 SIL\r\n0.1 0.25 B 0.2\r\n\r\n0.25 0.3 IH .27 bin\r\n")
    segments = read_lab(path)
    assert rows(segments) == [(0, 0.1, "SIL"), (0.1, 0.25, "B"), (0.25, 0.3, "IH")]
    assert [(s.apex, s.word, s.line) for s in segments] == [(None, None, 1), (0.2, None, 2), (0.27, "bin", 4)]


def test_phseg_frames_are_inclusive_and_tile(tmp_path):
    """Catches end = EFrm/100, which leaves a 10 ms hole after each phone, and context read as the phone."""
    segments = read_phseg(put(tmp_path, "a.phseg", PHSEG))
    assert rows(segments) == [(0, 0.12, "SIL"), (0.12, 0.2, "HH")]


def test_flite_times_are_ends(tmp_path):
    """Catches end times that are taken for durations."""
    path = put(tmp_path, "a.psdur", "pau:0.220 hh:0.295 ax:0.342 \n")
    assert rows(read_flite(path)) == [(0, 0.22, "pau"), (0.22, 0.295, "hh"), (0.295, 0.342, "ax")]
    fails(read_flite, put(tmp_path, "b.psdur", "pau:0.2 hh:0.1"), 1, "before the phoneme before it")
    fails(read_flite, put(tmp_path, "c.psdur", "pau 0.2"), 1, "label:seconds")


def test_pho_durations_add_up_without_drift(tmp_path):
    """Catches comments read as phonemes, pitch points read as durations, and sums of seconds that drift."""
    text = "; hello\n_ 50\nh 60 50 120 ; comment\n" + "a 1\n" * 1000
    segments = read_pho(put(tmp_path, "a.pho", text))
    assert rows(segments)[:2] == [(0, 0.05, ""), (0.05, 0.11, "h")] and segments[-1].end == 1.11
    fails(read_pho, put(tmp_path, "b.pho", "_ 50\na -5\n"), 2, "'-5' is not a duration")
    fails(read_pho, put(tmp_path, "c.pho", "_ 50\na\n"), 2, "'a' has no duration")
    fails(read_pho, put(tmp_path, "d.pho", "_ 50 10 x\n"), 1, "pitch point")


@pytest.mark.parametrize("text", [LONG, SHORT], ids=["long", "short"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_textgrid_forms_and_encodings(tmp_path, text, encoding):
    """Catches the words tier being taken for the phones, and a lost unlabelled interval at the end."""
    path = put(tmp_path, "a.TextGrid", text, encoding)
    assert rows(read_textgrid(path)) == [(0, 0.25, "AH0"), (0.25, 0.75, "B"), (0.75, 1, "")]


@pytest.mark.parametrize("name, text, count", [
    ("a.LAB", "0 1 A\n", 1), ("a.textgrid", SHORT, 3), ("a.txt", SHORT, 3), ("a.txt", PHSEG, 2), ("a.pho", "_ 50\n", 1),
    ("a.txt", "pau:0.2 hh:0.3\n", 2), ("a.txt", "0 .1 A\n", 1), ("a.txt", "; x\n_ 50\na 50 50 120\n", 2),
])  # fmt: skip
def test_format_is_told_by_suffix_then_content(tmp_path, name, text, count):
    """Catches a format that is only found under its usual name."""
    assert len(read_timings(put(tmp_path, name, text))) == count


def test_unknown_content_and_missing_files(tmp_path):
    """Catches an OSError or UnicodeError that reaches the user bare."""
    fails(read_timings, put(tmp_path, "a.txt", "lorem ipsum\n"), 1, "this is not timings of flite, lab")
    fails(read_timings, tmp_path / "none.lab", None, "")
    fails(read_lab, put(tmp_path, "b.lab", "0 1 é\n", "latin-1"), 1, "not UTF-8 text")


def test_gaps_become_silence_and_rounding_is_closed(tmp_path):
    """Catches segments that do not tile: a late start, a gap, an overlap of rounding, an unlabelled interval."""
    path = put(tmp_path, "a.lab", "0.1 0.2 hh\n0.1995 0.3 AH1 0.25\n0.3004 0.4 l\n0.5 0.6 OW\n")
    segments = phoneme_segments(path, read_lab(path), SPEECH)
    assert [s.label for s in segments] == ["SIL", "HH", "AH", "L", "SIL", "OW"]
    assert segments[0].start == 0 and all(a.end == b.start for a, b in zip(segments, segments[1:]))
    grid = put(tmp_path, "a.TextGrid", LONG)
    assert [s.label for s in phoneme_segments(grid, read_textgrid(grid), SPEECH)] == ["AH", "B", "SIL"]


def test_unknown_labels_are_named_with_their_place(tmp_path):
    """Catches an unknown label that becomes silence or an error without a line."""
    path = put(tmp_path, "a.lab", "0 0.1 hh\n0.1 0.2 XX\n")
    fails(lambda p: phoneme_segments(p, read_lab(p), SPEECH), path, 2, "'XX'")
    grid = put(tmp_path, "a.TextGrid", LONG.replace('"B"', '"XX"'))
    fails(lambda p: phoneme_segments(p, read_textgrid(p), SPEECH), grid, 32, "'XX'")
    with pytest.warns(UserWarning) as caught:
        segments = phoneme_segments(path, [*read_lab(path), *read_lab(put(tmp_path, "b.lab", "0.2 0.3 XX\n"))], SPEECH,
                                    strict=False)
    assert [s.label for s in segments] == ["HH", "HH", "HH"] and len(caught) == 1
    assert f"{path}:2: " in str(caught[0].message) and "'XX'" in str(caught[0].message)


def test_htk_labels_with_and_without_context(tmp_path):
    """Catches the unit of 100 ns, a phoneme cut at the wrong signs, and HTK's .lab taken for seconds."""
    text = ("0 2200000 x^x-pau+m=ay@1_2/A:0_0/C:1+0+2\n2200000 2900000 pau-m+ay\n2900000 4400000 ay+b -12.5\n"
            "4400000 5000000 m-b\n5000000 6000000 +BREATH+\n6000000 6500000 h#\n")
    expected = [(0, 0.22, "pau"), (0.22, 0.29, "m"), (0.29, 0.44, "ay"), (0.44, 0.5, "b"), (0.5, 0.6, "+BREATH+"),
                (0.6, 0.65, "h#")]
    path = put(tmp_path, "a.lab", text)
    assert rows(read_htk(path)) == rows(read_lab(path)) == rows(read_timings(path)) == expected
    assert rows(read_timings(put(tmp_path, "a.txt", text))) == expected
    assert rows(read_lab(put(tmp_path, "b.lab", "0 1 sil\n1 2 b\n"))) == [(0, 1, "sil"), (1, 2, "b")]


def test_mary_times_are_ends_and_labels_x_sampa(tmp_path):
    """Catches durations read as starts, a comment read as data, and MARY's S read as ARPABET's."""
    text = "#\n0.1 125 _\n0.25 125 S\n# more\n0.4 125 V\n0.5 125 N\n"
    for name in ("a.realised_durations", "a.txt"):
        path = put(tmp_path, name, text)
        assert rows(read_timings(path)) == rows(read_mary(path)) == [
            (0, 0.1, "_"), (0.1, 0.25, "S"), (0.25, 0.4, "V"), (0.4, 0.5, "N")]
        assert [s.label for s in phoneme_segments(path, read_mary(path), SPEECH)] == ["SIL", "SH", "AH", "NG"]
    fails(read_mary, put(tmp_path, "b.txt", "#\n0.1 125\n"), 2, "2 fields")
    fails(read_mary, put(tmp_path, "b.txt", "#\n0.2 125 a\n0.1 125 b\n"), 3, "before the phoneme before it")
    fails(read_mary, put(tmp_path, "b.txt", "#\n0.2 x a\n"), 2, "'x'")


def test_mbrola_labels_are_x_sampa(tmp_path):
    """Catches MBROLA's N read as ARPABET's, and its flush mark read as a phoneme."""
    path = put(tmp_path, "a.pho", "_ 50\nT 50\nI 50\nN 50\n#\n")
    assert [s.label for s in phoneme_segments(path, read_pho(path), SPEECH)] == ["SIL", "TH", "IH", "NG"]
