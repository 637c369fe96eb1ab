// Voices that are followed: tests/voices/sessions.json has what every language must show, frame by frame, as
// tests/voices/oracle.py works it out. And clocks, misuse, and what a hostile server can do.
import assert from "node:assert/strict";
import test from "node:test";
import { Labial, REST, binary, difference, framesOf, refused, rows, source, wait, words } from "./setup.mjs";

const labial = await Labial.load({ words });
const { sessions } = JSON.parse(source("tests/voices/sessions.json"));
const wanted = framesOf("tests/voices/frames.txt");

function* times([name, first, last, difference]) {
    if (name === "played") yield first;
    else for (let k = 0; k <= Math.floor((last - first) / difference + 1e-6); k++) yield first + k * difference;
}

for (const { name, options: { offset_ms: offset = 0, ...options } = {}, steps, shown } of sessions) {
    test(name, async () => {
        const voice = await labial.voice({ ...options, offset: offset / 1000 });
        const [found, every] = [[], []];
        for (const [call, ...rest] of steps) {
            if (!call.startsWith("play")) {
                voice[call](...rest.map((one) => one ?? undefined));
                continue;
            }
            const frames = [...times([call, ...rest])].flatMap((seconds) => voice.played(seconds));
            found.push([frames.length, frames.length ? voice.number : -1]);
            every.push(...frames);
        }
        assert.equal(difference(every, wanted[name]), "");
        assert.deepEqual(found, shown.map(([count, last]) => [count, last]));
    });
}

const WORDS = [["Maybe", 0.1, 0.5], ["people", 0.55, 0.95], ["hum.", 1, 1.3]];

/** A voice that was told the words. */
async function told(options) {
    const voice = await labial.voice(options);
    for (const word of WORDS) voice.say(...word);
    return voice;
}

/** Draws a voice until that holds, 10 ms apart, or for five seconds; returns how long that was, milliseconds. */
async function drawn(voice, until) {
    const begin = performance.now();
    while (!until() && performance.now() - begin < 5000) {
        voice.at();
        await wait(10);
    }
    assert.ok(until());
    return performance.now() - begin;
}

const media = () => ({ currentTime: 0, paused: false, ended: false, readyState: 4, play: async () => {} });

test("an answer of few messages that told no timings is named at its end, once", async (context) => {
    const warn = context.mock.method(console, "warn", () => {});
    for (const [messages, count] of [[[], 0], [[{}], 1], [[{ type: "WordBoundary", offset: 1e6, duration: 3e6, text: "Go." }], 0]]) {
        const voice = await labial.voice({});
        for (const message of messages) voice.feed(message);
        voice.finish();
        voice.finish();
        assert.equal(warn.mock.callCount(), count);
        warn.mock.resetCalls();
    }
});

test("behind the end of an element's sound the lips come to rest", async (context) => {
    context.mock.method(Date, "now", () => 0); // the computer's clock may be set back
    const element = Object.assign(media(), { currentTime: 0.5 });
    const voice = await labial.voice({ clock: element });
    voice.say("spa", 0.2, 0.6);
    voice.finish();
    assert.ok([...voice.at()].some((value) => Math.abs(value) > 100));
    Object.assign(element, { currentTime: 0.6, ended: true });
    assert.ok(await drawn(voice, () => voice.done) > 400);
    assert.deepEqual([...voice.at()], REST);
});

test("messages of another service than the first ones are told of once", async (context) => {
    const warn = context.mock.method(console, "warn", () => {});
    const first = { alignment: { chars: ["a"], charStartTimesMs: [0], charDurationsMs: [90] } };
    const other = { type: "timestamps", context_id: "c", word_timestamps: { words: ["go"], start: [0], end: [0.5] } };
    for (const [format, count] of [["auto", 1], ["elevenlabs", 0]]) {
        const voice = await labial.voice({ format });
        for (const message of [first, { word: "go", start: 0.5, end: 0.75 }, other, other]) voice.feed(message);
        assert.equal(warn.mock.callCount(), count);
        if (count) assert.match(warn.mock.calls[0].arguments[0], /message 3 .* Cartesia .* ElevenLabs: name the format/);
        warn.mock.resetCalls();
    }
});

test("times that seem to be milliseconds are doubted, once", async (context) => {
    const warn = context.mock.method(console, "warn", () => {});
    const voice = await labial.voice();
    voice.say("Hello,", 0, 10);
    assert.equal(warn.mock.callCount(), 0);
    for (const start of [100, 500]) voice.say("world!", start, start + 400);
    assert.deepEqual(warn.mock.calls.map(({ arguments: [text] }) => text), ['labial: "world!" lasts 400 s; are these seconds?']);
});

test("the end is told once when all was shown, and not of what was cancelled", async () => {
    for (const cancelled of [false, true]) {
        const voice = await told({});
        let ended = 0;
        voice.addEventListener("ended", () => ended++);
        voice.played(0.5);
        if (cancelled) voice.cancel();
        else voice.finish();
        for (const seconds of [0.6, 1, 2, 3, 4]) voice.played(seconds);
        assert.equal(voice.done, true);
        assert.equal(ended, cancelled ? 0 : 1);
    }
});

test("a clock that was not given is asked for, and a time stands for it", async () => {
    const voice = await told({});
    assert.throws(() => voice.played(), { name: "LabialError", message: /^the voice has no clock/ });
    assert.throws(() => voice.at(), { name: "LabialError" });
    assert.equal(voice.number, -1);
    assert.equal(voice.played(0.5).length, 26);
    assert.deepEqual([voice.number, voice.time, voice.fps, voice.done], [25, 0.5, 50, false]);
});

test("at() is the frame that played() returned last, in one object", async () => {
    const [one, other] = [await told({}), await told({ output: "arkit" })];
    for (let seconds = 0; seconds < 1.5; seconds += 0.013) {
        const frames = one.played(seconds);
        const weights = other.at(seconds);
        assert.equal(other.at(seconds), weights);
        if (frames.length) assert.deepEqual(weights, labial.convert(frames.at(-1), "arkit", {}, other.visemes));
        assert.deepEqual([...one.at(seconds)], frames.length ? [...frames.at(-1)] : [...one.at(seconds)]);
    }
    const vrm = await told({ output: "vrm" });
    assert.deepEqual(vrm.played(0.6)[30], labial.convert((await told({})).played(0.6)[30], "vrm", {}, vrm.visemes));
    assert.ok(Math.abs(vrm.visemes.reduce((sum, one) => sum + one, 0) - 128) <= 8);
});

test("an AudioContext counts from begin(), less what its device needs", async () => {
    const context = { currentTime: 100, outputLatency: 0.05, baseLatency: 0.01, destination: {} };
    const stream = { getAudioTracks: () => [] };
    for (const options of [{ clock: context }, { clock: stream, context }]) {
        context.currentTime = 100;
        const voice = await told(options);
        assert.deepEqual(voice.played(), [], "lips wait for begin()");
        assert.deepEqual([...voice.at()], REST);
        voice.begin(100.25);
        context.currentTime = 100.29;
        assert.deepEqual(voice.played(), []);
        context.currentTime = 101.051;
        const frames = voice.played();
        assert.deepEqual(rows(frames), rows((await told({})).played(0.751)));
        assert.deepEqual([voice.number, Math.round(1000 * voice.time)], [37, 100990]);
        assert.throws(() => voice.begin(100), RangeError);
        voice.begin(103); // the next utterance
        voice.say("Mama", 0, 0.4);
        context.currentTime = 103.3;
        const next = await told({});
        next.played(0.751);
        next.begin(2.75);
        next.say("Mama", 0, 0.4);
        assert.deepEqual([...voice.at()], [...next.at(3)]);
    }
    const again = await told({ clock: context }); // cancelled before its first sound: begin() is another utterance
    again.cancel();
    again.begin(context.currentTime);
    again.say("Mama", 0, 0.4);
    context.currentTime += 0.3;
    assert.ok(again.played().some((faps) => faps.some((value) => Math.abs(value) > 30)), "what follows is told");
    const early = await labial.voice({ clock: { ...context, outputLatency: undefined, currentTime: 7 } });
    early.begin();
    assert.ok(Math.abs(early.time - (7 - 0.01 - 0.02)) < 1e-9, "begin() without a time is now, and no frame was shown");
});

test("MediaStreams without a context share one, which asks to run, until the page closes it", async (context) => {
    let [made, asked, last] = [0, 0, null];
    globalThis.AudioContext = class {
        currentTime = ++made;
        constructor() { last = this; }
        resume() { asked++; }
    };
    context.after(() => { delete globalThis.AudioContext; });
    for (let i = 0; i < 5; i++) {
        const voice = await labial.voice({ clock: { getAudioTracks: () => [] } });
        assert.equal(voice.now, 1);
        voice.close();
    }
    assert.deepEqual([made, asked], [1, 5]);
    last.state = "closed";
    assert.equal((await labial.voice({ clock: { getAudioTracks: () => [] } })).now, 2);
});

test("a media element counts while it plays", async () => {
    const element = Object.assign(media(), { paused: true, readyState: 0 });
    const voice = await told({ clock: element });
    assert.deepEqual(voice.played(), []);
    Object.assign(element, { paused: false, readyState: 4 });
    assert.equal(voice.played().length, 1);
    Object.assign(element, { currentTime: 0.5, paused: true });
    assert.equal(voice.played().length, 25);
});

test("a sound that goes on late delays the lips", async () => {
    const context = { currentTime: 5, outputLatency: 0, destination: {} };
    const voice = await told({ clock: context });
    voice.begin(5);
    context.currentTime = 5.4;
    assert.equal(voice.played().length, 21);
    voice.delay(0.3);
    context.currentTime = 5.7;
    assert.equal(voice.played().length, 0);
    context.currentTime = 5.9;
    assert.deepEqual(rows(voice.played()).at(-1), rows((await told({})).played(0.6)).at(-1));
    for (const wrong of [-1, NaN, "1"]) assert.throws(() => voice.delay(wrong), TypeError);
});

test("a cancelled voice eases although its sound has stopped; an element may get another sound", async (context) => {
    context.mock.method(Date, "now", () => 0);
    const element = Object.assign(media(), { currentTime: 0.3 });
    const voice = await told({ clock: element });
    assert.ok([...voice.at()].some(Boolean));
    Object.assign(element, { paused: true });
    voice.cancel(100);
    assert.ok(await drawn(voice, () => voice.done) > 80);
    assert.deepEqual([...voice.at()], REST);
    const { number } = voice;
    assert.equal(number, 15, "easing is no frame of the sound");
    Object.assign(element, { currentTime: 0 });
    voice.begin(0);
    for (const word of WORDS) voice.say(...word);
    Object.assign(element, { paused: false, currentTime: 0.6 });
    const frames = voice.played();
    assert.ok(frames.length === 31 && voice.number === number + 31 && Math.abs(voice.time - 0.6) < 0.021);
    const fresh = rows((await told({})).played(0.6));
    const apart = Math.max(...frames.at(-1).map((value, i) => Math.abs(value - fresh[30][i])));
    assert.ok(apart < 40, "but for the beginning, the motion is that of the words alone");
});

test("a mouth closes although the clock stands, also if the next answer has begun", async () => {
    for (const begins of ["at once", "on the way"]) {
        let heard = 0.3;
        const voice = await told({ clock: () => heard });
        for (let time = 0; time <= heard; time += 0.02) voice.at(time);
        assert.ok([...voice.at()].some((value) => Math.abs(value) > 100));
        voice.cancel(100);
        await wait(begins === "at once" ? 0 : 50);
        voice.at();
        voice.begin(heard);
        for (const [text, start, end] of WORDS) voice.say(text, start + 1, end + 1);
        await drawn(voice, () => ![...voice.at()].some(Boolean));
        assert.ok(!voice.done && Math.abs(voice.time - heard) < 0.021);
        for (; heard < 1.9; heard += 0.02) voice.at();
        const fresh = (await told({})).at(heard - 1.3);
        const apart = [...voice.at()].map((value, i) => Math.abs(value - fresh[i]));
        assert.ok(Math.max(...apart) < 40, `${begins}: the answer is where its sound`);
    }
});

test("a mouth closes at the end although the clock stops with the sound, and the voice has ended", async (context) => {
    let now = 1e6;
    context.mock.method(performance, "now", () => now);
    for (const call of ["at", "played"]) {
        let ended = 0;
        const voice = await told({});
        voice.addEventListener("ended", () => ended++);
        voice.finish();
        for (let time = 0; time < 0.81; time += 0.02) voice[call](time);
        now += 5000;
        assert.deepEqual([voice.played(0.8), voice.done], [[], false], "it waits for sound");
        for (let time = 0.82; time < 1.25; time += 0.02) voice[call](time);
        const stands = rows([voice.at(1.24)])[0];
        const poses = [];
        for (let i = 0; i < 60; i++) {
            now += 10;
            if (call === "at") poses.push(rows([voice.at(1.24)])[0]);
            else poses.push(...rows(voice.played(1.24)));
            assert.deepEqual([voice.done, ended], i < 37 ? [false, 0] : [true, 1]);
        }
        if (call === "at") assert.deepEqual(poses[8], stands);
        else assert.equal(poses.length, 15);
        assert.notDeepEqual(poses[call === "at" ? 20 : 0], stands);
        assert.deepEqual([...new Set(poses.at(-1))], [0]);
        assert.ok(Math.abs(voice.time - 1.24) < 0.001);
    }
});

test("following yields every frame once, in time, and ends", async () => {
    const begin = performance.now();
    const clock = () => (performance.now() - begin < 60 ? null : (performance.now() - begin - 60) / 200);
    const voice = await told({ clock });
    voice.finish();
    const found = [];
    let late = 0;
    for await (const faps of voice.follow()) {
        found.push([...faps]);
        late = Math.max(late, clock() - voice.time);
    }
    assert.ok(voice.done && found.length >= 1.8 * 50 && voice.number === found.length - 1 && late < 1);
    const whole = await told({});
    assert.deepEqual(found.slice(0, 50), rows(whole.played(0.98)));
    await assert.rejects(voice.follow({}).next(), { name: "TypeError", message: /^the clock is .*, not a function/ });
    const silent = await labial.voice();
    silent.finish();
    for await (const faps of silent.follow(() => null)) assert.fail(`${faps}`);
    const interrupted = await told({});
    interrupted.played(0.3);
    interrupted.finish();
    interrupted.cancel(50);
    const poses = [];
    for await (const faps of interrupted.follow(() => 0.3)) poses.push([...faps]);
    assert.ok(interrupted.done && poses.length === 3 && poses.at(-1).every((value) => value === 0));
    const stopped = await told({});
    for await (const faps of stopped.follow(() => 0.1)) {
        assert.ok(faps);
        stopped.close();
    }
});

test("a voice that is not understood says so in a sentence, and goes on", async () => {
    const voice = await told({});
    const before = rows(voice.played(0.2));
    const numbers = [NaN, -1, Infinity, "80", {}, [], true, 1n, Symbol("x")];
    const calls = [
        ...numbers.flatMap((x) => [() => voice.say("a", x), () => voice.say("a", 0, x), () => voice.push("m", x, 9),
            () => voice.begin(x), () => voice.cancel(x)]),
        ...[NaN, Infinity, "1", {}, 1e9].map((x) => () => voice.played(x)),
        ...[null, 5, {}, []].map((x) => () => voice.say(x, 0, 1)),
        ...["", "zzz", -1, 40, {}, null].map((x) => () => voice.push(x, 0, 1)),
        ...[[1, 0], [0, 4000], [4e7, 4e7]].flatMap((times) => {
            return [() => voice.push("m", ...times), () => voice.say("m", ...times)];
        }),
        ...[null, undefined, 5, true, "{", "5", "null", [5], [null], [[]], new TextEncoder().encode("{"),
            new Uint8Array([0x7b, 0xff]), new Array(10001).fill({}), `${"[".repeat(100)}${"]".repeat(100)}`,
        ].map((x) => () => voice.feed(x)),
    ];
    refused(calls);
    for (const sound of [new ArrayBuffer(64), new Int16Array(9), "[]", {}, { audio: "" }, new Blob(["{}"])]) {
        voice.feed(sound);
    }
    for (const odd of [{ word: "a", start: 0, end: NaN }, { word: "a", start: 9, end: 1 }, { word: "a", start: 0, end: 1e9 },
        { word: "a", start: 0, end: null }, { word: "x".repeat(1e6), start: 0, end: 1 }, { audio_offset: 5, viseme_id: 99 },
        { alignment: { chars: ["a"], charStartTimesMs: [], charsDurationsMs: [] } }]) {
        voice.feed(odd);
    }
    const whole = await told({});
    assert.deepEqual(before.concat(rows(voice.played(0.9))), rows(whole.played(0.9)));
    for (const options of [{ format: "x" }, { format: 5 }, { output: "x" }, { model: "x" }, { labels: "x" },
        { clock: 5 }, { unknown: "x" }, { clock: {} }, { offset: "1" }, { own: { a: "x" } }, { own: 5 }]) {
        await assert.rejects(labial.voice(options), ({ name }) => name === "LabialError" || name === "TypeError");
    }
    voice.close();
    voice.close();
    for (const call of [() => voice.feed({}), () => voice.say("a", 0), () => voice.played(1),
        () => voice.begin(), () => voice.delay(1), () => voice.finish(), () => voice.cancel()]) {
        assert.throws(call, { name: "LabialError", message: "the voice is closed" });
    }
    await assert.rejects((await Labial.load()).voice(), { message: /^words are not loaded/ });
});

test("an event may have no document, and a time of zero be left out", async () => {
    const voice = await told({});
    const before = voice.stats.told;
    for (const message of ["", "\r\n", "data: [DONE]\n\n", ": keepalive\n\n", "event: x", "id: 5\n"]) voice.feed(message);
    assert.equal(voice.stats.told, before);
    voice.feed({ timepoints: [{ markName: "go" }, { markName: "on", timeSeconds: 0.5 }] });
    assert.equal(voice.stats.told, before + 2);
});

test("numbers are written out by the caller, once each", async () => {
    const asked = [];
    const numbers = (digits) => (asked.push(digits), "people");
    const own = { 1984: (await labial.words()).phonemes("people").join(" ") };
    const [written, given] = [await labial.voice({ numbers }), await labial.voice({ own })];
    for (const voice of [written, given]) for (const start of [0.1, 1.1]) voice.say("1984", start, start + 0.8);
    assert.deepEqual(rows(written.played(2.2)), rows(given.played(2.2)));
    assert.deepEqual(asked, ["1984"]);
});

test("utterances have names: those that are over change nothing", async () => {
    const [one, other] = [await told({}), await told({})];
    for (const voice of [one, other]) {
        voice.begin(2, "b");
        voice.say("by", 0, 0.5);
        voice.cancel(100);
        if (voice === other) assert.throws(() => voice.begin(1, 7), { name: "TypeError" });
        voice.begin(1, "c");
    }
    const message = (context_id) => ({ type: "timestamps", context_id, done: false,
        word_timestamps: { words: ["hum"], start: [0], end: [0.5] } });
    one.feed(message("c"));
    for (const name of ["b", "c", "b"]) other.feed(message(name));
    for (const seconds of [0.99, 1.9]) assert.deepEqual(rows(one.played(seconds)), rows(other.played(seconds)));
    assert.deepEqual([one.stats.dropped, other.stats.dropped], [0, 2]);
});

test("a loaded model moves lips as the bundled one", async () => {
    const model = labial.model(binary(labial, labial.models.speech));
    const [one, other] = [await told({}), await told({ model })];
    for (const seconds of [0, 0.5, 1.4]) assert.deepEqual(rows(one.played(seconds)), rows(other.played(seconds)));
    other.close();
});

test("a server that tells without end is refused, and what is over is forgotten", async () => {
    const voice = await labial.voice();
    const words = (count, from, length) => {
        const start = Array.from({ length: count }, (_, i) => from + i * length);
        const end = start.map((seconds) => seconds + 0.8 * length);
        return { word_timestamps: { words: start.map(() => "mama"), start, end } };
    };
    voice.feed(words(9999, 0, 1));
    voice.feed(words(9999, 9999, 1));
    assert.throws(() => voice.feed(words(3, 20000, 1)), { name: "LabialError", message: /there is room for 20000/ });
    assert.deepEqual(voice.stats, { messages: 3, told: 19998, skipped: 0, dropped: 0 });
    const long = await labial.voice();
    const memory = labial.memory.bytes.length;
    let frames = 0;
    for (let seconds = 0; seconds < 600; seconds += 10) {
        long.feed(words(40, seconds, 0.25));
        for (let now = seconds; now < seconds + 10; now += 0.5) frames += long.played(now).length;
    }
    assert.equal(frames, 29976);
    assert.equal(labial.memory.bytes.length, memory);
});
