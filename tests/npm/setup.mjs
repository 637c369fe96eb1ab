// What the tests of the npm package share: the package itself, as it was packed, and the conformance streams.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { binary as blob } from "../../web/layout.mjs";

/** The folder of the package, which the build names. */
export const folder = resolve(process.env.LABIAL_NPM_PACKAGE ?? "build/wasm/npm");

/** A module of the packages, such as "/mouth.js" or "-words/index.js". */
export const load = (path) => import(pathToFileURL(`${folder}${path}`));
/** The packages that labial is given. */
export const [hearing, words] = ["-hearing", "-words"].map((name) => () => load(`${name}/index.js`));

export const { Labial, LabialError, heard, timings } = await load("/index.js");
/** The laughter model, from the package beside it. */
export const { default: laughter } = await load("-laughter/index.js");
export const { unpack } = await load("/unpack.js");

/** The repository's file of this path. */
export function source(path) {
    return readFileSync(new URL(`../../${path}`, import.meta.url), "utf8");
}

const MODELS = { SPEECH: ["speech", "SPEECH_EN_"], LAUGHTER: ["laughter", "LAUGHTER_SYNTHETIC_"] };

/** The streams of tests/conformance/vectors.c, by name: their steps. */
export function vectors() {
    const found = {};
    const streams = source("tests/conformance/vectors.c").matchAll(/conformance_step_t (\w+)_steps\[\] = \{([^;]*)\};/g);
    for (const [, name, body] of streams) {
        found[name] = [...body.matchAll(/(PUSH|CANCEL|AGAIN|END|ARTICULATION)(?:\(([^)]*)\))?/g)].map(([, kind, inner = ""]) => {
            const [first, second, third] = inner.split(/,\s*/);
            if (kind !== "PUSH") return { kind, frames: Number(first), milliseconds: Number(second) };
            const [model, prefix] = MODELS[first];
            return { kind, model, label: second.slice(prefix.length), milliseconds: Number(third) };
        });
    }
    return found;
}

/** The frames of a file such as tests/conformance/frames.txt, by the names that it has. */
export function framesOf(path) {
    const found = {};
    let frames;
    for (const line of source(path).trimEnd().split("\n")) {
        const values = line.split(" ");
        if (values[0] === "and") frames.push(...new Array(Number(values[1])).fill(frames.at(-1)));
        else if (/^-?\d/.test(line)) frames.push(values.map(Number));
        else frames = found[line] = [];
    }
    return found;
}

/** The first difference between frames, in a sentence; nothing for frames that are the same. */
export function difference(found, wanted) {
    for (let frame = 0; frame < Math.min(found.length, wanted.length); frame++) {
        const channel = wanted[frame].findIndex((value, k) => found[frame][k] !== value);
        if (channel >= 0) {
            return `frame ${frame}, channel ${channel} is ${found[frame][channel]}, not ${wanted[frame][channel]}`;
        }
    }
    return found.length === wanted.length ? "" : `${found.length} frames, not ${wanted.length}`;
}

/** A model of the library as a binary one. */
export function binary(mouth, model) {
    if (model === mouth.models.laughter) return unpack(laughter);
    return blob(mouth.memory.bytes.buffer, model.at);
}

/** The frames as arrays. */
export const rows = (frames) => Array.from(frames, (faps) => [...faps]);
export const REST = new Array(13).fill(0);
export const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
/** Puts the names of a class's members that its types declare beside those that its prototype has, and `own`. */
export function assertTyped(file, name, prototype, own = []) {
    const inherited = /^(constructor|(add|remove)EventListener|(connected|disconnected|adopted)Callback)$/;
    const [types] = readFileSync(`${folder}/${file}.d.ts`, "utf8").match(new RegExp(`export class ${name}\\b[^]*?\\n\\}`));
    const typed = [...types.matchAll(/^    (?:get |set |readonly )?(\w+)(?:<[^(]*>)?[(:]/gm)].map(([, found]) => found);
    const has = Object.getOwnPropertyNames(prototype).concat(own);
    const [declared, found] = [typed, has].map((names) => [...new Set(names)].filter((one) => !inherited.test(one)).sort());
    assert.deepEqual(declared, found, name);
}

/** Each call must be refused by an error of one of `kinds`, in a sentence of its own of at most `most` characters. */
export function refused(calls, most = 200, kinds = ["LabialError", "TypeError", "RangeError"]) {
    for (const call of calls) {
        assert.throws(call, (error) => {
            assert.ok(kinds.includes(error.name), String(error.stack));
            assert.match(error.message, /^[^\n]{8,}$/, error.stack);
            assert.ok(error.message.length <= most, error.stack);
            assert.doesNotMatch(error.message, /undefined \(|Cannot|is not a function|convert|is not iterable/, error.stack);
            return true;
        }, call.toString());
    }
}
