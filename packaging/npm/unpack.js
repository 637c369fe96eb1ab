// What pack.mjs packed: a context-mixing coder for tables. Each bit is predicted from what stood at several distances before
// it, to the left and in the rows above; a mixture of these predictions that learns as it goes drives an arithmetic
// coder. Nothing but exact operations on doubles and integers, so that every engine predicts the same.

const SLOTS = 65536; // per context
const SHIFT = 16;
/** Steps per unit of the logistic function's argument, and how far the tables of it reach. */
const STEPS = 128;
const REACH = 12 * STEPS;
const CONTEXTS = 15;
const KINDS = 16;
const RATE = 0.02;
const LIMIT = 60;

const squash = new Float64Array(2 * REACH + 1);
const stretch = new Float64Array(4096);
for (let i = 0, power = 1; i <= REACH; i++, power *= 1.0078430972064479 /* e ** (1 / STEPS) */) {
    squash[REACH + i] = power / (1 + power);
    squash[REACH - i] = 1 / (1 + power);
}
for (let i = 0, x = 0; i < 4096; i++) {
    while (squash[x] < (i + 0.5) / 4096) x++;
    stretch[i] = (x - REACH) / STEPS;
}
const pace = Float64Array.from({ length: LIMIT + 1 }, (_, i) => 1 / (i + 1.6));

/** Codes `size` bytes in parts [size, width, kind]: `code` takes the probability of a one, of 65536, and tells the bit. */
export function model(bytes, parts, code) {
    const chances = new Uint16Array(CONTEXTS * SLOTS).fill(32768);
    const counts = new Uint8Array(CONTEXTS * SLOTS);
    const weights = new Float64Array(KINDS * 8 * CONTEXTS).fill(0.3);
    const inputs = new Float64Array(CONTEXTS);
    const places = new Int32Array(CONTEXTS);
    const hashes = new Int32Array(CONTEXTS);
    let begin = 0;
    for (const [size, width, kind] of parts) {
        const before = (i, distance) => (i - distance >= begin ? bytes[i - distance] : 0);
        for (let i = begin; i < begin + size; i++) {
            const base = Math.imul(kind, 7919) + ((i - begin) % width) * 131;
            const w = before(i, 1), ww = before(i, 2), www = before(i, 3);
            const n = before(i, width), nw = before(i, width + 1), nww = before(i, width + 2), nn = before(i, 2 * width);
            hashes[0] = base;
            hashes[1] = base + 1e6 + w * 77773;
            hashes[2] = base + 2e6 + n * 991199;
            hashes[3] = base + 3e6 + ((w & 240) + (n >> 4)) * 40503;
            hashes[4] = kind + 4e6 + ((w >> 2) * 64 + (ww >> 2)) * 7177;
            hashes[5] = base + 5e6 + (((w + n - nw) & 255) >> 2) * 8191;
            hashes[6] = base + 6e6 + ((n >> 3) * 32 + (nn >> 3)) * 65599;
            hashes[7] = kind + 7e6 + ((((w << 24) >> 24) + ((n << 24) >> 24) + 512) >> 3) * 12345;
            hashes[8] = base + 8e6 + ww * 4441;
            hashes[9] = base + 9e6 + ((ww + n - nww) & 255) * 9973;
            hashes[10] = base + 10e6 + (ww * 256 + n) * 131071;
            hashes[11] = base + 11e6 + (w >> 4) * 771;
            hashes[12] = base + 12e6 + (n >> 4) * 881;
            hashes[13] = base + 13e6 + (((2 * n - nn) & 255) >> 2) * 997;
            hashes[14] = kind + 14e6 + (w * 65536 + ww * 256 + www) * 1009;
            for (let j = 0; j < CONTEXTS; j++) hashes[j] = Math.imul(hashes[j], 0x9e3779b1);
            let node = 1;
            for (let bit = 7; bit >= 0; bit--) {
                const row = (kind * 8 + bit) * CONTEXTS;
                let dot = 0;
                for (let j = 0; j < CONTEXTS; j++) {
                    const place = j * SLOTS + ((hashes[j] ^ Math.imul(node, 0x85ebca6b)) >>> SHIFT);
                    const count = counts[place];
                    const input = count === 0 ? 0 : stretch[chances[place] >> 4] * (count < 3 ? 0.6 : 1);
                    places[j] = place;
                    inputs[j] = input;
                    dot += weights[row + j] * input;
                }
                const chance = squash[Math.max(0, Math.min(2 * REACH, Math.round(dot * STEPS) + REACH))];
                const one = code(Math.max(16, Math.min(65520, Math.round(chance * 65536))), (bytes[i] >> bit) & 1);
                const error = (one - chance) * RATE;
                for (let j = 0; j < CONTEXTS; j++) {
                    const place = places[j];
                    const count = counts[place];
                    weights[row + j] += error * inputs[j];
                    chances[place] += Math.trunc((65535 * one - chances[place]) * pace[count]);
                    if (count < LIMIT) counts[place] = count + 1;
                }
                node = 2 * node + one;
            }
            bytes[i] = node;
        }
        begin += size;
    }
}
