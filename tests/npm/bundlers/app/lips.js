// What every entry of the matrix does: the frames of a word and a laugh, those of a sound, and words' phonemes.
import { Labial } from "labial";

export const WORD = "0 .1 sil\n.1 .2 m\n.2 .5 AA\n.5 .6 p\n.6 1.4 <laugh:0.7>\n1.4 1.5 sil";

export async function frames(laughter) {
    const labial = await Labial.load({ laughter });
    await labial.laughter();
    return Array.from(labial.render(labial.read(WORD)).faps);
}

/** A second of sound that needs no file, heard by both models. */
export async function heard(hearing) {
    const labial = await Labial.load({ hearing });
    const sound = Int16Array.from({ length: 16000 }, (_, i) => ((i * i) % 8191) * (i % 400 < 200 ? 1 : -1));
    const found = [];
    for (const model of ["small", "large"]) {
        const one = await labial.hear(null, { sampleRate: 16000, model });
        one.push(sound);
        one.end();
        found.push(...Array.from(one, (faps) => [...faps]).flat());
    }
    return found;
}

/** The phonemes of two words and when they end. */
export async function spoken(words) {
    const labial = await Labial.load({ words });
    const timed = [{ text: "Maybe,", start: 0.1, end: 0.5 }, { text: "people!", start: 0.75 }];
    return (await labial.words()).wordTimings(timed).flatMap(({ end, label }) => [label, end]);
}
