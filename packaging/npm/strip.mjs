// The scripts as they are packed: node strip.mjs FOLDER SCRIPT... writes them without comments and indentation, by a third
// smaller. A comment is what stands on lines of its own, or behind `;`, `,`, `{` or `)` and a blank up to the line's end,
// which no text in these scripts has; index.d.ts keeps those that users need. A text of several lines stays as it is.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

const [, , folder, ...scripts] = process.argv;
for (const path of scripts) {
    const code = readFileSync(path, "utf8")
        .replace(/^[ \t]*(\/\*\*[^]*?\*\/|\/\/.*)\n/gm, "")
        .replace(/(?<=[;,{)]) (\/\/ .*|\/\*.*\*\/)$/gm, "")
        .replace(/`[^`]*`|^\s+/gm, (found) => (found.startsWith("`") ? found : ""));
    writeFileSync(join(folder, basename(path)), code);
}
