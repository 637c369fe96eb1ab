// One mouth that moves while its phonemes are still arriving.
import { CHANNELS, LabialError, NO_LAUGHTER, VISEMES, amount, shown } from "./memory.js";

const DURATION_MAX = 3600000;
/** Milliseconds. If no sound of a stream lasts longer than SHORTEST, they are probably seconds, as in
 * export/labial/core/guard.py; if one lasts longer than LONGEST, milliseconds were probably taken for seconds. */
const SHORTEST = 5;
const LONGEST = 10000;
const ARTICULATION_MAX = 200;
/** Phonemes that may wait in addition to those in the library's queue. */
const WAITING_MAX = 65536;
/** Ticks without a frame after which a stream without room for a model will never have any. */
const PATIENCE = 64;
/** Results (labial_result_t). */
const [OK, STARVED, DONE] = [0, 2, 3];
const [ERROR_STATE, ERROR_DURATION, ERROR_FULL, ERROR_FRAME_RATE, ERROR_MODELS] = [-5, -7, -8, -9, -10];

const abandoned = new FinalizationRegistry(({ memory, at, size }) => memory.release(at, size));

export class Stream {
    #labial;
    #at; // 0 when freed
    #output;
    #settings; // labels, nearest
    #model; // of the next push
    #fed; // of the last phoneme that the library has
    #models; // all that were used, which stay alive as long as the stream does
    #waiting = []; // model, phoneme, milliseconds of what waits for its turn
    #head = 0;
    #longest = 0; // of the durations of sounds
    #asked = 0; // milliseconds since the beginning, as they were given
    #given = 0; // and in whole ones
    #closed = false; // no more pushes
    #ended = false; // and the library knows
    #refused = 0; // ticks since a model was refused for want of room
    #state = 1;
    #laughs = 0;
    #frame;
    #number = -1;
    #exact = false;

    constructor(labial, options = {}) {
        const { output = "faps", model = "speech", labels = "auto", unknown = "error", exact = false } = options;
        labial.checkOutput(output);
        labial.labels(labels);
        if (unknown !== "error" && unknown !== "nearest") {
            throw new LabialError(`unknown is ${shown(unknown)}, neither "error" nor "nearest"`);
        }
        this.#labial = labial;
        this.#output = output;
        this.#settings = { labels, nearest: unknown === "nearest" };
        this.#frame = output === "faps" ? new Int16Array(CHANNELS) : {};
        this.#model = this.#fed = this.#modelOf(model);
        this.#models = new Set([this.#model]);
        const size = labial.wasm.mouth_size();
        const at = labial.memory.take(size);
        const result = labial.wasm.mouth_init(at, this.#model.at);
        if (result < 0) {
            labial.memory.release(at, size);
            throw labial.failure(result);
        }
        this.#at = at;
        this.exact = exact;
        abandoned.register(this, { memory: labial.memory, at, size }, this);
    }

    // ---- In ---------------------------------------------------------------------------------------------------------

    push(label, milliseconds, { labels = this.#settings.labels, hint } = {}) {
        this.#takes();
        const { nearest } = this.#settings;
        const phoneme = this.#labial.phoneme(label, { model: this.#model, labels, hint, nearest });
        const asked = this.#asked + amount(milliseconds, "milliseconds");
        const whole = Math.round(asked) - this.#given;
        if (whole > DURATION_MAX) throw this.#labial.failure(ERROR_DURATION, shown(milliseconds));
        this.#wait([phoneme, whole]);
        if (phoneme !== this.#model.silence) this.#longest = Math.max(this.#longest, milliseconds);
        this.#asked = asked;
        this.#given += whole;
    }

    laugh(seconds, intensity = 0.5, seed = this.#laughs + 1) {
        this.#takes();
        const before = this.#model;
        this.use("laughter");
        try {
            this.#wait(this.#labial.laugh(seconds, intensity, seed));
            this.#laughs++;
        } finally {
            this.#model = before;
        }
    }

    use(model) {
        this.#open();
        const next = this.#modelOf(model);
        const first = this.#fed;
        if (next.fps !== first.fps || next.stride !== first.stride) throw this.#labial.failure(ERROR_FRAME_RATE);
        this.#models.add(next);
        this.#model = next;
    }

    end() {
        this.#open();
        const longest = this.#longest;
        if ((longest > 0 && longest < SHORTEST) || longest > LONGEST) {
            console.warn(`labial: the longest sound lasts ${longest} ms: push() takes milliseconds, render() seconds`);
        }
        this.#longest = 0;
        this.#closed = true;
    }

    cancel(milliseconds = 200) {
        const at = this.#open();
        const whole = Math.ceil(Math.min(amount(milliseconds, "milliseconds"), DURATION_MAX));
        this.#check(this.#labial.wasm.mouth_cancel(at, whole));
        this.#waiting.length = this.#head = this.#refused = 0;
        this.#closed = true; // and the end that the library is told then changes nothing
    }

    restart() {
        const at = this.#open();
        this.#check(this.#labial.wasm.mouth_restart(at));
        this.#closed = this.#ended = false;
        this.#asked = this.#given = 0;
        this.#state = 1;
    }

    articulation(percent) {
        const at = this.#open();
        if (amount(percent, "percent") > ARTICULATION_MAX) {
            throw new RangeError(`percent is ${shown(percent)}, not from 0 to ${ARTICULATION_MAX}`);
        }
        this.#check(this.#labial.wasm.mouth_articulation(at, Math.round(percent)));
    }

    // ---- Out --------------------------------------------------------------------------------------------------------

    tick() {
        const at = this.#open();
        this.#feed(at);
        this.#state = this.#check(this.#labial.wasm.mouth_tick(at));
        if (this.#state !== OK && this.#refused && this.#refused++ > PATIENCE) throw this.#labial.failure(ERROR_MODELS);
        this.#number += this.#state === OK ? 1 : 0;
        return this.#labial.wasm.mouth_moved(at) ? this.#shown(at) : null;
    }

    #shown(at) {
        const place = this.#labial.wasm.mouth_faps(at);
        if (this.#output !== "faps") {
            return this.#labial.weigh(place, this.#output, this.#frame, this.#labial.wasm.mouth_visemes(at));
        }
        this.#frame.set(this.#labial.memory.int16(place, CHANNELS));
        return this.#frame;
    }

    *[Symbol.iterator]() {
        for (;;) {
            const at = this.#open();
            if (!this.#advance(at, () => this.#check(this.#labial.next(at)))) return;
            this.#number++;
            const frame = this.#shown(at);
            yield this.#output === "faps" ? frame.slice() : { ...frame };
        }
    }

    /** Feeds the library until `take` returns how many frames it took, by no clock; 0 when there are no more. */
    #advance(at, take) {
        let before, count;
        let idle = 0;
        do {
            before = this.#waiting.length - this.#head;
            this.#feed(at);
            count = take();
            idle = this.#waiting.length - this.#head < before ? 0 : idle + 1;
        } while (!count && (idle === 0 || (this.#refused && idle < PATIENCE)));
        this.#state = this.#labial.wasm.mouth_state(at);
        if (!count && this.#refused) throw this.#labial.failure(ERROR_MODELS);
        return count;
    }

    get exact() { return this.#exact; }

    set exact(exact) {
        this.#check(this.#labial.wasm.mouth_exact(this.#open(), exact ? 1 : 0));
        this.#exact = Boolean(exact);
    }

    get visemes() {
        const place = this.#labial.wasm.mouth_visemes(this.#open());
        return this.#labial.memory.bytes.slice(place, place + VISEMES);
    }

    get number() { return this.#number; }
    get time() { return this.#number / this.fps; }
    get fps() { return this.#fed.fps; }
    get output() { return this.#output; }
    get model() { return this.#model; }
    get done() { return this.#state === DONE; }
    get starved() { return this.#state === STARVED; }

    get latency() {
        const at = this.#open();
        let waiting = 0;
        for (let i = this.#head; i < this.#waiting.length; i += 3) waiting += this.#waiting[i + 2];
        const frames = this.#labial.wasm.mouth_held(at) + Math.round((waiting * this.fps) / 1000);
        const delay = this.#labial.wasm.mouth_delay(at);
        return { frames, milliseconds: Math.round((1000 * frames) / this.fps), delay };
    }

    get closed() { return !this.#at; }

    free() {
        if (!this.#at) return;
        abandoned.unregister(this);
        this.#labial.memory.release(this.#at, this.#labial.wasm.mouth_size());
        this.#at = 0;
        this.#models.clear();
        this.#waiting.length = this.#head = 0;
    }

    /** All frames that are ready; calls `add` with pieces, which are valid only during the call. Not for users. */
    drain(add) {
        const at = this.#open();
        while (this.#advance(at, () => this.#labial.run(at, add)));
    }

    // ---- Inside -----------------------------------------------------------------------------------------------------

    #open() {
        if (!this.#at) throw new LabialError("the stream was freed");
        return this.#at;
    }

    /** That it takes phonemes. */
    #takes() {
        this.#open();
        if (this.#closed) throw this.#labial.failure(ERROR_STATE);
    }

    #check(result) {
        if (result < 0) throw this.#labial.failure(result);
        return result;
    }

    #modelOf(model) {
        const bundled = this.#labial.models;
        const found = typeof model === "string" && Object.hasOwn(bundled, model) ? bundled[model] : model;
        if (found === null && model === "laughter") throw new LabialError(NO_LAUGHTER);
        if (!this.#labial.owns(found)) {
            throw new TypeError(`the model is ${shown(model)}, not one of this library's`);
        }
        return found;
    }

    #wait(pairs) {
        if (this.#waiting.length - this.#head + 1.5 * pairs.length > 3 * WAITING_MAX) {
            throw this.#labial.failure(ERROR_FULL);
        }
        for (let i = 0; i < pairs.length; i += 2) this.#waiting.push(this.#model, pairs[i], pairs[i + 1]);
    }

    /** Passes waiting phonemes to the library while it has room. */
    #feed(at) {
        const { wasm } = this.#labial;
        while (this.#head < this.#waiting.length && wasm.mouth_room(at) > 0) {
            const model = this.#waiting[this.#head];
            if (model !== this.#fed) {
                const result = wasm.mouth_use(at, model.at);
                if (result === ERROR_MODELS) {
                    this.#refused ||= 1;
                    return;
                }
                this.#check(result);
                this.#fed = model;
                this.#refused = 0;
            }
            this.#check(wasm.mouth_push(at, this.#waiting[this.#head + 1], this.#waiting[this.#head + 2]));
            this.#head += 3;
        }
        if (this.#head === this.#waiting.length) {
            this.#waiting.length = this.#head = 0;
            if (this.#closed && !this.#ended) {
                this.#check(wasm.mouth_end(at));
                this.#ended = true;
            }
        } else if (this.#head > 3072) {
            this.#waiting.splice(0, this.#head);
            this.#head = 0;
        }
    }
}
