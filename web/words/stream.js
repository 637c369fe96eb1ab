// Words in time on their way to phonemes.

/** LABIAL_WORDS_NO_END. */
const NO_END = 2 ** 32 - 1;

const abandoned = new FinalizationRegistry(({ words, memory, at, size, held }) => {
    memory.release(at, size);
    words.release(held.table);
});

export class WordStream {
    #tools;
    #labial;
    #wasm;
    #memory;
    #words;
    #numbers;
    #known; // words of one's own
    #at; // 0 when freed
    #size;
    #held = {}; // the library's table of these words
    #moment = 0; // milliseconds up to which there are phonemes
    #ready = []; // those that were not taken
    #place = 0;

    constructor(tools, labial, wasm, memory, words, { own, numbers, offset = 0 } = {}) {
        const milliseconds = words.offset(offset);
        this.#tools = tools;
        this.#labial = labial;
        this.#wasm = wasm;
        this.#memory = memory;
        this.#words = words;
        this.#numbers = numbers;
        this.#known = words.known(own, numbers, []);
        this.#held.table = words.table(this.#known);
        this.#size = wasm.words_stream_size() + 8; // a phoneme and its milliseconds
        this.#at = memory.take(this.#size);
        abandoned.register(this, { words, memory, at: this.#at, size: this.#size, held: this.#held }, this);
        this.#check(wasm.words_begin(this.#at, this.#held.table.place, milliseconds));
    }

    say(word) {
        this.add(this.#words.word(word, this.#place + 1));
    }

    flush() {
        const at = this.#open();
        this.#collect(at);
        this.#check(this.#wasm.words_flush(at));
    }

    take() {
        this.#collect(this.#open());
        return this.#ready.splice(0);
    }

    free() {
        if (!this.#at) return;
        abandoned.unregister(this);
        this.#memory.release(this.#at, this.#size);
        this.#words.release(this.#held.table);
        this.#at = 0;
    }

    /** A word in whole milliseconds. Not for users. */
    add(word) {
        const at = this.#open();
        const words = this.#words;
        const wasm = this.#wasm;
        this.#collect(at);
        this.#learn(at, word.text);
        const end = word.end ?? NO_END;
        words.withText(word.text, (text, size) => {
            if (!words.spelt(word)) {
                this.#check(wasm.words_say(at, text, size, word.start, end), word.text);
                return;
            }
            const count = word.ends.length;
            const ends = this.#memory.take(4 * count);
            try {
                this.#memory.int32(ends, count).set(word.ends);
                this.#check(wasm.words_say_characters(at, text, size, word.start, ends, count), word.text);
            } finally {
                this.#memory.release(ends, 4 * count);
            }
        });
        this.#place++;
    }

    /** Tells the library of numbers that are to be written out. */
    #learn(at, text) {
        if (!this.#numbers) return;
        const known = this.#words.known(this.#known, this.#numbers, [text]);
        if (known.size === this.#known.size) return;
        const table = this.#words.table(known);
        this.#wasm.words_pronounce(at, table.place);
        this.#words.release(this.#held.table);
        this.#held.table = table;
        this.#known = known;
    }

    /** Takes the phonemes that are known from the library. */
    #collect(at) {
        const out = at + this.#size - 8;
        while (this.#check(this.#wasm.words_next(at, out)) === 0) {
            const [phoneme, milliseconds] = this.#memory.int32(out, 2);
            const start = this.#moment / 1000;
            this.#moment += milliseconds;
            const label = phoneme ? this.#words.labels[phoneme] : "";
            this.#ready.push({ start, end: this.#moment / 1000, label, labels: "arpabet" });
        }
    }

    #open() {
        if (!this.#at) throw new this.#tools.LabialError("the stream of words was freed");
        return this.#at;
    }

    #check(result, what) {
        if (result < 0) throw this.#labial.failure(result, what === undefined ? "" : this.#tools.shown(what));
        return result;
    }
}
