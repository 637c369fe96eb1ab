// A whole utterance: converts timings to frames for every moment of its sound.
import { CHANNELS, LONGEST, LabialError, VISEMES, amount, shown } from "./memory.js";

/** Overlaps and gaps up to this many microseconds come from rounding. */
const TOLERANCE = 1000;
/** Number of phonemes after which frames are read. */
const BATCH = 4096;

export class Track {
    #labial;
    #between = new Float32Array(CHANNELS);
    #shares = new Uint8Array(VISEMES);
    #weights = {};

    constructor(labial, output, fps, { faps, visemes }) {
        this.#labial = labial;
        const length = faps.length / CHANNELS;
        Object.assign(this, { output, fps, faps, visemes, length, duration: length / fps });
    }

    at(seconds) {
        if (typeof seconds !== "number" || Number.isNaN(seconds)) {
            throw new TypeError(`the time is ${shown(seconds)}, not a number of seconds`);
        }
        const between = this.#between;
        const last = this.length - 1;
        const place = Math.max(0, Math.min(last, seconds * this.fps));
        const first = Math.floor(place);
        const next = Math.min(last, first + 1);
        const mix = (all, width, i) => {
            const value = all[width * first + i];
            return value + (all[width * next + i] - value) * (place - first);
        };
        for (let i = 0; i < CHANNELS; i++) between[i] = last < 0 ? 0 : mix(this.faps, CHANNELS, i);
        if (this.output === "faps") return between;
        for (let i = 0; i < VISEMES && last >= 0; i++) this.#shares[i] = Math.round(mix(this.visemes, VISEMES, i));
        return this.#labial.convert(between, this.output, this.#weights, last < 0 ? null : this.#shares);
    }

    frame(number) {
        if (!Number.isInteger(number) || number < 0 || number >= this.length) {
            throw new RangeError(`there is no frame ${shown(number)}; the track has ${this.length}`);
        }
        const faps = this.faps.subarray(CHANNELS * number, CHANNELS * (number + 1));
        if (this.output === "faps") return faps;
        return this.#labial.convert(faps, this.output, {}, this.visemes.subarray(VISEMES * number, VISEMES * (number + 1)));
    }

    *[Symbol.iterator]() {
        for (let number = 0; number < this.length; number++) yield this.frame(number);
    }
}

/** The FAPs of all frames of the segments, 13 for each, and the shares of their sounds, 15 for each. */
export function speak(stream, segments) {
    if (!segments || typeof segments[Symbol.iterator] !== "function" || typeof segments === "string") {
        throw new TypeError(`the timings are ${shown(segments)}, not a list of { start, end, label }`);
    }
    const [faps, visemes] = [growing(new Int16Array(CHANNELS * 512)), growing(new Uint8Array(VISEMES * 512))];
    const add = (piece, shares) => {
        faps.add(piece);
        visemes.add(shares);
    };
    let position = 0; // microseconds
    let number = 0;
    const until = (end) => {
        const whole = Math.floor((end + 500) / 1000) - Math.floor((position + 500) / 1000);
        position = end;
        return whole;
    };
    for (const segment of segments) {
        const [start, end] = times(segment, ++number);
        if (start + TOLERANCE < position) {
            throw new LabialError(`entry ${number} starts at ${segment.start} s, before the one before it ends`);
        }
        if (start > position + TOLERANCE) stream.push(stream.model.silence, until(start));
        say(stream, segment, number, until(Math.max(position, end)));
        if (number % BATCH === 0) stream.drain(add);
    }
    stream.end();
    stream.drain(add);
    return { faps: faps.all(), visemes: visemes.all() };
}

/** An array that grows as pieces are added to it. */
function growing(array) {
    let used = 0;
    const add = (piece) => {
        if (used + piece.length > array.length) {
            const larger = new array.constructor(2 * array.length + piece.length);
            larger.set(array.subarray(0, used));
            array = larger;
        }
        array.set(piece, used);
        used += piece.length;
    };
    return { add, all: () => array.slice(0, used) };
}

function times(segment, number) {
    if (!segment || typeof segment !== "object") {
        throw new TypeError(`entry ${number} is ${shown(segment)}, not an object { start, end, label }`);
    }
    const [start, end] = ["start", "end"].map((name) => {
        const seconds = amount(segment[name], `entry ${number}: ${name}`);
        if (seconds > LONGEST) {
            throw new LabialError(`entry ${number}: ${seconds} s is more than a day; are these seconds?`);
        }
        return Math.round(1e6 * seconds);
    });
    if (end < start) throw new LabialError(`entry ${number} ends at ${segment.end} s, before its start`);
    return [start, end];
}

function say(stream, segment, number, milliseconds) {
    const { label = segment.phoneme, labels: hint } = segment;
    const laugh = typeof label === "string" && /^<laugh(?:[: ](.*))?>$/.exec(label);
    try {
        if (laugh) {
            const intensity = laugh[1] === undefined ? 0.5 : Number(laugh[1] || NaN);
            stream.laugh(milliseconds / 1000, intensity);
        } else {
            stream.push(label === "" ? stream.model.silence : label, milliseconds, { hint });
        }
    } catch (error) {
        if (error instanceof Error) error.message = `entry ${number}: ${error.message}`;
        throw error;
    }
}
