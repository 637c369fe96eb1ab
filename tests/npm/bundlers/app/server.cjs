const { Labial } = require("labial");

(async () => {
    const labial = await Labial.load({ laughter: require("labial-laughter") });
    const { faps } = labial.render(labial.read(process.env.WORD));
    console.log(JSON.stringify(Array.from(faps)));
})();
