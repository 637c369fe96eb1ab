// Words and written characters with their times to phonemes: what labial.words() loads. docs/browser.md is the manual;
// labial's index.d.ts has the calls.
import english from "./english.js";
import { Words } from "./words.js";

/** What is compiled already, and the words of each library: an instance is large. */
let compiled;
const made = new WeakMap();

/** Words for a library, with `tools`, which are labial's: its own sources would be another copy. */
export async function words(tools, labial) {
    const found = made.get(labial) ?? started(tools, labial);
    made.set(labial, found);
    try {
        return await found;
    } catch (error) {
        made.delete(labial); // so that it can be tried again
        throw error;
    }
}

async function started(tools, labial) {
    compiled ??= tools.allowed(WebAssembly.compile(tools.unpack(english))).catch((error) => {
        compiled = undefined;
        throw error;
    });
    const { exports } = await WebAssembly.instantiate(await compiled, {});
    return new Words(tools, labial, exports);
}
