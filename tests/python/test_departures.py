"""Labial's departures from the published method: each is really taken back, and the last of all leave that method."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from labial.corpus.phonesets import SPEECH
from labial.evaluate import departures
from labial.evaluate.departures import DEPARTURES
from labial.evaluate.material import utterances
from labial.reference import published
from labial.reference.tables import FloatTables
from models import write_episode
from test_choices import corpus, training  # noqa: F401, fixtures


def test_every_departure_changes_something(corpus, training) -> None:  # noqa: F811
    """Would catch a row that measures the model as it is. This corpus has pairs too few to be learnt."""
    timeline = utterances(corpus[11:], SPEECH, 50)[0].timeline
    model = training.model("labial")
    plain = DEPARTURES[0].synthesise(model, timeline)
    same = {item.title for item in DEPARTURES[1:]
            if np.array_equal(item.synthesise(item.back(model), timeline), plain)}
    assert same <= {"pairs"}


def test_units_of_a_published_model_are_the_published_ones(corpus, training) -> None:  # noqa: F811
    """The row of units and joins is the published reference, which test_published.py holds against other programs."""
    timeline = utterances(corpus[11:], SPEECH, 50)[0].timeline
    model = training.model("paper")
    np.testing.assert_array_equal(departures._unit_by_unit(model, timeline),
                                  published.synthesise(FloatTables(model), timeline.stream))


@pytest.mark.slow
def test_the_command_writes_a_table(corpus, tmp_path: Path,  # noqa: F811
                                    capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "corpus").mkdir()
    for item in corpus:
        write_episode(tmp_path / "corpus", item)
    options = ["--splits", "1", "--jobs", "1", "-o", str(tmp_path / "t.md")]
    assert departures.main([str(tmp_path / "corpus"), *options]) == 0
    lines = (tmp_path / "t.md").read_text().splitlines()
    assert lines[0] == "| taken back | diff | correlation | amplitude | closure | jitter | seam |"
    assert len(lines) == 3 + len(DEPARTURES) and all(line.count("|") == 8 for line in lines)
    assert capsys.readouterr().out == "\n".join(lines) + "\n"
    assert departures.main([str(tmp_path / "nothing"), "-o", str(tmp_path / "t.md")]) == 1
    assert "nothing: no such folder" in capsys.readouterr().err
