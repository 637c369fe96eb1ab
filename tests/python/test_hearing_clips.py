"""Folders of speech for hearing, and clips as the network learns them; distortions of sounds and of their log energies:
what each changes, and what it leaves; the figures that hearing is judged by, against cases worked by hand, what they
are measured on, and the command."""

from __future__ import annotations

import ctypes.util
import importlib.util
import re
from pathlib import Path
from typing import List, Optional

import numpy as np
import pytest
import soundfile

from labial.__main__ import main
from labial.corpus.episode import Segment
from labial.errors import DataError, LabialError
from labial.evaluate import hearing
from labial.files.faps import CHANNELS, FAP_NUMBERS, TOUCHING
from labial.files.frames import opening
from labial.hearing import clips, distort, measures, prepared, targets
from labial.hearing.features import BANDS, FLOOR, FRAME, RATE, log_energies, triangles
from labial.hearing.measures import Figures, delay, measured, pooled
from labial.hearing.model import CLASSES, save
from labial.hearing.prepared import Prepared
from models import random_hearing
from packages import needs_runtime

LAB = "0.00 0.10 SIL\n0.10 0.20 M\n0.20 0.50 AA1\n"


def sound(path: Path, seconds: float = 0.5) -> Path:
    """A tone that swells, as a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    time = np.arange(round(seconds * 16000)) / 16000
    soundfile.write(str(path), 0.3 * np.sin(2 * np.pi * 200 * time) * time / seconds, 16000)
    return path


def test_what_tells_the_phonemes(tmp_path: Path) -> None:
    """Timings come before a table, a table before a text; a table counts in its folder and the one below."""
    for name in ("wavs/a.wav", "wavs/b.flac", "c.wav", "deep/er/d.wav", "e.wav"):
        sound(tmp_path / name)
    (tmp_path / "metadata.csv").write_text("a|10|ten\nb|two\n\nc|three|three\nmissing|x|x\n")
    (tmp_path / "wavs" / "b.lab").write_text(LAB)
    (tmp_path / "c.txt").write_text("not this")
    (tmp_path / "deep" / "er" / "d.txt").write_text("four\n five \n")
    (tmp_path / "e.TextGrid").write_text("")
    found = {Path(path).stem: told for path, told in clips.find(tmp_path)}
    assert [found[name].text for name in "abcde"] == ["ten", None, "three", "four five", None]
    assert (found["a"].line, found["c"].line, Path(found["e"].path).name) == (1, 4, "e.TextGrid")


@pytest.mark.parametrize(("table", "message"), [
    ("a|one\nb\n", r"metadata.csv:2: not NAME\|TEXT"), ("a|one|one|one\n", "metadata.csv:1: not"),
    ("a| \n", "metadata.csv:1: not"), ("a|one\n\na|two\n", "metadata.csv:3: a is already in line 1"),
    (None, "a.wav: neither timings nor a text"),
])  # fmt: skip
def test_folders_without_what_is_needed(table: Optional[str], message: str, tmp_path: Path) -> None:
    """No folder, no sounds, a sound without anything that tells what it says, an empty text, wrong timings."""
    for folder, missing in ((tmp_path / "none", "none: not a folder"), (tmp_path, "no sounds")):
        with pytest.raises(DataError, match=missing):
            clips.find(folder)
    sound(tmp_path / "a.wav")
    if table:
        (tmp_path / "metadata.csv").write_text(table)
    with pytest.raises(DataError, match=message):
        clips.find(tmp_path)
    (tmp_path / "metadata.csv").unlink(missing_ok=True)
    (tmp_path / "a.txt").write_text(" \n")
    with pytest.raises(DataError, match="a.txt: no text"):
        clips.find(tmp_path)
    (tmp_path / "a.lab").write_text("0 1 AA\n1 2 XYZ\n")
    with pytest.raises(DataError, match="a.lab:2: no speech phoneme is called 'XYZ'"):
        clips.read(tmp_path, tmp_path / "cache")


class Found:
    """What alignment is taken for in the tests below."""

    def __init__(self, confidence: float) -> None:
        from labial.sound.recogniser import Stretch

        self.stretches = [Stretch(0.0, 0.3, confidence), Stretch(0.3, 0.4, 1.0)]

    def lab(self) -> str:
        """The segments."""
        return LAB


@pytest.mark.skipif(importlib.util.find_spec("pocketsphinx") is None, reason="pocketsphinx is not installed")
def test_alignments_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each sound is aligned once; what fits badly is left out with a warning, also the next time, but not where one
    stretch of several is unsure; another text is aligned anew."""
    asked: List[str] = []

    def aligned(path: str, text: Optional[str]) -> Found:
        asked.append(str(text))
        if text == "wrong":
            raise LabialError("the text has no words")
        return Found({"good": 0.9, "bad": 0.1, "unsure": 0.5}.get(str(text), 1.0))

    monkeypatch.setattr("labial.sound.align.aligned", aligned)
    folder, cache = tmp_path / "in", tmp_path / "cache"
    for name, text in (("a", "good"), ("b", "bad"), ("c", "unsure"), ("d", "wrong")):
        sound(folder / f"{name}.wav")
        (folder / f"{name}.txt").write_text(text)
    told: List[tuple] = []
    with pytest.warns(UserWarning) as warned:
        first = clips.read(folder, cache, told=lambda done, total: told.append((done, total)))
    messages = sorted(str(item.message) for item in warned)
    assert len(messages) == 2 and "b.txt: the text hardly fits" in messages[0] and "d.txt: the text has" in messages[1]
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)] and asked == ["good", "bad", "unsure", "wrong"]
    again = clips.read(folder, cache)
    assert again == first and [Path(item.sound).stem for item in first] == ["a", "c"] and len(asked) == 4
    assert [item.label for item in first[0].segments] == ["SIL", "M", "AA"]
    (folder / "a.txt").write_text("another")
    clips.read(folder, cache)
    assert asked[4:] == ["another"]
    for name in "ac":
        (folder / f"{name}.txt").write_text("bad")
    with pytest.warns(UserWarning), pytest.raises(DataError, match="no sound fits its text"):
        clips.read(folder, cache)


def test_durations_follow_the_clock() -> None:
    """Rounding does not add up, gaps are silence, and a speed shortens all."""
    segments = [Segment(k * 0.0334, (k + 1) * 0.0334, "AA") for k in range(30)]
    assert sum(length for _, length in targets.durations(segments)) == round(30 * 33.4)
    given = [Segment(0.1, 0.2, "M"), Segment(0.3, 0.5, "AA")]
    assert targets.durations(given) == [("SIL", 100), ("M", 100), ("SIL", 100), ("AA", 200)]
    assert targets.durations(given, 2.0) == [("SIL", 50), ("M", 50), ("SIL", 50), ("AA", 100)]


@needs_runtime
def test_targets_are_those_of_the_stream() -> None:
    """Frames of labial.render, as many as asked for; the class in a frame's middle; closed lips touch, open ones do
    not."""
    from labial import render

    timings = [("SIL", 100), ("M", 90), ("AA", 310)]
    frames = targets.frames(timings, 30)
    assert frames.shape == (30, CHANNELS)
    assert np.array_equal(frames[:20], np.array(render([*timings, ("SIL", 400)]))[:20])
    assert [CLASSES[k] for k in targets.classes(timings, 26)] == ["SIL"] * 5 + ["M"] * 4 + ["AA"] * 16 + ["SIL"]
    assert opening(targets.closure().pose) <= TOUCHING < opening(frames[15])
    assert targets.frames([], 4).shape == (4, CHANNELS)


@needs_runtime
def test_takes_of_a_clip(tmp_path: Path) -> None:
    """The first is undistorted, so that its closure is where it was, after the pause before it; all are as long in
    energies as in frames; the same seed gives the same takes, another seed others."""
    (tmp_path / "a.lab").write_text(LAB)
    segments = clips.phoneme_segments("a", tuple(clips.read_timings(tmp_path / "a.lab")), clips.SPEECH)
    clip = clips.Clip(str(sound(tmp_path / "a.wav")), segments)
    takes = prepared.prepare_clip(clip, 3, 0)
    for energies, frames, classes in takes:
        assert len(energies) == 2 * len(frames) == 2 * len(classes)
        assert (classes == CLASSES.index("M")).sum() in range(3, 8)
    energies, _, classes = takes[0]
    loud = np.flatnonzero(energies.max(axis=1) > energies.max() - 1)
    spoken = np.flatnonzero(classes == CLASSES.index("AA"))
    assert 2 * spoken[0] < loud[0] and loud[-1] <= 2 * spoken[-1] + 3
    again, other = prepared.prepare_clip(clip, 3, 0), prepared.prepare_clip(clip, 3, 1)
    assert all(np.array_equal(a, b) for one, two in zip(takes, again) for a, b in zip(one, two))
    assert any(len(one[0]) != len(two[0]) for one, two in zip(takes, other))


@needs_runtime
def test_what_was_prepared_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a cache that knows other options and other timings apart; about one clip in twenty is held out."""
    for k in range(3):
        sound(tmp_path / "in" / f"{k}.wav")
        (tmp_path / "in" / f"{k}.lab").write_text(LAB)
    given = clips.read(tmp_path / "in", tmp_path / "cache")
    first = prepared.prepare(given, 2, 0, tmp_path / "cache")
    assert len(first.lengths) == 6 and first.lengths.sum() == len(first.classes) == len(first.frames)
    counted: List[int] = []
    monkeypatch.setattr(prepared, "prepare_clip", lambda *a, **b: counted.append(1) or [
        (log_energies(np.zeros(640)).astype(np.float16), np.zeros((2, 13), np.int16), np.zeros(2, np.uint8))])
    again = prepared.prepare(given, 2, 0, tmp_path / "cache")
    assert not counted and np.array_equal(again.energies, first.energies)
    prepared.prepare(given, 2, 1, tmp_path / "cache")
    assert len(counted) == 3
    (tmp_path / "in" / "0.lab").write_text(LAB.replace("M", "B"))
    prepared.prepare(clips.read(tmp_path / "in", tmp_path / "cache"), 2, 0, tmp_path / "cache")
    assert len(counted) == 6
    share = np.mean([prepared.is_held(f"/some/where/{k}.wav") for k in range(4000)])
    assert 0.04 < share < 0.06


def test_parts_are_the_takes_that_are_held_out() -> None:
    """And their frames and hops alone."""
    lengths, held = np.array([2, 3, 1]), np.array([False, True, False])
    every = prepared.Prepared(np.arange(12)[:, None] * np.ones((12, 24)), np.arange(6)[:, None] * np.ones((6, 13)),
                              np.arange(6), lengths, held)
    kept, learned = every.part(True), every.part(False)
    assert kept.classes.tolist() == [2, 3, 4] and kept.energies[:, 0].tolist() == [4, 5, 6, 7, 8, 9]
    assert learned.classes.tolist() == [0, 1, 5] and learned.lengths.tolist() == [2, 1]


def tone(frequency: float, seconds: float = 1.0) -> np.ndarray:
    return (0.5 * np.sin(2 * np.pi * frequency * np.arange(round(seconds * RATE)) / RATE)).astype(np.float32)


def noise(seconds: float = 2.0, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(scale=0.1, size=round(seconds * RATE)).astype(np.float32)


def test_speeds_levels_and_offsets() -> None:
    """Peaks in dB of full scale, rounded to whole numbers; silence stays silence; too large an offset is held."""
    found = distort.resampled(tone(440.0), 1.1)
    loudest = float(np.argmax(np.abs(np.fft.rfft(found))) * RATE / len(found))
    assert len(found) == round(RATE / 1.1) and loudest == pytest.approx(484.0, abs=2)
    assert distort.rms(found) == pytest.approx(distort.rms(tone(440.0)), rel=0.02)
    found = distort.as_integers(tone(440.0), -40.0)
    assert found.dtype == np.int16 and np.abs(found).max() == 328
    assert distort.as_integers(tone(440.0), -40.0, 0.5).mean() == pytest.approx(164, abs=1)
    assert not distort.as_integers(np.zeros(10, np.float32), 0.0).any()
    assert distort.as_integers(tone(440.0), 0.0, 0.3).max() == 32767


def test_a_channel_passes_its_band() -> None:
    """24 dB an octave outside, 3 dB at its edges, all of the middle."""
    for frequency, level in ((1000.0, 0.0), (300.0, -3.0), (150.0, -24.0), (3400.0, -3.0), (6800.0, -24.0)):
        found = distort.rms(distort.limited(tone(frequency), 300.0, 3400.0)) / distort.rms(tone(frequency))
        assert 20 * np.log10(found) == pytest.approx(level, abs=0.5)


def test_a_room_rings_after_the_sound() -> None:
    """A click is followed by noise that falls by 60 dB in the decay, of the click's energy."""
    click = np.zeros(RATE, np.float32)
    click[1000] = 1.0
    found = distort.reverberated(click, 0.5, 1.0, np.random.default_rng(0))
    assert found[1000] == pytest.approx(1.0, abs=1e-4) and not np.abs(found[:1000]).max() > 1e-5
    tail = found[1001:]
    assert np.sum(tail**2) == pytest.approx(1.0, rel=0.01) and np.abs(tail[8100:]).max() < 1e-5
    level = [10 * np.log10(np.mean(tail[a : a + 800] ** 2)) for a in (400, 4400)]
    assert level[0] - level[1] == pytest.approx(30.0, abs=1.5)  # a quarter of a second of the half
    rumble = np.abs(np.fft.rfft(distort.rumbling(RATE, np.random.default_rng(3)))) ** 2
    assert rumble[:400].sum() > 0.95 * rumble.sum()


def test_clipping_and_companding() -> None:
    """The share that is cut off; 8 bits of mu-law leave 37 to 39 dB at any level down to -30 dB."""
    found = distort.clipped(noise(), 0.05)
    assert (np.abs(found) >= np.abs(found).max() - 1e-6).mean() == pytest.approx(0.05, abs=0.002)
    for scale in (1.0, 0.03):
        given = noise() / np.abs(noise()).max() * scale
        error = distort.companded(given) - given
        assert 34 < 20 * np.log10(distort.rms(given) / distort.rms(error)) < 41


def test_drawn_distortions_cover_their_ranges() -> None:
    """Half of the sounds keep room and channel; levels and speeds fill their ranges; the same seed draws the same."""
    random = np.random.default_rng(0)
    every = [distort.drawn(random) for _ in range(2000)]
    again = np.random.default_rng(0)
    assert [distort.drawn(again) for _ in range(5)] == every[:5]
    plain = [item for item in every if not (item.decay or item.band or item.rumble or item.clip or item.companded
                                            or item.offset)]
    assert 0.5 < len(plain) / len(every) < 0.65
    peaks, speeds = (np.array([getattr(item, name) for item in every]) for name in ("peak", "speed"))
    assert -45 <= peaks.min() < -44 and -1 < peaks.max() <= 0 and 0.25 < (speeds == 1.0).mean() < 0.35
    assert 0.85 <= speeds.min() < 0.86 and 1.19 < speeds.max() <= 1.2
    for item in (every[0], distort.Distortion(1.1, 0.2, 1.0, (200.0, 4000.0), 0.5, 0.05, companded=True, peak=-20.0,
                                                   offset=0.1)):
        found = distort.distorted(noise(0.5), item, np.random.default_rng(1))
        assert found.dtype == np.int16 and len(found) == round(8000 / item.speed)


# ---- Log energies


def test_noise_has_the_bands_of_noise() -> None:
    """Of white noise the bands have energies in proportion to their triangles; all together have a mean of 1."""
    found = np.exp2(distort.white(60.0, np.random.default_rng(0))).mean(axis=0)
    shares = triangles().sum(axis=0)
    assert found == pytest.approx(shares / shares.mean(), rel=0.05)


def test_noise_is_mixed_at_its_ratio() -> None:
    """Against sounds that are mixed before their energies are taken: the same but for what sound and noise add to each
    other at random, most in the narrow low bands; and any level of the noise counts the same."""
    speech, hiss = 3000 * noise(2.0), 3000 * noise(2.0, 1)
    swell = np.repeat([0.05, 1.0, 0.2, 1.0], RATE // 2).astype(np.float32)
    given, added = (log_energies(item)[None, 2:] for item in (speech * swell, hiss))
    ratio = 10.0
    scale = distort.rms(speech * swell) / distort.rms(hiss) * 10 ** (-ratio / 20)
    true = log_energies(speech * swell + scale * hiss)[2:]
    found = distort.mixed(given, added - 5.0, np.array([ratio]))[0]
    assert np.abs((found - true).mean(axis=0)).max() < 0.25
    assert np.abs((found - true).reshape(4, -1).mean(axis=1)).max() < 0.2


def test_bands_are_warped_linearly() -> None:
    """Band k has what was in band 1.1 k; a factor of 1 changes nothing."""
    ramp = np.tile(np.arange(BANDS, dtype=np.float32), (2, 3, 1))
    found = distort.warped(ramp, np.array([1.0, 1.1]))
    assert found[0] == pytest.approx(ramp[0], abs=1e-5)
    assert found[1, 0] == pytest.approx(np.minimum(1.1 * np.arange(BANDS), BANDS - 1), abs=1e-4)


def test_augmented_energies() -> None:
    """Shapes and the floor; digital silence stays where no noise comes; most crops have noise in it; the same seed
    gives the same; the level of speech strays to both sides."""
    pool = distort.white(30.0, np.random.default_rng(0))
    given = np.full((400, 60, BANDS), FLOOR, np.float32)
    given[:, 20:] = 16.0
    found = distort.augmented(given, pool, np.random.default_rng(1))
    assert found.shape == given.shape and found.dtype == np.float32 and found.min() == FLOOR
    assert np.array_equal(found, distort.augmented(given, pool, np.random.default_rng(1)))
    silent = (found[:, :20] == FLOOR).all(axis=(1, 2))
    assert 1 - distort.NOISY < silent.mean() + 0.02 and silent.mean() < 1 - distort.NOISY + 0.06
    moved = np.median(found[:, 20:], axis=(1, 2)) - 16.0
    assert 1.3 < moved.std() < 3.5 and abs(moved.mean()) < 0.6


# ---- The figures that hearing is judged by ---------------------------------------------------------------------------


SIL, M, AA = (CLASSES.index(name) for name in ("SIL", "M", "AA"))


def mouth(gaps: List[float]) -> np.ndarray:
    """(T, 13) frames in which the lips are so far apart; the jaw and all others stay."""
    frames = np.zeros((len(gaps), CHANNELS))
    frames[:, FAP_NUMBERS.index(51)] = -0.25 * np.array(gaps)
    frames[:, FAP_NUMBERS.index(52)] = -0.75 * np.array(gaps)
    return frames


def test_closures_by_hand() -> None:
    """Two frames before and after a run count, three do not; 72 FAP units touch, 73 do not."""
    classes = np.full(40, AA)
    classes[[10, 11, 20, 21, 30, 31]] = M
    gaps = np.full(40, 200.0)
    gaps[8], gaps[17], gaps[33] = 72, 10, 73
    assert measures.closures(mouth(gaps.tolist()), classes) == [True, False, False]
    gaps[33] = 72
    assert measures.closures(mouth(gaps.tolist()), classes) == [True, False, True]


def test_false_closures_by_hand() -> None:
    """A run is one; near p, b, m, near where Labial's lips touch, and in silence there is none."""
    classes = np.full(60, AA)
    classes[10], classes[50:] = M, SIL
    true, heard = np.full(60, 200.0), np.full(60, 200.0)
    true[25] = 70
    heard[[12, 23, 27, 55]] = 10  # within two frames of a reason, or in silence
    assert measures.false_closures(mouth(true.tolist()), mouth(heard.tolist()), classes) == 0
    heard[[13, 30, 31, 32, 40]] = 10
    assert measures.false_closures(mouth(true.tolist()), mouth(heard.tolist()), classes) == 3
    figures = measured([(mouth(true.tolist()), mouth(heard.tolist()), classes)])
    assert figures.false == pytest.approx(3 / (50 / 50)) and figures.closed == 1.0


def test_figures_of_several_clips() -> None:
    """Correlations are means over clips, closures and false ones are counted together, the jerk is that of all."""
    wave = (200 + 80 * np.sin(np.arange(50) / 3)).tolist()
    classes = np.full(50, AA)
    one, other = mouth(wave), mouth(wave[::-1])
    twice = 200 + 2 * (one - 200)
    figures = measured([(one, twice, classes), (one, other, classes)])
    expected = (1 + float(np.corrcoef(wave, wave[::-1])[0, 1])) / 2
    assert figures.opening == pytest.approx(expected) and figures.channels == pytest.approx(expected)
    assert figures.speech == figures.opening
    assert np.isnan(figures.closed) and figures.false == 0
    assert figures.jerk == pytest.approx(np.sqrt((2**2 + 1) / 2), rel=1e-6)
    assert measured([(one, one, classes)]).jerk == pytest.approx(1.0)
    assert all(np.isnan(value) for value in measured([]))


def test_pooled_figures() -> None:
    """Weighed by shares; what is not known does not count."""
    nan = float("nan")
    found = pooled([Figures(0.8, 0.7, nan, 0.2, 1.0), Figures(0.4, 0.5, 0.6, nan, 2.0), Figures(*[nan] * 5)], [3, 1, 9])
    assert found[:5] == pytest.approx((0.7, 0.65, 0.6, 0.2, 1.25))
    assert np.isnan(pooled([Figures(*[nan] * 5)], [1])).all()


def test_the_delay_is_found() -> None:
    """Of both signs; and it is what the evaluation takes out."""
    gaps = np.random.default_rng(0).uniform(0, 300, 80)
    classes = np.full(80, AA)
    for lag in (-2, 0, 3):
        rows = [(mouth(gaps.tolist()), mouth(np.roll(gaps, lag).tolist()), classes)]
        assert delay(rows) == lag
        true, heard, _ = hearing._without(lag, *rows[0])
        assert np.array_equal(true[5:-5], heard[5:-5])


def test_what_is_best_is_chosen() -> None:
    """Edges under which the closures of a made-up network are seen without false ones, whatever the folders' order, and
    an empty folder counts for nothing."""
    model = random_hearing(3)
    random = np.random.default_rng(1)
    lengths = np.array([60, 80])
    prepared = Prepared(random.uniform(5, 20, (280, 24)).astype(np.float16),
                        random.normal(scale=60, size=(140, CHANNELS)).astype(np.int16),
                        random.choice([M, AA, SIL], size=140).astype(np.uint8), lengths, np.array([True, True]))
    empty = prepared.part(False)
    found = measures.choose(model, [empty, prepared], np.array([0.5, 0.5]))
    assert found == measures.choose(model, [prepared], np.array([1.0]))
    assert found.edges[0] < found.edges[1] and f"closes from {found.edges[0]:g}" in str(found)
    better = Figures(0.8, 0.7, 0.9, 0.05, 1.0)
    for worse in (better._replace(opening=0.7), better._replace(closed=0.8), better._replace(false=0.2),
                  better._replace(jerk=1.3)):
        assert measures.worth(worse) < measures.worth(better)
    assert measures.worth(better._replace(false=0.0, jerk=0.5)) == measures.worth(better)


# ---- The evaluation --------------------------------------------------------------------------------------------------


def swelling(seconds: float = 2.0) -> np.ndarray:
    time = np.arange(round(seconds * RATE)) / RATE
    return (0.3 * np.sin(2 * np.pi * 1000 * time) * (1 + np.sin(2 * np.pi * 3 * time))).astype(np.float32)


def test_conditions_are_what_they_are_called() -> None:
    """Peaks, ratios and colours of the noise, and the share that is clipped."""
    sound = swelling()
    found = {name: make(sound, np.random.default_rng(0)).astype(float) for name, make in hearing.CONDITIONS.items()}
    assert set(found) == {"clean", "-40 dBFS", "white noise 20 dB", "pink noise 10 dB", "telephone",
                          "reverberation .25 s", "clipped 5 %"}
    assert all(len(item) == len(sound) for item in found.values())
    for name, item in found.items():
        peak = 20 * np.log10(np.abs(item).max() / 32767)
        assert peak == pytest.approx(-40 if name == "-40 dBFS" else -6, abs=0.1), name
    for name, ratio in (("white noise 20 dB", 20.0), ("pink noise 10 dB", 10.0)):
        item = found[name]
        scale = float(item @ sound) / float(sound @ sound)  # the noise has nothing of the tone
        rest = item - scale * sound
        assert 20 * np.log10(distort.rms(scale * sound) / distort.rms(rest)) == pytest.approx(ratio, abs=0.5)
    clipped = found["clipped 5 %"]
    assert (np.abs(clipped) >= np.abs(clipped).max() - 1).mean() == pytest.approx(0.05, abs=0.01)
    spectrum = np.abs(np.fft.rfft(hearing.pink(1 << 17, np.random.default_rng(0)))) ** 2
    octave = [10 * np.log10(spectrum[a : 2 * a].mean()) for a in (2048, 4096, 8192, 16384)]
    assert np.diff(octave) == pytest.approx([-3.0] * 3, abs=0.4)


@needs_runtime
def test_loudness_opens_the_mouth() -> None:
    """Shut in silence, open where it is loud; with crossings of zero a hiss opens it less, and only that."""
    hum, hiss = swelling(1.0) * 0 + 0.3, np.random.default_rng(0).normal(scale=0.3, size=RATE)
    hum = (hum * np.sin(2 * np.pi * 150 * np.arange(RATE) / RATE)).astype(np.float32)
    sound = distort.as_integers(np.concatenate([np.zeros(RATE), hum, hiss]), -3.0)
    gap, less = (opening(method(sound))
                 for method in (hearing.loudness, hearing.loudness_and_crossings))
    assert len(gap) == len(sound) // FRAME and gap[:45].max() <= 72 < gap[60:].min()
    assert np.allclose(gap[55:95], less[55:95]) and less[110:].max() < 0.6 * gap[110:].min()
    assert hearing.crossings(sound)[60:90].mean() == pytest.approx(300, abs=60)
    assert hearing.loudness(np.zeros(0, np.int16)).shape == (0, CHANNELS)


@needs_runtime
def test_a_perfect_method_is_perfect_and_a_late_one_late() -> None:
    """Would catch rows that are mixed up, and a delay that is not taken out."""
    timings = [("SIL", 200), ("M", 100), ("AA", 300), ("B", 100), ("IY", 300), ("SIL", 200)]
    item = hearing.Sounds("made up", [(swelling(1.2), timings)])
    true = hearing.targets.frames(timings, 60)
    shown = {"right": lambda sound: true, "late": lambda sound: np.concatenate([true[:1].repeat(2, 0), true[:-2]]),
             "wrong": lambda sound: -true}
    rows = {row.method: row for row in hearing.evaluated([item], shown, ["clean"])}
    assert rows["right"].figures[:4] == pytest.approx((1, 1, 1, 0)) and rows["right"].delay == 0
    assert rows["late"].delay == 40 and rows["late"].figures.opening > 0.99
    assert rows["wrong"].figures.opening < 0.7 and rows["right"].tenth == pytest.approx(1.0)
    lines = hearing.table(list(rows.values())).splitlines()
    assert len(lines) == 5 and all(line.count("|") == lines[0].count("|") for line in lines)


@needs_runtime
@pytest.mark.skipif(not ctypes.util.find_library("espeak-ng"), reason="espeak-ng is not installed")
def test_the_command_judges(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """A folder and a voice, in the chosen conditions and by the chosen methods; the library's integers hear what the
    network does; and wrong names are named."""
    folder = tmp_path / "speech"
    folder.mkdir()
    soundfile.write(str(folder / "a.wav"), swelling(), RATE)
    (folder / "a.lab").write_text("0 0.5 SIL\n0.5 0.7 M\n0.7 1.5 AA\n1.5 2 SIL\n")
    save(random_hearing(), tmp_path / "hear.npz")
    given = ["evaluate-hear", str(tmp_path / "hear.npz")]
    chosen = ["--conditions", "clean,telephone", "--methods", "network,integers,loudness"]
    assert main([*given, str(folder), "--voices", "espeak:en-us", *chosen, "-o", str(tmp_path / "table.md")]) == 0
    rows = [re.split(r" *\| *", line)[1:-1] for line in (tmp_path / "table.md").read_text().splitlines()[2:]]
    assert [row[:3] for row in rows[:3]] == [[f"{tmp_path.name}/speech", "clean", name]
                                             for name in ("network", "integers", "loudness")]
    assert len(rows) == 12 and rows[-1][:2] == ["espeak:en-us", "telephone"]
    for network, integers in zip(rows[6::3], rows[7::3]):  # in speech, where the library rests in pauses alone
        assert float(integers[4]) == pytest.approx(float(network[4]), abs=0.06)
    for option, wrong, message in (("--methods", "network,magic", "--methods: 'magic' is not one of network"),
                                   ("--conditions", "dirty", "'dirty' is not one of clean")):
        assert main([*given, str(folder), option, wrong]) == 1 and message in capsys.readouterr().err
    assert main([*given, "--voices"]) == 1 and "nothing to judge by" in capsys.readouterr().err
