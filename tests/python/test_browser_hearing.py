"""Hearing in a real browser: lips of an <audio> element, a MediaStream and a node against the sound that leaves for the
loudspeaker, which a recorder of the test's own takes down."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any, Dict, Iterator

import numpy as np
import pytest

import labial
from browser import Browser, Page, served
from labial.files.frames import opening
from models import write_wav
from npm import lay
from packages import needs_runtime

FLITE = shutil.which("flite")
pytestmark = [pytest.mark.slow, needs_runtime,
              pytest.mark.skipif(not FLITE, reason="needs flite: install the Debian package flite")]

TEXT = "Mama may be happy. Papa saw a boat by the water."
FPS = 50
#: How long a page is watched: longer than the text and what comes before it, so that silence follows.
SECONDS = 6
PAGE = """<!DOCTYPE html>
<link rel="icon" href="data:,">
<labial-mouth id="face"></labial-mouth>
<audio id="voice" src="voice.wav"></audio>
<script type="module">
import { Labial } from "./node_modules/labial/index.js";
import "./node_modules/labial/labial-mouth.js";

const RECORDER = `registerProcessor("recorder", class extends AudioWorkletProcessor {
    process([[samples]]) {
        this.port.postMessage([currentTime, samples ? samples.slice() : new Float32Array(128)]);
        return true;
    }
});`;
const labial = window.labial = await Labial.load({ hearing: () => import("./node_modules/labial-hearing/index.js") });
const data = await (await fetch("voice.wav")).arrayBuffer();
window.ahead = () => import("./node_modules/labial-hearing-host/ahead.js");

/** A source of sound in each form: what is heard, and what begins it. */
const sources = {
    element: async () => [voice, () => voice.play()],
    stream: async (context) => {
        const [node, begin] = await sources.node(context);
        const out = context.createMediaStreamDestination();
        node.connect(out);
        return [out.stream, begin];
    },
    remote: async (context) => {
        const [stream, begin] = await sources.stream(context);
        const [here, there] = [new RTCPeerConnection(), new RTCPeerConnection()];
        here.onicecandidate = ({ candidate }) => candidate && there.addIceCandidate(candidate);
        there.onicecandidate = ({ candidate }) => candidate && here.addIceCandidate(candidate);
        const come = new Promise((resolve) => { there.ontrack = ({ streams: [one] }) => resolve(one); });
        here.addTrack(stream.getTracks()[0], stream);
        await here.setLocalDescription();
        await there.setRemoteDescription(here.localDescription);
        await there.setLocalDescription();
        await here.setRemoteDescription(there.localDescription);
        window.connections = [here, there];
        return [await come, async () => {
            while (here.connectionState !== "connected") await new Promise((resolve) => setTimeout(resolve, 50));
            begin();
        }];
    },
    node: async (context) => {
        const buffer = await context.decodeAudioData(data.slice(0));
        const node = new AudioBufferSourceNode(context, { buffer });
        return [node, () => node.start()];
    },
};

window.hear = async (kind, rate, options) => {
    const context = rate ? new AudioContext({ sampleRate: rate }) : new AudioContext();
    const [source, begin] = await sources[kind](context);
    const hearing = await labial.hear(source, { context, ...options });
    await context.audioWorklet.addModule(URL.createObjectURL(new Blob([RECORDER], { type: "text/javascript" })));
    const recorder = new AudioWorkletNode(context, "recorder", { channelCount: 1, channelCountMode: "explicit" });
    const heard = window.heard = { rate: context.sampleRate, delay: hearing.delay, latency: hearing.latency,
        first: null, samples: [], seen: [], drawn: [], over: false };
    recorder.port.onmessage = ({ data: [time, samples] }) => {
        heard.first ??= time;
        for (const sample of samples) heard.samples.push(Math.round(32768 * sample));
        if (heard.samples.length % 512 === 0) heard.seen.push([hearing.now, ...hearing.at()]);
    };
    hearing.sound.connect(recorder).connect(context.destination);
    face.hearing = hearing;
    requestAnimationFrame(function watch() {
        if (heard.over) return;
        heard.drawn.push([...hearing.at(), ...face.faps]);
        requestAnimationFrame(watch);
    });
    window.hearing = hearing;
    await begin();
};
window.ready = true;
</script>
"""


@pytest.fixture(scope="module")
def folder(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hearing") / "page"
    lay(npm_package, folder, "labial", "labial-hearing", "labial-hearing-host")
    (folder / "index.html").write_text(PAGE, encoding="utf-8")
    harmonics = np.arange(1, 20)  # of 100 Hz, so that what is delayed by 0.2 s adds up
    tone = np.sin(2 * np.pi * 100 * np.outer(np.arange(16000) / 16000, harmonics)) / harmonics
    write_wav(folder / "tone.wav", 4000 * tone.sum(axis=1))
    subprocess.run([str(FLITE), "-voice", "slt", "-t", TEXT, "-o", str(folder / "voice.wav")], check=True, timeout=60)
    return folder


@pytest.fixture
def page(folder: Path, browser: Browser) -> Iterator[Page]:
    with served(folder) as address:
        page = browser.page(f"{address}/index.html")
        page.wait_for("window.ready")
        yield page
        assert page.errors() == []


def lips_of(heard: Dict[str, Any], model: str) -> np.ndarray:
    """(T,) the opening that the library makes of the recording."""
    recorded, rate = np.array(heard["samples"]), int(heard["rate"])
    if rate > 48000:
        recorded, rate = recorded[: len(recorded) // 2 * 2].reshape(-1, 2).mean(axis=1), rate // 2
    samples = np.clip(np.round(recorded), -32768, 32767).astype(np.int16)
    with labial.Hearing(rate, model=f"hear_{model}") as hearing:
        return opening(np.array([frame.faps for frame in hearing.frames([samples])]))


@pytest.mark.parametrize(("kind", "rate", "model"), [
    ("element", 0, "small"), ("stream", 44100, "large"), ("node", 96000, "small"), ("remote", 0, "small"),
    ("node", 0, "ahead"),
])
def test_lips_move_with_what_is_heard(page: Page, kind: str, rate: int, model: str) -> None:
    """Catches lips or a sound that are late, blocks that are lost, and a face that is drawn from another clock."""
    page.evaluate(f"hear('{kind}', {rate}, {{ model: {'ahead' if model == 'ahead' else repr(model)} }})")
    page.wait_for(f"heard.samples.length > {SECONDS} * heard.rate", 60)
    heard = page.evaluate("heard.over = true, heard")
    assert heard["delay"] >= heard["latency"]
    expected = lips_of(heard, model)
    seen = np.array(heard["seen"])
    times, lips = seen[:, 0] - heard["first"], opening(seen[:, 1:])
    opened = np.flatnonzero(expected > 100) / FPS
    spoken = (times > opened[0]) & (times < min(opened[-1], len(expected) / FPS - 0.5))
    assert spoken.sum() > 100

    def difference(lag: float) -> float:  # of most: a busy machine may stop the page for a moment
        at = (times[spoken] - lag) * FPS
        return float(np.median(np.abs(np.interp(at, np.arange(len(expected)), expected) - lips[spoken])))

    lags = np.arange(-0.2, 0.201, 0.01)
    best = lags[np.argmin([difference(lag) for lag in lags])]
    assert abs(best) <= 0.02, [round(difference(lag), 1) for lag in lags]
    assert difference(0) < 0.2 * float(np.std(expected))
    assert lips[times > opened[-1] + 0.3].max() < 100 and lips[spoken].max() > 200
    drawn = np.array(heard["drawn"])
    apart = np.abs(drawn[:, :13] - drawn[:, 13:]).max(axis=1)
    assert len(drawn) > 5 and np.median(apart) < 0.2 * float(np.std(expected))


def test_a_cancel_silences_and_a_restart_goes_on(page: Page) -> None:
    """Catches a sound behind closed lips, a face that stays open, and an element that is heard only once."""
    page.evaluate("hear('element', 0, {})")
    page.wait_for("heard.samples.length > heard.rate && Math.abs(face.faps[4]) > 100")
    refused = "(() => { try { hearing.push(new Int16Array(1)); } catch ({ code }) { return code; } })()"
    assert page.evaluate(refused) == -5
    page.evaluate("face.cancel(200)")
    assert page.evaluate("[hearing.done, ...face.faps]") == [True] + [0] * 13
    level = "heard.samples.slice(-heard.rate / 5).reduce((sum, one) => sum + Math.abs(one), 0) / (heard.rate / 5)"
    page.wait_for(f"{level} < 1")
    assert not page.evaluate("voice.paused")
    page.evaluate("hearing.restart(), voice.currentTime = 0, face.hearing = hearing, 0")
    page.wait_for(f"{level} > 300 && Math.abs(face.faps[4]) > 100")
    assert page.evaluate("face.hearing === hearing && hearing.segments().length > 0")
    page.evaluate("hearing.close(), heard.over = true, voice.play()")
    assert page.evaluate("hearing.done && hearing.sound === null && !voice.paused")
    page.evaluate("face.hearing = null, face.show(new Array(13).fill(0))")
    page.evaluate("labial.hear(voice).then((one) => { face.hearing = hearing = one; voice.currentTime = 0; })")
    page.wait_for("Math.abs(face.faps[4]) > 100")
    page.evaluate("hearing.close()")


def test_hearings_of_one_element_open_and_close_in_any_order(page: Page) -> None:
    """Catches a hearing that the next makes deaf, a close that throws, and a sound that is doubled or lost."""
    page.evaluate("""(async () => {
        const context = window.context = new AudioContext(), out = new GainNode(context);
        out.connect(context.destination);
        Object.defineProperty(context, "destination", { value: out });
        const audio = Object.assign(new Audio("tone.wav"), { loop: true });
        const peak = (node) => {
            const meter = new AnalyserNode(context, { fftSize: 2048 }), block = new Float32Array(2048);
            node.connect(meter);
            return () => (meter.getFloatTimeDomainData(block), Math.max(...block));
        };
        window.loud = peak(out);
        window.hearings = [];
        window.open = async (options) => {
            const hearing = await labial.hear(audio, { context, ...options });
            hearings.push(Object.assign(hearing, { peak: peak(hearing.sound) }));
        };
        window.hears = (hearing) => hearing.peak() > 0.15 && Math.max(...hearing.at().map(Math.abs)) > 50;
        await open();
        await audio.play();
    })()""")

    def settled(sound: bool = True) -> None:
        right = "loud() > 0.15 && loud() < 0.3" if sound else "loud() === 0"
        page.wait_for(f"hearings.every(one => one.closed || hears(one)) && {right}")

    settled()
    for step in ("open()", "open({ play: false })", "open()", "hearings[0].close()", "hearings[3].close()", "open()"):
        page.evaluate(f"Promise.resolve({step}).then(() => 0)")
        settled()
    for number in (4, 1):
        page.evaluate(f"hearings[{number}].close()")
        settled(number == 4)  # the last one is not played
    page.evaluate("hearings[2].close()")
    settled()
    page.evaluate("open().then(() => hearings[5].sound.disconnect()).then(() => hearings[5].close())")
    settled()


def test_a_context_that_the_page_closed_is_not_taken_again(page: Page) -> None:
    """Catches all later hearings failing, and a stream that nobody says is lost since it was so from the beginning."""
    page.evaluate("""(async () => {
        const { stream } = new AudioContext().createMediaStreamDestination();
        const first = await labial.hear(stream);
        await first.context.close();
        window.refused = await labial.hear(stream, { context: first.context }).catch(({ message }) => message);
        stream.getTracks()[0].stop();
        const second = await labial.hear(stream);
        second.addEventListener("lost", () => { window.lost = second.context !== first.context; });
    })()""")
    assert page.evaluate("refused") == "the AudioContext of the source was closed"
    page.wait_for("window.lost")


def test_what_cannot_be_heard_is_told(page: Page) -> None:
    """Catches an error of the browser's that says nothing, and one for a page without https."""
    attempt = "({}).then(() => '', ({{ message }}) => message)"
    for source, message in (
        ("new AudioContext().createMediaStreamDestination().stream", ""),
        ("new MediaStream()", "the stream has no track of sound"),
        ("face", "the source is [object HTMLElement], not a MediaStream, an audio element or an AudioNode"),
    ):
        assert page.evaluate(attempt.format(f"labial.hear({source})")) == message
    page.evaluate("Object.defineProperty(AudioContext.prototype, 'audioWorklet', { value: undefined }), 0")
    assert "AudioWorklet" in page.evaluate(attempt.format("labial.hear(voice)"))
