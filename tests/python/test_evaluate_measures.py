"""Each measure on hand-made motion whose answer is known, laughter's own too; an evaluation of the synthetic corpus,
which must say what it is."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.corpus.laughter import is_synthetic
from labial.corpus.phonesets import LAUGHTER, SPEECH
from labial.evaluate import lipsync
from labial.evaluate.material import Utterance, timeline
from labial.evaluate.measures import (
    Judge,
    amplitude,
    correlation,
    differences,
    joins,
    judged_frames,
    labial_parameters,
    longest_train,
    measure_scale,
    rises,
)
from labial.files.faps import FAP_COLUMNS, FAP_NAMES
from models import write_motion
from test_evaluate import planted

FPS = 50
BOTTOM, CORNER, TOP = (FAP_NAMES.index(name) for name in ("raise_b_midlip_o", "stretch_l_cornerlip_o", "push_t_lip"))


def item(labels: List[str], frames: List[int], human: np.ndarray, phone_set=SPEECH) -> Utterance:
    given = timeline([phone_set.phonemes.index(label) for label in labels], [20 * n for n in frames], FPS)
    episode = planted(lambda t: np.zeros((t.frames, 13)), 1)[0]
    return Utterance(episode, given, ("word",) * len(labels), human)


def wave(frames: int, period: float = 12.0) -> np.ndarray:
    """(T, 13) FAP: every channel a sine of its own phase."""
    return 100 * np.sin(2 * np.pi * np.arange(frames)[:, None] / period + np.arange(13))


def judge_of(*items: Utterance, phone_set=SPEECH) -> Judge:
    return Judge(items, judged_frames(items, phone_set), measure_scale(items, phone_set, FPS), phone_set, FPS)


def vowels() -> Utterance:
    """Four vowels of ten frames between silences of five."""
    return item(["SIL", "AA", "IY", "AA", "UW", "SIL"], [5, 10, 10, 10, 10, 5], wave(50))


def test_labial_parameters_are_those_of_the_paper() -> None:
    # Catches a wrong channel or sign: openness grows when the top lip rises (fap51 < 0) and the bottom lip sinks.
    frames = np.arange(13.0)[None, :] + 1
    fap = dict(zip(("3", "16", "17", "51", "52", "53", "54"), frames[0]))
    expected = [-(fap["51"] + fap["52"]), fap["53"] + fap["54"], fap["17"], fap["16"]]
    assert labial_parameters(frames)[0].tolist() == expected


def test_diff_is_the_mean_absolute_error_over_the_training_maximum() -> None:
    # Catches a maximum that is taken over silence, or over the test part.
    human = np.zeros((20, 13))
    human[:5, TOP] = 500.0  # silence
    human[5:, TOP] = -200.0
    test = item(["SIL", "AA"], [5, 15], human)
    off = human.copy()
    off[:5] += 999.0  # silence is not judged
    off[5:10, TOP] += 30.0
    off[10:, TOP] -= 60.0
    measured = judge_of(test).measure([off])
    assert measured["diff/top"] == pytest.approx((5 * 30 + 10 * 60) / 15 / 200)
    assert measured["diff/mean"] == pytest.approx(measured["diff/top"] / 4)
    assert measured["class/open"] == pytest.approx(measured["diff/mean"])
    assert "class/silence" not in measured and "class/bilabial" not in measured


def test_correlation_and_amplitude() -> None:
    measured = judge_of(vowels()).measure([vowels().human])  # the human is perfect
    assert measured["diff/mean"] == 0 and measured["correlation/mean"] == pytest.approx(1)
    assert measured["amplitude/mean"] == pytest.approx(1) and measured["jitter"] == pytest.approx(1)
    human = np.array([[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [2.0, 0.0, 1.0]])
    motion = np.array([[0.0, 1.0, 0.0], [3.0, 0.0, 1.0], [6.0, 1.0, 0.0]])
    np.testing.assert_allclose(correlation(human, motion), [1, -1, 0])
    np.testing.assert_allclose(amplitude(human, motion), [3, 1, np.nan])
    # Catches a channel that was not measured, whose mean is not quite its only value, and which then has an amplitude.
    assert np.isnan(amplitude(np.full((7, 1), 0.1) + np.spacing(0.1) * np.arange(7)[:, None], motion[:7, :1])).all()
    # And a mean of correlations per utterance, which hides that levels are wrong.
    low, high = vowels(), replace(vowels(), human=vowels().human + 300)
    assert judge_of(low, high).measure([high.human, low.human])["correlation/open_jaw"] < -0.5


def test_jitter_of_noise_and_of_smooth_motion() -> None:
    # Third difference of white noise has 20 times its variance; of a sine, (2 sin(w / 2))^3 its amplitude.
    test = item(["AA"], [2000], wave(2000))
    rng = np.random.default_rng(0)
    expected = np.sqrt(20.0) * 10 / ((2 * np.sin(np.pi / 12)) ** 3 * 100 / np.sqrt(2))
    found = judge_of(test).measure([rng.normal(0, 10, (2000, 13))])["jitter"]
    assert found == pytest.approx(expected, rel=0.05)
    assert judge_of(test).measure([test.human / 2])["jitter"] == pytest.approx(0.5)


def test_differences_never_reach_over_what_is_not_judged() -> None:
    frames = np.array([0.0, 0, 0, 0, 100, 0, 0, 0, 0])[:, None]
    mask = np.array([1, 1, 1, 1, 0, 1, 1, 1, 1], dtype=bool)
    assert differences(frames, mask, 2).shape == (4, 1) and not differences(frames, mask, 2).any()
    assert len(differences(frames, mask, 4)) == 0 and len(differences(frames[:2], mask[:2], 3)) == 0


def kinked(at: Tuple[int, ...]) -> np.ndarray:
    """(50, 13): a slope that changes by 1 at the given frames, and a faint bend everywhere."""
    slope = 0.01 * np.arange(50) + sum(1.0 * (np.arange(50) >= t) for t in at)
    return np.cumsum(slope)[:, None] * np.ones(13)


def test_seams_are_seen_where_units_join_and_only_there() -> None:
    assert np.flatnonzero(joins([10], [5], 30)).tolist() == [8, 9, 13, 14]  # the edges of cross-fades
    assert np.flatnonzero(joins([0, 29], [0, 1], 30)).tolist() == [27]
    # Units AA IY AA UW: the cross-fades are over IY (frames 15 to 24) and over the second AA (25 to 34).
    judge = judge_of(vowels())
    at_join, elsewhere = judge.measure([kinked((25,))]), judge.measure([kinked((20, 30))])
    assert at_join["seam/largest"] == pytest.approx(1.01 / 0.01, rel=1e-6)
    assert at_join["seam/mean"] > 5 and elsewhere["seam/mean"] < 0.5
    assert elsewhere["seam/largest"] == pytest.approx(0.01 / 1.01, rel=1e-6)
    assert np.isnan(judge.measure([np.ones((50, 13))])["seam/mean"])


def lips(opening: List[float]) -> np.ndarray:
    """(T, 13) with the given openness."""
    frames = np.zeros((len(opening), 13))
    frames[:, BOTTOM] = -np.array(opening)
    frames[:, CORNER] = 1.0
    return frames


def test_closure_rate() -> None:
    # Catches a reach that is too narrow (the second P closes 40 ms late) or too wide, and thresholds of the test part.
    labels, frames = ["AA", "P", "AA", "P", "AA"], [20, 4, 20, 4, 20]
    human = [100.0] * 68
    human[20:24] = human[44:48] = [0.0] * 4
    human[0:8] = [50.0] * 8
    judge = judge_of(item(labels, frames, lips(human)))
    full = judge.measure([lips(human)])
    assert full["closure/rate"] == 1 and full["closure/of human"] == 1
    late = [100.0] * 68
    late[20], late[49] = 20.0, -5.0  # closed within P but not firmly; firmly two frames after it
    measured = judge.measure([lips(late)])
    assert measured["closure/rate"] == 1 and measured["firm closure/rate"] == 0.5
    late[49], late[50] = 100.0, -5.0  # three frames after is too late
    assert judge.measure([lips(late)])["closure/rate"] == 0.5
    none = item(["a", "fricative", "e"], [20, 20, 20], wave(60), LAUGHTER)
    assert np.isnan(judge_of(none, phone_set=LAUGHTER).measure([none.human])["closure/rate"])


def test_only_the_judged_words_count() -> None:
    test = vowels()
    marked = Utterance(test.episode, test.timeline, (None, "a", "b", "a", "b", None), test.human)
    mask = judged_frames([marked], SPEECH, ["b"])[0]
    assert np.flatnonzero(mask).tolist() == [*range(15, 25), *range(35, 45)]


# ---- Laughter


def laugh(labels: List[str], frames: List[int], opening: np.ndarray) -> Utterance:
    """A laugh whose lips are `opening` (T,) FAP apart."""
    motion = lips(opening)
    motion[:, CORNER] = np.arange(len(motion))
    return item(labels, frames, motion, LAUGHTER)


def opening_of(item: Utterance) -> np.ndarray:
    return -item.human[:, BOTTOM]


def two_pulses() -> Utterance:
    """Silence 10, "a" 5 that opens to 100, fricative 5 at 30, "e" 5 that opens to 60, silence 10: frames."""
    opening = np.repeat([5.0, 100.0, 30.0, 60.0, 2.0], [10, 5, 5, 5, 10])
    return laugh(["silence", "a", "fricative", "e", "silence"], [10, 5, 5, 5, 10], opening)


def measured(item: Utterance, opening: np.ndarray):
    motion = item.human.copy()
    motion[:, BOTTOM] = -opening
    return judge_of(item, phone_set=LAUGHTER).measure([motion])


def test_a_pulse_rises_over_what_lies_between_it_and_the_one_before() -> None:
    # Catches a rise over the whole laugh's least, over what follows the peak, and a peak of the vowel before.
    item = two_pulses()
    everything = np.ones(item.timeline.frames, dtype=bool)
    assert rises(item, item.human, everything, LAUGHTER, FPS).tolist() == [95.0, 30.0]
    only_e = np.arange(item.timeline.frames) >= 20
    assert rises(item, item.human, only_e, LAUGHTER, FPS).tolist() == [30.0]
    falling = item.human.copy()
    falling[:, BOTTOM] = np.arange(item.timeline.frames)  # closes all the time
    assert rises(item, falling, everything, LAUGHTER, FPS).tolist() == [0.0, 0.0]
    for late, rise in ((26, 45.0), (27, 0.0)):  # it is looked for two frames around its phoneme
        beside = item.human.copy()
        beside[:, BOTTOM] = np.where(np.arange(len(beside)) == late, -50.0, -5.0)
        assert rises(item, beside, everything, LAUGHTER, FPS)[1] == rise
    opening = np.repeat([0.0, 100.0, 10.0, 20.0, 5.0], [5, 1, 1, 5, 5])
    short = laugh(["silence", "a", "e", "silence"], [5, 2, 5, 5], opening)
    assert rises(short, short.human, np.ones(17, dtype=bool), LAUGHTER, FPS).tolist() == [100.0, 10.0]


def test_pulses_seen_and_their_height() -> None:
    item = two_pulses()
    own = measured(item, opening_of(item))
    assert own["pulses/of human"] == pytest.approx(1) and own["pulses/height"] == pytest.approx(1)
    assert own["pulses/seen"] == 0.5  # of two, one lies above their 20th percentile
    half = measured(item, 0.4 * opening_of(item))
    assert half["pulses/seen"] == 0 and half["pulses/height"] == pytest.approx(0.4)
    assert measured(item, np.full(item.timeline.frames, 40.0))["pulses/height"] == 0


def test_lips_rest_on_each_other_in_sounds_of_the_nose_and_speech_measures_are_left_out() -> None:
    labels, frames = ["a", "ne", "a", "nasal", "a"], [20, 5, 20, 5, 20]
    opening = np.full(70, 100.0)
    opening[20:25] = opening[45:50] = 0.0
    opening[:6] = 50.0
    item = laugh(labels, frames, opening)
    assert measured(item, opening)["closure/rate"] == 1
    open_nasal = opening.copy()
    open_nasal[45:50] = 90.0
    found = measured(item, open_nasal)
    assert found["closure/rate"] == 0.5 and found["closure/of human"] == 0.5
    assert not any(name.startswith(("firm closure", "class/")) for name in found)
    assert {name for name in found if name.startswith("phoneme/")} == {"phoneme/a", "phoneme/ne", "phoneme/nasal"}
    assert found["phoneme/nasal"] > 0 and found["phoneme/ne"] == 0


def test_the_longest_train_has_the_phonemes_beside_it() -> None:
    # Catches trains that go on over a pause, and phonemes that are no pulses counted as such.
    labels = ["a", "silence", "ne", "a", "fricative", "e", "silence", "e", "silence", "o", "click"]
    frames = [5, 30, 10, 5, 5, 5, 5, 5, 30, 5, 5]
    assert longest_train(laugh(labels, frames, np.zeros(sum(frames))), LAUGHTER) == (2, 8)
    assert longest_train(laugh(["o", "a"], [5, 5], np.zeros(10)), LAUGHTER) == (0, 1)
    assert longest_train(laugh(["silence", "ne"], [5, 5], np.zeros(10)), LAUGHTER) is None


@pytest.fixture(scope="module")
def corpus(tmp_path_factory) -> Path:
    where = tmp_path_factory.mktemp("laughter") / "corpus"
    assert main(["laughter-corpus", str(where), "--episodes", "16", "--seed", "3"]) == 0
    return where


@pytest.mark.slow
def test_every_table_of_the_synthetic_corpus_says_so(corpus, tmp_path, capsys) -> None:
    # Catches tables that could be taken for results on people, or for speech; pulses that no method could miss or
    # reach, and a regression that learns nothing from phonemes.
    assert main(["evaluate", str(corpus), "--kind", "laughter", "--splits", "2", "--methods", "mean,steps,regression",
                 "--jobs", "2", "--quiet", "-o", str(tmp_path)]) == 0
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    headings = [line for line in text.splitlines() if line.startswith("#")]
    assert len(headings) == 5 and all("synthetic data" in line for line in headings)
    assert "Nobody laughed" in text and "\n| synthetic original |" in text
    assert "| human |" not in text and "p, b, m" not in text and "firm" not in text
    assert "Table 1, synthetic data" in capsys.readouterr().out
    columns = text[text.index("## Table 4"):].splitlines()[2].strip("| ").split(" | ")
    found = set(columns) - {"method"}  # few episodes have every grade of every vowel
    assert set(LAUGHTER.phonemes[1:12]) < found < set(LAUGHTER.phonemes) and "a_loud" in found and "a_soft" in found
    tables = sorted(path.name for path in tmp_path.glob("*.csv"))
    assert len(tables) == 5 and all(name.endswith("_synthetic.csv") for name in tables)
    assert not any("human" in path.read_text() for path in tmp_path.glob("*.csv"))
    assert (tmp_path / "error_per_phoneme.png").stat().st_size > 0
    rows = [line.split(",") for line in (tmp_path / "table2_synthetic.csv").read_text().splitlines()[1:]]
    value = {(method, measure): float(mean) for method, measure, mean, _ in rows}
    assert 0.6 < value["original", "pulses/seen"] < 1 and value["mean", "pulses/seen"] == 0
    assert 0.5 < value["regression", "pulses/height"] < 1.2 and value["regression", "correlation/mean"] > 0.3


def test_a_recorded_corpus_is_not_called_synthetic(corpus, tmp_path) -> None:
    recorded = tmp_path / "recorded"
    shutil.copytree(corpus, recorded)
    assert is_synthetic(recorded)
    (recorded / "README.md").write_text("# Laughter of ours\n")
    assert not is_synthetic(recorded)
    (recorded / "README.md").unlink()
    assert not is_synthetic(recorded)


# ---- The figures of lip-sync on a head of one shape


#: Opening in 20 frames, mm: at rest, a vowel, a closure, at rest.
MEANT = np.array([0, 0, 0, 0, 0, 4, 8, 10, 8, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], dtype=float)


def weights(path: Path, times: np.ndarray, values: Dict[str, np.ndarray]) -> None:
    """Lines as `labial synth --to arkit` writes them."""
    path.write_text("".join(json.dumps({"frame": k, "time": float(time), "arkit":
                                        {name: float(column[k]) for name, column in values.items()}}) + "\n"
                            for k, time in enumerate(times)))  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A head whose lower lip falls by 20 mm at weight 1, of viseme_aa too, and an utterance with three lip-syncs."""
    points = {"nose": (0, 20.48, 0), "corner_left": (25.6, 0, 0), "corner_right": (-25.6, 0, 0),
              "inner_upper": (0, 0, 0), "inner_lower": (0, 0, 0)}
    rows = [["shape", *(f"{name}_{axis}" for name in points for axis in "xyz")],
            ["neutral", *(str(value) for point in points.values() for value in point)]]
    rows += [[name, *("0" for _ in range(13)), "-20", "0"] for name in ("jawOpen", "viseme_aa")]
    (tmp_path / "head.csv").write_text("\n".join(",".join(row) for row in rows) + "\n")
    out = tmp_path / "folder"
    out.mkdir()
    (out / "a.lab").write_text("0 0.1 sil\n0.1 0.2 AA\n0.2 0.3 B\n0.3 0.4 sil\n")
    times, faps = np.arange(20) / 50, np.zeros((20, 13))
    faps[:, FAP_COLUMNS.index("fap52")] = -MEANT / 0.02  # a unit is 20.48 / 1024 mm
    write_motion(out / "a.csv", times, faps)
    weights(out / "a.right.jsonl", times, {"jawOpen": MEANT / 20, "tongueOut": MEANT})
    weights(out / "a.still.jsonl", times[:2] * 30, {"aa": np.full(2, 0.5)})
    weights(out / "a.late.jsonl", times + 0.04, {"jawOpen": MEANT / 20})
    return out


def run(folder: Path, capsys: pytest.CaptureFixture[str]) -> List[str]:
    """What is printed, by lines."""
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 0
    return capsys.readouterr().out.splitlines()


def test_figures_worked_out_by_hand(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What follows the FAPs, what is half open all the time, and what comes two frames late. The 95th percentile of 20
    values lies .05 of the way from the second largest, 8, to the largest, 10."""
    lines = run(folder, capsys)
    third = np.sqrt(np.mean(np.diff(MEANT, 3) ** 2)) * 125
    assert lines[0].startswith("1 utterances, 0 s, 1 p, b, m; the FAPs mean an opening of 8.1 mm")
    assert lines[0].endswith(f"a jerk of {third:.0f} m/s\u00b3")
    table = {cells[1]: cells[2:] for cells in ([cell.strip() for cell in line.split("|")] for line in lines[4:])}
    assert table["right"] == ["8.1 (1.00)", "0.00", "1.00", "0.0", "0.0", f"{third:.0f}", "1.00", ""]
    assert table["still"] == ["10.0 (1.23)", f"{np.sqrt(np.mean((10 - MEANT) ** 2)):.2f}", "0.00", "10.0", "10.0", "0",
                              "nan", ""]
    late = np.concatenate([[0, 0], MEANT[:-2]])
    assert table["late"] == ["8.1 (1.00)", f"{np.sqrt(np.mean((late - MEANT) ** 2)):.2f}", "1.00", "0.0", "0.0",
                             f"{third:.0f}", f"{np.corrcoef(late, MEANT)[0, 1]:.2f}", ""]


@pytest.mark.parametrize(("name", "text", "message"), [
    ("a.new.jsonl", '{"time": 0, "arkit": {"beak": 1}}\n', "a.new.jsonl:1: none of these weights"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": 1}}\n{"time": 0, "arkit": {"jawOpen": 1}}\n', ":2: expected"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": "x"}}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": NaN}}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", '{"time": 0}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", "[]\n", "a.new.jsonl:1: expected"),
    ("a.new.jsonl", "\n", "a.new.jsonl: no frames"),
    ("a.lab", "0 0.4 AA\n", "no p, b or m"),
])
def test_errors(folder: Path, capsys: pytest.CaptureFixture[str], name: str, text: str, message: str) -> None:
    """One line, and status 1."""
    (folder / name).write_text(text)
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 1
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1


def test_lip_syncs_have_every_utterance(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Otherwise they would be judged on different sentences."""
    for suffix in ("lab", "csv", "right.jsonl"):
        (folder / f"b.{suffix}").write_bytes((folder / f"a.{suffix}").read_bytes())
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 1
    assert "no b.late.jsonl with the weights of late" in capsys.readouterr().err
