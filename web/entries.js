// Objects of what a speech service tells, and the JSON that they come in, as in export/labial/corpus/entries.py.
import { LabialError, shown } from "./memory.js";

/** What is read of a message, as in export/labial/files/limits.py: levels, documents, items, characters of a text. */
export const LIMITS = { nesting: 64, documents: 10000, items: 10000, text: 1000 };
/** What is no text, as in export/labial/files/grammar.py. */
const CONTROL = /[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]/;
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
/** A name in small letters without underscores. */
export const plain = (name) => name.replaceAll("_", "").toLowerCase();

/** One object of what a service tells: `line` where a line is a document of its own, else its `place`, from 1. */
export class Entry {
    #plain = null;

    constructor(fields, line, place) {
        Object.assign(this, { fields, line, place });
        if (!isObject(fields)) throw this.error(`${told(fields)} is not an object`);
    }

    error(problem) {
        return new LabialError(`${this.line ? `line ${this.line}` : `entry ${this.place}`}: ${problem}`);
    }

    /** The fields by their names in small letters without underscores; of two that are then alike, the first. */
    get plain() {
        if (!this.#plain) {
            this.#plain = new Map();
            for (const key in this.fields) { // those of an object of a client library, too
                const name = plain(key);
                if (!this.#plain.has(name)) this.#plain.set(name, this.fields[key]);
            }
        }
        return this.#plain;
    }

    /** An object within this one; null for what is no object. */
    inner(value, place = 0) {
        return isObject(value) ? new Entry(value, this.line, place || this.place) : null;
    }
}

/** The objects of a list, a single one, or of JSON: one document, or one per line, which may be server-sent events. */
export function entriesOf(source) {
    if (typeof source === "string") return documentsOf(source).map(([item, line, place]) => new Entry(item, line, place));
    return (Array.isArray(source) ? source : [source]).map((item, i) => new Entry(item, 0, i + 1));
}

/** The documents of a text, each with its line, 0 if it has none of its own, and its number. `odd` is called for single
 * lines that are not JSON, if it is given. */
export function documentsOf(source, odd = null, most = Infinity) {
    const text = source.replace(/^\uFEFF/, "");
    linesOf(text);
    try {
        const document = parsed(text);
        return (Array.isArray(document) ? document : [document]).map((item, i) => [item, 0, i + 1]);
    } catch (error) {
        if (!(error instanceof SyntaxError)) throw error;
    }
    const lines = linesOf(text).map((line, i) => [contentOf(line), i + 1]).filter(([line]) => !/^[ \t\r]*$/.test(line));
    if (odd && !lines.length) return []; // an event without a document
    const isEvent = lines.length === 1 && lines[0][0] !== text.trim();
    if (lines.length < 2 && !isEvent) throw new LabialError("not JSON");
    if (lines.length > most) throw new LabialError(`${lines.length} lines, more than the ${most} that are read`);
    return lines.flatMap(([line, place], i) => {
        try {
            return [[parsed(line), place, place]];
        } catch (error) {
            const problem = error instanceof SyntaxError ? new LabialError(`line ${place}: not JSON`) : error;
            if (!odd || i === 0) throw problem;
            odd(problem);
            return [];
        }
    });
}

function parsed(text) {
    let found;
    try {
        found = JSON.parse(text);
    } catch (error) {
        if (error instanceof RangeError) throw new LabialError("JSON that is nested too deeply");
        throw error;
    }
    let level = [found];
    for (let i = 0; level.length; i++) {
        if (i > LIMITS.nesting) throw new LabialError("JSON that is nested too deeply");
        level = level.flatMap((one) => (typeof one === "object" && one !== null ? Object.values(one) : []));
    }
    return found;
}

/** The document of a line: what follows `data:` in a server-sent event, "" in its other fields. */
function contentOf(line) {
    const text = line.replace(/^[ \t]+/, "");
    if (text.startsWith("data:")) return text.slice(5).trim() === "[DONE]" ? "" : text.slice(5);
    return /^(event:|id:|retry:|:)/.test(text) ? "" : line;
}

/** The lines of a text, each of which ends with LF. */
function linesOf(text) {
    const lines = text.split("\n");
    lines.forEach((line, i) => {
        const strange = line.match(CONTROL);
        if (!strange) return;
        const hex = strange[0].charCodeAt(0).toString(16).padStart(2, "0");
        throw new LabialError(`line ${i + 1}: byte 0x${hex} is not text`);
    });
    return lines;
}

/** A value for a message. */
export function told(value) {
    if (typeof value === "object" && value !== null) return Array.isArray(value) ? "a list" : "an object";
    return shown(value);
}
