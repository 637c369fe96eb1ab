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
