// The layout of a model's tables in the module's memory (labial_model_t of include/labial/model.h, for 32-bit targets),
// for builds and tests.

/** Offsets in labial_model_t: of the number of channels, of the first table's pointer and of the channels'. */
const [COUNT, TABLES, DESCRIPTORS] = [20, 36, 80];
/** Bytes of the number of channels and of their sources, and of the header of a binary model. */
const [SOURCES, HEADER] = [14, 48];

/** The tables in the order of a binary model (include/labial/blob.h): name, address, bytes. */
function tables(buffer, model) {
    const view = new DataView(buffer);
    const half = (offset) => view.getUint16(model + offset, true);
    const byte = (offset) => view.getUint8(model + offset);
    const components = half(4);
    const [phonemes, classes, states, fours] = [6, 7, 8, 9].map(byte);
    const taps = byte(13);
    const floors = byte(16);
    const knots = byte(17);
    const pairs = half(18);
    const channels = byte(COUNT);
    const found = [];
    const add = (name, at, rows, width) => {
        if (at && rows) found.push({ name, at, size: rows * width });
    };
    [
        ["phonemes", phonemes, 6], ["components", components, 6], ["contexts", components, classes],
        ["shapes", components, channels], ["slopes", components, channels], ["kernels", phonemes * taps, (channels + 3) & ~3],
        ["pair_keys", pairs, 2], ["pairs", pairs * knots, channels],
        ["floors", floors, 2 * channels], ["contacts", floors, 2], ["protrusion", 1, 38],
    ].forEach(([name, rows, width], i) => add(name, view.getUint32(model + TABLES + 4 * i, true), rows, width));
    for (let k = 0; k < channels; k++) {
        const at = view.getUint32(model + DESCRIPTORS, true) + 32 * k;
        add("scales", at, 1, 16);
        [["emissions", 4], ["states", 8], ["transitions", 8 * fours], ["initials", 1]].forEach(
            ([name, width], i) => add(name, view.getUint32(at + 16 + 4 * i, true), states, width),
        );
    }
    return found;
}

/** A model of the module's memory as a binary one, which blob.h describes. */
export function binary(buffer, model) {
    const view = new DataView(buffer);
    const parts = tables(buffer, model);
    const padded = parts.map(({ size }) => (size + 3) & ~3);
    const bytes = new Uint8Array(HEADER + padded.reduce((sum, size) => sum + size, 0));
    const header = new DataView(bytes.buffer);
    bytes.set(new TextEncoder().encode("LBM1"));
    header.setUint32(4, bytes.length, true);
    bytes.set(new Uint8Array(buffer, model, 6), 12);
    bytes.set(new Uint8Array(buffer, model + 6, 10), 18);
    const has = (name) => parts.some((part) => part.name === name);
    const knots = view.getUint8(model + 17);
    header.setUint8(28, (has("contexts") ? 1 : 0) | (has("slopes") ? 2 : 0) | (knots === 2 ? 4 : 0) | (has("protrusion") ? 8 : 0));
    header.setUint8(29, view.getUint8(model + 16));
    header.setUint16(30, view.getUint16(model + 18, true), true);
    bytes.set(new Uint8Array(buffer, model + COUNT, SOURCES), 32);
    let at = HEADER;
    parts.forEach((part, i) => {
        bytes.set(new Uint8Array(buffer, part.at, part.size), at);
        at += padded[i];
    });
    header.setUint32(8, crc32(bytes.subarray(12)), true);
    return bytes;
}

/** CRC-32 of bytes, as zlib has it. */
function crc32(bytes) {
    let sum = ~0;
    for (const byte of bytes) {
        sum ^= byte;
        for (let bit = 0; bit < 8; bit++) sum = (sum >>> 1) ^ (0xedb88320 & -(sum & 1));
    }
    return ~sum >>> 0;
}
