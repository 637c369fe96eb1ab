"""Other projects beside hearing (labial.evaluate.others): what they are given, against Chromium's own audio nodes and
against made-up packages; how their weights become lips; the phone loop; and what is said where something lacks."""

from __future__ import annotations

import base64
import json
import shutil
from pathlib import Path
from typing import Any, List

import numpy as np
import pytest

pytest.importorskip("soxr")

from browser import CHROMIUM, REASON, Browser, Page, served  # noqa: E402
from labial.__main__ import main  # noqa: E402
from labial.errors import LabialError  # noqa: E402
from labial.evaluate import others  # noqa: E402
from labial.files.faps import TOUCHING  # noqa: E402
from labial.files.frames import opening  # noqa: E402
from labial.hearing.features import RATE  # noqa: E402
from labial.hearing.model import save  # noqa: E402
from labial.runtime.render import render  # noqa: E402
from models import random_hearing  # noqa: E402
from npm import TOOLS_MISSING, tools  # noqa: E402
from packages import needs_runtime  # noqa: E402

needs_node = pytest.mark.skipif(not shutil.which("node"), reason="needs node: install the Debian package nodejs")
needs_chromium = pytest.mark.skipif(not CHROMIUM, reason=REASON)

#: Stand-ins of the packages: one shows what its analyser reports, the other what its worklet hears.
WAWA = """exports.Lipsync = class {
    constructor() {
        const context = new window.AudioContext();
        this.analyser = context.createAnalyser();
        this.analyser.fftSize = context.sampleRate === 48000 ? 2048 : 0;
        this.levels = new Uint8Array(this.analyser.frequencyBinCount);
    }
    processAudio() {
        this.analyser.getByteFrequencyData(this.levels);
        this.state = performance.now() >= 1000 / 60 ? "vowel" : "plosive";
        this.viseme = this.levels[1023] === 7 ? "viseme_aa" : "viseme_PP";
    }
};
"""
WORKLET = """registerProcessor("made", class extends AudioWorkletProcessor {
    static get parameterDescriptors() { return [{ name: "gain", defaultValue: 2 }]; }
    sum = 0;
    process([[block]], outputs, { gain }) {
        for (const sample of block) this.sum += gain[0] * sample;
        this.port.postMessage(this.sum);
        return true;
    }
});
"""
NODE = """export class HeadAudio extends AudioWorkletNode {
    constructor(context) {
        super(context, "made", {});
        this.port.onmessage = ({ data }) => (this.sum = data);
        this.time = 0;
    }
    async loadModel(path) { this.model = (await (await fetch(path)).arrayBuffer()).byteLength; }
    update(step) { this.onvalue("viseme_U", this.sum ?? -1); this.onvalue("viseme_I", (this.time += step)); }
}
"""


def vowels(seconds: float = 1.0, rate: int = RATE) -> np.ndarray:
    """A buzz whose pitch and spectrum move, loud and soft."""
    time = np.arange(round(seconds * rate)) / rate
    phase = 2 * np.pi * np.cumsum(120 + 30 * np.sin(7 * time)) / rate
    tilt = 1.5 + np.sin(11 * time)
    sound = sum(np.sin(k * phase) / k**tilt for k in range(1, 30))
    return np.asarray(9000 * sound * (0.55 + 0.45 * np.sin(9 * time)), np.int16)


def package(folder: Path, name: str, files: List[List[str]]) -> Path:
    """`folder`, with a made-up package in its node_modules."""
    for path, text in [["package.json", json.dumps({"name": name})], *files]:
        place = folder / "node_modules" / name / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    return folder


# ---- What packages are given, and give


@needs_node
@needs_runtime
def test_visemes_of_an_analyser(tmp_path: Path) -> None:
    """Rows of levels arrive one by one, 60 times a second of the clock; weights are smoothed as the example does it, up
    by .2 or .4 and down by .1 or .2 a row; the second way has them plainly."""
    package(tmp_path, "wawa-lipsync", [["index.js", WAWA]])
    rows = np.zeros((4, 1024), np.uint8)
    rows[1:3, 1023] = 7
    found = others.run(shutil.which("node") or "", "wawa-lipsync", tmp_path / "node_modules", rows.tobytes())
    names = list(others.VISEMES)
    lips, wide = names.index("PP"), names.index("aa")
    assert found.shape == (4, 2, 15) and not np.delete(found, (lips, wide), axis=2).any()
    assert found[:, 1, [lips, wide]].tolist() == [[1, 0], [0, 1], [0, 1], [1, 0]]
    assert found[:, 0, lips] == pytest.approx([0.4, 0.36, 0.324, 0.4592])  # up at .4, down at .1, up at .2
    assert found[:, 0, wide] == pytest.approx([0.0, 0.2, 0.36, 0.324])
    shown = others.method("wawa-lipsync unsmoothed", tmp_path)(np.zeros(1600, np.int16))
    assert shown.shape == (5, 13) and shown == pytest.approx(np.tile(others.poses()[lips], (5, 1)))


@needs_node
def test_weights_of_a_worklet(tmp_path: Path) -> None:
    """Blocks of 128 samples arrive before the page is drawn that comes after them, with the parameters' defaults; a
    value that was never reported is 0."""
    files = [["headworklet.min.mjs", WORKLET], ["headaudio.min.mjs", NODE], ["model-en-mixed.bin", "model"]]
    package(tmp_path, "@met4citizen/headaudio", [[f"dist/{name}", text] for name, text in files])
    sound = np.ones(1700, "<f4")
    found = others.run(shutil.which("node") or "", "headaudio", tmp_path / "node_modules", sound.tobytes())[:, 0]
    names = list(others.VISEMES)
    assert found[:, names.index("U")].tolist() == [-1, 2 * 6 * 128, 2 * 12 * 128]
    assert found[:, names.index("I")] == pytest.approx(1000 / 60 * np.arange(1, 4), rel=1e-6)
    assert not np.delete(found, (names.index("U"), names.index("I")), axis=1).any()


@needs_runtime
def test_weights_mix_lips() -> None:
    """Lips touch at full PP and without weights and are open at aa; halves are half as open; rows at 60 a second are
    read in the middle of frames of 20 ms."""
    names = list(others.VISEMES)
    weights = np.zeros((61, 15))
    weights[:, names.index("aa")] = np.linspace(0, 1, 61)
    wide = others.poses()[names.index("aa")]
    assert opening(wide) > 400
    assert others.shown(weights, 50) == pytest.approx(np.outer((np.arange(50) + 0.5) / 50, wide))
    assert opening(others.poses()[names.index("PP")]) <= TOUCHING
    assert not others.poses()[names.index("sil")].any() and not others.shown(np.zeros((0, 15)), 3).any()


def test_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package without its folder, one that is not in it, one that fails, and no node."""
    if shutil.which("node"):
        with pytest.raises(LabialError, match=r"npm install --prefix FOLDER wawa-lipsync, and then --npm FOLDER"):
            others.method("wawa-lipsync", None)
        with pytest.raises(LabialError, match=r"there is no .*headaudio: npm install --prefix"):
            others.method("headaudio", tmp_path)
        package(tmp_path, "wawa-lipsync", [["index.js", "throw new Error('made up')"]])
        with pytest.raises(LabialError, match="wawa-lipsync failed: Error: made up"):
            others.method("wawa-lipsync", tmp_path)(vowels(0.1))
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.raises(LabialError, match="headaudio needs node"):
        others.method("headaudio", tmp_path)


@needs_node
def test_the_command_names_them(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Other projects are judged only where they are named, and need their packages before anything is aligned."""
    save(random_hearing(), tmp_path / "hear.npz")
    given = ["evaluate-hear", str(tmp_path / "hear.npz"), "nowhere"]
    assert main([*given, "--methods", "integers,headaudio", "--npm", str(tmp_path)]) == 1
    assert f"npm install --prefix {tmp_path} @met4citizen/headaudio" in capsys.readouterr().err
    assert main([*given, "--methods", "wawa"]) == 1 and "crossings; wawa-lipsync; " in capsys.readouterr().err
    assert main(given) == 1 and "nowhere" in capsys.readouterr().err


# ---- The recogniser


@needs_runtime
def test_the_phone_loop_closes_lips() -> None:
    """Silence is silence. Labial's lips of what the loop finds in a buzz are as many frames as the sound has."""
    pytest.importorskip("pocketsphinx")
    listen = others.method("pocketsphinx", None)
    rest = np.array(render([("SIL", 2000)]), dtype=float).reshape(-1, 13)[50]
    assert listen(np.zeros(2 * RATE, np.int16))[50] == pytest.approx(rest, abs=2)
    found = listen(vowels())
    assert found.shape == (50, 13) and np.ptp(opening(found)) > 50
    assert listen(np.zeros(0, np.int16)).shape == (0, 13)


# ---- Chromium's own nodes

#: A context that renders a sound and stops 60 times a second, at whole blocks, where `look(number)` is called.
RENDERED = """async (samples, prepare, look) => {
    const bytes = Uint8Array.from(atob(samples), (letter) => letter.charCodeAt(0));
    const sound = new Float32Array(bytes.buffer);
    const context = new OfflineAudioContext(1, sound.length, 48000);
    const buffer = context.createBuffer(1, sound.length, 48000);
    buffer.copyToChannel(sound, 0);
    const source = context.createBufferSource();
    source.buffer = buffer;
    const node = await prepare(context);
    source.connect(node);
    source.start();
    const stop = (call) => {
        const at = (Math.floor((call * 800) / 128) * 128) / 48000;
        if (at < sound.length / 48000)
            context.suspend(at).then(async () => { await look(node, call); stop(call + 1); context.resume(); });
    };
    await look(node, 0);
    stop(1);
    await context.startRendering();
}"""


def sound_of(page: Page, samples: np.ndarray) -> None:
    text = base64.b64encode(samples.astype("<f4").tobytes()).decode()
    page.evaluate(f"globalThis.samples = {json.dumps(text)}; globalThis.rendered = {RENDERED}; 0")


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("site")
    (folder / "index.html").write_text('<!doctype html><link rel="icon" href="data:,">')
    if not TOOLS_MISSING:
        (folder / "node_modules").symlink_to(tools() / "node_modules")
    with served(folder) as address, Browser(tmp_path_factory.mktemp("profile") / "p") as browser:
        yield browser.page(f"{address}/index.html")


@pytest.mark.slow
@needs_chromium
def test_levels_are_chromiums(page: Page) -> None:
    """Every level of its AnalyserNode in half a second of a buzz, but for what its float32 rounds."""
    samples = others.in_browser(vowels(0.5))
    sound_of(page, samples)
    seen = page.evaluate("""(async () => { const rows = [];
        await rendered(samples, (context) => { const node = context.createAnalyser(); node.connect(context.destination);
            return node; }, (node) => { const row = new Uint8Array(node.frequencyBinCount);
            node.getByteFrequencyData(row); rows.push([...row]); });
        return rows; })()""")
    found = others.levels(samples)
    assert len(seen) >= len(found) == 30 and found.max() > 150
    difference = np.abs(np.array(seen[:30]) - found)
    assert difference.max() <= 1 and (difference > 0).mean() < 0.01


@pytest.mark.slow
@needs_node
@needs_chromium
@pytest.mark.skipif(bool(TOOLS_MISSING), reason=TOOLS_MISSING)
def test_headaudio_is_chromiums(page: Page) -> None:
    """The package's weights in two seconds, by its worklet in Chromium and by its files under node."""
    samples = others.in_browser(vowels(2.0))
    sound_of(page, samples)
    seen = page.evaluate("""(async () => {
        const files = "./node_modules/@met4citizen/headaudio/dist/";
        const { HeadAudio } = await import(files + "headaudio.min.mjs");
        const present = {}, rows = [], pause = (ms) => new Promise((done) => setTimeout(done, ms));
        await rendered(samples, async (context) => {
            await context.audioWorklet.addModule(files + "headworklet.min.mjs");
            const node = new HeadAudio(context);
            node.onvalue = (name, value) => (present[name] = value);
            await node.loadModel(files + "model-en-mixed.bin");
            await pause(100); // messages to the worklet
            return node;
        }, async (node) => { await pause(4); node.update(1000 / 60); rows.push({ ...present }); });
        return rows; })()""")
    found = others.run(shutil.which("node") or "", "headaudio", tools() / "node_modules", samples.tobytes())[:, 0]
    theirs = np.array([[row.get(f"viseme_{name}", 0.0) for name in others.VISEMES] for row in seen])
    assert len(theirs) >= len(found) == 120 and found.max() > 0.5
    assert np.abs(theirs[:120] - found).max() < 1e-5
