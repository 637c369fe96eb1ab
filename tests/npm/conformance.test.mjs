// Every conformance stream through the package's own calls, fed in three ways: the frames must be those of every board,
// bit for bit. Would catch a call that reaches the library otherwise than it was made, and frames that get lost between.
import assert from "node:assert/strict";
import test from "node:test";
import { Labial, difference, framesOf, laughter, vectors } from "./setup.mjs";

const mouth = await Labial.load({ laughter });

/** The labels of a model's phonemes by what they are called in its header. */
function constants(model) {
    const labels = Array.from({ length: model.phonemes }, (_, i) => mouth.label(i, model));
    return new Map(labels.map((label) => [label.toUpperCase().replace(/\W/g, "_"), label]));
}

const labels = { speech: constants(mouth.models.speech), laughter: constants(mouth.models.laughter) };

function push(stream, { model, label, milliseconds }) {
    stream.use(model);
    stream.push(labels[model].get(label), milliseconds);
}

/** How phonemes are fed, and frames are taken that can be had, while any are left: of the whole part, after each phoneme,
 * frame by frame. */
const feeds = {
    fill(stream, phonemes) {
        phonemes.forEach((phoneme) => push(stream, phoneme));
    },
    hungry(stream, phonemes, add, left) {
        for (const phoneme of phonemes) {
            push(stream, phoneme);
            while (left() > 0 && take(stream, 1, add)) continue;
        }
    },
    "real time"(stream, phonemes, add, left) {
        stream.exact = true; // as phonemes come when they begin, each is late
        for (const phoneme of phonemes) {
            push(stream, phoneme);
            for (let ms = 0; ms < Math.min(phoneme.milliseconds, 5000); ms += 20) {
                const frame = left() > 0 && stream.tick();
                if (frame) add(frame.slice());
            }
        }
        stream.exact = false;
    },
};

/** Takes up to `count` frames; whether they all came. */
function take(stream, count, add) {
    if (count === 0) return true;
    for (const frame of stream) {
        add(frame);
        if (--count === 0) return true;
    }
    return false;
}

function play(steps, feed) {
    const stream = mouth.stream();
    const frames = [];
    const changes = []; // of the articulation, each after so many frames of a part
    for (let i = 0; i < steps.length; ) {
        while (steps[i].kind === "ARTICULATION") changes.push(steps[i++]);
        const begin = frames.length;
        const change = () => {
            if (changes[0]?.frames !== frames.length - begin) return;
            stream.articulation(Math.min(changes.shift().milliseconds, 200));
        };
        const add = (frame) => {
            frames.push(frame);
            change();
        };
        change();
        const phonemes = [];
        while (steps[i].kind === "PUSH") phonemes.push(steps[i++]);
        const cut = steps[i].kind === "CANCEL" ? steps[i].frames : Infinity;
        const left = () => cut - (frames.length - begin);
        feeds[feed](stream, phonemes, add, left);
        if (cut < Infinity) {
            assert.ok(take(stream, left(), add), "the frame to cancel after does not come");
            stream.cancel(steps[i].milliseconds);
        } else {
            stream.end();
        }
        while (++i < steps.length && steps[i].kind === "AGAIN") {
            assert.ok(take(stream, steps[i].frames, add));
            stream.cancel(steps[i].milliseconds);
        }
        take(stream, Infinity, add);
        assert.ok(stream.done);
        if (i < steps.length) stream.restart();
    }
    assert.equal(stream.number, frames.length - 1);
    stream.free();
    return frames;
}

const streams = Object.entries(vectors());
const wanted = framesOf("tests/conformance/frames.txt");
assert.ok(streams.length >= 24 && streams.length === Object.keys(wanted).length);
for (const [name, steps] of streams) {
    for (const feed of Object.keys(feeds)) {
        test(`${name}, ${feed}`, () => assert.equal(difference(play(steps, feed), wanted[name]), ""));
    }
}

test("a difference says where it is", () => {
    const frames = wanted.sentence.map((faps) => [...faps]);
    frames[5][3]++;
    frames[7][0]++;
    const [value] = wanted.sentence[5].slice(3);
    assert.equal(difference(frames, wanted.sentence), `frame 5, channel 3 is ${value + 1}, not ${value}`);
    assert.equal(difference(wanted.sentence.slice(1), []), "89 frames, not 0");
    assert.equal(difference(wanted.sentence, wanted.sentence), "");
});
