// The scripts as they are packed: node strip.mjs FOLDER SCRIPT... writes them without comments and indentation, by a third
// smaller. The comments begin their lines; index.d.ts keeps those that users need. A script with a text of
// several lines keeps its indentation.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

const [, , folder, ...scripts] = process.argv;
for (const path of scripts) {
    const text = readFileSync(path, "utf8");
    const whole = /`[^`]*\n[^`]*`/.test(text.replace(/`[^`\n]*`/g, "")); // its lines are not all lines of code
    const code = text.replace(/^[ \t]*\/\*\*[^]*?\*\/\n/gm, "").replace(/^[ \t]*\/\/.*\n/gm, "");
    writeFileSync(join(folder, basename(path)), whole ? code : code.replace(/^\s+/gm, ""));
}
