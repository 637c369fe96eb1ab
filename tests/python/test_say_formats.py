"""labial-say's formats: every one of timings gives the motion that its times say, and the exporter reads it alike."""

from __future__ import annotations

import random
import warnings
from pathlib import Path
from typing import List, Tuple

import pytest

from labial.__main__ import main
from labial.corpus.formats import read_timings
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import phoneme_segments
from labial.errors import DataError
from labial.see.motion import read_bands
from packages import SOURCE
from test_say import motion, pytestmark, say

__all__ = ["pytestmark"]

SEEDS = SOURCE / "tests/fuzz/seeds/fuzz_timings"
#: The same sentence in every format.
SENTENCE = ["sentence.psdur", "sentence.lab", "sentence.pho", "sentence.realised_durations", "sentence.phseg",
            "htk.lab", "hts.lab", "aligned.TextGrid", "short.TextGrid", "utf16.TextGrid", "points.TextGrid"]
FORMATS = {".psdur": "flite", ".pho": "pho", ".realised_durations": "mary", ".phseg": "phseg", ".TextGrid": "textgrid"}
PHRASE = [("SIL", 220), ("M", 70), ("AY", 150), ("B", 90), ("EY", 200), ("B", 80), ("IY", 90), ("SIL", 220)]


def lab(phrase: List[Tuple[str, int]]) -> str:
    """`phrase` as lines of start, end and label."""
    text, at = "", 0
    for label, duration in phrase:
        text += f"{at / 1000:.3f} {(at + duration) / 1000:.3f} {label}\n"
        at += duration
    return text


@pytest.mark.parametrize("name", SENTENCE)
def test_one_sentence_in_every_format(name: str) -> None:
    """Catches a unit, an inclusive end, a tier or a phone set that is misread, and a format taken for another."""
    data = (SEEDS / name).read_bytes()
    expected = motion(lab(PHRASE))
    assert len({tuple(row[1:]) for row in expected}) > 20, "a mouth that does not move proves nothing"
    assert motion(data) == expected
    named = "htk" if name in ("htk.lab", "hts.lab") else FORMATS.get(Path(name).suffix, "lab")
    assert motion(data, "--from", named) == expected


@pytest.mark.parametrize("name", SENTENCE)
def test_library_and_exporter_read_alike(name: str) -> None:
    """Catches a reader of one of the two that does otherwise: the sentence is known from neither."""
    segments = phoneme_segments(SEEDS / name, read_timings(SEEDS / name), SPEECH)
    bounds = [round(1000 * segment.end) for segment in segments]
    found = [(s.label, end - begin) for s, begin, end in zip(segments, [0, *bounds], bounds)]
    assert found == PHRASE


@pytest.mark.parametrize("name", SENTENCE)
def test_line_ends_and_byte_order_marks(name: str) -> None:
    """Catches carriage returns, a missing last line feed or a mark of the encoding that change the motion."""
    data = (SEEDS / name).read_bytes()
    if name.startswith("utf16"):
        text = data.decode("utf-16")
        assert motion(text) == motion(text.encode("utf-16-le").join([b"\xff\xfe", b""])) == motion(data)
        return
    text = data.decode()
    assert motion(text.replace("\n", "\r\n")) == motion(text)
    assert motion(text.rstrip()) == motion(text)
    assert motion(b"\xef\xbb\xbf" + data) == motion(text)
    assert motion(text.encode("utf-16")) == motion(text)


def test_a_tier_is_taken_by_name() -> None:
    """Catches a tier that is not the one asked for, and a wish that is passed over in silence."""
    grid = (SEEDS / "aligned.TextGrid").read_text(encoding="utf-8")
    assert motion(grid, "--tier", "phones") == motion(grid)
    done = say(grid, "--tier", "words")
    assert done.returncode == 0 and b"no phoneme '\"baby\"'" in done.stderr
    done = say(grid, "--tier", "letters")
    assert done.returncode == 1 and done.stderr == b"labial-say: line 69: there is no interval tier 'letters'\n"


@pytest.mark.parametrize(("name", "old", "new", "line", "told"), [
    ("htk.lab", "2900000", "2900000.5", 2, "100 ns"),
    ("htk.lab", "2900000 4400000", "4400000 2900000", 3, "before its"),
    ("htk.lab", "2200000 2900000 m", "2100000 2900000 m", 2, "0.210000"), ("htk.lab", " m -123.4", "", 2, "2 fields"),
    ("sentence.realised_durations", "125 m", "125", 3, "2 fields"),
    ("sentence.realised_durations", "0.29 125", "0.29 x", 3, "'x'"),
    ("sentence.realised_durations", "0.44 125", "0.24 125", 4, "before the"),
    ("sentence.phseg", "EFrm", "EFrn", 1, "header"), ("sentence.phseg", "    22    28", "    2x    28", 3, "'2x'"),
    ("sentence.phseg", "    22    28", "    28    22", 3, "before its first"),
    ("sentence.phseg", " Total", " Total score: 1\n Total", 11, "last line"),
    ("aligned.TextGrid", "xmin = 0.29", "xmin = 0,29", 46, "'0,29'"),
    ("aligned.TextGrid", "xmin = 0.29", "xmin = -0.29", 46, "'-0.29'"),
    ("aligned.TextGrid", "xmin = 0.29", "xmin = 0.2", 48, "0.200000"),
    ("aligned.TextGrid", "size = 8", "size = 9", 69, "ends before"),
    ("aligned.TextGrid", "size = 8", "size = 7", 66, "end of the file"),
    ("aligned.TextGrid", "size = 4", "size = 3", 28, "a tier's class"),
    ("aligned.TextGrid", '"IntervalTier"', '"Tier"', 10, "'Tier'"),
    ("aligned.TextGrid", '"TextGrid"', '"PitchTier"', 2, "TextGrid"),
    ("aligned.TextGrid", 'text = "M"', 'text = "M', 48, "'M          intervals"),
    ("aligned.TextGrid", 'text = "M"', 'text = "' + "M" * 64 + '"', 44, "63"),
])  # fmt: skip
def test_malformed_files_are_named(name: str, old: str, new: str, line: int, told: str) -> None:
    """Catches a slip in a file that passes for motion, and an error that does not say where."""
    text = (SEEDS / name).read_text(encoding="utf-8")
    assert old in text
    done = say(text.replace(old, new))
    assert done.returncode == 1
    assert done.stderr.decode().startswith(f"labial-say: line {line}: ") and told in done.stderr.decode()
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize("data", [b"\xff\xfea", b"\xfe\xff\xd8\x00\x00a", b"\xff\xfe\x00\xdc", b"\xff\xfe\x3d\xd8",
                                  b"\xff\xfe\x00\x00", b"\xef\xbb"])  # fmt: skip
def test_broken_encodings_are_errors(data: bytes) -> None:
    """Catches half characters of UTF-16 that become labels."""
    done = say(data)
    assert done.returncode == 1 and done.stderr.startswith(b"labial-say: line 1: ")


def test_labels_are_read_as_the_format_means_them() -> None:
    """Catches X-SAMPA's S and N read as ARPABET's in a format of X-SAMPA, or the other way round."""
    phrase = [("a", 100), ("S", 90), ("N", 100), ("i", 100)]
    sampa = motion("a 100\nS 90\nN 100\ni 100\n")
    assert sampa == motion(lab([("AE", 100), ("SH", 90), ("NG", 100), ("IY", 100)]))
    assert motion(lab(phrase), "--labels=xsampa") == sampa != motion(lab(phrase))
    assert motion("pau 100\nay 90\n") == motion(lab([("pau", 100), ("ay", 90)])), "what is no X-SAMPA is any set's"


def jaw(rows: List[List[str]], start: float, end: float) -> List[int]:
    """FAP 3 between two times."""
    return [int(row[1]) for row in rows if start <= float(row[0]) < end]


def openings(values: List[int]) -> int:
    """How often the jaw opens past the middle of its range, which is 0 when it hardly moves."""
    middle = (min(values) + max(values)) / 2
    return sum(a < middle <= b for a, b in zip(values, values[1:])) if max(values) - min(values) > 40 else 0


@pytest.mark.parametrize(("text", "start", "end", "total"), [
    ("pau:0.200 <laugh 2.0 0.7> m:0.300 ay:0.500\n", 0.2, 2.2, 2.5),
    ("pau:0.200 <laugh:0.7>:2.200 m:2.300 ay:2.500\n", 0.2, 2.2, 2.5),
    ("<laugh 2.0>\npau:0.200 m:0.300 ay:0.500\n", 0.0, 2.0, 2.5),
    ("pau:0.2\n<laugh 2.0 1>\nm:0.1 ay:0.3\n", 0.2, 2.2, 2.5),
    ("0.0 0.2 sil\n<laugh 2.0 0.7>\n0.2 0.3 m\n0.3 0.5 ay\n", 0.2, 2.2, 2.5),
    ("0.0 0.2 sil\n0.2 2.2 <laugh:0.7>\n2.2 2.3 m\n2.3 2.5 ay\n", 0.2, 2.2, 2.5),
    ("0 2000000 sil\n2000000 22000000 <laugh>\n22000000 23000000 m\n23000000 25000000 ay\n", 0.2, 2.2, 2.5),
    ("_ 200\n<laugh 2.0 0.7>\nm 100\nAI 200\n", 0.2, 2.2, 2.5),
    ("_ 200\n<laugh:0.7> 2000\nm 100\nAI 200\n", 0.2, 2.2, 2.5),
    ("#\n0.2 125 _\n<laugh 2.0 0.7>\n0.3 125 m\n0.5 125 AI\n", 0.2, 2.2, 2.5),
])  # fmt: skip
def test_laughs_in_every_stream(text: str, start: float, end: float, total: float) -> None:
    """Catches a laugh that is not one, takes another time than it was given, or does not shift what follows."""
    rows = motion(text)
    assert len(rows) == round(50 * total)
    assert openings(jaw(rows, start, end)) >= 3, "pulses every 210 ms open the jaw"
    silent = motion(lab([("SIL", round(1000 * total))]))
    assert openings(jaw(silent, start + 0.4, end)) == 0, "once the mouth has come to rest"
    assert motion(text) == rows


def test_intensity_of_laughs() -> None:
    """Catches an intensity that is not passed on, and a default that is not the middle."""
    texts = {name: motion(f"pau:0.1 {name} pau:0.2\n") for name in
             ("<laugh 4>", "<laugh 4 0.5>", "<laugh 4 1>", "<laugh 4 0>", "<laugh 4.0 0.500>")}
    assert texts["<laugh 4>"] == texts["<laugh 4 0.5>"] == texts["<laugh 4.0 0.500>"]
    assert texts["<laugh 4 0>"] != texts["<laugh 4 0.5>"] != texts["<laugh 4 1>"]
    assert sum(jaw(texts["<laugh 4 0>"], 0, 9)) < sum(jaw(texts["<laugh 4 1>"], 0, 9))


def test_laughs_of_one_stream_differ() -> None:
    """Catches a toy that always laughs the same laugh."""
    rows = motion("<laugh:0.5> 2000\n_ 1000\n<laugh:0.5> 2000\n_ 1000\n")
    assert jaw(rows, 0.5, 1.5) != jaw(rows, 3.5, 4.5)


@pytest.mark.parametrize(("text", "told"), [
    ("pau:0.1 <laugh> \n", "form"), ("pau:0.1 <laugh 1 0.5\n", "'>'"), ("pau:0.1 <laugh 1 2>\n", "0 to 1"),
    ("pau:0.1 <laugh x 0.5>\n", "'x'"), ("pau:0.1 <laugh 1 2 3 4>\n", "expected"),
    ("_ 10\n<laugh:1.5> 100\n", "0 to 1"),
    ("_ 10\n<laugh:> 100\n", "intensity"), ("pau:0.1 <laugh 4000>\n", "hour"), ("<laugh >\n", "laugh"),
    ("0.0 0.1 sil\n<laugh 99999999>\n", "99999999"),
])  # fmt: skip
def test_malformed_laughs_are_named(text: str, told: str) -> None:
    """Catches a slip in a laugh that is read as something else."""
    done = say(text)
    assert done.returncode == 1 and told in done.stderr.decode()


@pytest.mark.parametrize("name", sorted(path.name for path in SEEDS.iterdir()))
def test_damaged_files_are_data_errors(name: str, tmp_path: Path) -> None:
    """Catches damage that reaches the user of the exporter as another error than one with the file's name, and that
    labial-say takes otherwise than as motion or an error with its line."""
    data = (SEEDS / name).read_bytes()
    rng = random.Random(name)
    for number in range(40):
        damaged = bytearray(data)
        for _ in range(rng.randint(1, 3)):
            at = rng.randrange(len(damaged))
            patch = rng.choices(b'0123456789.:- \n"<>#;aZ\xc9\x00', k=rng.randint(0, 3))
            damaged[at : at + rng.randint(0, 6)] = bytes(patch)
        path = tmp_path / name
        path.write_bytes(damaged)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                phoneme_segments(path, read_timings(path), SPEECH, strict=False)
            except DataError as error:
                assert str(error).startswith(str(path))
        if number < 8:
            done = say(bytes(damaged))
            assert done.returncode in (0, 1)
            if done.returncode == 1:
                assert done.stderr.splitlines()[-1].startswith(b"labial-say: line ")


def test_a_label_means_what_its_set_means() -> None:
    """Catches an option that changes nothing, and a set that takes another one's labels without a word."""
    rows = lab([("sil", 100), ("y", 150), ("th", 90), ("sil", 100)])
    assert motion(rows, "--labels", "ipa") == motion(rows.replace("y", "uw").replace("th", "t"))
    assert motion(rows, "--labels", "arpabet") == motion(rows, "--labels", "auto") == motion(rows)
    for labels, label in (("ipa", "hh"), ("ipa", "2"), ("ipa", "ʲ"), ("ipa", "@"), ("arpabet", "ə"), ("xsampa", "ʃ"),
                          ("auto", "2"), ("auto", "ː")):
        done = say(lab([("sil", 100), (label, 100), ("sil", 100)]), "--labels", labels)
        assert done.returncode == 0 and f"no phoneme '{label}'" in done.stderr.decode(), (labels, label)
    assert say(rows, "--labels", "sampa").returncode == 2


def test_the_exporter_reads_labels_as_labial_say_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Catches a set of labels that only one of the two knows, and an option of `labial` that is not handed on."""
    model, phones = SOURCE / "export/models/speech_en.npz", tmp_path / "a.lab"
    phones.write_text("0 0.1 sil\n0.1 0.3 y\n0.3 0.4 sil\n", encoding="utf-8")
    moved = {}
    for labels in ("auto", "arpabet", "ipa", "xsampa"):
        assert main(["synth", str(model), str(phones), "--labels", labels]) == 0
        moved[labels] = capsys.readouterr().out
    assert moved["auto"] == moved["arpabet"] != moved["ipa"] == moved["xsampa"]
    assert [band.label for band in read_bands(phones, "ipa")] == ["SIL", "UW", "SIL"]
    assert [band.label for band in read_bands(phones)] == ["SIL", "Y", "SIL"]
