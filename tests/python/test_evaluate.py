"""An evaluation from corpus to report: small, whole, and the same bytes for any number of processes; its timelines and
splits, and corpora that are made up by a known law."""

from __future__ import annotations

import csv
from dataclasses import fields, replace
from pathlib import Path
from typing import Callable, List, Sequence

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from labial.__main__ import main
from labial.corpus import Episode, Segment
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.evaluate import methods, protocol
from labial.evaluate.material import Split, Timeline, Utterance, bands, make_splits, timeline, utterance, utterances
from labial.evaluate.methods import METHODS, select
from labial.evaluate.report import Cell, cell
from labial.evaluate.training import Training, choose, validation_error
from labial.reference import published, stream
from labial.reference.tables import FloatTables
from labial.see.motion import Band
from labial.train import train
from labial.train.codebook import lbg
from models import write_episode

QUICK = "mean,steps,blur,regression,hmm_synthesis"


def law(given) -> np.ndarray:
    return gaussian_filter1d(shape_of_phoneme()[given.phoneme_at], 1.5, axis=0, mode="nearest")


@pytest.fixture(scope="module")
def corpus():
    return planted(law, 18, noise=3.0)


@pytest.fixture(scope="module")
def folder(corpus, tmp_path_factory) -> Path:
    where = tmp_path_factory.mktemp("corpus")
    for item in corpus:
        write_episode(where, item)
    return where


@pytest.mark.slow
def test_every_method_end_to_end(corpus) -> None:
    # Catches a method that cannot be fitted, and orders that no honest measure would give.
    outcome, = protocol.evaluate(corpus, protocol.Options(splits=1), progress=False)
    assert list(outcome.measures) == ["human", *(method.name for method in METHODS)]
    diff = {name: values["diff/mean"] for name, values in outcome.measures.items()}
    assert diff["human"] == 0 and max(diff, key=diff.get) == "mean"
    assert diff["blur"] < diff["steps"] and diff["labial"] < diff["steps"]
    assert diff["device"] == pytest.approx(diff["labial"], rel=0.15)
    for values in outcome.measures.values():
        assert all(-1 <= values[f"correlation/{name}"] <= 1 for name in ("open_jaw", "mean"))
    assert set(outcome.example.motion) == {method.name for method in METHODS}
    assert len(outcome.split.training) == 14 and len(outcome.split.test) == 4


@pytest.mark.slow
def test_the_trained_rows_decode_as_they_say(corpus) -> None:
    """The paper's row unit by unit, as it is published; Labial's as the run-time does."""
    material = utterances(corpus, SPEECH, 50)
    training = Training(material[:8], SPEECH, 50, 0)
    given = material[9].timeline
    for name, synthesise in (("paper", published.synthesise), ("labial", stream.synthesise)):
        (method,) = (item for item in METHODS if item.name == name)
        found = method.fit(training)(given)
        np.testing.assert_array_equal(found, synthesise(FloatTables(training.model(name)), given.stream))
    unlike = stream.synthesise(FloatTables(training.model("paper")), given.stream)
    assert np.abs(methods.reference(training.model("paper"))(given) - unlike).max() > 1


@pytest.mark.slow
def test_the_same_bytes_for_any_number_of_jobs(folder, tmp_path, capsys) -> None:
    # Catches results in the order they arrive, seeds of the process, times and paths in the report; and tables that
    # were not made from the splits beside them.
    for name, jobs in (("one", "1"), ("two", "2")):
        arguments = ["evaluate", str(folder), "--splits", "3", "--methods", QUICK, "--jobs", jobs, "--quiet"]
        assert main([*arguments, "-o", str(tmp_path / name)]) == 0
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert {"report.md", "table1.csv", "splits.csv", "trajectories.png", "steps_and_curve.png"} <= set(files)
    for name in files:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name
    assert "processor time per split" in capsys.readouterr().out
    splits, table = (list(csv.DictReader((tmp_path / "one" / name).read_text(encoding="utf-8").splitlines()))
                     for name in ("splits.csv", "table1.csv"))
    values = [float(r["value"]) for r in splits if r["method"] == "mean" and r["measure"] == "diff/openness"]
    assert len(values) == 3 and len(set(values)) == 3
    found = next(r for r in table if r["method"] == "mean" and r["measure"] == "diff/openness")
    assert float(found["mean"]) == pytest.approx(np.mean(values), rel=1e-4)
    assert float(found["deviation"]) == pytest.approx(np.std(values, ddof=1), rel=1e-3)
    assert f"| mean shape | {np.mean(values):.4f} ({np.std(values, ddof=1):.4f}) |" in (
        tmp_path / "one" / "report.md").read_text()


@pytest.mark.slow
def test_held_out_words_from_the_command_line(folder, tmp_path) -> None:
    arguments = ["evaluate", str(folder), "--splits", "1", "--methods", "mean,steps", "--quiet", "--jobs", "1",
                 "--hold-out-words", "beta, gamma", "-o", str(tmp_path)]  # fmt: skip
    assert main(arguments) == 0
    text = (tmp_path / "report.md").read_text()
    assert "judged on the words beta, gamma" in text and "7 episodes trained on, 9 held out" in text


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_failing_split_is_told_and_ends_the_run(corpus, monkeypatch, jobs: int) -> None:
    # Catches a run that waits for ever, or that leaves out what failed.
    with pytest.raises(LabialError, match="omega"):
        protocol.evaluate(corpus, protocol.Options(held_out=("omega",)), jobs=jobs, progress=False)
    broken = protocol.Options(splits=2, kind="speech", methods="mean,nonsense")
    with pytest.raises(LabialError, match="nonsense"):
        protocol.evaluate(corpus, broken, jobs=jobs, progress=False)
    enough = tuple(range(17))
    monkeypatch.setattr(protocol, "make_splits", lambda *_: [Split(0, enough, (17,)), Split(1, enough, ())])
    with pytest.raises(LabialError, match="split 1: no frame to judge"):
        protocol.evaluate(corpus, protocol.Options(methods="mean"), jobs=jobs, progress=False)


def test_selection_of_methods() -> None:
    assert [item.name for item in select(" blur,mean ")] == ["mean", "blur"]
    assert select("all") == list(METHODS)
    for wrong in ("", "blur,nonsense"):
        with pytest.raises(LabialError):
            select(wrong)


def test_a_measure_that_no_split_has_is_a_dash(corpus) -> None:
    outcomes = protocol.evaluate(corpus, protocol.Options(splits=1, methods="mean"), progress=False)
    assert str(cell(outcomes, "mean", "seam/mean")) == "-" and str(Cell(0.1234, 0.001)) == "0.1234 (0.0010)"
    one = cell(outcomes, "mean", "diff/mean")  # a deviation of 0 would say that splits agree
    assert str(one) == f"{one.mean:.4f}"


# ---- Timelines and splits of an evaluation ---------------------------------------------------------------------------


FPS = 50
LABELS = ("P", "AA", "T", "IY", "UW", "S", "K")
WORDS = ("alpha", "beta", "gamma")


def planted(law: Callable[[Timeline], np.ndarray], count: int, noise: float = 0.0, seed: int = 0,
            labels: Sequence[str] = LABELS) -> List[Episode]:
    """Episodes of 20 phonemes between silences whose motion (T, 13) is `law` of the timeline, plus noise, FAP."""
    episodes = []
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        names = ["SIL", *rng.choice(labels, 20), "SIL"]
        milliseconds = [200, *(20 * rng.integers(3, 9, 20)), 200]
        ends = np.cumsum(milliseconds) / 1000.0
        given = timeline([SPEECH.phonemes.index(name) for name in names], milliseconds, FPS)
        motion = law(given) + rng.normal(0, noise, (given.frames, 13)) * (noise > 0)
        times = (np.arange(given.frames) + 0.5) / FPS
        words = [None, *(WORDS[(number + n // 5) % 3] if number % 2 else "delta" for n in range(20)), None]
        segments = tuple(Segment(end - ms / 1000.0, end, name, word=word)
                         for end, ms, name, word in zip(ends, milliseconds, names, words))
        episodes.append(Episode(f"e{number:03}", times, motion, segments))
    return episodes


def training(law: Callable[[Timeline], np.ndarray], count: int = 30, noise: float = 1.0,
             labels: Sequence[str] = LABELS) -> Training:
    return Training(utterances(planted(law, count, noise, labels=labels), SPEECH, FPS), SPEECH, FPS, seed=0)


def unseen(law: Callable[[Timeline], np.ndarray], count: int = 4, labels: Sequence[str] = LABELS) -> List:
    return utterances(planted(law, count, seed=99, labels=labels), SPEECH, FPS)


def shape_of_phoneme() -> np.ndarray:
    """(P, 13) FAP: a shape for every phoneme."""
    return np.random.default_rng(5).normal(0, 150, (len(SPEECH.phonemes), 13))


def ramp(given: Timeline) -> np.ndarray:
    """Channel k rises by k + 1 FAP per frame."""
    return np.arange(given.frames)[:, None] * np.arange(1, 14)[None, :]


def test_the_timeline_is_what_the_library_is_told() -> None:
    # Catches human frames that are judged against a timeline shifted or stretched by rounding.
    motion = np.arange(60.0)[:, None] * np.ones(13)
    segments = (Segment(0.1, 0.1337, "SIL"), Segment(0.1337, 0.1442, "P"), Segment(0.1442, 1.0004, "AA"))
    episode = Episode("odd", 0.1 + (np.arange(60) + 0.5) / 50, motion, segments)
    item = utterance(episode, SPEECH, 50)
    assert item.timeline.milliseconds.tolist() == [34, 10, 856]
    assert item.timeline.length.tolist() == [2, 0, 43] and item.timeline.frames == 45 == len(item.human)
    assert item.timeline.held.tolist() == [0, 2]
    np.testing.assert_allclose(item.human[:, 4], np.arange(45), atol=1e-9)
    with pytest.raises(LabialError, match="odd: labels QQ"):
        utterance(replace(episode, segments=(Segment(0.0, 1.0, "QQ"),)), SPEECH, 50)


def test_human_frames_are_those_of_the_planted_law() -> None:
    # Catches resampling or alignment that is off by half a frame.
    for item in unseen(ramp):
        np.testing.assert_allclose(item.human, ramp(item.timeline), atol=1e-6)


def test_words_select_frames() -> None:
    item = utterances(planted(ramp, 2), SPEECH, FPS)[1]
    expected = np.repeat([word == "beta" for word in item.words], item.timeline.length)
    assert np.array_equal(item.in_words(["beta"]), expected) and expected.any()
    assert not item.in_words(["delta"]).any()


def test_the_longest_word_is_one_run_of_segments() -> None:
    # Catches a word that occurs twice taken for one, and words that are not judged.
    item = utterances(planted(ramp, 2), SPEECH, FPS)[1]
    words = ("a", "a", "b", "a", "a", "a", "c", None, "c", *(None,) * 13)
    marked = Utterance(item.episode, item.timeline, words, item.human)
    assert marked.longest_word(silence=0) == (3, 5)
    assert marked.longest_word(silence=0, words=["c", "b"]) == (2, 2)
    assert marked.longest_word(silence=0, words=["d"]) is None


def test_splits_are_disjoint_and_do_not_depend_on_their_number() -> None:
    # Catches test episodes that are trained on, and a split 0 that changes when more are asked for.
    corpus = utterances(planted(ramp, 21), SPEECH, FPS)
    many = make_splits(corpus, 6, seed=3)
    assert make_splits(corpus, 2, seed=3) == many[:2]
    assert len({split.training for split in many}) == 6
    for split in many:
        assert sorted(split.training + split.test) == list(range(21)) and len(split.training) == 17
    assert make_splits(corpus, 1, seed=4)[0] != many[0]


def test_held_out_words_leave_the_training_part() -> None:
    # Catches a word that is trained on and judged as unseen.
    corpus = utterances(planted(ramp, 20), SPEECH, FPS)
    for split in make_splits(corpus, 3, seed=0, held_out=["beta", "gamma"]):
        assert split.words == ("beta", "gamma") and len(split.training) == 8
        assert not any(set(corpus[i].words) & {"beta", "gamma"} for i in split.training)
        assert all(set(corpus[i].words) & {"beta", "gamma"} for i in split.test)
    with pytest.raises(LabialError, match="omega"):
        make_splits(corpus, 1, 0, ["beta", "omega"])
    with pytest.raises(LabialError, match="nothing is left"):
        make_splits(corpus, 1, 0, ["beta", "delta"])


def test_inner_validation_stays_inside_the_training_part() -> None:
    # Catches settings that are chosen on what the final fit is judged by, or on what the inner fit has seen.
    part = training(ramp, 20)
    fold, = part.folds
    assert len(fold.training.utterances) == 16 and not fold.words
    assert sorted(item.episode.name for item in (*fold.training.utterances, *fold.held_out)) == [
        item.episode.name for item in part.utterances]  # fmt: skip


def test_inner_validation_holds_out_words_where_unseen_words_are_judged() -> None:
    # Catches settings that suit known words alone, error on frames of words that were fitted, silence as a word.
    named = [replace(e, segments=tuple(replace(s, word="<s>" if s.label == "SIL" else f"w{n}" if i < 9 else "common")
                                       for i, s in enumerate(e.segments))) for n, e in enumerate(planted(ramp, 20))]
    part = Training(utterances(named, SPEECH, FPS), SPEECH, FPS, seed=0, unseen_words=True)
    words = [word for fold in part.folds for word in fold.words]
    assert [len(fold.words) for fold in part.folds] == [6, 6, 6] and len(set(words)) == 18
    assert not {"common", "<s>"} & set(words)
    for fold in part.folds:
        assert not any(set(fold.words) & set(item.words) for item in fold.training.utterances)
        assert all(set(fold.words) & set(item.words) for item in fold.held_out) and len(fold.held_out) == 6

    def wrong_in_common(given: Timeline) -> np.ndarray:
        return ramp(given) + 99.0 * (given.segment_at >= 9)[:, None]

    assert validation_error(part.scale, part.folds[0], wrong_in_common) == pytest.approx(0, abs=1e-9)
    assert validation_error(part.scale, part.folds[0], lambda given: ramp(given) + 5.0) > 1e-3


def test_the_setting_of_least_error_over_all_folds_is_chosen() -> None:
    part = training(ramp, 20)
    assert choose(part, [40.0, -3.0, 2.0, 7.0], lambda _: lambda off: lambda given: ramp(given) + off) == 2.0


@pytest.mark.slow
def test_methods_share_the_cells_of_their_codebooks(monkeypatch) -> None:
    # Catches a model that changes because another was trained before it, and cells that are computed twice.
    calls = []
    monkeypatch.setattr("labial.evaluate.training.lbg", lambda points, size: calls.append(size) or lbg(points, size))
    part = training(ramp, 4)
    shared = [part.model(method, normalise=True) for method in ("paper", "labial")]
    assert len(calls) == 13 + 4  # of the solved channels, four are sides of pairs, which labial's method evens
    assert part.model("paper", normalise=True) is shared[0] and part.model("paper") is not shared[0]
    assert len(calls) == 17 + 13  # as they are, features have other cells
    for model in shared:
        alone = train([item.episode for item in part.utterances], kind="speech", method=model.method, jobs=1,
                      progress=False, normalise=True)  # fmt: skip
        for field in fields(model):
            own, other = getattr(model, field.name), getattr(alone, field.name)
            assert np.array_equal(own, other) if isinstance(own, np.ndarray) else own == other, field.name


def test_bands_are_the_phonemes_that_have_frames() -> None:
    """Catches phonemes without frames that are drawn, bands that leave the window, and kinds of other phonemes."""
    given = timeline([0, 2, 1, 0], [100, 1, 59, 100], 50)
    assert given.length.tolist() == [5, 0, 3, 5]
    labels, kinds = ("SIL", "AA", "T"), ("silence", "vowel", "other")
    assert bands(given, labels, kinds, 50) == [
        Band(0.0, 0.1, "SIL", "silence"),
        Band(0.1, 0.16, "AA", "vowel"),
        Band(0.16, 0.26, "SIL", "silence"),
    ]
    assert bands(given, labels, kinds, 50, 5, 9) == [Band(0.1, 0.16, "AA", "vowel"), Band(0.16, 0.18, "SIL", "silence")]
