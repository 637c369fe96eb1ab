// Messages of speech services, one at a time, as they arrive while the sound plays. It does what
// export/labial/corpus/messages.py does; a test holds them to each other.

/** After so many messages without a timing, one sentence is logged. */
const PATIENCE = 50;

/** Reads the messages of one service. */
export class Messages {
    #tools;
    #labial;
    #format; // null to recognise it by the first message with timings
    #recognises;
    #silent = null; // a service whose messages had no timings
    #hasWarned = false;
    #hasToldOfOthers = false;
    #labels; // the set of labels where the format does not tell it
    #phonemes = new Map(); // of labels: the nearest one takes long to find
    #stats = { messages: 0, told: 0, skipped: 0 };

    constructor({ tools, labial }, { format, labels }) {
        const { SERVICES } = tools.timings;
        if (format !== "auto" && !Object.hasOwn(SERVICES, format)) {
            const names = Object.keys(SERVICES).join(", ");
            throw new tools.LabialError(`${tools.shown(format)} is no format of messages: ${names}`);
        }
        this.#tools = tools;
        this.#labial = labial;
        this.#recognises = format === "auto";
        this.#format = this.#recognises ? null : format;
        this.#labels = labels;
    }

    /** What became of the messages so far. */
    get stats() { return { ...this.#stats }; }

    /** A list of { told, chained, joins, gap, utterance }: what a message tells. `told` lists { kind, items, key }.
     * Items are { text, start, end } in seconds; the texts of phonemes are labels of ARPABET. */
    read(message) {
        const stats = this.#stats;
        stats.messages++;
        const odd = new this.#tools.timings.Odd(false);
        let heard;
        try {
            heard = this.#entries(message, odd).map((item) => this.#heard(item, odd));
        } catch (error) {
            if (error instanceof this.#tools.LabialError) error.message = `message ${stats.messages}: ${error.message}`;
            throw error;
        } finally {
            stats.skipped += odd.count;
        }
        for (const { told } of heard) for (const { items } of told) stats.told += items.length;
        if (stats.messages === PATIENCE) this.expectTimings();
        return heard.filter(({ told }) => told.length);
    }

    /** Warns, once, if there were messages and none of them told timings. */
    expectTimings() {
        if (!this.#stats.messages || this.#stats.told || this.#hasWarned) return;
        this.#hasWarned = true;
        const { SERVICES } = this.#tools.timings;
        const service = SERVICES[this.#format ?? this.#silent];
        const problem = service ? `${service.title} has to be asked for them${service.advice && `: ${service.advice}`}`
            : `none is of a known service (${Object.keys(SERVICES).join(", ")})`;
        console.warn(`labial: ${this.#stats.messages} messages told no timings: ${problem}`);
    }

    /** The objects of a message. Bytes that are not JSON are sound. */
    #entries(message, odd) {
        const { LabialError, shown, timings: { Entry, LIMITS, documentsOf } } = this.#tools;
        let found = message;
        if (isBinary(message)) {
            const bytes = bytesOf(message);
            const first = bytes.subarray(0, 64).find((byte) => ![9, 10, 13, 32].includes(byte));
            if (![0x7b, 0x5b, 0x64, 0x65, 0x69, 0x72, 0x3a].includes(first)) return [];
            try {
                found = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
            } catch {
                if (first !== 0x7b && first !== 0x5b) return [];
                throw new LabialError("not UTF-8");
            }
        }
        if (typeof found === "string") {
            found = documentsOf(found, () => { odd.count++; }, LIMITS.documents);
        } else if (typeof found === "object" && found !== null) {
            found = (Array.isArray(found) ? found : [found]).map((item, i) => [item, 0, i + 1]);
        } else {
            throw new TypeError(`a message is ${shown(message)}, not an object, a list, text or bytes`);
        }
        if (found.length > LIMITS.documents) {
            throw new LabialError(`${found.length} objects, more than the ${LIMITS.documents} that are read`);
        }
        return found.map(([item, line, place]) => new Entry(item, line, place));
    }

    #heard(item, odd) {
        const { LONGEST_GAP, LIMITS, SERVICES, serviceOf } = this.#tools.timings;
        const format = this.#format ?? serviceOf(item);
        if (!format) return { told: [] };
        const service = SERVICES[format];
        const read = service.told(item) || !service.bare ? service.read(item, odd) : [];
        if (read.reduce((sum, { items }) => sum + items.length, 0) > LIMITS.items) {
            throw item.error(`more than ${LIMITS.items} words or phonemes in a message`);
        }
        const told = read.map((one) => this.#converted(one, odd))
            .filter(({ items, key }) => items.length || key !== undefined);
        if (told.length) {
            this.#format = format;
        } else {
            this.#silent = format;
            this.#expectOthers(item, format);
        }
        return {
            told, chained: service.times === "chained", joins: service.times === "restart",
            gap: read.some(({ kind }) => kind === "phonemes") ? LONGEST_GAP : 0, utterance: service.utterance(item),
        };
    }

    /** Phonemes by their labels of ARPABET; no text that is too long. */
    #converted({ kind, items, key }, odd) {
        const { LIMITS, phonemeSegments } = this.#tools.timings;
        const isSound = kind === "sounds" || kind === "labels";
        let found = items;
        if (isSound) {
            found = phonemeSegments(items, kind).map(({ start, end, label, labels }) => {
                return { text: this.#phoneme(label, labels), start, end, item: items[0].item };
            });
        } else if (kind === "phonemes") {
            found = items.map((one) => ({ ...one, text: this.#phoneme(one.text, "ipa") }));
        }
        const short = found.filter(({ text }) => text.length <= LIMITS.text || [...text].length <= LIMITS.text);
        odd.count += found.length - short.length;
        return { kind: isSound ? "phonemes" : kind, items: short, key };
    }

    /** The label of the phoneme that a label means, or the one nearest to it; an empty one is silence. */
    #phoneme(label, hint) {
        if (label === "") return "SIL";
        const key = `${hint} ${label}`;
        if (!this.#phonemes.has(key)) {
            if (this.#phonemes.size >= this.#tools.timings.LIMITS.items) this.#phonemes.clear();
            const found = this.#labial.phoneme(label, { labels: this.#labels, hint, nearest: true });
            this.#phonemes.set(key, this.#labial.label(found));
        }
        return this.#phonemes.get(key);
    }

    /** Warns, once, if a message is of another service than those that told timings before. */
    #expectOthers(item, format) {
        if (!this.#recognises || this.#format === null || this.#hasToldOfOthers) return;
        const { SERVICES, serviceOf } = this.#tools.timings;
        const other = SERVICES[serviceOf(item)];
        if (!other || other === SERVICES[format] || other.bare) return;
        this.#hasToldOfOthers = true;
        console.warn(`labial: message ${this.#stats.messages} seems to be of ${other.title} and is not read, since earlier `
            + `ones are of ${SERVICES[format].title}: name the format, or use a voice for each service`);
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
