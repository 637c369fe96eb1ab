// Timings of any service, told by their content: segments for render(), or what a single message tells. The readers of
// phonemes and visemes are those of the package labial.
import { even, strip, wordsOfCharacters } from "./characters.js";
import { LATEST } from "./lexicon.js";
import { BOUNDARIES, Joint, SERVICES, WORD_MARKS, collect, isBoundary, pieced } from "./services.js";
import { segmentsOf } from "./stream.js";

/** A gap between phonemes, in seconds, is silence if it is longer. */
const LONGEST_GAP = 0.15;
const KINDS = ["phonemes", "words", "characters"];

/** Every format of JSON by its name, in the order of detection: `told` says whether an entry is the first of one,
 * `read` makes segments of all entries, `source` being what they are from; `message` reads one of them, where words are
 * told. */
export function formatsOf(lexicon) {
    const { timings } = lexicon.tools;
    const wordsOf = (service) => (entries, source, options) => fromTold(lexicon, collect(service, entries), options);
    const formats = {
        kokoro: { told: (first) => first.has("preddur"), read: (entries, source) => timings.fromKokoro(source) },
        headtts: { told: isHeadTTS, read: (entries, source) => timings.fromHeadTTS(source) },
        azure: {
            ...BOUNDARIES,
            told: (first) => first.has("visemeid") || first.has("privvisemeid") || isBoundary(first),
            read: (entries, source, options) => entries.every(isBoundary)
                ? wordsOf(BOUNDARIES)(entries, source, options) : timings.fromAzure(source),
        },
        polly: {
            ...WORD_MARKS,
            told: (first) => first.has("type", "time", "value"),
            read: (entries, source, options) => entries.some((item) => item.get("type") === "viseme")
                ? timings.fromPolly(source) : wordsOf(WORD_MARKS)(entries, source, options),
        },
    };
    for (const [name, service] of Object.entries(SERVICES)) formats[name] = { ...service, read: wordsOf(service) };
    formats.piper = { told: isPiper, read: (entries, source) => timings.fromPiper(source) };
    formats.json = {
        told: isPlain,
        read: (entries) => timings.checked(entries.map((item) => {
            const [start, end] = [item.number("start"), item.number("end")];
            return { start, end, label: item.text("phoneme"), line: item.line };
        })),
    };
    return formats;
}

/** The segments of a source in a format, or in the one that its content tells. */
export function readTimings(lexicon, formats, source, { format = "auto", own, numbers, offset = 0 } = {}) {
    const { labial, tools: { LabialError, timings } } = lexicon;
    const moved = lexicon.offset(offset) / 1000;
    const isText = typeof source === "string" && !/^\uFEFF?[ \t\r\n]*[{[]/.test(source);
    let segments;
    if (labial.formats.includes(format) && (format !== "auto" || isText)) {
        segments = labial.read(source, { format });
    } else {
        const entries = timings.entriesOf(source);
        const name = format === "auto" ? entries.length && formatOf(formats, entries[0]) : format;
        if (!name) throw new LabialError(`no known format of phoneme timings: ${Object.keys(formats).join(", ")}`);
        segments = known(lexicon, formats, name).read(entries, source, { own, numbers });
    }
    if (!moved) return segments;
    return segments.filter(({ end }) => end + moved > 0)
        .map((one) => ({ ...one, start: Math.max(0, one.start + moved), end: one.end + moved }));
}

/** Reads messages one by one, as they arrive. */
export class MessageReader {
    #formats;
    #entriesOf;
    #format;
    #count = 0;
    #joints = KINDS.map(() => new Joint());

    constructor(lexicon, formats, { format = "auto" } = {}) {
        if (format !== "auto") known(lexicon, formats, format);
        this.#formats = formats;
        this.#entriesOf = lexicon.tools.timings.entriesOf;
        this.#format = format;
    }

    get format() {
        return this.#format;
    }

    read(source) {
        const found = { phonemes: [], words: [], characters: [] };
        for (const item of this.#entriesOf(source)) {
            if (this.#format === "auto") this.#format = formatOf(this.#formats, item) ?? "auto";
            const service = this.#formats[this.#format];
            if (!service?.message) continue;
            const told = service.message(item, this.#count++);
            KINDS.forEach((kind, i) => {
                const items = told[kind] ?? [];
                for (const { text, start, end } of pieced(service.joins ? this.#joints[i].add(items) : items)) {
                    found[kind].push({ text, start, end });
                }
            });
            if (told.chunk !== undefined) found.chunk = told.chunk;
        }
        return found;
    }
}

/** The name of the format that an entry is the first of, or undefined. */
export function formatOf(formats, first) {
    return Object.keys(formats).find((name) => formats[name].told(first));
}

function known({ tools: { LabialError, shown } }, formats, name) {
    if (Object.hasOwn(formats, name)) return formats[name];
    throw new LabialError(`${shown(name)} is no format of JSON: ${Object.keys(formats).join(", ")}`);
}

/** Segments of what a service tells of words, characters or phonemes. */
function fromTold(lexicon, { phonemes, characters, words }, options) {
    const { LabialError, shown, timings } = lexicon.tools;
    if (phonemes) return timings.checked(fromPhonemes(phonemes));
    const items = characters ?? words;
    if (!items.length) throw new LabialError("no words with their times");
    const starts = items.map((one) => milliseconds(one, one.start));
    const ends = items.map((one) => {
        const end = characters ? one.end || one.start : one.end;
        return end === null ? null : milliseconds(one, end);
    });
    const texts = items.map(({ text }) => text);
    const found = characters ? wordsOfCharacters(texts, starts, ends)
        : texts.map((text, i) => ({ text, start: starts[i], end: ends[i] }));
    found.forEach(({ text, start }, i) => {
        if (i && start < found[i - 1].start) {
            throw new LabialError(`${shown(text)} begins before ${shown(found[i - 1].text)}, which comes first`);
        }
    });
    return timings.checked(segmentsOf(lexicon, found, options));
}

/** Phonemes in the IPA; short gaps belong to the phoneme before. */
function fromPhonemes(items) {
    return items.map(({ text, start, end, item }, i) => {
        const after = i + 1 < items.length ? items[i + 1].start : -1;
        const until = end < after && after <= end + LONGEST_GAP ? after : end;
        return { start, end: until, label: strip(text), labels: "ipa", line: item.line };
    });
}

function milliseconds({ item }, seconds) {
    if (seconds * 1000 <= LATEST) return even(seconds * 1000);
    throw item.error(`${seconds} s is later than any time that is believed`);
}

function isHeadTTS(first) {
    const { data } = first.fields;
    return first.has("vtimes") || (typeof data === "object" && data !== null && Object.hasOwn(data, "vtimes"));
}

function isPiper(first) {
    const shapes = [["phonemealignments"], ["alignments"], ["last"], ["phoneme", "numsamples"], ["phoneme", "seconds"]];
    return shapes.some((names) => first.has(...names)) && !isPlain(first);
}

function isPlain(first) {
    return first.has("phoneme", "start", "end");
}
