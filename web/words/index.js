// Words and written characters with their times to phonemes: what labial.words() loads. docs/browser.md is the manual;
// labial's index.d.ts has the calls.
import english from "./english.js";
import { Words } from "./words.js";

/** What is compiled already, and the words of each library. */
let compiled;
const made = new WeakMap();

/** Words for a library, with `tools`, which are labial's: its own sources would be another copy. */
export async function words(tools, labial) {
    compiled ??= WebAssembly.compile(tools.unpack(english)).catch((error) => {
        compiled = undefined; // so that it can be tried again
        throw error;
    });
    const { exports } = await WebAssembly.instantiate(await compiled, {});
    if (!made.has(labial)) made.set(labial, new Words(tools, labial, exports));
    return made.get(labial);
}
