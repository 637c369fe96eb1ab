"""The published method with its open choices made otherwise: each is really made, and undone again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from labial.corpus.phonesets import PHONE_SETS, SPEECH
from labial.evaluate import choices
from labial.evaluate.baselines import trained
from labial.evaluate.choices import CHOICES, Choice
from labial.evaluate.material import utterances
from labial.evaluate.training import Training
from labial.reference import published
from labial.reference.published import Piece, join
from labial.reference.tables import FloatTables
from labial.train import codebook, pipeline, shapes
from models import write_episode
from test_evaluate import law, planted


@pytest.fixture(scope="module")
def corpus():
    return planted(law, 14, noise=3.0)


@pytest.fixture(scope="module")
def training(corpus) -> Training:
    return Training(utterances(corpus[:11], SPEECH, 50), SPEECH, 50, 0)


def test_the_first_row_is_the_published_method(corpus, training) -> None:
    """The same frames as the row `paper` of an evaluation."""
    given = [item.timeline for item in utterances(corpus[11:], SPEECH, 50)]
    motion = choices._motion(CHOICES["speech"][0], training, given)
    for frames, item in zip(motion, given):
        np.testing.assert_array_equal(frames, trained.fit_paper(training).predict(item))


def test_every_choice_changes_something_and_leaves_nothing_behind(corpus, training) -> None:
    """Would catch a choice that is not made, and one that is still made in the next row."""
    given = [utterances(corpus[11:], SPEECH, 50)[0].timeline]
    kept = [codebook.VARIANCE_FLOOR, codebook.transitions, shapes.SAMPLES_PER_COMPONENT, shapes.REGULARISATION,
            published.join, published.OVERLAP, published.PIECE_MAX, pipeline.PHONE_SETS]
    plain = choices._motion(Choice(""), training, given)[0]
    same = []
    for choice in CHOICES["speech"][1:]:
        if np.array_equal(choices._motion(choice, training, given)[0], plain):
            same.append(choice.title)
    # This corpus's apexes are the middles, and it has no unit of more than 40 frames.
    assert set(same) <= {"a phoneme's middle, not the apex of its sound", "units of any length, not cut at 40 frames",
                         "cross-fade of 20 frames at most, not 8"}
    assert [codebook.VARIANCE_FLOOR, codebook.transitions, shapes.SAMPLES_PER_COMPONENT, shapes.REGULARISATION,
            published.join, published.OVERLAP, published.PIECE_MAX, pipeline.PHONE_SETS] == kept
    np.testing.assert_array_equal(choices._motion(Choice(""), training, given)[0], plain)


def test_full_covariances_without_covariances_are_the_diagonal_ones(training) -> None:
    """Equation 3 with the matrix written out, against the solver of the published reference."""
    model = training.model("paper")
    path = np.random.default_rng(1).integers(0, model.log_initial.shape[1], (30, 13))
    inverse = np.zeros((*model.state_precision.shape[:2], 3, 3))
    inverse[..., np.arange(3), np.arange(3)] = model.state_precision
    terms = FloatTables(model).equation(path, np.zeros((30, 13)))
    np.testing.assert_allclose(choices._solve_full(model, inverse, path), published.solve(terms), atol=1e-6)


def test_a_cut_lies_in_the_middle_of_what_two_pieces_share() -> None:
    pieces = [Piece(0, 10, 0, 4), Piece(6, 15, 4, 0)]
    motion = [np.full((10, 13), 1.0), np.full((9, 13), 2.0)]
    assert choices._cut_in_the_middle(pieces, motion)[:, 0].tolist() == [1.0] * 8 + [2.0] * 7
    assert 1.0 < join(pieces, motion)[7, 0] < 2.0


def test_laughs_have_their_boundaries_changed() -> None:
    """The phone set of the training alone: what is judged stays as it was."""
    by_title = {choice.title: choice for choice in CHOICES["laughter"]}
    every = by_title["every phoneme ends a unit"].replaced[pipeline, "PHONE_SETS"]["laughter"]
    silence = by_title["silence alone ends a unit"].replaced[pipeline, "PHONE_SETS"]["laughter"]
    assert all(every.boundary) and sum(silence.boundary) == 1 and silence.boundary[0]
    assert 1 < sum(PHONE_SETS["laughter"].boundary) < len(PHONE_SETS["laughter"].boundary)


@pytest.mark.slow
def test_the_command_writes_a_table(corpus, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "corpus").mkdir()
    for item in corpus:
        write_episode(tmp_path / "corpus", item)
    assert choices.main([str(tmp_path / "corpus"), "--splits", "1", "--jobs", "1", "-o", str(tmp_path / "t.md")]) == 0
    lines = (tmp_path / "t.md").read_text().splitlines()
    assert lines[0] == "| choice | diff | correlation | amplitude | closure | jitter | seam |"
    assert len(lines) == 2 + len(CHOICES["speech"]) and all(line.count("|") == 8 for line in lines)
    assert capsys.readouterr().out == "\n".join(lines) + "\n"
    assert choices.main([str(tmp_path / "nothing"), "-o", str(tmp_path / "t.md")]) == 1
    assert "nothing: no such folder" in capsys.readouterr().err
