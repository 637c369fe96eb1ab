// A voice: messages of a speech service in, as they arrive while its sound plays; frames out, when they are due. The
// rules are the library's (include/labial/voice.h); docs/streams.md explains them.
import { strip, whole } from "./characters.js";
import { Messages } from "./messages.js";

const CHANNELS = 13;
const VISEMES = 15;
/** Room for words and phonemes that are told ahead of the sound: a server is not trusted. A phoneme or character takes
 * one place, a word up to 20 letters two. */
const PLACES = 20000;
/** Seconds between two looks at a clock that has not begun. */
const PATIENCE = 0.01;
/** The clock is believed up to this many seconds, a year; items up to a day, and those that last an hour at most. */
const LATEST = 3.2e7;
const [DAY, HOUR] = [86400, 3600];
/** Seconds beyond which the time of a word or phoneme is doubted. */
const LONG = 10;
/** The longest cancel, milliseconds. */
const CANCEL_MAX = 1e6;
/** LABIAL_OK, LABIAL_WAITING and LABIAL_ERROR_FULL. */
const [OK, WAITING, FULL] = [0, 1, -8];
/** Kinds of items (labial_voice_kind_t), and from when on their times count (labial_voice_times_t). */
const KINDS = { phonemes: 0, azure: 1, polly: 2, words: 3, characters: 4 };
const [ABSOLUTE, CHAINED, JOINED] = [0, 1, 2];

const abandoned = new FinalizationRegistry((blocks) => blocks.release());

/** What a voice has in the module's memory. */
class Blocks {
    #lexicon;
    #taken = [];
    #table = {};

    constructor(lexicon) {
        this.#lexicon = lexicon;
    }

    take(size) {
        const at = this.#lexicon.memory.take(size);
        this.#taken.push([at, size]);
        return at;
    }

    /** Another table of own words, in place of the one before. */
    set table(table) {
        this.#lexicon.release(this.#table);
        this.#table = table;
    }

    release() {
        for (const [at, size] of this.#taken.splice(0)) this.#lexicon.memory.release(at, size);
        this.table = {};
    }
}

/** Tells as an event "ended" that all of an utterance was shown. */
export class Voice extends EventTarget {
    #lexicon;
    #tools;
    #labial;
    #output;
    #clock; // null without one
    #given; // as it was given
    #origin; // what the clock tells when the voice's time is 0; null until begin() says
    #since = 0; // when the clock moved last, or a cancel was, milliseconds,
    #eased = 0; // and the poses since then
    #heard = -1; // the time of the call before
    #settings; // of push()
    #model;
    #messages;
    #blocks;
    #at; // where the voice is
    #known; // words of one's own,
    #numbers; // what writes numbers out,
    #tail = ""; // and the characters of a word that may go on
    #faps; // where a frame is written,
    #shares; // and the shares of its sounds
    #sounds = null; // these, of the frame before
    #shown = null; // FAPs of the frame before,
    #number = -1; // and its number
    #frame; // what at() returns
    #closed = false;
    #told = false; // that it has ended
    #doubts = false; // that times are in seconds; it said so

    constructor(lexicon, options = {}) {
        super();
        const { tools, labial, wasm, memory } = lexicon;
        const { format = "auto", output = "faps", model = "speech", labels = "auto", unknown = "error" } = options;
        const { own, numbers, offset = 0, clock, context } = options;
        const stream = labial.stream({ output, model, labels, unknown }); // which checks them
        this.#model = stream.model;
        stream.free();
        this.#lexicon = lexicon;
        this.#tools = tools;
        this.#labial = labial;
        this.#output = output;
        this.#settings = { model: this.#model, labels, nearest: unknown === "nearest" };
        this.#messages = new Messages(lexicon, { format, labels });
        this.#known = lexicon.known(own, numbers, []);
        this.#numbers = numbers;
        this.#clock = clockOf(tools, clock, context);
        this.#given = clock ?? null;
        this.#origin = this.#clock?.anchored ? null : 0;
        this.#frame = output === "faps" ? new Int16Array(CHANNELS) : {};
        const table = lexicon.table(this.#known); // an error in a word of one's own is raised now
        const milliseconds = lexicon.offset(offset);
        this.#blocks = new Blocks(lexicon);
        this.#blocks.table = table;
        const copy = this.#modelCopy();
        const found = this.#numbersInModel();
        this.#at = this.#blocks.take(wasm.voice_size(copy, PLACES));
        this.#faps = this.#blocks.take(2 * CHANNELS);
        this.#shares = this.#blocks.take(VISEMES);
        memory.bytes.fill(0, this.#shares, this.#shares + VISEMES);
        memory.bytes.fill(0, this.#at, this.#at + wasm.voice_size(copy, 0));
        abandoned.register(this, this.#blocks, this);
        lexicon.check(wasm.voice_init(this.#at, copy, PLACES, found, milliseconds));
        lexicon.check(wasm.voice_words(this.#at, table.place));
    }

    // ---- What becomes known

    feed(message) {
        this.#open();
        for (const { told, chained, joins, gap, utterance } of this.#messages.read(message)) {
            const counted = chained ? CHAINED : joins ? JOINED : ABSOLUTE;
            for (const { kind, items, key } of told) {
                this.#tell(kind, items, { counted, utterance, key: key === undefined ? 0 : Math.trunc(key) + 1,
                    gap: Math.round(1000 * (gap ?? 0)) });
            }
        }
    }

    say(text, start, end) {
        this.#open();
        if (typeof text !== "string") throw new TypeError(`the word is ${this.#tools.shown(text)}, not text`);
        const item = this.#timed(strip(text), start, end ?? null, this.#tools.shown(text));
        if (item.text) this.#tell("words", [item]);
    }

    push(label, start, end) {
        this.#open();
        const item = this.#timed("", start, end, "a phoneme");
        item.text = this.#labial.phoneme(label, this.#settings);
        this.#tell("phonemes", [item]);
    }

    begin(at, utterance) {
        this.#open();
        if (utterance != null && typeof utterance !== "string") {
            throw new TypeError(`the utterance is ${this.#tools.shown(utterance)}, not its name`);
        }
        let after = 0;
        if (this.#origin === null) {
            this.#origin = at == null ? this.#clock.read() : this.#moment(at);
            if (!this.cancelled && utterance == null) return;
        } else {
            const heard = this.#clock ? (this.#clock.read() ?? 0) : Infinity;
            const shown = this.#next / this.fps;
            if (heard - this.#origin < shown - 1 / this.fps) this.#origin = heard - shown; // the clock was set back
            after = at == null ? -1 : this.#moment(at) - this.#origin;
            if (at != null && after < 0) throw new RangeError(`${at} s is before the first sound, ${this.#origin} s`);
        }
        this.#checked(this.#lexicon.wasm.voice_begin(this.#at, after, this.#identity(utterance)));
    }

    delay(seconds) {
        this.#open();
        const later = this.#tools.amount(seconds, "the delay");
        if (this.#origin !== null) this.#origin += later;
    }

    finish() {
        this.#open();
        this.#messages.expectTimings();
        this.#lexicon.wasm.voice_finish(this.#at);
    }

    cancel(milliseconds = 200) {
        this.#open();
        const length = Math.min(this.#tools.amount(milliseconds, "milliseconds"), CANCEL_MAX);
        this.#lexicon.wasm.voice_cancel(this.#at, Math.ceil(length - 1e-6));
        [this.#since, this.#eased] = [this.#tools.elapsed(), 0];
    }

    // ---- What is shown

    played(seconds = this.now) {
        return this.#poses(seconds, (faps) => {
            return this.#output === "faps" ? Int16Array.from(faps) : this.#labial.convert(faps, this.#output, {}, this.#sounds);
        });
    }

    at(seconds = this.now) {
        if (this.#closed) this.#shown = this.#sounds = null;
        else this.#poses(seconds, () => null);
        const faps = this.#shown ?? new Array(CHANNELS).fill(0);
        if (this.#output !== "faps") return this.#labial.convert(faps, this.#output, this.#frame, this.#sounds);
        this.#frame.set(faps);
        return this.#frame;
    }

    get visemes() {
        return this.#sounds ?? Uint8Array.from({ length: VISEMES }, (_, i) => (i === 0 ? 128 : 0));
    }

    async *follow(clock) {
        if (clock !== undefined && typeof clock !== "function") {
            throw new TypeError(`the clock is ${this.#tools.shown(clock)}, not a function; others are an option`);
        }
        const own = clock ? clockOf(this.#tools, clock) : this.#clock;
        while (!this.#closed) {
            const heard = this.#read(own);
            for (const frame of this.played(heard)) {
                yield frame;
                if (this.#closed) return;
            }
            if (this.#lexicon.wasm.voice_finished(this.#at) && this.done) return;
            const wait = heard === null ? PATIENCE : this.#origin + this.#next / this.fps - heard;
            const milliseconds = 1000 * Math.min(Math.max(wait, 0.001), 1 / this.fps);
            await new Promise((resolve) => { setTimeout(resolve, milliseconds); });
        }
    }

    get number() { return this.#number; }
    get time() { return this.number / this.fps + (this.#origin ?? 0); }
    get now() { return this.#read(this.#clock); }
    get clock() { return this.#given; }
    get output() { return this.#output; }
    get fps() { return this.#model.fps; }
    get done() { return this.#closed || this.#lexicon.wasm.voice_done(this.#at) !== 0; }
    get cancelled() { return !this.#closed && this.#lexicon.wasm.voice_cancelled(this.#at) !== 0; }

    get stats() {
        this.#open();
        return this.#lexicon.withBytes(12, (at) => {
            this.#lexicon.wasm.voice_counts(this.#at, at);
            const [told, skipped, dropped] = this.#lexicon.memory.int32(at, 3);
            const read = this.#messages.stats;
            return { messages: read.messages, told, skipped: read.skipped + skipped, dropped };
        });
    }

    get closed() { return this.#closed; }

    close() {
        this.#closed = true;
        this.#blocks.release();
        abandoned.unregister(this);
    }

    // ---- Inside --------------------------------------------------------------------------------------------------

    get #next() { return this.#closed ? 0 : this.#lexicon.wasm.voice_next(this.#at); }

    #read(clock) {
        if (!clock) throw new this.#tools.LabialError("the voice has no clock: give it one, or say the time");
        return clock.read();
    }

    #open() {
        if (this.#closed) throw new this.#tools.LabialError("the voice is closed");
    }

    #moment(seconds) {
        if (this.#tools.amount(seconds, "the time") > LATEST) throw new RangeError(`${seconds} s is more than a year`);
        return seconds;
    }

    #timed(text, start, end, what) {
        const [begin, stop] = [this.#moment(start), end === null ? null : this.#moment(end)];
        if (stop !== null && !(begin <= stop && stop <= begin + HOUR)) {
            throw new RangeError(`${what} from ${begin} to ${stop} s ends before it begins or lasts more than an hour`);
        }
        if (Math.max(begin, stop ?? 0) > DAY) {
            throw new RangeError(`${what} at ${begin} s is more than a day after the beginning; are these seconds?`);
        }
        if (stop - begin > LONG && !this.#doubts) {
            this.#doubts = true;
            console.warn(`labial: ${what} lasts ${stop - begin} s; are these seconds?`);
        }
        return { text, start: begin, end: stop };
    }

    #checked(result) {
        if (result !== FULL) return this.#lexicon.check(result);
        throw new this.#tools.LabialError("too many words, phonemes or utterances are told ahead of the sound: " +
            `there is room for ${PLACES} phonemes`);
    }

    #identity(utterance) {
        if (utterance == null) return 0;
        return this.#lexicon.withText(utterance, (at, size) => this.#lexicon.wasm.voice_identity(at, size));
    }

    /** Gives the library what a message tells of one kind. */
    #tell(kind, items, { counted = ABSOLUTE, utterance = null, key = 0, gap = 0 } = {}) {
        const { wasm, memory } = this.#lexicon;
        if (!this.#model.names && kind !== "phonemes") this.#phoneme("SIL"); // an error
        const texts = items.map(({ text }) => (kind === "phonemes" ? this.#phoneme(text) : whole(text)));
        if (kind === "words" || kind === "characters") this.#learn(texts, kind === "characters");
        const count = items.length;
        const room = texts.reduce((sum, text) => sum + 3 * (text.length ?? 1) + 1, 1);
        const structures = wasm.voice_items_size(count);
        const identity = this.#identity(utterance);
        this.#lexicon.withBytes(structures + 18 * count + room, (at) => {
            const [times, sizes] = [at + structures, at + structures + 16 * count];
            let to = sizes + 2 * count;
            const begin = to;
            texts.forEach((text, i) => {
                const size = kind === "phonemes" ? 1 : memory.write(text, to, 3 * text.length + 1).written;
                if (kind === "phonemes") memory.bytes[to] = text;
                memory.int16(sizes, count)[i] = Math.min(size, 32767);
                to += Math.min(size, 32767);
            });
            const seconds = new Float64Array(memory.bytes.buffer, times, 2 * count);
            items.forEach(({ start, end }, i) => seconds.set([start, end ?? -1], 2 * i));
            this.#checked(wasm.voice_tell(this.#at, at, count, times, sizes, begin, identity, key, gap, KINDS[kind],
                counted));
        });
    }

    #phoneme(label) {
        return this.#labial.phoneme(label, { model: this.#model });
    }

    /** Tells the library of numbers that are to be written out. Characters may go on in the next message. */
    #learn(texts, joined) {
        if (!this.#numbers) return;
        const text = joined ? this.#tail + texts.join("") : texts.join(" ");
        if (joined) this.#tail = text.slice(-100).match(/\S*$/u)[0];
        const known = this.#lexicon.known(this.#known, this.#numbers, [text]);
        if (known.size === this.#known.size) return;
        const table = this.#lexicon.table(known);
        this.#lexicon.wasm.voice_words(this.#at, table.place);
        this.#blocks.table = table;
        this.#known = known;
    }

    /** The model, copied from the library's memory to this module's, where its tables have other addresses. */
    #modelCopy() {
        const { at, range: [begin, end] } = this.#model;
        const isBundled = this.#model === this.#labial.models.speech;
        if (isBundled && this.#lexicon.speech) return this.#lexicon.speech;
        const copy = isBundled ? this.#lexicon.memory.take(end - begin) : this.#blocks.take(end - begin);
        this.#lexicon.memory.bytes.set(this.#labial.memory.bytes.subarray(begin, end), copy);
        this.#lexicon.wasm.voice_move(copy + at - begin, copy - begin);
        if (isBundled) this.#lexicon.speech = copy + at - begin;
        return copy + at - begin;
    }

    /** The model's number of each phoneme of words, or 0 where they are the same, or where it has other ones. */
    #numbersInModel() {
        const { names } = this.#model;
        if (!names) return 0;
        const settings = { model: this.#model, nearest: true };
        const numbers = this.#lexicon.labels.map((label) => this.#labial.phoneme(label, settings));
        if (numbers.every((number, i) => number === i)) return 0;
        const at = this.#blocks.take(numbers.length);
        this.#lexicon.memory.bytes.set(numbers, at);
        return at;
    }

    /** What `take` makes of the poses that are due. After a cancel and at the end the clock may stand with its sound: then
     * the face eases by the program's time. */
    #poses(seconds, take) {
        this.#open();
        if (seconds !== null && (typeof seconds !== "number" || Number.isNaN(seconds))) {
            throw new TypeError(`the time is ${this.#tools.shown(seconds)}, not a number of seconds or null`);
        }
        const poses = seconds === null || this.#origin === null ? [] : this.#due(seconds - this.#origin, take);
        const now = this.#tools.elapsed();
        const stands = seconds === null || seconds <= this.#heard;
        if (!stands && !this.cancelled) [this.#since, this.#eased] = [now, 0];
        const due = Math.floor((now - this.#since) / 1000 * this.fps);
        while (stands && this.#eased < due) {
            const result = this.#lexicon.wasm.voice_ease(this.#at, this.#faps);
            if (result === OK) poses.push(this.#take(take));
            else if (result === WAITING) this.#eased++;
            else break;
        }
        this.#heard = seconds ?? this.#heard;
        if (poses.length) {
            const done = this.done && !this.cancelled;
            if (done && !this.#told) this.dispatchEvent(new Event("ended"));
            this.#told = done;
        }
        return poses;
    }

    /** What `take` makes of the frames that became due when `heard` seconds of the voice were heard. */
    #due(heard, take) {
        if (heard > LATEST) throw new RangeError(`${heard} s is more than a year`);
        const last = heard >= 0 ? Math.floor(heard * this.fps + 1e-6) : -1;
        if (last < this.#next) return [];
        const frames = [];
        while (this.#checked(this.#lexicon.wasm.voice_frame(this.#at, last, this.#faps)) === 0) {
            this.#number = this.#next - 1;
            frames.push(this.#take(take));
        }
        return frames;
    }

    /** What `take` makes of the pose that was computed. */
    #take(take) {
        const { wasm, memory } = this.#lexicon;
        this.#shown = Int16Array.from(memory.int16(this.#faps, CHANNELS));
        wasm.voice_visemes(this.#at, this.#shares);
        this.#sounds = memory.bytes.slice(this.#shares, this.#shares + VISEMES);
        this.#eased++;
        return take(this.#shown);
    }
}

// Clocks by which a voice is heard: how many seconds of its sound have reached the listener.

/** For streams that come without a context. */
let shared;

/** What reads a clock: `read` returns seconds, or null while nothing is heard. `anchored` where the clock runs before
 * the voice does, so that begin() must say when it begins. */
function clockOf({ shown, heard }, clock, context) {
    if (clock == null) return null;
    if (typeof clock === "function") return { read: () => clock() ?? null, anchored: false };
    if (typeof clock === "object") {
        if ("destination" in clock && "currentTime" in clock) return { read: () => output(clock), anchored: true };
        if ("play" in clock && "currentTime" in clock) {
            const silent = () => clock.currentTime === 0 && (clock.paused || clock.readyState < 3);
            return { read: () => (silent() ? null : heard(clock)), anchored: false };
        }
        if ("getAudioTracks" in clock) {
            if (shared?.state === "closed") shared = null; // by the page
            const own = context ?? (shared ??= new AudioContext());
            if (own === shared) Promise.resolve(own.resume()).catch(() => {}); // waits for a click
            return { read: () => output(own), anchored: true };
        }
    }
    const kinds = "an AudioContext, a media element, a MediaStream or a function";
    throw new TypeError(`the clock is ${shown(clock)}, not ${kinds}`);
}

/** The time of an AudioContext that is heard now: what is computed at `currentTime` is heard later. */
function output(context) {
    return context.currentTime - (context.outputLatency || context.baseLatency || 0);
}
