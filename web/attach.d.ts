import type { Face, Hearing, Rig, Track, Voice, Weights } from "./index.js";

/** A loaded avatar: a scene of three.js, what its GLTFLoader loads, or a VRM of three-vrm. */
export type Avatar = { traverse(visit: (node: any) => void): void } | { scene: { traverse(visit: (node: any) => void): void } };

/** What is shown at a time, seconds. */
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
     * within a fifth of a second. */
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
 * labial.rig(), or the face to take if there are several. Throws a LabialError where no names are known. */
export function attach<O extends Face | Rig = Face>(avatar: Avatar, options?: { output?: O }): Head<O>;
