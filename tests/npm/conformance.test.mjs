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

/** How phonemes are fed, and all frames that can be had are taken: of the whole part, after each, frame by frame. */
const feeds = {
    fill(stream, phonemes) {
        phonemes.forEach((phoneme) => push(stream, phoneme));
        return [];
    },
    hungry(stream, phonemes, most) {
        return phonemes.flatMap((phoneme) => {
            push(stream, phoneme);
            const found = [];
            while (found.length < most && take(stream, 1, found)) continue;
            most -= found.length;
            return found;
        });
    },
    "real time"(stream, phonemes, most) {
        const found = [];
        stream.exact = true; // as phonemes come when they begin, each is late
        phonemes.forEach((phoneme) => {
            push(stream, phoneme);
            for (let ms = 0; ms < Math.min(phoneme.milliseconds, 5000); ms += 20) {
                const frame = found.length < most && stream.tick();
                if (frame) found.push(frame.slice());
            }
        });
        stream.exact = false;
        return found;
    },
};

/** Takes up to `count` frames; whether they all came. */
function take(stream, count, found) {
    if (count === 0) return true;
    for (const frame of stream) {
        found.push(frame);
        if (--count === 0) return true;
    }
    return false;
}

/** A stream each of whose frames may change its articulation, by steps of `changes`: after `frames` of a part. */
function articulated(changes) {
    const stream = mouth.stream();
    const tick = stream.tick.bind(stream);
    let begun = 0;
    function change() {
        if (changes[0]?.frames !== stream.number + 1 - begun) return;
        stream.articulation(Math.min(changes.shift().milliseconds, 200));
    }
    stream.tick = () => {
        const frame = tick();
        if (frame) change();
        return frame;
    };
    const iterate = stream[Symbol.iterator].bind(stream);
    stream[Symbol.iterator] = function* () {
        for (const frame of iterate()) {
            change();
            yield frame;
        }
    };
    return { stream, begin: () => ((begun = stream.number + 1), change()) };
}

function play(steps, feed) {
    const changes = [];
    const { stream, begin } = articulated(changes);
    const frames = [];
    for (let i = 0; i < steps.length; ) {
        while (steps[i].kind === "ARTICULATION") changes.push(steps[i++]);
        begin();
        const phonemes = [];
        while (steps[i].kind === "PUSH") phonemes.push(steps[i++]);
        const cut = steps[i].kind === "CANCEL" ? steps[i].frames : Infinity;
        const part = feeds[feed](stream, phonemes, cut);
        if (cut < Infinity) {
            assert.ok(take(stream, cut - part.length, part), "the frame to cancel after does not come");
            stream.cancel(steps[i].milliseconds);
        } else {
            stream.end();
        }
        while (++i < steps.length && steps[i].kind === "AGAIN") {
            assert.ok(take(stream, steps[i].frames, part));
            stream.cancel(steps[i].milliseconds);
        }
        take(stream, Infinity, part);
        assert.ok(stream.done);
        frames.push(...part);
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
