// Timings that speech services report as JSON: the interpreter of the table export/labial/corpus/services.json, which
// the build writes as table.js. It does what services.py and formats.py of export/labial/corpus do; a test holds them to
// each other.
import { entriesOf, plain, told } from "./entries.js";
import { LONGEST, LabialError, shown } from "./memory.js";
import table from "./table.js";

export { Entry, LIMITS, documentsOf, entriesOf } from "./entries.js";

/** A blank between words, or a gap between a service's phonemes, is a pause if it is longer, in seconds. */
export const LONGEST_GAP = 0.15;
/** Seconds that the last viseme lasts, of which only the beginning is told. */
const LAST_VISEME = 0.1;
/** No word or phoneme lasts longer, in seconds. */
const LONGEST_ITEM = 3600;
/** Times that differ by no more, in seconds, are the same. */
const ROUNDING = 0.001;
/** Messages of which the times go on may overlap by as much, seconds. */
const OVERLAP = 0.02;

const VISEMES = table.visemes;
const KINDS = ["sounds", "labels", "phonemes", ...Object.keys(VISEMES), "words", "characters"];
const isSpoken = (kind) => kind === "words" || kind === "characters";
const VOWELS = new Set("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split(" "));

// ---- Readers of the package labial

export const fromPiper = (source) => segmentsOf("piper", entriesOf(source));
export const fromKokoro = (source) => segmentsOf("kokoro", entriesOf(source));
export const fromHeadTTS = (source) => segmentsOf("headtts", entriesOf(source));
export const fromAzure = (source) => segmentsOf("azure", entriesOf(source));
export const fromPolly = (source) => segmentsOf("polly", entriesOf(source));

/** Segments of a service's messages, in the order of their arrival. `spoken` makes those of words and characters. */
export function segmentsOf(name, entries, spoken = null) {
    const service = SERVICES[name];
    const odd = new Odd(true);
    const found = Object.fromEntries(KINDS.map((kind) => [kind, []]));
    for (const item of entries) {
        for (const told of service.read(item, odd)) found[told.kind].push([service.utterance(item), told]);
    }
    const kind = KINDS.find((one) => (spoken || !isSpoken(one)) && found[one].some(([, { items }]) => items.length));
    const items = kind ? joined(found[kind], service.times) : [];
    const advice = service.advice && `: ${service.advice}`;
    if (!items.length) throw new LabialError(`${service.title} times nothing here${advice}`);
    if (VISEMES[kind]) return checked(shapes(items, kind));
    return checked(isSpoken(kind) ? spoken(items, kind) : phonemeSegments(items, kind));
}

/** The items of messages one after the other. Where messages have keys, they are in the order of these, and the latest
 * of each counts. Times begin again with an utterance, and where a service may count from the message before: in one
 * that begins before that one began, or with other words within it, of which it lasts at least half. They then count
 * from the end of all that came before. */
function joined(messages, times) {
    if (messages.some(([, { key }]) => key !== undefined)) {
        const keyed = new Map(messages.map(([, { key, items }], i) => [key ?? i, items]));
        return [...keyed].sort(([a], [b]) => a - b).flatMap(([, items]) => items);
    }
    const line = new Joint(times);
    return messages.flatMap(([utterance, { items }]) => line.add(items, utterance));
}

/** Puts messages one after the other. */
export class Joint {
    #times;
    #origin = 0;
    #end = 0;
    #before = null;
    #last = null;

    constructor(times) {
        this.#times = times;
    }

    add(items, utterance = null) {
        if (!items.length) return items;
        const [first] = items;
        const last = this.#last;
        const length = Math.max(...items.map(({ start, end }) => end || start)) - first.start;
        const told = this.#end - this.#origin;
        const again = last && (first.start < last.start - ROUNDING
            || ((first.start !== last.start || first.text !== last.text)
                && told - first.start > Math.max(OVERLAP, Math.min(length, told - last.start) / 2)));
        const other = last && utterance !== this.#before && this.#origin + first.start < this.#end - ROUNDING;
        if (this.#times === "chained" || other || (this.#times === "restart" && again)) this.#origin = this.#end;
        const origin = this.#origin;
        const found = items.map((item) => {
            return { ...item, start: item.start + origin, end: item.end === null ? null : item.end + origin };
        });
        this.#end = found.reduce((end, { start, end: own }) => Math.max(end, own || start), this.#end);
        this.#before = utterance;
        this.#last = first;
        return found;
    }
}

// ---- The table's fields

/** Items that make no sense: when strict, the first one is an error, otherwise they are counted. */
export class Odd {
    count = 0;
    first = null;

    constructor(strict) {
        this.strict = strict;
    }

    add(place, problem) {
        this.count++;
        this.first ??= place.error(problem());
        if (this.strict) throw this.first;
    }
}

/** A field: its alternatives, each the names on its way and the divisor that makes seconds of it. */
class Field {
    constructor(text) {
        this.optional = text.startsWith("?");
        this.options = text.replace(/^\?/, "").split("|").map((option) => {
            const [path, divisor = "1"] = option.split("/");
            const steps = stepsOf(path);
            const isNumber = /^[0-9]/.test(divisor);
            return { steps, divisor: isNumber ? Number(divisor) : 0, name: isNumber ? "" : plain(divisor) };
        });
        this.name = text.replace(/^[?=]/, "").split("|")[0].split("/")[0];
    }

    /** The value of the first alternative that exists, and its number; undefined without one. */
    found(entry) {
        for (let i = 0; i < this.options.length; i++) {
            const value = descended(entry, this.options[i].steps);
            if (value !== undefined) return [value, i];
        }
        return [undefined, 0];
    }

    /** What the value of an alternative is divided by; 0 where the field that says it does not. */
    divisor(i, entry, root) {
        const { divisor, name } = this.options[i];
        if (!name) return divisor;
        const value = number(entry.plain.get(name) ?? root.plain.get(name), 1);
        return value !== null && value >= 1 ? value : 0;
    }
}

function stepsOf(path) {
    return path ? path.split(".").map((name) => {
        const bare = name.replaceAll("[]", "");
        const exact = bare.startsWith("=");
        return { name: exact ? bare.slice(1) : plain(bare), depth: (name.length - bare.length) / 2, exact };
    }) : [];
}

/** The value at the end of a way, of lists that of the first item. */
function descended(entry, steps) {
    let value;
    let inner = entry;
    for (const { name, depth, exact } of steps) {
        if (!inner) return undefined;
        if (exact) value = Object.hasOwn(inner.fields, name) ? inner.fields[name] : undefined;
        else value = inner.plain.get(name);
        for (let i = 0; i < depth; i++) value = Array.isArray(value) ? value[0] : undefined;
        inner = value === undefined ? null : entry.inner(value);
    }
    return value;
}

/** A value in seconds; null for what is no finite number from 0 on. */
function number(value, divisor) {
    if (typeof value !== "number") return null;
    const found = value / divisor;
    return found >= 0 && found < Infinity ? found : null;
}

function listed(value) {
    return Array.isArray(value) ? value : ArrayBuffer.isView(value) && value.length >= 0 ? Array.from(value) : null;
}

/** One row of what a service tells. */
class Tell {
    constructor(row) {
        const field = (name) => (row[name] === undefined ? null : new Field(row[name]));
        const rule = (name) => Object.entries(row[name] ?? {}).map(([key, text]) => [new Field(key), text]);
        this.kind = row.kind;
        this.places = (row.in ?? [""]).map(stepsOf);
        this.lists = row.lists ?? false;
        for (const name of ["text", "start", "end", "length", "span", "offset", "key"]) this[name] = field(name);
        this.only = rule("only");
        this.without = rule("not");
        this.pieces = (row.pieces ?? []).map((name) => new Field(name));
        this.letters = row.letters ? table.letters : {};
        this.hold = row.hold ?? 0;
    }

    /** The items { text, start, end, item } of a message. */
    read(item, odd) {
        let found = [];
        for (const path of this.places) {
            found = this.#within(item, path, odd).filter((one) => this.text.found(one)[0] !== undefined);
            if (found.length) break;
        }
        if (!found.length) return [];
        let later = 0;
        if (this.offset) {
            const [value, i] = this.offset.found(item);
            later = value === undefined ? 0 : number(value, this.offset.divisor(i, item, item));
            if (later === null) {
                odd.add(item, () => `'${this.offset.name}' is ${told(value)}, not a number from 0 on`);
                return [];
            }
        }
        const rows = this.lists ? found.flatMap((one) => this.#rows(one, odd)) : this.#objects(found, item, odd);
        const times = rows.filter((row) => this.#believed(row, odd)).map(({ text, start, end, item: place }) => ({
            text: Object.hasOwn(this.letters, text) ? this.letters[text] : text,
            start: start + later, end: end === null ? null : end + later, item: place,
        }));
        if (!this.hold) return times;
        return times.map((one, i) => {
            const after = i + 1 < times.length ? times[i + 1].start : Infinity;
            const kept = one.end === null || after === Infinity || one.end < after - this.hold;
            return kept ? one : { ...one, end: after };
        });
    }

    /** Whether there is a list of items, which may be empty. */
    listed(item) {
        return Array.isArray(descended(item, this.places[0].map((step) => ({ ...step, depth: 0 }))));
    }

    /** The objects at the end of a path. */
    #within(item, path, odd) {
        let found = [item];
        path.forEach(({ name, depth }, place) => {
            const after = [];
            for (const one of found) {
                let values = [one.plain.get(name)];
                for (let i = 0; i < depth; i++) values = values.flat();
                for (const value of values) {
                    const inner = one.inner(value, depth ? after.length + 1 : 0);
                    const isLast = place === path.length - 1;
                    if (inner) after.push(inner);
                    else if (value != null && isLast) odd.add(one, () => `${told(value)} is not an object`);
                }
            }
            found = after;
        });
        return found;
    }

    /** Of objects, one for each item. */
    #objects(found, root, odd) {
        const rows = [];
        let moment = 0;
        let behind;
        for (const one of found) {
            const says = (field) => String(field.found(one)[0]).toLowerCase();
            if (!this.only.every(([field, text]) => says(field) === text)) continue;
            if (this.without.some(([field, text]) => says(field).includes(text))) continue;
            const text = this.#text(this.text.found(one)[0], one, odd);
            const start = this.start ? this.#time(this.start, one, root, odd) ?? 0 : moment; // protobuf leaves zeros out
            const length = this.length && this.#time(this.length, one, root, odd);
            const told = this.end && this.#time(this.end, one, root, odd);
            if (text === null || [start, length, told].some(Number.isNaN)) continue;
            const end = length === null ? told : start + length;
            if (!this.start && end !== null) moment = end;
            const [from, to] = this.pieces.map((field) => field.found(one)[0]);
            const last = rows[rows.length - 1];
            if (last && from !== undefined && from === behind && adjoin(last.text, text)) {
                Object.assign(last, { text: last.text + text, end });
            } else {
                rows.push({ text, start, end, item: one });
            }
            behind = to;
        }
        return rows;
    }

    /** Of an object, lists of the same length. */
    #rows(one, odd) {
        const value = this.text.found(one)[0];
        const texts = typeof value === "string" ? ["", ...value, ""] : listed(value);
        const lists = {};
        const divisors = {};
        for (const name of ["start", "span", "length", "end"]) {
            const field = this[name];
            const skipped = !field || (name === "end" && lists.length);
            const [list, i] = skipped ? [undefined, 0] : field.found(one);
            lists[name] = list === undefined ? null : listed(list);
            divisors[name] = field ? field.divisor(i, one, one) : 1;
            if (list !== undefined && !lists[name]) {
                odd.add(one, () => `'${field.name}' is ${told(list)}, not a list`);
                return [];
            }
        }
        if (!texts || !(lists.span || lists.length || lists.end)) {
            const missing = texts ? this.span ?? this.end ?? this.length : this.text;
            odd.add(one, () => `no field '${missing.name}'`);
            return [];
        }
        if (lists.span) {
            const pairs = lists.span.map((pair) => listed(pair) ?? []);
            [lists.start, lists.end] = [0, 1].map((k) => pairs.map((pair) => (pair.length === 2 ? pair[k] : null)));
            divisors.start = divisors.end = divisors.span;
        }
        const { start: starts, length: lengths, end: ends } = lists;
        const counts = new Set([texts, starts, lengths, ends].filter(Boolean).map(({ length }) => length));
        if (counts.size > 1 || (!starts && this.start)) {
            odd.add(one, () => `'${this.text.name}' and their times are not of one length`);
            return [];
        }
        const rows = [];
        let moment = 0;
        texts.forEach((item, i) => {
            const text = this.#text(item, one, odd);
            const start = starts ? number(starts[i], divisors.start) : moment;
            const length = lengths && number(lengths[i], divisors.length);
            const end = start !== null && length !== null ? start + length : ends && number(ends[i], divisors.end);
            if (start === null || end === null) {
                const wrong = (start === null ? starts : lengths ?? ends)[i];
                odd.add(one, () => `a time of '${this.text.name}' is ${told(wrong)}, not a number from 0 on`);
                return;
            }
            moment = end;
            if (text !== null) rows.push({ text, start, end, item: one });
        });
        return rows;
    }

    #text(given, place, odd) {
        let value = given;
        if (VISEMES[this.kind]) {
            if (typeof value === "number" || typeof value === "boolean") value = String(value);
            if (typeof value === "string" && Object.hasOwn(VISEMES[this.kind], value)) return value;
            odd.add(place, () => `no viseme is called ${told(value)}`);
            return null;
        }
        if (typeof value !== "string") {
            odd.add(place, () => `'${this.text.name}' is ${told(value)}, not text`);
            return null;
        }
        return this.kind === "phonemes" ? withoutDigits(strip(value)) : value;
    }

    /** A field of an object in seconds; null where it may be missing and is, NaN where it makes no sense. */
    #time(field, one, root, odd) {
        const [value, i] = field.found(one);
        if (field.optional && (value === undefined || value === null)) return null;
        const divisor = field.divisor(i, one, root);
        if (value === undefined || !divisor) {
            odd.add(one, () => `no field '${divisor ? field.name : field.options[i].name}'`);
            return NaN;
        }
        const found = number(value, divisor);
        if (found !== null) return found;
        odd.add(one, () => `'${field.name}' is ${told(value)}, not a number from 0 on`);
        return NaN;
    }

    #believed({ text, start, end, item }, odd) {
        const latest = Math.max(start, end ?? 0);
        if (latest > LONGEST) {
            odd.add(item, () => `${latest} s is more than a day; are these seconds?`);
        } else if (end !== null && end < start && this.kind !== "characters") {
            odd.add(item, () => `${shown(text)} ends at ${end} s, before its start ${start} s`);
        } else if (end !== null && end - start > LONGEST_ITEM) {
            odd.add(item, () => `${shown(text)} lasts ${end - start} s, more than an hour`);
        } else {
            return true;
        }
        return false;
    }
}

function adjoin(before, after) {
    return /[\p{L}\p{N}]$/u.test(before.slice(-2)) && /^[\p{L}\p{N}]/u.test(after);
}

/** A text without the digits at its end. */
function withoutDigits(text) {
    let length = text.length;
    while (length && text[length - 1] >= "0" && text[length - 1] <= "9") length--;
    return text.slice(0, length);
}

/** What Python's str.isspace() says of. */
const BLANK = /[\s\x1c-\x1f\x85]/;

/** A text without the blanks around it. */
function strip(text) {
    let [first, last] = [0, text.length]; // a regular expression would be quadratic
    while (first < last && BLANK.test(text[first])) first++;
    while (first < last && BLANK.test(text[last - 1])) last--;
    return text.slice(first, last);
}

/** A service of the table. */
class Service {
    #marks;
    #utterance;
    #tells;

    constructor(row) {
        this.title = row.title;
        this.advice = row.advice ?? "";
        this.times = row.times ?? "";
        this.#marks = (row.is ?? []).map((fields) => fields.map((name) => new Field(name)));
        this.#utterance = row.utterance ? new Field(row.utterance) : null;
        this.#tells = row.tells.map((tell) => new Tell(tell));
        /** Whether its messages are nothing but timings: others may have fields of the same names. */
        this.bare = this.#tells.every(({ places }) => places.length === 1 && !places[0].length);
        this.begins = this.#marks.flatMap(([first]) => first.options.map(({ steps }) => plain(steps[0].name)));
    }

    /** Whether an object is one of this service. */
    told(item) {
        return this.#marks.some((fields) => fields.every((field) => field.found(item)[0] !== undefined));
    }

    /** What identifies the utterance of a message, if anything does. */
    utterance(item) {
        const value = this.#utterance?.found(item)[0];
        return typeof value === "string" || Number.isInteger(value) ? String(value) : null;
    }

    /** What a message tells: { kind, items, key }; those of which it tells nothing only where they replace others. */
    read(item, odd) {
        const found = [];
        for (const tell of this.#tells) {
            const items = tell.read(item, odd);
            const key = tell.key ? number(tell.key.found(item)[0], 1) ?? undefined : undefined;
            if (items.length || (key !== undefined && tell.listed(item))) found.push({ kind: tell.kind, items, key });
        }
        return found;
    }
}

/** Every service by its name, in the order of detection. */
export const SERVICES = {};
for (const [name, row] of Object.entries(table.services)) SERVICES[name] = new Service(row);
const NAMES = Object.keys(SERVICES);
/** By the first name of a rule, the services that it may tell. */
const BEGINS = new Map();
for (const name of NAMES) for (const first of SERVICES[name].begins) BEGINS.set(first, [...(BEGINS.get(first) ?? []), name]);

/** The name of the service that an object is of, or undefined. */
export function serviceOf(item) {
    const found = new Set();
    for (const first of item.plain.keys()) for (const name of BEGINS.get(first) ?? []) found.add(name);
    return NAMES.find((name) => found.has(name) && SERVICES[name].told(item));
}

// ---- Segments

/** Segments of sounds, labels or phonemes; short gaps belong to the phoneme before. */
export function phonemeSegments(items, kind) {
    const labels = kind === "labels" ? {} : { labels: "ipa" };
    const segments = items.map(({ text, start, end, item }) => {
        return { start, end: end ?? start, label: text, ...labels, line: item.line };
    });
    if (kind === "sounds") return phonemesOf(segments);
    if (kind === "phonemes") {
        segments.forEach((segment, i) => {
            const after = i + 1 < items.length ? items[i + 1].start : -1;
            if (segment.end < after && after <= segment.end + LONGEST_GAP) segment.end = after;
        });
    }
    return segments;
}

/** Phonemes, in the IPA, of characters that follow each other; "" is silence, and so is every gap. */
function phonemesOf(tokens) {
    const result = [];
    let begin = null; // of the stress mark before the next phoneme
    let joins = false; // the next character may be the second half of the phoneme before it
    for (const { start, end, label, line } of tokens) {
        const last = result[result.length - 1];
        const voiced = last && last.label ? last : null;
        const free = voiced && begin === null;
        const pair = free && joins && table.pairs.includes(voiced.label + label) && start <= voiced.end;
        if (label === "ˈ" || label === "ˌ") {
            begin = begin === null ? start : begin;
        } else if ((free && /^[\p{Lm}\p{Mn}\p{Sk}\p{Nd}]+$/u.test(label)) || pair) {
            if (voiced.label.length < 64) voiced.label += label;
            voiced.end = end;
        } else if (voiced && /^\s+$/u.test(label) && end - start <= LONGEST_GAP) {
            voiced.end = end;
            joins = false;
        } else if (/^[\p{P}\p{S}\p{Z}\p{C}]*$/u.test(label)) {
            if (last && !voiced) last.end = end;
            else result.push({ start, end, label: "", line });
            begin = null;
        } else {
            result.push({ start: begin === null ? start : begin, end, label, labels: "ipa", line });
            begin = null;
            joins = true;
        }
    }
    return result;
}

/** Segments of visemes, or of pairs of them, of which only the beginnings are told. */
function shapes(marks, kind) {
    const phonemes = VISEMES[kind];
    const found = [];
    for (let at = 0; at < marks.length; at++) {
        const { text, start, item } = marks[at];
        const pair = phonemes[`${text} ${marks[at + 1]?.text}`];
        if (pair) at++;
        const end = marks[at + 1]?.start ?? marks[at].start + LAST_VISEME;
        found.push({ start, end, label: pair || phonemes[text], labels: "arpabet", line: item.line });
    }
    const sounds = found.map(({ label }) => label);
    found.forEach((segment, i) => {
        if (sounds[i] === "UW" && VOWELS.has(sounds[i + 1]) && sounds[i + 1] !== "UW") segment.label = "W";
    });
    return found;
}

/** `segments`, or an error where times are late, turned round or overlap, or where there are none. */
function checked(segments) {
    if (!segments.length) throw new LabialError("no segments");
    let previous = -Infinity;
    return segments.map(({ line, ...segment }, i) => {
        const { start, end } = segment;
        const where = line ? `line ${line}` : `interval ${i + 1}`;
        const complain = (problem) => new LabialError(`${where}: ${problem}`);
        if (Math.min(start, end) < 0) throw complain(`${start} s is before the beginning, 0`);
        if (!(Math.max(start, end) <= LONGEST)) {
            throw complain(`${end} s is more than a day; are these seconds?`);
        }
        if (end < start) throw complain(`the segment ends at ${end} s, before its start ${start} s`);
        if (start < previous - ROUNDING) {
            throw complain(`the segment starts at ${start} s, before the end of the one before, ${previous} s`);
        }
        previous = Math.max(previous, end);
        return segment;
    });
}
