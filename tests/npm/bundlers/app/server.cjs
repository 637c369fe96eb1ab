const { Labial } = require("labial");

(async () => {
    const labial = await Labial.load({ laughter: require("labial-laughter"), hearing: require("labial-hearing") });
    const { faps } = labial.render(labial.read(process.env.WORD));
    const heard = [];
    for (const model of ["small", "large"]) { // as in lips.js
        const one = await labial.hear(null, { sampleRate: 16000, model });
        one.push(Int16Array.from({ length: 16000 }, (_, i) => ((i * i) % 8191) * (i % 400 < 200 ? 1 : -1)));
        one.end();
        heard.push(...Array.from(one, (frame) => [...frame]).flat());
    }
    console.log(JSON.stringify([Array.from(faps), heard]));
})();
