import type { Faps, Hearing, Stream, Track, Voice } from "./index.js";

/** The element <labial-mouth>: a drawn mouth, 430 wide by 412 high unless CSS says otherwise. The colours behind the
 * face are the CSS variables --labial-backdrop-top and --labial-backdrop-bottom.
 *
 * A source is a track, a stream, a hearing or a voice with the output "faps", any other throws a TypeError; setting one
 * starts it. With an audio element, the drawn frame is within half a frame period of the sound, at any speed and, for a
 * track, through jumps. After the sound's end time goes on as heard() tells it. A source without a sound goes by the clock,
 * and so does one that is set after the sound's end, until that is played again. If a source is closed or freed, the face
 * comes to rest, and then has no source.
 *
 * The event "ended" tells that the source has ended by itself and was drawn, "lost" that the stream that is heard has lost
 * its sound: a microphone that was unplugged, a connection that closed. */
export class LabialMouth extends HTMLElement {
    /** The sound to follow: the one that was set, else the element whose id the attribute `for` names. */
    get audio(): HTMLMediaElement | null;
    set audio(audio: HTMLMediaElement | null);
    /** The track that is drawn; its time 0 is that of the sound. */
    get track(): Track<"faps"> | null;
    set track(track: Track<"faps"> | null);
    /** The stream that is drawn: the element ticks it. Its first frame is due at time 0 of the sound. */
    get stream(): Stream<"faps"> | null;
    set stream(stream: Stream<"faps"> | null);
    /** What is heard and drawn: by its own clock, or, where it has none, by the sound to follow. */
    get hearing(): Hearing<"faps"> | null;
    set hearing(hearing: Hearing<"faps"> | null);
    /** The voice that is followed and drawn: by its own clock, or, where it has none, by the sound to follow. */
    get voice(): Voice<"faps"> | null;
    set voice(voice: Voice<"faps"> | null);
    /** Seconds of the source that are drawn: the sound's, if there is one. Those of a voice with a clock are the clock's, but
     * count from the first begin() if it is an AudioContext or a MediaStream. */
    readonly position: number;
    /** The drawn frame: 13 FAPs, interpolated for a track. The same object each time. */
    readonly faps: Float32Array;
    /** Draws the given frame. Throws a TypeError unless there are 13 FAPs. */
    show(faps: Faps | ArrayLike<number>): void;
    /** Interrupts: pauses the sound and eases to the neutral face within so many milliseconds, by default 200. Resolves
     * when the face is at rest, or when another source is set. A voice with a clock stays the source: its next utterance
     * is drawn. */
    cancel(milliseconds?: number): Promise<void>;
}

/** Adds a style to a shadow root. */
export function adopt(root: ShadowRoot, style: string): void;
/** Defines an element, unless there is one of this name. */
export function define(name: string, element: CustomElementConstructor): void;

declare global {
    interface HTMLElementTagNameMap {
        "labial-mouth": LabialMouth;
    }
}
