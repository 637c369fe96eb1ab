// A page that speaks, laughs when it is tapped, and can be interrupted at any moment.
import { Labial } from "labial";
import "labial/labial-face.js";

const [face] = document.getElementsByTagName("labial-face");
const [voice] = document.getElementsByTagName("audio");
const [status] = document.getElementsByTagName("p");
const labial = await Labial.load({ laughter: () => import("labial-laughter") });
const laughter = labial.stream();
// What is said: a sound, the times of its phonemes, and who reads these. For a server's voice, change this line.
const WORDS = { sound: "welcome.flac", timings: "welcome.lab", read: (text) => labial.read(text), captions: [
    { text: "Welcome!", start: 0.22 }, { text: "My name is Bobby.", start: 0.77, end: 2 },
    { text: "Tap my mouth, and I will laugh.", start: 2.21, end: 4.12 },
    { text: "Tap it while I am speaking, and I stop.", start: 4.21, end: 6.53 },
] };
let turn = 0; // whoever asked last has the mouth

/** Interrupts what the mouth does. The result is that of `prepare`, once the mouth is at rest; null when somebody else
 * has asked for the mouth in the meantime. */
async function interrupt(prepare) {
    const mine = ++turn;
    const [ready] = await Promise.all([prepare?.(), face.cancel(200)]);
    return mine === turn ? (ready ?? true) : null;
}

async function text(address) {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
    return answer.text();
}

async function speak(words) {
    const times = await interrupt(() => text(words.timings));
    if (times === null) return;
    face.audio = voice;
    face.track = labial.render(words.read(times), { unknown: "nearest" });
    face.words = words.captions;
    voice.src = words.sound;
    await voice.play();
}

async function laugh() {
    if (!(await interrupt(() => labial.laughter()))) return;
    if (laughter.done) laughter.restart();
    laughter.laugh(1.5, 0.7);
    laughter.end();
    face.audio = null; // a laugh without a sound goes by itself
    face.stream = laughter;
}

/** On a tap does something, and says what went wrong; that a sound was interrupted is nothing wrong. */
function onTap(id, action) {
    document.getElementById(id)?.addEventListener("click", () => action().catch((error) => {
        if (error.name !== "AbortError") status.textContent = error.message;
    }));
}

onTap("face", laugh);
onTap("speak", () => speak(WORDS));
onTap("stop", () => interrupt());
status.textContent = "Tap the face, and it laughs.";
