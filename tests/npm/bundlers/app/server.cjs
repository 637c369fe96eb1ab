const { Labial } = require("labial");

(async () => {
    const [laughter, hearing, words] = [require("labial-laughter"), require("labial-hearing"), require("labial-words")];
    const labial = await Labial.load({ laughter, hearing, words });
    const { faps } = labial.render(labial.read(process.env.WORD));
    const heard = [];
    for (const model of ["small", "large"]) { // as in lips.js
        const one = await labial.hear(null, { sampleRate: 16000, model });
        one.push(Int16Array.from({ length: 16000 }, (_, i) => ((i * i) % 8191) * (i % 400 < 200 ? 1 : -1)));
        one.end();
        heard.push(...Array.from(one, (frame) => [...frame]).flat());
    }
    const timed = [{ text: "Maybe,", start: 0.1, end: 0.5 }, { text: "people!", start: 0.75 }];
    const spoken = (await labial.words()).wordTimings(timed).flatMap(({ end, label }) => [label, end]);
    console.log(JSON.stringify([Array.from(faps), heard, spoken]));
})();
