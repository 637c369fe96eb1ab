// The page: speaks what is typed, with the lips in step.
import { Labial } from "labial";
import "labial/labial-face.js";
import { load, speak, wav } from "./espeak.js";
import { LANGUAGES } from "./languages.mjs";

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
