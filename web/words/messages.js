// Messages of speech services, one at a time, as they arrive while the sound plays. It does what
// export/labial/corpus/messages.py does; a test holds them to each other.
import { strip } from "./characters.js";
import { formatOf } from "./readers.js";
import { isBoundary, pieced } from "./services.js";

/** A gap between a service's phonemes, in seconds, is silence if it is longer. */
const LONGEST_GAP = 0.15;
/** What is believed: characters of a text, and seconds of times and of lengths. */
const LONGEST_TEXT = 1000;
const LATEST = 86400;
const LONGEST = 3600;
/** Formats whose messages begin where the one before ended, and the readers of their phonemes. */
const CHAINED = { piper: "fromPiper", kokoro: "fromKokoro", headtts: "fromHeadTTS" };
/** Formats whose messages are nothing but timings: others are passed over. */
const BARE = ["azure", "polly", "minimax", "google", "words", "json", ...Object.keys(CHAINED)];

/** Reads the messages of one service. */
export class Messages {
    #tools;
    #labial;
    #formats;
    #format; // null to recognise it by the first message with timings
    #labels; // the set of labels where the format does not tell it
    #count = 0;

    constructor({ tools, labial }, formats, { format, labels }) {
        if (format !== "auto" && !Object.hasOwn(formats, format)) {
            const names = Object.keys(formats).join(", ");
            throw new tools.LabialError(`${tools.shown(format)} is no format of messages: ${names}`);
        }
        this.#tools = tools;
        this.#labial = labial;
        this.#formats = formats;
        this.#format = format === "auto" ? null : format;
        this.#labels = labels;
    }

    /** What a message tells: a list of { told, chained, joins, gap }, where `told` lists { kind, items, key }. Items are
     * { text, start, end } in seconds; the texts of phonemes are labels of ARPABET. */
    read(message) {
        this.#count++;
        const found = this.#documents(message).map((fields, i) => this.#heard(this.#entry(fields, i + 1)));
        return found.filter(({ told }) => told.length);
    }

    #entry(fields, place) {
        try {
            return new this.#tools.timings.Entry(fields, 0, place);
        } catch (error) {
            throw this.#error(error.message);
        }
    }

    #error(problem) {
        return new this.#tools.LabialError(`message ${this.#count}: ${problem}`);
    }

    /** The objects of a message. Bytes that are not JSON are sound. */
    #documents(message) {
        let found = message;
        if (isBinary(message)) {
            const bytes = bytesOf(message);
            const first = bytes.subarray(0, 64).find((byte) => ![9, 10, 13, 32].includes(byte));
            if (first !== 0x7b && first !== 0x5b) return [];
            try {
                found = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
            } catch {
                throw this.#error("not UTF-8");
            }
        }
        if (typeof found === "string") {
            try {
                found = JSON.parse(found);
            } catch {
                throw this.#error("not JSON");
            }
        } else if (typeof found !== "object" || found === null) {
            throw new TypeError(`a message is ${this.#tools.shown(message)}, not an object, a list, text or bytes`);
        }
        return Array.isArray(found) ? found : [found];
    }

    #heard(item) {
        try {
            const format = this.#format ?? formatOf(this.#formats, item);
            const service = format && this.#formats[format];
            if (!service || (BARE.includes(format) && !service.told(item))) return { told: [] };
            const heard = this.#told(format, service, item);
            heard.told = heard.told.filter(({ items, key }) => items.length || key !== undefined);
            for (const { kind, items } of heard.told) {
                for (const one of items) this.#check(item, one, kind !== "characters");
            }
            if (heard.told.length) this.#format = format;
            return heard;
        } catch (error) {
            if (error instanceof this.#tools.LabialError) error.message = `message ${this.#count}: ${error.message}`;
            throw error;
        }
    }

    #told(format, service, item) {
        const { timings } = this.#tools;
        if (format === "azure" && !isBoundary(item)) {
            const name = String(item.get("visemeid", "privvisemeid"));
            return this.#viseme(format, name, item.number("audiooffset", "privaudiooffset") / 1e7, item);
        }
        if (format === "polly" && item.get("type") === "viseme") {
            return this.#viseme(format, item.text("value"), item.number("time") / 1000, item);
        }
        if (service.message) {
            const { chunk, ...lists } = service.message(item);
            const told = Object.entries(lists).map(([kind, items]) => ({ kind, items: pieced(items), key: chunk }));
            for (const { kind, items } of told) {
                if (kind === "phonemes") for (const one of items) one.text = this.#phoneme(strip(one.text), "ipa");
            }
            return { told, joins: service.joins ?? false, chained: false, gap: LONGEST_GAP };
        }
        let segments;
        try {
            segments = Object.hasOwn(CHAINED, format) ? timings[CHAINED[format]](item.fields) : service.read([item]);
        } catch (error) {
            if (error.message === "no segments") return { told: [] };
            throw error;
        }
        const items = segments.map(({ start, end, label, labels }) => {
            return { text: this.#phoneme(label, labels), start, end };
        });
        return { told: [{ kind: "phonemes", items }], chained: Object.hasOwn(CHAINED, format), joins: false, gap: 0 };
    }

    #viseme(service, name, start, item) {
        if (!this.#tools.timings.VISEMES[service][0].has(name)) {
            throw item.error(`no viseme is called ${this.#tools.shown(name)}`);
        }
        const items = [{ text: name, start, end: null }];
        return { told: [{ kind: service, items }], chained: false, joins: false, gap: 0 };
    }

    /** The label of the phoneme that a label means, or the one nearest to it; an empty one is silence. */
    #phoneme(label, hint) {
        if (label === "") return "SIL";
        return this.#labial.label(this.#labial.phoneme(label, { labels: this.#labels, hint, nearest: true }));
    }

    #check(item, { text, start, end }, inOrder) {
        const shown = this.#tools.shown(text);
        const latest = Math.max(start, end ?? 0);
        const length = [...text].length;
        if (length > LONGEST_TEXT) throw item.error(`a text of ${length} characters, more than ${LONGEST_TEXT}`);
        if (inOrder && end !== null && end < start) {
            throw item.error(`${shown} ends at ${end} s, before its start ${start} s`);
        }
        if (latest > LATEST) throw item.error(`${latest} s is more than a day; are these seconds?`);
        if (end !== null && end - start > LONGEST) {
            throw item.error(`${shown} lasts ${end - start} s, more than an hour`);
        }
    }
}

function bytesOf(message) {
    if (ArrayBuffer.isView(message)) return new Uint8Array(message.buffer, message.byteOffset, message.byteLength);
    return new Uint8Array(message instanceof ArrayBuffer ? message : 0);
}

/** Whether a message is bytes; what a WebSocket without `binaryType` delivers cannot be read at once, and is sound. */
function isBinary(message) {
    return ArrayBuffer.isView(message) || message instanceof ArrayBuffer
        || (typeof Blob !== "undefined" && message instanceof Blob);
}
