"""Readers of what speech services tell: samples of each, and what is wrong in such a file.

services/README.md says where the samples come from.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, List, Tuple

import pytest

from labial.__main__ import main
from labial.corpus.formats import as_lab, read_timings
from labial.corpus.services import LAST_VISEME, LONGEST_BLANK, phonemes_of
from labial.corpus.timings import SourceSegment, read_segments
from labial.errors import DataError
from labial.see.motion import read_bands

SAMPLES = Path(__file__).with_name("services")
PIPER = "SIL B AA B SIL M AY JH AH JH M EY CH UW SIL F AY V D EY Z G OW B AY SIL"
#: What each sample says, by hand from the words that it is of.
WORDS = {
    "piper.json": ("piper", PIPER), "piper_info.json": ("piper", PIPER),
    "azure.json": ("azure", "SIL SIL P AA P W OW CH EY SIL"), "polly.marks": ("polly", "SIL P AE P P EY SIL W IH SIL"),
    "headtts.json": ("headtts", "SIL M AY OW M SIL B AA B"),
    "kokoro.json": ("kokoro", "SIL M AY HH OW M SIL B ER D SIL"),
    "plain.json": ("json", "SIL M AA SIL P"),
}  # fmt: skip


def phonemes(path: Path, source: Any = None) -> List[Tuple[float, float, str]]:
    """Start, end and phoneme, as `labial timings` tells them."""
    rows = [line.split() for line in as_lab(path, source=source).splitlines()]
    return [(float(start), float(end), label) for start, end, label in rows]


def put(folder: Path, content: Any, name: str = "a.json") -> Path:
    path = folder / name
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", WORDS)
def test_sample_is_told_by_itself(name: str, tmp_path: Path) -> None:
    """Catches a format that is taken for another, phonemes that get lost, and a .lab that is read back otherwise."""
    source, words = WORDS[name]
    found = phonemes(SAMPLES / name)
    assert [label for _, _, label in found] == words.split()
    assert all(before[1] == after[0] for before, after in zip(found, found[1:])) and found[0][0] == 0
    assert found == phonemes(SAMPLES / name, source)
    assert main(["timings", str(SAMPLES / name), "--from", source, "-o", str(tmp_path / "a.lab")]) == 0
    assert [(s.start, s.end, s.label) for s in read_segments(tmp_path / "a.lab", "lab")] == found
    bands = [band.label for band in read_bands(SAMPLES / name) if band.kind != "silence"]
    assert bands == [word for word in words.split() if word != "SIL"]


def test_piper_counts_every_sample() -> None:
    """Catches marks, blanks and pauses whose time is lost: the second sentence begins with the second chunk."""
    chunks = json.loads((SAMPLES / "piper.json").read_text(encoding="utf-8"))
    lengths = [sum(part["num_samples"] for part in chunk["phoneme_alignments"]) / 22050 for chunk in chunks]
    found = phonemes(SAMPLES / "piper.json")
    pause = [item for item in found if item[2] == "SIL"][2]
    assert found[-1][1] == pytest.approx(sum(lengths), abs=1e-4)
    assert pause[0] < lengths[0] < pause[1]
    first = chunks[0]["phoneme_alignments"]
    assert [part["phoneme"] for part in first[:5]] == ["^", "b", "ˈ", "ɑ", "ː"]
    assert found[2][1] - found[2][0] == pytest.approx(sum(p["num_samples"] for p in first[2:5]) / 22050, abs=2e-4)


def test_piper_info_is_the_chunks() -> None:
    for one, other in zip(phonemes(SAMPLES / "piper.json"), phonemes(SAMPLES / "piper_info.json")):
        assert one == pytest.approx(other, abs=2e-4)


def test_visemes_begin_where_they_are_told() -> None:
    """Catches ticks taken for milliseconds, pairs that lose a half, and a last viseme that has no end."""
    azure, polly = phonemes(SAMPLES / "azure.json"), phonemes(SAMPLES / "polly.marks")
    assert (0.48, 0.61, "OW") in azure and (0.7, 0.84, "EY") in azure
    assert azure[-1] == (0.84, 0.84 + LAST_VISEME, "SIL")
    assert polly[1] == (0.025, 0.11, "P") and polly[-1][:2] == (0.85, 0.95)


def test_headtts_and_kokoro_times() -> None:
    """Catches overlaps that shift what follows, an h or a blank that shuts the mouth, and frames of another rate."""
    headtts, kokoro = phonemes(SAMPLES / "headtts.json"), phonemes(SAMPLES / "kokoro.json")
    assert headtts[2:4] == [(0.53, 0.745, "AY"), (0.745, 0.9, "OW")] and headtts[5] == (1.02, 1.2, "SIL")
    assert kokoro[1] == (0.45, 0.55, "M") and kokoro[-1][1] == pytest.approx(101 / 40)


@pytest.mark.parametrize("shape", [
    [{"privAudioOffset": 500000, "privVisemeId": 21}, {"privAudioOffset": 900000, "privVisemeId": 2}],
    '{"AudioOffset": 500000, "VisemeId": 21}\n\n{"AudioOffset": 900000, "VisemeId": 2}\n',
    [{"audioOffset": 500000, "visemeId": "21"}, {"audioOffset": 900000, "visemeId": "2"}],
])  # fmt: skip
def test_azure_events_of_any_library(tmp_path: Path, shape: Any) -> None:
    expected = [(0, 0.05, "SIL"), (0.05, 0.09, "P"), (0.09, 0.19, "AA")]
    assert phonemes(put(tmp_path, shape)) == expected


def test_headtts_message_and_a_row_of_answers(tmp_path: Path) -> None:
    one = json.loads((SAMPLES / "headtts.json").read_text(encoding="utf-8"))
    found = phonemes(put(tmp_path, [{"type": "audio", "ref": 1, "data": one}, one]))
    assert [label for _, _, label in found] == WORDS["headtts.json"][1].split() * 2
    assert found[-1][1] == pytest.approx(2 * 1.6)


def tokens(text: str, seconds: float = 0.05) -> List[SourceSegment]:
    return [SourceSegment(seconds * i, seconds * (i + 1), label) for i, label in enumerate(text.split("|"))]


@pytest.mark.parametrize(("text", "labels"), [
    ("a|ɪ", "aɪ"), ("a|ː|ɪ", "aː ɪ"), ("a|ˈ|ɪ", "a ɪ"), ("t| |ʃ", "t ʃ"), ("t|ʃ|ʰ|ɚ", "tʃʰ ɚ"), ("ɔ|̃|.", "ɔ̃ _"),
    ("^|_|ˈ|ɑ|$", "_ ɑ _"), ("k|,| |k", "k _ k"), ("ˈ|.|a", "_ a"), ("ː|a", "_ a"),
])  # fmt: skip
def test_characters_become_phonemes(text: str, labels: str) -> None:
    """Catches two vowels of two syllables that become one, and marks that become phonemes or lose their time."""
    found = phonemes_of(tokens(text))
    if text == "ː|a":  # a mark at the beginning belongs to nothing
        assert found[-1].label == "a"
        return
    assert [segment.label or "_" for segment in found] == labels.split()
    assert found[-1].end == pytest.approx(0.05 * len(text.split("|")))
    if text == "a|ˈ|ɪ":
        assert found[1].start == pytest.approx(0.05)


def test_long_blank_is_a_pause() -> None:
    short, long = phonemes_of(tokens("m| |m", LONGEST_BLANK - 0.01)), phonemes_of(tokens("m| |m", LONGEST_BLANK + 0.01))
    assert [item.label for item in short] == ["m", "m"] and [item.label for item in long] == ["m", "", "m"]


CHUNK = {"sample_rate": 100, "phoneme_alignments": [{"phoneme": "m", "num_samples": 5}]}


@pytest.mark.parametrize(("source", "content", "line", "words"), [
    ("json", "", 1, "not JSON"), ("json", "[{]", 1, "not JSON"), ("json", "[\n{\n", 3, "not JSON"),
    ("json", "{}\n{]\n", 2, "not JSON"), ("json", "[]", None, "no segments"), ("json", "[1]", None, "entry 1"),
    ("json", "[" * 100000, None, "deeply"), ("json", "9" * 5000, None, "digits"),
    ("json", [{"phoneme": "m", "start": 0}], None, "entry 1: no field 'end'"),
    ("json", [{"phoneme": 1, "start": 0, "end": 1}], None, "not text"),
    ("json", [{"phoneme": "m", "start": True, "end": 1}], None, "not a number"),
    ("json", '[{"phoneme": "m", "start": 0, "end": NaN}]', None, "not a number"),
    ("json", '[{"phoneme": "m", "start": 0, "end": 1' + "0" * 400 + "}]", None, "not a number"),
    ("json", [{"phoneme": "m", "start": 1, "end": 0}], None, "before its start"),
    ("piper", [{"phoneme": "m", "num_samples": 5}], None, "sample_rate"),
    ("piper", {**CHUNK, "sample_rate": 0}, None, "sample_rate"),
    ("piper", {**CHUNK, "phoneme_alignments": None}, None, "include_alignments"),
    ("piper", {**CHUNK, "phoneme_alignments": [{"phoneme": "m", "num_samples": -1}]}, None, "entry 1"),
    ("piper", {"voice": {}, "last": None}, None, "/synthesize"),
    ("azure", [{"audio_offset": 0, "viseme_id": 22}], None, "'22'"),
    ("azure", [{"audio_offset": 9, "viseme_id": 2}, {"audio_offset": -1, "viseme_id": 0}], None, "entry 2"),
    ("azure", [{"audio_offset": 90000, "viseme_id": 2}, {"audio_offset": 1, "viseme_id": 0}], None, "before its start"),
    ("polly", '{"time":0,"type":"ssml","value":"a"}', None, "no speech marks of type 'viseme' or 'word'"),
    ("polly", '{"time":0,"type":"viseme","value":"p"}\n{"time":5,"type":"viseme","value":"?"}\n', 2, "'?'"),
    ("headtts", {"phonemes": ["m"], "vtimes": [0, 1], "vdurations": [5]}, None, "one length"),
    ("headtts", {"phonemes": [1], "vtimes": [0], "vdurations": [5]}, None, "one length"),
    ("kokoro", {"phonemes": "ma", "pred_dur": [1, 2, 3]}, None, "3 durations for 2 characters"),
])  # fmt: skip
def test_malformed_files(tmp_path: Path, source: str, content: Any, line: Any, words: str) -> None:
    """One line that names the file, the line where there is one, and what is wrong."""
    path = put(tmp_path, content)
    with pytest.raises(DataError) as caught:
        read_timings(path, source)
    text = str(caught.value)
    assert text.startswith(f"{path}:{line}: " if line else f"{path}: ") and words in text and "\n" not in text


def test_other_json_is_no_timings(tmp_path: Path) -> None:
    for content in ("[]", "{}", '{"phonemes": []}', "[[]]"):
        with pytest.raises(DataError):
            read_timings(put(tmp_path, content))


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Without -o the phonemes go to standard output; the same readers serve synth; --from settles the format."""
    model = Path(__file__).parents[2] / "export" / "models" / "speech_en.npz"
    assert main(["timings", str(SAMPLES / "plain.json")]) == 0
    assert capsys.readouterr().out.splitlines()[1] == "0.1200 0.2000 M"
    assert main(["synth", str(model), str(SAMPLES / "azure.json"), "-o", str(tmp_path / "a.csv")]) == 0
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 1 + 47 + 12
    assert main(["timings", str(SAMPLES / "azure.json"), "--from", "polly"]) == 1
    assert "no field 'type'" in capsys.readouterr().err
