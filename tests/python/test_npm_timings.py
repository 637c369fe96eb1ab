"""The npm package's readers of JSON against those of labial.corpus, and its reader of text against theirs, which is the
library's in both: the same segments, to the last bit, or an error in both."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Tuple

import pytest

from labial.corpus import services
from labial.corpus.phonesets import AUTO
from labial.corpus.timings import PathLike, SourceSegment
from labial.errors import DataError

SAMPLES = Path(__file__).with_name("services")
READERS: Dict[str, Callable[[PathLike], List[SourceSegment]]] = {
    "fromPiper": services.read_piper, "fromKokoro": services.read_kokoro, "fromHeadTTS": services.read_headtts,
    "fromAzure": services.read_azure, "fromPolly": services.read_polly,
}  # fmt: skip
SAMPLE_OF = {"piper.json": "fromPiper", "piper_info.json": "fromPiper", "kokoro.json": "fromKokoro",
             "headtts.json": "fromHeadTTS", "azure.json": "fromAzure", "polly.marks": "fromPolly"}

#: Reads [[reader, text], ...] and writes for each its segments, or the sentence of its error.
SCRIPT = """
const { Labial, timings } = await import(process.argv[1]);
const labial = await Labial.load();
let input = "";
for await (const piece of process.stdin) input += piece;
const answers = JSON.parse(input).map(([reader, text]) => {
    try {
        return reader in timings ? timings[reader](text) : labial.read(text, { format: reader });
    } catch (error) {
        if (error.name !== "LabialError" || error.message.includes("\\n")) throw error;
        return error.message;
    }
});
process.stdout.write(JSON.stringify(answers));
"""

Row = Tuple[float, float, str, Optional[str]]


def read_by_node(cases: List[Tuple[str, str]]) -> List[Any]:
    """What the package's readers make of each text: rows, or the text of an error."""
    node = shutil.which("node")
    if not node:
        pytest.skip("needs node: install the Debian package nodejs")
    folder = os.environ.get("LABIAL_NPM_PACKAGE", "")
    if not folder:
        pytest.skip("LABIAL_NPM_PACKAGE does not name the built package")
    url = (Path(folder) / "index.js").as_uri()
    done = subprocess.run([node, "--input-type=module", "-e", SCRIPT, url], input=json.dumps(cases), check=False,
                          capture_output=True, encoding="utf-8", timeout=120)
    assert done.returncode == 0, done.stderr
    return [answer if isinstance(answer, str) else
            [(item["start"], item["end"], item["label"], item.get("labels", AUTO)) for item in answer]
            for answer in json.loads(done.stdout)]


def read_by_python(folder: Path, reader: str, text: str) -> Any:
    """The same of the exporter's readers."""
    path = folder / "a"
    path.write_bytes(text.encode("utf-8"))
    try:
        return [(item.start, item.end, item.label, item.labels) for item in READERS[reader](path)]
    except DataError as error:
        return str(error)


def assert_alike(folder: Path, cases: List[Tuple[str, str]]) -> None:
    for case, found in zip(cases, read_by_node(cases)):
        wanted = read_by_python(folder, *case)
        if isinstance(wanted, str):
            assert isinstance(found, str), (case, wanted, found)
        else:
            assert found == wanted, case


def test_samples(tmp_path: Path) -> None:
    """Catches a time that is rounded otherwise, a phoneme that is joined otherwise, labels of no set."""
    cases = [(reader, (SAMPLES / name).read_text(encoding="utf-8")) for name, reader in SAMPLE_OF.items()]
    for (name, _), rows in zip(SAMPLE_OF.items(), read_by_node(cases)):
        assert not isinstance(rows, str) and len(rows) > 5, name
    assert_alike(tmp_path, cases)


def drawn(rng: random.Random) -> Tuple[str, str]:
    """Timings of any service, mostly well-formed, with all that makes a difference in them."""
    reader = rng.choice(list(READERS))
    labels = ["a", "ɪ", "ˈ", "ˌ", "ː", "t", "ʃ", " ", ",", ".", "^", "$", "_", "e", "o", "ʊ", "ə", "\u0303", "", "ʰ",
              "A"]
    times = [0.0]
    for _ in range(rng.randrange(1, 30)):
        times.append(times[-1] + rng.choice([0, 0.01, 0.05, 0.08, rng.random() / 3, 0.15, 0.4]))
    steps = range(len(times) - 1)
    if reader == "fromPiper":
        parts = [{"phoneme": rng.choice(labels), "num_samples": rng.randrange(0, 6000)} for _ in steps]
        chunk = {"sample_rate": rng.choice([16000, 22050]), "phoneme_alignments": parts}
        content: Any = [chunk] * rng.randrange(1, 3)
    elif reader == "fromKokoro":
        text = "".join(rng.choice(labels) for _ in steps)
        content = {"phonemes": text, "pred_dur": [rng.randrange(0, 12) for _ in range(len(text) + 2)]}
    elif reader == "fromHeadTTS":
        starts = [1000 * time for time in times[:-1]]
        content = [{"phonemes": [rng.choice(labels) for _ in steps], "vtimes": starts,
                    "vdurations": [rng.randrange(0, 300) for _ in steps]}] * rng.randrange(1, 3)
    elif reader == "fromAzure":
        content = [{"audioOffset": round(1e7 * time), "visemeId": rng.randrange(0, 23 if rng.random() < 0.05 else 22)}
                   for time in times[:-1]]
    elif reader == "fromPolly":
        names = [*"ptSTfkirsluaeEoO@BJx", "sil", "sil"]
        marks = [{"time": round(1000 * time), "type": rng.choice(["viseme", "viseme", "word"]),
                  "value": rng.choice(names)} for time in times[:-1]]
        return reader, "\n".join(map(json.dumps, marks))
    return reader, json.dumps(content, ensure_ascii=False)


def test_drawn_timings(tmp_path: Path) -> None:
    """Catches rules that agree on the samples alone: blanks of every length, marks in every place, pairs, overlaps."""
    rng = random.Random(12)
    cases = [drawn(rng) for _ in range(600)]
    answers = [read_by_python(tmp_path, *case) for case in cases]
    assert {case[0] for case, answer in zip(cases, answers) if not isinstance(answer, str)} == set(READERS)
    assert_alike(tmp_path, cases)


CHUNK: Dict[str, Any] = {"sample_rate": 100, "phoneme_alignments": [{"phoneme": "m", "num_samples": 5}]}


MALFORMED: List[Tuple[str, Any]] = [
    ("fromPiper", ""), ("fromPiper", "[{]"), ("fromPiper", "{}\n{]\n"), ("fromPiper", "[]"), ("fromPiper", "[1]"),
    ("fromPiper", "[" * 100000), ("fromPiper", "9" * 5000), ("fromPiper", "null"), ("fromPiper", [[]]),
    ("fromPiper", [{"phoneme": "m", "num_samples": 5}]), ("fromPiper", {**CHUNK, "sample_rate": 0}),
    ("fromPiper", {**CHUNK, "sample_rate": True}), ("fromPiper", {**CHUNK, "phoneme_alignments": None}),
    ("fromPiper", {**CHUNK, "phoneme_alignments": [{"phoneme": "m", "num_samples": -1}]}),
    ("fromPiper", {**CHUNK, "phoneme_alignments": [{"phoneme": 1, "num_samples": 1}]}),
    ("fromPiper", {"voice": {}, "last": None}), ("fromPiper", '{"phoneme": "m", "seconds": 1' + "0" * 400 + "}"),
    ("fromPiper", '{"phoneme": "m", "seconds": NaN}'), ("fromPiper", {"phoneme": "m", "seconds": 90000}),
    ("fromAzure", [{"audio_offset": 0, "viseme_id": 22}]), ("fromAzure", [{"audio_offset": 0}]),
    ("fromAzure", [{"audio_offset": 90000, "viseme_id": 2}, {"audio_offset": 1, "viseme_id": 0}]),
    ("fromAzure", [{"audio_offset": 0, "viseme_id": "__proto__"}]),
    ("fromAzure", [{"audio_offset": 0, "viseme_id": {}}]), ("fromPolly", {"time": 0, "type": "word", "value": "a"}),
    ("fromPolly", {"time": 0, "type": "viseme", "value": "?"}),
    ("fromPolly", {"time": 0, "type": "viseme", "value": "constructor"}),
    ("fromHeadTTS", {"phonemes": ["m"], "vtimes": [0, 1], "vdurations": [5]}),
    ("fromHeadTTS", {"phonemes": [1], "vtimes": [0], "vdurations": [5]}), ("fromHeadTTS", {"phonemes": []}),
    ("fromKokoro", {"phonemes": "ma", "pred_dur": [1, 2, 3]}), ("fromKokoro", {"phonemes": 3, "pred_dur": []}),
]  # fmt: skip


def test_malformed_timings(tmp_path: Path) -> None:
    """Catches what Python refuses and JavaScript reads, among it what its objects inherit."""
    cases = [(reader, text if isinstance(text, str) else json.dumps(text)) for reader, text in MALFORMED]
    assert all(isinstance(read_by_python(tmp_path, *case), str) for case in cases)
    assert_alike(tmp_path, cases)
