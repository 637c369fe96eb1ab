// What is known of a voice: its utterances and their phonemes, in time, by the rules of docs/streams.md. It does what
// export/labial/runtime/timeline.py does; a test holds them to each other.
//
// All times are whole milliseconds: those of items from the beginning of their utterance, those of segments from the
// beginning of the played sound.
import { strip, wordsOfCharacters } from "./characters.js";
import { segmentsOf } from "./stream.js";

/** Items that may be known at a time: a server is not trusted. */
const MOST = 10000;
/** Kinds of items: of those that an utterance has, the first counts. */
const KINDS = ["phonemes", "azure", "polly", "words", "characters"];
/** What is over is forgotten so many milliseconds later. */
const KEPT = 1000;
/** A gap between phonemes up to this comes from rounding. */
export const ROUNDING = 1;
/** Before a change, so many characters are read again, for a [tag] may have begun there. */
const BACK = 100;

/** Whole milliseconds; halves are rounded up, here and in Python. */
export function milliseconds(seconds) {
    return Math.floor(seconds * 1000 + 0.5);
}

/** The utterances of a voice. An item is { start, end, what, gap, key }; a segment is { start, end, phoneme }. */
export class Timeline {
    #lexicon;
    #how; // own words and numbers
    #number; // of a label in the model
    #silence;
    #offset;
    #utterances = [];

    constructor(lexicon, { own, numbers, number, silence, offset }) {
        const known = lexicon.known(own, numbers, []);
        lexicon.release(lexicon.table(known)); // an error in a word of one's own is raised now
        this.#lexicon = lexicon;
        this.#how = { own: known, numbers };
        this.#number = number;
        this.#silence = silence;
        this.#offset = offset;
    }

    /** Whether nothing is known. */
    get empty() {
        return !this.#utterances.some(({ segments }) => segments.length);
    }

    /** When the last utterance ends, as far as is known. */
    get end() {
        const last = this.#utterances.at(-1);
        return last ? Math.max(last.end, last.origin + (last.segments.at(-1)?.end ?? 0)) : 0;
    }

    /** A new utterance; the one before it ends there at the latest. */
    begin(origin) {
        this.#utterances.push(new Utterance(origin));
    }

    clear() {
        this.#utterances = [];
    }

    /** Adds what a message tells to the last utterance; items that begin within the time of the new ones are replaced.
     * Throws where that cannot be read, and where there is too much of it; then nothing is changed. */
    tell(heard) {
        const copy = this.#utterances.at(-1).copy();
        this.#add(copy, itemsOf(heard, copy));
    }

    /** The same with an item of the caller's own. */
    put(kind, item) {
        this.#add(this.#utterances.at(-1).copy(), [[kind, [item]]]);
    }

    /** All phonemes from `start` on, without gaps, and silence without end after them. */
    plan(start) {
        const found = [];
        const append = (begin, end, phoneme) => {
            const last = found.at(-1);
            if (last && last.phoneme === phoneme && phoneme === this.#silence) last.end = end;
            else found.push({ start: begin, end, phoneme });
        };
        let moment = start;
        this.#utterances.forEach(({ origin, segments }, i) => {
            const limit = this.#utterances[i + 1]?.origin ?? Infinity;
            const shift = origin + this.#offset;
            for (const segment of segments) {
                const begin = Math.max(segment.start + shift, moment);
                const end = Math.min(segment.end + shift, limit);
                if (end <= begin) continue;
                if (begin > moment) append(moment, begin, this.#silence);
                append(begin, end, segment.phoneme);
                moment = end;
            }
        });
        append(moment, Infinity, this.#silence);
        return found;
    }

    /** Forgets what ended well before `moment`. */
    forget(moment) {
        const limit = moment - KEPT - this.#offset;
        const utterances = this.#utterances;
        while (utterances.length > 1 && Math.max(utterances[0].end, utterances[1].origin) < limit) utterances.shift();
        for (const utterance of utterances) utterance.forget(limit - utterance.origin);
    }

    /** Adds items to a copy of the last utterance, which then takes its place. */
    #add(copy, told) {
        for (const [kind, items] of told) {
            const first = put((copy.items[kind] ??= []), items);
            for (const { start, end } of items) copy.end = Math.max(copy.end, copy.origin + (end ?? start));
            const all = [...this.#utterances.slice(0, -1), copy].flatMap((one) => Object.values(one.items));
            if (all.reduce((sum, { length }) => sum + length, 0) > MOST) {
                const { LabialError } = this.#lexicon.tools;
                throw new LabialError(`more than ${MOST} words or phonemes are told ahead of the sound`);
            }
            if (kind === copy.kind) this.#convert(copy, kind, kind === copy.counted ? first : 0);
        }
        this.#utterances[this.#utterances.length - 1] = copy;
    }

    /** Makes the segments of the items of a kind, of which those from `changed` on are new. */
    #convert(utterance, kind, changed) {
        const items = utterance.items[kind];
        const { segments } = utterance;
        const first = convertedFrom(kind, items, changed);
        const kept = first > 0 ? placeOf(segments, items[first].start - ROUNDING) : 0;
        segments.length = kept;
        utterance.counted = kind;
        const fresh = items.slice(first);
        const found = kind === "phonemes" ? sounds(fresh, kept ? segments[kept - 1].end : -Infinity)
            : kind === "words" || kind === "characters" ? this.#spoken(fresh, kind) : this.#shapes(fresh, kind);
        for (const { start, end, what } of found) segments.push({ start, end, phoneme: this.#number(what) });
    }

    /** The phonemes of words or of characters. */
    #spoken(items, kind) {
        const words = kind === "words" ? items.map(({ what, start, end }) => ({ text: what, start, end }))
            : wordsOfCharacters(items.map(({ what }) => what), items.map(({ start }) => start),
                items.map(({ start, end }) => end ?? start));
        const whole = (seconds) => Math.round(1000 * seconds);
        return segmentsOf(this.#lexicon, words, this.#how).filter(({ label }) => label)
            .map(({ start, end, label }) => ({ start: whole(start), end: whole(end), what: label }));
    }

    /** The phonemes of visemes, each of which lasts until the next. */
    #shapes(items, kind) {
        const names = items.map(({ what }) => what);
        return this.#lexicon.tools.timings.standIns(kind, names).map(({ first, last, phoneme }) => ({
            start: items[first].start,
            end: items[last + 1]?.start ?? items.at(-1).start + milliseconds(this.#lexicon.tools.timings.LAST_VISEME),
            what: phoneme,
        }));
    }
}

/** Words or phonemes whose times count from `origin`. */
class Utterance {
    items = {};
    told = {}; // seconds up to which messages of a kind told something
    counted = ""; // the kind that the segments are of
    segments = []; // times from the origin

    constructor(origin) {
        this.origin = this.end = origin;
    }

    copy() {
        const found = new Utterance(this.origin);
        for (const [kind, items] of Object.entries(this.items)) found.items[kind] = [...items];
        const { told, end, counted, segments } = this;
        return Object.assign(found, { told: { ...told }, end, counted, segments: [...segments] });
    }

    /** The kind that counts. */
    get kind() {
        return KINDS.find((kind) => this.items[kind]?.length) ?? "";
    }

    /** Forgets the items that end before `limit`, but the last ones; characters up to a blank. */
    forget(limit) {
        for (const [kind, items] of Object.entries(this.items)) {
            let count = 0;
            for (let i = 0; i + 1 < items.length; i++) {
                if (Math.max(items[i].start, items[i].end ?? 0, items[i + 1].start) >= limit) break;
                if (kind !== "characters" || isBlank(items[i].what)) count = i + 1;
            }
            items.splice(0, count);
        }
        while (this.segments.length > 1 && this.segments[0].end < limit) this.segments.shift();
    }
}

/** The items that a message tells, by kind, and in the order of their beginnings. */
function itemsOf({ told, chained, joins, gap }, utterance) {
    return told.map(({ kind, items, key }) => {
        const before = utterance.told[kind] ?? 0;
        let timed = items;
        if (timed.length && (chained || joins)) {
            const origin = chained || timed[0].start < before - 1e-3 ? before : 0;
            timed = timed.map(({ text, start, end }) => {
                return { text, start: start + origin, end: end === null ? null : end + origin };
            });
        }
        utterance.told[kind] = timed.reduce((most, { start, end }) => Math.max(most, end || start), before);
        const rows = timed.map(({ text, start, end }) => ({
            start: milliseconds(start), end: end === null ? null : milliseconds(end), what: text,
            gap: Math.max(milliseconds(gap), ROUNDING), key,
        }));
        if (key !== undefined) {
            utterance.items[kind] = (utterance.items[kind] ?? []).filter((item) => item.key !== key);
            utterance.counted = "";
        }
        return [kind, rows.sort((a, b) => a.start - b.start)];
    });
}

/** Puts items where they belong, in place of those that begin within their time; returns the place of the first. */
function put(known, items) {
    if (!items.length) return known.length;
    const begin = items[0].start;
    const end = items.reduce((most, item) => Math.max(most, item.end ?? item.start + 1), begin + 1);
    const first = placeOf(known, begin);
    known.splice(first, placeOf(known, end) - first, ...items);
    return first;
}

/** The place of the first of what begins at `start` or later. */
function placeOf(sorted, start) {
    let [low, high] = [0, sorted.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if (sorted[middle].start < start) low = middle + 1;
        else high = middle;
    }
    return low;
}

/** The first item that may sound otherwise if those from `changed` on do. */
function convertedFrom(kind, items, changed) {
    if (kind !== "characters") return Math.max(0, changed - 2);
    let first = changed - BACK;
    while (first > 0 && !isBlank(items[first - 1].what)) first--;
    return Math.max(0, first);
}

/** Phonemes after one that ends at `previous`: each lasts until the next if the gap between them is short, and no
 * longer. */
function sounds(items, previous) {
    return items.map((item, i) => {
        const after = items[i + 1]?.start ?? -1;
        let { start } = item;
        let end = item.end ?? start;
        if (Math.abs(start - previous) <= ROUNDING) start = previous;
        if ((end < after && after <= end + item.gap) || (end > after + ROUNDING && after + ROUNDING > 0)) end = after;
        end = Math.max(start, end);
        previous = end;
        return { start, end, what: item.what };
    });
}

function isBlank(text) {
    return text !== "" && strip(text) === "";
}
