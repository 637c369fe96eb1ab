import { LabialMouth } from "./labial-mouth.js";
import type { TimedWord } from "./index.js";

/** The element <labial-face>: a whole drawn face, which does all that <labial-mouth> does. Its eyes blink and its brows move,
 * unless the visitor prefers reduced motion. It can have the keyboard's focus, where Enter and the space bar are clicks, and
 * screen readers name it in the language of the place where it stands (`lang`); an `aria-label` or a `role` of your own
 * replaces that.
 *
 * It is light or dark as `color-scheme` says. CSS variables: --labial-skin, --labial-hair, --labial-lips, --labial-iris,
 * --labial-backdrop-top, --labial-backdrop-bottom; `::part(caption)` is the caption. */
export class LabialFace extends LabialMouth {
    /** Captions: the words that are spoken, by `position`. They are shown line by line, and in
     * a line of several words the one that is spoken is marked. null for none, and cancel() sets that. */
    get words(): readonly TimedWord[];
    set words(words: Iterable<TimedWord> | null);
    /** The caption that is shown. A text that is set stays until another one, or words, are set. */
    get caption(): string;
    set caption(text: string | null);
}

declare global {
    interface HTMLElementTagNameMap {
        "labial-face": LabialFace;
    }
}
