"""The client of docs/streams.md, with a stand-in for ElevenLabs' stream: in node, and in Chromium with an AudioContext,
where lips are held to the sound that leaves for the loudspeaker."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any, Dict, Iterator

import numpy as np
import pytest

import labial
from browser import Browser, Page, served
from labial.files.frames import opening
from messages import RATE, answers, elevenlabs
from npm import TOOLS_MISSING, lay, node
from packages import SOURCE, needs_runtime
from pages import parse

pytestmark = [pytest.mark.slow, needs_runtime, pytest.mark.skipif(bool(TOOLS_MISSING), reason=TOOLS_MISSING)]

TEXT = "Mama may go. Papa saw a boat."
FPS = 50

#: The client under node, by its own clock, which begins with the first piece of the sound.
NODE = """
import { Labial } from "labial";
import { speak } from "./client.js";
const labial = await Labial.load({ words: () => import("labial-words") });
let begin = null;
const clock = () => (begin === null ? null : (performance.now() - begin) / 1000);
const voice = await labial.voice({ format: "elevenlabs", clock });
speak(process.argv[2], process.argv[3], voice, () => { begin ??= performance.now(); });
const frames = [];
let latest = 0;
for await (const frame of voice.follow()) {
    frames.push([...frame]);
    latest = Math.max(latest, clock() - voice.time);
}
console.log(JSON.stringify({ frames, latest, number: voice.number }));
process.exit();
"""
PAGE = """<!DOCTYPE html>
<link rel="icon" href="data:,">
<labial-mouth id="face"></labial-mouth>
<script type="importmap">{"imports": {"labial": "./node_modules/labial/index.js",
    "labial-words": "./node_modules/labial-words/index.js"}}</script>
<script type="module">
import { Labial } from "labial";
import "./node_modules/labial/labial-mouth.js";
import { speak } from "./client.js";
import { player } from "./player.js";
import { talk } from "./page.js";

const RECORDER = `registerProcessor("recorder", class extends AudioWorkletProcessor {
    process([[samples]]) {
        const loudest = samples ? Math.max(...samples, 0) : 0;
        this.port.postMessage([currentTime, loudest]);
        return true;
    }
});`;
const labial = await Labial.load({ words: () => import("labial-words") });
const connect = AudioBufferSourceNode.prototype.connect;

/** Speaks with the FAPs taken down, and what is heard at which time of the context. */
window.hear = async (address, text) => {
    const context = new AudioContext();
    await context.audioWorklet.addModule(URL.createObjectURL(new Blob([RECORDER], { type: "text/javascript" })));
    const recorder = new AudioWorkletNode(context, "recorder", { channelCount: 1, channelCountMode: "explicit" });
    recorder.connect(context.destination);
    AudioBufferSourceNode.prototype.connect = function () { return connect.call(this, recorder); };
    const voice = await labial.voice({ format: "elevenlabs", clock: context });
    Object.assign(window, { voice, context, seen: [], heard: [], drawn: [] });
    recorder.port.onmessage = ({ data }) => {
        heard.push(data);
        if (!voice.done) seen.push([voice.now, ...voice.at()]);
    };
    face.voice = voice;
    requestAnimationFrame(function watch() {
        drawn.push([...voice.at(), ...face.faps]);
        if (!voice.done) requestAnimationFrame(watch);
    });
    speak(address, text, voice, player(context, voice, RATE));
};
/** The page of docs/streams.md as it is. */
window.shown = [];
window.talk = (address, text) => talk(address, text, ({ jawOpen }) => shown.push(jawOpen));
Object.assign(window, { labial, ready: true });
</script>
""".replace("RATE", str(RATE))


@pytest.fixture(scope="module")
def folder(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("voice") / "site"
    lay(npm_package, folder, "labial", "labial-words")
    for block in parse(SOURCE / "docs" / "streams.md"):
        if block.name:
            (folder / block.name).write_text(block.text, encoding="utf-8")
    (folder / "package.json").write_text('{ "type": "module" }')
    (folder / "main.js").write_text(NODE, encoding="utf-8")
    (folder / "index.html").write_text(PAGE, encoding="utf-8")
    return folder


@pytest.fixture
def page(folder: Path, browser: Browser) -> Iterator[Page]:
    with served(folder) as site:
        page = browser.page(f"{site}/index.html")
        page.wait_for("window.ready")
        yield page
        assert page.errors() == []


def expected() -> np.ndarray:
    """(T, 13) FAPs of all that is told, known from the beginning."""
    messages = answers(TEXT)
    return np.array(labial.render(labial.read_timings(messages, source="elevenlabs"), exact=True))


def test_client_in_node(folder: Path) -> None:
    """Words that come in time: every frame is that of the whole answer, bit for bit, and none is late."""
    with elevenlabs() as address:
        done = subprocess.run([str(node(22)), "main.js", address, TEXT], cwd=folder, stdout=subprocess.PIPE, check=True,
                              timeout=60, encoding="utf-8")
    found: Dict[str, Any] = json.loads(done.stdout)
    whole = expected()
    frames = np.array(found["frames"])
    assert found["number"] == len(frames) - 1 and len(frames) > len(whole) and found["latest"] < 0.3
    assert np.array_equal(frames[: len(whole) - 10], whole[: len(whole) - 10])
    assert np.abs(frames[-1]).max() < 60 and np.abs(frames).max() > 100


def test_client_in_a_page(page: Page) -> None:
    """Catches a begin that is not that of the sound, a delay that is subtracted twice, and a face by another clock."""
    with elevenlabs() as address:
        page.evaluate(f"hear({address!r}, {TEXT!r})")
        page.wait_for("voice.done", 60)
    heard, seen, drawn = (np.array(page.evaluate(name)) for name in ("heard", "seen", "drawn"))
    loud = heard[heard[:, 1] > 0.01, 0]
    whole = opening(expected())
    assert abs(loud[-1] - loud[0] - len(whole) / FPS) < 0.1
    times, lips = seen[:, 0] - loud[0], opening(seen[:, 1:])
    spoken = (times > 0) & (times < len(whole) / FPS - 0.3)
    assert spoken.sum() > 100

    def difference(lag: float) -> float:
        at = np.clip(np.floor((times[spoken] - lag) * FPS), 0, len(whole) - 1).astype(int)
        return float(np.median(np.abs(whole[at] - lips[spoken])))

    lags = np.arange(-0.2, 0.201, 0.01)
    best = lags[np.argmin([difference(lag) for lag in lags])]
    assert abs(best) <= 0.02 and difference(best) < 1, [round(difference(lag), 1) for lag in lags]
    assert lips[spoken].max() > 200 and np.abs(lips[times < -0.01]).max(initial=0) == 0
    apart = np.abs(drawn[:, :13] - drawn[:, 13:]).max(axis=1)
    assert len(drawn) > 5 and np.median(apart) < 0.2 * float(np.std(whole))


def test_page_of_the_manual_and_an_interruption(page: Page) -> None:
    """The three files as they are; then sound and lips are interrupted, begin again, and end with the face."""
    with elevenlabs(0.05) as address:
        page.evaluate(f"talk({address!r}, 'Mama.')")
        page.wait_for("shown.length > 5 && Math.max(...shown) > 0.1 && shown.at(-1) === 0", 60)
        page.evaluate(f"hear({address!r}, {TEXT!r})")
        page.wait_for("Math.abs(face.faps[4]) > 100", 60)
        begin = page.evaluate("context.suspend(), voice.cancel(200), performance.now()")
        page.wait_for("voice.done")
        assert page.evaluate("performance.now()") - begin < 2000
        page.wait_for("!face.faps.some(Boolean)")
        page.evaluate("context.resume(), voice.begin(context.currentTime + 0.2), voice.say('Aah', 0, 60), 0")
        page.wait_for("Math.abs(face.faps[4]) > 100", 60)
        assert page.evaluate("face.cancel(200).then(() => voice.cancelled)")
        page.wait_for("!face.faps.some(Boolean) && voice.done", 60)


def test_stand_in_is_what_readers_expect() -> None:
    """Each sentence is a message whose times begin at 0, as the sample of ElevenLabs' web socket has it."""
    found = answers(TEXT)
    assert [message["isFinal"] for message in found] == [None, None, True]
    total = sum(len(message["alignment"]["chars"]) for message in found[:-1])
    timings = labial.read_timings(found)
    assert total * 70 - 200 <= sum(length for _, length in timings) <= total * 70
    assert [label for label, _ in timings if label != "SIL"][:4] == ["M", "AA", "M", "AH"]
