// Measures the npm package under node: node bench/npm.mjs FOLDER prints the microseconds per frame of each way, the best of
// RUNS runs, and what the first run took, before the engine compiled it well, as JSON. The input is that of bench/runtime.py.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const SENTENCE = [["SIL", 120], ["M", 70], ["AY", 160], ["B", 60], ["EY", 110], ["B", 55], ["IY", 90], ["M", 65],
    ["EY", 120], ["B", 50], ["IY", 80], ["HH", 60], ["AE", 110], ["P", 75], ["IY", 35]];
const TIMES = 100;
const RUNS = 10;

const { Labial } = await import(pathToFileURL(resolve(process.argv[2], "index.js")));
const labial = await Labial.load();
const phonemes = Array.from({ length: TIMES }, () => SENTENCE).flat();
let end = 0;
const segments = phonemes.map(([label, milliseconds]) => ({ start: end, end: (end += milliseconds / 1000), label }));

/** Frames of an utterance, one by one. */
function ticked(output) {
    const stream = labial.stream({ output });
    phonemes.forEach(([label, milliseconds]) => stream.push(label, milliseconds));
    stream.end();
    let frames = 0;
    while (!stream.done) frames += stream.tick() ? 1 : 0;
    stream.free();
    return frames;
}

/** Times of an utterance at which it is looked at, 60 per second. */
function shown(output) {
    const track = labial.render(segments, { output, exact: true });
    const begin = performance.now();
    const times = 60 * track.duration;
    for (let i = 0; i < times; i++) track.at(i / 60);
    return (1000 * (performance.now() - begin)) / times;
}

const runs = {
    "rendered whole": () => labial.render(segments, { exact: true }).length,
    "one by one": () => ticked("faps"),
    "one by one, with ARKit's blendshapes": () => ticked("arkit"),
};
const found = {};
for (const [way, run] of Object.entries(runs)) {
    const taken = Array.from({ length: RUNS }, () => {
        const begin = performance.now();
        const frames = run();
        return (1000 * (performance.now() - begin)) / frames;
    });
    if (way === "rendered whole") found["rendered whole, the first time"] = taken[0];
    found[way] = Math.min(...taken);
}
found["shown, with ARKit's blendshapes"] = Math.min(...Array.from({ length: RUNS }, () => shown("arkit")));
console.log(JSON.stringify(Object.fromEntries(Object.entries(found).map(([way, us]) => [way, Number(us.toFixed(2))]))));
