"""Sound and picture apart: known shifts of recorded motion are found, told, and undone by labial record --offset."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import List

import numpy as np
import pytest

from labial.__main__ import main
from labial.capture.sync import SURE, Lag, advice, estimate
from labial.corpus import Episode, read_corpus
from labial.corpus.episode import Segment
from packages import SOURCE
from test_record import seen

ADDRESSES = SOURCE / "export" / "corpora" / "addresses"
#: What docs/record.md promises, seconds.
TOLERANCE = 0.010


def recording(name: str) -> List[Episode]:
    return [episode for episode in read_corpus(ADDRESSES) if f"_{name}_" in episode.name]


@pytest.mark.parametrize("name", ["gulf", "diwali", "weekly", "farewell"])
def test_a_known_shift_of_recorded_motion_is_found(name: str) -> None:
    """Catches a wrong sign or scale, a search that stops short, and closures that are lost among vowels."""
    episodes = recording(name)
    for shift in (-0.4, -0.12, 0.0, 0.08, 0.25):
        lag = estimate([replace(episode, times=episode.times + shift) for episode in episodes])
        assert abs(lag.seconds - shift) < TOLERANCE and lag.confidence >= SURE


def test_phonemes_of_another_sentence_are_not_trusted() -> None:
    """Catches a confidence that is there whatever the motion: each sentence's phonemes with the next one's lips."""
    episodes = recording("weekly")
    strangers = []
    for own, other in zip(episodes, [*episodes[1:], episodes[0]]):
        scale = (own.times[-1] - own.times[0]) / (other.times[-1] - other.times[0])
        strangers.append(replace(own, times=other.times * scale, frames=other.frames))
    assert estimate(strangers).confidence < SURE


def test_few_closures_tell_nothing() -> None:
    episode = recording("gulf")[0]
    vowels = [segment if segment.label not in "PBM" else replace(segment, label="T") for segment in episode.segments]
    lag = estimate([replace(episode, segments=tuple(vowels))])
    assert lag.closures == 0 and lag.confidence == 0.0
    assert advice(lag, 0.0) == ["sound and picture: 0 p, b, m are too few to tell whether they are together"]


def test_a_mouth_that_does_not_move_tells_nothing() -> None:
    """Catches a division by the opening's spread."""
    still = Episode("a", np.arange(100) / 50, np.zeros((100, 13)), tuple(
        Segment(k / 10, (k + 1) / 10, "PA"[k % 2].replace("A", "AA")) for k in range(20)))
    lag = estimate([still])
    assert np.isfinite(lag.seconds) and "not to be relied on" in advice(replace(lag, confidence=0.0), 0.0)[0]


@pytest.mark.parametrize(("lag", "offset", "lines"), [
    (Lag(0.084, 0.99, 40), 0.0, ["the picture is 84 ms late", "--offset 84 brings"]),
    (Lag(-0.05, 0.95, 40), 0.02, ["the picture is 50 ms early", "--offset -30 brings"]),
    (Lag(0.001, 1.0, 40), 0.0, ["together, by 40 p, b, m"]),
    (Lag(0.012, 1.0, 40), 0.0, ["12 ms late"]),
    (Lag(0.2, 0.5, 6), 0.0, ["confidence 50%: not to be relied on"]),
])  # fmt: skip
def test_what_is_said(lag: Lag, offset: float, lines: List[str]) -> None:
    """Catches advice that forgets the offset that was already given, or follows what is not sure."""
    said = advice(lag, offset)
    assert len(said) == len(lines)
    for text, part in zip(said, lines):
        assert part in text


def test_record_tells_the_offset_and_undoes_it(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """The whole way: landmarks that are 84 ms late, what is said of them, and the corpus with what was said."""
    folder = tmp_path / "in"
    for episode in recording("gulf"):
        with zipfile.ZipFile(ADDRESSES / "episodes.zip") as packed:
            packed.extract(f"{episode.name}.lab", folder)
        np.savez(folder / f"{episode.name}.npz", landmarks=seen(episode.frames), times=episode.times + 0.084)
    assert main(["record", str(folder), "-o", str(tmp_path / "late")]) == 0
    said = capsys.readouterr().out.splitlines()[-1]
    assert said.startswith("--offset ")
    offset = float(said.split()[1])
    assert abs(offset - 84) < 1000 * TOLERANCE
    assert main(["record", str(folder), "-o", str(tmp_path / "right"), "--offset", str(offset)]) == 0
    assert "--offset" not in capsys.readouterr().out
    late, right = (read_corpus(tmp_path / name)[0] for name in ("late", "right"))
    assert np.allclose(late.times[-1] - right.times[-1], offset / 1000, atol=0.002) and right.times[0] >= 0
    assert main(["record", str(folder), "-o", str(tmp_path / "far"), "--offset", "9000"]) == 1
    short = folder / "talker_a_gulf_04.npz"
    assert main(["record", str(short), "-o", str(tmp_path / "far"), "--offset", "4999"]) == 1
    error = capsys.readouterr().err
    assert "an offset of 9000 ms is not within -5000 .. 5000" in error and "shorter than the offset" in error
