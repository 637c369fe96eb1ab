// What is drawn, without a page: the shape of the lips, the moment that is drawn, and the element's types.
import assert from "node:assert/strict";
import test from "node:test";
import { Labial, REST, assertTyped, heard, load, source } from "./setup.mjs";

const { CHANNELS, faceFrame, follow, mouthShape } = await load("/mouth.js");
const { LabialMouth } = await load("/labial-mouth.js");
const { attach } = await load("/attach.js");
const labial = await Labial.load();
const ARKIT = ["jawOpen", "mouthFunnel", "mouthPucker", "mouthClose"];

/** A scene of three.js, as far as attach() looks: meshes with shapes of these names. */
function scene(...meshes) {
    const nodes = meshes.map((names) => ({
        morphTargetDictionary: Object.fromEntries(names.map((name, i) => [name, i])), morphTargetInfluences: names.map(() => 0),
    }));
    return { nodes, traverse: (visit) => [{}, ...nodes].forEach(visit) };
}

/** The line that is drawn between closed lips, in drawing units. */
const LINE = 1.8;

test("lips are drawn closed in p, b, m and at rest, and open in vowels", () => {
    const segments = labial.read(source("examples/kiosk/welcome.lab"));
    const track = labial.render(segments);
    const gaps = Array.from(track, (faps) => mouthShape(faps).gap);
    assert.equal(mouthShape(REST).gap, 0);
    for (const { start, end, label } of segments) {
        const own = gaps.slice(Math.round(start * track.fps), Math.round(end * track.fps));
        if (["P", "B", "M"].includes(label)) assert.ok(Math.min(...own) < LINE, `${label} at ${start}: ${own}`);
        if (["AA", "AE", "AY"].includes(label)) assert.ok(Math.max(...own) > 4 * LINE, `${label} at ${start}: ${own}`);
    }
});

test("of a face, lips close in p, b, m, and teeth stand on the lower lip in f and v", () => {
    const teeth = (faps) => faceFrame(faps)[3] - faps[3];
    assert.equal(teeth(REST), 0);
    const words = "B IY F AA R . F AY V . M AH M . P AA P . AA V ER".split(" ");
    const segments = words.map((label, i) => ({ start: 0.12 * i, end: 0.12 * i + 0.12, label: label === "." ? "" : label }));
    const track = labial.render(segments);
    for (const { start, end, label } of segments) {
        const frames = Array.from({ length: 7 }, (_, i) => track.at(start + (end - start) * i / 6).slice());
        const gaps = frames.map((faps) => mouthShape(faceFrame(faps)).gap);
        if (["P", "B", "M"].includes(label)) assert.ok(Math.min(...gaps) < LINE, `${label}: ${gaps}`);
        if (["F", "V"].includes(label)) assert.ok(Math.min(...frames.map(teeth)) < -100, `${label} at ${start}`);
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
    assertTyped("labial-mouth", "LabialMouth", LabialMouth.prototype);
});

test("an avatar's shapes are found by all names that are known of them", () => {
    const weights = { arkit: { jawOpen: 0.4, mouthSmileLeft: 0.2 }, oculus: { PP: 0.3, ih: 0.5 }, vrm: { aa: 0.6, ou: 0.1 } };
    const cases = [
        ["arkit", ["Head.JawOpen", "mouth_Close", "MouthFunnel", "mouthPucker", "mouthSmile_L", "aa"], [0.4, 0, 0, 0, 0.2, 0]],
        ["oculus", "viseme_sil viseme_PP viseme_FF viseme_TH viseme_DD viseme_kk viseme_SS viseme_nn viseme_I".split(" "),
            [0, 0.3, 0, 0, 0, 0, 0, 0, 0.5]],
        ["arkit", [...ARKIT, "mouthSmile.R", "Head.mouthSmile.L"], [0.4, 0, 0, 0, 0, 0.2]], // as Blender names sides
        ["vrm", ["Fcl_ALL_Joy", "Fcl_MTH_A", "Fcl_MTH_I", "Fcl_MTH_U"], [0, 0.6, 0, 0.1]],
    ];
    for (const [output, names, wanted] of cases) {
        const found = scene(names, ["other", ...names]);
        const head = attach(found);
        assert.deepEqual([head.output, head.meshes], [output, found.nodes]);
        head.show(weights[output]);
        assert.deepEqual(found.nodes.map((mesh) => mesh.morphTargetInfluences), [wanted, [0, ...wanted]]);
        head.rest();
        assert.deepEqual(found.nodes[1].morphTargetInfluences, [0, ...wanted].fill(0));
        head.source = labial.render([{ start: 0, end: 1, label: output === "oculus" ? "M" : "AA" }], { output });
        head.update(0.5);
        assert.ok(Math.max(...found.nodes[0].morphTargetInfluences) > 0.1, output);
    }
});

test("a head whose jaw hardly opens is moved by its visemes", () => {
    const shape = (x) => ({ count: 2, getX: (i) => x * i, getY: () => 0, getZ: () => 0 });
    for (const [jaw, wanted] of [[0, "vrm"], [0.4, "vrm"], [0.5, "arkit"], [-3, "arkit"]]) {
        const names = [...ARKIT, "Fcl_MTH_A", "Fcl_MTH_I", "Fcl_MTH_U"];
        const found = scene(names, names);
        found.nodes[1].geometry = { morphAttributes: { position: names.map((name) => shape(name === "Fcl_MTH_A" ? 1 : name === "jawOpen" ? jaw : 9)) } };
        found.nodes[0].geometry = { morphAttributes: { position: names.map(() => shape(0)) } }; // eyes
        assert.equal(attach(found).output, wanted, `jaw ${jaw}`);
    }
    assert.equal(attach(scene([...ARKIT, "aa"])).output, "arkit");
});

test("what is no avatar, and one that nothing is known of, is an error", () => {
    const errors = [[{}, TypeError, /^the avatar is none/], [scene(), undefined, /has no shapes/],
        [scene(["smile", "beak"]), undefined, /neither ARKit's nor visemes: smile, beak; labial fit/],
        [scene(["jawOpen", "grin"]), undefined, /too few of ARKit's or of visemes: jawOpen, grin; .* { output: "arkit" } moves/]];
    for (const [avatar, kind, message] of errors) assert.throws(() => attach(avatar), { message, ...(kind && { name: kind.name }) });
    const head = attach(scene(["smile", "beak"]), { output: labial.rig({ labial: "rig", name: "bird", outputs: { beak: {
        weights: REST, gain: 4096, neutral: 0, minimum: 0, maximum: 1000, invert: 0, contact: 0, closed: 0 } } }) });
    head.show({ beak: 0.5, tail: 1 });
    assert.deepEqual(head.meshes[0].morphTargetInfluences, [0, 0.5]);
    assert.throws(() => { head.source = Promise.resolve(); }, { name: "TypeError", message: /^the source is .*a promise resolves to$/ });
    for (const output of ["arkitt", "oculus"]) {
        assert.throws(() => attach(scene(ARKIT), { output }), { name: "LabialError", message: /^the avatar has none of the shapes/ });
    }
});

test("a source that moves nothing of a head is an error", () => {
    const head = attach(scene(ARKIT));
    const said = [{ start: 0, end: 1, label: "AA" }];
    for (const output of ["faps", "vrm"]) {
        assert.throws(() => { head.source = labial.render(said, { output }); },
            { name: "TypeError", message: /^the source's output is (faps|vrm), and the head takes arkit/ });
    }
    head.source = labial.render(said, { output: "arkit" });
    assert.throws(() => head.update(), { name: "TypeError", message: /head\.audio/ });
});

test("a mouth comes to rest behind the end of its sound, and opens again when the sound is played again", ({ mock }) => {
    let now = 7000;
    mock.method(performance, "now", () => now);
    const found = scene(ARKIT);
    const head = attach(found);
    const track = labial.render([{ start: 0, end: 0.3, label: "AA" }], { output: "arkit" });
    const open = () => Math.max(...found.nodes[0].morphTargetInfluences);
    const sound = { currentTime: 0.3, ended: true };
    Object.assign(head, { source: track, audio: sound });
    head.update();
    assert.ok(open() > 0.1 && heard(sound) === 0.3);
    now += 100;
    assert.ok(Math.abs(heard(sound) - 0.4) < 1e-9);
    now += 1000;
    head.update();
    assert.equal(open(), 0);
    Object.assign(sound, { currentTime: 0.2, ended: false });
    head.update();
    assert.ok(open() > 0.1 && heard(sound) === 0.2);
    Object.assign(sound, { currentTime: 0.3, ended: true });
    assert.equal(heard(sound), 0.3);
});

test("a head without a source eases to rest, also if nobody draws it", ({ mock }) => {
    let now = 7000;
    let due;
    mock.method(performance, "now", () => now);
    mock.method(globalThis, "setTimeout", (call) => { due = call; });
    const found = scene(ARKIT);
    const head = attach(found);
    const open = () => found.nodes[0].morphTargetInfluences[0];
    const after = (milliseconds) => {
        now += milliseconds;
        head.update();
        return Math.round(1000 * open()) / 1000;
    };
    const speak = () => {
        head.source = { at: () => ({ jawOpen: 0.4 }) };
        head.update();
        head.source = null;
    };
    speak();
    assert.deepEqual([0, 50, 100, 100].map(after), [0.4, 0.3, 0.1, 0]);
    speak();
    assert.equal(open(), 0.4);
    due();
    assert.equal(open(), 0);
    speak();
    head.show({ jawOpen: 0.7 }); // which counts from then on
    due();
    assert.equal(after(100), 0.7);
    speak();
    head.rest();
    assert.equal(after(100), 0);
});
