"""What labial/espeak.js makes of espeak-ng's events, against the exporter; with npm's espeak-ng and n2words."""

from __future__ import annotations

import ctypes.util
import json
import random
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest

import labial
from bundlers import MISSING, node, tools
from labial.hearing import espeak
from npm import answered, package
from packages import SOURCE, run
from pages import parse
from runtime import needs_runtime

#: Frames in which the mouth comes to rest behind the last phoneme.
REST = 12

Rows = List[Tuple[float, float, str]]

#: Segments of each [events, samples, sampleRate].
ESPEAK = """
const { fromEspeak } = await import(url.replace(/index\\.js$/, "espeak.js"));
answer(given.map(([events, samples, sampleRate]) => {
    const sound = samples && { samples: samples.map((piece) => Int16Array.from(piece)), sampleRate };
    const segments = fromEspeak(events, sound);
    const labels = new Set(segments.filter(({ label }) => label).map(({ label }) => label));
    return [segments, [...labels].filter((label) => {
        try {
            return !Number.isInteger(labial.phoneme(label, { labels: "ipa" }));
        } catch {
            return true;
        }
    })];
}));
"""


def events_of(events: List[Tuple[int, str]]) -> List[Dict[str, Any]]:
    return [{"type": "phoneme", "audio_position": start, "id": name} for start, name in events]


def without_gaps(ends: List[Tuple[float, str]]) -> Rows:
    """The segments of phonemes' ends; those of no length are left out."""
    found, moment = [], 0.0
    for end, label in ends:
        if end > moment:
            found.append((moment, end, label))
            moment = end
    return found


def joined(found: Rows) -> Rows:
    """Adjacent silences as one."""
    result: Rows = []
    for start, end, label in found:
        if result and not label and not result[-1][2]:
            result[-1] = (result[-1][0], end, "")
        else:
            result.append((start, end, label))
    return result


def test_drawn_events_of_espeak(tmp_path: Path) -> None:
    """Would catch a closure, a pause, a mark or a language's name that is treated otherwise."""
    rng = random.Random(10)
    labels = ["m", "ˈɑː", "p", "t", "k", "tʃ", "ɡ", "", "", "ʲ", "(en)", "5", "ə-", "ɐ̃ʊ̃"]
    given, wanted = [], []
    for _ in range(200):
        events, moment = [], 0
        for _ in range(rng.randrange(1, 15)):
            events.append((moment, rng.choice(labels)))
            moment += rng.choice([0, 4, 30, 64, 65, 66, 90, 200])
        rate = rng.choice([8000, 22050])
        pieces = [rng.choice([0, 20, 900, 8000]) for _ in range(moment // 15 + 2)]
        samples = np.repeat(np.array(pieces, "int16"), rate * 15 // 1000) * rng.choice([1, -1])
        given.append([events_of(events), [samples[:777].tolist(), samples[777:].tolist()], rate])
        wanted.append(without_gaps(espeak.phonemes(events, samples, rate)))
    moved = 0
    for (events, _, _), (found, _), one in zip(given, answered(ESPEAK, given, tmp_path), wanted):
        segments = [(item["start"], item["end"], item["label"]) for item in found]
        assert [item[2] for item in joined(segments)] == [item[2] for item in joined(one)], events
        assert [item[:2] for item in joined(segments)] == pytest.approx([item[:2] for item in joined(one)]), events
        starts = {event["audio_position"] / 1000 for event in events}
        moved += sum(item[0] not in starts for item in segments)
    assert moved > 100


#: Sentences with stops between vowels, of each language one.
SENTENCES = {
    "en-us": "Mama may keep the top tape. Peter picked a pack of cards.",
    "de": "Der Papst packt täglich Pakete, die Katze auch!",
    "fr": "Papa peut parler, tout le monde attend quatre cafés.",
    "es": "El papá puede cantar, mucho tiempo atrás.",
    "it": "Il papà può cantare, ciao a tutti.",
    "pl": "Pan Tadeusz pije kawę, proszę czekać.",
}


@pytest.mark.skipif(not ctypes.util.find_library("espeak-ng"), reason="espeak-ng is not installed")
def test_espeak_in_six_languages(tmp_path: Path) -> None:
    """No unknown label, and the times that the exporter takes of the same events."""
    given, wanted = [], []
    for voice, text in SENTENCES.items():
        speaker = espeak.Speaker(voice)
        samples, rate, ends = speaker.say(text)
        given.append([events_of(speaker._events), [samples.tolist()], rate])
        wanted.append(joined(without_gaps(ends)))
    for voice, (found, unknown), one in zip(SENTENCES, answered(ESPEAK, given, tmp_path), wanted):
        segments = joined([(item["start"], item["end"], item["label"]) for item in found])
        assert unknown == [] and len(segments) > 20, voice
        assert [item[2] for item in segments] == [item[2] for item in one], voice
        assert [item[:2] for item in segments] == pytest.approx([item[:2] for item in one]), voice


#: Of each voice and text, what the npm package of espeak-ng reports: events, samples and their rate.
PACKAGED = """
const { default: load } = await import("@echogarden/espeak-ng-emscripten");
const speaker = new (await load()).eSpeakNGWorker();
const found = JSON.parse(process.argv[1]).map(([voice, text]) => {
    const [events, samples] = [[], []];
    speaker.set_voice(voice);
    speaker.synthesize(text, (piece, reported) => {
        samples.push([...piece]);
        events.push(...reported);
        return false;
    });
    return [events, samples, speaker.get_samplerate()];
});
process.stdout.write(JSON.stringify(found));
"""


@pytest.mark.slow
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_espeaks_npm_package_in_six_languages(tmp_path: Path) -> None:
    """No unknown label, the times that the exporter takes of the same events, and stops that begin in silence. Would
    catch events of another form, among them labels that fill all eight bytes."""
    texts = [*SENTENCES.items(), ("pt", "Não, mãe, põe o pão à mão, eles chegaram.")]
    done = run(node(22), "--input-type=module", "-e", PACKAGED, json.dumps(texts), cwd=tools())
    given = json.loads(done)
    stops = 0
    for (voice, _), events_and_sound, (found, unknown) in zip(texts, given, answered(ESPEAK, given, tmp_path)):
        events, pieces, rate = events_and_sound
        samples = np.concatenate([np.array(piece, "int16") for piece in pieces])
        names = [(event["audio_position"], event["id"].encode("utf-8")[:8].decode("utf-8", "ignore"))
                 for event in events if event["type"] == "phoneme"]
        wanted = joined(without_gaps(espeak.phonemes(names, samples, rate)))
        segments = joined([(item["start"], item["end"], item["label"]) for item in found])
        assert unknown == [] and len(segments) > 15, voice
        assert [item[2] for item in segments] == [item[2] for item in wanted], voice
        assert [item[:2] for item in segments] == pytest.approx([item[:2] for item in wanted]), voice
        assert segments[-1][1] == pytest.approx(len(samples) / rate, abs=0.001)
        loud = np.abs(samples.astype("int32"))
        for start, end, label in segments:
            reported = [position / 1000 for position, name in names if name == label and start < position / 1000 < end]
            if label[:1] in ("p", "t", "k") and reported:  # the sound falls silent there, before the burst
                assert loud[round(start * rate) : round(min(reported) * rate)].mean() < loud.max() / 50, (voice, start)
                stops += 1
    assert stops > 30


#: What the code of docs/browser.md says, by espeak-ng and by n2words.
PAGE = """
import { Labial } from "labial";
import { say } from "./espeak.js";
import { numbers } from "./numbers.js";

const { samples, sampleRate, track } = say("Mama may be happy.");
const labial = await Labial.load({ words: () => import("labial-words") });
const words = await labial.words();
const said = JSON.parse(process.argv[2]).map((digits) => [numbers(digits), words.phonemes(digits, { numbers })]);
const count = samples.reduce((sum, piece) => sum + piece.length, 0);
process.stdout.write(JSON.stringify({ seconds: count / sampleRate, lips: track.duration, said }));
"""


@pytest.mark.slow
@needs_runtime
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_code_of_the_page(tmp_path: Path) -> None:
    """Would catch calls that espeak-ng's or n2words' package does not have. Numbers are said as they are written."""
    built = package(tmp_path / "npm")
    modules = tmp_path / "node_modules"
    modules.mkdir()
    for name, folder in (("labial", built), ("labial-words", built.with_name(f"{built.name}-words")),
                         *((name, tools() / "node_modules" / name) for name in ("@echogarden", "n2words"))):
        (modules / name).symlink_to(folder)
    for block in parse(SOURCE / "docs" / "browser.md"):
        if block.name in ("espeak.js", "numbers.js"):
            (tmp_path / block.name).write_text(block.text, encoding="utf-8")
    (tmp_path / "package.json").write_text('{ "type": "module" }')
    (tmp_path / "page.js").write_text(PAGE)
    written = {
        "42": "forty-two", "1984": "nineteen eighty-four", "1900": "nineteen hundred", "1905": "nineteen oh five",
        "2003": "two thousand three", "2024": "twenty twenty-four", "12.5": "twelve point five",
        "1,234": "one thousand two hundred thirty-four",
    }  # fmt: skip
    found = json.loads(run(node(22), tmp_path / "page.js", json.dumps(list(written))))
    assert 1.0 < found["seconds"] and abs(found["lips"] - REST / 50 - found["seconds"]) < 0.02
    assert found["said"] == [[text, labial.phonemes(text.replace("-", " "))] for text in written.values()]
