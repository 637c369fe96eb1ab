"""The npm package against labial-say and the exporter: the same timings, frames and weights.

Its readers of JSON are held to those of labial.corpus: the same segments, to the last bit, or an error in both.
"""

from __future__ import annotations

import base64
import json
import lzma
import os
import random
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.corpus import formats
from labial.corpus.phonesets import ARPABET, AUTO
from labial.errors import DataError
from labial.files.faps import CHANNELS, FAP_NAMES
from labial.rig import FACES, description_of
from messages import SAMPLES
from npm import answered
from packages import SOURCE, needs_runtime, run
from test_hearing import voice

SAY = os.environ.get("LABIAL_SAY", "")
OUTPUTS = ("faps", *FACES)

#: For each text and each output the frames of `labial.render()`.
RENDER = """
await labial.laughter();
answer(given.texts.map((text) => given.outputs.map((output) => {
    const track = labial.render(labial.read(text), { output, unknown: "nearest" });
    return Array.from(track, (frame) => (output === "faps" ? Array.from(frame) : frame));
})));
"""


def drawn_lab(rng: random.Random) -> str:
    """Lines of a .lab: phonemes of every set, pauses, laughs, unknown labels, gaps, times that are no whole frames."""
    labels = [*ARPABET, "ˈɑː", "tʃ", "øː", "sil", "xyz", "<unk>", "<laugh>", "<laugh:0.9>"]
    end, rows = 0.0, []
    for _ in range(rng.randrange(1, 60)):
        start = end + rng.choice([0.0, 0.0, 0.0, 0.0004, 0.1234, 0.6])
        end = start + rng.choice([0.0, 0.0101, 0.05, rng.random() / 3, 1.7])
        rows.append(f"{start:.4f} {end:.4f} {rng.choice(labels)}\n")
    return "".join(rows)


def said(text: str, output: str) -> List[Any]:
    """What labial-say writes of each frame."""
    form = "csv" if output == "faps" else output
    lines = run(SAY, "--to", form, text=text).splitlines()
    if output == "faps":
        return [[int(value) for value in line.split(",")[1:]] for line in lines[1:]]
    return [json.loads(line)[output] for line in lines]


@pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")
def test_frames_are_those_of_labial_say(tmp_path: Path) -> None:
    """Catches times that are rounded otherwise, gaps that close, a laugh of another seed, weights of another name."""
    rng = random.Random(5)
    texts = [drawn_lab(rng) for _ in range(25)]
    frames = 0
    for text, tracks in zip(texts, answered(RENDER, {"texts": texts, "outputs": OUTPUTS}, tmp_path / "npm")):
        for output, track in zip(OUTPUTS, tracks):
            assert track == said(text, output), (output, text)
            frames += len(track)
    assert frames > 10000


#: The weights of each rig in each frame, from convert() and from a stream.
RIGS = """
const { rigs, frames, wrong } = given;
const converted = rigs.map((text) => labial.rig(text)).map((rig) => frames.map((faps) => labial.convert(faps, rig)));
const segments = [{ start: 0, end: 0.3, label: "AA" }, { start: 0.3, end: 0.4, label: "m" }];
const mine = labial.rig(JSON.parse(rigs[0]));
const track = labial.render(segments, { output: mine });
const stream = labial.stream({ output: mine });
stream.push("AA", 300);
stream.push("m", 100);
stream.end();
const refused = wrong.map((text) => {
    try {
        labial.rig(text);
        return "";
    } catch (error) {
        return error.message;
    }
});
answer({
    converted, refused, faps: Array.from(track.faps), visemes: Array.from(track.visemes),
    track: [...track], between: track.at(0.1), stream: [...stream],
    names: [mine.name, mine.outputs],
});
"""


def description(rng: random.Random) -> str:
    """A face of weights that nobody has."""
    lines = ['unit = "weight"']
    for number in range(rng.randrange(1, 9)):
        mixed = ", ".join(f"{name} = {rng.uniform(-1, 1):.3f}" for name in rng.sample(FAP_NAMES, rng.randrange(1, 6)))
        lines += [f"[output.shape_{number}]", f"from = {{ {mixed} }}", f"neutral = {rng.uniform(-0.3, 0.3):.4f}",
                  f"full = {rng.choice([0, 1])}", f"reach = {rng.uniform(80, 900):.1f}", "minimum = 0",
                  f"maximum = {rng.uniform(0.3, 1):.2f}"]
        if rng.random() < 0.3:
            lines += ["closed = 0.1"]
        if number % 3 == 1:
            middle = [f"[{at}, {10 * at + (number + at) % 1:.2f}]" for at in (0.2, 0.4, 0.7)[: number % 4]]
            lines += [f"curve = [{', '.join(['[-0.5, -5]', *middle, '[1.1, 12.5]'])}]"]
    return "\n".join(lines) + "\n"


@pytest.mark.slow
@needs_runtime
def test_weights_are_those_of_python(tmp_path: Path) -> None:
    """Every rig, built-in or random, in random frames and the largest; and files that are not whole are refused."""
    rng = random.Random(20)
    paths = [description_of(name) for name in FACES]
    for number in range(20):
        paths.append(tmp_path / f"face{number}.toml")
        paths[-1].write_text(description(rng))
    for path in paths:
        assert main(["rig", str(path), "--json", "-o", str(tmp_path / "web")]) == 0
    texts = [(tmp_path / "web" / f"{path.stem}.json").read_text() for path in paths]
    frames: List[List[int]] = [[rng.randrange(-700, 700) for _ in range(CHANNELS)] for _ in range(60)]
    frames += [[0] * CHANNELS, [32767] * CHANNELS, [-32768] * CHANNELS]
    first = json.loads(texts[0])
    some = next(iter(first["outputs"]))

    def changed(**values: Any) -> str:
        return json.dumps({**first, "outputs": {some: {**first["outputs"][some], **values}}})

    wrong = ["{}", "3", "null", json.dumps({**first, "outputs": {}}), changed(weights=[1] * 12),
             changed(weights=[40000] + [0] * 12), changed(gain=0.5), changed(gain="1"), changed(neutral=None),
             changed(minimum=5, maximum=4), changed(invert=2), changed(contact=-1), changed(closed=7),
             changed(curve=3), changed(curve=[[1, 2]]), changed(curve=[[0, 0, 2**25 + 1]]),
             changed(curve=[[0, 0, "1"]]),
             changed(curve=[[5, 0, 1], [5, 0, 1]]), changed(curve=[[place, 0, 1] for place in range(9)]),
             json.dumps({**first, "outputs": {some: None}})]
    found = answered(RIGS, {"rigs": texts, "frames": frames, "wrong": wrong}, tmp_path / "npm")
    for path, weights in zip(paths, found["converted"]):
        rig = labial.Rig(path)
        assert weights == [rig.apply(frame) for frame in frames], path.name
    assert all(found["refused"]) and len(found["refused"]) == len(wrong), found["refused"]
    rig = labial.Rig(paths[0])
    faps = [found["faps"][at : at + CHANNELS] for at in range(0, len(found["faps"]), CHANNELS)]
    sounds = [found["visemes"][at : at + 15] for at in range(0, len(found["visemes"]), 15)]
    assert found["track"] == found["stream"] and len(faps) == 20 + 12  # at rest
    assert found["track"] == [rig.apply(frame, visemes=shares) for frame, shares in zip(faps, sounds)]
    assert found["between"] == found["track"][5] and found["names"] == [paths[0].stem, list(rig.outputs)]


@pytest.mark.parametrize(("text", "message"), [
    ('unit = "us"\n[output.jaw]\nfrom = "jaw"\nneutral = 1400\nfull = 1900\n', "unit: --json is for faces of weights"),
    ('unit = "weight"\n[output.jaw]\nfrom = "jaw"\nneutral = 0\nfull = 1\nslew = 0.1\n', "output.jaw.slew: is for"),
    ('unit = "weight"\n[output.jaw]\nfrom = "jaw"\nneutral = 0\nfull = 1\nacceleration = 0.05\n', "jaw.acceleration"),
])
def test_servos_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str) -> None:
    """One line that names the file, and no file."""
    (tmp_path / "face.toml").write_text(text)
    assert main(["rig", str(tmp_path / "face.toml"), "--json", "-o", str(tmp_path)]) == 1
    error = capsys.readouterr().err
    assert message in error and "face.toml" in error and not (tmp_path / "face.json").exists()


#: The readers of the package alone, and the services that they are of.
READERS = {"fromPiper": "piper", "fromKokoro": "kokoro", "fromHeadTTS": "headtts", "fromAzure": "azure",
           "fromPolly": "polly"}

#: Of each [reader, text] its segments, or the sentence of its error.
READ = """
answer(given.map(([reader, text]) => {
    try {
        return reader in timings ? timings[reader](text) : labial.read(text, { format: reader });
    } catch (error) {
        if (error.name !== "LabialError" || error.message.includes("\\n")) throw error;
        return error.message;
    }
}));
"""

def read_by_node(cases: List[Tuple[str, str]]) -> List[Any]:
    """What the package's readers make of each text: rows, or the text of an error."""
    return [answer if isinstance(answer, str) else
            [(item["start"], item["end"], item["label"], item.get("labels", AUTO)) for item in answer]
            for answer in answered(READ, cases)]


def read_by_python(folder: Path, reader: str, text: str) -> Any:
    """The same of the exporter's readers."""
    path = folder / "a"
    path.write_bytes(text.encode("utf-8"))
    try:
        return [(item.start, item.end, item.label, item.labels) for item in formats.read_service(path, READERS[reader])]
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
    cases = [(reader, sample.text) for reader, service in READERS.items() for sample in SAMPLES.values()
             if sample.service == service and not sample.phonemes.startswith("SIL M EY")]
    assert len(cases) == 6 and all(not isinstance(rows, str) and len(rows) > 5 for rows in read_by_node(cases))
    assert_alike(tmp_path, cases)


def drawn_json(rng: random.Random) -> Tuple[str, str]:
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
        marks = [{"time": 0, "type": "viseme", "value": "p"}]  # words alone are of the package labial-words
        marks += [{"time": round(1000 * time), "type": rng.choice(["viseme", "viseme", "word"]),
                  "value": rng.choice(names)} for time in times[:-1]]
        return reader, "\n".join(map(json.dumps, marks))
    return reader, json.dumps(content, ensure_ascii=False)


def test_drawn_timings(tmp_path: Path) -> None:
    """Catches rules that agree on the samples alone: blanks of every length, marks in every place, pairs, overlaps."""
    rng = random.Random(12)
    cases = [drawn_json(rng) for _ in range(600)]
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
    ("fromAzure", [{"audio_offset": 0, "viseme_id": {}}]),
    ("fromPolly", {"time": 0, "type": "viseme", "value": "?"}),
    ("fromPolly", {"time": 0, "type": "viseme", "value": "constructor"}),
    ("fromHeadTTS", {"phonemes": ["m"], "vtimes": [0, 1], "vdurations": [5]}),
    ("fromHeadTTS", {"phonemes": [1], "vtimes": [0], "vdurations": [5]}), ("fromHeadTTS", {"phonemes": []}),
    ("fromKokoro", {"phonemes": "ma", "pred_dur": [1, 2, 3]}), ("fromKokoro", {"phonemes": 3, "pred_dur": []}),
]


def test_malformed_timings(tmp_path: Path) -> None:
    """Catches what Python refuses and JavaScript reads, among it what its objects inherit."""
    cases = [(reader, text if isinstance(text, str) else json.dumps(text)) for reader, text in MALFORMED]
    assert all(isinstance(read_by_python(tmp_path, *case), str) for case in cases)
    assert_alike(tmp_path, cases)


# ---- Hearing in the npm package --------------------------------------------------------------------------------------


#: Of each { sampleRate, channels, model, blocks } the frames, the stretches and the latency.
HEAR = r"""
const file = (name) => () => import(url.replace(/\/index\.js$/, name));
const hearing = await Labial.load({ hearing: file("-hearing/index.js") });
const others = { host: file("-hearing-host/index.js"), ahead: file("-hearing-host/ahead.js") };
const found = [];
for (const { blocks, model, ...options } of given) {
    const heard = await hearing.hear(null, { ...options, model: others[model] ?? model });
    for (const block of blocks) heard.push(Int16Array.from(block));
    heard.end();
    const frames = Array.from(heard, (faps) => [Array.from(faps), Array.from(heard.visemes)]);
    found.push([frames, heard.segments(), heard.latency]);
    heard.close();
}
answer(found);
"""


@needs_runtime
def test_frames_are_those_of_python(tmp_path: Path) -> None:
    """Catches another model, a rate that is converted otherwise, and frames that are lost between blocks."""
    rng = np.random.default_rng(3)
    sounds, asked = [], []
    for number, rate in enumerate((8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000)):
        sound = voice(1.7, number, rate)
        if number % 2:
            sound = np.stack([sound, -(sound // 3)], axis=1)
        model = ("small", "large", "host", "ahead")[number // 2 % 4]
        cuts = np.sort(rng.integers(0, len(sound), 12))
        sounds.append((model, rate, sound))
        asked.append({"sampleRate": rate, "channels": sound.ndim, "model": model,
                      "blocks": [block.ravel().tolist() for block in np.split(sound, cuts)]})
    found = answered(HEAR, asked, tmp_path / "npm")
    assert len(found) == len(sounds)
    for (model, rate, sound), (frames, segments, latency) in zip(sounds, found):
        with labial.Hearing(rate, sound.ndim, model=f"hear_{model}") as hearing:
            heard = list(hearing.frames([sound]))
            rows = [(item.name, item.frame / 50, (item.frame + item.frames) / 50) for item in hearing.shown()]
        assert frames == [[list(frame.faps), list(frame.visemes)] for frame in heard], (model, rate)
        assert [(row["label"], round(row["start"], 6), round(row["end"], 6)) for row in segments] == rows
        assert latency == pytest.approx(0.28 if model == "ahead" else 0.12, abs=0.002)


#: Bytes of the numbers of `given`, which were packed.
UNPACK = """
const { unpack } = await import(url.replace(/index\\.js$/, "unpack.js"));
answer(given.map((text) => Buffer.from(unpack(text)).toString("base64")));
"""


def test_what_is_packed_is_an_xz_file(tmp_path: Path) -> None:
    rng = random.Random(7)
    noise = rng.randbytes(150_000)
    text = (SOURCE / "DESIGN.md").read_bytes()
    numbers = bytes((i * i >> 5) & 255 for i in range(70_000))
    given = [b"a", b"abc" * 9000, bytes(300_000), text, numbers, noise, noise + text + noise + text + numbers,
             *(bytes(rng.choices(b"abcd\0", k=rng.randrange(1, 3000))) for _ in range(40))]
    packed = [base64.b64encode(lzma.compress(data, preset=9)).decode() for data in given]
    assert [base64.b64decode(text) for text in answered(UNPACK, packed, tmp_path)] == given


@pytest.mark.parametrize("script", ["npm/speech.js", "npm-laughter/index.js", "npm-hearing/small.js",
                                    "npm-hearing-host/ahead.js", "npm-words/english.js"])
def test_the_packages_are_what_xz_unpacks(npm_package: Path, script: str) -> None:
    data = lzma.decompress(base64.b64decode((npm_package.parent / script).read_text().split('"')[-2]))
    assert data[:4] in (b"\0asm", b"LBM1")
