// Words beside what tests/python/test_words_runtime.py compares with Python: streams of words, messages as they arrive,
// numbers, memory, misuse.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import test from "node:test";
import { Labial, LabialError, assertTyped, folder, load, words as given, refused, source, wait } from "./setup.mjs";

const { fromEspeak } = await load("/espeak.js");
const labial = await Labial.load({ words: given });
/** The memory of the words' module. */
let memory;
const { instantiate } = WebAssembly;
WebAssembly.instantiate = async (...given) => {
    const made = await instantiate(...given);
    memory = made.exports.memory;
    return made;
};
const words = await labial.words();
WebAssembly.instantiate = instantiate;
const SAID = [{ text: "Maybe", start: 0.1, end: 0.42 }, { text: "people", start: 0.45, end: 0.9 },
    { text: "in", start: 0.9 }, { text: "1984.", start: 1.1, end: 1.9 }, { text: "Hum", start: 2.5, end: 3 }];
const numbers = (digits) => (digits === "1984" ? "the year of Orwell" : "many");
const labels = (segments) => segments.map(({ label }) => label || "-").join(" ");

test("numbers are written out by the caller, once each", () => {
    const asked = [];
    const spy = (digits) => (asked.push(digits), numbers(digits));
    const spelt = labels(words.wordTimings(SAID, { numbers: spy }));
    assert.match(spelt, / IH N DH AH Y IH R .* L - HH AH M$/);
    assert.deepEqual(asked, ["1984"]);
    const own = new Map([["1984", "M"]]);
    assert.equal(words.phonemes("1984, 1,234.5 3rd", { numbers: spy, own }).join(" "), "M M EH N IY TH ER D");
    assert.deepEqual(asked, ["1984", "1,234.5"]);
});

test("a stream says what a list says, word by word", () => {
    for (const options of [{}, { offset: 0.25, own: { people: "P" } }, { numbers }]) {
        const stream = words.stream(options);
        const found = [];
        SAID.forEach((word, i) => {
            stream.push(word);
            const known = stream.take();
            assert.equal(known.length > 0, i > 0, "a word's phonemes come with the next one");
            found.push(...known);
        });
        stream.end();
        found.push(...stream.take());
        assert.deepEqual(found, words.wordTimings(SAID, options));
        assert.deepEqual(stream.take(), []);
        assert.throws(() => stream.push(SAID[0]), { code: -5 });
        stream.restart();
        stream.push({ text: "More", start: 4, end: 4.5 });
        stream.end();
        assert.match(labels(stream.take()), /^- M AO R$/);
        stream.free();
        stream.free();
        for (const call of [() => stream.push(SAID[0]), () => stream.take(), () => stream.end(), () => stream.restart()]) {
            assert.throws(call, new LabialError("the stream of words was freed"));
        }
    }
});

test("words that nobody takes wait, and a refused one changes nothing", () => {
    const stream = words.stream();
    for (const word of SAID) stream.push(word);
    assert.throws(() => stream.push({ text: "late", start: 0 }), { code: -15, message: /^"late": / });
    assert.throws(() => stream.push({ text: "long", start: 3, end: 9000 }), { code: -7 });
    assert.throws(() => stream.push({ text: "ab", start: 3, ends: [4, 3.5] }), { code: -15 });
    stream.end();
    assert.deepEqual(stream.take(), words.wordTimings(SAID));
});

test("characters of a word move its phonemes", () => {
    const [even, slow] = [[3.15, 3.3], [3.25, 3.3]].map((ends) => words.wordTimings([{ text: "my", start: 3, end: 3.3, ends }]));
    assert.equal(labels(even), "- M AY");
    assert.ok(slow[1].end > even[1].end + 0.02);
    assert.deepEqual(words.characterTimings("my", [3, 3.25], [3.25, 3.3]), slow);
    assert.deepEqual(words.wordTimings([{ text: "my", start: 3, end: 3.3, ends: [3.3] }]), words.wordTimings([{ text: "my", start: 3, end: 3.3 }]));
});

/** The words of test_words_runtime.py, as "fi" of the caller's own say where each begins. */
test("words of scripts without blanks end at punctuation, and where one probably begins", () => {
    for (const text of ["妈妈爸爸|，朋友们|……好|——吗|？「是|」。", "你好|,世界|.再见|!好吗|?是|:的|;A,B", "今日は|新聞を|読みまし|た|。",
        "コンピュー|ターをつ|かってしゃっ|きんです", "すごーい|ね|・ァかヽか|か゛か", "แม่|และพ่อ|ไปซื้อปลา|, ດີ|ເດັກ|!ก", "वह| घर,गया| 엄마와!아빠",
        `${"o".repeat(60)}|${"o".repeat(60)}|oooooooooo`]) {
        const parts = text.split("|");
        const said = parts.map((part) => part.replace(/^[^\p{L}]+|[^\p{L}\p{M}]+$/gu, "")).filter(Boolean);
        const own = Object.fromEntries(said.map((word) => [word, "F IY"]));
        const sounds = said.flatMap(() => ["F", "IY"]);
        assert.deepEqual(words.phonemes(text.replaceAll("|", ""), { own }), sounds, text);
        const characters = [...text.replaceAll("|", "")];
        const times = characters.map((_, i) => i + (i % 3) / 10);
        const found = words.characterTimings(characters, times, [...times.slice(1), characters.length], { own });
        const begins = [];
        let place = 0;
        for (const part of parts) {
            const first = [...part].findIndex((one) => /\p{L}/u.test(one));
            if (first >= 0) begins.push(times[place + first]);
            place += [...part].length;
        }
        assert.deepEqual(found.filter(({ label }) => label === "F").map(({ start }) => start), begins, text);
    }
});

test("messages are read as they arrive", () => {
    const reader = words.reader();
    assert.deepEqual(reader.read({ audio: "AAAA", alignment: null }), { phonemes: [], words: [], characters: [] });
    for (const [chars, starts] of [[["H", "i"], [0, 0.1]], [["y", "o"], [0.2, 0.2 + 0.1]]]) {
        const alignment = { chars, charStartTimesMs: [0, 100], charDurationsMs: [100, 100] };
        assert.deepEqual(reader.read({ alignment }).characters.map(({ start }) => start), starts);
    }
    assert.equal(reader.format, "elevenlabs");
    const fish = words.reader({ format: "fish" });
    const event = (text) => ({ chunk_seq: 3, chunk_audio_offset_sec: 1, alignment: { segments: [{ text, start: 0, end: 1 }] } });
    assert.deepEqual(fish.read(event("May")), { phonemes: [], words: [{ text: "May", start: 1, end: 2 }], characters: [], chunk: 3 });
    assert.deepEqual(fish.read([]), { phonemes: [], words: [], characters: [] });
    assert.equal(fish.read([event("Maybe"), { event: "finish" }]).words[0].text, "Maybe");
});

test("parsed messages and text are alike, visemes and text formats are read as well", () => {
    const list = [{ word: "Maybe,", start: 0.1, end: 0.5 }, { word: "go.", start: 0.75, end: 1 }];
    const segments = words.read(list);
    assert.deepEqual(words.read(JSON.stringify(list)), segments);
    assert.deepEqual(words.read(`\uFEFF\n ${list.map((one) => JSON.stringify(one)).join("\n")}`), segments);
    assert.deepEqual(words.read([{ audioOffset: 0, visemeId: 2 }])[0].label, "AA");
    assert.deepEqual(words.read("0 .5 AA\n"), labial.read("0 .5 AA\n"));
    assert.deepEqual(words.read("0 .5 AA\n", { offset: 0.1, format: "lab" })[0], { start: 0.1, end: 0.6, label: "AA" });
    assert.ok(["elevenlabs", "lab", "piper", "words"].every((name) => words.formats.includes(name)));
});

test("espeak-ng's events, in any order of kinds, with and without their sound", () => {
    const event = (audio_position, id, type = "phoneme") => ({ type, text_position: 1, word_length: 0, audio_position, id });
    const events = [event(0, undefined, "samplerate"), event(0, 1, "sentence"), event(0, "m"), event(100, "ˈɑː"),
        event(210, 2, "word"), event(300, "p"), event(380, "ɐ̃ʊ̃\u0001"), event(500, ""), event(600, undefined, "end")];
    const plain = fromEspeak(events);
    assert.deepEqual(plain.map(({ start, label }) => [start, label]), [[0, "m"], [0.1, "ˈɑː"], [0.3, "p"], [0.38, "ɐ̃ʊ̃"], [0.5, ""]]);
    const sound = Int16Array.from({ length: 4800 }, (_, i) => (i >= 2000 && i < 2400 ? 0 : 9000 * Math.sin(i)));
    const [whole, floats, pieces] = [sound, Float32Array.from(sound, (x) => x / 32768), [sound.subarray(0, 7), sound.subarray(7)]]
        .map((samples) => fromEspeak(events, { samples, sampleRate: 8000 }));
    assert.deepEqual([whole[1].end, whole[2].start], [0.25, 0.25]);
    assert.deepEqual(floats, whole);
    assert.deepEqual(pieces, whole);
    assert.deepEqual(fromEspeak([event(0, "??"), event(90, undefined, "end")])[0].label, "ʊɐ");
    for (const [wrong, options] of [[null], ["x"], [{}], [events, { samples: sound }], [events, { samples: sound, sampleRate: 5 }],
        [events, { samples: "x", sampleRate: 8000 }], [events, { samples: [sound, 5], sampleRate: 8000 }]]) {
        assert.throws(() => fromEspeak(wrong, options), TypeError);
    }
    for (const wrong of [[], [event(0, undefined, "end")], [null], [event(0, 5)], [event("0", "m")], [event(NaN, "m")], [{ type: 7, audio_position: 0 }]]) {
        assert.throws(() => fromEspeak(wrong), LabialError);
    }
});

test("hostile values are refused in a sentence, and take no memory", () => {
    words.wordTimings(SAID, { own: Object.fromEntries(Array.from({ length: 500 }, (_, i) => [`word${i}`, "M"])) });
    const before = memory.buffer.byteLength;
    const calls = [
        ...[5, null, undefined, {}, ["a"], Symbol("x")].map((x) => () => words.phonemes(x)),
        ...[5, "x", { a: 5 }, { a: [5] }, { a: "QQ" }, { "": "M" }, { "a\0": "M" }, { a: new Array(97).fill("M") },
            new Map([[5, "M"]]), new Map(Array.from({ length: 70000 }, (_, i) => [`w${i}`, "M"]))].map((own) => () => words.phonemes("a", { own })),
        ...[5, "x", () => 5, () => null].map((x) => () => words.phonemes("12", { numbers: x })),
        ...[null, 5, {}, "word", [null], [5], [{}], [{ text: 5, start: 0 }], [{ text: "a" }], [{ text: "a", start: "0" }],
            [{ text: "a", start: -1 }], [{ text: "a", start: NaN }], [{ text: "a", start: 0, end: 1e9 }],
            [{ text: "a", start: 1, end: 0 }], [{ text: "a", start: 0, ends: 5 }], [{ text: "a", start: 0, ends: ["x"] }],
            [SAID[1], SAID[0]]].map((x) => () => words.wordTimings(x)),
        ...["x", NaN, 2e6, null, 1n].map((offset) => () => words.wordTimings(SAID, { offset })),
        ...[[5, [0], [1]], ["a", [0, 1], [1]], ["a", [0], [1, 2]], [[5], [0], [1]], ["a", null, [1]], ["a", ["0"], [1]], ["a", [-1], [1]]]
            .map((x) => () => words.characterTimings(...x)),
        ...[null, 5, "", "{", "[]", {}, [], [[]], "nothing", [{ word: "a", start: 0 }], [{ word: "a", start: 0, end: 1e300 }]].map((x) => () => words.read(x)),
        ...["x", null, "constructor", "lab"].flatMap((format) => [() => words.read([{}], { format }), () => words.reader({ format })]),
        () => words.reader().read(5), () => words.reader({ format: "words" }).read({ word: "a" }), () => words.stream({ own: 5 }),
    ];
    refused([...calls, ...calls, ...calls], 250, ["LabialError", "TypeError"]);
    assert.equal(memory.buffer.byteLength, before);
});

test("streams that nobody holds are given back", async () => {
    const own = Object.fromEntries(Array.from({ length: 300 }, (_, i) => [`word${i}`, "M AA"]));
    const use = () => {
        const stream = words.stream({ own, numbers });
        for (const word of SAID) stream.push(word);
    };
    for (let round = 0; round < 20; round++) {
        for (let i = 0; i < 100; i++) use();
        globalThis.gc();
        await wait(0);
    }
    assert.ok(memory.buffer.byteLength < 2000 * 300 * 5, `${memory.buffer.byteLength} bytes`);
});

test("words are loaded once, and asked for in a sentence", async () => {
    assert.equal(await labial.words(), words);
    const missing = { name: "LabialError", message: /^words are not loaded: Labial\.load\(.*labial-words/ };
    for (const wrong of [undefined, () => null, { hear() {} }]) {
        await assert.rejects((await Labial.load({ words: wrong })).words(), missing);
    }
    const other = await Labial.load({ words: Promise.resolve({ default: { default: await given() } }) });
    assert.notEqual(await other.words(), words);
    assert.deepEqual((await other.words()).wordTimings(SAID), words.wordTimings(SAID));
});

test("the package has these files and the dictionary's notice, and CommonJS has words as well", async () => {
    const scripts = "characters index lexicon messages readers stream voice".split(" ");
    const files = ["LICENSE", "README.md", "english.js", "index.d.ts", "package.json"];
    assert.deepEqual(readdirSync(`${folder}-words`).sort(), [...files, ...scripts.flatMap((one) => [`${one}.js`, `${one}.js.map`])].sort());
    const notice = /^\/\*! .*Carnegie Mellon University\. All rights reserved\. .*POSSIBILITY OF SUCH DAMAGE\. \*\/\n/;
    assert.match(readFileSync(`${folder}-words/english.js`, "utf8"), notice);
    const require = createRequire(import.meta.url);
    const common = await require(folder).Labial.load({ words: require(`${folder}-words`) });
    assert.deepEqual((await common.words()).wordTimings(SAID), words.wordTimings(SAID));
});

test("every package's LICENSE has the code's licence and the notices of what is in it, and of nothing else", () => {
    const notices = source("NOTICE");
    const inside = { "": ["speech_en"], "-laughter": ["laughter_synthetic"], "-hearing": ["hear_small", "hear_large"],
        "-hearing-host": ["hear_host", "hear_ahead"], "-words": ["words_en"] };
    const sections = [...notices.matchAll(/^(\w[\w, ]*):\n\n((?: {4}.*\n|\n)+)/gm)];
    assert.equal(sections.flatMap(([, names]) => names.split(", ")).length, 7);
    for (const [name, own] of Object.entries(inside)) {
        const text = readFileSync(`${folder}${name}/LICENSE`, "utf8");
        assert.ok(text.startsWith(`${source("LICENSE")}\n`) && text.includes(`that code: ${own.join(", ")}.`), name);
        for (const [, names, notice] of sections) {
            const listed = names.split(", ").some((one) => own.includes(one));
            assert.equal(text.includes(notice.trimEnd()), listed, `${name}: ${names}`);
        }
    }
});

test("a source map leads from each line of a script to the line that was written", () => {
    const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const numbers = (text) => {
        const found = [];
        for (let value = 0, shift = 0, i = 0; i < text.length; i++) {
            const digit = digits.indexOf(text[i]);
            value |= (digit & 31) << shift;
            shift += 5;
            if (digit & 32) continue;
            found.push(value & 1 ? -(value >> 1) : value >> 1);
            value = shift = 0;
        }
        return found;
    };
    for (const path of ["/index.js", "/mouth.js", "/labial-face.js", "-hearing/tap.js", "-words/voice.js"]) {
        const lines = readFileSync(`${folder}${path}`, "utf8").split("\n");
        const map = JSON.parse(readFileSync(`${folder}${path}.map`, "utf8"));
        const written = map.sourcesContent[0].split("\n");
        assert.match(lines.at(-2), /^\/\/# sourceMappingURL=[\w-]+\.js\.map$/);
        let line = 0;
        const steps = map.mappings.split(";");
        assert.equal(steps.length, lines.length - 2);
        steps.forEach((step, i) => {
            const [column, file, down, across] = numbers(step);
            line += down;
            assert.deepEqual([column, file, across], [0, 0, 0]);
            assert.ok(written[line].includes(lines[i]), `${path}:${i + 1}: ${lines[i]}`);
        });
        assert.ok(line > steps.length);
    }
});

test("types and what words, streams and readers have are the same", () => {
    for (const [name, one, own] of [["Words", words, ["formats"]], ["WordStream", words.stream(), []],
        ["MessageReader", words.reader(), []], ["Voice", words.voice(), []]]) {
        assertTyped("index", name, Object.getPrototypeOf(one), own);
        assert.deepEqual(Object.keys(one), own);
    }
});
