// What the tests of the npm package share: the package itself, as it was packed, and the conformance streams.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { tables } from "../../packaging/npm/layout.mjs";

/** The folder of the package, which the build names. */
export const folder = resolve(process.env.LABIAL_NPM_PACKAGE ?? "build/wasm/npm");

export const { Labial, LabialError, timings } = await import(pathToFileURL(`${folder}/index.js`));

/** The repository's file of this path. */
export function source(path) {
    return readFileSync(new URL(`../../${path}`, import.meta.url), "utf8");
}

const MODELS = { SPEECH: ["speech", "SPEECH_EN_"], LAUGHTER: ["laughter", "LAUGHTER_SYNTHETIC_"] };

/** The streams of tests/conformance/vectors.c: name, steps, the number of frames and their digest. */
export function vectors() {
    const text = source("tests/conformance/vectors.c");
    const steps = {};
    for (const [, name, body] of text.matchAll(/conformance_step_t (\w+)_steps\[\] = \{([^;]*)\};/g)) {
        steps[name] = [...body.matchAll(/(PUSH|CANCEL|AGAIN|END)(?:\(([^)]*)\))?/g)].map(([, kind, inner = ""]) => {
            const [first, second, third] = inner.split(/,\s*/);
            if (kind !== "PUSH") return { kind, frames: Number(first), milliseconds: Number(second) };
            const [model, prefix] = MODELS[first];
            return { kind, model, label: second.slice(prefix.length), milliseconds: Number(third) };
        });
    }
    return [...text.matchAll(/\{ "(\w+)", \w+, (\d+), (\d+), (0x[0-9a-f]+)u \}/g)].map(([, name, , frames, digest]) => ({
        name, steps: steps[name], frames: Number(frames), digest: Number(digest),
    }));
}

/** A bundled model as a binary one, which blob.h describes. */
export function binary(mouth, model) {
    const { buffer } = mouth.memory.bytes;
    const view = new DataView(buffer);
    const parts = tables(buffer, model.at);
    const padded = parts.map(({ size }) => (size + 3) & ~3);
    const bytes = new Uint8Array(32 + padded.reduce((sum, size) => sum + size, 0));
    const header = new DataView(bytes.buffer);
    bytes.set(new TextEncoder().encode("LBM1"));
    header.setUint32(4, bytes.length, true);
    bytes.set(new Uint8Array(buffer, model.at, 6), 12);
    bytes.set(new Uint8Array(buffer, model.at + 6, 10), 18);
    const has = (name) => parts.some((part) => part.name === name);
    const knots = view.getUint8(model.at + 17);
    header.setUint8(28, (has("contexts") ? 1 : 0) | (has("slopes") ? 2 : 0) | (knots === 2 ? 4 : 0));
    header.setUint8(29, view.getUint8(model.at + 16));
    header.setUint16(30, view.getUint16(model.at + 18, true), true);
    let at = 32;
    parts.forEach((part, i) => {
        bytes.set(new Uint8Array(buffer, part.at, part.size), at);
        at += padded[i];
    });
    header.setUint32(8, crc32(bytes.subarray(12)), true);
    return bytes;
}

/** CRC-32 of bytes, as zlib has it. */
export function crc32(bytes) {
    let sum = ~0;
    for (const byte of bytes) {
        sum ^= byte;
        for (let bit = 0; bit < 8; bit++) sum = (sum >>> 1) ^ (0xedb88320 & -(sum & 1));
    }
    return ~sum >>> 0;
}
