// Takes the samples of a stream, an element or a node, and plays the sound later, in step with the lips.

/** Gathers blocks of the mean of all channels and posts them with the time of their first sample. Rates beyond those
 * that are heard are lowered by whole factors. The output is silent; it is there so that the browser runs the node. */
const PROCESSOR = `
registerProcessor("labial-tap", class extends AudioWorkletProcessor {
    constructor({ processorOptions: { factor } }) {
        super();
        this.factor = factor;
        this.room = Math.ceil(sampleRate / factor / 100 / 32) * 32;
        this.block = null;
        this.port.onmessage = () => { this.closed = true; };
    }
    process([[input]]) {
        const { factor } = this;
        const count = 128 / factor;
        for (let i = 0; i < count; i++) {
            if (!this.block) {
                this.block = new Float32Array(this.room);
                this.used = 0;
                this.time = currentTime + i * factor / sampleRate;
            }
            let sum = 0;
            for (let j = 0; input && j < factor; j++) sum += input[i * factor + j];
            this.block[this.used++] = sum / factor;
            if (this.used === this.room) {
                this.port.postMessage([this.block, this.time], [this.block.buffer]);
                this.block = null;
            }
        }
        return !this.closed;
    }
});
`;

/** Contexts that have the processor, and the nodes of elements: an element can have only one. */
const prepared = new WeakMap();
const elements = new WeakMap();
/** For sources that come without a context. */
let shared;

const isStream = (source) => typeof source?.getAudioTracks === "function";
const isElement = (source) => typeof source?.play === "function" && "currentTime" in source;
const isNode = (source) => typeof source?.connect === "function" && Boolean(source.context);

/** The AudioContext whose clock the hearing follows; null when there is nothing to follow. */
export function contextOf({ LabialError, shown }, source, given) {
    if (source === null) return given ?? null;
    if (isNode(source)) return source.context;
    if (!isStream(source) && !isElement(source)) {
        throw new TypeError(`the source is ${shown(source)}, not a MediaStream, an audio element or an AudioNode`);
    }
    const known = elements.get(source)?.context ?? given ?? shared;
    if (known) return known;
    if (!globalThis.AudioContext) throw new LabialError("there is no AudioContext here: push() the samples instead");
    return (shared = new AudioContext());
}

/** Begins to take samples once it is started. */
export async function tap({ LabialError }, context, source, play = !isNode(source)) {
    if (!context.audioWorklet) {
        throw new LabialError("this page has no AudioWorklet: browsers have it on https: and localhost alone");
    }
    let loading = prepared.get(context);
    if (!loading) {
        const address = URL.createObjectURL(new Blob([PROCESSOR], { type: "text/javascript" }));
        loading = context.audioWorklet.addModule(address).finally(() => URL.revokeObjectURL(address));
        loading.catch(() => prepared.delete(context)); // so that it can be tried again
        prepared.set(context, loading);
    }
    await loading;
    if (context.state === "suspended") Promise.resolve(context.resume()).catch(() => {}); // waits for a click
    const factor = context.sampleRate <= 48000 ? 1 : context.sampleRate <= 96000 ? 2 : 4;
    return new Tap(context, nodeOf(LabialError, context, source), { source, factor, play });
}

function nodeOf(LabialError, context, source) {
    if (isNode(source)) return source;
    if (isStream(source)) {
        if (!source.getAudioTracks().length) throw new LabialError("the stream has no track of sound");
        return context.createMediaStreamSource(source);
    }
    if (!elements.has(source)) elements.set(source, context.createMediaElementSource(source));
    return elements.get(source);
}

class Tap {
    #node;
    #worklet;
    #later;
    #silent = null;

    constructor(context, node, { source, factor, play }) {
        this.context = context;
        this.sampleRate = context.sampleRate / factor;
        this.element = isElement(source);
        this.play = play;
        this.#node = node;
        this.#worklet = new AudioWorkletNode(context, "labial-tap", {
            channelCount: 1, channelCountMode: "explicit", processorOptions: { factor },
        });
        if (isStream(source) && globalThis.Audio) {
            // Chromium delivers the sound of a remote stream to nodes only while an element has it as well.
            this.#silent = Object.assign(new Audio(), { muted: true, srcObject: source });
        }
    }

    /** Passes each block, with the time when it is heard, to `take`. */
    start(delay, take) {
        const { context } = this;
        this.#later = new DelayNode(context, { delayTime: delay, maxDelayTime: delay + 1 });
        this.sound = new GainNode(context);
        if (this.element) this.#node.disconnect(); // it may play without delay, after an earlier hearing
        this.#node.connect(this.#later).connect(this.sound);
        if (this.play) this.sound.connect(context.destination);
        this.#worklet.port.onmessage = ({ data: [block, time] }) => take(block, time + delay);
        this.#node.connect(this.#worklet).connect(context.destination);
    }

    close() {
        this.#worklet.port.onmessage = null;
        this.#worklet.port.postMessage(null);
        this.#worklet.disconnect();
        this.sound?.disconnect();
        if (this.#later) {
            this.#node.disconnect(this.#worklet);
            this.#node.disconnect(this.#later);
        }
        if (this.element) this.#node.connect(this.context.destination); // it cannot play in another way any more
        if (this.#silent) this.#silent.srcObject = null;
    }
}
