import "labial/labial-mouth.js";
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

const places = {
    page: () => frames(() => import("labial-laughter")),
    worker: () => heard(new Worker(new URL("./worker.js", import.meta.url), { type: "module" })),
    worklet,
    hearing: () => hears(() => import("labial-hearing")),
    words: () => spoken(() => import("labial-words")),
    element: async () => document.querySelector("labial-mouth").shadowRoot.querySelectorAll("path").length,
};
window.results = {};
for (const [place, run] of Object.entries(places)) {
    run().then((result) => { window.results[place] = result; }, (error) => { window.results[place] = String(error); });
}
