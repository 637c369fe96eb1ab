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
    readonly fps: number;
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
    /** Only the frames of the phonemes: the mouth stays as the last one leaves it, and where phonemes are late. By
     * default it comes to rest, in 12 frames. */
    exact?: boolean;
}

/** A frame of an output. */
export type FrameOf<O extends Output> =
    O extends Face ? Weights<O> : O extends Rig<infer Name> ? Record<Name, number> : Faps;

/** The laughter model as the package labial-laughter has it, or the bytes of its .lbm file. */
export type Laughter = string | ArrayBuffer | ArrayBufferView | { readonly default: unknown };

/** A mouth that moves while its phonemes are still arriving. Its first frames lead from the neutral face to the motion. */
export class Stream<O extends Output = "faps"> implements Iterable<FrameOf<O>> {
    private constructor();
    /** Adds a phoneme, by label or number, of the current model; milliseconds from 0 to 3,600,000. Fractions of
     * milliseconds accumulate. Up to 65,536 phonemes may wait. */
    push(label: string | number, milliseconds: number, options?: { labels?: Labels; hint?: Labels }): void;
    /** Adds a laugh: seconds, 0 to 3,600; intensity from 0, a hum, to 1, an open mouth. The same seed gives the same
     * laugh; without one, every laugh of a stream is different. The laughter model must be loaded. */
    laugh(seconds: number, intensity?: number, seed?: number): void;
    /** Selects another model of the same frame rate for the next pushes. */
    use(model: "speech" | "laughter" | Model): void;
    /** No more phonemes will come: after the frames of the last one the mouth comes to rest. */
    end(): void;
    /** Drops what is not yet delivered and eases back to the neutral face over so many milliseconds, by default 200,
     * rounded up to whole frames, 1 to 1,000; then the stream is done. */
    cancel(milliseconds?: number): void;
    /** Continues a stream that was cancelled or that has ended and delivered the frames of all phonemes. */
    restart(): void;
    /** How far the mouth moves, in percent, 0 to 200: 100 at first, 50 a mumble, 130 a shout. Lips still close. From the
     * next frame that is taken in it comes nearer to that by up to 10 percent a frame. */
    articulation(percent: number): void;
    /** Call once per frame period: returns the next frame, or null if there is none yet. The frame is the same object
     * each time, which avoids garbage; copy it to keep it. Where phonemes are late for more than five calls the mouth
     * comes to rest: then it returns frames, too, and `number` stays as it is. */
    tick(): FrameOf<O> | null;
    /** All frames that are ready, each a new object. */
    [Symbol.iterator](): IterableIterator<FrameOf<O>>;
    /** Whether it has only the frames of the phonemes, as the option; from the next frame on. */
    exact: boolean;
    /** Number of the frame that was delivered last, from 0; -1 before the first. */
    readonly number: number;
    /** How much of each sound that frame shows: 15 shares of together 128, in the order sil, PP, FF, TH, DD, kk, CH, SS,
     * nn, RR, aa, E, ih, oh, ou. The weights of faces already follow them. */
    readonly visemes: Uint8Array;
    /** When that frame is due, seconds after the first. */
    readonly time: number;
    /** Frames per second. */
    readonly fps: number;
    /** The form of its frames. */
    readonly output: O;
    /** The model of the next push. */
    readonly model: Model;
    /** The stream was ended or cancelled, and every frame was delivered. */
    readonly done: boolean;
    /** The next frame waits for more phonemes: the stream is late by one frame for each tick after which this holds. */
    readonly starved: boolean;
    /** The input that is pushed and not yet delivered, and `delay`, the frames from accepting a frame to delivering
     * it. */
    readonly latency: { frames: number; milliseconds: number; delay: number };
    /** Frees the memory at once; otherwise the garbage collector does. */
    free(): void;
    /** Whether its memory was freed. */
    readonly closed: boolean;
}

/** The motion of a whole utterance. Frame k is due k / fps seconds after the sound begins. It begins and ends at rest, as
 * a rule 12 frames after the last segment, unless it was to be exact. */
export class Track<O extends Output = "faps"> implements Iterable<FrameOf<O>> {
    private constructor();
    readonly output: O;
    /** Frames per second. */
    readonly fps: number;
    /** Number of frames. */
    readonly length: number;
    /** Seconds. */
    readonly duration: number;
    /** The FAPs of all frames, 13 for each, whatever the output is. */
    readonly faps: Int16Array;
    /** How much of each sound each frame shows, 15 shares for each, as a stream's `visemes`. */
    readonly visemes: Uint8Array;
    /** The mouth at a time of the sound, seconds, interpolated between two frames. Before the beginning it is the first
     * frame, after the end the last one. The same object each time. */
    at(seconds: number): O extends "faps" ? Float32Array : FrameOf<O>;
    /** One frame. */
    frame(number: number): FrameOf<O>;
    [Symbol.iterator](): IterableIterator<FrameOf<O>>;
}

/** Seconds of an <audio> or <video> element's sound, for a track's at(). After the sound, where the element's own time
 * stands, time goes on, so that the mouth comes to rest. */
export function heard(audio: { readonly currentTime: number; readonly ended?: boolean }): number;

/** An object of pages, if the program has the types of pages. */
type Dom<Name extends string> = typeof globalThis extends { [key in Name]: { prototype: infer One } } ? One : unknown;

/** What can be heard: a MediaStream, an <audio> or <video> element, or an AudioNode. */
export type Sound =
    | { getAudioTracks(): unknown[] }
    | { play(): Promise<void>; currentTime: number }
    | { readonly context: unknown; readonly numberOfOutputs: number };

export interface HearOptions<O extends Output = Output> {
    /** Default: "faps". */
    output?: O;
    /** Default: "small". "large" hears better, and better still what the package labial-hearing-host has, as in
     * `model: () => import("labial-hearing-host")`. A page fetches the one that it uses. */
    model?: "small" | "large" | object | (() => object);
    /** Of a sound that is pushed: samples per second, 8000, 12000, 16000, 22050, 24000, 32000, 44100 or 48000. */
    sampleRate?: number;
    /** Of a sound that is pushed: 1, the default, or 2, whose samples come in pairs, left first. */
    channels?: 1 | 2;
    /** The AudioContext whose clock counts. By default that of the node; one for all other sources. */
    context?: Dom<"AudioContext">;
    /** Whether the sound is played, in step with the lips: by default it is, but that of an AudioNode is not. Of several
     * hearings of one element the loudspeaker has the one that began last, of those that play; as it closes, the one before. */
    play?: boolean;
    /** Seconds by which the sound is played later than it comes, at least `latency`. Default: 0.2. */
    delay?: number;
    /** Whether end() gives the frames of the sound alone. By default the mouth comes to rest, in 12 more. */
    exact?: boolean;
}

/** The package labial-hearing. */
export type Hears = { readonly hear: (...given: any[]) => Promise<unknown> } | { readonly default: unknown };

/** Lips from sound alone, 50 frames per second; at rest in silence. All times are seconds: of the AudioContext's clock for a source; for a
 * sound that is pushed, those that push() was given, or from 0 on. */
export class Hearing<O extends Output = "faps"> implements Iterable<FrameOf<O>>, AsyncIterable<FrameOf<O>> {
    #private;
    private constructor();
    /** Hears samples, full scale being 32768 or 1; `time` is when the first of them is heard, by default when those
     * before it end. Silence fills gaps. Not for a source. */
    push(samples: Int16Array | Float32Array, time?: number): void;
    /** No more sound will come: the last frames and the way to rest follow. */
    end(): void;
    /** Drops the frames after this time, by default now, and eases to the neutral face over so many milliseconds, by
     * default 200, rounded up to whole frames, 1 to 1,000. Sound of a source is silenced, and what comes of it is not heard. */
    cancel(milliseconds?: number, seconds?: number): void;
    /** Continues after end() or cancel(). */
    restart(): void;
    /** How far the mouth moves, as a stream's: from the next frame that is heard it comes nearer to that. */
    articulation(percent: number): void;
    /** The mouth at a time, by default now, interpolated between two frames; the last one if it is too
     * early to know. The same object each time. Without an AudioContext the time must be given. */
    at(seconds?: number): O extends "faps" ? Float32Array : FrameOf<O>;
    /** The frames that are ready, each a new object. Of frames that nobody takes, the last 262,144 stay. */
    [Symbol.iterator](): IterableIterator<FrameOf<O>>;
    /** The frames to the end, each as soon as it is ready. */
    [Symbol.asyncIterator](): AsyncIterableIterator<FrameOf<O>>;
    /** How much of each sound the last frame shows, as a stream's `visemes`, by the lip classes that lead in it and
     * beside it. */
    readonly visemes: Uint8Array;
    /** The stretches of one lip class that ended since the last call; the label is a phoneme that stands for the class:
     * "M" for p, b, m. */
    segments(): Segment[];
    /** Number of the last frame, from 0; -1 before the first. */
    readonly number: number;
    /** When that frame is due. */
    readonly time: number;
    /** The time that is heard now; null without an AudioContext. */
    readonly now: number | null;
    /** Frames per second. */
    readonly fps: number;
    /** Seconds from a frame's begin in the sound until it is ready: 0.12. */
    readonly latency: number;
    /** Seconds by which the sound of a source is played later, so that lips are ready by then; 0 for a sound that is
     * pushed. */
    readonly delay: number;
    /** It was ended, cancelled or closed, and has no frame left. */
    readonly done: boolean;
    /** The AudioContext whose clock counts, or null. */
    readonly context: Dom<"AudioContext"> | null;
    /** The form of its frames. */
    readonly output: O;
    /** The sound of a source in step with the lips, to be connected where `play` is false; null for a sound that is
     * pushed. */
    readonly sound: Dom<"AudioNode"> | null;
    /** "ended": the element or the node that is heard has played to its end. "lost": the stream has lost its sound, since
     * the microphone was unplugged or forbidden, or the connection closed. Both when the sound before that was heard. */
    addEventListener(type: "ended" | "lost", listener: (event: { readonly type: string }) => void, options?: { once?: boolean }): void;
    removeEventListener(type: "ended" | "lost", listener: (event: { readonly type: string }) => void): void;
    /** Lets go of the source. A hearing with a source stays until then. at() is the neutral face from then on: cancel()
     * leads there smoothly. */
    close(): void;
    /** Whether it was closed. */
    readonly closed: boolean;
}

/** The package labial-words. */
export type HasWords = { readonly words: (...given: any[]) => Promise<unknown> } | { readonly default: unknown };

/** How words are pronounced. */
export interface Pronunciation {
    /** Words that are pronounced otherwise, with their phonemes in ARPABET: `{ google: "G UW G AH L" }`. */
    own?: Readonly<Record<string, string | readonly string[]>> | ReadonlyMap<string, string | readonly string[]> | null;
    /** Writes out a number, given as it stands in the text: "1984", "1,234.5". */
    numbers?: ((digits: string) => string) | null;
}

export interface WordOptions extends Pronunciation {
    /** Seconds that are added to all times: a positive number for a voice that reports its words too early. */
    offset?: number;
}

/** A word as it is written, punctuation included, and when it is spoken, seconds. */
export interface TimedWord {
    text: string;
    start: number;
    /** Without it the word lasts until the next one, or as long as such a word usually does. */
    end?: number | null;
    /** When each of its characters ends, if you know that. */
    ends?: Iterable<number> | null;
}

/** What a message tells: a text, a character, or a phoneme of the IPA, and its time, seconds from the beginning of the
 * sound; null where it does not tell when a word ends. */
export interface TimedText {
    text: string;
    start: number;
    end: number | null;
}

/** What a message tells. */
export interface Told {
    phonemes: TimedText[];
    words: TimedText[];
    characters: TimedText[];
    /** Of Fish Audio: of each chunk the latest message counts. */
    chunk?: number;
}

/** Reads the messages of one answer, as they arrive. */
export class MessageReader {
    #private;
    private constructor();
    /** The format; "auto" until a message tells it. */
    readonly format: string;
    /** Reads a message, or several; all lists are empty where it tells no words. */
    read(source: unknown): Told;
}

/** Words on their way to phonemes, while they are still arriving. */
export class WordStream {
    #private;
    private constructor();
    /** Adds a word. How it ends depends on what follows, so that its phonemes come with the next word or end(). */
    push(word: TimedWord): void;
    /** No more words will come: the last one ends where it said. */
    end(): void;
    /** Continues after end(): words of the same sound may follow. */
    restart(): void;
    /** The segments that became known since the last call; they follow each other without gaps, from 0 on. */
    take(): Segment[];
    /** Frees the memory at once; otherwise the garbage collector does. */
    free(): void;
}

/** English words and characters with their times to phonemes and theirs. */
export class Words {
    #private;
    private constructor();
    /** The phonemes of a text, in ARPABET without stress, word after word. */
    phonemes(text: string, options?: Pronunciation): string[];
    /** Segments from words in the order in which they are spoken. */
    wordTimings(words: Iterable<TimedWord>, options?: WordOptions): Segment[];
    /** Segments from characters, blanks included, and when each begins and ends, seconds. */
    characterTimings(text: Iterable<string>, starts: Iterable<number>, ends: Iterable<number>, options?: WordOptions): Segment[];
    /** The formats that read() takes. */
    readonly formats: readonly string[];
    /** Timings of any voice: the JSON of a service, parsed or as text, a message or a list of them in the order of their
     * arrival, or the text of a `.lab` and its like. `format` names the format; without it the content tells. */
    read(source: unknown, options?: WordOptions & { format?: string }): Segment[];
    /** What reads the messages of one answer one by one. */
    reader(options?: { format?: string }): MessageReader;
    /** A new stream of words. */
    stream(options?: WordOptions): WordStream;
    /** What labial.voice() resolves to. */
    voice<O extends Output = "faps">(options?: VoiceOptions<O>): Voice<O>;
}

/** How much of a sound was heard: the time of an AudioContext, less what its device needs, of an <audio> or <video>
 * element, of a MediaStream, by an AudioContext, or what a function returns: seconds, or null while nothing is heard. */
export type Clock =
    | { readonly currentTime: number; readonly destination: unknown }
    | { play(): Promise<void>; currentTime: number }
    | { getAudioTracks(): unknown[] }
    | (() => number | null | undefined);

export interface VoiceOptions<O extends Output = Output> extends WordOptions {
    /** What the service's messages are, such as "elevenlabs"; "auto", the default, recognises them. */
    format?: string;
    /** Default: "faps". */
    output?: O;
    /** Default: "speech". */
    model?: "speech" | Model;
    /** The set of labels of phonemes. Default: "auto". */
    labels?: Labels;
    /** Treatment of unknown labels of push(), as of a stream; those of services move like the nearest known one. */
    unknown?: "error" | "nearest";
    /** By which the voice is heard. Without one, times are given to each call. */
    clock?: Clock;
    /** The AudioContext that counts for a MediaStream; by default one for all of them. */
    context?: Dom<"AudioContext">;
}

/** Lips that follow a voice whose words or phonemes become known while it is heard. Times of messages are seconds
 * from the beginning of the utterance, all others those of the clock. A frame is due when number / fps seconds of the
 * sound were heard; it is final once a call has returned it. */
export class Voice<O extends Output = "faps"> {
    #private;
    private constructor();
    /** Takes a message of the service, parsed, as text or as bytes. Messages without timings are passed over. Throws where
     * one is malformed; earlier ones stay. */
    feed(message: unknown): void;
    /** Takes a word as it is written; without an end it lasts until the next one, or as long as it usually does. */
    say(text: string, start: number, end?: number | null): void;
    /** Takes a phoneme, by label or number of the model. Where an utterance has phonemes, its words are not read. */
    push(label: string | number, start: number, end: number): void;
    /** Begins the next utterance, whose sound begins at this time of the clock; by default where the one before ends, or
     * now if that is over. With the clock of an AudioContext or a MediaStream the first call says when the first
     * utterance begins; until then lips rest. A clock that was set back, as that of an element with another sound, counts
     * from there. `utterance` is what the service calls it, if it does: messages of others that are over are dropped.
     * It moves messages that came before their sound begins there: the utterance of this name, or without one the first that
     * waits. */
    begin(at?: number | null, utterance?: string | null): void;
    /** The sound goes on so many seconds later than it would have, because its next piece came too late: lips wait. Only
     * for a clock that does not stop with the sound, as that of an AudioContext. */
    delay(seconds: number): void;
    /** Nothing more follows. If no message told timings, a warning says so. */
    finish(): void;
    /** Drops what is not yet shown and eases to the neutral face over so many milliseconds, by default 200, rounded up to
     * whole frames, 1 to 1,000. It ignores messages of the cancelled utterance until begin(). */
    cancel(milliseconds?: number): void;
    /** The frames that became due since the last call, each a new object; usually none to three. More than a second after
     * the last call only the latest one is returned. */
    played(seconds?: number | null): FrameOf<O>[];
    /** The frame that is due, by default now: for each picture that is drawn. The same object each time. */
    at(seconds?: number | null): FrameOf<O>;
    /** The frames as they become due, until the voice is closed or, after finish(), done; by default by its own clock. */
    follow(clock?: () => number | null | undefined): AsyncIterableIterator<FrameOf<O>>;
    /** How much of each sound the last frame shows, as a stream's `visemes`. */
    readonly visemes: Uint8Array;
    /** Number of the last frame, from 0; -1 before the first. */
    readonly number: number;
    /** When that frame was due. */
    readonly time: number;
    /** Its clock, or null. */
    readonly clock: Clock | null;
    /** The time that is heard now; null while nothing is heard. Throws without a clock. */
    readonly now: number | null;
    /** Frames per second. */
    readonly fps: number;
    /** Nothing is left: after finish(), half a second after the last word, if there was any, also where the clock stops
     * there; after cancel(), when the face is neutral. */
    readonly done: boolean;
    /** The form of its frames. */
    readonly output: O;
    /** Nothing has begun since cancel(). */
    readonly cancelled: boolean;
    /** What became so far of the messages: how many there were; words, phonemes and so on that came and that made no
     * sense; messages of utterances that are over, and those that came twice. */
    readonly stats: {
        readonly messages: number; readonly told: number; readonly skipped: number; readonly dropped: number;
    };
    /** "ended": nothing of the utterance is left, after finish(). */
    addEventListener(type: "ended", listener: (event: { readonly type: string }) => void, options?: { once?: boolean }): void;
    removeEventListener(type: "ended", listener: (event: { readonly type: string }) => void): void;
    /** Frees the memory at once; otherwise the garbage collector does. at() is the neutral face from then on: cancel()
     * leads there smoothly. Other calls throw. */
    close(): void;
    /** Whether it was closed. */
    readonly closed: boolean;
}

/** The bytes of a module, or what they are compiled to, a WebAssembly.Module, which not every program's types know. */
type Wasm = ArrayBuffer | ArrayBufferView | object;

/** The library. One serves any number of streams. */
export class Labial {
    private constructor();
    /** The library, with the speech model. `laughter` is the laughter model, or a function that loads it when laughter()
     * is called for the first time: `() => import("labial-laughter")`; `hearing` is likewise the package labial-hearing, for
     * hear(). `wasm` is a build of your own: its bytes, or the compiled module. */
    static load(options?: {
        laughter?: Laughter | Promise<Laughter> | (() => Laughter | Promise<Laughter>);
        hearing?: Hears | Promise<Hears> | (() => Hears | Promise<Hears>);
        words?: HasWords | Promise<HasWords> | (() => HasWords | Promise<HasWords>);
        wasm?: Wasm | Promise<Wasm>;
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
    /** Lips of a sound: of a source, or, without one, of samples that are pushed. Rejects if load() got no package
     * labial-hearing, or where the page cannot hear. */
    hear<O extends Output = "faps">(source?: Sound | null, options?: HearOptions<O>): Promise<Hearing<O>>;
    /** What turns words into phonemes, loaded once. Rejects if load() got no package labial-words. */
    words(): Promise<Words>;
    /** Lips of a voice whose messages arrive while it is heard. Rejects if load() got no package labial-words. */
    voice<O extends Output = "faps">(options?: VoiceOptions<O>): Promise<Voice<O>>;
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
    /** The weights of a face for 13 FAPs, and for the shares of the sounds that they show, if you have these: a tongue,
     * teeth and pressed lips need them. */
    convert<F extends Face | Rig>(faps: ArrayLike<number>, output: F, out?: Partial<FrameOf<F>>,
                                  visemes?: ArrayLike<number> | null): FrameOf<F>;
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
