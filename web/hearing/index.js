// Lips from sound alone: what labial.hear() calls. docs/browser.md is the manual; labial's index.d.ts has the calls.
import { contextOf, tap } from "./tap.js";

/** The models: each is a WebAssembly module of its own, with the code that hears. */
const MODELS = { small: () => import("./small.js"), large: () => import("./large.js") };
/** What is compiled already, by the model's text. */
const compiled = new Map();

/** What to hear with `tools`, which are labial's: its own sources would be another copy. */
export async function hear(tools, labial, source, options = {}) {
    const { LabialError, allowed, shown } = tools;
    const { model = "small", output = "faps", channels = 1 } = options;
    labial.checkOutput(output);
    const given = Object.hasOwn(MODELS, model) ? MODELS[model] : model;
    if (given == null || !["function", "object"].includes(typeof given)) {
        throw new LabialError(`${shown(model)} is no model of hearing: ${Object.keys(MODELS).join(", ")}`);
    }
    const context = contextOf(tools, source ?? null, options.context);
    const code = await allowed(module(tools, given));
    const wasm = (await WebAssembly.instantiate(code, {})).exports;
    const listened = source == null ? null : await tap(tools, context, source, options.play);
    try {
        const heard = listened ? { sampleRate: listened.sampleRate, channels: 1 } : { channels };
        return new Hearing(tools, labial, wasm, { ...options, ...heard, output, context, tap: listened });
    } catch (error) {
        listened?.close();
        throw error;
    }
}

/** The compiled module of a model: of a module with its text, what loads one, or a promise of it. */
async function module({ LabialError, shown, unpack }, model) {
    let text = await (typeof model === "function" ? model() : model);
    while (text?.default) text = text.default; // a module, or one inside another as CommonJS has it
    if (typeof text !== "string") throw new LabialError(`${shown(text)} is no model of hearing`);
    if (!compiled.has(text)) compiled.set(text, WebAssembly.compile(unpack(text)));
    return compiled.get(text).catch((error) => {
        compiled.delete(text); // so that it can be tried again
        throw error;
    });
}

// One pair of ears: sound in, frames for every moment of it out.

const CHANNELS = 13;
const VISEMES = 15;
/** Frames per second, LABIAL_HEAR_FPS. */
const RATE = 50;
/** Samples that are heard in one call, and the frames for which a call has room: the end delivers fewer. */
const PIECE = 4096;
const ROOM = 64;
/** Most frames, and stretches of one class, that are kept for a program that does not take them: 87 minutes. */
const MOST = 2 ** 18;
const STRETCHES_MOST = 2 ** 14;
/** Frames that stay after they were shown: a program may ask for an earlier moment. */
const BEHIND = 100;
/** Seconds. A block that comes nearer to the end of the one before follows it without a gap. */
const NEAR = 0.005;
/** Silence that is heard after a sound and before the next one where they lie farther apart. Seconds. */
const AFTER = 0.5;
const BEFORE = 0.2;
/** LABIAL_CANCEL_MAX: the longest way to rest of a cancel, frames. */
const CANCEL_MAX = 1000;
const ARTICULATION_MAX = 200;
const ERROR_STATE = -5;

/** Tells "ended" and "lost" of its source as events. */
class Hearing extends EventTarget {
    #tools;
    #labial;
    #wasm;
    #memory;
    #at; // 0 when closed
    #samples; // where samples, frames and stretches lie for a call
    #faps;
    #visemes;
    #stretches;
    #names = [];
    #channels;
    #output;
    #context;
    #tap;
    #ended = false;
    #kept = new Int16Array(CHANNELS * 512); // the frames from number #first to #count, and the shares of their sounds
    #sounds = new Uint8Array(VISEMES * 512);
    #first = 0;
    #count = 0;
    #number = -1;
    #heard = 0; // frames that the module has counted, which differ from #count by #offset
    #offset = 0;
    #base = 0; // the frame with which the sound since the last restart begins, and the samples of a channel since
    #pushed = 0;
    #sampleRate;
    #latency;
    #delay;
    #anchors = [{ frame: 0, time: 0 }]; // where sound begins that does not follow what came before at once
    #found = []; // stretches of one class
    #waiting = []; // to be called when there are frames
    #pose = new Float32Array(CHANNELS);
    #shares = Uint8Array.from({ length: VISEMES }, (_, i) => (i === 0 ? 128 : 0)); // of the moment shown last
    #weights = {};

    constructor(tools, labial, wasm, { sampleRate, channels, output, context, tap, delay, exact }) {
        super();
        const memory = new tools.Memory(wasm.memory, wasm.__heap_base.value);
        this.#tools = tools;
        this.#labial = labial;
        this.#wasm = wasm;
        this.#memory = memory;
        this.#channels = channels;
        this.#output = output;
        this.#context = context;
        this.#tap = tap;
        this.#sampleRate = sampleRate;
        this.#at = memory.take(wasm.ears_size());
        this.#samples = memory.take(2 * 2 * PIECE);
        this.#faps = memory.take(2 * CHANNELS * ROOM);
        this.#visemes = memory.take(VISEMES * ROOM);
        this.#stretches = memory.take(12 * ROOM);
        const given = [sampleRate, channels].map((value) => (Number.isInteger(value) && value === value >>> 0 ? value : 0));
        const result = wasm.ears_init(this.#at, wasm.hearing_model(0), ...given);
        if (result < 0) {
            const [rate, count] = [sampleRate, channels].map(tools.shown);
            throw labial.failure(result, `${rate} samples per second, channels: ${count}`);
        }
        if (exact) wasm.ears_exact(this.#at, 1);
        for (let at; (at = wasm.hearing_class(0, this.#names.length)); ) this.#names.push(memory.text(at));
        this.#latency = wasm.ears_latency(this.#at) / 1000;
        this.#delay = tap ? tools.amount(delay ?? this.#latency + 0.08, "delay") : 0;
        tap?.start(this.#delay, (...block) => this.#ended || this.#push(...block), (what) => this.dispatchEvent(new Event(what)));
    }

    // ---- In ---------------------------------------------------------------------------------------------------------

    push(samples, time) {
        this.#open();
        if (this.#ended || this.#tap) throw this.#labial.failure(ERROR_STATE);
        this.#push(samples, time);
    }

    #push(samples, time) {
        const scale = scaleOf(samples);
        if (!scale || samples.length % this.#channels) {
            const what = scale ? `${samples.length} numbers for 2 channels` : this.#tools.shown(samples);
            throw new TypeError(`the sound is ${what}, not an Int16Array or a Float32Array of whole pairs`);
        }
        if (time !== undefined) this.#follow(this.#moment(time));
        this.#hear(samples.length, (to, from) => {
            for (let i = 0; i < to.length; i++) {
                to[i] = Math.max(-32768, Math.min(32767, Math.round(samples[from + i] * scale)));
            }
        });
        this.#wake();
    }

    end() {
        this.#open();
        if (this.#ended) return;
        this.#take(this.#wasm.ears_end(this.#at, ...this.#room()));
        this.#close(1);
    }

    cancel(milliseconds = 200, seconds = this.now ?? this.time) {
        this.#open();
        const length = Math.ceil((this.#tools.amount(milliseconds, "milliseconds") * RATE) / 1000 - 1e-6);
        const steps = Math.max(1, Math.min(length, CANCEL_MAX));
        const place = this.#place(this.#moment(seconds));
        const pose = Array.from(this.#between(place));
        const sounds = Array.from(this.#shares);
        this.#heard += this.#check(this.#wasm.ears_cancel(this.#at, 0, 0, 0, 0, 0));
        this.#count = Math.floor(place) + 1;
        this.#number = Math.min(this.#number, this.#count - 1);
        this.#found = this.#found.filter(({ start }) => start <= seconds);
        this.#anchors = this.#anchors.filter(({ frame }, i) => i === 0 || frame <= this.#count);
        this.#anchor(this.#count, Math.max(this.#due(this.#count), seconds));
        for (let step = 1; step <= steps; step++) {
            const way = step / steps;
            const left = 1 - way * way * (3 - 2 * way);
            const shares = sounds.map((share) => Math.floor(share * left));
            shares[0] += sounds.reduce((sum, share) => sum + share, 0) - shares.reduce((sum, share) => sum + share, 0);
            this.#keep(pose.map((value) => Math.round(value * left)), shares);
        }
        this.#close(0);
    }

    restart() {
        this.#check(this.#wasm.ears_restart(this.#open()));
        this.#base = this.#count;
        this.#offset = this.#count - this.#heard;
        this.#pushed = 0;
        this.#ended = false;
        this.#volume(1);
    }

    articulation(percent) {
        const at = this.#open();
        if (this.#tools.amount(percent, "percent") > ARTICULATION_MAX) {
            throw new RangeError(`percent is ${this.#tools.shown(percent)}, not from 0 to ${ARTICULATION_MAX}`);
        }
        this.#check(this.#wasm.ears_articulation(at, Math.round(percent)));
    }

    // ---- Out --------------------------------------------------------------------------------------------------------

    at(seconds = this.now) {
        const place = this.#place(this.#moment(seconds));
        this.#number = Math.max(this.#number, Math.floor(place));
        const pose = this.#between(place);
        return this.#output === "faps" ? pose : this.#labial.convert(pose, this.#output, this.#weights, this.#shares);
    }

    *[Symbol.iterator]() {
        while (this.#number + 1 < this.#count) {
            this.#number = Math.max(this.#number + 1, this.#first);
            const place = this.#number - this.#first;
            const faps = this.#kept.slice(CHANNELS * place, CHANNELS * (place + 1));
            this.#shares.set(this.#sounds.subarray(VISEMES * place, VISEMES * (place + 1)));
            yield this.#output === "faps" ? faps : this.#labial.convert(faps, this.#output, {}, this.#shares);
        }
    }

    async *[Symbol.asyncIterator]() {
        for (;;) {
            for (const frame of this) yield frame; // `yield*` would take this very iterator
            if (this.#ended) return;
            await new Promise((resolve) => this.#waiting.push(resolve));
        }
    }

    segments() {
        return this.#found.splice(0);
    }

    get number() { return this.#number; }
    get visemes() { return this.#shares.slice(); }
    get time() { return this.#due(this.#number); }

    get now() {
        const context = this.#context;
        return context && context.currentTime - (context.outputLatency || context.baseLatency || 0);
    }

    get fps() { return RATE; }
    get latency() { return this.#latency; }
    get delay() { return this.#delay; }
    get done() { return this.#ended && this.#number + 1 >= this.#count; }
    get closed() { return !this.#at; }
    get output() { return this.#output; }
    get context() { return this.#context; }
    get sound() { return this.#tap?.sound ?? null; }

    close() {
        if (!this.#at) return;
        this.#at = 0;
        this.#count = 0; // at() is the neutral face
        this.#close(1);
        this.#tap?.close();
        this.#tap = null;
    }

    // ---- Inside -----------------------------------------------------------------------------------------------------

    #open() {
        if (!this.#at) throw new this.#tools.LabialError("the hearing was closed");
        return this.#at;
    }

    #check(result) {
        if (result < 0) throw this.#labial.failure(result);
        return result;
    }

    #moment(seconds) {
        if (!Number.isFinite(seconds)) {
            throw new TypeError(`the time is ${this.#tools.shown(seconds)}, not a number of seconds`);
        }
        return seconds;
    }

    #close(volume) {
        this.#ended = true;
        this.#volume(volume);
        this.#wake();
    }

    #volume(share) {
        this.#tap?.sound.gain.setTargetAtTime(share, this.#context.currentTime, 0.01);
    }

    #wake() {
        for (const resolve of this.#waiting.splice(0)) resolve();
    }

    // ---- Sound

    /** Where the next sample lies, in frames. */
    get #position() { return this.#base + (this.#pushed * RATE) / this.#sampleRate; }

    /** Silence up to where the next sound begins; of a long one only what lips are seen to do. */
    #follow(time) {
        const position = this.#position;
        if (position === 0) this.#anchors = [{ frame: 0, time }];
        const gap = time - this.#due(position);
        if (gap < -NEAR) {
            this.#anchor(position, time);
        } else if (gap > AFTER + BEFORE) {
            this.#silence(AFTER);
            this.#anchor(this.#position, time - BEFORE);
            this.#silence(BEFORE);
        } else if (gap > NEAR) {
            this.#silence(gap);
        }
    }

    #silence(seconds) {
        this.#hear(Math.round(seconds * this.#sampleRate) * this.#channels, (to) => to.fill(0));
    }

    /** Hears so many numbers, which `fill` writes piece by piece. */
    #hear(count, fill) {
        for (let from = 0; from < count; from += PIECE * this.#channels) {
            const piece = Math.min(PIECE * this.#channels, count - from);
            fill(this.#memory.int16(this.#samples, piece), from);
            this.#pushed += piece / this.#channels;
            this.#take(this.#wasm.ears_push(this.#at, this.#samples, piece / this.#channels, ...this.#room()));
        }
    }

    // ---- Frames

    /** Where a call writes what it delivers. */
    #room() {
        return [this.#faps, this.#visemes, this.#stretches, ROOM];
    }

    /** Keeps what a call has delivered. */
    #take(count) {
        const sounds = this.#memory.bytes.subarray(this.#visemes, this.#visemes + VISEMES * this.#check(count));
        this.#keep(this.#memory.int16(this.#faps, CHANNELS * count), sounds);
        this.#heard += count;
        const rows = this.#memory.int32(this.#stretches, 3 * this.#wasm.ears_stretches(this.#at));
        for (let i = 0; i < rows.length; i += 3) {
            const first = rows[i + 1] + this.#offset;
            const end = this.#due(first + rows[i + 2] - 1) + 1 / RATE;
            this.#found.push({ start: this.#due(first), end, label: this.#names[rows[i]] });
        }
        if (this.#found.length > STRETCHES_MOST) this.#found.splice(0, STRETCHES_MOST / 2);
    }

    #keep(frames, sounds) {
        const count = frames.length / CHANNELS;
        if (CHANNELS * (this.#count - this.#first + count) > this.#kept.length) {
            const shown = Math.min(this.#count, this.#number - BEHIND);
            const begin = Math.max(this.#first, shown, this.#count + count - MOST);
            const rest = this.#kept.subarray(CHANNELS * (begin - this.#first), CHANNELS * (this.#count - this.#first));
            const size = 2 * (rest.length + frames.length);
            const heard = this.#sounds.subarray(VISEMES * (begin - this.#first), VISEMES * (this.#count - this.#first));
            if (size > this.#kept.length) {
                this.#kept = new Int16Array(size);
                this.#sounds = new Uint8Array((VISEMES * size) / CHANNELS);
            }
            this.#kept.set(rest);
            this.#sounds.set(heard);
            this.#first = begin;
            while (this.#anchors.length > 1 && this.#anchors[1].frame <= begin) this.#anchors.shift();
        }
        this.#kept.set(frames, CHANNELS * (this.#count - this.#first));
        this.#sounds.set(sounds, VISEMES * (this.#count - this.#first));
        this.#count += count;
    }

    // ---- Times

    /** From this frame on, which may be a fraction, the time runs from here. */
    #anchor(frame, time) {
        this.#anchors = this.#anchors.filter((one) => one.frame < frame && one.time < time);
        this.#anchors.push({ frame, time });
    }

    #due(frame) {
        const { frame: first, time } = this.#anchors.findLast((one) => one.frame <= frame) ?? this.#anchors[0];
        return time + (frame - first) / RATE;
    }

    /** The frame of a time, and how far it has come to the next one; -1 before there is any. */
    #place(seconds) {
        const next = this.#anchors.findIndex((one) => one.time > seconds);
        const { frame, time } = this.#anchors.at(next < 0 ? -1 : Math.max(0, next - 1));
        const end = next > 0 ? this.#anchors[next].frame : Infinity;
        const place = Math.min(end, frame + (seconds - time) * RATE, this.#count - 1);
        return Math.max(Math.min(this.#first, this.#count - 1), place);
    }

    /** The pose there, always in the same array; the shares of its sounds are in #shares. */
    #between(place) {
        const pose = this.#pose.fill(0), shares = this.#shares.fill(0);
        shares[0] = 128;
        if (place < 0) return pose;
        const number = Math.floor(place);
        const from = number - this.#first, to = number + 1 < this.#count ? from + 1 : from;
        const mix = (all, width, i) => all[width * from + i] + (all[width * to + i] - all[width * from + i]) * (place - number);
        for (let i = 0; i < CHANNELS; i++) pose[i] = mix(this.#kept, CHANNELS, i);
        for (let i = 0; i < VISEMES; i++) shares[i] = Math.round(mix(this.#sounds, VISEMES, i));
        return pose;
    }
}

/** By what samples are multiplied to be 16 bits; 0 if they are none. */
function scaleOf(samples) {
    const kind = ArrayBuffer.isView(samples) ? Object.prototype.toString.call(samples) : "";
    return kind === "[object Int16Array]" ? 1 : kind === "[object Float32Array]" ? 32768 : 0;
}
