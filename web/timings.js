// Phonemes and their times, from JSON that voices tell: lists of { start, end, label, labels }, seconds. Each reader does
// what that of the same name in export/labial/corpus/services.py does; a test holds them to each other.
import { LONGEST, LabialError, shown } from "./memory.js";

/** A blank between words, or what a service leaves out between two phonemes, is a pause from here on, in seconds. */
const LONGEST_BLANK = 0.15;
/** Seconds that the last viseme lasts, of which only the beginning is told. */
export const LAST_VISEME = 0.1;
/** Kokoro's frames per second: 600 samples each, 24,000 samples per second. */
const KOKORO_RATE = 40;
/** Azure's ticks per second, of 100 ns. */
const TICKS = 1e7;
/** Overlaps up to this many seconds come from rounding. */
const TOLERANCE = 0.001;

/** What is no text, as in export/labial/files/grammar.py. */
const CONTROL = /[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]/;

const PAIRS = new Set("aɪ aʊ ɔɪ eɪ oʊ əʊ tʃ dʒ ɜɹ".split(" "));
/** Kokoro's letters that are not the IPA's. */
const MISAKI = { A: "eɪ", I: "aɪ", O: "oʊ", Q: "əʊ", W: "aʊ", Y: "ɔɪ", T: "ɾ", "ᵊ": "ə" };
const VOWELS = new Set("AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split(" "));
/** Azure's ids, from 0 on; what it tells in two events; Polly's symbols. */
const AZURE = table("SIL AH AA AO EH ER IH UW OW AW OY AY HH R L S SH DH F N K P".split(" ").map((p, i) => [i, p]));
const AZURE_PAIRS = { "8 4": "OW", "4 6": "EY", "19 16": "CH" };
const POLLY = table("sil SIL p P t N S SH T DH f F k K i IH r R s S l L u UW @ AH a AE e EY E EH o OW O AO B B J Y x K"
    .match(/\S+ \S+/g).map((pair) => pair.split(" ")));
/** The phoneme of each viseme, and of pairs. */
export const VISEMES = { azure: [AZURE, AZURE_PAIRS], polly: [POLLY, {}] };

function table(pairs) {
    return new Map(pairs.map(([name, phoneme]) => [String(name), phoneme]));
}

// ---- Readers --------------------------------------------------------------------------------------------------------

/** Piper's alignments: audio chunks with `sample_rate` and `phoneme_alignments` (`phoneme`, `num_samples`), or what its
 * HTTP server's /info answers. */
export function fromPiper(source) {
    let moment = 0;
    return checked(phonemesOf(piperPhonemes(entriesOf(source)).map((item) => {
        const label = item.text("phoneme");
        const start = moment;
        moment += item.number("seconds");
        return { start, end: moment, label, line: item.line };
    })));
}

/** Results of Kokoro's pipeline: `phonemes`, a string, and `pred_dur`, frames of the silence before it, of each of its
 * characters and of the silence behind it. */
export function fromKokoro(source) {
    let frames = 0;
    const tokens = [];
    for (const item of entriesOf(source)) {
        const characters = ["", ...item.text("phonemes"), ""];
        const durations = item.list("preddur").map((value) => item.asNumber(value, "pred_dur"));
        if (durations.length !== characters.length) {
            throw item.error(`${durations.length} durations for ${characters.length - 2} characters and the silence ` +
                "around them: Kokoro left out characters that it does not know");
        }
        characters.forEach((label, i) => {
            const start = frames / KOKORO_RATE;
            frames += durations[i];
            tokens.push({ start, end: frames / KOKORO_RATE, label: misaki(label), line: item.line });
        });
    }
    return checked(phonemesOf(tokens));
}

/** HeadTTS's answers: `phonemes` with `vtimes` and `vdurations`, milliseconds; each begins where the one before ends. */
export function fromHeadTTS(source) {
    const segments = [];
    let origin = 0;
    for (let item of entriesOf(source)) {
        const { data } = item.fields;
        if (!item.has("vtimes") && isObject(data)) item = new Entry(data, item.line, item.place);
        const labels = item.list("phonemes");
        const [starts, lengths] = ["vtimes", "vdurations"]
            .map((name) => item.list(name).map((value) => item.asNumber(value, name) / 1000));
        if (labels.length !== starts.length || labels.length !== lengths.length ||
            !labels.every((label) => typeof label === "string")) {
            throw item.error("'phonemes', 'vtimes' and 'vdurations' are not of one length");
        }
        labels.forEach((label, i) => {
            const after = i + 1 < starts.length ? starts[i + 1] : Infinity;
            let end = starts[i] + lengths[i];
            if (end > after || after - end <= LONGEST_BLANK) end = after;
            segments.push({ start: origin + starts[i], end: origin + end, label: misaki(label), line: item.line });
        });
        origin = segments.length ? segments[segments.length - 1].end : origin;
    }
    return checked(phonemesOf(segments));
}

/** Azure's viseme events: `viseme_id` and `audio_offset`, ticks of 100 ns, under the names of any of its libraries. */
export function fromAzure(source) {
    return fromVisemes(entriesOf(source).map((item) => {
        const id = item.get("visemeid", "privvisemeid");
        return [item.number("audiooffset", "privaudiooffset") / TICKS, String(id), item];
    }), "azure");
}

/** Amazon Polly's speech marks, of which those of type "viseme" are read. */
export function fromPolly(source) {
    const marks = entriesOf(source).filter((item) => item.get("type") === "viseme")
        .map((item) => [item.number("time") / 1000, item.text("value"), item]);
    if (!marks.length) throw new LabialError("no speech marks of type 'viseme'");
    return fromVisemes(marks, "polly");
}

// ---- Characters and visemes -----------------------------------------------------------------------------------------

/** Phonemes, in the IPA, of characters that follow each other; "" is silence, and so is every gap. */
function phonemesOf(tokens) {
    const result = [];
    let begin = null; // of the stress mark before the next phoneme
    let joins = false; // the next character may be the second half of the phoneme before it
    for (const { start, end, label, line } of tokens) {
        const last = result[result.length - 1];
        const voiced = last && last.label ? last : null;
        const free = voiced && begin === null;
        const pair = free && joins && PAIRS.has(voiced.label + label) && start <= voiced.end;
        if (label === "ˈ" || label === "ˌ") {
            begin = begin === null ? start : begin;
        } else if ((free && /^[\p{Lm}\p{Mn}\p{Sk}\p{Nd}]+$/u.test(label)) || pair) {
            voiced.label += label;
            voiced.end = end;
        } else if (voiced && /^\s+$/u.test(label) && end - start <= LONGEST_BLANK) {
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

/** Segments of visemes of which only the beginnings are told. */
function fromVisemes(marks, service) {
    const [phonemes] = VISEMES[service];
    marks.forEach(([, name, item]) => {
        if (!phonemes.has(name)) throw item.error(`no viseme is called ${shown(name)}`);
    });
    return checked(standIns(service, marks.map(([, name]) => name)).map(({ first, last, phoneme }) => {
        const end = last + 1 < marks.length ? marks[last + 1][0] : marks[last][0] + LAST_VISEME;
        return { start: marks[first][0], end, label: phoneme, labels: "arpabet", line: marks[first][2].line };
    }));
}

/** The phoneme of each viseme or pair of visemes, with the first and the last one that it stands for. */
export function standIns(service, names) {
    const [phonemes, pairs] = VISEMES[service];
    const found = [];
    for (let at = 0; at < names.length; at++) {
        const joined = at + 1 < names.length ? pairs[`${names[at]} ${names[at + 1]}`] : undefined;
        found.push({ first: at, last: joined ? at + 1 : at, phoneme: joined || phonemes.get(names[at]) });
        if (joined) at++;
    }
    const told = found.map(({ phoneme }) => phoneme);
    found.forEach((item, i) => {
        if (told[i] === "UW" && VOWELS.has(told[i + 1]) && told[i + 1] !== "UW") item.phoneme = "W";
    });
    return found;
}

function misaki(label) {
    return Object.hasOwn(MISAKI, label) ? MISAKI[label] : label;
}

/** Objects of `phoneme` and `seconds` from any of Piper's shapes. */
function piperPhonemes(entries) {
    return entries.flatMap((outer) => {
        let item = outer;
        if (item.has("last")) {
            const last = item.get("last");
            if (!isObject(last)) throw item.error("the server has not spoken yet: ask for /info after /synthesize");
            item = new Entry(last, item.line, item.place);
        }
        if (item.has("phonemealignments")) {
            if (item.get("phonemealignments") === null) {
                throw item.error("the voice told no alignments: load it with include_alignments=True");
            }
            const rate = item.number("samplerate");
            if (rate < 1) throw item.error(`'sample_rate' is ${rate}`);
            return item.parts("phonemealignments").map((part) => new Entry(
                { phoneme: part.get("phoneme"), seconds: part.number("numsamples") / rate }, part.line, part.place));
        }
        if (item.has("alignments")) return item.parts("alignments");
        if (item.has("phoneme", "numsamples")) {
            throw item.error("samples without a rate: keep the chunk's sample_rate beside its phoneme_alignments");
        }
        return [item];
    });
}

// ---- Entries, which the package labial-words takes as well ----------------------------------------------------------

/** One object of what a service tells: `line` where a line is a document of its own, else its `place`, from 1. */
export class Entry {
    constructor(fields, line, place) {
        Object.assign(this, { fields, line, place });
        if (!isObject(fields)) throw this.error(`${told(fields)} is not an object`);
    }

    error(problem) {
        return new LabialError(`${this.line ? `line ${this.line}` : `entry ${this.place}`}: ${problem}`);
    }

    /** The first field that there is of `names`, whatever the case and the underscores of the keys. */
    get(...names) {
        const key = Object.keys(this.fields).find((one) => names.includes(plain(one)));
        if (key === undefined) throw this.error(`no field '${names[0]}'`);
        return this.fields[key];
    }

    has(...names) {
        const keys = Object.keys(this.fields).map(plain);
        return names.every((name) => keys.includes(name));
    }

    number(...names) {
        return this.asNumber(this.get(...names), names[0]);
    }

    asNumber(value, what) {
        if (typeof value === "number" && value >= 0 && value < Infinity) return value;
        throw this.error(`'${what}' is ${told(value)}, not a number from 0 on`);
    }

    text(...names) {
        const value = this.get(...names);
        if (typeof value !== "string") throw this.error(`'${names[0]}' is ${told(value)}, not text`);
        return value;
    }

    list(...names) {
        const value = this.get(...names);
        if (!Array.isArray(value)) throw this.error(`'${names[0]}' is ${told(value)}, not a list`);
        return value;
    }

    parts(name) {
        return this.list(name).map((item, i) => new Entry(item, this.line, i + 1));
    }
}

/** The objects of a list, a single one, or of JSON: one document, or one per line. */
export function entriesOf(source) {
    if (typeof source !== "string") return (Array.isArray(source) ? source : [source]).map(entry);
    const text = source.replace(/^\uFEFF/, "");
    linesOf(text);
    try {
        const document = JSON.parse(text);
        return (Array.isArray(document) ? document : [document]).map(entry);
    } catch (error) {
        if (!(error instanceof SyntaxError)) throw error;
    }
    const lines = linesOf(text).map((line, i) => [i + 1, line]).filter(([, line]) => !/^[ \t\r]*$/.test(line));
    return lines.map(([number, line]) => {
        try {
            return new Entry(JSON.parse(line), number, number);
        } catch (error) {
            throw error instanceof SyntaxError ? new LabialError(`line ${number}: not JSON`) : error;
        }
    });
}

/** The lines of a text, each of which ends with LF. */
function linesOf(text) {
    const lines = text.replace(/^\uFEFF/, "").split("\n");
    lines.forEach((line, i) => {
        const strange = line.match(CONTROL);
        if (strange) throw new LabialError(`line ${i + 1}: byte 0x${hex(strange[0])} is not text`);
    });
    return lines;
}

function hex(character) {
    return character.charCodeAt(0).toString(16).padStart(2, "0");
}

function entry(fields, i) {
    return new Entry(fields, 0, i + 1);
}

/** `segments`, or an error where times are late, turned round or overlap, or where there are none. */
export function checked(segments) {
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
        if (start < previous - TOLERANCE) {
            throw complain(`the segment starts at ${start} s, before the end of the one before, ${previous} s`);
        }
        previous = Math.max(previous, end);
        return segment;
    });
}

function isObject(value) {
    return typeof value === "object" && value !== null && !Array.isArray(value);
}

function plain(key) {
    return key.replaceAll("_", "").toLowerCase();
}

function told(value) {
    return typeof value === "object" ? shown(JSON.stringify(value)) : shown(value);
}
