"""The demo page and those of `labial page` in a real browser, from the disk: what is drawn and what is heard."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, Iterator, List

import numpy as np
import pytest

from browser import CHROMIUM, REASON, Browser, Page
from labial.__main__ import main
from test_see import data_of, frames

DEMO_PAGE = os.environ.get("LABIAL_DEMO_PAGE", "")
pytestmark = pytest.mark.skipif(not CHROMIUM, reason=REASON)

#: The line that is drawn between closed lips, in drawing units; lips that are nearer look closed.
LINE = 1.8
#: Plays, and takes down in every animation frame the sound's time before and after the page draws, and the motion's, in
#: seconds. Functions for a frame are called in the order in which they ask for it.
WATCH = """{
const {audio} = window.labialPlayer, seen = window.seen = [];
let before = 0;
(function first() {
  before = audio.currentTime;
  requestAnimationFrame(first);
})();
document.getElementById("play").click();
(function second() {
  if (!audio.paused) seen.push([before, audio.currentTime, window.labialPlayer.position / FPS]);
  requestAnimationFrame(second);
})();
}"""
#: The widest distance between the inner contours of the lips as they are drawn: the path goes along the upper lip and
#: back along the lower one.
GAP = """(() => {
  const points = document.querySelector("#mouth path[data-d=inner]").getAttribute("d").match(/-?[0-9.]+/g).map(Number);
  const y = points.filter((_, i) => i % 2), n = y.length;
  return Math.max(...y.slice(0, n / 2).map((top, i) => y[n - 1 - i] - top));
})()"""


@pytest.fixture
def demo(browser: Browser) -> Iterator[Page]:
    """The demo page."""
    if not DEMO_PAGE:
        pytest.skip("LABIAL_DEMO_PAGE does not name the built page")
    page = browser.page(Path(DEMO_PAGE).as_uri())
    yield page
    assert page.errors() == []


def demo_data() -> Dict[str, Any]:
    return data_of(Path(DEMO_PAGE).read_text(encoding="utf-8"))


def in_step(seen: List[List[float]], fps: float) -> None:
    """Sound and lips are never more than a frame apart while the sound plays."""
    before, after, drawn = np.array([frame for frame in seen if frame[0] > 0]).T
    assert len(drawn) >= 3  # on a machine that is busy otherwise, too
    assert np.maximum(before - drawn, drawn - after).max() <= 1 / fps


def test_demo_plays_pauses_and_seeks_in_step(demo: Page) -> None:
    """Catches a sound that does not play, lips that run ahead or behind, and either going on or elsewhere alone."""
    fps = demo_data()["fps"]
    watch, press = WATCH.replace("FPS", str(fps)), "document.getElementById('play').click()"
    demo.evaluate(watch)
    demo.wait_for("labialPlayer.audio.currentTime > 0.8")
    demo.evaluate(press)
    in_step(demo.evaluate("seen"), fps)
    where = demo.evaluate("[labialPlayer.audio.paused, labialPlayer.audio.currentTime, labialPlayer.position]")
    assert where[0] and abs(where[1] - where[2] / fps) <= 1 / fps
    demo.evaluate("new Promise(resolve => setTimeout(resolve, 200))")
    assert demo.evaluate("[labialPlayer.audio.currentTime, labialPlayer.position]") == where[1:]

    demo.evaluate(f"labialPlayer.seek(9 * {fps}); {watch}")
    demo.wait_for("labialPlayer.audio.currentTime > 9.5")
    demo.evaluate(press)
    seen = demo.evaluate("seen")
    assert seen[0][0] >= 8.9
    in_step(seen, fps)


def test_demo_closes_the_lips_it_draws(demo: Page) -> None:
    """In every p, b and m a frame is drawn with the lips closed; vowels are open, f and v are not closed."""
    data = demo_data()
    demo.evaluate(f"window.gap = frame => {{ labialPlayer.seek(frame); return {GAP}; }}")
    least = {}
    for p in data["phonemes"]:
        frames = range(p["start_frame"], p["start_frame"] + p["frames"])
        gaps = demo.evaluate(f"{list(frames)}.map(gap)")
        least.setdefault(p["label"], []).append(min(gaps))
        if p["label"] in ("AA", "AE", "AY", "EH"):
            assert max(gaps) > 4 * LINE, p
    closed = least["P"] + least["B"] + least["M"]
    assert len(closed) >= 25 and max(closed) < LINE
    assert min(least["F"] + least["V"]) > 0.7 * LINE


def page_of(folder: Path, sound: str) -> str:
    """The address of the page of a.csv in `folder`, with a sound there."""
    out = folder / "a.html"
    assert main(["page", str(folder / "a.csv"), "--audio", str(folder / sound), "-o", str(out)]) == 0
    return out.as_uri()


@pytest.mark.parametrize("options", [
    {"format": "WAV", "subtype": "PCM_16"}, {"format": "WAV", "subtype": "FLOAT"}, {"format": "FLAC"},
    {"format": "MP3"}, {"format": "OGG", "subtype": "VORBIS"}, {"format": "OGG", "subtype": "OPUS"},
], ids=lambda options: "-".join(options.values()))  # fmt: skip
def test_page_plays_ones_own_sound(browser: Browser, tmp_path: Path, options: Dict[str, str]) -> None:
    """Catches a kind of sound that the browser refuses, and a sound that begins elsewhere."""
    soundfile = pytest.importorskip("soundfile")
    soundfile.write(tmp_path / "sound", np.sin(np.arange(48000) / 10) / 2, 48000, **options)
    (tmp_path / "a.lab").write_text("0 0.1 sil\n0.1 0.4 m\n0.4 1 ah\n")
    model = Path(__file__).resolve().parents[2] / "export" / "models" / "speech_en.npz"
    assert main(["synth", str(model), str(tmp_path / "a.lab"), "-o", str(tmp_path / "a.csv")]) == 0
    page = browser.page(page_of(tmp_path, "sound"))
    page.wait_for("labialPlayer.audio.readyState >= 3")
    assert page.evaluate("labialPlayer.audio.duration") == pytest.approx(1.0, abs=0.03)
    page.evaluate(WATCH.replace("FPS", "50"))
    page.wait_for("labialPlayer.audio.currentTime > 0.4")
    in_step(page.evaluate("seen"), 50)
    assert page.evaluate("document.getElementById('mute').hidden") and page.errors() == []


def test_page_says_that_its_sound_cannot_be_played(browser: Browser, tmp_path: Path) -> None:
    """Without its sound the page still moves, and says why nothing is heard."""
    (tmp_path / "a.csv").write_text(frames(100))
    (tmp_path / "a.wav").write_bytes(b"RIFF\x24\x00\x00\x00WAVEfmt " + bytes(40))
    page = browser.page(page_of(tmp_path, "a.wav"))
    page.wait_for("!document.getElementById('mute').hidden")
    page.evaluate("document.getElementById('play').click()")
    page.wait_for("labialPlayer.position > 10")
