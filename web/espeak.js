// Phonemes and their times from espeak-ng as WebAssembly (@echogarden/espeak-ng-emscripten), whose events have the
// fields of espeak_EVENT. It does what tools/speak/espeak.c and export/labial/hearing/voices.py do; a test holds them to
// each other.
import { LabialError, shown } from "./memory.js";

/** Shorter stretches without a label are word boundaries, glottal stops or glides, for which espeak-ng has no IPA: they
 * belong to the phoneme before. Milliseconds; pauses last 150. */
const SHORTEST_PAUSE = 65;
/** Milliseconds: steps in which the sound's level is taken, the longest closure, what the phoneme before it keeps. */
const STEP = 5;
const LONGEST_CLOSURE = 100;
const KEPT = 20;
/** A closure is this many times quieter than the loudest step of the phoneme before it. */
const QUIETER = 16;
const STOP = /^[ptkbdgcqɡʈɖɟɢ]/u;
/** Tones, and modifier letters that espeak-ng reports on their own, are part of the phoneme before. */
const MARK = /^[\p{Nd}\p{Lm}\p{Sk}]*$/u;
/** Bytes of a label; what the binding reads beyond them is of another field. */
const LABEL_MAX = 8;
/** What espeak-ng 1.51 calls the vowel of German "Uhr", for want of an IPA. */
const NAMELESS = { "??": "ʊɐ" };
/** The lowest and highest rates of sound. */
const RATES = [1000, 384000];

/** Segments of what espeak-ng said, from its events; `samples` is the sound, whole or in pieces. */
export function fromEspeak(events, { samples, sampleRate } = {}) {
    const sound = samples == null ? null : new Sound(samples, sampleRate);
    const segments = [];
    let label = ""; // of the phoneme that began last
    let begin = 0;
    let unlabelled = 0; // where a stretch without a label begins behind it
    let last = 0;

    const add = (from, to, what) => {
        const labels = what && { labels: "ipa" };
        if (to > from) segments.push({ start: from / 1000, end: to / 1000, label: what, ...labels });
    };
    const isPause = (moment) => unlabelled > 0 && moment >= unlabelled + SHORTEST_PAUSE;
    const close = (end) => {
        let from = begin;
        if (isPause(end)) {
            add(from, unlabelled, label);
            [label, from] = ["", Math.max(from, unlabelled)];
        }
        unlabelled = 0;
        add(from, end, label);
    };
    for (const { type, position, name } of checked(events)) {
        last = Math.max(last, position);
        if (type !== "phoneme" || name.startsWith("(")) continue; // the name of a language, where its words begin
        if (!name && !unlabelled) unlabelled = position;
        if (MARK.test(name)) continue;
        const closed = sound && label && !isPause(position) && STOP.test(name);
        const start = Math.max(begin, closed ? sound.closure(begin, position) : position);
        close(start);
        [label, begin] = [name, start];
    }
    close(Math.max(sound ? sound.end : last, begin));
    if (!segments.length) throw new LabialError("espeak-ng reported no phonemes: it does so for events of synthesize()");
    return segments;
}

/** The levels of a sound. */
class Sound {
    constructor(samples, rate) {
        if (typeof rate !== "number" || !(rate >= RATES[0] && rate <= RATES[1])) {
            throw new TypeError(`sampleRate is ${shown(rate)}, not a number from ${RATES[0]} to ${RATES[1]}`);
        }
        const pieces = ArrayBuffer.isView(samples) ? [samples] : samples;
        const isSound = (one) => one instanceof Int16Array || one instanceof Float32Array;
        if (!Array.isArray(pieces) || !pieces.every(isSound)) {
            throw new TypeError(`the samples are ${shown(samples)}, not an Int16Array, a Float32Array or a list of them`);
        }
        this.levels = [];
        let [place, sum, count, bound] = [0, 0, 0, Math.ceil((STEP * rate) / 1000)];
        for (const piece of pieces) {
            const scale = piece instanceof Float32Array ? 32768 : 1;
            for (const value of piece) {
                sum += Math.abs(Math.round(scale * value));
                count++;
                if (++place < bound) continue;
                this.levels.push(Math.floor(sum / count));
                bound = Math.ceil(((this.levels.length + 1) * STEP * rate) / 1000);
                sum = count = 0;
            }
        }
        this.end = Math.round((1000 * place) / rate);
    }

    /** Where the silence before a burst begins, milliseconds: at `burst` itself if there is none. The phoneme before
     * begins at `before`. */
    closure(before, burst) {
        const end = Math.min(Math.floor(burst / STEP), this.levels.length);
        const first = Math.max(Math.ceil((before + KEPT) / STEP), end - LONGEST_CLOSURE / STEP, 0);
        const loudest = this.levels.slice(Math.floor(before / STEP), end).reduce((most, one) => Math.max(most, one), 0);
        let begin = end;
        while (begin > first && this.levels[begin - 1] * QUIETER <= loudest) begin--;
        return begin < end ? begin * STEP : burst;
    }
}

/** The events' types, positions in milliseconds, and labels. */
function checked(events) {
    if (!Array.isArray(events)) throw new TypeError(`the events are ${shown(events)}, not a list`);
    return events.map((event, i) => {
        const { type, audio_position: position, id } = event ?? {};
        const named = type !== "phoneme" || typeof id === "string";
        if (typeof type !== "string" || !named || typeof position !== "number" || !(Math.abs(position) < 2 ** 31)) {
            throw new LabialError(`event ${i + 1} is not one of espeak-ng's: ${shown(JSON.stringify(event))}`);
        }
        const name = type === "phoneme" ? cut(id) : "";
        return { type, position: Math.max(position, 0), name: Object.hasOwn(NAMELESS, name) ? NAMELESS[name] : name };
    });
}

/** The whole characters in the first bytes of a label. */
function cut(label) {
    let bytes = 0;
    return [...label].filter((one) => {
        const code = one.codePointAt(0);
        bytes += code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
        return bytes <= LABEL_MAX;
    }).join("");
}
