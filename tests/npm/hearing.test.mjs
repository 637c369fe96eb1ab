// Hearing beside the frames themselves, which tests/python/test_npm.py compares with the library's: blocks of
// any length, times, cancels, misuse. Sound comes from a generator; tests/python/test_browser_hearing.py has pages.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import test from "node:test";
import { Labial, LabialError, REST, assertTyped, folder, hearing, rows } from "./setup.mjs";

const labial = await Labial.load({ hearing });
const RATE = 16000;

/** Int16 samples: a hum that opens and closes, over a little noise. */
function voice(seconds) {
    let seed = 1;
    return Int16Array.from({ length: Math.round(seconds * RATE) }, (_, i) => {
        seed = (seed * 48271) % 2147483647;
        let tone = 0;
        for (let k = 1; k < 20; k++) tone += Math.sin((2 * Math.PI * 120 * k * i) / RATE) / k;
        return tone * 4000 * Math.max(0, Math.sin((2 * Math.PI * 2.3 * i) / RATE)) + (seed % 81) - 40;
    });
}

function* pieces(samples, lengths) {
    for (let at = 0, i = 0; at < samples.length; at += lengths[i++ % lengths.length]) {
        yield samples.subarray(at, at + lengths[i % lengths.length]);
    }
}

const hears = (options) => labial.hear(null, { sampleRate: RATE, ...options });

async function heard(blocks, options) {
    const one = await hears(options);
    for (const block of blocks) one.push(block);
    one.end();
    return rows(one);
}

test("frames and stretches do not depend on how long blocks are, and 16 bits are floats", async () => {
    const sound = voice(2.5);
    const whole = await heard([sound]);
    assert.equal(whole.length, 125 + 12);
    assert.ok(whole.at(-1).every((value) => value === 0) && Math.max(...whole[0].map(Math.abs)) <= 40, "rest");
    assert.deepEqual(await heard([sound], { exact: true }), whole.slice(0, 125));
    const silence = await heard([new Int16Array(RATE)]);
    assert.ok(silence.length === 50 && silence.flat().every((value) => value === 0));
    assert.ok(Math.max(...whole.map((faps) => -(faps[3] + faps[4]))) > 150, "the mouth opens");
    for (const lengths of [[1], [128], [7, 4096, 333], [4095, 4097]]) {
        assert.deepEqual(await heard(pieces(sound, lengths)), whole);
    }
    assert.deepEqual(await heard([Float32Array.from(sound, (value) => value / 32768)]), whole);
    const loud = [-5, NaN, Infinity].map((value) => new Float32Array(RATE).fill(value));
    const clipped = [-32768, 0, 32767].map((value) => new Int16Array(RATE).fill(value));
    assert.deepEqual(await heard(loud), await heard(clipped));
    const pairs = Int16Array.from({ length: 2 * sound.length }, (_, i) => sound[i >> 1]);
    assert.deepEqual(await heard([pairs], { channels: 2 }), whole);
});

test("the sounds of frames move what lips do not tell, and go with the face", async () => {
    const one = await hears({ output: "oculus" });
    const plain = await hears();
    assert.deepEqual([...one.visemes], [128, ...new Array(14).fill(0)]);
    for (const each of [one, plain]) each.push(voice(2));
    let spoken = 0, apart = 0;
    for (const weights of one) {
        const faps = plain[Symbol.iterator]().next().value, shares = one.visemes;
        assert.ok(Math.abs(shares.reduce((sum, share) => sum + share, 0) - 128) <= 2, `${shares}`);
        assert.deepEqual([...plain.visemes], [...shares]);
        assert.deepEqual(weights, labial.convert(faps, "oculus", {}, shares));
        const alone = labial.convert(faps, "oculus");
        apart += Object.keys(weights).some((name) => weights[name] !== alone[name]);
        spoken += shares[0] < 64;
    }
    assert.ok(spoken > 30 && apart > 30, `${spoken} ${apart}`);
    one.at(1.51);
    const shown = one.visemes;
    one.cancel(200, 1.51);
    one.at(1.6);
    assert.ok(shown[0] < one.visemes[0] && one.visemes[0] < 128, `${shown} ${one.visemes}`);
    one.at(2);
    assert.deepEqual([...one.visemes], [128, ...new Array(14).fill(0)]);
});

test("a frame is known after the latency, and the iterator waits for it", async () => {
    const sound = voice(1);
    const one = await hears();
    assert.ok(one.latency > 0.1 && one.latency < 0.2 && one.delay === 0 && one.fps === 50 && one.now === null);
    assert.equal(one.number, -1);
    const needed = Math.round(one.latency * RATE);
    one.push(sound.subarray(0, needed - 1));
    assert.equal([...one].length, 0);
    one.push(sound.subarray(needed - 1, needed));
    assert.equal([...one].length, 1);
    const taken = [];
    const taking = (async () => {
        for await (const frame of one) taken.push([...frame]);
    })();
    for (let at = needed; at < sound.length; at += 640) {
        const before = taken.length;
        one.push(sound.subarray(at, at + 640));
        await new Promise((resolve) => setImmediate(resolve));
        assert.ok(taken.length > before || at + 640 > sound.length);
    }
    assert.ok(!one.done);
    one.end();
    await taking;
    assert.deepEqual(taken, (await heard([sound])).slice(1));
    assert.ok(one.done);
});

test("at() is a line between frames, at the time of their sound", async () => {
    const sound = voice(1);
    const frames = await heard([sound]);
    const one = await hears();
    assert.deepEqual([...one.at(0)], REST);
    one.push(sound, 100);
    one.end();
    assert.deepEqual([...one.at(100.2)].map(Math.round), frames[10]);
    assert.equal(one.number, 10);
    assert.ok(Math.abs(one.time - 100.2) < 1e-9);
    assert.deepEqual([...one.at(100.21)].map((v) => Math.round(2 * v)), frames[10].map((v, i) => v + frames[11][i]));
    assert.deepEqual([...one.at(0)], frames[0]);
    assert.ok(!one.done);
    assert.deepEqual([...one.at(999)], frames.at(-1));
    assert.ok(one.done);
    assert.equal(one.at(100), one.at(100.5), "no garbage");
});

test("sound that is heard later leaves the mouth closed between, and its frames come in their time", async () => {
    const sound = voice(0.5);
    for (const gap of [0.1, 3600]) {
        const one = await hears();
        one.push(sound, 10);
        one.push(sound, 10.5 + gap);
        one.push(new Int16Array(RATE), 11 + gap);
        const silence = new Int16Array(Math.round(Math.min(gap, 0.7) * RATE));
        const both = await heard([sound, silence, sound, new Int16Array(RATE)]);
        const second = (0.5 + Math.min(gap, 0.7)) * 50;
        for (const k of [0, 5, 24]) {
            assert.deepEqual([...one.at(10 + k / 50)].map(Math.round), both[k]);
            assert.deepEqual([...one.at(10.5 + gap + k / 50)].map(Math.round), both[second + k], `${gap} ${k}`);
        }
        const between = [...one.at(10.5 + Math.min(gap, 1000))];
        if (gap > 1) assert.ok(-(between[3] + between[4]) < 100, `closed: ${between}`);
    }
});

test("a block that is heard earlier than the one before ends takes its place", async () => {
    const [a, b] = [voice(1), new Int16Array(RATE)];
    const one = await hears();
    one.push(a, 0);
    one.push(b, 0.5);
    one.end();
    const frames = await heard([a, b]);
    assert.deepEqual([...one.at(0.4)].map(Math.round), frames[20]);
    assert.deepEqual([...one.at(0.6)].map(Math.round), frames[55]);
});

test("a cancel eases from what is shown, and what follows a restart fades in", async () => {
    const sound = voice(1);
    const frames = await heard([sound]);
    const one = await hears();
    assert.throws(() => one.restart(), { code: -5 });
    one.push(sound, 5);
    one.at(5.4);
    one.cancel(100, 5.4);
    assert.throws(() => one.push(sound), { code: -5 });
    const eased = rows(one);
    assert.equal(eased.length, 5);
    assert.deepEqual(eased.at(-1), REST);
    const size = (faps) => Math.hypot(...faps);
    [frames[20], ...eased].reduce((before, faps) => (assert.ok(size(faps) <= size(before)), faps));
    assert.ok(Math.abs(one.time - 5.5) < 0.021 && one.done);
    one.restart();
    one.push(sound, 7);
    one.end();
    const again = rows(one);
    assert.deepEqual(again.slice(-30), frames.slice(-30), "and its lips are those of the sound");
    assert.ok(one.segments().every(({ start, end, label }) => start <= 5.4 || (start >= 5.4 && end > start && label)));
    const fresh = await hears();
    fresh.cancel(0);
    assert.deepEqual(rows(fresh), [REST]);
});

test("articulation is a factor, and a cancel takes its time", async () => {
    const sound = voice(1);
    const frames = await heard([sound]);
    const one = await hears();
    one.articulation(50);
    one.push(sound);
    one.end();
    rows(one).slice(8, 40).forEach((faps, i) => {
        faps.forEach((value, k) => assert.ok(Math.abs(2 * value - frames[i + 8][k]) <= 2));
    });
    for (const wrong of [-1, NaN, 201, "much"]) assert.throws(() => one.articulation(wrong));
    const other = await hears();
    other.cancel(1e7, 0);
    assert.equal(rows(other).length, 1000);
});

test("stretches of lip classes follow each other, with labels that speech has", async () => {
    const one = await hears();
    one.push(voice(3), 2);
    one.end();
    const segments = one.segments();
    assert.ok(segments.length > 3);
    segments.forEach(({ start, end, label }, i) => {
        assert.ok(Math.abs(start - (i ? segments[i - 1].end : 2)) < 1e-9 && end > start);
        assert.ok(Number.isInteger(labial.phoneme(label)));
    });
    assert.ok(Math.abs(segments.at(-1).end - 5) < 1e-9);
    assert.deepEqual(one.segments(), []);
    assert.equal(labial.render(segments, { exact: true }).length, 250);
});

test("frames that nobody takes do not fill the memory", async () => {
    const one = await labial.hear(null, { sampleRate: 8000 });
    const second = new Int16Array(8000);
    global.gc();
    const before = process.memoryUsage().arrayBuffers;
    for (let i = 0; i < 1200; i++) {
        one.push(second);
        if (i % 2) one.at(i - 1);
    }
    global.gc();
    assert.ok(process.memoryUsage().arrayBuffers - before < 2 ** 20);
    assert.ok([...one].length > 40);
});

test("misuse is told", async () => {
    for (const given of [undefined, { words() {} }]) {
        await assert.rejects((await Labial.load({ hearing: given })).hear(), { name: "LabialError", message: /labial-hearing/ });
    }
    const lazy = await Labial.load({ hearing: Promise.resolve({ default: await hearing() }) });
    assert.ok(await lazy.hear(null, { sampleRate: RATE }));
    await assert.rejects(labial.hear(), { name: "LabialError", message: /^undefined samples per second.*not supported/ });
    await assert.rejects(labial.hear(null, { sampleRate: 11025 }), LabialError);
    for (const options of [{ channels: 3 }, { channels: 2 ** 32 + 1 }, { output: "arkitt" }]) {
        await assert.rejects(hears(options), LabialError);
    }
    for (const model of ["huge", 3, null]) await assert.rejects(hears({ model }), { message: /small, large/ });
    for (const model of [Promise.resolve({ default: 3 }), () => ({})]) {
        await assert.rejects(hears({ model }), { name: "LabialError", message: /is no model of hearing/ });
    }
    await assert.rejects(labial.hear({}), { name: "TypeError", message: /MediaStream/ });
    await assert.rejects(labial.hear({ getAudioTracks: () => [] }), { message: /no AudioContext here/ });
    const one = await hears({ channels: 2 });
    const view = new DataView(new ArrayBuffer(4));
    for (const wrong of [undefined, "x", [1, 2], new Uint8Array(4), new Int16Array(3), view]) {
        assert.throws(() => one.push(wrong), TypeError);
    }
    assert.throws(() => one.push(new Int16Array(2), NaN), TypeError);
    assert.throws(() => one.at(), TypeError);
    assert.throws(() => one.cancel(-1), TypeError);
    one.close();
    one.close();
    for (const call of [() => one.push(new Int16Array(2)), () => one.end(), () => one.cancel(), () => one.restart()]) {
        assert.throws(call, { message: "the hearing was closed" });
    }
    assert.ok(one.done);
});

test("the package has these files, and CommonJS hears as well", async () => {
    const files = "LICENSE README.md index.d.ts index.js index.js.map labial-tap-text.js labial-tap.js " +
        "labial-tap.js.map large.js package.json small.js tap.js tap.js.map";
    assert.equal(readdirSync(`${folder}-hearing`).sort().join(" "), files);
    for (const name of ["small", "large"]) {
        const text = readFileSync(`${folder}-hearing/${name}.js`, "utf8");
        assert.match(text, /^\/\*! .*LibriSpeech.*CC BY 4\.0.*GRID.*\*\/\n/);
    }
    const require = createRequire(import.meta.url);
    const common = await require(folder).Labial.load({ hearing: require(`${folder}-hearing`) });
    const one = await common.hear(null, { sampleRate: RATE, model: "large" });
    one.push(voice(1));
    one.end();
    assert.deepEqual(rows(one), await heard([voice(1)], { model: "large" }));
});

test("types and what a hearing has are the same", async () => {
    assertTyped("index", "Hearing", Object.getPrototypeOf(await hears()));
});
