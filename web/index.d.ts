import type { Face, Faces } from "./faces.js";

export type { Face, Faces };

/** 13 lip and jaw parameters in FAP units: MPEG-4 FAPs 3, 16, 17, 51 .. 60, in this order. */
export type Faps = Int16Array;

/** A face's weights by name, 0 .. 1. */
export type Weights<F extends Face = Face> = F extends Face ? Record<Faces[F], number> : never;

/** Your own face, read by `labial.rig()`: an output like the built-in faces. */
export class Rig<Name extends string = string> {
    #private;
    private constructor();
    readonly name: string;
    /** The names of its weights. */
    readonly outputs: readonly Name[];
}

/** The form of frames. */
export type Output = "faps" | Face | Rig;

/** A set of labels: "auto" is any of the others, in their order. */
export type Labels = "auto" | "arpabet" | "ipa" | "xsampa";

/** One phoneme and when it is spoken, seconds. `label` is any label that the model knows, "" for silence, "<laugh>" or
 * "<laugh:0.7>" for a laugh; `labels` is the set that is tried first. */
export interface Segment {
    start: number;
    end: number;
    label: string;
    labels?: Labels;
}

/** An error of the library, with its description. `code` is the result (labial_result_t), 0 without one. */
export class LabialError extends Error {
    readonly code: number;
}

/** A model that streams can use. */
export interface Model {
    /** The number of phonemes; they are numbered from 0. */
    readonly phonemes: number;
    /** The number of silence. */
    readonly silence: number;
    /** Frames per second. */
    readonly rate: number;
}

export interface StreamOptions<O extends Output = Output> {
    /** Default: "faps". */
    output?: O;
    /** The model of the first pushes. Default: "speech". */
    model?: "speech" | "laughter" | Model;
    /** Default: "auto". */
    labels?: Labels;
    /** Treatment of unknown labels: an exception ("error", the default), or the motion of the nearest known label. */
    unknown?: "error" | "nearest";
}

/** A frame of an output. */
export type FrameOf<O extends Output> =
    O extends Face ? Weights<O> : O extends Rig<infer Name> ? Record<Name, number> : Faps;

/** The laughter model as the package labial-laughter has it, or the bytes of its .lbm file. */
export type Laughter = string | ArrayBuffer | ArrayBufferView | { readonly default: unknown };

/** A mouth that moves while its phonemes are still arriving. */
export class Stream<O extends Output = "faps"> implements Iterable<FrameOf<O>> {
    /** Adds a phoneme, by label or number, of the current model; milliseconds from 0 to 3,600,000. Fractions of
     * milliseconds accumulate. Up to 65,536 phonemes may wait. */
    push(label: string | number, milliseconds: number, options?: { labels?: Labels; hint?: Labels }): void;
    /** Adds a laugh: seconds, 0 to 3,600; intensity from 0, a hum, to 1, an open mouth. The same seed gives the same
     * laugh; without one, every laugh of a stream is different. The laughter model must be loaded. */
    laugh(seconds: number, intensity?: number, seed?: number): void;
    /** Selects another model of the same frame rate for the next pushes. */
    use(model: "speech" | "laughter" | Model): void;
    /** No more phonemes will come. */
    end(): void;
    /** Drops what is not yet delivered and eases back to the neutral face; then the stream is done. */
    cancel(milliseconds?: number): void;
    /** Continues a stream that is done or was cancelled. */
    restart(): void;
    /** How far the mouth moves, in percent, 0 to 200: 100 at first, 50 a mumble, 130 a shout. Lips still close. From the
     * next frame that is taken in it comes nearer to that by up to 10 percent a frame. */
    articulation(percent: number): void;
    /** Call once per frame period: returns the next frame, or null if there is none yet. The frame is the same object
     * each time, which avoids garbage; copy it to keep it. */
    tick(): FrameOf<O> | null;
    /** All frames that are ready, each a new object. */
    [Symbol.iterator](): IterableIterator<FrameOf<O>>;
    /** Number of the frame that was delivered last, from 0; -1 before the first. */
    readonly number: number;
    /** When that frame is due, seconds after the first. */
    readonly time: number;
    /** Frames per second. */
    readonly rate: number;
    /** The model of the next push. */
    readonly model: Model;
    /** The stream was ended or cancelled, and every frame was delivered. */
    readonly done: boolean;
    /** The next frame waits for more phonemes. */
    readonly starved: boolean;
    /** The input that is pushed and not yet delivered, and `delay`, the frames from accepting a frame to delivering
     * it. */
    readonly latency: { frames: number; milliseconds: number; delay: number };
    /** Frees the memory at once; otherwise the garbage collector does. */
    free(): void;
}

/** The motion of a whole utterance. Frame k is due k / rate seconds after the sound begins. */
export class Track<O extends Output = "faps"> implements Iterable<FrameOf<O>> {
    readonly output: O;
    /** Frames per second. */
    readonly rate: number;
    /** Number of frames. */
    readonly length: number;
    /** Seconds. */
    readonly duration: number;
    /** The FAPs of all frames, 13 for each, whatever the output is. */
    readonly faps: Int16Array;
    /** The mouth at a time of the sound, seconds, interpolated between two frames. Before the beginning it is the first
     * frame, after the end the last one. The same object each time. */
    at(seconds: number): O extends "faps" ? Float32Array : FrameOf<O>;
    /** One frame. */
    frame(number: number): FrameOf<O>;
    [Symbol.iterator](): IterableIterator<FrameOf<O>>;
}

/** The library. One serves any number of streams. */
export class Labial {
    /** The library, with the speech model. `laughter` is the laughter model, or a function that loads it when laughter()
     * is called for the first time: `() => import("labial-laughter")`. `wasm` is a build of your own: its bytes, or the
     * compiled module. */
    static load(options?: {
        laughter?: Laughter | Promise<Laughter> | (() => Laughter | Promise<Laughter>);
        wasm?: BufferSource | WebAssembly.Module | Promise<BufferSource | WebAssembly.Module>;
    }): Promise<Labial>;
    /** The laughter model, loaded once; after that streams laugh. Rejects if load() got none. */
    laughter(): Promise<Model>;
    /** The bundled models; laughter is null until it is loaded. */
    readonly models: { readonly speech: Model; readonly laughter: Model | null };
    /** The attribution that the licence of the speech model's data requires. */
    readonly attribution: string;
    /** A new stream. */
    stream<O extends Output = "faps">(options?: StreamOptions<O>): Stream<O>;
    /** The motion of a whole utterance; gaps between segments are silence. */
    render<O extends Output = "faps">(timings: Iterable<Segment>, options?: StreamOptions<O>): Track<O>;
    /** The formats that read() takes. */
    readonly formats: readonly string[];
    /** Timings as text: .lab, flite, HTK, MBROLA, MaryTTS, Sphinx or TextGrid, one of `formats`; "auto", when left out,
     * is told from the first line. `tier` names that of a TextGrid. */
    read(text: string, options?: { format?: string; tier?: string }): Segment[];
    /** A model from a binary file (`labial export --blob`), which is checked. */
    model(bytes: ArrayBuffer | ArrayBufferView): Model;
    /** Your own face, from the JSON of `labial rig FACE.toml --json`, parsed or as text. It is checked. */
    rig<Name extends string = string>(description: unknown): Rig<Name>;
    /** The number of the phoneme that a label means. */
    phoneme(label: string | number, options?: { model?: Model; labels?: Labels; hint?: Labels; nearest?: boolean }): number;
    /** The label of a phoneme. */
    label(phoneme: number, model?: Model): string;
    /** FAPs of speaking while laughing: `intensity` is the amount of laughter, `words` how far it gives way to words,
     * both 0 .. 1. */
    blend(speech: ArrayLike<number>, laugh: ArrayLike<number>, intensity: number, words: number, out?: Int16Array): Faps;
    /** The weights of a face for 13 FAPs. */
    convert<F extends Face | Rig>(faps: ArrayLike<number>, output: F, out?: Partial<FrameOf<F>>): FrameOf<F>;
}

/** Readers of voices' timings; `source` is their JSON, parsed or as text. */
export namespace timings {
    /** Piper's audio chunks with `sample_rate` and `phoneme_alignments`, or its HTTP server's answer to /info. */
    function fromPiper(source: unknown): Segment[];
    /** Kokoro's results with `phonemes` and `pred_dur`. */
    function fromKokoro(source: unknown): Segment[];
    /** HeadTTS's answers with `phonemes`, `vtimes` and `vdurations`. */
    function fromHeadTTS(source: unknown): Segment[];
    /** Azure's viseme events. */
    function fromAzure(source: unknown): Segment[];
    /** Amazon Polly's speech marks. */
    function fromPolly(source: unknown): Segment[];
}
