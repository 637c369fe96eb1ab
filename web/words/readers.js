// Timings of any service, told by their content: segments for render(), or what a single message tells. The readers of
// phonemes and visemes are those of the package labial.
import { even, strip, wordsOfCharacters } from "./characters.js";
import { BOUNDARIES, Joint, SERVICES, WORD_MARKS, collect, isBoundary, pieced } from "./services.js";

/** A gap between phonemes, in seconds, is silence if it is longer. */
const LONGEST_GAP = 0.15;
/** Latest time, milliseconds: the library counts in 32 bits. */
const LATEST = 2 ** 32 - 2;

/** What reads with `words`, for `labial`. */
export function readers(tools, labial, words) {
    const { LabialError, shown, timings } = tools;

    /** Segments of phonemes in the IPA; short gaps belong to the phoneme before. */
    function fromPhonemes(items) {
        return timings.checked(items.map(({ text, start, end, item }, i) => {
            const after = i + 1 < items.length ? items[i + 1].start : -1;
            const until = end < after && after <= end + LONGEST_GAP ? after : end;
            return { start, end: until, label: strip(text), labels: "ipa", line: item.line };
        }));
    }

    function milliseconds({ item }, seconds) {
        if (seconds * 1000 <= LATEST) return even(seconds * 1000);
        throw item.error(`${seconds} s is later than any time that is believed`);
    }

    /** Segments of what a service tells of words, characters or phonemes. */
    function fromTold({ phonemes, characters, ...told }, options) {
        if (phonemes) return fromPhonemes(phonemes);
        const items = characters ?? told.words;
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
        return timings.checked(words.timed(found, options));
    }

    /** Every format by its name, in the order of detection: `told` says whether an entry is the first of one, `read`
     * makes segments of all entries; `source` is what they are from. */
    const formats = {
        kokoro: { told: (first) => first.has("preddur"), read: (entries, source) => timings.fromKokoro(source) },
        headtts: { told: isHeadTTS, read: (entries, source) => timings.fromHeadTTS(source) },
        azure: {
            message: BOUNDARIES.message,
            told: (first) => first.has("visemeid") || first.has("privvisemeid") || isBoundary(first),
            read: (entries, source, options) => entries.every(isBoundary)
                ? fromTold(collect(BOUNDARIES, entries), options) : timings.fromAzure(source),
        },
        polly: {
            message: WORD_MARKS.message,
            told: (first) => first.has("type", "time", "value"),
            read: (entries, source, options) => entries.some((item) => item.get("type") === "viseme")
                ? timings.fromPolly(source) : fromTold(collect(WORD_MARKS, entries), options),
        },
    };
    for (const [name, service] of Object.entries(SERVICES)) {
        formats[name] = { ...service, read: (entries, source, options) => fromTold(collect(service, entries), options) };
    }
    formats.piper = { told: isPiper, read: (entries, source) => timings.fromPiper(source) };
    formats.json = {
        told: isPlain,
        read: (entries) => timings.checked(entries.map((item) => {
            const [start, end] = [item.number("start"), item.number("end")];
            return { start, end, label: item.text("phoneme"), line: item.line };
        })),
    };

    /** The name of a format that an entry is the first of, or undefined. */
    const formatOf = (first) => Object.keys(formats).find((name) => first && formats[name].told(first));

    function known(format) {
        if (Object.hasOwn(formats, format)) return formats[format];
        throw new LabialError(`${shown(format)} is no format of timings: ${names.join(", ")}`);
    }

    const names = Object.freeze([...labial.formats, ...Object.keys(formats)]);

    /** Reads messages one by one, as they arrive: what each tells, lists of { text, start, end }, seconds from the
     * beginning of the sound; of a `chunk` (Fish Audio's) the latest message counts. */
    class Reader {
        #format;
        #count = 0;
        #joints = { phonemes: new Joint(), words: new Joint(), characters: new Joint() };

        constructor({ format = "auto" } = {}) {
            if (format !== "auto") known(format);
            this.#format = format;
        }

        get format() {
            return this.#format;
        }

        read(source) {
            const found = { phonemes: [], words: [], characters: [] };
            for (const item of timings.entriesOf(source)) {
                if (this.#format === "auto") this.#format = formatOf(item) ?? "auto";
                const service = formats[this.#format];
                if (!service?.message) continue;
                const told = service.message(item, this.#count++);
                for (const kind of Object.keys(this.#joints)) {
                    const items = told[kind] ?? [];
                    const placed = service.joins ? this.#joints[kind].add(items) : items;
                    for (const { text, start, end } of pieced(placed)) found[kind].push({ text, start, end });
                }
                if (told.chunk !== undefined) found.chunk = told.chunk;
            }
            return found;
        }
    }

    return {
        formats: names,
        reader: (options) => new Reader(options),

        read(source, { format = "auto", own, numbers, offset = 0 } = {}) {
            const moved = words.offset(offset) / 1000;
            const isText = typeof source === "string" && !/^\uFEFF?[ \t\r\n]*[{[]/.test(source);
            let segments;
            if (labial.formats.includes(format) && (format !== "auto" || isText)) {
                segments = labial.read(source, { format });
            } else {
                const entries = timings.entriesOf(source);
                const name = format === "auto" ? formatOf(entries[0]) : format;
                if (!name) throw new LabialError(`no known format of phoneme timings: ${names.join(", ")}`);
                segments = known(name).read(entries, source, { own, numbers });
            }
            if (!moved) return segments;
            return segments.filter(({ end }) => end + moved > 0)
                .map((one) => ({ ...one, start: Math.max(0, one.start + moved), end: one.end + moved }));
        },
    };
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
