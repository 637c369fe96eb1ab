// The scripts as they are packed: node strip.mjs FOLDER SCRIPT... writes them without comments and indentation, by a third
// smaller. The comments begin their lines; index.d.ts keeps those that users need.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

const [, , folder, ...scripts] = process.argv;
for (const path of scripts) {
    const text = readFileSync(path, "utf8");
    if (/`[^`]*\n[^`]*`/.test(text.replace(/`[^`\n]*`/g, ""))) throw new Error(`${path}: a text of several lines`);
    writeFileSync(join(folder, basename(path)), text
        .replace(/^[ \t]*\/\*\*[^]*?\*\/\n/gm, "")
        .replace(/^[ \t]*\/\/.*\n/gm, "")
        .replace(/^\s+/gm, ""));
}
