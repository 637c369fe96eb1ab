// Lips from sound alone: what labial.hear() calls. docs/browser.md is the manual; labial's index.d.ts has the calls.
import { Hearing } from "./hearing.js";
import { contextOf, tap } from "./tap.js";

/** The models: each is a WebAssembly module of its own, with the code that hears. */
const MODELS = { small: () => import("./small.js"), large: () => import("./large.js") };
/** What is compiled already, by the model's text. */
const compiled = new Map();

/** What to hear with `tools`, which are labial's: its own sources would be another copy. */
export async function hear(tools, labial, source, options = {}) {
    const { LabialError, allowed, shown } = tools;
    const { model = "small", output = "faps", channels = 1, delay, play, exact } = options;
    labial.checkOutput(output);
    const given = Object.hasOwn(MODELS, model) ? MODELS[model] : model;
    if (given == null || !["function", "object"].includes(typeof given)) {
        throw new LabialError(`${shown(model)} is no model of hearing: ${Object.keys(MODELS).join(", ")}`);
    }
    const context = contextOf(tools, source ?? null, options.context);
    const code = await allowed(module(tools, given));
    const wasm = (await WebAssembly.instantiate(code, {})).exports;
    const listened = source == null ? null : await tap(tools, context, source, play);
    try {
        const sampleRate = listened?.sampleRate ?? options.sampleRate;
        const settings = { sampleRate, channels: listened ? 1 : channels, output, context, tap: listened, delay, exact };
        return new Hearing(tools, labial, wasm, settings);
    } catch (error) {
        listened?.close();
        throw error;
    }
}

/** The compiled module of a model: of a module with its text, what loads one, or a promise of it. */
async function module({ LabialError, shown, unpack }, model) {
    let text = await (typeof model === "function" ? model() : model);
    while (text?.default) text = text.default; // a module, or one inside another as CommonJS has it
    if (typeof text !== "string") throw new LabialError(`${shown(text)} is no model of hearing`);
    if (!compiled.has(text)) compiled.set(text, WebAssembly.compile(unpack(text)));
    return compiled.get(text).catch((error) => {
        compiled.delete(text); // so that it can be tried again
        throw error;
    });
}
