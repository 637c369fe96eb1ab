// Labial: lips from phonemes. docs/browser.md is the manual, index.d.ts documents each call.
import { CHANNELS, LabialError, Memory, NO_LAUGHTER, VISEMES, allowed, amount, elapsed, heard, shown } from "./memory.js";
import { Stream } from "./stream.js";
import { Track, speak } from "./track.js";
import { unpack } from "./unpack.js";
import * as timings from "./services.js";
import speech from "./speech.js";

export { LabialError, Stream, Track, heard, timings };

/** Most outputs of a rig. */
const OUTPUTS_MAX = 1024;
/** Numbers of an output in a rig's file, besides its weights, in the order of rig_output(), and their largest
 * values. */
const NUMBERS = Object.entries({
    gain: 2 ** 28, neutral: 2 ** 24, minimum: 2 ** 24, maximum: 2 ** 24, invert: 1, contact: 1, closed: 2 ** 24,
});
/** Slew, deadband and acceleration, which weights of a page have not. */
const UNLIMITED = [0, 0, 0];
/** Most segments of an output's curve, and their numbers, likewise: where each begins, its value there, its slope. */
const SEGMENTS_MAX = 8;
const SEGMENT = [2 ** 24, 2 ** 24, 2 ** 25];
/** All numbers of an output. */
const RIG_NUMBERS = CHANNELS + NUMBERS.length + UNLIMITED.length + 1 + SEGMENTS_MAX * SEGMENT.length + 1 + VISEMES;

/** Bytes of the buffer for labels, frames and weights. */
const SCRATCH = 16384;
const LABEL_MAX = 256;
/** Most bytes of a model. */
const MODEL_MAX = 2 ** 26;
/** What other packages take, since their own sources would be copies. */
const TOOLS = { LabialError, Memory, allowed, amount, elapsed, heard, shown, unpack, timings };
/** The error for a package that load() was not given. */
const missing = (name, is) => `${name} ${is} not loaded: Labial.load({ ${name}: () => import("labial-${name}") })`;
const LABELS = { auto: 0xe0, arpabet: 0x20, ipa: 0x40, xsampa: 0x80 };

/** A model for streams, bundled or loaded. */
export class Model {
    constructor(labial, at, names, range) {
        const { wasm } = labial;
        Object.freeze(Object.assign(this, {
            at, names, range, // of the memory: all that its tables are in
            phonemes: wasm.model_phonemes(at), silence: wasm.model_silence(at), fps: wasm.model_fps(at),
            stride: wasm.model_stride(at),
        }));
    }
}

/** A face from labial.rig(). */
export class Rig {
    constructor(name, outputs) {
        Object.freeze(Object.assign(this, { name, outputs: Object.freeze(outputs) }));
    }
}

/** The library. One serves any number of streams. */
export class Labial {
    #scratch;
    #rigs = new WeakMap(); // where their tables are
    #owned = new WeakSet();
    #loaded;
    #laughter; // where the laughter model comes from
    #coming = null; // its model, while it is on its way
    #hearing; // where hearing comes from
    #words; // where words come from

    constructor(instance, { laughter, hearing, words }) {
        this.wasm = instance.exports;
        this.memory = new Memory(this.wasm.memory, this.wasm.__heap_base.value);
        this.models = { speech: new Model(this, this.wasm.bundled_model(0), this.wasm.bundled_names(0),
            [0, this.wasm.__heap_base.value]), laughter: null };
        this.#owned.add(this.models.speech);
        this.faces = facesOf(this);
        this.attribution = this.memory.text(this.wasm.attribution());
        this.#scratch = this.memory.take(SCRATCH);
        this.#loaded = new FinalizationRegistry(([at, size]) => this.memory.release(at, size));
        this.#laughter = laughter;
        this.#hearing = hearing;
        this.#words = words;
        Object.freeze(this);
    }

    static async load(options = {}) {
        const { wasm, laughter } = options;
        const code = (await wasm) ?? unpack(speech);
        const made = await allowed(WebAssembly.instantiate(code, {}));
        const labial = new Labial(made.instance ?? made, options);
        if (laughter && typeof laughter !== "function") await labial.laughter();
        return labial;
    }

    async laughter() {
        this.models.laughter ??= await (this.#coming ??= this.#fetch());
        return this.models.laughter;
    }

    stream(options) {
        return new Stream(this, options);
    }

    async hear(source, options) {
        return (await given(this.#hearing, missing("hearing", "is"), "hear")).hear(TOOLS, this, source, options);
    }

    async words() {
        return (await given(this.#words, missing("words", "are"), "words")).words(TOOLS, this);
    }

    async voice(options) {
        return (await this.words()).voice(options);
    }

    render(segments, { output = "faps", ...options } = {}) {
        this.checkOutput(output);
        const stream = new Stream(this, options);
        try {
            return new Track(this, output, stream.model.fps, speak(stream, segments));
        } finally {
            stream.free();
        }
    }

    model(data) {
        const bytes = bytesOf(data);
        if (bytes.length > MODEL_MAX) throw new LabialError(`the model has ${bytes.length} bytes, more than ${MODEL_MAX}`);
        const header = this.wasm.blob_size();
        const size = header + bytes.length;
        const at = this.memory.take(size);
        this.memory.bytes.set(bytes, at + header);
        const result = this.wasm.model_load(at, at + header, bytes.length);
        if (result < 0) {
            this.memory.release(at, size);
            throw this.failure(result);
        }
        const names = [0, 1].map((number) => this.wasm.bundled_names(number));
        const own = names.find((one) => this.wasm.names_phonemes(one) === this.wasm.model_phonemes(at)) ?? 0;
        const model = new Model(this, at, own, [at, at + size]);
        this.#owned.add(model);
        this.#loaded.register(model, [at, size]);
        return model;
    }

    rig(description) {
        const given = typeof description === "string" ? JSON.parse(description) : description;
        const rows = Object.entries(given?.outputs ?? {});
        if (given?.labial !== "rig" || rows.length < 1 || rows.length > OUTPUTS_MAX) {
            throw new LabialError(`the rig is ${shown(given)}, not what labial rig --json wrote`);
        }
        const [size, curve] = [this.wasm.rig_output_size(), this.wasm.rig_curve_size()];
        const bytes = (size + curve) * rows.length; // the outputs, then the curves
        const at = this.memory.take(bytes);
        try {
            rows.forEach(([name, row], i) => {
                this.memory.int32(this.#scratch, RIG_NUMBERS).set(numbersOf(name, row));
                this.wasm.rig_output(at + size * i, at + size * rows.length + curve * i, this.#scratch);
            });
            const result = this.wasm.rig_check(at, rows.length);
            if (result < 0) throw this.failure(result, shown(given.name));
        } catch (error) {
            this.memory.release(at, bytes);
            throw error;
        }
        const rig = new Rig(String(given.name), rows.map(([name]) => name));
        this.#rigs.set(rig, at);
        this.#loaded.register(rig, [at, bytes]);
        return rig;
    }

    get formats() {
        const names = [];
        for (let at; (at = this.wasm.timings_name(names.length)); ) names.push(this.memory.text(at));
        return names;
    }

    read(text, { format = "auto", tier = "" } = {}) {
        if (typeof text !== "string") throw new TypeError(`the timings are ${shown(text)}, not text`);
        const number = this.formats.indexOf(format);
        if (number < 0) throw new LabialError(`${shown(format)} is no format of timings: ${this.formats.join(", ")}`);
        const { wasm, memory } = this;
        const rows = wasm.timings_size() + 7 & ~7; // a parser, 24 bytes of times, 16 of numbers, the tier, the text
        const size = rows + 44 + 3 * (tier.length + text.length);
        const at = memory.take(size);
        try {
            const name = at + rows + 40;
            const { written } = memory.write(tier, name, 3 * tier.length + 1);
            memory.bytes[name + written] = 0;
            const begin = name + written + 1;
            const end = begin + memory.write(text, begin, 3 * text.length + 1).written;
            wasm.timings_init(at, number, tier && name, 0);
            const segments = [];
            const take = () => {
                const [from, to] = new Float64Array(wasm.memory.buffer, at + rows, 2);
                const [, , laugh, xsampa] = memory.int32(at + rows + 24, 4);
                const place = wasm.timings_label(at);
                const label = place ? memory.text(place) : laugh < 0 ? "" : `<laugh:${laugh / 256}>`;
                segments.push({ start: from, end: to, label, ...(xsampa && { labels: "xsampa" }) });
            };
            let result;
            do { // the text is wanted, perhaps once more
                result = 0;
                for (let next = begin; next < end && result >= 0; next += memory.int32(at + rows + 24, 1)[0]) {
                    result = wasm.timings_next(at, next, end - next, at + rows, at + rows + 24);
                    if (result === 0) take();
                }
                while (result >= 0 && (result = wasm.timings_end(at, at + rows, at + rows + 24)) === 0) take();
            } while (result === 2);
            if (result < 0) {
                throw new LabialError(`line ${wasm.timings_line(at)}: ${memory.text(wasm.timings_message(at))}`, result);
            }
            if (!segments.length) throw new LabialError("no segments");
            return segments;
        } finally {
            memory.release(at, size);
        }
    }

    phoneme(label, { model = this.models.speech, labels = "auto", hint = "", nearest = false } = {}) {
        if (typeof label === "number") {
            if (!Number.isInteger(label) || label < 0 || label >= model.phonemes) throw this.failure(-6, shown(label));
            return label;
        }
        if (typeof label !== "string") throw new TypeError(`the label is ${shown(label)}, not text`);
        const sets = labels === "auto" && hint ? [hint, labels] : [labels];
        const { written, whole } = this.memory.write(label, this.#scratch, LABEL_MAX);
        if (!model.names || (!whole && !nearest)) throw this.failure(-11, shown(label));
        for (const set of sets) {
            const found = this.wasm.find(model.names, this.labels(set), this.#scratch, written);
            if (found >= 0) return found;
        }
        if (!nearest) throw this.failure(-11, shown(label));
        return this.wasm.find_nearest(model.names, this.labels(labels), this.#scratch, written, model.silence);
    }

    label(phoneme, model = this.models.speech) {
        this.phoneme(phoneme, { model });
        return model.names ? this.memory.text(this.wasm.label_at(model.names, phoneme)) : "";
    }

    blend(speech, laugh, intensity, words, out = new Int16Array(CHANNELS)) {
        const at = this.#scratch;
        [speech, laugh].forEach((faps, i) => this.#put(faps, at + 32 * i));
        const q8 = [[intensity, "intensity"], [words, "words"]].map(([x, what]) => share(x, what));
        this.wasm.blend(...q8, at, at + 32, at + 64);
        out.set(this.memory.int16(at + 64, CHANNELS));
        return out;
    }

    convert(faps, output, out = {}, visemes = null) {
        if (this.checkOutput(output) === "faps") {
            throw new LabialError('FAPs are what "faps" are already; convert them to a face');
        }
        this.#put(faps, this.#scratch);
        const shares = visemes ? this.#scratch + 32 : 0;
        if (visemes && visemes.length !== VISEMES) {
            throw new TypeError(`the shares of sounds are ${shown(visemes)}, not ${VISEMES} numbers`);
        }
        if (visemes) this.memory.bytes.set(visemes, shares);
        return this.weigh(this.#scratch, output, out, shares);
    }

    async #fetch() {
        try {
            const data = await given(this.#laughter, NO_LAUGHTER);
            const model = this.model(typeof data === "string" ? unpack(data) : data);
            if (model.names !== this.wasm.bundled_names(1)) throw new LabialError("the laughter is the model of something else");
            return model;
        } finally {
            this.#coming = null; // so that it can be tried again
        }
    }

    // ---- For streams and tracks -------------------------------------------------------------------------------------

    /** The weights of the FAPs, and of the shares of sounds, at addresses of the module's memory; 0: not known. */
    weigh(at, output, out, shares = 0) {
        const rig = this.#rigs.get(output);
        const names = rig === undefined ? this.faces[output] : output.outputs;
        const values = this.#scratch + 64;
        if (rig === undefined) this.wasm.weigh(Object.keys(this.faces).indexOf(output), at, shares, values);
        else this.wasm.rig_weigh(rig, names.length, at, shares, values);
        const thousandths = this.memory.int32(values, names.length);
        for (let i = 0; i < names.length; i++) out[names[i]] = thousandths[i] / 1000;
        return out;
    }

    /** Phonemes and milliseconds of a laugh, one after the other. */
    laugh(seconds, intensity, seed) {
        const milliseconds = Math.round(1000 * amount(seconds, "seconds"));
        const at = this.#scratch;
        const words = at + this.wasm.laugh_size();
        const level = share(intensity, "intensity");
        if (!Number.isInteger(seed)) throw new TypeError(`the seed is ${shown(seed)}, not a whole number`);
        const result = this.wasm.laugh_init(at, Math.min(milliseconds, 2 ** 32 - 1), level, seed >>> 0);
        if (result < 0) throw this.failure(result, `${shown(seconds)} s`);
        const found = [];
        while (this.wasm.laugh_next(at, words) === 0) found.push(...this.memory.int32(words, 2));
        return found;
    }

    /** Runs a stream until no more frames are ready, and returns their number. Calls `add` with pieces, FAPs and shares of
     * sounds, which are valid only during the call. */
    run(mouth, add) {
        const most = Math.floor(SCRATCH / (2 * CHANNELS + VISEMES));
        const shares = this.#scratch + 2 * CHANNELS * most;
        let count;
        let frames = 0;
        do {
            count = this.wasm.mouth_run(mouth, this.#scratch, shares, most);
            if (count < 0) throw this.failure(count);
            add(this.memory.int16(this.#scratch, CHANNELS * count), this.memory.bytes.subarray(shares, shares + VISEMES * count));
            frames += count;
        } while (count === most);
        return frames;
    }

    /** One frame, which then lies at mouth_faps(); returns their number, 0 if the stream waits. */
    next(mouth) {
        return this.wasm.mouth_run(mouth, this.#scratch, 0, 1);
    }

    owns(model) {
        return this.#owned.has(model);
    }

    failure(result, what = "") {
        return new LabialError((what && `${what}: `) + this.memory.text(this.wasm.result_text(result)), result);
    }

    labels(name) {
        if (!Object.hasOwn(LABELS, name)) {
            throw new LabialError(`${shown(name)} is none of the sets of labels: ${Object.keys(LABELS).join(", ")}`);
        }
        return LABELS[name];
    }

    checkOutput(output) {
        if (output !== "faps" && !this.#rigs.has(output) && !Object.hasOwn(this.faces, output)) {
            throw new LabialError(`${shown(output)} is no output: faps, ${Object.keys(this.faces).join(", ")}, ` +
                "or what this library's rig() made");
        }
        return output;
    }

    #put(faps, at) {
        if (!faps || faps.length !== CHANNELS) throw new TypeError(`FAPs are ${shown(faps)}, not ${CHANNELS} numbers`);
        const to = this.memory.int16(at, CHANNELS);
        for (let i = 0; i < CHANNELS; i++) to[i] = Math.max(-32768, Math.min(32767, Math.round(faps[i])));
    }
}

/** What load() was given, or what a function that it was given loads; without it, or without its `call`, the error
 * `problem`. */
async function given(source, problem, call = "") {
    let found = await (typeof source === "function" ? source() : source);
    while (found && found.default) found = found.default; // a module, or one inside another as CommonJS has it
    if (!found || (call && typeof found[call] !== "function")) throw new LabialError(problem);
    return found;
}

/** The names of each face's weights, by the face's name, in the order of the module. */
function facesOf({ wasm, memory }) {
    const faces = {};
    for (let face = 0, at; (at = wasm.face_name(face)); face++) {
        const names = (faces[memory.text(at)] = []);
        while ((at = wasm.weight_name(face, names.length))) names.push(memory.text(at));
        Object.freeze(names);
    }
    return Object.freeze(faces);
}

/** The numbers of an output of a rig's file; the library checks them. */
function numbersOf(name, row) {
    const { weights, curve = [], visemes } = row ?? {};
    const right = Array.isArray(weights) && weights.length === CHANNELS && weights.every((one) => whole(one, 32767)) &&
        NUMBERS.every(([key, most]) => whole(row[key], most)) &&
        Array.isArray(curve) && curve.length <= SEGMENTS_MAX && curve.every(isSegment) &&
        (visemes === undefined || (Array.isArray(visemes) && visemes.length === VISEMES && visemes.every((one) => whole(one, 32767))));
    if (!right) throw new LabialError(`output ${shown(name)} is not one that labial rig --json wrote`);
    const bends = [curve.length, ...curve.flat(), ...new Array((SEGMENTS_MAX - curve.length) * SEGMENT.length).fill(0)];
    const sounds = visemes ? [1, ...visemes] : [0];
    return [...weights, ...NUMBERS.map(([key]) => row[key]), ...UNLIMITED, ...bends, ...sounds];
}

function isSegment(given) {
    return Array.isArray(given) && given.length === SEGMENT.length && given.every((one, i) => whole(one, SEGMENT[i]));
}

function whole(value, most) {
    return Number.isInteger(value) && Math.abs(value) <= most;
}

/** A share from 0 to 1, in 1/256. */
function share(value, what) {
    if (amount(value, what) > 1) throw new RangeError(`${what} is ${shown(value)}, not from 0 to 1`);
    return Math.round(256 * value);
}

/** The bytes of a buffer, or of a view of one, of any realm. */
function bytesOf(data) {
    try {
        if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
        if (Object.prototype.toString.call(data) === "[object ArrayBuffer]") return new Uint8Array(data);
    } catch {
        // a detached buffer
    }
    throw new TypeError(`the model is ${shown(data)}, not the bytes of a .lbm file`);
}
