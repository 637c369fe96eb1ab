// Builds the page:
//
//     node build.mjs [FOLDER]
//
// FOLDER, by default `page`, then has all that it needs: index.html, page.js, and COPYING, espeak-ng's licence.
import { build } from "esbuild";
import { copyFileSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { gzipSync } from "node:zlib";

/** What the page speaks: espeak-ng's names of voices, and the first part of their data's names. Add a row, and build. */
const LANGUAGES = [
    { voice: "en-us", data: "en", name: "English", text: "Papa may be by the sea, but mama bakes a big apple pie." },
    { voice: "de", data: "de", name: "Deutsch", text: "Papa mag am Abend bei Mama ein paar Pflaumen probieren." },
    { voice: "es", data: "es", name: "Español", text: "Papá compra pan y miel para mamá en el bonito pueblo." },
    { voice: "fr", data: "fr", name: "Français", text: "Papa apporte un beau bouquet de pivoines à maman." },
    { voice: "it", data: "it", name: "Italiano", text: "Il babbo prepara un piatto di pasta per la mamma." },
    { voice: "hi", data: "hi", name: "हिन्दी", text: "मेरी माँ बाज़ार में पके आम और पपीता बेचती है।" },
];

const own = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const out = process.argv[2] ?? "page";
const espeak = dirname(createRequire(import.meta.url).resolve("@echogarden/espeak-ng-emscripten"));

/** The page's languages and their data: of 24 MB for all that espeak-ng speaks, one or two. The module's script names the
 * files and their places. */
function data() {
    const script = readFileSync(join(espeak, "espeak-ng.js"), "utf8");
    const bytes = readFileSync(join(espeak, "espeak-ng.data"));
    const needed = ["phondata", "phonindex", "phontab", "intonations", ...LANGUAGES.map(({ data }) => `${data}_dict`)];
    const voices = new Set(LANGUAGES.flatMap(({ voice, data }) => [voice, data]));
    const parts = [...script.matchAll(/\{filename:"\/usr\/share\/espeak-ng-data\/([^"]+)",start:(\d+),end:(\d+)\}/g)]
        .map(([, name, start, end]) => ({ name, start: Number(start), length: end - start }))
        .filter(({ name }) => needed.includes(name) || voices.has(name.match(/^lang\/.*\/(.+)$/)?.[1].toLowerCase()));
    const missing = needed.filter((name) => !parts.some((part) => part.name === name));
    if (missing.length) throw new Error(`espeak-ng.data has no ${missing.join(", ")}`);
    const used = Buffer.concat(parts.map(({ start, length }) => bytes.subarray(start, start + length)));
    const base64 = gzipSync(used, { level: 9 }).toString("base64");
    const files = parts.map(({ start, length }) => ({ start, length }));
    return `export const LANGUAGES = ${JSON.stringify(LANGUAGES)}, size = ${bytes.length}, files = ${JSON.stringify(files)}, ` +
        `base64 = "${base64}";`;
}

mkdirSync(out, { recursive: true });
await build({
    entryPoints: [join(own, "page.js")],
    outfile: join(out, "page.js"),
    bundle: true,
    minify: true,
    format: "iife", // browsers load no module from a file
    charset: "utf8",
    target: "es2022",
    legalComments: "inline",
    external: ["module"], // of node, which the page is not
    define: { "import.meta.url": "location.href" },
    plugins: [{
        name: "espeak-ng-data",
        setup(found) {
            found.onResolve({ filter: /^espeak-ng-data$/ }, ({ path }) => ({ path, namespace: "espeak-ng-data" }));
            found.onLoad({ filter: /.*/, namespace: "espeak-ng-data" }, () => ({ contents: data() }));
        },
    }],
});
copyFileSync(join(own, "index.html"), join(out, "index.html"));
copyFileSync(join(espeak, "COPYING"), join(out, "COPYING"));
