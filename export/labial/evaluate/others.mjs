// Runs what npm's packages for lip-sync make of a sound, for others.py, which describes what goes in and comes out:
//
//     node others.mjs wawa-lipsync NODE_MODULES VISEMES < levels > weights
//     node others.mjs headaudio NODE_MODULES VISEMES < samples > weights
//
// The packages' own files run, unchanged. Of a browser there is only what they use: an analyser that returns levels
// computed before; the two sides of an audio worklet, whose messages arrive at once; and a clock that follows the sound.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const RATE = 48000;
const PER_SECOND = 60;
const BLOCK = 128;
const FFT = 2048;

const [method, folder, list] = process.argv.slice(2);
const visemes = list.split(",");
const input = readFileSync(0);
let now = 0;
Object.defineProperty(globalThis, "performance", { value: { now: () => now } });

/** Weights as wawa-lipsync's example moves those of its avatar, then the same without its smoothing. */
function wawa() {
    const { Lipsync } = createRequire(join(folder, "any.js"))("wawa-lipsync");
    let row = 0;
    const analyser = {
        fftSize: 0,
        get frequencyBinCount() {
            return this.fftSize / 2;
        },
        getByteFrequencyData(levels) {
            levels.set(input.subarray(row * levels.length, (row + 1) * levels.length));
        },
    };
    globalThis.window = {
        AudioContext: class {
            sampleRate = RATE;
            createAnalyser() {
                return analyser;
            }
        },
    };
    const lipsync = new Lipsync();
    if (analyser.fftSize !== FFT) throw new Error(`it analyses ${analyser.fftSize} samples instead of ${FFT}`);
    const rows = input.length / (FFT / 2);
    const weights = new Float32Array(rows * 2 * visemes.length);
    const smooth = new Float64Array(visemes.length);
    for (; row < rows; row++) {
        now = (row * 1000) / PER_SECOND;
        lipsync.processAudio();
        const slow = lipsync.state === "vowel" ? 0.5 : 1;
        visemes.forEach((name, k) => {
            const shown = `viseme_${name}` === lipsync.viseme;
            smooth[k] += (shown ? 1 - smooth[k] : -smooth[k]) * slow * (shown ? 0.4 : 0.2);
            weights[row * 2 * visemes.length + k] = smooth[k];
            weights[(row * 2 + 1) * visemes.length + k] = shown ? 1 : 0;
        });
    }
    return weights;
}

/** What HeadAudio's node reports, 60 times a second, while its worklet hears the sound. */
async function headaudio() {
    const registered = {};
    let pending;
    class Port {
        onmessage = null;
        postMessage(data) {
            this.other.onmessage?.({ data });
        }
    }
    globalThis.sampleRate = RATE;
    globalThis.registerProcessor = (name, type) => (registered[name] = type);
    globalThis.AudioWorkletProcessor = class {
        port = pending;
    };
    globalThis.AudioWorkletNode = class {
        constructor(context, name, options) {
            this.port = new Port();
            pending = new Port();
            this.port.other = pending;
            pending.other = this.port;
            this.processor = new registered[name](options);
        }
    };
    globalThis.fetch = async (path) => new Response(readFileSync(path));
    const files = join(folder, "@met4citizen", "headaudio", "dist");
    await import(pathToFileURL(join(files, "headworklet.min.mjs")));
    const { HeadAudio } = await import(pathToFileURL(join(files, "headaudio.min.mjs")));
    const node = new HeadAudio({ sampleRate: RATE });
    await node.loadModel(join(files, "model-en-mixed.bin"));
    const parameters = {};
    for (const { name, defaultValue } of node.processor.constructor.parameterDescriptors)
        parameters[name] = new Float32Array([defaultValue]);

    const samples = new Float32Array(input.buffer.slice(input.byteOffset, input.byteOffset + input.length));
    const rows = Math.ceil((samples.length * PER_SECOND) / RATE);
    const weights = new Float32Array(rows * visemes.length);
    const present = new Map();
    node.onvalue = (name, value) => present.set(name, value);
    let at = 0;
    for (let row = 0; row < rows; row++) {
        now = (row * 1000) / PER_SECOND;
        for (; (at + BLOCK) * PER_SECOND <= row * RATE; at += BLOCK)
            node.processor.process([[samples.subarray(at, at + BLOCK)]], [], parameters);
        node.update(1000 / PER_SECOND);
        visemes.forEach((name, k) => (weights[row * visemes.length + k] = present.get(`viseme_${name}`) ?? 0));
    }
    return weights;
}

try {
    const weights = method === "headaudio" ? await headaudio() : wawa();
    process.stdout.write(new Uint8Array(weights.buffer));
} catch (error) {
    process.stderr.write(`${error}\n`);
    process.exitCode = 1;
}
