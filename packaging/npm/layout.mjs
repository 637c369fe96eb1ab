// Where the tables of a model lie in the module's memory (labial_model_t of include/labial/model.h, for 32-bit targets):
// what the tests know of it.

const CHANNELS = 13;

/** The tables in the order of a binary model (include/labial/blob.h): name, address, bytes, bytes of a row. */
export function tables(buffer, model) {
    const view = new DataView(buffer);
    const half = (offset) => view.getUint16(model + offset, true);
    const byte = (offset) => view.getUint8(model + offset);
    const components = half(4);
    const [phonemes, classes, states, predecessors] = [6, 7, 8, 9].map(byte);
    const taps = byte(13);
    const floors = byte(16);
    const knots = byte(17);
    const pairs = half(18);
    const found = [];
    const add = (name, at, rows, width) => {
        if (at && rows) found.push({ name, at, size: rows * width, width });
    };
    [
        ["phonemes", phonemes, 6], ["components", components, 6], ["contexts", components, 2 * classes],
        ["shapes", components, CHANNELS], ["slopes", components, CHANNELS], ["kernels", phonemes * taps, CHANNELS],
        ["pair_keys", pairs, 2], ["pairs", pairs * knots, CHANNELS], ["floors", floors, 2 * CHANNELS],
        ["contacts", floors, 2],
    ].forEach(([name, rows, width], i) => add(name, view.getUint32(model + 20 + 4 * i, true), rows, width));
    const channels = view.getUint32(model + 60, true);
    for (let k = 0; k < CHANNELS; k++) {
        const at = channels + 24 * k;
        add("scales", at, 1, 12);
        [["emissions", 6], ["states", 10], ["transitions", 2 * predecessors]].forEach(([name, width], i) =>
            add(name, view.getUint32(at + 12 + 4 * i, true), states, width));
    }
    return found;
}
