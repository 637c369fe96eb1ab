"""The figures that hearing is judged by, against cases worked by hand; what they are measured on; the command."""

from __future__ import annotations

import ctypes.util
import re
from pathlib import Path
from typing import List

import numpy as np
import pytest

pytest.importorskip("soxr")

from labial.__main__ import main  # noqa: E402
from labial.evaluate import hearing  # noqa: E402
from labial.files.faps import CHANNELS, FAP_NUMBERS  # noqa: E402
from labial.files.frames import opening  # noqa: E402
from labial.hearing import distort, measures  # noqa: E402
from labial.hearing.features import FRAME, RATE  # noqa: E402
from labial.hearing.measures import Figures, delay, measured, pooled  # noqa: E402
from labial.hearing.model import CLASSES, save  # noqa: E402
from labial.hearing.prepared import Prepared  # noqa: E402
from models import random_hearing  # noqa: E402
from packages import needs_runtime  # noqa: E402

SIL, M, AA = (CLASSES.index(name) for name in ("SIL", "M", "AA"))


def mouth(gaps: List[float]) -> np.ndarray:
    """(T, 13) frames in which the lips are so far apart; the jaw and all others stay."""
    frames = np.zeros((len(gaps), CHANNELS))
    frames[:, FAP_NUMBERS.index(51)] = -0.25 * np.array(gaps)
    frames[:, FAP_NUMBERS.index(52)] = -0.75 * np.array(gaps)
    return frames


def test_the_correlation_is_pearsons() -> None:
    random = np.random.default_rng(0)
    one, other = random.normal(size=(2, 50, 3))
    found = measures.correlation(one, other)
    assert found == pytest.approx([np.corrcoef(a, b)[0, 1] for a, b in zip(one.T, other.T)])
    assert np.isnan(measures.correlation(one, np.ones((50, 3)))).all()


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


# ---- The evaluation


def tone(seconds: float = 2.0) -> np.ndarray:
    time = np.arange(round(seconds * RATE)) / RATE
    return (0.3 * np.sin(2 * np.pi * 1000 * time) * (1 + np.sin(2 * np.pi * 3 * time))).astype(np.float32)


def test_conditions_are_what_they_are_called() -> None:
    """Peaks, ratios and colours of the noise, and the share that is clipped."""
    sound = tone()
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
    hum, hiss = tone(1.0) * 0 + 0.3, np.random.default_rng(0).normal(scale=0.3, size=RATE)
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
    item = hearing.Sounds("made up", [(tone(1.2), timings)])
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
    soundfile = pytest.importorskip("soundfile")
    folder = tmp_path / "speech"
    folder.mkdir()
    soundfile.write(str(folder / "a.wav"), tone(), RATE)
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
