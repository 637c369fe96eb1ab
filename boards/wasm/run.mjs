// Runs an image that was built for WebAssembly: node run.mjs IMAGE.wasm. Its text goes to the standard output, and what
// main() returns becomes the exit status; a trap is 99, like a processor fault on the other boards.
import { readFile } from "node:fs/promises";

class Exit extends Error {
    constructor(status) {
        super();
        this.status = status;
    }
}

const text = [];
let status;
try {
    const board = {
        put: (character) => text.push(character),
        exit: (code) => {
            throw new Exit(code);
        },
    };
    const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]), { board });
    status = instance.exports.run();
} catch (error) {
    status = error instanceof Exit ? error.status : 99;
    if (!(error instanceof Exit)) text.push(...new TextEncoder().encode(`\nThe processor faulted.\n${error.message}\n`));
}
process.stdout.write(Buffer.from(text));
process.exitCode = status;
