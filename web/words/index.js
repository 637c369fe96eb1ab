// Words and written characters with their times to phonemes: what labial.words() loads. docs/browser.md is the manual;
// labial's index.d.ts has the calls.
import { linked, wordsOf, wordsOfCharacters } from "./characters.js";
import english from "./english.js";
import { Lexicon } from "./lexicon.js";
import { MessageReader, readTimings } from "./readers.js";
import { WordStream, inMilliseconds, segmentsOf } from "./stream.js";
import { Voice } from "./voice.js";

/** What is compiled already, and the words of each library: an instance is large. */
let compiled;
const made = new WeakMap();

/** Words for a library, with `tools`, which are labial's: its own sources would be another copy. */
export async function words(tools, labial) {
    const found = made.get(labial) ?? started(tools, labial);
    made.set(labial, found);
    try {
        return await found;
    } catch (error) {
        made.delete(labial); // so that it can be tried again
        throw error;
    }
}

async function started(tools, labial) {
    compiled ??= tools.allowed(WebAssembly.compile(tools.unpack(english))).catch((error) => {
        compiled = undefined;
        throw error;
    });
    const { exports } = await WebAssembly.instantiate(await compiled, {});
    return new Words(tools, labial, exports);
}

/** Texts, words and characters with their times, and what services tell of them. */
class Words {
    #lexicon;

    constructor(tools, labial, wasm) {
        this.#lexicon = new Lexicon(tools, labial, wasm);
        this.formats = Object.freeze([...labial.formats, ...Object.keys(tools.timings.SERVICES)]);
        Object.freeze(this);
    }

    phonemes(text, { own, numbers } = {}) {
        const lexicon = this.#lexicon;
        if (typeof text !== "string") throw new TypeError(`the text is ${lexicon.tools.shown(text)}, not text`);
        const texts = linked(wordsOf(text), " ");
        const table = lexicon.table(lexicon.known(own, numbers, texts));
        try {
            return lexicon.read(texts, table);
        } finally {
            lexicon.release(table);
        }
    }

    wordTimings(words, options = {}) {
        const listed = this.#lexicon.listed(words, "words");
        return segmentsOf(this.#lexicon, listed.map((word, i) => inMilliseconds(this.#lexicon, word, i + 1)), options);
    }

    characterTimings(text, starts, ends, options = {}) {
        const lexicon = this.#lexicon;
        const { LabialError, shown } = lexicon.tools;
        const items = lexicon.listed(text, "characters");
        const wrong = items.findIndex((item) => typeof item !== "string");
        if (wrong >= 0) throw new TypeError(`character ${wrong + 1} is ${shown(items[wrong])}, not text`);
        const times = [starts, ends].map((list) => lexicon.listed(list, "times"));
        if (times.some((list) => list.length !== items.length)) {
            const [begins, finishes] = times.map((list) => list.length);
            throw new LabialError(`${items.length} characters have ${begins} beginnings and ${finishes} ends`);
        }
        const [begins, finishes] = times.map((list) => list.map((time) => lexicon.milliseconds(time)));
        return segmentsOf(lexicon, wordsOfCharacters(items, begins, finishes), options);
    }

    read(source, options) { return readTimings(this.#lexicon, source, options); }
    reader(options) { return new MessageReader(this.#lexicon, options); }
    stream(options) { return new WordStream(this.#lexicon, options); }
    voice(options) { return new Voice(this.#lexicon, options); }
}
