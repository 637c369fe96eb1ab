// <labial-mouth>: draws a mouth from a track, a stream, a hearing or a voice in step with its sound. modules.d.ts
// documents it.
import { heard, shown } from "./memory.js";
import { CHANNELS, createMouth, follow } from "./mouth.js";

/** Milliseconds in which a mouth comes to rest. */
const CLOSING = 200;
const NO_FAPS = `a frame has ${CHANNELS.length} FAPs; what is drawn has the output "faps"`;

/** Plays a track: any moment of it, interpolated between frames. */
class TrackPlayer {
    #track;

    constructor(track) {
        this.#track = track;
        this.period = 1 / track.fps;
    }

    at(seconds) {
        return this.#track.at(seconds);
    }

    over(seconds) {
        return seconds >= this.#track.duration;
    }
}

/** Eases from a frame to the neutral face. */
class Easing {
    #from;
    #seconds;

    constructor(faps, milliseconds) {
        this.#from = Array.from(faps);
        this.#seconds = milliseconds / 1000;
    }

    at(seconds) {
        return this.#from.map((value) => (this.over(seconds) ? 0 : value * (1 - seconds / this.#seconds)));
    }

    over(seconds) {
        return seconds >= this.#seconds;
    }
}

/** Plays a stream: one frame after the other. */
class StreamPlayer {
    #stream;
    #frame = new Array(CHANNELS.length).fill(0);
    #shown = 0; // frames since time 0

    constructor(stream) {
        this.#stream = stream;
        this.period = 1 / stream.fps;
    }

    /** Ticks until the due frame is ready, or until none comes; then the last one stays. Frames that come late catch up
     * with a sound; without one what follows is as much later. */
    at(seconds, audio) {
        const due = Math.floor(seconds / this.period + 1e-6) + 1;
        let underway = this.#stream.latency.delay;
        while (this.#shown < due) {
            const frame = this.#stream.tick();
            if (frame) {
                this.#frame = Array.from(frame);
                this.#shown++;
            } else if (this.#stream.done || this.#stream.starved || underway-- <= 0) {
                break;
            }
        }
        if (!audio || audio.ended) this.#shown = due;
        return this.#frame;
    }

    over() {
        return this.#stream.done;
    }

    /** From now on, from time 0, the stream itself eases to the neutral face. */
    cancel(milliseconds) {
        this.#stream.cancel(milliseconds);
        this.#shown = 0;
    }
}

/** Plays what is heard: the moment of its own clock, or that of the element's sound where it has none. */
class HearingPlayer {
    #hearing;
    #begin = 0; // of the easing
    #cancelled = false;

    constructor(hearing) {
        this.#hearing = hearing;
        this.period = 1 / hearing.fps;
    }

    at(seconds) {
        const now = this.#cancelled ? null : this.#hearing.now; // which stands if the sound has stopped
        return this.#hearing.at(now ?? this.#begin + seconds);
    }

    over() {
        return this.#cancelled && this.#hearing.done;
    }

    cancel(milliseconds) {
        this.#begin = this.#hearing.now ?? this.#hearing.time;
        this.#hearing.cancel(milliseconds, this.#begin);
        this.#cancelled = true;
    }
}

/** Plays a voice that is followed: by its own clock, or by the element's sound where it has none. */
class VoicePlayer {
    #voice;
    #clock;
    #begin = 0; // of the easing
    #length = Infinity; // of it, from the cancel on, seconds

    constructor(voice) {
        this.#voice = voice;
        this.#clock = voice.clock !== null;
        this.period = 1 / voice.fps;
    }

    at(seconds) {
        return this.#clock ? this.#voice.at() : this.#voice.at(this.#begin + seconds);
    }

    /** The next utterance may have begun during the easing, and then the voice is not done at its end. */
    over(seconds) {
        return this.#length < Infinity && (this.#voice.done || seconds > this.#length);
    }

    cancel(milliseconds) {
        this.#begin = Math.max(0, this.#voice.time);
        this.#voice.cancel(milliseconds);
        this.#length = milliseconds / 1000 + this.period;
    }

    /** Whether an utterance has begun since the cancel. */
    get speaks() {
        return this.#length < Infinity && !this.#voice.cancelled;
    }

    /** What plays after a cancel: the same voice, whose clock goes on. */
    get next() {
        return this.#clock ? new VoicePlayer(this.#voice) : null;
    }

    /** Seconds of the voice that are drawn, where it has a clock of its own. */
    get position() {
        return this.#clock ? this.#voice.number / this.#voice.fps : undefined;
    }
}

/** What cancel() promises, and what resolves it. */
function resting() {
    const rest = {};
    rest.promise = new Promise((resolve) => { rest.resolve = resolve; });
    return rest;
}

/** Node has no elements, but the module may be imported there. */
const Base = globalThis.HTMLElement ?? class {};

export class LabialMouth extends Base {
    /** What draws, and the style of what is around it. */
    static create = createMouth;
    static style = ":host, div, svg { display: block } div, svg { width: 100%; height: 100% }";

    #draw;
    #faps = new Float32Array(CHANNELS.length);
    #source = null;
    #player = null;
    #audio = null;
    #position = 0; // seconds
    #over = false; // the source was drawn to its end
    #goes = false; // there is more to draw than the mouth: captions
    #told = new AbortController(); // of the source's events
    #before = null; // when the last animation frame was, milliseconds
    #late = false; // the sound had ended before the source was drawn first
    #asked = 0; // the next animation frame
    #rest = null; // of a source that is cancelled: the promise of cancel() and what resolves it

    constructor() {
        super();
        const root = this.attachShadow({ mode: "open" });
        const place = document.createElement("div");
        root.append(place);
        adopt(root, new.target.style);
        this.#draw = new.target.create(place);
        this.#draw(this.#faps);
    }

    connectedCallback() {
        for (const name of Object.keys(this)) { // properties that were set before the element was defined
            if (!(name in Object.getPrototypeOf(this))) continue;
            const value = this[name];
            delete this[name];
            this[name] = value;
        }
        this.#listen();
        this.#ask();
    }

    adoptedCallback() {
        adopt(this.shadowRoot, this.constructor.style);
    }

    disconnectedCallback() {
        this.#halt();
        this.#listen();
        this.#before = null;
        if (this.#rest) this.#leave();
    }

    get audio() {
        return this.#audio ?? this.getRootNode().getElementById?.(this.getAttribute("for")) ?? null;
    }

    set audio(audio) {
        this.#audio = audio;
    }

    /** Seconds of the source that are drawn. */
    get position() {
        return (this.audio ? undefined : this.#player?.position) ?? this.#position;
    }

    get track() {
        return this.#player instanceof TrackPlayer ? this.#source : null;
    }

    set track(track) {
        this.#set(track, TrackPlayer, "at");
    }

    get stream() {
        return this.#player instanceof StreamPlayer ? this.#source : null;
    }

    set stream(stream) {
        this.#set(stream, StreamPlayer, "tick");
    }

    get faps() {
        return this.#faps;
    }

    get hearing() {
        return this.#player instanceof HearingPlayer ? this.#source : null;
    }

    set hearing(hearing) {
        this.#set(hearing, HearingPlayer, "at");
    }

    get voice() {
        return this.#player instanceof VoicePlayer ? this.#source : null;
    }

    set voice(voice) {
        this.#set(voice, VoicePlayer, "at");
    }

    show(faps) {
        if (faps.length !== CHANNELS.length) {
            throw new TypeError(NO_FAPS);
        }
        this.#faps.set(faps);
        this.#draw(this.#faps);
    }

    cancel(milliseconds = CLOSING) {
        if (!(milliseconds >= 0)) throw new TypeError("the milliseconds are no number from 0 on");
        if (this.#rest && !this.#player.speaks) return this.#rest.promise;
        this.audio?.pause();
        const eases = this.#player?.cancel && !this.#source?.closed && !this.#player.over();
        if (eases) this.#player.cancel(milliseconds);
        if (!this.isConnected || (!eases && !this.#faps.some(Boolean))) {
            this.#leave();
            return Promise.resolve();
        }
        this.#take(this.#source, eases ? this.#player : new Easing(this.#faps, milliseconds));
        this.#rest = resting();
        return this.#rest.promise;
    }

    /** Ends what was cancelled. */
    #leave() {
        const next = this.#player?.next;
        this.#take(next && this.#source, next);
    }

    /** Takes a source from its owner. */
    #set(source, Player, call) {
        if (source && typeof source[call] !== "function") {
            throw new TypeError(`the source is ${shown(source)}, which has no ${call}(): set what a promise resolves to`);
        }
        this.#take(source, source && new Player(source));
    }

    #take(source, player) {
        if (source?.output !== undefined && source.output !== "faps") throw new TypeError(NO_FAPS);
        this.#rested();
        this.#source = source || null;
        this.#player = player || null;
        this.#listen();
        this.#position = 0;
        this.#over = false;
        this.#before = null;
        if (!player) {
            this.#halt();
            if (this.#goes || this.#faps.some(Boolean)) this.#goes = this.show(new Float32Array(CHANNELS.length));
        }
        this.#ask();
    }

    /** Passes the source's events on while the element is on the page: a source may outlive it. */
    #listen() {
        this.#told.abort();
        this.#told = new AbortController();
        for (const type of this.isConnected ? ["ended", "lost"] : []) {
            this.#source?.addEventListener?.(type, () => this.dispatchEvent(new Event(type)), this.#told);
        }
    }

    #halt() {
        cancelAnimationFrame(this.#asked);
        this.#asked = 0;
    }

    #rested() {
        this.#rest?.resolve();
        this.#rest = null;
    }

    #ask() {
        if (this.#asked || !this.#player || !this.isConnected) return;
        this.#asked = requestAnimationFrame((now) => this.#step(now));
    }

    /** One animation frame. */
    #step(now) {
        this.#asked = 0;
        if (this.#source?.closed) { // by its owner: the mouth comes to rest without it
            this.#source = null;
            this.#player = new Easing(this.#faps, CLOSING);
            this.#position = 0;
            this.#rest ??= resting();
        }
        const player = this.#player;
        const audio = this.#rest ? null : this.audio;
        this.#position = this.#moment(audio, now);
        this.#before = now;
        this.#goes = this.show(player.at(this.#position, audio));
        const over = player.over(this.#position);
        if (over !== this.#over) {
            this.#over = over;
            if (over && !this.#rest) this.dispatchEvent(new Event("ended"));
            if (player !== this.#player) return; // a listener has set another source
        }
        if (over && this.#rest) this.#leave();
        else if (!over || audio || this.#goes) this.#ask();
    }

    /** The time to show now, seconds: that of the sound; without a sound that of the clock. A sound that has ended before
     * the source is drawn is none until it is played again. */
    #moment(audio, now) {
        const passed = (now - (this.#before ?? now)) / 1000;
        if (this.#before === null || !audio?.ended) this.#late = Boolean(audio?.ended);
        if (!audio || this.#late) return this.#position + passed;
        const waits = audio.paused || audio.seeking || audio.readyState < HTMLMediaElement.HAVE_FUTURE_DATA;
        if (waits || audio.ended) return heard(audio);
        return follow(this.#position + passed * audio.playbackRate, heard(audio), this.#player.period);
    }
}

/** Adds a style to a shadow root: a page may allow only style sheets of its own files, and scripts' sheets. */
export function adopt(root, style) {
    const sheet = new (root.ownerDocument.defaultView ?? globalThis).CSSStyleSheet(); // another document takes no other
    sheet.replaceSync(style);
    root.adoptedStyleSheets = [...(root.adoptedStyleSheets ?? []), sheet]; // which jsdom lacks
}

/** Defines an element, unless a copy of the package, perhaps another version, has done so. */
export function define(name, element) {
    if (globalThis.customElements && !customElements.get(name)) customElements.define(name, element);
}

define("labial-mouth", LabialMouth);
