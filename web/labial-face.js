// <labial-face>: <labial-mouth> with a whole face around it, captions, a name for screen readers, and a place in the order
// of the keyboard. modules.d.ts documents it.
import { LabialMouth, define } from "./labial-mouth.js";
import { createFace } from "./mouth.js";

/** What screen readers call it, by the language of the place where it stands. */
const NAMES = {
    ar: "وجه يتحدث", cs: "Mluvící tvář", da: "Et talende ansigt", de: "Ein sprechendes Gesicht", en: "A speaking face",
    es: "Una cara que habla", fi: "Puhuvat kasvot", fr: "Un visage qui parle", hi: "बोलता हुआ चेहरा",
    it: "Un volto che parla", ja: "話す顔", ko: "말하는 얼굴", nl: "Een pratend gezicht", nn: "Eit snakkande ansikt",
    no: "Et snakkende ansikt", pl: "Mówiąca twarz", pt: "Um rosto que fala", ru: "Говорящее лицо", sv: "Ett talande ansikte",
    tr: "Konuşan bir yüz", uk: "Обличчя, що говорить", zh: "说话的脸",
};
/** Codes of the same language. */
const ALIASES = { nb: "no" };
/** Most characters of a line of captions, and seconds for which it stays. */
const LINE = 42;
const STAYS = 1;

const STYLE = `
:host { display: block; position: relative }
:host(:focus-visible) { outline: 3px solid Highlight; outline-offset: 3px }
div, svg { display: block; width: 100%; height: 100% }
p { position: absolute; inset: auto 4% 4%; margin: 0 auto; width: fit-content; max-width: 92%; box-sizing: border-box;
  max-height: 60%; overflow: auto;
  padding: .3em .8em; border-radius: .5em; background: rgb(0 0 0 / .72); color: #fff; text-align: center;
  font: 600 1.1rem/1.35 system-ui, sans-serif; text-wrap: balance }
p:empty { display: none }
mark { background: none; color: #ffd977 }
`;

export class LabialFace extends LabialMouth {
    static create = createFace;
    static style = STYLE;
    #internals;
    #caption;
    #lines = []; // of captions: their words, with the time from and to which each line is shown
    #words = [];
    #line = null; // the line that is shown, and its words
    #spans = [];
    #said = null; // the word that is marked

    constructor() {
        super();
        this.#internals = this.attachInternals?.();
        this.#caption = document.createElement("p");
        this.#caption.part = "caption";
        this.shadowRoot.append(this.#caption);
        this.addEventListener("keydown", (event) => {
            if (event.key !== "Enter" && event.key !== " ") return;
            event.preventDefault(); // a page scrolls
            this.click();
        });
    }

    connectedCallback() {
        super.connectedCallback();
        if (!this.hasAttribute("tabindex")) this.tabIndex = 0;
        if (!this.#internals) return;
        const [language] = (languageOf(this) || navigator.language).toLowerCase().split("-");
        this.#internals.role = "img";
        this.#internals.ariaLabel = NAMES[ALIASES[language] ?? language] ?? NAMES.en;
    }

    get words() { return this.#words; }

    set words(words) {
        this.#words = Array.from(words ?? []);
        this.#lines = linesOf(this.#words);
        this.#write(null);
    }

    get caption() { return this.#caption.textContent; }

    set caption(text) {
        this.words = null;
        this.#caption.textContent = text ?? "";
    }

    /** Returns whether captions are shown. */
    show(faps) {
        super.show(faps);
        if (!this.#lines.length) return false;
        const at = this.position;
        const speaks = this.track ?? this.stream ?? this.hearing ?? this.voice;
        const line = (speaks && this.#lines.find(({ start, end }) => start <= at && at < end)) ?? null;
        if (line !== this.#line) this.#write(line);
        const said = line?.words.length > 1 ? line.words.findLast(({ start }) => start <= at) : null;
        if (said !== this.#said) {
            this.#said = said;
            this.#spans.forEach((span, i) => {
                const wanted = line.words[i] === said ? "mark" : "span";
                if (span.localName === wanted) return;
                this.#spans[i] = Object.assign(document.createElement(wanted), { textContent: span.textContent });
                span.replaceWith(this.#spans[i]);
            });
        }
        return line !== null;
    }

    cancel(milliseconds) {
        this.words = null;
        return super.cancel(milliseconds);
    }

    #write(line) {
        this.#line = line;
        this.#said = null;
        this.#spans = (line?.words ?? []).map(({ text }) => Object.assign(document.createElement("span"), { textContent: text }));
        this.#caption.replaceChildren(...this.#spans.flatMap((span, i) => (i ? [" ", span] : [span])));
    }
}

/** The `lang` that holds for an element, which may be that of another component around it. */
function languageOf(element) {
    const marked = element.closest("[lang]");
    if (marked) return marked.lang;
    const { host } = element.getRootNode();
    return host && languageOf(host);
}

/** Lines that fit, broken where a sentence ends or a pause is; each is shown until the next one begins. */
function linesOf(words) {
    const lines = [];
    for (const word of words) {
        const line = lines.at(-1);
        const last = line?.words.at(-1);
        const follows = line && line.length + word.text.length < LINE && !/[.!?…]["'”’)]*$/.test(last.text) &&
            word.start - (last.end ?? last.start) < STAYS;
        if (follows) {
            line.words.push(word);
            line.length += word.text.length + 1;
        } else {
            lines.push({ words: [word], start: word.start, length: word.text.length });
        }
    }
    lines.forEach((line, i) => {
        const last = line.words.at(-1);
        line.end = Math.min(lines[i + 1]?.start ?? Infinity, (last.end ?? last.start + 0.5) + STAYS);
    });
    return lines;
}

define("labial-face", LabialFace);
