// What speech services tell of words, of written characters and of phonemes in their messages. Each reader takes one
// message and does what that of the same name in export/labial/corpus/word_services.py does; a test holds them to each
// other.

/** Azure's and Edge's ticks per second. */
const TICKS = 1e7;
/** Names of the same three lists in messages about characters: of texts, beginnings, and ends or durations. */
const CHARACTERS = ["characters", "chars"];
const STARTS = ["characterstarttimesseconds", "characterstarttimeseconds", "characterstarttimesms", "charstarttimesms",
    "starttimesseconds", "starttimesms", "starttimes", "starts", "start"];
const ENDS = ["characterendtimesseconds", "characterendtimeseconds", "characterendtimesms", "charendtimesms",
    "endtimesseconds", "endtimesms", "endtimes", "ends", "end"];
const DURATIONS = ["charsdurationsms", "chardurationsms", "characterdurationsms", "durationsms"];

// ---- Readers of one message: lists of { text, start, end }, seconds, as `words`, `characters` or `phonemes`; an end
// that is not told is null

function ofWords(item) {
    return { words: [word(item)] };
}

function ofBoundaries(item) {
    const type = Object.hasOwn(item.fields, "type") ? plainly(item.fields.type) : "";
    if (!isBoundary(item) || (type + kindOf(item)).includes("sentence")) return {};
    const start = item.number("audiooffset", "privaudiooffset", "offset") / TICKS;
    const has = item.has("duration") || item.has("privduration");
    const length = has ? item.number("duration", "privduration") / TICKS : null;
    return { words: [timed(item.text("text", "privtext"), start, has ? start + length : null, item)] };
}

function ofWordMarks(item) {
    if (item.get("type") !== "word") return {};
    return { words: [timed(item.text("value"), item.number("time") / 1000, null, item)] };
}

function ofGoogle(item) {
    const marks = item.has("timepoints") ? item.parts("timepoints") : [item];
    return { words: marks.map((mark) => timed(mark.text("markname"), mark.number("timeseconds"), null, mark)) };
}

function ofKokoroFastAPI(item) {
    return isTold(item, "timestamps") ? { words: item.parts("timestamps").map(word) } : {};
}

function ofCartesia(item) {
    const list = (name, text) => isTold(item, name) ? lists(inner(item, name), [text], ["start"], ["end"]) : [];
    return { phonemes: list("phonemetimestamps", "phonemes"), words: list("wordtimestamps", "words") };
}

function ofHume(item) {
    const found = { phoneme: [], word: [] };
    for (const stamp of humeStamps(item)) {
        const time = inner(stamp, "time");
        const kind = stamp.text("type");
        if (!Object.hasOwn(found, kind)) continue;
        found[kind].push(timed(stamp.text("text"), time.number("begin") / 1000, time.number("end") / 1000, stamp));
    }
    return { phonemes: found.phoneme, words: found.word };
}

function ofInworld(message) {
    const item = message.has("result") ? inner(message, "result") : message;
    const found = {};
    if (!isTold(item, "timestampinfo")) return found;
    const info = inner(item, "timestampinfo");
    if (info.has("wordalignment") && isFilled(info.get("wordalignment"))) {
        const alignment = inner(info, "wordalignment");
        found.words = lists(alignment, ["words"], ["wordstarttimeseconds"], ["wordendtimeseconds"]);
        const details = alignment.has("phoneticdetails") ? alignment.parts("phoneticdetails") : [];
        found.phonemes = details.flatMap((detail) => detail.parts("phones").map(phone));
    }
    if (info.has("characteralignment") && isFilled(info.get("characteralignment"))) {
        found.characters = lists(inner(info, "characteralignment"), CHARACTERS, STARTS, ENDS);
    }
    return found;
}

/** Of each `chunk` the latest event counts. */
function ofFish(item, number) {
    if (!isTold(item, "alignment")) return {};
    const origin = item.has("chunkaudiooffsetsec") ? item.number("chunkaudiooffsetsec") : 0;
    const chunk = item.has("chunkseq") ? item.number("chunkseq") : number;
    return { words: inner(item, "alignment").parts("segments").map((part) => later(word(part), origin)), chunk };
}

/** Words in pieces; `from` and `to` are their places in the text. */
function ofMiniMax(item) {
    if (item.get("timestampedwords") === null) throw item.error("subtitles of sentences: ask for subtitle_type word");
    return {
        words: item.parts("timestampedwords").map((part) => ({
            ...timed(part.text("word"), part.number("timebegin") / 1000, part.number("timeend") / 1000, part),
            from: part.has("wordbegin") ? part.number("wordbegin") : -1,
            to: part.has("wordend") ? part.number("wordend") : -2,
        })),
    };
}

function ofElevenLabs(item) {
    const found = first(item, "normalizedalignment", "alignment");
    return found ? { characters: lists(found, CHARACTERS, STARTS, ENDS, DURATIONS) } : {};
}

/** The lists may stand in `timestamps`, `alignment` or the message itself. */
function ofSoniox(item) {
    const holder = first(item, "timestamps", "alignment", "charactertimestamps") ?? item;
    const has = CHARACTERS.some((name) => holder.has(name));
    return has ? { characters: lists(holder, CHARACTERS, STARTS, ENDS, DURATIONS) } : {};
}

// ---- How a first object tells the service

/** Whether this is a word boundary of Azure's or of edge-tts. */
export function isBoundary(item) {
    const offset = item.has("audiooffset") || item.has("privaudiooffset") || item.has("offset", "duration");
    return offset && (item.has("text") || item.has("privtext"));
}

function isElevenLabs(item) {
    const holder = first(item, "normalizedalignment", "alignment");
    return item.has("normalizedalignment") || (holder !== undefined && CHARACTERS.some((name) => holder.has(name)));
}

function isFish(item) {
    return item.has("chunkseq") || (first(item, "alignment")?.has("segments") ?? false);
}

function isKokoroFastAPI({ fields }) {
    const stamps = Object.hasOwn(fields, "timestamps") ? fields.timestamps : null;
    return Array.isArray(stamps) && isObject(stamps[0]) && Object.hasOwn(stamps[0], "word");
}

function isInworld(item) {
    return [item, first(item, "result")].some((one) => one?.has("timestampinfo"));
}

function isWords(item) {
    return ["word", "text"].some((text) => item.has(text, "start", "end") || item.has(text, "starttime", "endtime"));
}

/** The services that tell words or characters: how one message is read, whether its times are those of its own sound
 * where it begins before the end of the one before it, and how the first message is told from those of others. In the
 * order of detection. */
export const SERVICES = {
    elevenlabs: { message: ofElevenLabs, joins: true, told: isElevenLabs },
    cartesia: {
        message: ofCartesia,
        told: (item) => item.has("wordtimestamps") || item.has("phonemetimestamps") || item.has("type", "contextid"),
    },
    inworld: { message: ofInworld, joins: true, told: isInworld },
    hume: { message: ofHume, told: (item) => item.has("snippetid") || item.has("generations") },
    fish: { message: ofFish, told: isFish },
    minimax: { message: ofMiniMax, told: (item) => item.has("timestampedwords") },
    "kokoro-fastapi": {
        message: ofKokoroFastAPI, joins: true,
        told: (item) => item.has("audioformat", "timestamps") || isKokoroFastAPI(item),
    },
    soniox: { message: ofSoniox, joins: true, told: (item) => item.has("streamid") },
    google: { message: ofGoogle, told: (item) => item.has("timepoints") || item.has("markname", "timeseconds") },
    words: { message: ofWords, told: isWords },
};

/** Those that tell visemes as well. */
export const BOUNDARIES = { message: ofBoundaries };
export const WORD_MARKS = { message: ofWordMarks };

// ---- Several messages

/** Puts messages one after the other: one that begins before the end of the one before it begins there. */
export class Joint {
    #end = 0;

    add(message) {
        if (!message.length) return message;
        const origin = message[0].start < this.#end - 1e-3 ? this.#end : 0;
        const found = message.map((item) => later(item, origin));
        this.#end = found.reduce((end, item) => Math.max(end, item.end || item.start), this.#end);
        return found;
    }
}

/** What all messages of a service tell, as one of `phonemes`, `words` and `characters`: the first that there is. */
export function collect({ message, joins }, entries) {
    let told = entries.map(message);
    if (told.some(({ chunk }) => chunk !== undefined)) {
        const chunks = new Map(told.filter((one) => one.chunk !== undefined).map((one) => [one.chunk, one]));
        told = [...chunks.values()].sort((a, b) => a.chunk - b.chunk);
    }
    for (const kind of ["phonemes", "words", "characters"]) {
        const lists = told.map((one) => one[kind] ?? []);
        if (!lists.some((list) => list.length)) continue;
        const joint = new Joint();
        return { [kind]: pieced(joins ? lists.flatMap((list) => joint.add(list)) : lists.flat()) };
    }
    return { words: [] };
}

/** Words whose pieces adjoin in the text are joined. */
export function pieced(items) {
    const found = [];
    for (const item of items) {
        const last = found[found.length - 1];
        if (item.from >= 0 && item.from === last?.to && adjoin(last.text, item.text)) {
            Object.assign(last, { text: last.text + item.text, end: item.end, to: item.to });
        } else {
            found.push({ ...item });
        }
    }
    return found;
}

function adjoin(before, after) {
    return /[\p{L}\p{N}]$/u.test(before) && /^[\p{L}\p{N}]/u.test(after);
}

// ---- Parts of messages

function timed(text, start, end, item) {
    return { text, start, end, item };
}

function later(item, origin) {
    return { ...item, start: item.start + origin, end: item.end === null ? null : item.end + origin };
}

function word(item) {
    return timed(item.text("word", "text"), item.number("start", "starttime"), item.number("end", "endtime"), item);
}

/** One of Inworld's phones, without the digit of its stress. */
function phone(item) {
    const start = item.number("starttimeseconds");
    const text = item.text("phonesymbol").replace(/\p{Nd}+(?=\n?$)/u, "");
    return timed(text, start, start + item.number("durationseconds"), item);
}

/** What kind of boundary a service says that this is. */
function kindOf(item) {
    const names = ["boundarytype", "privboundarytype"];
    return names.some((name) => item.has(name)) ? plainly(item.get(...names)) : "";
}

function plainly(value) {
    return (typeof value === "object" ? JSON.stringify(value) : String(value)).toLowerCase();
}

function* humeStamps(item) {
    if (item.has("timestamp")) yield inner(item, "timestamp");
    if (isTold(item, "timestamps")) yield* item.parts("timestamps");
    for (const generation of item.has("generations") ? item.parts("generations") : []) {
        for (const snippet of generation.list("snippets").flat()) yield* humeStamps(entry(item, snippet));
    }
}

/** Texts and their times from lists of equal length; names that end in "ms" are of milliseconds. */
function lists(item, texts, starts, ends, durations = []) {
    const names = item.list(...texts);
    const begins = times(item, starts);
    let finishes;
    if (durations.some((name) => item.has(name))) {
        const lengths = times(item, durations);
        finishes = begins.slice(0, lengths.length).map((begin, i) => begin + lengths[i]);
    } else {
        finishes = times(item, ends);
    }
    const right = names.length === begins.length && begins.length === finishes.length;
    if (!right || names.some((name) => typeof name !== "string")) {
        throw item.error(`'${texts[0]}' and their times are not of one length`);
    }
    return names.map((name, i) => timed(name, begins[i], finishes[i], item));
}

/** A list of times in seconds. */
function times(item, names) {
    const name = names.find((one) => item.has(one)) ?? names[0];
    const scale = name.endsWith("ms") ? 1000 : 1;
    return item.list(name).map((value) => item.asNumber(value, name) / scale);
}

/** A field that must be an object. */
function inner(item, name) {
    return entry(item, item.get(name));
}

/** An object of a message, with the message's place. */
function entry(item, fields) {
    return new item.constructor(fields, item.line, item.place);
}

/** The first of the fields that is an object and not empty, or undefined. */
function first(item, ...names) {
    const name = names.find((one) => item.has(one) && isObject(item.get(one)) && isFilled(item.get(one)));
    return name && inner(item, name);
}

function isTold(item, name) {
    return item.has(name) && item.get(name) != null;
}

function isObject(value) {
    return typeof value === "object" && value !== null && !Array.isArray(value);
}

function isFilled(value) {
    return typeof value === "object" && value !== null ? Object.keys(value).length > 0 : Boolean(value);
}
