"""Laughter's own measures on hand-made motion; an evaluation of the synthetic corpus, which must say what it is."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import List

import numpy as np
import pytest

from labial.__main__ import main
from labial.corpus.laughter import is_synthetic
from labial.corpus.phonesets import LAUGHTER
from labial.evaluate.material import Utterance, timeline
from labial.evaluate.measures import Judge, judged_frames, measure_scale
from labial.evaluate.pulses import longest_train, rises
from labial.files.faps import FAP_NAMES
from test_evaluate_material import planted

FPS = 50
BOTTOM, CORNER = FAP_NAMES.index("raise_b_midlip_o"), FAP_NAMES.index("stretch_l_cornerlip_o")


def laugh(labels: List[str], frames: List[int], opening: np.ndarray) -> Utterance:
    """A laugh whose lips are `opening` (T,) FAP apart."""
    given = timeline([LAUGHTER.phonemes.index(label) for label in labels], [20 * n for n in frames], FPS)
    motion = np.zeros((given.frames, 13))
    motion[:, BOTTOM] = -opening
    motion[:, CORNER] = np.arange(given.frames)
    return Utterance(planted(lambda t: np.zeros((t.frames, 13)), 1)[0], given, (None,) * len(labels), motion)


def opening_of(item: Utterance) -> np.ndarray:
    return -item.human[:, BOTTOM]


def two_pulses() -> Utterance:
    """Silence 10, "a" 5 that opens to 100, fricative 5 at 30, "e" 5 that opens to 60, silence 10: frames."""
    opening = np.repeat([5.0, 100.0, 30.0, 60.0, 2.0], [10, 5, 5, 5, 10])
    return laugh(["silence", "a", "fricative", "e", "silence"], [10, 5, 5, 5, 10], opening)


def measured(item: Utterance, opening: np.ndarray):
    masks = judged_frames([item], LAUGHTER)
    motion = item.human.copy()
    motion[:, BOTTOM] = -opening
    return Judge([item], masks, measure_scale([item], LAUGHTER, FPS), LAUGHTER, FPS).measure([motion])


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
    opening = np.repeat([0.0, 100.0, 10.0, 20.0, 5.0], [5, 1, 1, 5, 5])
    short = laugh(["silence", "a", "e", "silence"], [5, 2, 5, 5], opening)
    assert rises(short, short.human, np.ones(17, dtype=bool), LAUGHTER, FPS).tolist() == [100.0, 10.0]


def test_a_pulse_is_looked_for_two_frames_around_its_phoneme() -> None:
    item = two_pulses()
    for late, rise in ((26, 45.0), (27, 0.0)):
        opening = np.full(item.timeline.frames, 5.0)
        opening[late] = 50.0
        motion = item.human.copy()
        motion[:, BOTTOM] = -opening
        assert rises(item, motion, opening > 0, LAUGHTER, FPS)[1] == rise


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


def evaluate(corpus: Path, out: Path, jobs: int = 1) -> str:
    arguments = ["evaluate", str(corpus), "--kind", "laughter", "--splits", "2", "--methods", "mean,steps,regression",
                 "--jobs", str(jobs), "--quiet", "-o", str(out)]  # fmt: skip
    assert main(arguments) == 0
    return (out / "report.md").read_text(encoding="utf-8")


def test_every_table_of_the_synthetic_corpus_says_so(corpus, tmp_path, capsys) -> None:
    # Catches tables that could be taken for results on people, or for speech.
    text = evaluate(corpus, tmp_path)
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


@pytest.mark.slow
def test_numbers_of_the_synthetic_corpus_are_those_of_a_laugh(corpus, tmp_path) -> None:
    # Catches pulses that no method could miss or reach, and a regression that learns nothing from phonemes.
    evaluate(corpus, tmp_path, jobs=2)
    rows = [line.split(",") for line in (tmp_path / "table2_synthetic.csv").read_text().splitlines()[1:]]
    value = {(method, measure): float(mean) for method, measure, mean, _ in rows}
    assert 0.6 < value["original", "pulses/seen"] < 1 and value["mean", "pulses/seen"] == 0
    assert 0.5 < value["regression", "pulses/height"] < 1.2
    assert value["regression", "correlation/mean"] > 0.3


def test_a_recorded_corpus_is_not_called_synthetic(corpus, tmp_path) -> None:
    recorded = tmp_path / "recorded"
    shutil.copytree(corpus, recorded)
    assert is_synthetic(recorded)
    (recorded / "README.md").write_text("# Laughter of ours\n")
    assert not is_synthetic(recorded)
    (recorded / "README.md").unlink()
    assert not is_synthetic(recorded)


@pytest.mark.slow
def test_the_report_of_a_recorded_corpus_does_not_say_synthetic(corpus, tmp_path) -> None:
    recorded = tmp_path / "recorded"
    shutil.copytree(corpus, recorded)
    (recorded / "README.md").unlink()
    text = evaluate(recorded, tmp_path / "report")
    assert "synthetic data" not in text and "\n| human |" in text
    assert (tmp_path / "report" / "table1.csv").exists()
