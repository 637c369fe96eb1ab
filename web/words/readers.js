// Timings of any service, told by their content: segments for render(), or what a single message tells. The package
// labial reads the messages; here words and characters become phonemes.
import { even, wordsOfCharacters } from "./characters.js";
import { segmentsOf } from "./stream.js";

/** The segments of a source in a format, or in the one that its content tells. */
export function readTimings(lexicon, source, { format = "auto", own, numbers, offset = 0 } = {}) {
    const { labial, tools: { LabialError, timings } } = lexicon;
    const moved = lexicon.offset(offset) / 1000;
    const isText = typeof source === "string" && !/^\uFEFF?[ \t\r\n]*[{[]/.test(source);
    let segments;
    if (labial.formats.includes(format) && (format !== "auto" || isText)) {
        segments = labial.read(source, { format });
    } else {
        const entries = timings.entriesOf(source);
        const name = format === "auto" ? entries.slice(0, 100).map(timings.serviceOf).find(Boolean) : format;
        if (!name) throw new LabialError(`no known format of phoneme timings: ${Object.keys(timings.SERVICES).join(", ")}`);
        const spoken = (items, kind) => fromWords(lexicon, items, kind, { own, numbers });
        segments = timings.segmentsOf(known(lexicon, name), entries, spoken);
    }
    if (!moved) return segments;
    const left = segments.filter(({ end }) => end + moved > 0);
    if (!left.length) throw new LabialError(`an offset of ${1000 * moved} ms leaves no segments`);
    return left.map((one) => ({ ...one, start: Math.max(0, one.start + moved), end: one.end + moved }));
}

/** Reads messages one by one, as they arrive. */
export class MessageReader {
    #timings;
    #format;
    #joints;

    constructor(lexicon, { format = "auto" } = {}) {
        if (format !== "auto") known(lexicon, format);
        this.#timings = lexicon.tools.timings;
        this.#format = format;
    }

    get format() { return this.#format; }

    read(source) {
        const { Joint, Odd, SERVICES, entriesOf, serviceOf } = this.#timings;
        const found = { phonemes: [], words: [], characters: [] };
        for (const item of entriesOf(source)) {
            if (this.#format === "auto") this.#format = serviceOf(item) ?? "auto";
            const service = SERVICES[this.#format];
            if (!service) continue;
            this.#joints ??= Object.fromEntries(Object.keys(found).map((kind) => [kind, new Joint(service.times)]));
            for (const { kind, items, key } of service.read(item, new Odd(true))) {
                if (!Object.hasOwn(found, kind)) continue;
                const all = key === undefined ? this.#joints[kind].add(items, service.utterance(item)) : items;
                for (const { text, start, end } of all) found[kind].push({ text, start, end });
                if (key !== undefined) found.chunk = key;
            }
        }
        return found;
    }
}

function known({ tools: { LabialError, shown, timings: { SERVICES } } }, name) {
    if (Object.hasOwn(SERVICES, name)) return name;
    throw new LabialError(`${shown(name)} is no format of JSON: ${Object.keys(SERVICES).join(", ")}`);
}

/** Segments of words or characters. */
function fromWords(lexicon, items, kind, options) {
    const { LabialError, shown } = lexicon.tools;
    const milliseconds = (seconds) => even(seconds * 1000);
    const starts = items.map(({ start }) => milliseconds(start));
    const ends = items.map(({ start, end }) => {
        const until = kind === "characters" ? end || start : end;
        return until === null ? null : milliseconds(until);
    });
    const texts = items.map(({ text }) => text);
    const words = kind === "characters" ? wordsOfCharacters(texts, starts, ends)
        : texts.map((text, i) => ({ text, start: starts[i], end: ends[i] }));
    words.forEach(({ text, start }, i) => {
        if (i && start < words[i - 1].start) {
            throw new LabialError(`${shown(text)} begins before ${shown(words[i - 1].text)}, which comes first`);
        }
    });
    return segmentsOf(lexicon, words, options);
}
