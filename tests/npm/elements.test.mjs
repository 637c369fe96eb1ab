// The elements as a page uses them, over a stand-in for the page: clocks and captions, sources that are closed while they
// are drawn, interruptions. tests/python/test_browser_elements.py has real pages.
import assert from "node:assert/strict";
import test from "node:test";
import { Labial, hearing, heard, load, wait, words } from "./setup.mjs";

/** As much of a page as the elements ask for. */
class Node {
    children = [];
    part = "";
    append(...nodes) { this.children.push(...nodes); }
    get textContent() { return this.children.map((one) => one.textContent ?? one).join(""); }
    set textContent(text) { this.children = [text]; }
}
class Element extends EventTarget {
    isConnected = false;
    attachShadow() { return (this.shadowRoot = Object.assign(new Node(), { ownerDocument: {}, adoptedStyleSheets: [] })); }
    getRootNode() { return {}; }
    getAttribute() { return null; }
    hasAttribute() { return false; }
    closest() { return null; }
}
class Piece extends Node {
    replaceChildren(...nodes) { this.children = nodes; nodes.forEach((one) => Object.assign(one, { parent: this })); }
    replaceWith(other) {
        this.parent.children = this.parent.children.map((one) => (one === this ? other : one));
        other.parent = this.parent;
    }
}
let pictures = new Map(); // that are asked for
let asked = 0;
let now = 0; // milliseconds
Object.assign(globalThis, {
    HTMLElement: Element,
    CSSStyleSheet: class { replaceSync() {} },
    document: { createElement: (localName) => Object.assign(new Piece(), { localName }) },
    requestAnimationFrame: (call) => (pictures.set(++asked, call), asked),
    cancelAnimationFrame: (number) => pictures.delete(number),
});

const { LabialFace } = await load("/labial-face.js");
const { attach } = await load("/attach.js");
const labial = await Labial.load({ hearing, words });

/** A face that draws nothing, on the page. */
class Face extends LabialFace {
    static create = () => () => {};
    ended = 0; // events
    constructor() {
        super();
        this.addEventListener("ended", () => { this.ended++; });
        this.insert();
    }
    insert() {
        this.isConnected = true;
        this.connectedCallback();
    }
    remove() {
        this.isConnected = false;
        this.disconnectedCallback();
    }
}

/** The pictures of so many seconds, 16 ms each; `before` is called before each. Returns how far the mouth moved at most. */
function play(face, seconds, before = () => {}) {
    let most = 0;
    for (const end = now + 1000 * seconds; now < end; now += 16) {
        before();
        const pose = [...face.faps];
        const due = [...pictures.values()];
        pictures = new Map();
        due.forEach((call) => call(now));
        most = Math.max(most, ...pose.map((value, i) => Math.abs(value - face.faps[i])));
    }
    return most;
}

const wide = (face) => -(face.faps[3] + face.faps[4]);
const rests = (face) => !face.faps.some(Boolean) && pictures.size === 0;
const caption = (face) => face.shadowRoot.children.at(-1).children.find(({ localName }) => localName === "mark")?.textContent;

/** A voice that says aah, by the pictures' time unless it has another clock. */
async function voiceOf(clock, options) {
    const begin = now;
    const voice = await labial.voice({ clock: clock ?? (() => (now - begin) / 1000), ...options });
    voice.push("AA", 0, 9);
    return voice;
}

/** An AudioContext whose time is that of the pictures. */
function contextOf() {
    const begin = now;
    return { destination: {}, get currentTime() { return (now - begin) / 1000; } };
}

/** A hearing of a hum that opens the mouth, with an AudioContext. */
async function hearingOf(context = null, options = {}) {
    const one = await labial.hear(null, { sampleRate: 16000, context, ...options });
    one.push(Int16Array.from({ length: 16000 }, (_, i) => {
        let tone = 0;
        for (let k = 1; k < 20; k++) tone += Math.sin((2 * Math.PI * 120 * k * i) / 16000) / k;
        return 4000 * tone;
    }), 0);
    return one;
}

function streamOf() {
    const stream = labial.stream();
    stream.push("AA", 9000);
    stream.push("m", 90);
    return stream;
}

const trackOf = (seconds = 1, options = {}) => labial.render([{ start: 0, end: seconds, label: "AA" }], options);
/** Sources that do not end: the property, what makes one, and what closes it. */
const SOURCES = [["voice", voiceOf, "close"], ["hearing", () => hearingOf(contextOf()), "close"], ["hearing", hearingOf, "close"],
    ["stream", streamOf, "free"]];

test("captions follow the clock of the voice", async () => {
    const words = "one two three four".split(" ").map((text, i) => ({ text, start: 0.5 * i, end: 0.5 * i + 0.4 }));
    let seconds = 0;
    const context = { outputLatency: 0.1, destination: {}, get currentTime() { return 7 + seconds; } };
    for (const clock of [() => seconds, context]) {
        seconds = 0;
        const face = new Face();
        const voice = await voiceOf(clock);
        face.voice = voice;
        face.words = words;
        play(face, 3); // its clock stands, or its sound has not begun
        assert.equal(caption(face), clock === context ? undefined : "one");
        if (clock === context) voice.begin(7 - 0.1);
        const seen = [];
        play(face, 2, () => { // at half its speed
            seconds += 0.008;
            seen.push([face.position, caption(face)]);
        });
        for (const [at, word] of seen.slice(2)) assert.equal(word, words[Math.floor(at / 0.5 + 1e-9)].text, `${at}`);
        assert.ok(Math.abs(face.position - 1) < 0.03 && caption(face) === "three", `${face.position}`);
        seconds += 0.6;
        play(face, 0.05);
        assert.equal(caption(face), "four");
        face.remove();
    }
});

test("captions go with the source, and stay for a second behind the end of one without a sound", async () => {
    const face = new Face();
    const text = () => face.caption;
    face.words = [{ text: "Go", start: 0, end: 0.5 }, { text: "now.", start: 0.5, end: 0.9 }];
    face.track = trackOf();
    let ended = 0;
    face.addEventListener("ended", () => { ended = face.position; });
    play(face, 1.8);
    assert.ok(ended > 1 && ended < 1.4 && text() === "Go now.", `${ended}`);
    play(face, 0.2);
    assert.ok(text() === "" && pictures.size === 0);
    face.words = [{ text: "Go", start: 0, end: 0.5 }];
    face.voice = await voiceOf();
    play(face, 0.3);
    assert.equal(text(), "Go");
    face.voice.close();
    play(face, 0.1);
    assert.equal(text(), "");
    play(face, 0.3);
    assert.ok(rests(face) && text() === "");
    face.track = trackOf();
    play(face, 0.3);
    assert.equal(text(), "Go");
    face.track = null;
    assert.equal(text(), "");
});

test("a source of another output is refused where it is set, and the one before goes on", async () => {
    const face = new Face();
    const track = face.track = trackOf();
    const others = {
        track: trackOf(1, { output: "arkit" }),
        stream: labial.stream({ output: "oculus" }),
        hearing: await hearingOf(null, { output: "vrm" }),
        voice: await voiceOf(null, { output: "arkit" }),
    };
    for (const [name, source] of Object.entries(others)) {
        assert.equal(typeof source.output, "string");
        assert.throws(() => { face[name] = source; }, { name: "TypeError", message: /output "faps"/ }, name);
        const early = Promise.resolve(source);
        assert.throws(() => { face[name] = early; }, { name: "TypeError", message: /\[object Promise\].* no / }, name);
    }
    play(face, 0.4);
    assert.ok(face.track === track && wide(face) > 50);
    face.remove();
});

test("behind the end of its sound a track is drawn as heard() has it, and a source set then goes by the clock", ({ mock }) => {
    mock.method(performance, "now", () => now);
    const face = new Face();
    const track = trackOf(2);
    const audio = face.audio = { currentTime: 1.5, ended: false, paused: true };
    face.track = track;
    play(face, 0.1);
    assert.equal(face.position, 1.5);
    Object.assign(audio, { currentTime: 1.7, ended: true }); // a jump to the end
    play(face, 0.2, () => assert.ok(face.position === 1.5 || Math.abs(face.position - heard(audio)) < 0.017));
    assert.ok(face.position > 1.85 && face.position < 1.91, `${face.position}`);
    face.track = track;
    play(face, 0.2);
    assert.ok(face.position > 0.15 && face.position < 0.21, `${face.position}`);
    Object.assign(audio, { currentTime: 0, ended: false }); // played again
    play(face, 0.1);
    Object.assign(audio, { currentTime: 0.3, ended: true });
    play(face, 0.1);
    assert.ok(face.position > 0.35 && face.position < 0.41, `${face.position}`);
    face.remove();
});

test("a source that is closed while it is drawn leaves a mouth at rest, for the next track", async () => {
    for (const [name, make, ends] of SOURCES) {
        const face = new Face();
        const source = await make();
        face[name] = source;
        play(face, 0.5);
        const open = wide(face);
        assert.ok(open > 60, `${name}: ${open}`);
        assert.equal(source.closed, false);
        source[ends]();
        assert.equal(source.closed, true);
        const most = play(face, 0.1);
        assert.ok(wide(face) > 0.1 * open && most < 0.2 * open, `${name} eases: ${most} of ${open}`);
        play(face, 0.3);
        assert.ok(rests(face) && face[name] === null && face.ended === 0, name);
        face.track = trackOf();
        play(face, 0.5);
        assert.ok(wide(face) > 60);
        face[name] = source; // which is closed
        play(face, 0.5);
        assert.ok(rests(face) && face[name] === null, `${name}, closed before`);
    }
});

test("a source may be closed before a cancel and during it", async () => {
    for (const [name, make, ends] of SOURCES) {
        for (const when of ["before", "during"]) {
            const face = new Face();
            const source = await make();
            face[name] = source;
            play(face, 0.5);
            if (when === "before") source[ends]();
            let rested = false;
            const cancelled = face.cancel(300).then(() => { rested = true; });
            play(face, 0.1);
            if (when === "during") source[ends]();
            await wait(0);
            assert.equal(rested, false, `${name} ${when}`);
            play(face, 0.4);
            await cancelled;
            assert.ok(rests(face) && face[name] === null, `${name} ${when}`);
        }
    }
});

test("a voice and a hearing that are closed are at rest for whoever asks", async () => {
    const names = ["jawOpen", "mouthFunnel", "mouthPucker", "mouthClose"];
    const mesh = { morphTargetDictionary: Object.fromEntries(names.map((name, i) => [name, i])), morphTargetInfluences: [0, 0, 0, 0] };
    const head = attach({ traverse: (visit) => visit(mesh) });
    for (const make of [(options) => voiceOf(() => 0.5, options), (options) => hearingOf({ currentTime: 0.5, destination: {} }, options)]) {
        const source = await make();
        assert.ok(-(source.at()[3] + source.at()[4]) > 60);
        source.close();
        assert.ok(source.done && [...source.at(), ...source.at(0.5)].every((value) => value === 0));
        head.source = await make({ output: head.output });
        head.update();
        const shown = [...mesh.morphTargetInfluences];
        assert.ok(shown.some((weight) => weight > 0.01));
        head.source.close();
        head.update(); // eases
        assert.ok(mesh.morphTargetInfluences.every((weight, i) => weight <= shown[i] && weight >= shown[i] / 4));
        assert.equal(head.source, null);
        await wait(250);
        assert.deepEqual(mesh.morphTargetInfluences, [0, 0, 0, 0]);
    }
    const silent = await labial.voice({});
    silent.close();
    assert.ok(silent.done && !silent.cancelled && [...silent.at(5)].every((value) => value === 0));
});

test("a cancel ends although the clock of what is heard stands", async () => {
    const face = new Face();
    face.hearing = await hearingOf({ currentTime: 0.5, destination: {} });
    play(face, 0.1);
    assert.ok(wide(face) > 60);
    let rested = false;
    face.cancel(200).then(() => { rested = true; });
    play(face, 0.3);
    await wait(0);
    assert.ok(rested && rests(face));
});

test("a face that leaves the page during a cancel, or is cancelled outside of it, keeps a voice with a clock", async () => {
    for (const during of [true, false]) {
        const face = new Face();
        const begin = now;
        const voice = await voiceOf();
        face.voice = voice;
        play(face, 0.5);
        if (during) face.cancel();
        face.remove();
        if (!during) await face.cancel();
        assert.equal(face.voice, voice);
        voice.begin((now - begin) / 1000);
        voice.push("AA", 0, 9);
        face.insert();
        play(face, 0.6);
        assert.ok(wide(face) > 60);
        face.remove();
    }
});

test("a face that has left the page is nothing to its voice, and is again on its return", async () => {
    const face = new Face();
    const voice = await voiceOf();
    face.voice = voice;
    for (const [change, ended] of [[() => face.remove(), 0], [() => face.insert(), 1], [() => { face.voice = null; }, 1]]) {
        change();
        voice.dispatchEvent(new Event("ended"));
        assert.equal(face.ended, ended);
    }
});
