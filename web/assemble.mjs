// Writes the generated files of the packages:
//
//     node assemble.mjs scripts FOLDER SCRIPT...      without comments and indentation, by a third smaller
//     node assemble.mjs text FILE SCRIPT              a script's text as another script's default export
//     node assemble.mjs data FILE WASM NOTICE         a file of bytes as a script's default export, below a notice
//     node assemble.mjs model FILE WASM NAME NOTICE   the model that a module exports, as a binary one, in the same way
//     node assemble.mjs table FILE JSON               the table of services, without what only readers of it need
//     node assemble.mjs faces FOLDER DESCRIPTION...   the types of all faces' weights
//     node assemble.mjs types FOLDER TYPES            the types of each module that TYPES declares
//     node assemble.mjs frameworks FOLDER             the types of the elements in React, Svelte and Vue
//     node assemble.mjs readme FILE README NAME       the part of README that is about the package of this name
//     node assemble.mjs licence FILE LICENSE NOTICE NAME...   LICENSE, and NOTICE on the models of these names
//     node assemble.mjs manifest FOLDER PACKAGES NAME VERSION   package.json, and index.d.ts where PACKAGES has it
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { binary } from "./layout.mjs";
import { unpack } from "./unpack.js";

const read = (path) => readFileSync(path, "utf8");

/** A comment is what stands on lines of its own, or behind `;`, `,`, `{` or `)` and a blank up to the line's end, which no
 * text in these scripts has; index.d.ts keeps those that users need. A text of several lines stays as it is. A source map
 * has the script as it was written. */
function scripts(folder, ...paths) {
    for (const path of paths) {
        const name = basename(path);
        const written = read(path);
        const marked = written.split("\n").map((line, i) => `${line}\0${i}`).join("\n"); // each line with its number
        const kept = marked
            .replace(/^[ \t]*(\/\*(?!!)[^]*?\*\/|\/\/.*?)\0\d+\n/gm, "")
            .replace(/(?<=[;,{)]) (\/\/ .*?|\/\*.*\*\/)(?=\0)/gm, "")
            .replace(/`[^`]*`|^\s+(?=\S)/gm, (found) => (found.startsWith("`") ? found : ""))
            .split("\n").filter((line) => !/^\s*\0/.test(line));
        const numbers = kept.map((line) => Number(line.split("\0")[1]));
        const map = { version: 3, file: name, sources: [`source/${name}`], sourcesContent: [written], names: [],
            mappings: numbers.map((line, i) => `AA${signed(line - (numbers[i - 1] ?? 0))}A`).join(";") };
        const code = kept.map((line) => line.split("\0")[0]).join("\n");
        writeFileSync(join(folder, name), `${code}\n//# sourceMappingURL=${name}.map\n`);
        writeFileSync(join(folder, `${name}.map`), JSON.stringify(map));
    }
}

function text(file, script) {
    const code = read(script).replace(/^\/\/# sourceMappingURL=.*\n/m, "");
    writeFileSync(file, `export default ${JSON.stringify(code)};\n`);
}

/** A number of a source map: base64 digits of five bits, the lowest first, the sign in the lowest bit. */
function signed(value) {
    let text = "";
    let rest = value < 0 ? (-value << 1) | 1 : value << 1;
    do {
        text += "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"[(rest & 31) | (rest > 31 ? 32 : 0)];
        rest >>= 5;
    } while (rest);
    return text;
}

/** Bytes as an .xz file. CMake, which runs this, has the means. */
function compressed(bytes) {
    const folder = mkdtempSync(join(tmpdir(), "labial-"));
    try {
        writeFileSync(join(folder, "bytes"), bytes);
        writeFileSync(join(folder, "pack.cmake"),
            "file(ARCHIVE_CREATE OUTPUT bytes.xz PATHS bytes FORMAT raw COMPRESSION XZ COMPRESSION_LEVEL 9)\n");
        execFileSync(process.env.CMAKE ?? "cmake", ["-P", "pack.cmake"], { cwd: folder });
        return readFileSync(join(folder, "bytes.xz"));
    } finally {
        rmSync(folder, { recursive: true });
    }
}

/** The input of unpack.js. Bundlers keep a notice that begins with an exclamation mark. */
function packed(file, bytes, notice) {
    const text = compressed(bytes).toString("base64");
    if (!Buffer.from(unpack(text)).equals(Buffer.from(bytes))) throw new Error(`${file}: not what was packed`);
    writeFileSync(file, `/*! ${notice} */\nexport default "${text}";\n`);
}

function table(file, json) {
    const { letters, pairs, visemes, services } = JSON.parse(read(json));
    for (const service of Object.values(services)) delete service.from;
    writeFileSync(file, `export default ${JSON.stringify({ letters, pairs, visemes, services })};\n`);
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

function types(folder, path) {
    for (const [, name, text] of read(path).matchAll(/^declare module "labial\/(.+)\.js" \{\n([^]*?)^\}\n/gm)) {
        const own = text.replace(/^ {4}/gm, "").replace(/^global /gm, "declare global ");
        const paths = own.replaceAll(' from "labial"', ' from "./index.js"').replaceAll(' from "labial/', ' from "./');
        writeFileSync(join(folder, `${name}.d.ts`), paths);
    }
}

/** The elements in the templates of frameworks: `import type {} from "labial/react"`, "labial/svelte" or "labial/vue". */
function frameworks(folder) {
    const imports = `import type { LabialFace } from "./labial-face.js";
import type { LabialMouth } from "./labial-mouth.js";
import type { Settings } from "./elements.js";
`;
    const elements = (type) => ["Face", "Mouth"].map((name) => `"labial-${name.toLowerCase()}": ${type(`Labial${name}`)};`);
    const types = {
        elements: `/** What frameworks set on an element, and its events. */
export type Settings<E> = Partial<Pick<E, keyof E & ("audio" | "track" | "stream" | "hearing" | "voice" | "words" | "caption")>> & {
    onended?: (event: Event) => void;
    onlost?: (event: Event) => void;
};
`,
        react: `import type { DetailedHTMLProps, HTMLAttributes } from "react";
${imports}
type Props<E> = DetailedHTMLProps<HTMLAttributes<E>, E> & Settings<E> & { for?: string };

declare module "react" {
    namespace JSX {
        interface IntrinsicElements {
            ${elements((name) => `Props<${name}>`).join("\n            ")}
        }
    }
}
`,
        svelte: `import type { HTMLAttributes } from "svelte/elements";
${imports}
declare module "svelte/elements" {
    interface SvelteHTMLElements {
        ${elements((name) => `HTMLAttributes<${name}> & Settings<${name}> & { for?: string }`).join("\n        ")}
    }
}
`,
        vue: `import type { DefineComponent, HTMLAttributes } from "vue";
${imports}
type Component<E> = DefineComponent<HTMLAttributes & Settings<E> & { for?: string }>;

declare module "vue" {
    interface GlobalComponents {
        ${elements((name) => `Component<${name}>`).join("\n        ")}
    }
}
`,
    };
    for (const [name, text] of Object.entries(types)) {
        const use = name === "elements" ? "" : `// The elements in templates: \`import type {} from "labial/${name}"\`.\n`;
        writeFileSync(join(folder, `${name}.d.ts`), `${use}${text}`);
    }
}

function readme(file, all, name) {
    const part = read(all).split(/^(?=# )/m).find((text) => text.startsWith(`# ${name}\n`));
    if (!part) throw new Error(`${all}: nothing about ${name}`);
    writeFileSync(file, `${part.trimEnd()}\n`);
}

/** The code's licence, then the notices of the models and tables that are in a package, from NOTICE. */
function licence(file, code, notice, ...names) {
    const sections = new Map([...read(notice).matchAll(/^(\S.*):\n\n((?: {4}.*\n|\n)+)/gm)]
        .flatMap(([, title, text]) => title.split(", ").map((name) => [name, text])));
    const inside = [...new Set(names.map((name) => {
        if (!sections.has(name)) throw new Error(`${notice}: nothing about ${name}`);
        return sections.get(name);
    }))];
    const listed = `What the package contains besides that code: ${names.join(", ")}.\n\n`;
    writeFileSync(file, `${read(code)}\n${listed}${inside.map((text) => text.trimEnd()).join("\n\n")}\n`);
}

/** What packages.json says of a package, and what is the same for all. */
function manifest(folder, packages, name, version) {
    const { declares, exports, sideEffects = false, ...own } = JSON.parse(read(packages))[name];
    const main = { types: "./index.d.ts", default: "./index.js" };
    const written = { name, version, ...own, type: "module", main: main.default, types: main.types,
        exports: { ".": main, ...exports, "./package.json": "./package.json" },
        files: ["*.js", "*.js.map", "*.d.ts"], engines: { node: ">=20.19" }, sideEffects };
    writeFileSync(join(folder, "package.json"), `${JSON.stringify(written, null, 2)}\n`);
    if (declares) writeFileSync(join(folder, "index.d.ts"), `${declares.join("\n")}\n`);
}

const [, , what, ...rest] = process.argv;
const data = (file, wasm, notice) => packed(file, readFileSync(wasm), notice);
await { scripts, text, data, table, model, faces, types, frameworks, readme, licence, manifest }[what](...rest);
