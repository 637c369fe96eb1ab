// Texts as Python has them, so that both find the same words.

/** What Python's str.isspace() says of. */
const BLANK = "[\\t-\\r\\x1c- \\x85\\xa0\\u1680\\u2000-\\u200a\\u2028\\u2029\\u202f\\u205f\\u3000]";
const BLANKS = new RegExp(`${BLANK}+`, "u");
const AROUND = new RegExp(`^${BLANK}+|${BLANK}+$`, "gu");
const TAGS = { "[": "]", "<": ">" };

/** LABIAL_VOICE_LETTERS: characters of a word, at most; and how many a word has where another one of kana begins the
 * next. */
const LETTERS = 60;
const KANA_MOST = 4;
/** Where a word ends besides blanks: punctuation of Chinese and Japanese, and marks behind a script without blanks. */
const MARKS = /[\u2014\u2015\u2025\u2026、。〈〉《》「」『』【】〔〕〖〗〘〙〚〛・！，：；？]/u;
const STOPS = /[,.!?:;]/u;
const KANA = /^[\u3041-\u30ff]/u;
const HAN = /^[\u2e80-\u2fdf\u3005-\u3007\u3400-\u4dbf\u4e00-\u9fff\uf900-\ufaff\u{20000}-\u{3ffff}]/u;
const THAI = /^[\u0e01-\u0eff]/u;
/** With what a word of kana goes on, also after so many; and vowels of Thai and Lao that begin a syllable. */
const GOES_ON = /[ぁぃぅぇぉすっゃゅょゎん\u3099-\u309fァィゥェォスッャュョヮンヹヺー-ヿ]/u;
const FIRST = /[\u0e40-\u0e44\u0ec0-\u0ec4]/u;

/** A text without half surrogates, which have no UTF-8. */
export function whole(text) {
    return text.replace(/\p{Cs}/gu, "?");
}

/** The texts between blanks. */
export function split(text) {
    return text.split(BLANKS).filter(Boolean);
}

/** The bracket of a link, [text](address) or [text][1], and what stands in it; a letter, which makes it a text to be
 * read. */
const LINK = /\[(?=([^[\]]*)\](?:\(|\[[0-9\]]))/gu;
const LETTER = /[A-Za-z\x80-\u{10ffff}]/u;

/** Parts of a text, which are as long afterwards: the brackets of links' texts are marks that are nothing, and those of
 * other links as wide as ideographs, since the library knows what is silent behind them. */
export function linked(items, between = "") {
    const text = items.join(between).replace(LINK, (_, inside) => (LETTER.test(inside) ? "\u200b" : "\uff3b"));
    let place = -between.length;
    return items.map((item) => {
        const from = place + between.length;
        place = from + item.length;
        return text.slice(from, place);
    });
}

/** The words of a text, as wordsOfCharacters() finds them, but with its tags. */
export function wordsOf(text) {
    const words = [[]];
    for (const character of whole(text)) {
        if (ends(words.at(-1), character)) {
            words.push([]);
        } else {
            if (begins(words.at(-1), character)) words.push([]);
            words.at(-1).push(character);
        }
    }
    return words.map((word) => word.join("")).filter(Boolean);
}

/** Whether a word, a list of characters, ends at a character, which belongs to none. */
function ends(word, character) {
    const last = word.at(-1) ?? "";
    const isUnspaced = KANA.test(last) || HAN.test(last) || THAI.test(last);
    return (isUnspaced && STOPS.test(character)) || BLANKS.test(character) || MARKS.test(character);
}

/** Whether a character begins another word, though no blank stands before it: where a word of Japanese probably ends,
 * before Han or katakana behind hiragana; where kana go on for long; before a vowel that is written first in its
 * syllable; and where the word is too long. */
function begins(word, character) {
    if (!word.length) return false;
    if (word.length >= LETTERS || FIRST.test(character)) return true;
    const last = word.at(-1);
    if (!KANA.test(last) || GOES_ON.test(character)) return false;
    const isKana = KANA.test(character);
    if (last < "\u30a0" && (HAN.test(character) || (isKana && character > "\u30a0"))) return true;
    return word.length >= KANA_MOST && isKana;
}

export function strip(text) {
    return text.replace(AROUND, "");
}

/** A number rounded to a whole one, halves to the even one. */
export function even(value) {
    const below = Math.floor(value);
    const rest = value - below;
    return rest > 0.5 || (rest === 0.5 && below % 2 !== 0) ? below + 1 : below;
}

/** The words { text, start, end, ends } of characters with their times, whole milliseconds: what stands between blanks,
 * or where ends() or begins() says so, without [tags] and <tags>. A bracket that is not closed, or a link's, begins none.
 * An item of several characters shares its time evenly among them; a character that ends before the one before it ends
 * with that. */
export function wordsOfCharacters(given, starts, finishes) {
    const items = linked(given);
    const words = [];
    let word = [];
    let start = 0;
    let times = [0];
    let closing = "";
    const last = {};
    for (const mark of Object.values(TAGS)) {
        last[mark] = items.reduce((found, item, number) => (item.includes(mark) ? number : found), -1);
    }
    [...items, " "].forEach((item, number) => {
        const [begin, end] = number < items.length ? [starts[number], finishes[number]] : [0, 0];
        const characters = [...whole(item)];
        const moment = (place) => begin + Math.floor(((end - begin) * place) / characters.length);
        characters.forEach((character, place) => {
            const mark = Object.hasOwn(TAGS, character) ? TAGS[character] : "";
            if (!closing && mark && last[mark] >= number) closing = mark;
            const isRead = !closing && !ends(word, character);
            if (word.length && (!isRead || begins(word, character))) {
                words.push({ text: word.join(""), start, end: times[times.length - 1], ends: times.slice(1) });
                word = [];
            }
            if (character === closing) closing = "";
            if (!isRead) return;
            if (!word.length) {
                start = moment(place);
                times = [start];
            }
            word.push(character);
            times.push(Math.max(times[times.length - 1], moment(place + 1)));
        });
    });
    return words;
}
