import type { Faps, Stream, Track } from "./index.js";

/** The element <labial-mouth>: a drawn mouth, 430 wide by 412 high unless CSS says otherwise. The colours behind the
 * face are the CSS variables --labial-backdrop-top and --labial-backdrop-bottom.
 *
 * A source is a track or a stream with the output "faps"; setting one begins it. With an audio element, frames are
 * drawn where its sound is, at any speed and, of a track, through jumps: never more than half a frame period away. What
 * is left of a source behind the sound's end plays by itself, and so does a source without a sound, from when it is
 * set. */
export class LabialMouth extends HTMLElement {
    /** The sound that is followed: the one that was set, else the element whose id the attribute `for` names. */
    get audio(): HTMLMediaElement | null;
    set audio(audio: HTMLMediaElement | null);
    /** The track that is drawn; its time 0 is that of the sound. */
    get track(): Track<"faps"> | null;
    set track(track: Track<"faps"> | null);
    /** The stream that is drawn: the element ticks it. Its first frame is due at time 0 of the sound. */
    get stream(): Stream<"faps"> | null;
    set stream(stream: Stream<"faps"> | null);
    /** What is drawn now: 13 FAPs, between two frames of a track. The same object each time. */
    readonly faps: Float32Array;
    /** Draws a frame of one's own. Throws a TypeError unless there are 13 FAPs. */
    show(faps: Faps | ArrayLike<number>): void;
    /** Interrupts: pauses the sound and eases to the neutral face in so many milliseconds, 200 unless given. Resolves
     * when the face is at rest, or when another source is set. */
    cancel(milliseconds?: number): Promise<void>;
}

declare global {
    interface HTMLElementTagNameMap {
        "labial-mouth": LabialMouth;
    }
}
