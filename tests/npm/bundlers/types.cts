// The types as CommonJS has them.
import labial = require("labial");
import hearing = require("labial-hearing");
import laughter = require("labial-laughter");
import words = require("labial-words");

async function word(): Promise<number> {
    const mouth = await labial.Labial.load({ laughter, hearing, words });
    const track = mouth.render(mouth.read("0 1 AA"), { output: "arkit" });
    mouth.render((await mouth.words()).wordTimings([{ text: "go", start: 0 }]));
    // @ts-expect-error no weight has this name
    track.at(0).jawOppen;
    return track.at(0).jawOpen;
}

export = word;
