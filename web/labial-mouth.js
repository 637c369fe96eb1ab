// <labial-mouth>: draws a mouth from a track, a stream, a hearing or a voice in step with its sound. modules.d.ts
// documents it.
import { heard, shown } from "./memory.js";
import { CHANNELS, createMouth, follow } from "./mouth.js";

/** Milliseconds in which a mouth comes to rest. */
const CLOSING = 200;
const NO_FAPS = `a frame has ${CHANNELS.length} FAPs; what is drawn has the output "faps"`;

/** Eases from a frame to the neutral face. */
function easing(faps, milliseconds) {
    const from = Array.from(faps);
    const length = milliseconds / 1000;
    const over = (seconds) => seconds >= length;
    return { over, at: (seconds) => from.map((value) => (over(seconds) ? 0 : value * (1 - seconds / length))) };
}

/** Plays a track: any moment of it, interpolated between frames. */
function playTrack(track) {
    return {
        kind: "track", period: 1 / track.fps, at: (seconds) => track.at(seconds), over: (seconds) => seconds >= track.duration,
    };
}

/** Plays a stream: one frame after the other. */
function playStream(stream) {
    const period = 1 / stream.fps;
    let shown = new Array(CHANNELS.length).fill(0);
    let count = 0; // frames since time 0
    return {
        kind: "stream", period,
        /** Ticks until the due frame is ready, or until none comes; then the last one stays. Frames that come late catch up
         * with a sound; without one what follows is as much later. */
        at(seconds, audio) {
            const due = Math.floor(seconds / period + 1e-6) + 1;
            let underway = stream.latency.delay;
            while (count < due) {
                const frame = stream.tick();
                if (frame) {
                    shown = Array.from(frame);
                    count++;
                } else if (stream.done || stream.starved || underway-- <= 0) {
                    break;
                }
            }
            if (!audio || audio.ended) count = due;
            return shown;
        },
        over: () => stream.done,
        /** From now on, from time 0, the stream itself eases to the neutral face. */
        cancel(milliseconds) {
            stream.cancel(milliseconds);
            count = 0;
        },
    };
}

/** Plays what is heard: the moment of its own clock, or that of the element's sound where it has none. */
function playHearing(hearing) {
    let begin = 0; // of the easing
    let cancelled = false;
    return {
        kind: "hearing", period: 1 / hearing.fps,
        at(seconds) {
            const now = cancelled ? null : hearing.now; // which stands if the sound has stopped
            return hearing.at(now ?? begin + seconds);
        },
        over: () => cancelled && hearing.done,
        cancel(milliseconds) {
            begin = hearing.now ?? hearing.time;
            hearing.cancel(milliseconds, begin);
            cancelled = true;
        },
    };
}

/** Plays a voice that is followed: by its own clock, or by the element's sound where it has none. */
function playVoice(voice) {
    const clock = voice.clock !== null;
    const period = 1 / voice.fps;
    let begin = 0; // of the easing
    let length = Infinity; // of it, from the cancel on, seconds
    return {
        kind: "voice", period,
        at: (seconds) => (clock ? voice.at() : voice.at(begin + seconds)),
        /** The next utterance may have begun during the easing, and then the voice is not done at its end. */
        over: (seconds) => length < Infinity && (voice.done || seconds > length),
        cancel(milliseconds) {
            begin = Math.max(0, voice.time);
            voice.cancel(milliseconds);
            length = milliseconds / 1000 + period;
        },
        /** Whether an utterance has begun since the cancel. */
        get speaks() { return length < Infinity && !voice.cancelled; },
        /** What plays after a cancel: the same voice, whose clock goes on. */
        get next() { return clock ? playVoice(voice) : null; },
        /** Seconds of the voice that are drawn, where it has a clock of its own. */
        get position() { return clock ? voice.number / voice.fps : undefined; },
    };
}

/** The properties that take a source: what plays it, and the call that it must have. */
const SOURCES = Object.entries({
    track: [playTrack, "at"], stream: [playStream, "tick"], hearing: [playHearing, "at"], voice: [playVoice, "at"],
});

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

    static {
        for (const [kind, [play, call]] of SOURCES) {
            Object.defineProperty(this.prototype, kind, {
                configurable: true,
                get() { return this.#player?.kind === kind ? this.#source : null; },
                set(source) { this.#set(source, play, call); },
            });
        }
    }

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
    get position() { return (this.audio ? undefined : this.#player?.position) ?? this.#position; }
    get faps() { return this.#faps; }

    show(faps) {
        if (faps.length !== CHANNELS.length) throw new TypeError(NO_FAPS);
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
        this.#take(this.#source, eases ? this.#player : easing(this.#faps, milliseconds));
        this.#rest = resting();
        return this.#rest.promise;
    }

    /** Ends what was cancelled. */
    #leave() {
        const next = this.#player?.next;
        this.#take(next && this.#source, next);
    }

    /** Takes a source from its owner. */
    #set(source, play, call) {
        if (source && typeof source[call] !== "function") {
            throw new TypeError(`the source is ${shown(source)}, which has no ${call}(): set what a promise resolves to`);
        }
        this.#take(source, source && play(source));
    }

    #take(source, player) {
        if (source?.output !== undefined && source.output !== "faps") throw new TypeError(NO_FAPS);
        this.#rest?.resolve();
        this.#rest = null;
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

    #ask() {
        if (this.#asked || !this.#player || !this.isConnected) return;
        this.#asked = requestAnimationFrame((now) => this.#step(now));
    }

    /** One animation frame. */
    #step(now) {
        this.#asked = 0;
        if (this.#source?.closed) { // by its owner: the mouth comes to rest without it
            this.#source = null;
            this.#player = easing(this.#faps, CLOSING);
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
