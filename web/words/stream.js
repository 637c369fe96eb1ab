// Words in time on their way to phonemes.

import { linked } from "./characters.js";

/** LABIAL_WORDS_NO_END, and LABIAL_WORDS_CHARACTERS: what the library reads of a word at most. */
const NO_END = 2 ** 32 - 1;
const CHARACTERS_MAX = 255;

const abandoned = new FinalizationRegistry((line) => line.free());

/** The library's stream of words. Its times are whole milliseconds. */
export class Line {
    #lexicon;
    #numbers;
    #known; // words of one's own
    #table; // the library's table of these words
    #at; // 0 when freed
    #size;
    #moment = 0; // milliseconds up to which there are phonemes
    #ready = []; // those that were not taken

    constructor(lexicon, { own, numbers, offset = 0 }) {
        const milliseconds = lexicon.offset(offset);
        this.#lexicon = lexicon;
        this.#numbers = numbers;
        this.#known = lexicon.known(own, numbers, []);
        this.#table = lexicon.table(this.#known);
        this.#size = lexicon.wasm.words_size() + 8; // and a phoneme with its milliseconds
        this.#at = lexicon.memory.take(this.#size);
        lexicon.check(lexicon.wasm.words_init(this.#at, this.#table.place, milliseconds));
    }

    /** A word { text, start, end, ends }; the end may be null, `ends` are those of its characters or undefined. */
    add({ text, start, end, ends }) {
        const { wasm, memory } = this.#lexicon;
        const at = this.#collect();
        this.#learn(at, text);
        const spelt = ends?.length > 0 && ends.length <= CHARACTERS_MAX && ends.length === [...text].length;
        this.#lexicon.withText(text, (place, size) => {
            if (!spelt) {
                this.#lexicon.check(wasm.words_push(at, place, size, start, end ?? NO_END), text);
                return;
            }
            this.#lexicon.withBytes(4 * ends.length, (list) => {
                memory.int32(list, ends.length).set(ends);
                this.#lexicon.check(wasm.words_push_characters(at, place, size, start, list, ends.length), text);
            });
        });
    }

    /** No more words will come. */
    end() {
        this.#lexicon.check(this.#lexicon.wasm.words_end(this.#collect()));
    }

    /** Words may follow after the end, in the same sound. */
    restart() {
        this.#lexicon.check(this.#lexicon.wasm.words_restart(this.#collect()));
    }

    /** The segments that are known. */
    take() {
        this.#collect();
        return this.#ready.splice(0);
    }

    free() {
        if (!this.#at) return;
        this.#lexicon.memory.release(this.#at, this.#size);
        this.#lexicon.release(this.#table);
        this.#at = 0;
    }

    /** Takes the phonemes that are known from the library; returns the stream's address. */
    #collect() {
        const { LabialError } = this.#lexicon.tools;
        const at = this.#at;
        if (!at) throw new LabialError("the stream of words was freed");
        const out = at + this.#size - 8;
        while (this.#lexicon.check(this.#lexicon.wasm.words_next(at, out)) === 0) {
            const [phoneme, milliseconds] = this.#lexicon.memory.int32(out, 2);
            const start = this.#moment / 1000;
            this.#moment += milliseconds;
            const label = phoneme ? this.#lexicon.labels[phoneme] : "";
            this.#ready.push({ start, end: this.#moment / 1000, label, labels: "arpabet" });
        }
        return at;
    }

    /** Tells the library of numbers that are to be written out. */
    #learn(at, text) {
        if (!this.#numbers) return;
        const known = this.#lexicon.known(this.#known, this.#numbers, [text]);
        if (known.size === this.#known.size) return;
        const table = this.#lexicon.table(known);
        this.#lexicon.wasm.words_pronounce(at, table.place);
        this.#lexicon.release(this.#table);
        this.#table = table;
        this.#known = known;
    }
}

/** What programs call: times are in seconds. */
export class WordStream {
    #lexicon;
    #line;
    #place = 0;

    constructor(lexicon, options = {}) {
        this.#lexicon = lexicon;
        this.#line = new Line(lexicon, options);
        abandoned.register(this, this.#line, this);
    }

    push(word) {
        this.#line.add(inMilliseconds(this.#lexicon, word, this.#place + 1));
        this.#place++;
    }

    end() { this.#line.end(); }
    restart() { this.#line.restart(); }
    take() { return this.#line.take(); }

    free() {
        abandoned.unregister(this);
        this.#line.free();
    }
}

/** A program's word, as add() takes it; `place` is its number, from 1. */
export function inMilliseconds(lexicon, word, place) {
    const { text, start, end, ends } = word ?? {};
    if (typeof text !== "string") {
        throw new TypeError(`word ${place} is ${lexicon.tools.shown(word)}, not an object { text, start, end }`);
    }
    return {
        text, start: lexicon.milliseconds(start), end: end == null ? null : lexicon.milliseconds(end),
        ends: ends && lexicon.listed(ends, "ends").map((time) => lexicon.milliseconds(time)),
    };
}

/** The segments of words in milliseconds, one after the other. */
export function segmentsOf(lexicon, words, { own, numbers, offset }) {
    const texts = linked(words.map(({ text }) => text), " ");
    const known = lexicon.known(own, numbers, texts);
    const line = new Line(lexicon, { own: known, offset });
    try {
        words.forEach((word, i) => line.add({ ...word, text: texts[i] }));
        line.end();
        return line.take();
    } finally {
        line.free();
    }
}
