// Writes the generated files of the packages:
//
//     node assemble.mjs scripts FOLDER SCRIPT...      without comments and indentation, by a third smaller
//     node assemble.mjs data FILE WASM NOTICE         a file of bytes as a script's default export, below a notice
//     node assemble.mjs model FILE WASM NAME NOTICE   the model that a module exports, as a binary one, in the same way
//     node assemble.mjs faces FOLDER DESCRIPTION...   the types of all faces' weights
//     node assemble.mjs commonjs FOLDER               index.cjs and *.d.cts, from what is in the folder by then
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { constants, deflateRawSync } from "node:zlib";
import { binary } from "./layout.mjs";
import { unpack } from "./unpack.js";

const read = (path) => readFileSync(path, "utf8");

/** A comment is what stands on lines of its own, or behind `;`, `,`, `{` or `)` and a blank up to the line's end, which no
 * text in these scripts has; index.d.ts keeps those that users need. A text of several lines stays as it is. */
function scripts(folder, ...paths) {
    for (const path of paths) {
        const code = read(path)
            .replace(/^[ \t]*(\/\*\*[^]*?\*\/|\/\/.*)\n/gm, "")
            .replace(/(?<=[;,{)]) (\/\/ .*|\/\*.*\*\/)$/gm, "")
            .replace(/`[^`]*`|^\s+/gm, (found) => (found.startsWith("`") ? found : ""));
        writeFileSync(join(folder, basename(path)), code);
    }
}

/** A raw deflate stream, split at multiples of 512 bytes where new codes save bytes: 1 % shorter than zlib's. */
function deflated(bytes) {
    const step = 512;
    const steps = Math.ceil(bytes.length / step);
    const best = [{ size: 0, parts: [] }];
    for (let end = 1; end <= steps; end++) {
        const finishFlush = end === steps ? constants.Z_FINISH : constants.Z_SYNC_FLUSH;
        for (let begin = Math.max(0, end - 48); begin < end; begin++) {
            const options = { level: 9, memLevel: 9, finishFlush };
            if (begin) options.dictionary = bytes.subarray(Math.max(0, begin * step - 32768), begin * step);
            const part = deflateRawSync(bytes.subarray(begin * step, end * step), options);
            const size = best[begin].size + part.length;
            if (!(best[end]?.size <= size)) best[end] = { size, parts: [...best[begin].parts, part] };
        }
    }
    return Buffer.concat(best[steps].parts);
}

/** The input of unpack.js. Bundlers keep a notice that begins with an exclamation mark. */
function packed(file, bytes, notice) {
    const text = deflated(bytes).toString("base64");
    if (!Buffer.from(unpack(text)).equals(Buffer.from(bytes))) throw new Error(`${file}: not what was packed`);
    writeFileSync(file, `/*! ${notice} */\nexport default "${text}";\n`);
}

async function model(file, wasm, name, notice) {
    const { instance } = await WebAssembly.instantiate(readFileSync(wasm), {});
    packed(file, binary(instance.exports.memory.buffer, instance.exports[name].value), notice);
}

function faces(folder, ...paths) {
    const rows = paths.map((path) => {
        const names = [...read(path).matchAll(/^\[output\.(\w+)\]/gm)].map(([, name]) => `"${name}"`);
        return `    ${basename(path, ".toml")}:\n        | ${names.join("\n        | ")};\n`;
    });
    writeFileSync(join(folder, "faces.d.ts"), `/** The names of each face's weights. */\nexport interface Faces {\n${rows.join("")}}\n` +
        "\nexport type Face = keyof Faces;\n");
}

/** One script of the modules, each a function that returns what it exports. Node's require() cannot take an ES module before
 * version 20.19; a bundler never sees this file (the condition "module" in package.json). */
function commonjs(folder) {
    const done = new Map();
    const add = (name) => {
        if (done.has(name)) return;
        const code = read(join(folder, `${name}.js`));
        if (code.startsWith("/*!")) { // data, of which there is one copy
            const path = `require("node:path").join(__dirname, "${name}.js")`;
            done.set(name, `const in_${name} = require("node:fs").readFileSync(${path}, "utf8").split('export default "')[1].slice(0, -3);\n`);
            return;
        }
        const exported = [];
        const take = (all, from) => {
            add(from);
            return `const ${all} = in_${from};\n`;
        };
        const body = code
            .replace(/^import (?:\* as )?(\w+|\{.*\}) from "\.\/(\w+)\.js";\n/gm, (_, all, from) => take(all, from))
            .replace(/^export \{(.*)\};\n/gm, (_, names) => (exported.push(names), ""))
            .replace(/^export (?=(?:async )?(?:const|class|function\*?) (\w+))/gm, (_, one) => (exported.push(one), ""));
        if (/^(import|export)\b/m.test(body)) throw new Error(`${name}.js: an import or export that is not known`);
        done.set(name, `const in_${name} = (() => {\n${body}return { ${exported.join(", ")} };\n})();\n`);
    };
    add("index");
    writeFileSync(join(folder, "index.cjs"), `"use strict";\n${[...done.values()].join("")}module.exports = in_index;\n`);
    for (const name of ["index", "faces"].filter((one) => existsSync(join(folder, `${one}.d.ts`)))) {
        writeFileSync(join(folder, `${name}.d.cts`), read(join(folder, `${name}.d.ts`)).replaceAll('"./faces.js"', '"./faces.cjs"'));
    }
}

const [, , what, ...rest] = process.argv;
const data = (file, wasm, notice) => packed(file, readFileSync(wasm), notice);
await { scripts, data, model, faces, commonjs }[what](...rest);
