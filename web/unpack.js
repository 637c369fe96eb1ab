// Decodes bytes in a script: base64 of an .xz file, as CMake writes it. An AudioWorklet has neither atob() nor
// DecompressionStream.
import { LabialError } from "./memory.js";

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/** How the text begins; the bytes before the first chunk, which are the headers of the file and of its block. */
const BEGIN = "/Td6WFoA";
const HEADERS = 24;
/** LZMA's settings: the context of a literal is three bits of the byte before, that of a match two of its place. */
const SETTINGS = 0x5d;
/** Most bytes that are unpacked. */
const MOST = 2 ** 26;

/** Probabilities that a bit is 0, in 1/2048. */
const odds = (count) => new Uint16Array(count).fill(1024);
const lengths = () => ({ choice: odds(2), low: odds(32), middle: odds(32), high: odds(256) });

/** What is known of the bytes so far. */
const beginning = () => ({
    state: 0, // what kinds of symbols came last
    last: [0, 0, 0, 0], // the latest distances, less one
    match: odds(48), long: odds(48), again: odds(12), older: odds(12), third: odds(12), fourth: odds(12),
    literals: odds(8 * 0x300), slots: odds(256), middles: odds(128), lows: odds(16),
    lengths: lengths(), lengthsAgain: lengths(),
});

/** The decoded bytes of a text. Throws a LabialError if it is damaged. */
export function unpack(text) {
    const packed = fromBase64(text);
    const coder = new Uint32Array(2); // the range, and the code within it
    let at = HEADERS;
    let out = new Uint8Array(2 * packed.length);
    let used = 0;
    let known = beginning();

    const damaged = () => new LabialError("what was packed is damaged, or by another version of labial");
    const next = () => {
        if (at >= packed.length) throw damaged();
        return packed[at++];
    };
    const pair = () => 256 * next() + next() + 1;

    // ---- Bits and numbers

    const widen = () => {
        coder[0] <<= 8;
        coder[1] = (coder[1] << 8) | next();
    };
    const bit = (table, i) => {
        const chance = table[i];
        const bound = (coder[0] >>> 11) * chance;
        const one = coder[1] < bound ? 0 : 1;
        if (one) {
            coder[0] -= bound;
            coder[1] -= bound;
            table[i] = chance - (chance >> 5);
        } else {
            coder[0] = bound;
            table[i] = chance + ((2048 - chance) >> 5);
        }
        if (coder[0] < 2 ** 24) widen();
        return one;
    };
    /** A number whose bits are 0 as often as 1. */
    const even = (count) => {
        let value = 0;
        for (let i = 0; i < count; i++) {
            coder[0] >>>= 1;
            const one = coder[1] < coder[0] ? 0 : 1;
            if (one) coder[1] -= coder[0];
            if (coder[0] < 2 ** 24) widen();
            value = 2 * value + one;
        }
        return value;
    };
    const highFirst = (table, from, count) => {
        let node = 1;
        for (let i = 0; i < count; i++) node = 2 * node + bit(table, from + node);
        return node - (1 << count);
    };
    const lowFirst = (table, from, count) => {
        let value = 0;
        for (let i = 0, node = 1; i < count; i++) {
            const one = bit(table, from + node);
            node = 2 * node + one;
            value += one << i;
        }
        return value;
    };

    // ---- Symbols

    /** A literal. After a match, `other` is the byte that would have continued it, else -1. */
    const literal = (other) => {
        const from = used ? 0x300 * (out[used - 1] >> 5) : 0;
        let node = 1;
        for (let i = 7, same = other >= 0; same && i >= 0; i--) {
            const wanted = (other >> i) & 1;
            const one = bit(known.literals, from + 256 * (1 + wanted) + node);
            same = one === wanted;
            node = 2 * node + one;
        }
        while (node < 256) node = 2 * node + bit(known.literals, from + node);
        return node - 256;
    };
    const length = ({ choice, low, middle, high }, place) => {
        if (!bit(choice, 0)) return 2 + highFirst(low, 8 * place, 3);
        return bit(choice, 1) ? 18 + highFirst(high, 0, 8) : 10 + highFirst(middle, 8 * place, 3);
    };
    const distance = (size) => {
        const slot = highFirst(known.slots, 64 * Math.min(size - 2, 3), 6);
        if (slot < 4) return slot;
        const count = (slot >> 1) - 1;
        const base = (2 | (slot & 1)) * 2 ** count;
        if (slot < 14) return base + lowFirst(known.middles, base - slot, count);
        return base + 16 * even(count - 4) + lowFirst(known.lows, 0, 4);
    };
    /** Writes what the next symbol stands for. */
    const write = (end) => {
        const { state, last } = known;
        const place = used & 3;
        if (!bit(known.match, 4 * state + place)) {
            out[used] = literal(state < 7 ? -1 : out[used - last[0] - 1]);
            used++;
            known.state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
            return;
        }
        let size = 1;
        if (!bit(known.again, state)) {
            size = length(known.lengths, place);
            last.unshift(distance(size));
            last.pop();
            known.state = state < 7 ? 7 : 10;
        } else {
            const which = !bit(known.older, state) ? 0 : !bit(known.third, state) ? 1 : 2 + bit(known.fourth, state);
            if (which || bit(known.long, 4 * state + place)) size = length(known.lengthsAgain, place);
            last.unshift(...last.splice(which, 1));
            known.state = state >= 7 ? 11 : size === 1 ? 9 : 8;
        }
        if (last[0] >= used || used + size > end) throw damaged();
        for (const stop = used + size; used < stop; used++) out[used] = out[used - last[0] - 1];
    };

    // ---- Chunks

    if (!text.startsWith(BEGIN)) throw damaged();
    for (let kind; (kind = next()); ) {
        const compressed = kind >= 0x80;
        const end = used + pair() + (compressed ? 65536 * (kind & 31) : 0);
        if (end > MOST) throw damaged();
        if (end > out.length) {
            const larger = new Uint8Array(2 * end);
            larger.set(out);
            out = larger;
        }
        if (!compressed) {
            while (used < end) out[used++] = next();
            continue;
        }
        const size = pair();
        if (kind >= 0xa0) known = beginning();
        if (kind >= 0xc0 && next() !== SETTINGS) throw damaged();
        const after = at + size;
        for (let i = 0; i < 5; i++) widen();
        coder[0] = 2 ** 32 - 1;
        while (used < end) write(end);
        at = after;
    }
    return out.slice(0, used);
}

function fromBase64(text) {
    const length = text.indexOf("=") < 0 ? text.length : text.indexOf("=");
    const bytes = new Uint8Array((length * 3) >> 2);
    for (let i = 0, at = 0, value = 0; i < length; i++) {
        value = (value << 6) | DIGITS.indexOf(text[i]);
        if (i % 4) bytes[at++] = value >> (6 - 2 * (i % 4));
    }
    return bytes;
}
