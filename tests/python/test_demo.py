"""The demo page and those of `labial page`: one file that needs nothing else, what is drawn and what is heard in a
browser. LABIAL_DEMO_PAGE holds the built page's path."""

from __future__ import annotations

import base64
import io
import itertools
import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import numpy as np
import pytest

import labial
from browser import Browser, Page
from labial.__main__ import main
from labial.files.frames import opening
from labial.reference.fade import EASE
from packages import needs_runtime, run
from test_see import data_of, frames

PAGE = os.environ.get("LABIAL_DEMO_PAGE", "")
pytestmark = needs_runtime
needs_flite = pytest.mark.skipif(not shutil.which("flite"), reason="needs the Debian package flite")

DEMO = Path(__file__).resolve().parents[2] / "examples" / "demo"

VOWELS = ("AA", "AE", "AH", "AO", "AW", "AY", "EH", "ER", "EY", "IH", "IY", "OW", "OY", "UH", "UW")


@pytest.fixture(scope="module")
def data() -> Dict[str, Any]:
    """What the built page plays."""
    if not PAGE:
        pytest.skip("LABIAL_DEMO_PAGE does not name the built page")
    return data_of(Path(PAGE).read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Dict[str, Any]:
    """What the page would play if the last sentence had a pause in the place of its laugh."""
    program = shutil.which("labial-demo", path=os.environ.get("LABIAL_PROGRAMS", ""))
    if not program:
        pytest.skip("LABIAL_PROGRAMS does not name the folder of labial-demo")
    folder = tmp_path_factory.mktemp("plain")
    pause, count = re.subn(r"<laugh ([0-9.]+) [0-9.]+>", r"pau:\1", (DEMO / "laughing.flite").read_text())
    assert count == 1
    (folder / "plain.flite").write_text(pause)
    return json.loads(run(program, DEMO / "sentence.flite", DEMO / "laugh.lab", folder / "plain.flite"))


def milliseconds(name: str) -> int:
    """How long a file lasts."""
    return sum(length for _, length in labial.read_timings(DEMO / name))


def parts(data: Dict[str, Any]) -> Tuple[int, int]:
    """The frames with which the laugh and the last sentence begin."""
    first = milliseconds("sentence.flite")
    begin, end = (int(ms * data["fps"] / 1000 + 0.5) for ms in (first, first + milliseconds("laugh.lab")))
    return begin, end


def spans(data: Dict[str, Any], kind: str, frm: int = 0) -> List[Tuple[str, int, int]]:
    """Label, first frame and frame past the end of the phonemes of a kind, from a frame on."""
    return [(p["label"], p["start_frame"], p["start_frame"] + p["frames"]) for p in data["phonemes"]
            if p["kind"] == kind and p["start_frame"] >= frm]


def test_frames_are_13_integers_that_move(data: Dict[str, Any]) -> None:
    """None is lost or added where models hand over or run side by side, all are within limits; then rest."""
    total = milliseconds("sentence.flite") + milliseconds("laugh.lab") + milliseconds("laughing.flite")
    assert len(data["frames"]) == int(total * data["fps"] / 1000 + 0.5) + EASE
    assert any(data["frames"][-EASE - 1]) and not any(data["frames"][-1])
    assert data["channels"] == [f"fap{n}" for n in (3, 16, 17, *range(51, 61))]
    frames = np.array(data["frames"])
    assert frames.shape[1] == 13 and frames.dtype == int and np.abs(frames).max() <= 1860
    assert all(np.ptp(part[:, [0, 4]], axis=0).min() >= 20 for part in np.split(frames, parts(data)))


def test_phonemes_tile_the_frames(data: Dict[str, Any]) -> None:
    """Phonemes follow each other from the first frame to the way to rest: speech, laughter, and both."""
    at = 0
    for phoneme in data["phonemes"]:
        assert phoneme["start_frame"] == at and phoneme["frames"] >= 1 and phoneme["label"]
        at += phoneme["frames"]
    assert at == len(data["frames"]) - EASE
    kinds = [kind for kind, _ in itertools.groupby(phoneme["kind"] for phoneme in data["phonemes"]
                                                   if phoneme["kind"] != "silence")]
    assert kinds == ["speech", "laughter", "speech", "laughing", "laughter", "laughing", "speech"]


def test_the_sentence_breaks_into_laughter_and_recovers(data: Dict[str, Any], plain: Dict[str, Any]) -> None:
    """Before and after it is plain speech; in between corners rise with every word, and the pause laughs."""
    frames, speech, both = np.array(data["frames"]), np.array(plain["frames"]), parts(data)[1]
    assert frames.shape == speech.shape
    laughing = spans(data, "laughing", both)
    (_, first, last), = spans(data, "laughter", both)
    begin, end = first - int(2 * data["fps"]), laughing[-1][2]  # it sets in two seconds before the words pause
    ramp = int(0.24 * data["fps"])
    assert begin <= laughing[0][1] and (frames[:begin] == speech[:begin]).all()
    assert (frames[end + ramp :] == speech[end + ramp :]).all() and len(frames) > end + 2 * ramp
    for _, word, past in laughing:
        if word >= begin + ramp and past <= end - ramp:
            assert (frames[word:past, 11:] > speech[word:past, 11:] + 30).all(), "the corners"
    lips = opening(frames[first + ramp : last - ramp])
    tops = (lips[:-2] < lips[1:-1]) & (lips[1:-1] >= lips[2:])
    assert tops.sum() >= 4 and lips.max() >= 100 > lips.min()


def test_sound_is_that_of_the_timings(data: Dict[str, Any]) -> None:
    """Catches another sound or length, words that are not where the phonemes are, and a voice in laughs."""
    soundfile = pytest.importorskip("soundfile")
    kind, _, content = data["audio"].partition(",")
    sound = base64.b64decode(content)
    assert kind == "data:audio/flac;base64" and sound == (DEMO / "speech.flac").read_bytes() and len(sound) <= 400_000
    samples, rate = soundfile.read(io.BytesIO(sound))
    assert abs(len(samples) / rate - (len(data["frames"]) - EASE) / data["fps"]) < 1 / data["fps"]

    def level(phoneme: Dict[str, Any]) -> float:
        first, count = (int(phoneme[key] * rate / data["fps"]) for key in ("start_frame", "frames"))
        heard = samples[first : first + count]
        return float(np.sqrt(np.mean(heard**2)))

    spoken = [p for p in data["phonemes"] if p["kind"] in ("speech", "laughing")]
    loud = float(np.median([level(p) for p in spoken if p["label"] in VOWELS]))
    assert all(level(p) > loud / 10 for p in spoken if p["label"] in VOWELS)
    assert all(level(p) < loud / 2 for p in spoken if p["label"] == "P")
    assert all(level(p) < loud / 5 for p in data["phonemes"] if p["kind"] == "silence")
    assert all(level(p) < loud / 20 for p in data["phonemes"] if p["kind"] == "laughter")  # the word before it ends


@needs_flite
def test_sound_is_what_flite_says(tmp_path: Path) -> None:
    """Sound and timings are of one utterance: what flite's voice slt says; README.md has the commands."""
    soundfile = pytest.importorskip("soundfile")
    text = (DEMO / "README.md").read_text(encoding="utf-8")
    commands = re.search(r"```sh\n(flite .*?)```", text, re.S)
    assert commands
    said = [line for line in commands[1].splitlines() if line.startswith("flite")]
    assert len(said) == 3
    for line in said:
        subprocess.run(line, shell=True, cwd=tmp_path, check=True, timeout=60)
    sentence, bear, maybe = ((tmp_path / f"{name}.flite").read_text().split() for name in ("sentence", "bear", "maybe"))
    assert (DEMO / "sentence.flite").read_text().split() == sentence
    first, _, last = (DEMO / "laughing.flite").read_text().strip().split("\n")
    assert first.split() == bear[:-1] and last.split() == maybe and bear[-1].startswith("pau:")
    samples, rate = soundfile.read(DEMO / "speech.flac", dtype="int16")
    laugh, pause = milliseconds("sentence.flite"), milliseconds("laughing.flite")
    second = laugh + milliseconds("laugh.lab")
    third = second + pause - round(float(maybe[-1].split(":")[1]) * 1000)
    for name, begin in (("sentence", 0), ("bear", second), ("maybe", third)):
        spoken, _ = soundfile.read(tmp_path / f"{name}.wav", dtype="int16")
        length = int(float(bear[-2].split(":")[1]) * rate) - rate // 100 if name == "bear" else len(spoken)
        at = begin * rate // 1000
        assert np.array_equal(samples[at : at + length], spoken[:length]), name


@needs_flite
def test_the_kiosks_sound_is_what_flite_says(tmp_path: Path) -> None:
    """examples/kiosk: sound and timings are what the commands of its README.md make."""
    soundfile = pytest.importorskip("soundfile")
    kiosk = DEMO.parent / "kiosk"
    said = re.search(r"```sh\n(flite .*?welcome\.flite)\n", (kiosk / "README.md").read_text(encoding="utf-8"), re.S)
    assert said
    subprocess.run(said[1], shell=True, cwd=tmp_path, check=True, timeout=60)
    assert main(["timings", str(tmp_path / "welcome.flite"), "-o", str(tmp_path / "welcome.lab")]) == 0
    assert (tmp_path / "welcome.lab").read_text() == (kiosk / "welcome.lab").read_text()
    sound, wanted = (soundfile.read(path, dtype="int16") for path in (kiosk / "welcome.flac", tmp_path / "welcome.wav"))
    assert sound[1] == wanted[1] and np.array_equal(sound[0], wanted[0])


# ---- The demo page and those of `labial page` in a real browser, from the disk ---------------------------------------


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
def demo(data: Dict[str, Any], browser: Browser) -> Iterator[Page]:
    page = browser.page(Path(PAGE).as_uri())
    yield page
    assert page.errors() == []


def in_step(seen: List[List[float]], fps: float) -> None:
    """Sound and lips are never more than a frame apart while the sound plays."""
    before, after, drawn = np.array([frame for frame in seen if frame[0] > 0]).T
    assert len(drawn) >= 3  # on a machine that is busy otherwise, too
    assert np.maximum(before - drawn, drawn - after).max() <= 1 / fps


@pytest.mark.slow
def test_demo_plays_pauses_and_seeks_in_step(demo: Page, data: Dict[str, Any]) -> None:
    """Catches a sound that does not play, lips that run ahead or behind, and either going on or elsewhere alone."""
    fps = data["fps"]
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


def test_demo_closes_the_lips_it_draws(demo: Page, data: Dict[str, Any]) -> None:
    """In every p, b and m a frame is drawn with the lips closed; vowels are open, f and v are not closed."""
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


@pytest.mark.slow
@pytest.mark.parametrize("options", [
    {"format": "WAV", "subtype": "PCM_16"}, {"format": "WAV", "subtype": "FLOAT"}, {"format": "MP3"},
    {"format": "OGG", "subtype": "OPUS"},
], ids=lambda options: "-".join(options.values()))
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


def test_page_on_a_phone(browser: Browser, tmp_path: Path) -> None:
    """Face and controls are seen at once, and screen readers do not read the numbers of every frame."""
    (tmp_path / "a.csv").write_text(frames(100))
    title = "Maybe people hum by the pool. " * 3
    assert main(["page", str(tmp_path / "a.csv"), "--title", title, "-o", str(tmp_path / "a.html")]) == 0
    page = browser.page((tmp_path / "a.html").as_uri())
    page.command("Emulation.setDeviceMetricsOverride", {"width": 375, "height": 667, "deviceScaleFactor": 1,
                                                        "mobile": True})
    page.wait_for("innerWidth === 375 && document.getElementById('play').getBoundingClientRect().bottom < 667")
    assert page.evaluate("document.documentElement.scrollWidth") == 375
    assert page.evaluate("[...document.querySelectorAll('output')].map((one) => one.ariaLive)") == ["off"] * 3
