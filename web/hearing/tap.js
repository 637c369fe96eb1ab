// Takes the samples of a stream, an element or a node, and plays the sound later, in step with the lips.

/** Contexts that have the processor. */
const prepared = new WeakMap();
/** The outlet of each element: it can have only one node, which all its hearings share. */
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
    if (shared?.state === "closed") shared = null; // by the page
    const known = elements.get(source)?.node.context ?? given ?? shared;
    if (known) return known;
    if (!globalThis.AudioContext) throw new LabialError("there is no AudioContext here: push() the samples instead");
    return (shared = new AudioContext());
}

/** Begins to take samples once it is started. */
export async function tap({ LabialError }, context, source, play = !isNode(source)) {
    if (context.state === "closed") throw new LabialError("the AudioContext of the source was closed");
    if (!context.audioWorklet) {
        throw new LabialError("this page has no AudioWorklet: browsers have it on https: and localhost alone");
    }
    let loading = prepared.get(context);
    if (!loading) {
        loading = addProcessor(LabialError, context);
        loading.catch(() => prepared.delete(context)); // so that it can be tried again
        prepared.set(context, loading);
    }
    await loading;
    if (context.state !== "running") Promise.resolve(context.resume()).catch(() => {}); // waits for a click
    const factor = context.sampleRate <= 48000 ? 1 : context.sampleRate <= 96000 ? 2 : 4;
    return new Tap(context, nodeOf(LabialError, context, source), { source, factor, play });
}

/** The processor's own file. A bundler that does not emit it, as esbuild and rollup, leaves its text. */
async function addProcessor(LabialError, context) {
    try {
        return await context.audioWorklet.addModule(new URL("./labial-tap.js?no-inline", import.meta.url));
    } catch {
        const { default: text } = await import("./labial-tap-text.js");
        const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
        try {
            return await context.audioWorklet.addModule(address);
        } catch (error) {
            throw Object.assign(new LabialError("the page can load neither labial-hearing's labial-tap.js nor its copy: serve " +
                "that file, or allow script-src blob:"), { cause: error });
        } finally {
            URL.revokeObjectURL(address);
        }
    }
}

function nodeOf(LabialError, context, source) {
    if (isNode(source)) return source;
    if (isStream(source)) {
        if (!source.getAudioTracks().length) throw new LabialError("the stream has no track of sound");
        return context.createMediaStreamSource(source);
    }
    if (!elements.has(source)) elements.set(source, new Outlet(context.createMediaElementSource(source)));
    return elements.get(source).node;
}

/** What the loudspeaker gets of an element: the sound of the tap that was opened last, of those that play. Without any tap
 * it is the sound itself, as an element with a node cannot play in another way any more. */
class Outlet {
    #taps = [];
    #direct;
    #heard = null; // the node that the loudspeaker has

    constructor(node) {
        this.node = node;
        this.#direct = new GainNode(node.context);
        node.connect(this.#direct);
    }

    add(tap) {
        this.#taps.push(tap);
        this.#route();
    }

    remove(tap) {
        this.#taps = this.#taps.filter((one) => one !== tap);
        this.#route();
    }

    #route() {
        const heard = this.#taps.length ? this.#taps.findLast(({ play }) => play)?.speaker ?? null : this.#direct;
        if (heard === this.#heard) return;
        this.#heard?.disconnect();
        heard?.connect(this.node.context.destination);
        this.#heard = heard;
    }
}

class Tap {
    #node;
    #worklet;
    #source;
    #later;
    #silent = null;
    #outlet; // of an element
    #watched = new AbortController(); // of the source's events

    constructor(context, node, { source, factor, play }) {
        this.context = context;
        this.sampleRate = context.sampleRate / factor;
        this.play = play;
        this.speaker = new GainNode(context); // behind `sound`, which is the page's, too
        this.#outlet = elements.get(source);
        this.#node = node;
        this.#source = source;
        this.#worklet = new AudioWorkletNode(context, "labial-tap", {
            channelCount: 1, channelCountMode: "explicit", processorOptions: { factor },
        });
        if (isStream(source) && globalThis.Audio) {
            // Chromium delivers the sound of a remote stream to nodes only while an element has it as well.
            this.#silent = Object.assign(new Audio(), { muted: true, srcObject: source });
        }
    }

    /** Passes each block, with the time when it is heard, to `take`; and to `tell`, "ended" when an element or a node has
     * played to its end, "lost" when the last track of a stream ends, once the sound before that was heard. */
    start(delay, take, tell) {
        const { signal } = this.#watched;
        const tracks = isStream(this.#source) ? this.#source.getAudioTracks() : [];
        const later = (what) => setTimeout(() => signal.aborted || tell(what), 1000 * delay);
        if (!tracks.length) this.#source.addEventListener("ended", () => later("ended"), { signal });
        const check = () => tracks.length && tracks.every(({ readyState }) => readyState === "ended") && later("lost");
        for (const track of tracks) track.addEventListener("ended", check, { signal });
        check();
        const { context } = this;
        this.#later = new DelayNode(context, { delayTime: delay, maxDelayTime: delay + 1 });
        this.sound = new GainNode(context);
        this.#node.connect(this.#later).connect(this.sound).connect(this.speaker);
        if (this.#outlet) this.#outlet.add(this);
        else if (this.play) this.speaker.connect(context.destination);
        this.#worklet.port.onmessage = ({ data: [block, time] }) => take(block, time + delay);
        this.#node.connect(this.#worklet).connect(context.destination);
    }

    close() {
        this.#watched.abort();
        this.#worklet.port.onmessage = null;
        this.#worklet.port.postMessage(null);
        this.#worklet.disconnect();
        this.#outlet?.remove(this);
        this.speaker.disconnect();
        this.sound?.disconnect();
        if (this.#later) {
            this.#node.disconnect(this.#worklet);
            this.#node.disconnect(this.#later);
        }
        if (this.#silent) this.#silent.srcObject = null;
    }
}
