"""Readers of what speech services tell: samples of each, and what is wrong in such a file.

services.json has the samples; those of words say "Maybe, go." from 0.1 to 0.5 s and from 0.75 to 1 s.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest

import labial
from labial.__main__ import main
from labial.corpus.formats import LAST_VISEME, _phonemes_of, as_lab, read_timings
from labial.corpus.services import SERVICES
from labial.corpus.timings import SourceSegment, read_segments
from labial.errors import DataError
from labial.see.motion import read_bands
from messages import SAMPLES
from packages import needs_runtime

pytestmark = needs_runtime
#: Samples that tell no ends of words, that tell phonemes, and that tell characters.
OPEN = ("polly_words", "google")
SOUNDS = ("cartesia_phonemes", "inworld", "hume")
CHARACTERS = ("elevenlabs", "elevenlabs_ws", "soniox", "resemble", "xai")
SPOKEN = [name for name, sample in SAMPLES.items() if sample.phonemes.startswith("SIL M EY")]


def phonemes(path: Path, source: Any = None) -> List[Tuple[float, float, str]]:
    """Start, end and phoneme, as `labial timings` tells them."""
    rows = [line.split() for line in as_lab(path, source=source).splitlines()]
    return [(float(start), float(end), label) for start, end, label in rows]


def put(folder: Path, content: Any, name: str = "a.json") -> Path:
    path = folder / name
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


def of_sample(folder: Path, name: str) -> List[Tuple[float, float, str]]:
    """The phonemes of a sample."""
    return phonemes(put(folder, SAMPLES[name].text))


def test_every_service_has_a_sample() -> None:
    """A service of the table that nothing reads would be untested."""
    assert {sample.service for sample in SAMPLES.values()} == set(SERVICES)
    assert all(service.title and service.source for service in SERVICES.values())


@pytest.mark.parametrize("name", SAMPLES)
def test_sample_is_told_by_itself(name: str, tmp_path: Path) -> None:
    """Catches a format that is taken for another, phonemes that get lost, and a .lab that is read back otherwise."""
    source, words = SAMPLES[name].service, SAMPLES[name].phonemes
    path = put(tmp_path, SAMPLES[name].text)
    found = phonemes(path)
    assert [label for _, _, label in found] == words.split()
    assert all(before[1] == after[0] for before, after in zip(found, found[1:])) and found[0][0] == 0
    assert found == phonemes(path, source) == phonemes(put(tmp_path, SAMPLES[name].messages), source)
    assert main(["timings", str(path), "--from", source, "-o", str(tmp_path / "a.lab")]) == 0
    assert [(s.start, s.end, s.label) for s in read_segments(tmp_path / "a.lab", "lab")] == found
    bands = [band.label for band in read_bands(path) if band.kind != "silence"]
    assert bands == [word for word in words.split() if word != "SIL"]


@pytest.mark.parametrize("name", SPOKEN)
def test_words_are_in_time(name: str, tmp_path: Path) -> None:
    """Catches a word that is lost, a unit or an origin that is mistaken."""
    ends = [end for _, end, _ in of_sample(tmp_path, name)]
    assert ends[0] == 0.1 and ends[5] == 0.75
    if name not in OPEN:
        assert ends[4] == pytest.approx(0.55 if name in CHARACTERS else 0.5, abs=1e-9) and ends[7] == 1.0
    if name in SOUNDS:
        assert ends[1:4] == [0.17, 0.3, 0.36]
    else:
        assert all(before < after for before, after in zip(ends, ends[1:]))


def test_words_and_characters_differ_by_what_is_told(tmp_path: Path) -> None:
    """The characters of the samples are not equally long, so that they move the boundaries of phonemes."""
    words = of_sample(tmp_path, "words")
    assert words == of_sample(tmp_path, "cartesia")
    spelt = of_sample(tmp_path, "elevenlabs")
    assert spelt == of_sample(tmp_path, "elevenlabs_ws") and spelt[1:4] != words[1:4]


def test_utterances_follow_each_other(tmp_path: Path) -> None:
    """Catches a second context whose times, which begin at 0 again, fall into the first one, and a rounded begin that
    is taken for another beginning."""
    def stamps(context: str, *words: Tuple[str, float, float]) -> Dict[str, Any]:
        texts, starts, ends = zip(*words)
        return {"context_id": context, "word_timestamps": {"words": texts, "start": starts, "end": ends}}

    for service, begin in {"cartesia": 0.3, "rime": 0.299}.items():
        rows = [("go", 0.0, 0.3), ("go", begin, 0.6)]
        one = [stamps("a", row) for row in rows]
        two = [*one, stamps("b", ("go", 0.0, 0.3))]
        assert [end for _, end, _ in phonemes(put(tmp_path, one), service)][-1] == 0.6
        assert [end for _, end, _ in phonemes(put(tmp_path, two), service)][-1] == 0.9


def test_piper_counts_every_sample(tmp_path: Path) -> None:
    """Catches marks, blanks and pauses whose time is lost: the second sentence begins with the second chunk."""
    chunks = SAMPLES["piper"].messages
    lengths = [sum(part["num_samples"] for part in chunk["phoneme_alignments"]) / 22050 for chunk in chunks]
    found = of_sample(tmp_path, "piper")
    pause = [item for item in found if item[2] == "SIL"][2]
    assert found[-1][1] == pytest.approx(sum(lengths), abs=1e-4)
    assert pause[0] < lengths[0] < pause[1]
    first = chunks[0]["phoneme_alignments"]
    assert [part["phoneme"] for part in first[:5]] == ["^", "b", "ˈ", "ɑ", "ː"]
    assert found[2][1] - found[2][0] == pytest.approx(sum(p["num_samples"] for p in first[2:5]) / 22050, abs=2e-4)


def test_times_are_those_of_the_sample(tmp_path: Path) -> None:
    """Catches ticks taken for milliseconds, pairs that lose a half, a last viseme that has no end; overlaps that shift
    what follows, an h or a blank that shuts the mouth, and frames of another rate."""
    for one, other in zip(of_sample(tmp_path, "piper"), of_sample(tmp_path, "piper_info")):
        assert one == pytest.approx(other, abs=2e-4)
    azure, polly = of_sample(tmp_path, "azure"), of_sample(tmp_path, "polly")
    assert (0.48, 0.61, "OW") in azure and (0.7, 0.84, "EY") in azure
    assert azure[-1] == (0.84, 0.84 + LAST_VISEME, "SIL")
    assert polly[1] == (0.025, 0.11, "P") and polly[-1][:2] == (0.85, 0.95)
    headtts, kokoro = of_sample(tmp_path, "headtts"), of_sample(tmp_path, "kokoro")
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
    one = SAMPLES["headtts"].messages[0]
    found = phonemes(put(tmp_path, [{"type": "audio", "ref": 1, "data": one}, one]))
    assert [label for _, _, label in found] == SAMPLES["headtts"].phonemes.split() * 2
    assert found[-1][1] == pytest.approx(2 * 1.6)


def tokens(text: str, seconds: float = 0.05) -> List[SourceSegment]:
    return [SourceSegment(seconds * i, seconds * (i + 1), label) for i, label in enumerate(text.split("|"))]


@pytest.mark.parametrize(("text", "labels"), [
    ("a|ɪ", "aɪ"), ("a|ː|ɪ", "aː ɪ"), ("a|ˈ|ɪ", "a ɪ"), ("t| |ʃ", "t ʃ"), ("t|ʃ|ʰ|ɚ", "tʃʰ ɚ"), ("ɔ|̃|.", "ɔ̃ _"),
    ("^|_|ˈ|ɑ|$", "_ ɑ _"), ("k|,| |k", "k _ k"), ("ˈ|.|a", "_ a"),
])  # fmt: skip
def test_characters_become_phonemes(text: str, labels: str) -> None:
    """Catches two vowels of two syllables that become one, and marks that become phonemes or lose their time."""
    found = _phonemes_of(tokens(text))
    assert [segment.label or "_" for segment in found] == labels.split()
    assert found[-1].end == pytest.approx(0.05 * len(text.split("|")))


def test_times_of_marks_and_blanks() -> None:
    """A mark at the beginning belongs to nothing; a blank of more than 150 ms is a pause."""
    assert _phonemes_of(tokens("ː|a"))[-1].label == "a"
    assert _phonemes_of(tokens("a|ˈ|ɪ"))[1].start == pytest.approx(0.05)
    for seconds, labels in ((0.14, ["m", "m"]), (0.16, ["m", "", "m"])):
        assert [item.label for item in _phonemes_of(tokens("m| |m", seconds))] == labels


CHUNK = {"sample_rate": 100, "phoneme_alignments": [{"phoneme": "m", "num_samples": 5}]}


@pytest.mark.parametrize(("source", "content", "line", "words"), [
    ("json", "", 1, "not JSON"), ("json", "[{]", 1, "not JSON"), ("json", "[\n{\n", 3, "not JSON"),
    ("json", "{}\n{]\n", 2, "not JSON"), ("json", "[]", None, "times nothing here"), ("json", "[1]", None, "entry 1"),
    ("json", "[" * 100000, None, "deeply"), ("json", "9" * 5000, None, "digits"),
    ("json", [{"phoneme": "m", "start": 0}], None, "entry 1: no field 'end'"),
    ("json", [{"phoneme": 1, "start": 0, "end": 1}], None, "not text"),
    ("json", [{"phoneme": "m", "start": True, "end": 1}], None, "not a number"),
    ("json", '[{"phoneme": "m", "start": 0, "end": NaN}]', None, "not a number"),
    ("json", '[{"phoneme": "m", "start": 0, "end": 1' + "0" * 400 + "}]", None, "not a number"),
    ("json", [{"phoneme": "m", "start": 1, "end": 0}], None, "before its start"),
    ("piper", [{"phoneme": "m", "num_samples": 5}], None, "samplerate"),
    ("piper", {**CHUNK, "sample_rate": 0}, None, "samplerate"),
    ("piper", {**CHUNK, "phoneme_alignments": None}, None, "include_alignments"),
    ("piper", {**CHUNK, "phoneme_alignments": [{"phoneme": "m", "num_samples": -1}]}, None, "entry 1"),
    ("piper", {"voice": {}, "last": None}, None, "include_alignments"),
    ("azure", [{"audio_offset": 0, "viseme_id": 22}], None, "'22'"),
    ("azure", [{"audio_offset": 9, "viseme_id": 2}, {"audio_offset": -1, "viseme_id": 0}], None, "entry 2"),
    ("azure", [{"audio_offset": 90000, "viseme_id": 2}, {"audio_offset": 1, "viseme_id": 0}], None, "before its start"),
    ("polly", '{"time":0,"type":"ssml","value":"a"}', None, "--speech-mark-types"),
    ("polly", '{"time":0,"type":"viseme","value":"p"}\n{"time":5,"type":"viseme","value":"?"}\n', 2, "'?'"),
    ("headtts", {"phonemes": ["m"], "vtimes": [0, 1], "vdurations": [5]}, None, "one length"),
    ("headtts", {"phonemes": [1], "vtimes": [0], "vdurations": [5]}, None, "not text"),
    ("kokoro", {"phonemes": "ma", "pred_dur": [1, 2, 3]}, None, "not of one length"),
    *((None, text, None, "") for text in ("[]", "{}", '{"phonemes": []}', "[[]]")),
    ("words", [{"word": "a", "start": 1, "end": 2}, {"word": "b", "start": 0, "end": 1}], None,
     "'b' begins before 'a'"),
    ("words", [{"word": "a", "start": 2, "end": 1}], None, "before its start"),
    ("words", [{"word": "a", "start": "0", "end": 1}], None, "entry 1: 'start' is 0, not a number"),
    ("words", [{"word": 1, "start": 0, "end": 1}], None, "entry 1: 'word' is 1, not text"),
    ("words", [{"word": "a", "start": 0, "end": 1e9}], None, "more than a day"),
    ("words", [{"word": "a", "start": 0, "end": 1e307}], None, "more than a day"),
    ("words", [{"word": "a", "start": 0}], None, "entry 1: no field 'end'"),
    ("words", [], None, "times nothing here"),
    ("cartesia", [{"type": "done", "context_id": "c"}], None, "times nothing here"),
    ("cartesia", [{"word_timestamps": {"words": ["a"], "start": [0, 1], "end": [1]}}], None, "are not of one length"),
    ("cartesia", [{"word_timestamps": {"words": [1], "start": [0], "end": [1]}}], None, "is 1, not text"),
    ("cartesia", [{"word_timestamps": 7}], None, "7 is not an object"),
    ("elevenlabs", {"alignment": {"characters": ["a"], "character_start_times_seconds": [0]}}, None, "no field"),
    ("minimax", [{"text": "a", "timestamped_words": None}], None, "subtitle_type word"),
    ("hume", {"snippet_id": "a", "timestamp": {"text": "a", "type": "word", "time": 1}}, None,
     "no field 'time.begin'"),
    ("google", {"timepoints": 1}, None, "1 is not an object"),
    ("inworld", {"timestampInfo": {}}, None, "times nothing here"),
    ("fish", [{"chunk_seq": 1, "alignment": {"segments": [{"text": "go", "start": 0, "end": 0.3}]}},
              {"chunk_seq": 1, "alignment": {"segments": []}}], None, "times nothing here"),
    ("polly", [{"type": ["word"], "value": "a", "time": 1}], None, "--speech-mark-types"),
])  # fmt: skip
def test_malformed_files(tmp_path: Path, source: Any, content: Any, line: Any, words: str) -> None:
    """One line that names the file, the line where there is one, and what is wrong."""
    path = put(tmp_path, content)
    with pytest.raises(DataError) as caught:
        read_timings(path, source)
    text = str(caught.value)
    assert text.startswith(f"{path}:{line}: " if line else f"{path}: ") and words in text and "\n" not in text


@pytest.mark.parametrize("source, content", [
    ("hume", {"generations": [{"snippets": [[{"timestamps": [
        {"text": "go", "type": "word", "time": {"begin": 0, "end": 300}}]}]]}]}),
    ("hume", {"snippet_id": "a", "timestamps": [{"text": "go", "type": "word", "time": {"begin": 0, "end": 300}}]}),
    ("inworld", {"result": {"timestampInfo": {"characterAlignment": {
        "characters": ["g", "o"], "characterStartTimeSeconds": [0, 0.1], "characterEndTimeSeconds": [0.1, 0.3]}}}}),
    ("inworld", [{"timestampInfo": None}, {"timestampInfo": {"wordAlignment": {
        "words": ["go"], "wordStartTimeSeconds": [0], "wordEndTimeSeconds": [0.3]}}}]),
    ("elevenlabs", {"alignment": {"chars": ["g", "o"], "char_start_times_ms": [0, 100],
                                  "chars_durations_ms": [100, 200]}, "normalizedAlignment": {}}),
    ("soniox", {"stream_id": "s", "characters": ["go"], "starts": [0], "ends": [0.3]}),
    ("words", [{"text": "go", "start_time": 0, "end_time": 0.3}]),
    ("google", [{"markName": "go", "timeSeconds": 0}, {"markName": ".", "timeSeconds": 0.3}]),
    ("azure", {"privAudioOffset": 0, "privText": "go", "privDuration": 3000000}),
    ("azure", [{"audio_offset": 0, "text": "go"}, {"audio_offset": 3000000, "text": "."}]),
    ("kokoro-fastapi", [{"audio_format": "mp3", "timestamps": None},
                        {"timestamps": [{"word": "go", "start_time": 0, "end_time": 0.3}]}]),
    ("fish", {"alignment": {"segments": [{"text": "go", "start": 0, "end": 0.3}]}}),
])  # fmt: skip
def test_other_forms_of_messages(tmp_path: Path, source: str, content: Any) -> None:
    found = phonemes(put(tmp_path, content), source)
    assert [label for _, _, label in found] == ["G", "OW"] and found[-1][1] == 0.3


def test_times_are_moved_and_words_pronounced_otherwise(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """An offset for every format, cut off at the beginning; own words, and other languages where espeak-ng is."""
    path = put(tmp_path, SAMPLES["words"].messages)
    plain = labial.read_timings(path)
    plain_path = put(tmp_path, SAMPLES["plain"].messages, "b.json")
    assert labial.read_timings(path, offset_ms=50) == [("SIL", 50), *plain]
    early = labial.read_timings(path, offset_ms=-300)
    assert sum(milliseconds for _, milliseconds in early) == 700 and early[0][0] != "SIL"
    assert sum(ms for _, ms in labial.read_timings(plain_path, offset_ms=40)) == 40 + sum(
        ms for _, ms in labial.read_timings(plain_path))
    assert [label for label, _ in labial.read_timings(path, own={"maybe": "P AA"})] == "SIL P AA SIL G OW".split()
    with pytest.raises(labial.errors.LabialError, match="an offset of nan ms"):
        labial.read_timings(path, offset_ms=float("nan"))
    out = tmp_path / "a.lab"
    assert main(["timings", str(path), "--offset-ms", "50", "-o", str(out)]) == 0
    assert out.read_text().splitlines()[0].split() [1:] == ["0.0500", "SIL"]
    assert main(["timings", str(path), "--offset-ms", "-5000"]) == 1
    assert capsys.readouterr().err == f"labial: {path}: an offset of -5000 ms leaves no segments\n"
    if shutil.which("espeak-ng"):
        assert main(["timings", str(path), "--language", "de", "-o", str(out)]) == 0
        assert out.read_text().split()[-1] == "OW"
        assert labial.read_timings(path, language="de") != plain
