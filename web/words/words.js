// Words for programs: texts, words and characters with their times, and what services tell of them.
import { even, split, whole, wordsOfCharacters } from "./characters.js";
import { readers } from "./readers.js";
import { WordStream } from "./stream.js";

/** LABIAL_WORDS_PHONEMES and LABIAL_WORDS_CHARACTERS: what the library makes of a word and reads of it at most. */
const PHONEMES_MAX = 96;
const CHARACTERS_MAX = 255;
/** Latest time, milliseconds: the library counts in 32 bits. */
const LATEST = 2 ** 32 - 2;
const OFFSET_MAX = 1e9;
const OWN_MAX = 65535;
const OWN = "words of one's own";

/** What a text's words are looked up by: letters, digits and what may stand within a word. */
const STRETCH = /[\p{L}\p{N}]+(?:['’\-.,][\p{L}\p{N}]+)*/gu;
const NUMBER = /^\p{Nd}+(?:,\p{Nd}{3})*(?:\.\p{Nd}+)?$/u;

export class Words {
    #tools;
    #labial;
    #wasm;
    #memory;
    #readers;

    constructor(tools, labial, wasm) {
        const memory = new tools.Memory(wasm.memory, wasm.__heap_base.value);
        this.#tools = tools;
        this.#labial = labial;
        this.#wasm = wasm;
        this.#memory = memory;
        const labels = [];
        for (let label; (label = memory.text(wasm.words_label(labels.length))); ) labels.push(label);
        this.labels = Object.freeze(labels);
        this.#readers = readers(tools, labial, this);
        this.formats = this.#readers.formats;
        Object.freeze(this);
    }

    phonemes(text, { own, numbers } = {}) {
        if (typeof text !== "string") throw new TypeError(`the text is ${this.#tools.shown(text)}, not text`);
        const texts = split(text);
        const table = this.table(this.known(own, numbers, texts));
        try {
            return texts.flatMap((one) => this.spoken(one, table));
        } finally {
            this.release(table);
        }
    }

    wordTimings(words, { own, numbers, offset = 0 } = {}) {
        return this.timed(Array.from(this.#listed(words, "words"), (word, i) => this.word(word, i + 1)), { own, numbers, offset });
    }

    characterTimings(text, starts, ends, { own, numbers, offset = 0 } = {}) {
        const { LabialError, shown } = this.#tools;
        const items = Array.from(this.#listed(text, "characters"));
        const wrong = items.find((item) => typeof item !== "string");
        if (wrong !== undefined) throw new TypeError(`a character is ${shown(wrong)}, not text`);
        const times = [starts, ends].map((list) => Array.from(this.#listed(list, "times"), (time) => this.#time(time)));
        if (times.some((list) => list.length !== items.length)) {
            const [begins, finishes] = times.map((list) => list.length);
            throw new LabialError(`${items.length} characters have ${begins} beginnings and ${finishes} ends`);
        }
        return this.timed(wordsOfCharacters(items, ...times), { own, numbers, offset });
    }

    read(source, options) {
        return this.#readers.read(source, options);
    }

    reader(options) {
        return this.#readers.reader(options);
    }

    stream(options) {
        return new WordStream(this.#tools, this.#labial, this.#wasm, this.#memory, this, options);
    }

    // ---- For streams and readers ------------------------------------------------------------------------------------

    /** A word in whole milliseconds; `end` may be null, `ends` are those of its characters, if they are known. */
    word(given, place) {
        const { text, start, end, ends } = given ?? {};
        if (typeof text !== "string") {
            throw new TypeError(`word ${place} is ${this.#tools.shown(given)}, not an object { text, start, end }`);
        }
        return {
            text, start: this.#time(start), end: end == null ? null : this.#time(end),
            ends: ends && Array.from(this.#listed(ends, "ends"), (time) => this.#time(time)),
        };
    }

    /** The segments of words in whole milliseconds. */
    timed(words, { own, numbers, offset = 0 }) {
        const stream = this.stream({ own: this.known(own, numbers, words.map(({ text }) => text)), offset });
        try {
            for (const word of words) stream.add(word);
            stream.flush();
            return stream.take();
        } finally {
            stream.free();
        }
    }

    /** Whether the library takes the ends of a word's characters. */
    spelt({ text, ends }) {
        return Boolean(ends?.length) && ends.length <= CHARACTERS_MAX && ends.length === [...text].length;
    }

    /** Milliseconds that are added to times given in seconds. */
    offset(seconds) {
        const { LabialError, shown } = this.#tools;
        if (typeof seconds !== "number") throw new TypeError(`the offset is ${shown(seconds)}, not a number of seconds`);
        if (!(Math.abs(seconds * 1000) <= OFFSET_MAX)) throw new LabialError(`an offset of ${seconds} s is not within 1e6 s`);
        return even(seconds * 1000);
    }

    /** Words of one's own, a Map, and with them what stands in digits in these texts, as `numbers` writes it. */
    known(own, numbers, texts) {
        const { LabialError, shown } = this.#tools;
        const pairs = own == null ? [] : own instanceof Map ? own : typeof own === "object" ? Object.entries(own) : null;
        if (!pairs) throw new TypeError(`${OWN} are ${shown(own)}, not { word: phonemes }`);
        const found = new Map(Array.from(pairs, ([word, sounds]) => [word, typeof sounds === "string" ? split(sounds) : sounds]));
        if (numbers == null) return found;
        if (typeof numbers !== "function") throw new TypeError(`numbers is ${shown(numbers)}, not a function`);
        for (const item of texts.flatMap((text) => text.match(STRETCH) ?? [])) {
            if (found.has(item) || !NUMBER.test(item)) continue;
            const text = numbers(item);
            if (typeof text !== "string") throw new LabialError(`numbers(${shown(item)}) is ${shown(text)}, not text`);
            found.set(item, split(text).flatMap((word) => this.spoken(word)).slice(0, PHONEMES_MAX));
        }
        return found;
    }

    /** What the library is told of words of one's own: where that is in memory, to be released. */
    table(known) {
        const { LabialError, shown } = this.#tools;
        const count = known.size;
        if (count > OWN_MAX) throw new LabialError(`${count} ${OWN} are more than ${OWN_MAX}`);
        if (!count) return { at: 0, size: 0, place: 0 };
        const entries = Array.from(known, ([word, sounds]) => this.#entry(word, sounds));
        const head = this.#wasm.words_own_size(count) + 7 & ~7;
        const size = entries.reduce((sum, [word, sounds]) => sum + 3 * word.length + 2 + sounds.length, head + 1);
        const at = this.#memory.take(size);
        let to = at + head;
        for (const [word, sounds] of entries) {
            to += this.#memory.write(word, to, 3 * word.length + 1).written;
            this.#memory.bytes.set([0, sounds.length, ...sounds], to);
            to += 2 + sounds.length;
        }
        return { at, size, place: this.#wasm.words_own(at, count, at + head) };
    }

    release({ at, size }) {
        if (at) this.#memory.release(at, size);
    }

    /** Runs `call` with a text in memory, as address and size. */
    withText(text, call) {
        const room = 3 * text.length + 1;
        const at = this.#memory.take(room);
        try {
            return call(at, this.#memory.write(whole(text), at, room).written);
        } finally {
            this.#memory.release(at, room);
        }
    }

    /** The phonemes of a text without blanks. */
    spoken(text, table = { place: 0 }) {
        const room = 2 + 3 * PHONEMES_MAX;
        const out = this.#memory.take(room);
        try {
            const result = this.withText(text, (at, size) => this.#wasm.words_read(table.place, at, size, out));
            if (result < 0) throw this.#labial.failure(result);
            const found = this.#memory.bytes.subarray(out, out + room);
            return Array.from({ length: found[0] }, (_, i) => this.labels[found[2 + 3 * i]]);
        } finally {
            this.#memory.release(out, room);
        }
    }

    #entry(word, sounds) {
        const { LabialError, shown } = this.#tools;
        if (typeof word !== "string" || !word || word.includes("\0")) throw new LabialError(`${shown(word)} is no word`);
        if (!Array.isArray(sounds)) throw new TypeError(`the phonemes of ${shown(word)} are ${shown(sounds)}, not text or a list`);
        if (sounds.length > PHONEMES_MAX) {
            throw new LabialError(`${shown(word)} has ${sounds.length} phonemes, more than ${PHONEMES_MAX}`);
        }
        const numbers = sounds.map((label) => this.labels.indexOf(label));
        const wrong = numbers.indexOf(-1);
        if (wrong >= 0) throw new LabialError(`${shown(word)}: ${shown(sounds[wrong])} is no phoneme of ARPABET`);
        return [whole(word), numbers];
    }

    #listed(value, what) {
        if (value && typeof value[Symbol.iterator] === "function") return value;
        if (value === "") return [];
        throw new TypeError(`the ${what} are ${this.#tools.shown(value)}, not a list`);
    }

    /** Whole milliseconds of a time in seconds. */
    #time(seconds) {
        const { LabialError, shown } = this.#tools;
        if (typeof seconds !== "number") throw new TypeError(`a time is ${shown(seconds)}, not a number of seconds`);
        if (!(seconds >= 0 && seconds * 1000 <= LATEST)) throw new LabialError(`${seconds} s is no time from 0 to ${LATEST / 1000} s`);
        return even(seconds * 1000);
    }
}

