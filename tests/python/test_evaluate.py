"""An evaluation from corpus to report: small, whole, and the same bytes for any number of processes."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from labial.__main__ import main
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.evaluate import protocol
from labial.evaluate.baselines import trained
from labial.evaluate.material import utterances
from labial.evaluate.methods import METHODS, select
from labial.evaluate.report import Cell, cell
from labial.evaluate.splits import Split
from labial.evaluate.training import Training
from labial.reference import published, stream
from labial.reference.tables import FloatTables
from models import write_episode
from test_evaluate_material import planted, shape_of_phoneme

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


def test_the_trained_rows_decode_as_they_say(corpus) -> None:
    """The paper's row unit by unit, as it is published; Labial's as the run-time does."""
    material = utterances(corpus, SPEECH, 50)
    training = Training(material[:8], SPEECH, 50, 0)
    given = material[9].timeline
    for fit, name, synthesise in ((trained.fit_paper, "paper", published.synthesise),
                                  (trained.fit_labial, "labial", stream.synthesise)):
        found = fit(training).predict(given)
        np.testing.assert_array_equal(found, synthesise(FloatTables(training.model(name)), given.stream))
    unlike = stream.synthesise(FloatTables(training.model("paper")), given.stream)
    assert np.abs(trained.fit_paper(training).predict(given) - unlike).max() > 1


@pytest.mark.slow
def test_the_same_bytes_for_any_number_of_jobs(folder, tmp_path, capsys) -> None:
    # Catches results in the order they arrive, seeds of the process, times and paths in the report.
    for name, jobs in (("one", "1"), ("two", "2")):
        arguments = ["evaluate", str(folder), "--splits", "3", "--methods", QUICK, "--jobs", jobs, "--quiet"]
        assert main([*arguments, "-o", str(tmp_path / name)]) == 0
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert {"report.md", "table1.csv", "splits.csv", "trajectories.png", "steps_and_curve.png"} <= set(files)
    for name in files:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name
    assert "processor time per split" in capsys.readouterr().out


def test_held_out_words_from_the_command_line(folder, tmp_path) -> None:
    arguments = ["evaluate", str(folder), "--splits", "1", "--methods", "mean,steps", "--quiet", "--jobs", "1",
                 "--hold-out-words", "beta, gamma", "-o", str(tmp_path)]  # fmt: skip
    assert main(arguments) == 0
    text = (tmp_path / "report.md").read_text()
    assert "judged on the words beta, gamma" in text and "7 episodes trained on, 9 held out" in text


@pytest.mark.slow
def test_tables_hold_the_mean_and_deviation_of_the_splits(folder, tmp_path) -> None:
    # Catches tables that were not made from the splits beside them.
    arguments = ["evaluate", str(folder), "--splits", "3", "--methods", "mean", "--quiet", "--jobs", "1"]
    assert main([*arguments, "-o", str(tmp_path)]) == 0
    rows = list(csv.DictReader(open(tmp_path / "splits.csv", encoding="utf-8")))
    values = [float(r["value"]) for r in rows if r["method"] == "mean" and r["measure"] == "diff/openness"]
    assert len(values) == 3 and len(set(values)) == 3
    found = next(r for r in csv.DictReader(open(tmp_path / "table1.csv", encoding="utf-8"))
                 if r["measure"] == "diff/openness")
    assert float(found["mean"]) == pytest.approx(np.mean(values), rel=1e-4)
    assert float(found["deviation"]) == pytest.approx(np.std(values, ddof=1), rel=1e-3)
    assert f"| mean shape | {np.mean(values):.4f} ({np.std(values, ddof=1):.4f}) |" in (
        tmp_path / "report.md").read_text()


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
