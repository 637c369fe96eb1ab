// Texts as Python has them, so that both find the same words.

/** What Python's str.isspace() says of. */
const BLANK = "[\\t-\\r\\x1c- \\x85\\xa0\\u1680\\u2000-\\u200a\\u2028\\u2029\\u202f\\u205f\\u3000]";
const BLANKS = new RegExp(`${BLANK}+`, "u");
const AROUND = new RegExp(`^${BLANK}+|${BLANK}+$`, "gu");
const TAGS = { "[": "]", "<": ">" };

/** A text without half surrogates, which have no UTF-8. */
export function whole(text) {
    return text.replace(/\p{Cs}/gu, "?");
}

/** The texts between blanks. */
export function split(text) {
    return text.split(BLANKS).filter(Boolean);
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
 * without [tags] and <tags>. A bracket that is not closed begins none. An item of several characters shares its time
 * evenly among them; a character that ends before the one before it ends with that. */
export function wordsOfCharacters(items, starts, ends) {
    const words = [];
    let text = "";
    let start = 0;
    let times = [0];
    let closing = "";
    const last = {};
    for (const mark of Object.values(TAGS)) {
        last[mark] = items.reduce((found, item, number) => (item.includes(mark) ? number : found), -1);
    }
    [...items, " "].forEach((item, number) => {
        const [begin, end] = number < items.length ? [starts[number], ends[number]] : [0, 0];
        const characters = [...whole(item)];
        const moment = (place) => begin + Math.floor(((end - begin) * place) / characters.length);
        characters.forEach((character, place) => {
            const mark = Object.hasOwn(TAGS, character) ? TAGS[character] : "";
            if (!closing && mark && last[mark] >= number) closing = mark;
            if (closing || BLANKS.test(character)) {
                if (text) words.push({ text, start, end: times[times.length - 1], ends: times.slice(1) });
                text = "";
                times = [0];
                if (character === closing) closing = "";
                return;
            }
            if (!text) {
                start = moment(place);
                times = [start];
            }
            text += character;
            times.push(Math.max(times[times.length - 1], moment(place + 1)));
        });
    });
    return words;
}
