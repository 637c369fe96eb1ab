"""examples/speak-page as a browser opens its files, without a server: espeak-ng's sound is heard, and lips close in its
p, b, m, in every language of the page; what labial/espeak.js makes of espeak-ng's events, against the exporter."""

from __future__ import annotations

import json
import random
import shutil
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np
import pytest

import labial
from browser import Browser, Page
from labial.hearing import voices
from npm import NODE, TOOLS_MISSING, answered, install, lay, node, tools
from packages import SOURCE, needs_runtime, run
from pages import parse

EXAMPLE = SOURCE / "examples" / "speak-page"
needs_tools = pytest.mark.skipif(bool(TOOLS_MISSING), reason=TOOLS_MISSING)

#: How fast the page is made to speak.
SPEED = 4
#: The largest distance of the outer lips in contact beyond the neutral one, FAP units.
CLOSED = 72

#: Takes down the loudness that leaves for the loudspeaker, and what is drawn at which moment of the sound.
WATCH = """(() => {
    const voice = document.getElementById("voice"), face = document.getElementById("face");
    const context = new AudioContext(), ear = new AnalyserNode(context), samples = new Float32Array(ear.fftSize);
    context.createMediaElementSource(voice).connect(ear).connect(context.destination);
    voice.defaultPlaybackRate = SPEED;
    const render = face.show;
    face.show = (faps) => {
        const before = voice.currentTime;
        render.call(face, faps);
        ear.getFloatTimeDomainData(samples);
        const loudest = samples.reduce((sum, one) => Math.max(sum, Math.abs(one)), 0);
        seen.push([before, voice.currentTime, loudest, ...face.faps]);
    };
    window.say = (number) => {
        window.seen = [];
        const [form, language] = ["form", "language"].map((id) => document.getElementById(id));
        language.value = number;
        language.onchange();
        form.requestSubmit();
    };
})()""".replace("SPEED", str(SPEED))

#: The phonemes that the page shows, with their times.
SEGMENTS = """[...document.querySelectorAll("#status span")].map(({ textContent: label, title }) => {
    const [start, end] = title.split(" to ").map(parseFloat);
    return { label, start, end };
})"""


@pytest.fixture(scope="module")
def built(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's folder, as build.mjs writes it."""
    if TOOLS_MISSING:
        pytest.skip(TOOLS_MISSING)
    folder = tmp_path_factory.mktemp("speak") / "example"
    shutil.copytree(EXAMPLE, folder)
    install(npm_package, folder)
    for name in ("@echogarden", "esbuild"):
        (folder / "node_modules" / name).symlink_to(tools() / "node_modules" / name)
    run(NODE, "build.mjs", cwd=folder)
    return folder / "page"


@pytest.fixture
def page(built: Path, browser: Browser) -> Iterator[Page]:
    """The page, opened as a file, ready to speak."""
    page = browser.page((built / "index.html").as_uri())
    page.wait_for("document.getElementById('status').textContent.includes('press Enter')")
    page.evaluate(WATCH)
    yield page
    assert page.errors() == []


@pytest.mark.slow
def test_the_page_has_what_it_must(built: Path) -> None:
    """Catches a file that the page would have to fetch, and the missing licence of the voice."""
    assert {path.name for path in built.iterdir()} == {"index.html", "page.js", "COPYING"}
    assert "GNU GENERAL PUBLIC LICENSE" in (built / "COPYING").read_text(encoding="utf-8")
    assert 1e6 < (built / "page.js").stat().st_size < 2.5e6


@pytest.mark.slow
def test_six_languages_are_heard_and_seen(page: Page) -> None:
    """Catches a language without its data, a sound that nobody hears, lips beside it, and a stop that stays open."""
    languages = page.evaluate("[...document.getElementById('language').options].map(({ text }) => text)")
    assert len(languages) == 6
    labels = set()
    for number, language in enumerate(languages):
        page.evaluate(f"say({number})")
        page.wait_for("seen.length > 0 && voice.ended && face.track", 60)
        seen = np.array(page.evaluate("seen"))
        duration, faps = page.evaluate("[voice.duration, [...face.track.faps]]")
        segments = page.evaluate(SEGMENTS)
        lips = np.array(faps).reshape(-1, 13)[:, 3:5].sum(axis=1) * -1
        assert 1 < duration < 6 and abs((len(lips) - 12) / 50 - duration) < 0.05, language  # 12 of rest
        assert lips.max() > 200, language
        closures = [one for one in segments if one["label"].lstrip("ˈˌ")[:1] in ("p", "b", "m")]
        assert len(closures) >= 6, (language, segments)
        for one in closures:
            own = lips[round(50 * one["start"]) : round(50 * one["end"]) + 1]
            assert own.min() <= CLOSED, (language, one, own)
        # What is drawn is the motion between the moments before and after the drawing, give or take a frame.
        drawn = -seen[:, 6:8].sum(axis=1)
        playing = (seen[:, 0] > 0) & (seen[:, 1] < duration)
        assert playing.sum() > 2 and seen[playing, 2].max() > 0.05, (language, "nothing is drawn, or heard")
        for before, after, opening in np.c_[seen[playing, :2], drawn[playing]]:
            near = lips[max(0, int(50 * before) - SPEED) : int(50 * after) + SPEED + 2]
            assert near.min() - 1 <= opening <= near.max() + 1, (language, before, after)
        labels.update(one["label"] for one in segments)
    assert len(labels) > 60


@pytest.mark.slow
def test_the_face_is_seen_however_long_the_text_is(page: Page) -> None:
    """On a phone: neither the phonemes push it out, nor does the caption cover it."""
    page.command("Emulation.setDeviceMetricsOverride", {"width": 375, "height": 667, "deviceScaleFactor": 1,
                                                        "mobile": True})
    page.evaluate("window.seen = [], text.value = 'Maybe people hum by the pool. '.repeat(40), form.requestSubmit()")
    page.wait_for("face.caption.length > 1000")
    height, caption, below = page.evaluate("""[face.offsetHeight, face.shadowRoot.querySelector('p').offsetHeight,
        document.documentElement.scrollHeight]""")
    assert height > 200 and caption < 0.65 * height and below <= 667


# ---- What labial/espeak ----------------------------------------------------------------------------------------------


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


def assert_alike(cases: List[Any], wanted: List[List[Tuple[float, str]]], folder: Path) -> List[Tuple[Rows, List[str]]]:
    """Asserts that of each case the segments are those of `wanted`, ends of phonemes, but for how silences are cut;
    returns the segments, and the labels among them that are no phonemes."""

    def joined(rows: Rows) -> Rows:
        result: Rows = []
        for start, end, label in rows:
            if result and not label and not result[-1][2]:
                start = result.pop()[0]
            result.append((start, end, label))
        return result

    found = [([(item["start"], item["end"], item["label"]) for item in segments], unknown)
             for segments, unknown in answered(ESPEAK, cases, folder)]
    for case, (segments, _), ends in zip(cases, found, wanted):
        one, other = joined(segments), joined(without_gaps(ends))
        assert [row[2] for row in one] == [row[2] for row in other], case[0]
        assert [row[:2] for row in one] == pytest.approx([row[:2] for row in other]), case[0]
    return found


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
        wanted.append(voices.phonemes(events, samples, rate))
    moved = 0
    for (events, _, _), (segments, _) in zip(given, assert_alike(given, wanted, tmp_path)):
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
@needs_tools
def test_espeaks_npm_package_in_six_languages(tmp_path: Path) -> None:
    """No unknown label, the exporter's times, stops that begin in silence. Would catch events of another form."""
    texts = [*SENTENCES.items(), ("pt", "Não, mãe, põe o pão à mão, eles chegaram.")]
    given = json.loads(run(node(22), "--input-type=module", "-e", PACKAGED, json.dumps(texts), cwd=tools()))
    sounds = [np.concatenate([np.array(piece, "int16") for piece in pieces]) for _, pieces, _ in given]
    reported = [[(event["audio_position"], event["id"].encode("utf-8")[:8].decode("utf-8", "ignore"))
                 for event in events if event["type"] == "phoneme"] for events, _, _ in given]
    wanted = [voices.phonemes(names, samples, rate) for names, samples, (_, _, rate) in zip(reported, sounds, given)]
    stops = 0
    found = assert_alike(given, wanted, tmp_path)
    for (voice, _), (_, _, rate), samples, names, (segments, unknown) in zip(texts, given, sounds, reported, found):
        assert unknown == [] and len(segments) > 15, voice
        assert segments[-1][1] == pytest.approx(len(samples) / rate, abs=0.001)
        loud = np.abs(samples.astype("int32"))
        for start, end, label in segments:
            bursts = [position / 1000 for position, name in names if name == label and start < position / 1000 < end]
            if label[:1] in ("p", "t", "k") and bursts:  # the sound falls silent there, before the burst
                assert loud[round(start * rate) : round(min(bursts) * rate)].mean() < loud.max() / 50, (voice, start)
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
@needs_tools
def test_code_of_the_page(npm_package: Path, tmp_path: Path) -> None:
    """Would catch calls that espeak-ng's or n2words' package does not have. Numbers are said as they are written."""
    lay(npm_package, tmp_path, "labial", "labial-words")
    for name in ("@echogarden", "n2words"):
        (tmp_path / "node_modules" / name).symlink_to(tools() / "node_modules" / name)
    for block in parse(SOURCE / "docs" / "browser.md"):
        if block.name in ("espeak.js", "numbers.js"):
            (tmp_path / block.name).write_text(block.text, encoding="utf-8")
    (tmp_path / "package.json").write_text('{ "type": "module" }')
    (tmp_path / "page.js").write_text(PAGE)
    written = {
        "42": "forty-two", "1984": "nineteen eighty-four", "1900": "nineteen hundred", "1905": "nineteen oh five",
        "2003": "two thousand three", "2024": "twenty twenty-four", "12.5": "twelve point five",
        "1,234": "one thousand two hundred thirty-four",
    }
    found = json.loads(run(node(22), tmp_path / "page.js", json.dumps(list(written))))
    assert 1.0 < found["seconds"] and abs(found["lips"] - 12 / 50 - found["seconds"]) < 0.02  # 12 frames of rest
    assert found["said"] == [[text, labial.phonemes(text.replace("-", " "))] for text in written.values()]
