// What the types must allow and refuse: each line below an @ts-expect-error has to be an error.
import { Labial, type Faps, type Hearing, type Segment, type Stream, type Track, type Voice, type Weights, type Words } from "labial";
import { fromEspeak } from "labial/espeak.js";
import laughter from "labial-laughter";
import { attach } from "labial/attach.js";
import { LabialFace } from "labial/labial-face.js";
import type { LabialMouth } from "labial/labial-mouth.js";
import { createMouth, mouthShape } from "labial/mouth.js";

const labial = await Labial.load({ laughter: () => import("labial-laughter") });
await Labial.load({ laughter });
await Labial.load({ laughter: fetch("laughter.lbm").then((answer) => answer.arrayBuffer()) });

const arkit = labial.stream({ output: "arkit", labels: "ipa" });
const open: number | undefined = arkit.tick()?.jawOpen;
// @ts-expect-error the library comes from load()
new Labial();
// @ts-expect-error no weight has this name
arkit.tick()?.jawOppen;
// @ts-expect-error this one is VRM's
arkit.tick()?.aa;
// @ts-expect-error null until the first frame
arkit.tick().jawOpen;

const faps: Faps | null = labial.stream({ labels: "ipa" }).tick();
// @ts-expect-error FAPs have no names
labial.stream().tick()?.jawOpen;
const vrm: Track<"vrm"> = labial.render([{ start: 0, end: 1, label: "AA" }], { output: "vrm" });
const { aa, ih, ou } = vrm.at(0.5);
// @ts-expect-error no weight has this name
vrm.at(0.5).jawOpen;
for (const weights of vrm) weights.ou.toFixed();
const between: Float32Array = labial.render([]).at(0);
const sil: number = labial.convert(between, "oculus").sil;
// @ts-expect-error no face has this name
labial.convert(between, "arkitt");
// @ts-expect-error no output has this name
labial.stream({ output: "vrmm" });
// @ts-expect-error null until it is loaded
labial.models.laughter.fps;

const mine = labial.rig<"beak" | "brow">({});
const beak: number | undefined = labial.stream({ output: mine }).tick()?.beak;
labial.render([], { output: mine }).at(0).brow.toFixed();
labial.convert(between, labial.rig("{}")).anything.toFixed();
// @ts-expect-error the rig has no such output
labial.convert(between, mine).jawOpen;
// @ts-expect-error a rig comes from rig()
labial.stream({ output: { name: "mine", outputs: ["beak"] } });

const hears = await Labial.load({ hearing: () => import("labial-hearing") });
const heard = await hears.hear(new MediaStream(), { output: "arkit", model: "large", context: new AudioContext() });
const jaw: number = heard.at().jawOpen;
// @ts-expect-error no weight has this name
heard.at().jawOppen;
heard.sound?.connect(new AudioContext().destination);
await hears.hear(document.querySelector("audio"));
await hears.hear(new GainNode(new AudioContext()), { play: true });
const pushed: Hearing = await hears.hear(null, { sampleRate: 24000, channels: 2 });
pushed.push(new Int16Array(480), 3);
// @ts-expect-error bytes are no samples
pushed.push(new Uint8Array(480));
for await (const frame of pushed) frame.subarray(3);
hears.render(pushed.segments());
// @ts-expect-error this is no sound
await hears.hear("voice.wav");
// @ts-expect-error no model has this name
await hears.hear(null, { model: "huge" });

const speaks = await Labial.load({ words: () => import("labial-words") });
const words: Words = await speaks.words();
const own = { kokoro: "K OW K AO R OW", zed: ["Z", "EH", "D"] };
words.phonemes("Kokoro", { own, numbers: (digits) => digits.replaceAll(",", "") }).join();
speaks.render(words.wordTimings([{ text: "Hi", start: 0.1 }, { text: "you", start: 0.5, end: null }], { offset: 0.03 }));
words.characterTimings("my", [0, 0.1], [0.1, 0.3], { own: new Map([["my", "M AY"]]) });
words.characterTimings(["m", "y"], new Float64Array(2), new Float64Array(2));
const read: Segment[] = words.read([{ word: "go", start: 0, end: 1 }], { format: "words" });
const live = words.stream({ own });
const messages = words.reader({ format: "elevenlabs" });
for (const { text, start, end } of messages.read({}).words) live.push({ text, start, end });
for (const { label, start, end } of live.take()) speaks.stream().push(label, 1000 * (end - start), { hint: "arpabet" });
// @ts-expect-error a word has a beginning
live.push({ text: "go" });
// @ts-expect-error phonemes are text
words.phonemes("go", { own: { go: 5 } });
// @ts-expect-error this is not the package labial-words
await Labial.load({ words: () => import("labial-hearing") });
const voice = await speaks.voice({ format: "elevenlabs", output: "arkit", clock: new AudioContext(), own, offset: 0.03 });
voice.feed({ alignment: null });
voice.begin(1.5);
const opened: number = voice.at().jawOpen;
// @ts-expect-error no weight has this name
voice.at().jawOppen;
for (const { mouthClose } of voice.played(0.1)) mouthClose.toFixed();
for await (const weights of voice.follow()) weights.jawOpen.toFixed();
const followed: Voice = words.voice({ clock: new MediaStream() });
for await (const frame of followed.follow(() => null)) frame.subarray(3);
// @ts-expect-error this is no clock
await speaks.voice({ clock: 5 });
// @ts-expect-error no set of labels has this name
await speaks.voice({ labels: "x" });
const espoken: Segment[] = fromEspeak([{ type: "phoneme", audio_position: 0, id: "m" }]);
fromEspeak([], { samples: [new Int16Array(5)], sampleRate: 22050 });
// @ts-expect-error the rate of the sound is missing
fromEspeak([], { samples: new Int16Array(5) });

pushed.addEventListener("lost", ({ type }) => type.trim());
followed.addEventListener("ended", () => {});
// @ts-expect-error no event has this name
followed.addEventListener("finished", () => {});
const gap: number = mouthShape(between).gap;
createMouth(document.body)(between);
// @ts-expect-error text is no place
createMouth("face");
const head = attach({ traverse: () => {} });
head.source = labial.render([], { output: head.output });
head.audio = document.querySelector("audio");
head.update();
// @ts-expect-error this is no avatar
attach("avatar.glb");
const drawn = new LabialFace();
drawn.words = words.reader().read({}).words;
drawn.track = labial.render([]);
// @ts-expect-error words have times
drawn.words = ["Hello"];

/** Code that does not know the face. */
function total(weights: Weights): number {
    return Object.values<number>(weights).reduce((sum, one) => sum + one, 0);
}

function any(stream: Stream<"arkit" | "vrm">): void {
    const frame = stream.tick();
    if (frame) total(frame);
}

function follow(mouth: LabialMouth, track: Track, stream: Stream): void {
    mouth.track = track;
    mouth.stream = stream;
    mouth.hearing = pushed;
    mouth.voice = followed;
    // @ts-expect-error what is drawn has the output "faps"
    mouth.track = vrm;
}

export { aa, any, beak, espoken, faps, follow, gap, ih, jaw, open, opened, ou, read, sil };
