// A voice: messages of a speech service in, as they arrive while its sound plays; frames out, when they are due. It
// does what export/labial/runtime/voice.py does; a test holds them to each other. docs/streams.md has the rules.
import { strip } from "./characters.js";
import { clockOf } from "./clocks.js";
import { Messages } from "./messages.js";
import { ROUNDING, Timeline, milliseconds } from "./timeline.js";

const CHANNELS = 13;
/** A changed frame fades in over so many frames. */
const FADE = 8;
/** Seconds of what was shown that a new stream is given, besides the part of a second before. */
const HISTORY = 2;
/** Seconds from the end of the last word until lips are at rest. */
const REST = 0.5;
/** Seconds between two looks at a clock that has not begun. */
const PATIENCE = 0.01;
/** Times are believed up to this many seconds, a year. */
const LATEST = 3.2e7;
/** No phoneme is longer, milliseconds. */
const DURATION_MAX = 3600000;
/** Most frames of a fade. */
const FADE_MAX = 1000;
const NEUTRAL = new Array(CHANNELS).fill(0);

/** Tells as an event "ended" that all of an utterance was shown. */
export class Voice extends EventTarget {
    #tools;
    #labial;
    #output;
    #clock; // null without one
    #given; // as it was given
    #origin; // what the clock tells when the voice's time is 0; null until begin() says
    #eased = [0, 0]; // of the last cancel: the voice's time, and that of the program, milliseconds
    #settings; // of push()
    #model;
    #messages;
    #timeline;
    #closed = false;
    #finished = false;
    #cancelled = false;
    #changed = true; // something was told since the last frame
    #next = 0; // the frame that comes next
    #shown = null; // FAPs of the frame before
    #stream = null; // makes the frames; null: the face is neutral
    #plan = []; // what it is to be given
    #pushed = []; // and what it has
    #fade = NEUTRAL; // what is added to the stream's frames, less with each step
    #step = 0;
    #steps = 0;
    #frame; // what at() returns
    #told = false; // that it has ended

    constructor(lexicon, options = {}) {
        super();
        const { tools, labial } = lexicon;
        const { format = "auto", output = "faps", model = "speech", labels = "auto", unknown = "error" } = options;
        const { own, numbers, offset = 0, clock, context } = options;
        const stream = labial.stream({ output, model, labels, unknown }); // which checks them
        this.#model = stream.model;
        stream.free();
        this.#tools = tools;
        this.#labial = labial;
        this.#output = output;
        this.#settings = { model: this.#model, labels, nearest: unknown === "nearest" };
        this.#messages = new Messages(lexicon, { format, labels });
        this.#timeline = new Timeline(lexicon, {
            own, numbers, offset: lexicon.offset(offset), silence: this.#model.silence,
            number: (label) => labial.phoneme(label, { model: this.#model }),
        });
        this.#timeline.begin(0);
        this.#clock = clockOf(tools, clock, context);
        this.#given = clock ?? null;
        this.#origin = this.#clock?.anchored ? null : 0;
        this.#frame = output === "faps" ? new Int16Array(CHANNELS) : {};
    }

    // ---- What becomes known

    feed(message) {
        this.#open();
        for (const heard of this.#messages.read(message)) {
            if (this.#listens()) this.#timeline.tell(heard);
        }
    }

    say(text, start, end) {
        this.#open();
        if (typeof text !== "string") throw new TypeError(`the word is ${this.#tools.shown(text)}, not text`);
        const item = this.#timed(start, end ?? null, this.#tools.shown(text));
        if (strip(text) && this.#listens()) this.#timeline.put("words", { ...item, what: strip(text) });
    }

    push(label, start, end) {
        this.#open();
        const item = this.#timed(start, end, "a phoneme");
        const phoneme = this.#labial.phoneme(label, this.#settings);
        if (this.#listens()) this.#timeline.put("phonemes", { ...item, what: phoneme });
    }

    begin(at) {
        this.#open();
        if (this.#origin === null) {
            this.#origin = at === undefined ? this.#clock.read() : this.#moment(at);
            if (!this.#cancelled) return;
            this.#begin(0);
        } else {
            const heard = this.#clock ? (this.#clock.read() ?? 0) : Infinity;
            const shown = this.#next / this.fps;
            if (heard - this.#origin < shown - 1 / this.fps) this.#origin = heard - shown; // the clock was set back
            const after = at === undefined ? null : this.#moment(at) - this.#origin;
            if (after !== null && after < 0) {
                throw new RangeError(`${at} s is before the first sound, ${this.#origin} s`);
            }
            this.#begin(after === null ? null : milliseconds(after));
        }
    }

    delay(seconds) {
        this.#open();
        const later = this.#tools.amount(seconds, "the delay");
        if (this.#origin !== null) this.#origin += later;
    }

    finish() {
        this.#open();
        this.#finished = true;
    }

    cancel(milliseconds = 200) {
        this.#open();
        const length = Math.min(this.#tools.amount(milliseconds, "milliseconds"), DURATION_MAX);
        const steps = Math.ceil((length * this.fps) / 1000 - 1e-6);
        this.#timeline.clear();
        this.#cancelled = this.#changed = true;
        this.#dropStream();
        this.#fadeFrom(NEUTRAL, Math.max(1, Math.min(steps, FADE_MAX)));
        this.#eased = [this.#next / this.fps, Date.now()];
    }

    // ---- What is shown

    played(seconds = this.now) {
        return this.#due(seconds, (faps) => this.#form(faps));
    }

    at(seconds = this.now) {
        this.#due(seconds, () => null);
        const faps = this.#shown ?? NEUTRAL;
        if (this.#output !== "faps") return this.#labial.convert(faps, this.#output, this.#frame);
        this.#frame.set(faps);
        return this.#frame;
    }

    async *follow(clock) {
        if (clock !== undefined && typeof clock !== "function") {
            throw new TypeError(`the clock is ${this.#tools.shown(clock)}, not a function; others are an option`);
        }
        const own = clock ? clockOf(this.#tools, clock) : this.#clock;
        while (!this.#closed) {
            const heard = this.#heard(own);
            for (const frame of this.played(heard)) {
                yield frame;
                if (this.#closed) return;
            }
            if (this.#finished && this.done) return;
            const wait = heard === null ? PATIENCE : this.#origin + this.#next / this.fps - heard;
            const milliseconds = 1000 * Math.min(Math.max(wait, 0.001), 1 / this.fps);
            await new Promise((resolve) => { setTimeout(resolve, milliseconds); });
        }
    }

    get number() {
        return this.#shown ? this.#next - 1 : -1;
    }

    get time() {
        return this.number / this.fps + (this.#origin ?? 0);
    }

    get now() {
        return this.#heard(this.#clock);
    }

    get clock() {
        return this.#given;
    }

    get fps() {
        return this.#model.fps;
    }

    get done() {
        if (this.#closed) return true;
        if (this.#cancelled) return this.#step === this.#steps;
        if (this.#timeline.empty) return this.#finished;
        return this.#finished && this.#next >= (this.#timeline.end / 1000 + REST) * this.fps;
    }

    close() {
        this.#closed = true;
        this.#timeline.clear();
        this.#dropStream();
    }

    // ---- Inside --------------------------------------------------------------------------------------------------

    /** What a clock tells. While the face eases after a cancel, its sound may have stopped: then time goes on. */
    #heard(clock) {
        if (!clock) throw new this.#tools.LabialError("the voice has no clock: give it one, or say the time");
        const heard = clock.read();
        if (!this.#cancelled || this.#step === this.#steps || this.#origin === null) return heard;
        const [time, begin] = this.#eased;
        const eased = this.#origin + time + (Date.now() - begin) / 1000;
        return heard > eased ? heard : eased;
    }

    /** A frame in the voice's output. */
    #form(faps) {
        return this.#output === "faps" ? Int16Array.from(faps) : this.#labial.convert(faps, this.#output);
    }

    #open() {
        if (this.#closed) throw new this.#tools.LabialError("the voice is closed");
    }

    #moment(seconds) {
        if (this.#tools.amount(seconds, "the time") > LATEST) throw new RangeError(`${seconds} s is more than a year`);
        return seconds;
    }

    #timed(start, end, what) {
        const [begin, stop] = [this.#moment(start), end === null ? null : this.#moment(end)];
        if (stop !== null && !(begin <= stop && stop <= begin + DURATION_MAX / 1000)) {
            throw new RangeError(`${what} from ${begin} to ${stop} s ends before it begins or lasts more than an hour`);
        }
        return { start: milliseconds(begin), end: stop === null ? null : milliseconds(stop), gap: ROUNDING };
    }

    /** Whether what is told counts; then the stream may change. */
    #listens() {
        if (this.#finished && !this.#cancelled) this.#begin(null);
        this.#changed = true;
        return !this.#cancelled;
    }

    #begin(at) {
        this.#timeline.begin(at ?? Math.max(this.#timeline.end, this.#milliseconds));
        this.#cancelled = this.#finished = false;
        this.#changed = true;
    }

    /** When the next frame is due. */
    get #milliseconds() {
        return Math.floor((this.#next * 1000) / this.fps);
    }

    /** What `take` makes of the frames that became due. */
    #due(seconds, take) {
        this.#open();
        if (seconds === null || this.#origin === null) return [];
        if (typeof seconds !== "number" || Number.isNaN(seconds)) {
            throw new TypeError(`the time is ${this.#tools.shown(seconds)}, not a number of seconds or null`);
        }
        const heard = seconds - this.#origin;
        if (heard > LATEST) throw new RangeError(`${heard} s is more than a year`);
        const last = heard >= 0 ? Math.floor(heard * this.fps + 1e-6) : -1;
        if (last < this.#next) return [];
        const late = last - this.#next >= this.fps;
        if (late) this.#next = last;
        if (this.#changed || late) this.#followChanges(late);
        const frames = [];
        for (; this.#next <= last; this.#next++) {
            this.#shown = this.#faded(this.#made());
            frames.push(take(this.#shown));
        }
        const done = this.done && !this.#cancelled;
        if (done && !this.#told) this.dispatchEvent(new Event("ended"));
        this.#told = done;
        return frames;
    }

    /** Looks whether the stream has phonemes that are no longer right, and if so makes a new one. */
    #followChanges(late) {
        this.#changed = false;
        const start = Math.max(0, Math.floor(this.#milliseconds / 1000) - HISTORY) * 1000;
        this.#timeline.forget(start);
        if (!this.#stream && this.#timeline.empty && this.#shown) return; // the neutral face after a cancel
        const plan = this.#timeline.plan(start);
        const pushed = this.#pushed.filter(({ end }) => end > start)
            .map((one) => ({ ...one, start: Math.max(one.start, start) }));
        if (!this.#stream || late || !pushed.every((one, i) => same(one, plan[i]))) {
            this.#renew(plan);
        } else {
            this.#plan = plan.slice(pushed.length);
            this.#pushed = pushed;
        }
    }

    /** A new stream, which is given `plan`; the difference from what was shown fades. */
    #renew(plan) {
        this.#dropStream();
        this.#stream = this.#labial.stream({ model: this.#model });
        this.#plan = plan;
        let base = NEUTRAL;
        for (let frame = Math.floor(plan[0].start / 1000) * this.fps; frame < this.#next; frame++) base = this.#made();
        this.#fadeFrom(base, FADE);
    }

    /** Begins to fade from what was shown, where the stream is at `base`. */
    #fadeFrom(base, steps) {
        const shown = this.#shown ?? base;
        this.#fade = Array.from(shown, (value, i) => value - base[i]);
        this.#step = 0;
        this.#steps = steps;
    }

    /** The next frame of the stream. */
    #made() {
        if (!this.#stream) return NEUTRAL;
        for (;;) {
            for (const frame of this.#stream) return frame;
            if (this.#plan.length) this.#pushed.push(this.#plan.shift());
            const { start, end, phoneme } = this.#pushed.at(-1); // the endless silence again when an hour of it is over
            const length = end === Infinity ? DURATION_MAX : end - start;
            for (let passed = 0; passed < length; passed += DURATION_MAX) {
                this.#stream.push(phoneme, Math.min(length - passed, DURATION_MAX));
            }
        }
    }

    /** A frame of the stream as it is shown. */
    #faded(base) {
        if (this.#step === this.#steps) return base;
        this.#step++;
        const left = 16384 - ease(this.#step, this.#steps);
        return Array.from(base, (value, i) => {
            return Math.max(-32768, Math.min(32767, value + ((this.#fade[i] * left + 8192) >> 14)));
        });
    }

    #dropStream() {
        this.#stream?.free();
        this.#stream = null;
        this.#plan = [];
        this.#pushed = [];
    }
}

function same(one, other) {
    return other !== undefined && one.start === other.start && one.end === other.end && one.phoneme === other.phoneme;
}

/** Progress of a smooth transition, 0 to 16384 (labial_ease of lib/fixed.h). */
function ease(step, steps) {
    const share = Math.floor((step << 14) / steps);
    return (((share * share) >> 14) * (3 * 16384 - 2 * share)) >> 14;
}
