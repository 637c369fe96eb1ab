// What a program does with streams and tracks beside the conformance streams: feeding, laughs, other models, tracks in
// step with a sound, misuse.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import test from "node:test";
import { Labial, LabialError, REST, binary, folder, laughter, refused, rows, source, unpack, wait } from "./setup.mjs";

const mouth = await Labial.load({ laughter });
const WORDS = [["sil", 100], ["HH", 70], ["ə", 60], ["l", 80], ["ˈoʊ", 220], ["m", 80], ["sil", 150]];

const pushAll = (stream, words = WORDS) => words.forEach(([label, ms]) => stream.push(label, ms));

/** A stream that was fed and has ended. */
function fed(options, feed = pushAll) {
    const stream = mouth.stream(options);
    feed(stream);
    stream.end();
    return stream;
}

function speak(options, feed) {
    const stream = fed(options, feed);
    const frames = [...stream];
    assert.ok(stream.done);
    stream.free();
    return frames;
}

/** The same words as segments, seconds. */
function segments(words = WORDS) {
    let end = 0;
    return words.map(([label, ms]) => ({ start: end, end: (end += ms / 1000), label }));
}

test("ticks deliver what iterating does, later by the delay", () => {
    const stream = fed();
    const { delay, frames } = stream.latency;
    assert.equal(frames, 38);
    const ticks = [];
    while (!stream.done) {
        const frame = stream.tick();
        ticks.push(frame && [...frame]);
    }
    assert.deepEqual(ticks.slice(0, delay), new Array(delay).fill(null));
    assert.deepEqual(ticks.filter(Boolean), rows(speak()));
    assert.equal(stream.number, 49, "12 of them come to rest");
    assert.equal(stream.time, 0.98);
});

test("a stream begins and ends at rest, unless it is to be exact", () => {
    const far = (faps) => Math.max(...Array.from(faps, Math.abs));
    const said = (s) => s.push("AA", 300);
    const frames = speak({}, said);
    assert.equal(frames.length, 15 + 12);
    assert.ok(far(frames[0]) <= 40 && far(frames[14]) > 200 && far(frames[26]) === 0);
    const exact = speak({ exact: true }, said);
    assert.deepEqual(rows(exact), rows(frames.slice(0, 15)));
    const one = [{ start: 0, end: 0.3, label: "AA" }];
    assert.equal(mouth.render(one).length, 27);
    assert.equal(mouth.render(one, { exact: true }).length, 15);
    assert.ok(mouth.render(one).at(5).every((value) => value === 0));
});

test("where phonemes are late, a clock shows the way to rest, and asking for frames moves nothing", () => {
    for (const exact of [false, true]) {
        const stream = mouth.stream({ exact });
        stream.push("AA", 200);
        stream.push("IY", 200);
        const shown = [];
        while (!stream.starved) shown.push(stream.tick());
        const { number } = stream;
        const late = [];
        for (let i = 0; i < 30; i++) {
            late.push([...(stream.tick() ?? [])]);
            assert.ok(stream.starved && stream.number === number);
        }
        assert.deepEqual(late.map((faps) => faps.length > 0), late.map((_, i) => !exact && i >= 4 && i < 16));
        if (!exact) assert.ok(late[15].every((value) => value === 0) && late[14].some(Boolean));
        stream.end();
        assert.equal([...stream].length + number + 1, 20 + (exact ? 0 : 12));
    }
    const asked = mouth.stream();
    const found = [];
    for (const [label, ms] of WORDS) {
        asked.push(label, ms);
        for (let i = 0; i < 20; i++) found.push(...asked);
    }
    asked.end();
    found.push(...asked);
    assert.deepEqual(rows(found), rows(speak()));
});

test("a tick's frame is the same object, an iterator's is not", () => {
    const frames = speak();
    assert.notEqual(frames[0], frames[1]);
    for (const output of ["faps", "arkit"]) {
        const stream = fed({ output });
        const found = new Set();
        while (!stream.done) found.add(stream.tick());
        assert.equal(found.size, 2, "a frame and null");
    }
});

test("labels of all sets, numbers and words that mean other sounds", () => {
    assert.equal(mouth.phoneme("y"), mouth.phoneme("j", { labels: "ipa" }));
    assert.equal(mouth.phoneme("y", { labels: "ipa" }), mouth.phoneme("UW"));
    assert.equal(mouth.label(mouth.phoneme("tʃ", { labels: "ipa" })), "CH");
    assert.equal(mouth.phoneme(27), 27);
    assert.deepEqual(rows(speak({}, (s) => s.push("y", 200, { labels: "ipa" }))), rows(speak({}, (s) => s.push("UW", 200))));
    assert.throws(() => speak({}, (s) => s.push("ihr", 80)), { name: "LabialError", code: -11,
        message: '"ihr": no phoneme of this name is known' });
    assert.deepEqual(rows(speak({ unknown: "nearest" }, (s) => s.push("ihr", 80))), rows(speak({}, (s) => s.push("IH", 80))));
    const one = [{ start: 0, end: 0.3, label: "y", labels: "ipa" }]; // the set that a reader tells comes first
    assert.deepEqual(rows(mouth.render(one)), rows(speak({}, (s) => s.push("UW", 300))));
    assert.deepEqual(rows(mouth.render(one, { labels: "arpabet" })), rows(speak({}, (s) => s.push("Y", 300))));
});

test("a pause, a laugh and speech behind it, longer than the library's queue", () => {
    const feed = (seed) => (stream) => {
        stream.push("m", 80);
        stream.laugh(12.5, 0.7, seed);
        stream.push("AA", 200);
    };
    const frames = speak({}, feed(1));
    assert.equal(frames.length, Math.round(50 * (0.08 + 12.5 + 0.2)) + 12);
    assert.deepEqual(rows(frames), rows(speak({}, feed(undefined))), "the first laugh has the seed 1");
    assert.notDeepEqual(rows(frames), rows(speak({}, feed(2))));
    const widest = (list) => Math.max(...list.map((faps) => -(faps[3] + faps[4])));
    assert.ok(widest(speak({}, (s) => s.laugh(4, 1))) > widest(speak({}, (s) => s.laugh(4, 0))) + 200);
});

test("fractions of milliseconds do not drift", () => {
    assert.equal(speak({ exact: true }, (s) => {
        for (let i = 0; i < 3000; i++) s.push(i % 2 ? "AA" : "m", 20 / 3);
    }).length, 1000);
});

test("a cancel drops what waits, and what follows a restart fades in", () => {
    const stream = mouth.stream();
    for (let i = 0; i < 100; i++) stream.push(i % 2 ? "AA" : "b", 90);
    const before = [];
    for (const frame of stream) if (before.push(frame) === 30) break;
    stream.cancel(100);
    const eased = [...stream];
    assert.equal(eased.length, 5);
    assert.deepEqual([...eased[4]], REST);
    assert.throws(() => stream.push("m", 80), { code: -5 });
    stream.restart();
    stream.push("AA", 200);
    stream.end();
    assert.equal([...stream].length, 10 + 12);
    assert.equal(stream.number, 44 + 12);
});

test("weights are the rig's, by name", () => {
    for (const output of Object.keys(mouth.faces)) {
        const frames = speak({ output });
        const { visemes } = mouth.render(segments());
        rows(speak()).forEach((faps, i) => {
            assert.deepEqual(frames[i], mouth.convert(faps, output, {}, visemes.subarray(15 * i, 15 * i + 15)));
        });
        const all = frames.flatMap((weights) => Object.values(weights));
        assert.ok(Math.min(...all) === 0 && Math.max(...all) > 0.2 && Math.max(...all) <= 1);
    }
});

test("a frame tells how much of each sound it shows", () => {
    const words = [["sil", 100], ["AA", 200], ["M", 100], ["AA", 200], ["TH", 100], ["sil", 200]];
    const stream = fed({}, (s) => pushAll(s, words));
    const shown = [];
    for (const frame of stream) shown.push([...stream.visemes]);
    stream.free();
    for (const shares of shown) assert.ok(Math.abs(shares.reduce((sum, one) => sum + one, 0) - 128) <= 8);
    const most = [2, 10, 17, 25, 32, 43].map((frame) => shown[frame].indexOf(Math.max(...shown[frame])));
    assert.deepEqual(most, [0, 10, 1, 10, 3, 0]); // sil aa PP aa TH sil
    const { visemes } = mouth.render([{ start: 0, end: 0.3, label: "S" }]);
    assert.ok(visemes.length % 15 === 0 && visemes[15 * 5 + 7] === 128 && visemes.at(-15) === 128);
    assert.throws(() => mouth.convert(REST, "vrm", {}, [1, 2]), TypeError);
});

test("faces and names of weights are those of the rigs' descriptions, and the types name each", () => {
    const rigs = readdirSync(new URL("../../export/labial/rig", import.meta.url)).filter((name) => name.endsWith(".toml"));
    assert.deepEqual(Object.keys(mouth.faces), rigs.map((name) => name.slice(0, -5)).sort());
    for (const [face, names] of Object.entries(mouth.faces)) {
        const text = source(`export/labial/rig/${face}.toml`);
        assert.deepEqual([...names], [...text.matchAll(/^\[output\.(\w+)\]/gm)].map((match) => match[1]), face);
    }
    const types = readFileSync(`${folder}/faces.d.ts`, "utf8");
    const typed = [...types.matchAll(/^    (\w+):\n([^;]*);/gm)].map(([, face, names]) => [face, names.match(/\w+/g)]);
    assert.deepEqual(typed, Object.entries(mouth.faces).map(([face, names]) => [face, [...names]]));
});

test("a track is the stream's frames, and between them a line", () => {
    const track = mouth.render(segments());
    const frames = rows(speak());
    assert.deepEqual(rows(track), frames);
    assert.equal(track.duration, 1);
    assert.deepEqual([...track.at(0.2)], frames[10]);
    assert.deepEqual([...track.at(0.205)], frames[10].map((value, i) => Math.fround(value + (frames[11][i] - value) / 4)));
    assert.deepEqual([...track.at(-5)], frames[0]);
    assert.deepEqual([...track.at(99)], frames.at(-1));
    assert.equal(track.at(0.1), track.at(0.2), "no garbage");
    const weights = mouth.render(segments(), { output: "arkit" });
    const shares = weights.visemes.subarray(150, 165);
    assert.deepEqual(weights.at(0.2), mouth.convert(frames[10], "arkit", {}, shares));
    assert.notDeepEqual(weights.at(0.2), mouth.convert(frames[10], "arkit"));
    assert.deepEqual(weights.frame(10), weights.at(0.2));
    assert.deepEqual([...weights.faps], frames.flat());
});

test("times in another unit are doubted, once", (context) => {
    const warn = context.mock.method(console, "warn", () => {});
    const render = (...rows) => mouth.render(rows.map(([label, start, end]) => ({ label, start, end })));
    render(["", 0, 30], ["<laugh>", 30, 60], ["sil", 60, 90], ["AA", 90, 100]);
    assert.equal(warn.mock.callCount(), 0);
    render(["HH", 0, 70], ["", 70, 300], ["AA", 300, 420], ["m", 420, 900]);
    speak({}, (stream) => ["sil", "AA", "sil"].forEach((label, i) => stream.push(label, [90, 0.3, 200][i])));
    assert.deepEqual(warn.mock.calls.map(({ arguments: [text] }) => text.slice(0, 45)), [
        "labial: the longest sound lasts 480000 ms: pu", "labial: the longest sound lasts 0.3 ms: push("]);
});

test("gaps are silence, overlaps up to a millisecond are closed, laughs are laughed", () => {
    const found = mouth.render([{ start: 0.1, end: 0.2, label: "m" }, { start: 0.1995, end: 0.4, label: "AA" },
        { start: 0.6, end: 0.7, phoneme: "m" }, { start: 0.7, end: 1.9, label: "<laugh:0.7>" }]);
    const wanted = speak({}, (s) => {
        pushAll(s, [["sil", 100], ["m", 100], ["AA", 200], ["sil", 200], ["m", 100]]);
        s.laugh(1.2, 0.7);
    });
    assert.deepEqual(rows(found), rows(wanted));
    assert.equal(mouth.render([]).length, 0);
    assert.equal([...mouth.render([]).at(1)].length, 13);
});

test("speech and laughter at once", () => {
    const speech = rows(speak())[20];
    const laugh = rows(speak({}, (s) => s.laugh(2, 1)))[40];
    assert.deepEqual([...mouth.blend(speech, laugh, 0, 1)], speech);
    assert.deepEqual([...mouth.blend(speech, laugh, 1, 0)], laugh);
    assert.notDeepEqual([...mouth.blend(speech, laugh, 0.6, 1)], speech);
});

test("the library's pieces of memory are given back", () => {
    const before = mouth.memory.bytes.length;
    for (let i = 0; i < 20000; i++) {
        const stream = mouth.stream();
        stream.push("m", 20);
        stream.tick();
        stream.free();
        stream.free();
    }
    assert.equal(mouth.memory.bytes.length, before);
    const many = Array.from({ length: 300 }, () => mouth.stream({ exact: true }));
    many.forEach((stream, i) => stream.push("AA", 20 * i));
    many.forEach((stream) => stream.end());
    assert.ok(mouth.memory.bytes.length > before, "more than fits at first");
    many.forEach((stream, i) => assert.equal([...stream].length, i));
    [...many].sort((a, b) => a.latency.delay - b.latency.delay || Math.sin(many.indexOf(a))).forEach((s) => s.free());
    const grown = mouth.memory.bytes.length;
    for (let i = 0; i < 300; i++) many[i] = mouth.stream();
    assert.equal(mouth.memory.bytes.length, grown);
    many.forEach((stream) => stream.free());
});

test("streams that nobody holds are given back, too", async () => {
    for (let round = 0; round < 30; round++) {
        for (let i = 0; i < 100; i++) mouth.stream().push("m", 20);
        globalThis.gc();
        await wait(0);
    }
    assert.ok(mouth.memory.bytes.length < 3000 * mouth.wasm.mouth_size() / 2);
});

test("what follows a free is an error in a sentence", () => {
    const stream = mouth.stream();
    stream.free();
    for (const call of [() => stream.tick(), () => stream.push("m", 1), () => stream.laugh(1), () => stream.end(),
        () => stream.cancel(), () => stream.restart(), () => stream.use("speech"), () => [...stream],
        () => stream.articulation(50), () => stream.latency]) {
        assert.throws(call, new LabialError("the stream was freed"));
    }
});

test("hostile values are refused in a sentence, and change nothing", () => {
    const stream = mouth.stream();
    stream.push("m", 80);
    const numbers = [NaN, -1, Infinity, "80", null, undefined, {}, [], true, 1n, Symbol("x"), { valueOf: () => 1 }];
    const calls = [
        ...numbers.flatMap((x) => [() => stream.push("m", x), () => stream.laugh(x), () => stream.cancel(x ?? "")]),
        ...[NaN, -1, 1.1, "1", null].map((x) => () => stream.laugh(1, x)),
        ...[...numbers, 200.1, 201].map((x) => () => stream.articulation(x)),
        ...[1e9, 3600001].flatMap((x) => [() => stream.push("m", x), () => stream.laugh(x)]),
        ...[-1, 40, 0.5, NaN, 2 ** 40, null, {}, "", " ", "zzz", "x".repeat(1e6), "\ud800", "\0", Symbol("x"), () => 0]
            .map((x) => () => stream.push(x, 80)),
        ...[null, "x", {}, 5, { at: 16 }, "constructor", "__proto__", Symbol("x"), mouth.models]
            .flatMap((x) => [() => stream.use(x), () => mouth.stream({ model: x })]),
        ...["x", null, 5, "toString", {}].flatMap((x) => [() => mouth.stream({ output: x }),
            () => mouth.stream({ labels: x }), () => mouth.stream({ unknown: x }), () => mouth.render([], { output: x }),
            () => mouth.convert(new Int16Array(13), x)]),
        ...[null, 5, "abc", {}, [1], [null], [[]], [{}], [{ start: 0, end: 1 }], [{ start: 0, end: 1, label: 5.5 }],
            [{ start: 0, end: NaN, label: "m" }], [{ start: 1, end: 0, label: "m" }], [{ start: 0, end: 1e9, label: "m" }],
            [{ start: 0, end: 1, label: "m" }, { start: 0, end: 1, label: "m" }], [{ start: 0, end: 5000, label: "m" }],
            [{ start: 0, end: 1, label: "<laugh:2>" }], [{ start: 0, end: 1, label: "<laugh:>" }],
            [{ start: 0, end: 1, label: "m", labels: "x" }]].map((x) => () => mouth.render(x)),
        ...[null, 5, "abc", {}, [], new Uint8Array(0), new Uint8Array(7), new ArrayBuffer(4096)]
            .map((x) => () => mouth.model(x)),
        ...[null, 5, [], [1, 2], new Int16Array(12)].map((x) => () => mouth.convert(x, "arkit")),
        ...["x", NaN, null, undefined].map((x) => () => mouth.render(segments()).at(x)),
        ...[-1, 1.5, 1e9, NaN, "0"].map((x) => () => mouth.render(segments()).frame(x)),
        () => stream.restart(),
    ];
    refused(calls);
    stream.end();
    assert.deepEqual(rows(stream), rows(speak({}, (s) => s.push("m", 80))));
});

test("a model from a file is the model, and a damaged one is refused", () => {
    for (const kind of ["speech", "laughter"]) {
        const bytes = binary(mouth, mouth.models[kind]);
        const model = mouth.model(bytes);
        const say = (one) => rows(speak({ model: one }, (s) => [3, 7, 1, 11, 0].forEach((phoneme) => s.push(phoneme, 90))));
        assert.deepEqual(say(model), say(kind));
        assert.equal(mouth.label(3, model), mouth.label(3, mouth.models[kind]));
        const before = mouth.memory.bytes.length;
        for (let i = 0; i < bytes.length; i += 997) {
            const damaged = bytes.slice();
            damaged[i] ^= 1;
            assert.throws(() => mouth.model(damaged), LabialError);
            assert.throws(() => mouth.model(bytes.subarray(0, i)), LabialError);
        }
        assert.equal(mouth.memory.bytes.length, before);
    }
});

test("a model of a buffer that was handed over, or of a huge one, takes no memory", () => {
    const lost = new Uint8Array(4096);
    structuredClone(lost.buffer, { transfer: [lost.buffer] });
    const before = mouth.memory.bytes.length;
    for (let i = 0; i < 100; i++) {
        for (const data of [lost, lost.buffer]) assert.throws(() => mouth.model(data), TypeError);
    }
    for (const size of [2 ** 26 + 1, 2 ** 31, 2 ** 31 + 8]) {
        const huge = new ArrayBuffer(size); // of which no page is touched
        assert.throws(() => mouth.model(huge), { name: "LabialError", message: /^the model has \d+ bytes, more than/ });
    }
    assert.equal(mouth.memory.bytes.length, before);
    const model = mouth.model(binary(mouth, mouth.models.speech));
    assert.deepEqual(rows(speak({ model })), rows(speak()), "the pieces that are handed out do not overlap");
});

test("laughter is loaded when it is first needed, once, and until then asked for in a sentence", async () => {
    let asked = 0;
    const quiet = await Labial.load({ laughter: async () => (asked++, { default: { default: laughter } }) });
    const missing = { name: "LabialError", message: /^the laughter model is not loaded: Labial\.load\(/ };
    const stream = quiet.stream();
    for (const call of [() => stream.laugh(1), () => stream.use("laughter"), () => quiet.stream({ model: "laughter" }),
        () => quiet.render([{ start: 0, end: 1, label: "<laugh>" }])]) {
        assert.throws(call, (error) => missing.message.test(error.message.replace("entry 1: ", "")) && error.code === 0);
    }
    assert.deepEqual([quiet.models.laughter, asked], [null, 0]);
    const [first, second] = await Promise.all([quiet.laughter(), quiet.laughter()]);
    assert.equal(first, second);
    assert.equal(await quiet.laughter(), quiet.models.laughter);
    assert.equal(asked, 1);
    stream.laugh(2, 0.7);
    stream.end();
    assert.deepEqual(rows(stream), rows(speak({}, (s) => s.laugh(2, 0.7))));
    for (const given of [undefined, () => null]) {
        await assert.rejects((await Labial.load({ laughter: given })).laughter(), missing);
    }
    for (const given of ["abc", new Uint8Array(9), binary(mouth, mouth.models.speech), 5]) {
        await assert.rejects(Labial.load({ laughter: given }), /damaged|model/);
    }
    let online = false;
    const again = await Labial.load({ laughter: () => (online ? laughter : Promise.reject(new Error("offline"))) });
    await assert.rejects(again.laughter(), /offline/);
    online = true;
    assert.equal((await again.laughter()).fps, 50);
});

test("what unpacks the models names damage", () => {
    assert.equal(Buffer.from(unpack(laughter)).toString("latin1", 0, 4), "LBM1");
    for (const text of ["", laughter.slice(0, 40), laughter.slice(0, laughter.length / 2), laughter.slice(1), "eJxLBAAAYgBi"]) {
        assert.throws(() => unpack(text), { name: "LabialError", message: /damaged/ });
    }
    for (let seed = 1, i = 0; i < 300; i++) {
        const noise = Buffer.from(laughter, "base64");
        for (let k = 0; k < 4; k++) noise[24 + ((seed = (seed * 48271) % 2147483647) % (noise.length - 24))] ^= 1 << (seed & 7);
        try {
            unpack(noise.toString("base64"));
        } catch (error) {
            assert.ok(error instanceof LabialError, error.stack);
        }
    }
});

test("text is written as UTF-8, whole characters only", () => {
    const at = mouth.memory.take(64);
    for (const text of ["", "ab", "ˈɑː", "tʃ", "\u{1d11e}x", "\ud800", "\u07ff\u0800\uffff\u{10ffff}", "ə".repeat(40)]) {
        for (const size of [64, 7, 6, 5]) {
            const wanted = new Uint8Array(size);
            const { read, written } = new TextEncoder().encodeInto(text, wanted);
            assert.deepEqual(mouth.memory.write(text, at, size), { written, whole: read === text.length });
            assert.deepEqual([...mouth.memory.bytes.subarray(at, at + written)], [...wanted.subarray(0, written)]);
        }
    }
    mouth.memory.release(at, 64);
});

test("more than may wait is refused", () => {
    const stream = mouth.stream();
    let pushed = 0;
    assert.throws(() => {
        for (;; pushed++) stream.push("AA", 1);
    }, { code: -8, message: "the queue is full: take from it and push again" });
    assert.equal(pushed, 65536);
    stream.end();
    let frames = 0;
    while (!stream.done) frames += stream.tick() ? 1 : 0;
    assert.ok(frames > 3000);
});

test("models that alternate faster than the stream can let them go", () => {
    const third = mouth.model(binary(mouth, mouth.models.speech));
    const stream = () => fed({ exact: true }, (made) => {
        for (const model of ["speech", third, "laughter", "speech", third]) {
            made.use(model);
            pushAll(made, [[1, 200], [2, 200]]);
        }
    });
    assert.equal([...stream()].length, 100);
    const ticked = stream(); // the third model waits from the first tick on, and frames come with a delay
    let frames = 0;
    for (let tick = 0; tick < 200 && !ticked.done; tick++) frames += ticked.tick() !== null;
    assert.deepEqual([frames, ticked.done], [100, true]);
    const short = fed({}, (made) => ["speech", third, "laughter"].forEach((model) => {
        made.use(model);
        made.push(1, 20);
    }));
    assert.throws(() => [...short, ...Array.from({ length: 100 }, () => short.tick())], { code: -10 });
});
