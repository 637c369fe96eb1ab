"""examples/speak-page as a browser opens its files, without a server: espeak-ng's sound is heard, and lips close in its
p, b, m, in every language of the page."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Iterator

import numpy as np
import pytest

from browser import CHROMIUM, REASON, Browser, Page
from bundlers import MISSING, install, tools
from npm import NODE, package
from packages import SOURCE, run

EXAMPLE = SOURCE / "examples" / "speak-page"
pytestmark = [pytest.mark.slow, pytest.mark.skipif(not CHROMIUM, reason=REASON),
              pytest.mark.skipif(bool(MISSING), reason=MISSING)]  # fmt: skip

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
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's folder, as build.mjs writes it."""
    folder = tmp_path_factory.mktemp("speak") / "example"
    shutil.copytree(EXAMPLE, folder)
    install(package(tmp_path_factory.mktemp("npm") / "build"), folder)
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


def test_the_page_has_what_it_must(built: Path) -> None:
    """Catches a file that the page would have to fetch, and the missing licence of the voice."""
    assert {path.name for path in built.iterdir()} == {"index.html", "page.js", "COPYING"}
    assert "GNU GENERAL PUBLIC LICENSE" in (built / "COPYING").read_text(encoding="utf-8")
    assert 1e6 < (built / "page.js").stat().st_size < 2.5e6


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
