import type { Segment } from "./index.js";

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
