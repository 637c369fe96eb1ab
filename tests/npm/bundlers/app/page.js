import "labial/labial-face.js";
import { Labial } from "labial";
import { frames, heard as hears, spoken } from "./lips.js";

const heard = (port) => new Promise((resolve, reject) => {
    port.onmessage = ({ data }) => (Array.isArray(data) ? resolve(data) : reject(new Error(data)));
    port.onerror = (event) => reject(new Error(event.message));
});

async function worklet() {
    const context = new AudioContext();
    await context.audioWorklet.addModule("./worklet.js");
    const lips = new AudioWorkletNode(context, "lips");
    lips.connect(context.destination);
    return heard(lips.port);
}

/** Hears a node: whether labial-hearing's AudioWorklet was found as a file, and what it has heard. */
async function tapped() {
    const names = [];
    const { addModule } = AudioWorklet.prototype;
    AudioWorklet.prototype.addModule = function (address) {
        names.push(String(address).replace(/:.*/, ""));
        return addModule.call(this, address);
    };
    const labial = await Labial.load({ hearing: () => import("labial-hearing") });
    const context = new AudioContext();
    const hearing = await labial.hear(new ConstantSourceNode(context), { context });
    while (hearing.number < 5) {
        await new Promise((resolve) => setTimeout(resolve, 20));
        hearing.at();
    }
    return names;
}

const places = {
    page: () => frames(() => import("labial-laughter")),
    worker: () => heard(new Worker(new URL("./worker.js", import.meta.url), { type: "module" })),
    worklet,
    hearing: () => hears(() => import("labial-hearing")),
    words: () => spoken(() => import("labial-words")),
    element: async () => document.querySelector("labial-face").shadowRoot.querySelectorAll("path").length,
    tapped,
};
window.results = {};
for (const [place, run] of Object.entries(places)) {
    run().then((result) => { window.results[place] = result; }, (error) => { window.results[place] = String(error); });
}
