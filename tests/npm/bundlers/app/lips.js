// What every entry of the matrix does: the frames of a word and a laugh.
import { Labial } from "labial";

export const WORD = "0 .1 sil\n.1 .2 m\n.2 .5 AA\n.5 .6 p\n.6 1.4 <laugh:0.7>\n1.4 1.5 sil";

export async function frames(laughter) {
    const labial = await Labial.load({ laughter });
    await labial.laughter();
    return Array.from(labial.render(labial.read(WORD)).faps);
}
