"""examples/kiosk in a real browser, with the npm package as it is built: what is drawn is held to the sound and to the
frames of the C library."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any, Dict, Iterator, List

import numpy as np
import pytest

import labial
from browser import Browser, Page, served
from npm import lay
from packages import SOURCE, needs_runtime

KIOSK = SOURCE / "examples" / "kiosk"
pytestmark = [pytest.mark.slow, needs_runtime]

PERIOD = 0.02

#: Takes down what is drawn: the sound's time before and after, the clock, and the FAPs.
WATCH = """(() => {
  const face = document.getElementById("face"), voice = document.getElementById("voice"), show = face.show;
  window.seen = [];
  face.show = faps => {
    const before = voice.currentTime;
    show.call(face, faps);
    window.seen.push([before, voice.currentTime, performance.now() / 1000, ...face.faps]);
  };
})()"""

#: A clock that the test turns: animation frames come and the sound goes on when `turn` is called, and at no other time.
CLOCK = """
let now = 0, asked = new Map(), number = 0;
window.requestAnimationFrame = action => { asked.set(++number, action); return number; };
window.cancelAnimationFrame = number => asked.delete(number);
performance.now = () => now;
const sound = {time: 0, playing: false, length: Infinity};
const own = (name, get, set) => Object.defineProperty(HTMLMediaElement.prototype, name, {get, set});
own("currentTime", () => sound.time, time => { sound.time = time; });
own("paused", () => !sound.playing);
own("ended", () => sound.time >= sound.length);
own("seeking", () => false);
own("readyState", () => 4);
HTMLMediaElement.prototype.play = async () => { Object.assign(sound, {time: 0, playing: true}); };
HTMLMediaElement.prototype.pause = () => { sound.playing = false; };
window.turn = milliseconds => {
  now += milliseconds;
  if (sound.playing) sound.time = Math.min(sound.time + milliseconds / 1000, sound.length);
  if (sound.time >= sound.length) sound.playing = false;
  const actions = asked;
  asked = new Map();
  for (const action of actions.values()) action(now);
};
window.sound = sound;
window.until = async reached => {
  while (!reached()) {
    turn(1000 / 60);
    await new Promise(resolve => setTimeout(resolve)); // for what comes from the server, and for promises
  }
};
"""


@pytest.fixture(scope="module")
def address(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Where the kiosk is served, with the package beside it as `npm install` lays it down."""
    folder = tmp_path_factory.mktemp("kiosk") / "kiosk"
    shutil.copytree(KIOSK, folder)
    lay(npm_package, folder, "labial", "labial-laughter")
    with served(folder) as site:
        yield f"{site}/index.html"


def opened(browser: Browser, address: str, before: str = "") -> Page:
    page = browser.page(address, before)
    page.wait_for("document.getElementById('status').textContent !== ''")
    page.evaluate(WATCH)
    return page


def tap(page: Page, name: str) -> None:
    """A finger on an element."""
    box = f"document.getElementById('{name}').getBoundingClientRect()"
    x, y = page.evaluate(f"(box => [box.x + box.width / 2, box.y + box.height / 2])({box})")
    page.click(x, y)


def test_lips_are_where_the_sound_is(browser: Browser, address: str) -> None:
    """Real sound, real time: what is drawn is the C library's motion as it is heard, give or take a frame."""
    frames = np.array(labial.render(labial.read_timings(KIOSK / "welcome.lab")))
    page = opened(browser, address)
    tap(page, "speak")
    page.wait_for("voice.currentTime > 2.8")
    assert not page.evaluate("voice.paused")
    drawings = [row for row in page.evaluate("seen") if row[1] > 0]
    assert len(drawings) >= 5  # on a machine that is busy otherwise, too

    def distance(late: float) -> np.ndarray:
        """Of each drawing the distance to the motion between a frame before and a frame behind what is heard."""
        found = []
        for before, after, _, *faps in drawings:
            moments = np.arange(before - PERIOD, after + PERIOD, 0.001) + late
            motion = [np.interp(moments / PERIOD, np.arange(len(frames)), channel) for channel in frames.T]
            found.append(np.abs(np.transpose(motion) - faps).max(axis=1).min())
        return np.array(found)

    assert distance(0.0).max() < 12  # the fastest speech in a millisecond
    assert (distance(3 * PERIOD) > 12).mean() > 0.5  # so that this would be seen
    tap(page, "stop")
    assert page.errors() == []


def smooth(seen: List[List[Any]]) -> None:
    """From one drawing to the next nothing moves faster than the fastest speech, some 12 FAP units a millisecond."""
    rows = np.array([row[2:] for row in seen], dtype=float)
    steps = np.abs(np.diff(rows[:, 1:], axis=0)).max(axis=1)
    assert (steps <= 12 * np.maximum(np.diff(rows[:, 0]) * 1000, 20)).all()


def turn_until(page: Page, expression: str) -> None:
    """Turns the clock, 60 drawings a second, until an expression is true."""
    page.evaluate(f"until(() => {expression})")


def turn_for(page: Page, seconds: float) -> None:
    turn_until(page, f"performance.now() >= {page.evaluate('performance.now()') + 1000 * seconds}")


def speaking(page: Page, seconds: float) -> None:
    """A tap on "speak", and so many seconds of the sound."""
    tap(page, "speak")
    turn_until(page, "sound.playing")
    turn_for(page, seconds)


def test_a_stop_in_the_middle(browser: Browser, address: str) -> None:
    """The sound stops at once, the lips come to rest within a second without a jump, and stay there."""
    page = opened(browser, address, CLOCK)
    speaking(page, 1.6)
    tap(page, "stop")
    paused, at, stopped = page.evaluate("[voice.paused, voice.currentTime, performance.now() / 1000]")
    assert paused and at == pytest.approx(1.6, abs=0.02)
    turn_for(page, 1.2)
    seen = page.evaluate("seen")
    smooth(seen)
    at_rest = next(i for i, row in enumerate(seen) if row[2] > stopped and not any(row[3:]))
    assert seen[at_rest][2] - stopped < 1 and any(seen[at_rest - 1][3:])
    assert not any(any(row[3:]) for row in seen[at_rest:]) and page.evaluate("voice.currentTime") == at
    page.evaluate("seen.length = 0")
    speaking(page, 0.6)
    heard = [row[1] for row in page.evaluate("seen") if any(row[3:])]
    assert 0 < heard[0] < 0.3 and heard[-1] == pytest.approx(0.6, abs=0.02)
    assert page.errors() == []


def test_a_tap_makes_it_laugh_and_speech_interrupts_that(browser: Browser, address: str) -> None:
    """Tapped while it speaks it falls silent and laughs; told to speak while it laughs it speaks; nothing jumps."""
    page = opened(browser, address, CLOCK)
    speaking(page, 0.5)
    tap(page, "face")
    assert page.evaluate("voice.paused")
    turn_until(page, "face.stream && face.stream.number > 50")
    laughing = np.array([row[2:] for row in page.evaluate("seen")][-60:], dtype=float)  # a second of it
    opening = -(laughing[:, 4] + laughing[:, 5])
    tops = np.flatnonzero((opening[1:-1] > opening[:-2]) & (opening[1:-1] >= opening[2:]))
    assert laughing[-1, 12:14].min() > 20 and len(tops) >= 3 and np.ptp(opening) > 60
    tapped = page.evaluate("performance.now() / 1000")
    speaking(page, 0.5)
    assert page.evaluate("!!face.track")
    seen = page.evaluate("seen")
    smooth(seen)
    at_rest = next(row[2] for row in seen if row[2] > tapped and not any(row[3:]))
    assert 0.15 < at_rest - tapped < 1  # the stream's own way to rest takes 0.2 s
    tap(page, "face")
    turn_until(page, "face.stream && face.stream.done")
    assert page.errors() == []


def counters(page: Page) -> Dict[str, int]:
    """What the page holds after a collection: elements, listeners, and bytes, those of the library among them."""
    for _ in range(2):  # what finalizers let go of falls to the second
        page.command("HeapProfiler.collectGarbage")
    found = page.command("Memory.getDOMCounters")
    usage = page.command("Runtime.getHeapUsage")
    found["bytes"] = int(sum(usage[name] for name in ("usedSize", "embedderHeapUsedSize", "backingStorageSize")))
    return found


def test_ten_minutes_take_no_memory(browser: Browser, address: str) -> None:
    """By a clock that the test turns, 20 drawings a second. Catches what a kiosk that runs for weeks would die of."""
    page = opened(browser, address, CLOCK)
    page.evaluate("delete face.show")
    cycle = """(async minutes => {
      const settled = () => new Promise(resolve => setTimeout(resolve));
      const pass = seconds => { for (let i = 0; i < 20 * seconds; i++) turn(50); };
      let passed = 0;
      while (passed < 60 * minutes) {
        for (const [button, seconds] of [["speak", 7], ["face", 2.5], ["speak", 2], ["face", 1], ["stop", 1]]) {
          document.getElementById(button).click();
          while (button === "speak" && !sound.playing) { turn(20); passed += 0.02; await settled(); }
          for (let i = 0; i < 15; i++) { turn(20); await null; }
          pass(seconds);
          passed += seconds + 0.3;
        }
      }
    })"""
    page.evaluate(f"{cycle}(0.5)")  # what is loaded and compiled once
    held = []
    for _ in range(10):
        page.evaluate(f"{cycle}(1)")
        held.append(counters(page))

    def growth(name: str) -> int:
        return min(minute[name] for minute in held[-4:]) - min(minute[name] for minute in held[:4])

    assert growth("nodes") <= 0 and growth("jsEventListeners") <= 0
    assert growth("bytes") < 100_000, held
    assert page.errors() == []


def test_the_element_by_itself(browser: Browser, address: str) -> None:
    """A stream at the sound's clock, frame by frame; an element that is set early, or moved to another document."""
    page = opened(browser, address, CLOCK)
    wanted, found, late = page.evaluate("""(async () => {
      const {Labial} = await import("labial");
      const {LabialMouth, define} = await import("labial/labial-mouth.js");
      const labial = await Labial.load(), lab = labial.read(await (await fetch("welcome.lab")).text());
      const said = () => {
        const stream = labial.stream();
        for (const {start, end, label} of lab.slice(0, 12)) stream.push(label, 1000 * (end - start));
        stream.end();
        return stream;
      };
      const wanted = Array.from(said(), faps => Array.from(faps)), found = [];
      face.audio = voice;
      face.stream = said();
      voice.play();
      turn(0);
      for (let i = 0; i < wanted.length; i++) { found.push(Array.from(face.faps)); turn(20); }
      const late = document.createElement("late-mouth"), track = labial.render([{start: 0, end: 1, label: "AA"}]);
      late.track = track;
      document.body.append(late);
      define("late-mouth", class extends LabialMouth {});
      const frame = document.createElement("iframe");
      document.body.append(frame);
      frame.contentDocument.body.append(late);
      const sheets = late.shadowRoot.adoptedStyleSheets.map(sheet => sheet.cssRules.length);
      let refused = "";
      try { await late.cancel(NaN); } catch (error) { refused = error.message; }
      return [wanted, found, {own: Object.keys(late), kept: late.track === track, sheets, refused}];
    })()""")
    assert len(wanted) == 65 + 12 and wanted == found
    assert late["own"] == [] and late["kept"] and len(late["sheets"]) == 1 and late["sheets"][0] > 0
    assert "milliseconds" in late["refused"] and page.errors() == []


@pytest.mark.parametrize("lost", ["welcome.lab", "welcome.flac"])
def test_what_is_missing_is_said(browser: Browser, address: str, lost: str) -> None:
    """Without its timings or its sound the page says so, and the mouth rests; the next laugh is as ever."""
    page = opened(browser, address)
    page.command("Network.enable")
    page.command("Network.setBlockedURLs", {"urls": [f"*{lost}"]})
    tap(page, "speak")
    page.wait_for("document.getElementById('status').textContent !== 'Tap the face, and it laughs.'")
    assert page.evaluate("document.getElementById('status').textContent.length") > 10
    tap(page, "face")
    page.wait_for("face.stream && face.stream.number > 30")
