// The library's part of words: what texts sound like, words of one's own, times.
import { even, split, whole } from "./characters.js";

/** LABIAL_WORDS_PHONEMES: what the library makes of a word at most. */
const PHONEMES_MAX = 96;
/** Latest time, and largest offset, milliseconds: the library counts in 32 bits. */
export const LATEST = 2 ** 32 - 2;
const OFFSET_MAX = 1e9;
const OWN_MAX = 65535;
const OWN = "words of one's own";

/** What a text's words are looked up by: letters, digits and what may stand within a word. */
const STRETCH = /[\p{L}\p{N}]+(?:['’\-.,][\p{L}\p{N}]+)*/gu;
const NUMBER = /^\p{Nd}+(?:,\p{Nd}{3})*(?:\.\p{Nd}+)?$/u;

export class Lexicon {
    constructor(tools, labial, wasm) {
        this.tools = tools;
        this.labial = labial;
        this.wasm = wasm;
        this.memory = new tools.Memory(wasm.memory, wasm.__heap_base.value);
        this.speech = 0; // where a voice's copy of the speech model is
        this.labels = [];
        for (let label; (label = this.memory.text(wasm.words_label(this.labels.length))); ) this.labels.push(label);
    }

    /** The phonemes of words that follow each other; `table` is what table() made. A word may take phonemes from the end
     * of the one before: "dollars", where "million" follows "$5". */
    read(words, table = { place: 0 }) {
        const room = 3 + 3 * PHONEMES_MAX;
        const size = this.wasm.words_context_size();
        const found = [];
        this.withBytes(size + room, (context) => {
            const out = context + size;
            this.memory.bytes.fill(0, context, out);
            for (const word of words) {
                this.check(this.withText(word, (at, bytes) => this.wasm.words_read(table.place, context, at, bytes, out)));
                const read = this.memory.bytes.subarray(out, out + room);
                found.length -= Math.min(read[2], found.length);
                for (let i = 0; i < read[0]; i++) found.push(this.labels[read[3 + 3 * i]]);
            }
        });
        return found;
    }

    /** Words of one's own, as a Map of lists, and with them what stands in digits in these texts, as `numbers` writes
     * it. */
    known(own, numbers, texts) {
        const { LabialError, shown } = this.tools;
        if (own != null && typeof own !== "object") throw new TypeError(`${OWN} are ${shown(own)}, not { word: phonemes }`);
        const pairs = own instanceof Map ? own : Object.entries(own ?? {});
        const found = new Map();
        for (const [word, sounds] of pairs) found.set(word, typeof sounds === "string" ? split(sounds) : sounds);
        if (numbers == null) return found;
        if (typeof numbers !== "function") throw new TypeError(`numbers is ${shown(numbers)}, not a function`);
        for (const item of texts.flatMap((text) => text.match(STRETCH) ?? [])) {
            if (found.has(item) || !NUMBER.test(item)) continue;
            const text = numbers(item);
            if (typeof text !== "string") throw new LabialError(`numbers(${shown(item)}) is ${shown(text)}, not text`);
            found.set(item, this.read(split(text)).slice(0, PHONEMES_MAX));
        }
        return found;
    }

    /** What the library is told of such words: `place`, and where that is in memory, to be released. */
    table(known) {
        const { LabialError } = this.tools;
        const count = known.size;
        if (count > OWN_MAX) throw new LabialError(`${count} ${OWN} are more than ${OWN_MAX}`);
        if (!count) return { place: 0 };
        const entries = Array.from(known, ([word, sounds]) => this.#entry(word, sounds));
        const head = this.wasm.words_own_size(count);
        const size = entries.reduce((sum, [word, sounds]) => sum + 3 * word.length + 2 + sounds.length, head + 1);
        const at = this.memory.take(size);
        let to = at + head;
        for (const [word, sounds] of entries) {
            to += this.memory.write(word, to, 3 * word.length + 1).written;
            this.memory.bytes.set([0, sounds.length, ...sounds], to);
            to += 2 + sounds.length;
        }
        return { place: this.wasm.words_own(at, count, at + head), at, size };
    }

    release({ at, size }) {
        if (at) this.memory.release(at, size);
    }

    /** Whole milliseconds of a time in seconds. */
    milliseconds(seconds) {
        const { LabialError, shown } = this.tools;
        if (typeof seconds !== "number") throw new TypeError(`a time is ${shown(seconds)}, not a number of seconds`);
        if (!(seconds >= 0 && seconds * 1000 <= LATEST)) {
            throw new LabialError(`${seconds} s is no time from 0 to ${LATEST / 1000} s`);
        }
        return even(seconds * 1000);
    }

    /** Whole milliseconds of what is added to times, in seconds. */
    offset(seconds) {
        const { LabialError, shown } = this.tools;
        if (typeof seconds !== "number") throw new TypeError(`the offset is ${shown(seconds)}, no number of seconds`);
        if (!(Math.abs(seconds * 1000) <= OFFSET_MAX)) {
            throw new LabialError(`an offset of ${seconds} s is not within ${OFFSET_MAX / 1000} s`);
        }
        return even(seconds * 1000);
    }

    /** The items of a list of any kind. */
    listed(value, what) {
        if (value != null && typeof value[Symbol.iterator] === "function") return Array.from(value);
        throw new TypeError(`the ${what} are ${this.tools.shown(value)}, not a list`);
    }

    /** Runs `call` with a text in memory: its address and size. */
    withText(text, call) {
        const room = 3 * text.length + 1;
        return this.withBytes(room, (at) => call(at, this.memory.write(whole(text), at, room).written));
    }

    withBytes(size, call) {
        const at = this.memory.take(size);
        try {
            return call(at);
        } finally {
            this.memory.release(at, size);
        }
    }

    check(result, what) {
        if (result < 0) throw this.labial.failure(result, what === undefined ? "" : this.tools.shown(what));
        return result;
    }

    /** A word without half surrogates and the numbers of its phonemes. */
    #entry(word, sounds) {
        const { LabialError, shown } = this.tools;
        if (typeof word !== "string" || !word || word.includes("\0")) {
            throw new LabialError(`${shown(word)} is no word`);
        }
        if (!Array.isArray(sounds)) {
            throw new TypeError(`the phonemes of ${shown(word)} are ${shown(sounds)}, not text or a list`);
        }
        if (sounds.length > PHONEMES_MAX) {
            throw new LabialError(`${shown(word)} has ${sounds.length} phonemes, more than ${PHONEMES_MAX}`);
        }
        const numbers = sounds.map((label) => this.labels.indexOf(label));
        const wrong = numbers.indexOf(-1);
        if (wrong >= 0) throw new LabialError(`${shown(word)}: ${shown(sounds[wrong])} is no phoneme of ARPABET`);
        return [whole(word), numbers];
    }
}
