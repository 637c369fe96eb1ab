// Finds out which weights a loaded avatar takes, and moves it. modules.d.ts documents it.
import { LabialError, heard, shown } from "./memory.js";

/** Milliseconds in which a mouth comes to rest. */
const CLOSING = 200;

/** A name without its case, separators and the mesh's name before a dot; behind some dots is a side, L or R. */
const plain = (name) => name.replace(/^.*\.(?=[^.]{2})/, "").replace(/[\W_]/g, "").toLowerCase();

/** Other names of a weight: Ready Player Me's visemes, VRoid's shapes, sides as Face Cap has them. */
function namesOf(output, weight) {
    const names = [weight];
    if (output === "arkit") names.push(weight.replace(/(L)eft$|(R)ight$/, "$1$2"));
    if (output === "oculus") names.push(`viseme_${weight}`, `viseme_${{ ih: "I", oh: "O", ou: "U" }[weight] ?? weight}`, `v_${weight}`);
    if (output === "vrm") names.push(`Fcl_MTH_${{ aa: "A", ih: "I", ou: "U", ee: "E", oh: "O" }[weight]}`);
    return names.map(plain);
}

/** What tells a kind of avatar: so many of these weights. The first that is found is taken. */
const KINDS = Object.entries({
    arkit: ["jawOpen", "mouthFunnel", "mouthPucker", "mouthClose"],
    oculus: ["PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"],
    vrm: ["aa", "ih", "ou", "ee", "oh"],
});
const ENOUGH = { arkit: 4, oculus: 8, vrm: 3 };
const AH = ["oculus", "vrm"].flatMap((kind) => namesOf(kind, "aa"));

export class Head {
    #move; // by the plain name of a shape or an expression, what sets it
    #places = new Map(); // of each weight: what it moves
    #source = null;
    #shown = {}; // weights of the source
    #closing = null; // what eases them to rest, after the source

    constructor(output, meshes, move) {
        this.output = output;
        this.meshes = meshes;
        this.audio = null;
        this.#move = move;
    }

    get source() { return this.#source; }

    set source(source) {
        if (source && typeof source.at !== "function") {
            throw new TypeError(`the source is ${shown(source)}, which has no at(): set what a promise resolves to`);
        }
        if (source?.output !== undefined && source.output !== this.output) {
            const [given, taken] = [source, this].map(({ output }) => (typeof output === "string" ? output : "a rig's"));
            throw new TypeError(`the source's output is ${given}, and the head takes ${taken}: { output: head.output } makes it so`);
        }
        if (source) this.#closing = null;
        else if (this.#source) this.#closing = this.#closes();
        this.#source = source ?? null;
    }

    show(weights) {
        this.#closing = null;
        this.#set(weights);
    }

    update(seconds) {
        if (this.#source?.closed) this.source = null; // by its owner
        const source = this.#source;
        if (!source) {
            if (this.#closing) this.#set(this.#closing());
            return;
        }
        const at = seconds ?? (this.audio ? heard(this.audio) : undefined);
        if (at === undefined && source.at.length > 0) throw new TypeError("the source has no clock: set head.audio, or say the time");
        this.#shown = at === undefined ? source.at() : source.at(at);
        this.#set(this.#shown);
    }

    rest() {
        this.#closing = null;
        for (const places of this.#places.values()) places.forEach((set) => set(0));
    }

    #set(weights) {
        for (const [name, weight] of Object.entries(weights)) this.#placesOf(name).forEach((set) => set(weight));
    }

    /** What eases the weights to rest, each time it is called; in the end they rest even if nobody calls it. */
    #closes() {
        const from = Object.entries(this.#shown);
        const begin = performance.now();
        const ease = () => {
            const left = Math.max(0, 1 - (performance.now() - begin) / CLOSING);
            return Object.fromEntries(from.map(([name, weight]) => [name, weight * left]));
        };
        setTimeout(() => { if (this.#closing === ease) this.rest(); }, CLOSING);
        return ease;
    }

    #placesOf(name) {
        let places = this.#places.get(name);
        if (!places) {
            const names = namesOf(this.output, name);
            const found = names.find((one) => this.#move.has(one)) ?? plain(name);
            places = this.#move.get(found) ?? [];
            this.#places.set(name, places);
        }
        return places;
    }
}

/** Finds the shapes of an avatar: a scene, what GLTFLoader loads, or what three-vrm makes of it. */
export function attach(avatar, { output } = {}) {
    const vrm = avatar?.userData?.vrm ?? (avatar?.expressionManager ? avatar : null);
    const scene = vrm?.scene ?? avatar?.scene ?? avatar;
    if (typeof scene?.traverse !== "function") {
        throw new TypeError("the avatar is none: a scene of three.js, what GLTFLoader loads, or a VRM of three-vrm");
    }
    const move = new Map();
    const reached = new Map(); // by the plain name of a shape, how far it moves the head
    const add = (name, set) => {
        const known = plain(name);
        if (!move.has(known)) move.set(known, []);
        move.get(known).push(set);
    };
    const meshes = [];
    const manager = vrm?.expressionManager;
    for (const name of manager ? Object.keys(manager.expressionMap) : []) add(name, (weight) => manager.setValue(name, weight));
    const expressed = manager && kindOf(move, reached);
    const isExpressed = expressed && (typeof output !== "string" || output === expressed);
    scene.traverse((mesh) => {
        if (!mesh.morphTargetDictionary) return;
        meshes.push(mesh);
        if (isExpressed) return; // the expressions move the shapes
        for (const [name, place] of Object.entries(mesh.morphTargetDictionary)) {
            add(name, (weight) => { mesh.morphTargetInfluences[place] = weight; });
            const known = plain(name);
            if (known === "jawopen" || AH.includes(known)) {
                reached.set(known, Math.max(reached.get(known) ?? 0, reach(mesh.geometry?.morphAttributes?.position?.[place])));
            }
        }
    });
    const kind = output ?? kindOf(move, reached);
    const fits = typeof output !== "string" || KINDS.some(([one, names]) => one === output && names.some(has(move, one)));
    if (!fits) throw new LabialError(`the avatar has none of the shapes of ${JSON.stringify(output)}`);
    if (!kind) {
        const names = [...new Set(meshes.flatMap((mesh) => Object.keys(mesh.morphTargetDictionary)))];
        if (!names.length) throw new LabialError("the avatar has no shapes (morph targets)");
        const part = KINDS.find(([one, all]) => all.some(has(move, one)))?.[0];
        throw new LabialError(`the avatar's shapes are ${part ? "too few of ARKit's or of visemes" : "neither ARKit's nor visemes"}: ` +
            `${names.slice(0, 8).join(", ")}${names.length > 8 ? ", ..." : ""}; labial fit makes a rig for them` +
            (part ? `, and { output: "${part}" } moves those that there are` : ""));
    }
    return new Head(kind, meshes, move);
}

/** Whether there is a weight of a kind, under any of its names. */
function has(move, kind) {
    return (name) => namesOf(kind, name).some((one) => move.has(one));
}

/** How far a shape moves a vertex at most; endlessly where that is not known. */
function reach(moves) {
    let most = 0;
    for (let i = 0; i < (moves?.count ?? 0); i++) most = Math.max(most, Math.hypot(moves.getX(i), moves.getY(i), moves.getZ(i)));
    return moves ? most : Infinity;
}

/** The first kind whose names are there. Heads whose jaw hardly opens, as VRoid's to which ARKit's names were added, have
 * visemes that open the mouth. */
function kindOf(move, reached) {
    const opens = reached.get("jawopen") ?? Infinity, ah = Math.max(0, ...AH.map((name) => reached.get(name) ?? 0));
    return KINDS.find(([kind, names]) => names.filter(has(move, kind)).length >= ENOUGH[kind] &&
        (kind !== "arkit" || opens >= ah / 2))?.[0];
}
