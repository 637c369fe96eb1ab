// Allocates the memory of the WebAssembly module from its heap's base on. Also shared helpers of the scripts.

/** Numbers of a frame. */
export const CHANNELS = 13;
/** Shares of sounds in a frame. */
export const VISEMES = 15;
/** No timing is later, in seconds; beyond it the unit is not seconds. */
export const LONGEST = 86400;
/** The error for a laugh without the model. */
export const NO_LAUGHTER =
    'the laughter model is not loaded: Labial.load({ laughter: () => import("labial-laughter") }), await laughter()';

/** An error of the library, with its description; `code` is the result (labial_result_t), 0 without one. */
export class LabialError extends Error {
    constructor(message, code = 0) {
        super(message);
        this.name = "LabialError";
        this.code = code;
    }
}

/** What is compiled or instantiated, or a LabialError that names what the page's policy lacks. */
export async function allowed(made) {
    try {
        return await made;
    } catch (error) {
        if (!/unsafe-eval|wasm-eval|content.?security|\bCSP\b/i.test(error?.message)) throw error;
        throw Object.assign(new LabialError("the page's content security policy forbids WebAssembly: " +
            "add 'wasm-unsafe-eval' to its script-src"), { cause: error });
    }
}

/** Pieces of linear memory, aligned to eight bytes: the first gap that is large enough, else more pages. */
export class Memory {
    #memory;
    #gaps; // [address, size], ascending, never adjacent
    #i8;

    constructor(memory, base) {
        const start = eights(base);
        this.#memory = memory;
        this.#gaps = [[start, memory.buffer.byteLength - start]];
    }

    /** The module's bytes. Do not keep the array: it becomes invalid when the memory grows. */
    get bytes() {
        if (!this.#i8 || this.#i8.buffer !== this.#memory.buffer) this.#i8 = new Uint8Array(this.#memory.buffer);
        return this.#i8;
    }

    take(size) {
        const whole = eights(size);
        let index = this.#gaps.findIndex((gap) => gap[1] >= whole);
        if (index < 0) {
            const before = this.#memory.buffer.byteLength;
            try {
                this.#memory.grow(Math.ceil(whole / 65536));
            } catch {
                throw new LabialError("no memory is left; free streams that are no longer used");
            }
            this.release(before, this.#memory.buffer.byteLength - before);
            index = this.#gaps.length - 1;
        }
        const gap = this.#gaps[index];
        const at = gap[0];
        gap[0] += whole;
        gap[1] -= whole;
        if (gap[1] === 0) this.#gaps.splice(index, 1);
        return at;
    }

    release(at, size) {
        const gaps = this.#gaps;
        let index = gaps.findIndex((gap) => gap[0] > at);
        if (index < 0) index = gaps.length;
        gaps.splice(index, 0, [at, eights(size)]);
        for (const first of [index, index - 1]) {
            if (first >= 0 && first + 1 < gaps.length && gaps[first][0] + gaps[first][1] === gaps[first + 1][0]) {
                gaps[first][1] += gaps[first + 1][1];
                gaps.splice(first + 1, 1);
            }
        }
    }

    int16(at, count) { return new Int16Array(this.#memory.buffer, at, count); }
    int32(at, count) { return new Int32Array(this.#memory.buffer, at, count); }

    /** The text at an address, up to its zero: UTF-8, of which a message may have cut the last character. */
    text(at) {
        const bytes = this.bytes;
        const found = String.fromCharCode(...bytes.subarray(at, bytes.indexOf(0, at)));
        try {
            return decodeURIComponent(found.replace(/[%\x80-\xff]/g, (byte) => `%${byte.charCodeAt(0).toString(16)}`));
        } catch {
            return found;
        }
    }

    /** Writes text as UTF-8, as many whole characters as fit into `size` bytes; returns their bytes, and whether they
     * are all. An AudioWorklet has neither TextEncoder nor TextDecoder. */
    write(text, at, size) {
        const { bytes } = this;
        let written = 0;
        for (const character of text) {
            const code = character.codePointAt(0);
            const point = code >= 0xd800 && code < 0xe000 ? 0xfffd : code;
            const more = point < 0x80 ? 0 : point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
            if (written + more >= size) return { written, whole: false };
            bytes[at + written++] = more ? ((0xff00 >> (more + 1)) & 0xff) | (point >> (6 * more)) : point;
            for (let i = more - 1; i >= 0; i--) bytes[at + written++] = 0x80 | ((point >> (6 * i)) & 0x3f);
        }
        return { written, whole: true };
    }
}

/** The next multiple of eight; unlike `& ~7`, for any size. */
function eights(size) {
    return 8 * Math.ceil(size / 8);
}

/** A finite number from 0 on, or a TypeError that says what it is instead. */
export function amount(value, what) {
    if (typeof value !== "number" || !(value >= 0 && value < Infinity)) {
        throw new TypeError(`${what} is ${shown(value)}, not a number from 0 on`);
    }
    return value;
}

/** A value for messages, in at most 40 characters. */
export function shown(value) {
    let text;
    try {
        text = typeof value === "string" ? JSON.stringify(value) : String(value);
    } catch {
        text = typeof value;
    }
    return text.length <= 40 ? text : `${text.slice(0, 37)}...`;
}

/** Milliseconds of a clock that nobody sets. An AudioWorklet has another one alone. */
export const elapsed = () => (globalThis.performance ?? Date).now();

/** Of the elements whose sound has ended: when it was seen first, milliseconds. */
const ends = new WeakMap();

/** Seconds of a media element's sound. Behind the sound's end, where an element's own time stands, time goes on: a track
 * has frames behind its last phoneme, in which the mouth comes to rest. */
export function heard(audio) {
    if (!audio.ended) {
        ends.delete(audio);
        return audio.currentTime;
    }
    const now = elapsed();
    if (!ends.has(audio)) ends.set(audio, now);
    return audio.currentTime + (now - ends.get(audio)) / 1000;
}
