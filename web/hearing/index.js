// Lips from sound alone: what labial.hear() calls. docs/browser.md is the manual; labial's index.d.ts has the calls.
import { Hearing } from "./hearing.js";
import { contextOf, tap } from "./tap.js";

/** The models: each is a WebAssembly module of its own, with the code that hears. */
const MODELS = { small: () => import("./small.js"), large: () => import("./large.js") };
/** What is compiled already, by the model's name. */
const compiled = {};

/** What to hear with `tools`, which are labial's: its own sources would be another copy. */
export async function hear(tools, labial, source, options = {}) {
    const { LabialError, allowed, shown, unpack } = tools;
    const { model = "small", output = "faps", channels = 1, delay, play, exact } = options;
    labial.checkOutput(output);
    if (!Object.hasOwn(MODELS, model)) {
        throw new LabialError(`${shown(model)} is no model of hearing: ${Object.keys(MODELS).join(", ")}`);
    }
    const context = contextOf(tools, source ?? null, options.context);
    const code = await (compiled[model] ??= allowed(module(model, unpack)).catch((error) => {
        delete compiled[model]; // so that it can be tried again
        throw error;
    }));
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

async function module(model, unpack) {
    const { default: text } = await MODELS[model]();
    return WebAssembly.compile(unpack(text));
}
