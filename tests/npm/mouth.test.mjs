// What is drawn, without a page: the shape of the lips, the moment that is drawn, and the element's types.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import test from "node:test";
import { Labial, folder, source } from "./setup.mjs";

const { CHANNELS, follow, mouthShape } = await import(pathToFileURL(`${folder}/mouth.js`));
const { LabialMouth } = await import(pathToFileURL(`${folder}/labial-mouth.js`));
const labial = await Labial.load();

/** The line that is drawn between closed lips, in drawing units. */
const LINE = 1.8;

test("lips are drawn closed in p, b, m and at rest, and open in vowels", () => {
    const segments = labial.read(source("examples/kiosk/welcome.lab"));
    const track = labial.render(segments);
    const gaps = Array.from(track, (faps) => mouthShape(faps).gap);
    assert.equal(mouthShape(new Array(13).fill(0)).gap, 0);
    for (const { start, end, label } of segments) {
        const own = gaps.slice(Math.round(start * track.fps), Math.round(end * track.fps));
        if (["P", "B", "M"].includes(label)) assert.ok(Math.min(...own) < LINE, `${label} at ${start}: ${own}`);
        if (["AA", "AE", "AY"].includes(label)) assert.ok(Math.max(...own) > 4 * LINE, `${label} at ${start}: ${own}`);
    }
});

test("whatever the frame, the drawing has numbers and lips do not pass through each other", () => {
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    for (let i = 0; i < 500; i++) {
        const { paths, gap, jaw } = mouthShape(CHANNELS.map(() => Math.round((random() - 0.5) * 3720)));
        assert.ok(Object.values(paths).every((path) => !/NaN|Infinity|undefined/.test(path)) && gap >= 0 && jaw >= -4);
    }
});

test("each channel moves what its FAP names, to its side", () => {
    const numbers = (path) => path.match(/-?[0-9.]+/g).map(Number);
    const neutral = numbers(mouthShape(CHANNELS.map(() => 0)).paths.outer);
    const moved = (name) => {
        const outer = numbers(mouthShape(CHANNELS.map((one) => (one === name ? 300 : 0))).paths.outer);
        return outer.map((value, i) => value - neutral[i]); // x, y along the upper lip, then back along the lower one
    };
    const end = 2 * 48; // the left corner's x, behind 48 points
    assert.ok(moved("fap53")[end] > 10 && moved("fap53")[0] === 0, "the face's left is right on the screen");
    assert.ok(moved("fap54")[0] < -10 && moved("fap54")[end] === 0);
    assert.ok(moved("fap59")[end + 1] < -10 && moved("fap60")[1] < -10, "corners go up");
    assert.ok(moved("fap51")[end / 2 + 1] > 10, "the upper lip goes down");
    assert.ok(moved("fap52")[3 * end / 2 + 3] < -5, "the lower lip goes up");
    assert.ok(mouthShape(CHANNELS.map((one) => (one === "fap3" ? 300 : 0))).jaw > 10);
});

test("what is drawn is never farther from what is heard than half a period, and comes nearer", () => {
    for (const off of [-1, -0.02, -0.004, 0, 0.004, 0.02, 1]) {
        const drawn = follow(5 + off, 5, 0.02);
        assert.ok(Math.abs(drawn - 5) <= 0.01 + 1e-12 && Math.abs(drawn - 5) <= Math.abs(off));
    }
});

test("the element's types name what it has", () => {
    const types = readFileSync(`${folder}/labial-mouth.d.ts`, "utf8");
    const typed = new Set([...types.matchAll(/^    (?:get |set |readonly )?(\w+)[(:]/gm)].map(([, name]) => name));
    const own = Object.getOwnPropertyNames(LabialMouth.prototype);
    const ours = own.filter((name) => !["constructor", "connectedCallback", "disconnectedCallback"].includes(name));
    assert.deepEqual([...typed].sort(), ours.sort());
});
