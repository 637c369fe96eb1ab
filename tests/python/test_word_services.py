"""Readers of what services tell of words and written characters: samples of each, and what is wrong in such a file.

All samples say "Maybe, go." from 0.1 to 0.5 s and from 0.75 to 1 s; services/README.md says where they come from.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, List, Tuple

import pytest

import labial
from labial.__main__ import main
from labial.corpus.formats import as_lab
from labial.errors import DataError
from runtime import needs_runtime

pytestmark = needs_runtime
SAMPLES = Path(__file__).with_name("services")
NAMES = {
    "words.json": "words", "azure_words.json": "azure", "edge.json": "azure", "cartesia.json": "cartesia",
    "cartesia_phonemes.json": "cartesia", "kokoro_fastapi.json": "kokoro-fastapi", "fish.json": "fish",
    "minimax.json": "minimax", "polly_words.marks": "polly", "google.json": "google", "elevenlabs.json": "elevenlabs",
    "elevenlabs_ws.json": "elevenlabs", "soniox.json": "soniox", "inworld.json": "inworld", "hume.json": "hume",
}  # fmt: skip
#: Those that tell no ends of words, and those that tell phonemes.
OPEN = ("polly_words.marks", "google.json")
SOUNDS = ("cartesia_phonemes.json", "inworld.json", "hume.json")
CHARACTERS = ("elevenlabs.json", "elevenlabs_ws.json", "soniox.json")


def phonemes(path: Path, source: Any = None) -> List[Tuple[float, float, str]]:
    rows = [line.split() for line in as_lab(path, source=source).splitlines()]
    return [(float(start), float(end), label) for start, end, label in rows]


def put(folder: Path, content: Any) -> Path:
    path = folder / "a.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", NAMES)
def test_sample_is_told_by_itself(name: str) -> None:
    """Catches a format that is taken for another, a word that is lost, a unit or an origin that is mistaken."""
    found = phonemes(SAMPLES / name)
    assert found == phonemes(SAMPLES / name, NAMES[name])
    assert [label for _, _, label in found] == "SIL M EY B IY SIL G OW".split()
    ends = [end for _, end, _ in found]
    assert ends[0] == 0.1 and ends[5] == 0.75
    if name not in OPEN:
        assert ends[4] == pytest.approx(0.55 if name in CHARACTERS else 0.5, abs=1e-9) and ends[7] == 1.0
    if name in SOUNDS:
        assert ends[1:4] == [0.17, 0.3, 0.36]
    else:
        assert all(before < after for before, after in zip(ends, ends[1:]))


def test_words_and_characters_differ_by_what_is_told() -> None:
    """The characters of the samples are not equally long, so that they move the boundaries of phonemes."""
    words = [end for _, end, _ in phonemes(SAMPLES / "words.json")]
    assert words == [end for _, end, _ in phonemes(SAMPLES / "cartesia.json")]
    spelt = [end for _, end, _ in phonemes(SAMPLES / "elevenlabs.json")]
    assert spelt == [end for _, end, _ in phonemes(SAMPLES / "elevenlabs_ws.json")] and spelt[1:4] != words[1:4]


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


@pytest.mark.parametrize("source, content, problem", [
    ("words", [{"word": "a", "start": 1, "end": 2}, {"word": "b", "start": 0, "end": 1}], "'b' begins before 'a'"),
    ("words", [{"word": "a", "start": 2, "end": 1}], "ends before it begins"),
    ("words", [{"word": "a", "start": "0", "end": 1}], "entry 1: 'start' is 0, not a number from 0 on"),
    ("words", [{"word": 1, "start": 0, "end": 1}], "entry 1: 'word' is 1, not text"),
    ("words", [{"word": "a", "start": 0, "end": 1e9}], "later than any time"),
    ("words", [{"word": "a", "start": 0, "end": 1e307}], "later than any time"),
    ("words", [{"word": "a", "start": 0}], "entry 1: no field 'end'"),
    ("words", [], "no words with their times"),
    ("cartesia", [{"type": "done", "context_id": "c"}], "no words with their times"),
    ("cartesia", [{"word_timestamps": {"words": ["a"], "start": [0, 1], "end": [1]}}], "are not of one length"),
    ("cartesia", [{"word_timestamps": {"words": [1], "start": [0], "end": [1]}}], "are not of one length"),
    ("cartesia", [{"word_timestamps": 7}], "7 is not an object"),
    ("elevenlabs", {"alignment": {"characters": ["a"], "character_start_times_seconds": [0]}}, "no field"),
    ("minimax", [{"text": "a", "timestamped_words": None}], "ask for subtitle_type word"),
    ("hume", {"snippet_id": "a", "timestamp": {"text": "a", "type": "word", "time": 1}}, "1 is not an object"),
    ("google", {"timepoints": 1}, "'timepoints' is 1, not a list"),
    ("inworld", {"timestampInfo": {}}, "no words with their times"),
    ("fish", [{"chunk_seq": 1, "alignment": {"segments": [{"text": "go", "start": 0, "end": 0.3}]}},
              {"chunk_seq": 1, "alignment": {"segments": []}}], "no words with their times"),
    ("polly", [{"type": ["word"], "value": "a", "time": 1}], "no speech marks of type"),
])  # fmt: skip
def test_malformed_files(tmp_path: Path, source: str, content: Any, problem: str) -> None:
    """One line that names the file and says what is wrong."""
    path = put(tmp_path, content)
    with pytest.raises(DataError) as caught:
        phonemes(path, source)
    assert problem in str(caught.value) and str(caught.value).startswith(str(path)) and "\n" not in str(caught.value)


def test_times_are_moved_and_words_pronounced_otherwise(tmp_path: Path) -> None:
    """An offset for every format, cut off at the beginning; own words, and other languages where espeak-ng is."""
    path = SAMPLES / "words.json"
    plain = labial.read_timings(path)
    assert labial.read_timings(path, offset_ms=50) == [("SIL", 50), *plain]
    early = labial.read_timings(path, offset_ms=-300)
    assert sum(milliseconds for _, milliseconds in early) == 700 and early[0][0] != "SIL"
    assert sum(ms for _, ms in labial.read_timings(SAMPLES / "plain.json", offset_ms=40)) == 40 + sum(
        ms for _, ms in labial.read_timings(SAMPLES / "plain.json"))
    assert [label for label, _ in labial.read_timings(path, own={"maybe": "P AA"})] == "SIL P AA SIL G OW".split()
    with pytest.raises(labial.errors.LabialError, match="an offset of nan ms"):
        labial.read_timings(path, offset_ms=float("nan"))
    out = tmp_path / "a.lab"
    assert main(["timings", str(path), "--offset-ms", "50", "-o", str(out)]) == 0
    assert out.read_text().splitlines()[0].split() [1:] == ["0.0500", "SIL"]
    if shutil.which("espeak-ng"):
        assert main(["timings", str(path), "--language", "de", "-o", str(out)]) == 0
        assert out.read_text().split()[-1] == "OW"
        assert labial.read_timings(path, language="de") != plain


def test_parsed_json_is_read() -> None:
    """`read_timings` takes a service's message as it was parsed."""
    content = json.loads((SAMPLES / "elevenlabs.json").read_text())
    timings = labial.read_timings(content)
    assert timings[0] == ("SIL", 100) and sum(milliseconds for _, milliseconds in timings) == 1000
