// The types of the modules beside index.js, as the package declares them; assemble.mjs writes a file for each.

declare module "labial/labial-mouth.js" {
    import type { Faps, Hearing, Stream, Track, Voice } from "labial";

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

    global {
        interface HTMLElementTagNameMap {
            "labial-mouth": LabialMouth;
        }
    }
}

declare module "labial/labial-face.js" {
    import { LabialMouth } from "labial/labial-mouth.js";
    import type { TimedWord } from "labial";

    /** The element <labial-face>: a whole drawn face, which does all that <labial-mouth> does. Its eyes blink and its brows move,
     * unless the visitor prefers reduced motion. It can have the keyboard's focus, where Enter and the space bar are clicks, and
     * screen readers name it in the language of the place where it stands (`lang`); an `aria-label` or a `role` of your own
     * replaces that.
     *
     * It is light or dark as `color-scheme` says. CSS variables: --labial-skin, --labial-hair, --labial-lips, --labial-iris,
     * --labial-clothes, --labial-backdrop-top, --labial-backdrop-bottom; `::part(caption)` is the caption. */
    export class LabialFace extends LabialMouth {
        /** Captions: the words that are spoken, by `position`. It shows them line by line, and in
         * a line of several words the one that is spoken is marked. null for none, and cancel() sets that. */
        get words(): readonly TimedWord[];
        set words(words: Iterable<TimedWord> | null);
        /** The present caption. A text that is set stays until another one, or words, are set. */
        get caption(): string;
        set caption(text: string | null);
    }

    global {
        interface HTMLElementTagNameMap {
            "labial-face": LabialFace;
        }
    }
}

declare module "labial/mouth.js" {
    /** The parameters of a frame, in their order: "fap3", "fap16", ... */
    export const CHANNELS: readonly string[];

    /** What is drawn of a frame. */
    export interface MouthShape {
        /** The `d` of each path, in the names of the drawing. */
        paths: Record<string, string>;
        /** The opacity of some of them. */
        opacity: Record<string, number>;
        /** How far the jaw is down, and the widest distance between the lips' inner contours; in drawing units, of which the
         * neutral mouth's width is 170. */
        jaw: number;
        gap: number;
    }

    /** The drawing of a frame: 13 FAPs in the order of CHANNELS. */
    export function mouthShape(faps: ArrayLike<number>): MouthShape;
    /** Puts a mouth into an empty element or shadow root. Returns what draws a frame. */
    export function createMouth(place: Element | ShadowRoot): (faps: ArrayLike<number>) => void;
    /** The same with a whole face around it. */
    export function createFace(place: Element | ShadowRoot): (faps: ArrayLike<number>) => void;
    /** What the face's mouth draws of a frame: it smiles a little at rest, and in f and v teeth show. */
    export function faceFrame(faps: ArrayLike<number>): number[];
    /** Appends the SVG elements of a markup that has no text. */
    export function build(place: Element | ShadowRoot, markup: string): void;
    /** The moment to draw, where the clock says `next` and a sound is heard at `heard`: never farther than half a period away. */
    export function follow(next: number, heard: number, period: number): number;
    export function clamp(x: number, low: number, high: number): number;
}

declare module "labial/attach.js" {
    import type { Face, Hearing, Rig, Track, Voice, Weights } from "labial";

    /** A loaded avatar: a scene of three.js, what its GLTFLoader loads, or a VRM of three-vrm. */
    export type Avatar = { traverse(visit: (node: any) => void): void } | { scene: { traverse(visit: (node: any) => void): void } };

    /** What gives a frame for a time, seconds. */
    export type Source = Track<any> | Hearing<any> | Voice<any> | { at(seconds: number): Readonly<Record<string, number>> };

    /** An avatar whose mouth is moved. */
    export class Head<O extends Face | Rig = Face> {
        #private;
        private constructor();
        /** The form of the frames that it takes, for render(), hear() or voice(): "arkit" before "oculus" before "vrm", or
         * the rig that was given. ARKit's shapes count only if the jaw opens at least half as far as the viseme of "ah". */
        readonly output: O;
        /** The meshes that have shapes: head, teeth, beard. */
        readonly meshes: readonly any[];
        /** What is spoken: a track, a hearing or a voice of this output, or whatever gives weights; null closes the mouth
         * within a fifth of a second, and so does a source that is closed: then there is none. */
        get source(): Source | null;
        set source(source: Source | null);
        /** The sound whose time counts, as heard() tells it; without it that of the source's own clock, or what update() is
         * given. */
        audio: { readonly currentTime: number; readonly ended?: boolean } | null;
        /** Shows the source's moment: once for each picture, before `vrm.update()` and `renderer.render()`. */
        update(seconds?: number): void;
        /** Shows weights by name. */
        show(weights: Weights | Readonly<Record<string, number>>): void;
        /** Closes the mouth at once. */
        rest(): void;
    }

    /** Looks for ARKit's, Oculus's (Ready Player Me's) or VRM's names in an avatar. `output` is a rig of its own shapes, made by
     * labial.rig(), or the face to take if there are several. Throws a LabialError if it knows none of the names. */
    export function attach<O extends Face | Rig = Face>(avatar: Avatar, options?: { output?: O }): Head<O>;
}

declare module "labial/espeak.js" {
    import type { Segment } from "labial";

    /** An event of espeak-ng's `synthesize()`; all kinds of them may be given. */
    export interface EspeakEvent {
        type: string;
        /** Milliseconds from the beginning of the sound. */
        audio_position: number;
        /** The label of a phoneme. */
        id?: unknown;
    }

    type Samples = Int16Array | Float32Array;

    /** Phonemes and their times from the events of espeak-ng (@echogarden/espeak-ng-emscripten), in their order. With the
     * sound, whole or in the pieces in which it came, a p, t or k begins where the sound falls silent before it; without, at
     * its burst, later than lips close. */
    export function fromEspeak(events: readonly EspeakEvent[], sound?: { samples: Samples | readonly Samples[]; sampleRate: number }): Segment[];
}
