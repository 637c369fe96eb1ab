// Decodes bytes in a script: base64 of a raw deflate stream (RFC 1951). Neither atob() nor DecompressionStream is
// available everywhere: an AudioWorklet lacks both.
import { LabialError } from "./memory.js";

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/** The order of the code lengths' code lengths in a block. */
const ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
/** Base and extra bits: of lengths from symbol 257 on, of distances. */
const LENGTHS = table(29, 3, (i) => (i < 4 || i === 28 ? 0 : (i >> 2) - 1));
const DISTANCES = table(30, 1, (i) => (i < 2 ? 0 : (i >> 1) - 1));
LENGTHS[28][0] = 258;

const FIXED = [
    code(Array.from({ length: 288 }, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8))),
    code(new Array(30).fill(5)),
];

/** The decoded bytes of a text. Throws a LabialError if it is damaged. */
export function unpack(text) {
    const packed = fromBase64(text);
    let bit = 0;
    let out = new Uint8Array(2 * packed.length);
    let used = 0;

    const damaged = () => new LabialError("what was packed is damaged");
    const bits = (count) => {
        let value = 0;
        for (let i = 0; i < count; i++, bit++) {
            if (bit >= 8 * packed.length) throw damaged();
            value |= ((packed[bit >> 3] >> (bit & 7)) & 1) << i;
        }
        return value;
    };
    const symbol = ({ counts, symbols }) => {
        let value = 0;
        let first = 0;
        let index = 0;
        for (let length = 1; length < 16; length++) {
            value |= bits(1);
            if (value - first < counts[length]) return symbols[index + value - first];
            index += counts[length];
            first = (first + counts[length]) << 1;
            value <<= 1;
        }
        throw damaged();
    };
    const put = (byte) => {
        if (used === out.length) {
            const larger = new Uint8Array(2 * used + 64);
            larger.set(out);
            out = larger;
        }
        out[used++] = byte;
    };
    const codes = () => {
        const [literals, distances, told] = [bits(5) + 257, bits(5) + 1, bits(4) + 4];
        const own = new Array(19).fill(0);
        for (let i = 0; i < told; i++) own[ORDER[i]] = bits(3);
        const reader = code(own);
        const lengths = [];
        while (lengths.length < literals + distances) {
            const found = symbol(reader);
            if (found < 16) {
                lengths.push(found);
            } else {
                const repeated = found === 16 ? lengths[lengths.length - 1] : 0;
                const times = found === 16 ? 3 + bits(2) : found === 17 ? 3 + bits(3) : 11 + bits(7);
                for (let i = 0; i < times; i++) lengths.push(repeated);
            }
        }
        return [code(lengths.slice(0, literals)), code(lengths.slice(literals))];
    };

    for (let last = false; !last; ) {
        last = bits(1) === 1;
        const kind = bits(2);
        if (kind === 3) throw damaged();
        if (kind === 0) {
            bit = (bit + 7) & ~7;
            const size = bits(16);
            bits(16); // its complement
            for (let i = 0; i < size; i++) put(bits(8));
            continue;
        }
        const [literals, distances] = kind === 1 ? FIXED : codes();
        for (let found; (found = symbol(literals)) !== 256; ) {
            if (found < 256) {
                put(found);
                continue;
            }
            const [length, more] = LENGTHS[found - 257] ?? [];
            const size = length + bits(more);
            const [distance, extra] = DISTANCES[symbol(distances)] ?? [];
            const from = used - distance - bits(extra);
            if (!(from >= 0)) throw damaged();
            for (let i = 0; i < size; i++) put(out[from + i]);
        }
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

/** A canonical Huffman code by the lengths of its symbols: how many have each length, and the symbols by length. */
function code(lengths) {
    const counts = new Array(16).fill(0);
    lengths.forEach((length) => counts[length]++);
    counts[0] = 0;
    const symbols = lengths.map((_, i) => i).filter((i) => lengths[i]).sort((a, b) => lengths[a] - lengths[b] || a - b);
    return { counts, symbols };
}

function table(count, first, extra) {
    const found = [];
    for (let i = 0, base = first; i < count; base += 1 << extra(i++)) found.push([base, extra(i)]);
    return found;
}
