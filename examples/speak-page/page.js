// The page: speaks what is typed, with the lips in step.
import start from "@echogarden/espeak-ng-emscripten";
import { LANGUAGES, base64, files, size } from "espeak-ng-data"; // of build.mjs
import { Labial } from "labial";
import { fromEspeak } from "labial/espeak.js";
import "labial/labial-face.js";

const [face, form, language, text, status, voice] = ["face", "form", "language", "text", "status", "voice"]
    .map((id) => document.getElementById(id));
language.append(...LANGUAGES.map(({ name }, i) => new Option(name, i)));
const chosen = () => LANGUAGES[Number(language.value)];
language.onchange = () => { text.value = chosen().text; };
language.onchange();

const ready = Promise.all([Labial.load(), load()]);
ready.then(() => { status.textContent = "Type something, and press Enter."; }, told);

face.addEventListener("ended", () => { face.caption = ""; });
form.onsubmit = (event) => {
    event.preventDefault();
    say(text.value).catch(told);
};

async function say(words) {
    const [labial, espeak] = await ready;
    const { samples, sampleRate, segments } = speak(espeak, chosen().voice, words);
    status.replaceChildren(...segments.map(shown));
    const track = labial.render(segments, { labels: "ipa", unknown: "nearest" });
    URL.revokeObjectURL(voice.src);
    voice.src = URL.createObjectURL(wav(samples, sampleRate));
    face.audio = voice;
    face.track = track;
    face.caption = words;
    await voice.play();
}

/** A phoneme, whose time the mouse finds. */
function shown({ start, end, label }) {
    const title = `${start.toFixed(3)} to ${end.toFixed(3)} s`;
    return Object.assign(document.createElement("span"), { textContent: label || " ", title });
}

function told(error) {
    if (error.name !== "AbortError") status.textContent = error.message; // which says that something else is said now
}

// ---- espeak-ng's sound of a text, and the phonemes that it reports with it

/** The voice, as soon as its data are unpacked. */
async function load() {
    const packed = await (await fetch(`data:application/octet-stream;base64,${base64}`)).blob();
    const unpacked = new Response(packed.stream().pipeThrough(new DecompressionStream("gzip")));
    const bytes = new Uint8Array(await unpacked.arrayBuffer());
    // The module expects the data of all languages; those that are left out are zeros, and are not read.
    const whole = new Uint8Array(size);
    for (let i = 0, at = 0; i < files.length; at += files[i++].length) {
        whole.set(bytes.subarray(at, at + files[i].length), files[i].start);
    }
    const module = await start({ getPreloadedPackage: () => whole.buffer });
    return new module.eSpeakNGWorker();
}

/** The sound of a text, in pieces of 16 bits, and its phonemes as segments in seconds. */
function speak(espeak, voice, text) {
    if (espeak.set_voice(voice) !== 0) throw new Error(`espeak-ng has no voice ${voice}`);
    const [samples, events] = [[], []];
    espeak.synthesize(text, (piece, found) => {
        if (piece) samples.push(piece);
        events.push(...found);
    });
    const sampleRate = espeak.get_samplerate();
    return { samples, sampleRate, segments: fromEspeak(events, { samples, sampleRate }) };
}

/** A WAV file of pieces of samples, for an <audio> element. */
function wav(samples, rate) {
    const header = new DataView(new ArrayBuffer(44));
    const bytes = samples.reduce((sum, { byteLength }) => sum + byteLength, 0);
    [..."RIFF    WAVEfmt                     data"].forEach((letter, i) => header.setUint8(i, letter.charCodeAt(0)));
    const long = [[4, 36 + bytes], [16, 16], [24, rate], [28, 2 * rate], [40, bytes]];
    const short = [[20, 1], [22, 1], [32, 2], [34, 16]]; // PCM, one channel, bytes and bits of a sample
    for (const [at, value] of long) header.setUint32(at, value, true);
    for (const [at, value] of short) header.setUint16(at, value, true);
    return new Blob([header, ...samples], { type: "audio/wav" });
}
