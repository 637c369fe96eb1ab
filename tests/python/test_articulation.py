"""Articulation: motion in proportion, closures kept, changes without a jolt, on sentences of flite's."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

from labial.reference import published, stream, trajectory
from labial.reference.synthesis import synthesise
from labial.reference.tables import Equation, ExportedTables, FloatTables
from labial.reference.units import frame_counts
from labial.tables.model import load
from labial.tables.phones import read_stream
from labial.tables.quantise import quantise

#: From so many FAP units of opening on lips look parted (docs/experiments.md).
#: Follows from the corners by a table, and so is not in proportion.
FAP_17 = 2

PARTED = 80
Pairs = List[Tuple[int, int]]


@pytest.fixture(scope="module")
def voice() -> ExportedTables:
    return ExportedTables(quantise(load("speech_en"), "x"))


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> List[Pairs]:
    """Phonemes of eight sentences."""
    path = tmp_path_factory.mktemp("said") / "line.flite"
    lines = Path(__file__).with_name("sentences.flite").read_text(encoding="ascii").splitlines()
    found = []
    for line in lines[:8]:
        path.write_text(line + "\n", encoding="ascii")
        found.append(read_stream(str(path), load("speech_en")))
    return found


def opening(motion: np.ndarray) -> np.ndarray:
    """(T,) of the lips, FAP units."""
    return -motion[:, 3] - motion[:, 4]


def closures(tables: ExportedTables, phonemes: Pairs, motion: np.ndarray) -> List[float]:
    """The least opening in each p, b, m and a frame to either side."""
    ends = np.cumsum(frame_counts([length for _, length in phonemes], tables.fps))
    lips = {tables.phonemes.index(label) for label in "PBM"}
    return [opening(motion)[max(begin - 1, 0) : end + 1].min()
            for (phoneme, _), begin, end in zip(phonemes, [0, *ends], ends) if phoneme in lips and end > begin]


def test_gains_by_hand() -> None:
    """Ten percent a frame, from the first one on, in 256ths; a channel's frames have that of its turn."""
    found = stream.gains(np.array([100, 100, 125, 125, 90, 90, 300, 300]), 3)
    reached = [100, 100, 110, 120, 110, 100, 110, 120]
    assert (found[:, 0] * 256).tolist() == [np.floor(2.56 * reached[t] + 0.5) for t in (0, 3, 3, 3, 6, 6, 6, 7)]
    assert (found[:, 2] * 256).tolist() == [np.floor(2.56 * reached[t] + 0.5) for t in (2, 2, 2, 5, 5, 5, 7, 7)]
    assert (found[:, 3] == found[:, 0]).all() and (found[:, 5] == found[:, 2]).all()
    assert (stream.gains(np.array([300, 300, 300]), 3) == 2.0).all()
    assert stream.gains(np.zeros(0), 3).shape == (0, 13)


def test_with_a_lag_rows_are_made_later() -> None:
    """A frame's row is made in the channel's first turn of those that are as many frames later."""
    wanted = np.array([100] * 4 + [110] * 4)
    assert (stream.gains(wanted, 2, 1)[:, 0] > 1.0).tolist() == [False] * 2 + [True] * 6
    assert (stream.gains(wanted, 2, 0)[:, 0] > 1.0).tolist() == [False] * 3 + [True] * 5


@pytest.mark.parametrize("percent", [0, 50, 80, 100])
def test_up_to_100_all_motion_is_in_proportion(voice: ExportedTables, said: List[Pairs], percent: int) -> None:
    gain = np.floor(2.56 * percent + 0.5) / 256.0
    for phonemes in said[:2]:
        whole = stream.synthesise(voice, phonemes)
        apart = np.abs(stream.synthesise(voice, phonemes, articulation=percent) - gain * whole)
        assert np.delete(apart, FAP_17, axis=1).max() < 1e-9


@pytest.mark.parametrize("percent, least, most", [(130, 1.25, 1.4), (200, 1.9, 2.25)])
def test_beyond_100_the_mouth_goes_farther_and_still_closes(
    voice: ExportedTables, said: List[Pairs], percent: int, least: float, most: float
) -> None:
    """What is beside contact is a little farther from it in proportion; what has none is in proportion."""
    plain = [stream.synthesise(voice, phonemes) for phonemes in said]
    wide = [stream.synthesise(voice, phonemes, articulation=percent) for phonemes in said]
    ratio = np.concatenate([opening(one) for one in wide]).std() / np.concatenate([opening(one) for one in plain]).std()
    assert least < ratio < most
    gain = np.floor(2.56 * percent + 0.5) / 256.0
    without = [0, 1, 5, 6, 11, 12]  # channels that make no contact: jaw, lower lip's protrusion, corners
    assert max(np.abs(one - gain * other)[:, without].max() for one, other in zip(wide, plain)) < 1e-9
    found = [value for phonemes, one in zip(said, wide) for value in closures(voice, phonemes, one)]
    assert len(found) > 30 and max(found) <= PARTED
    assert max(value for phonemes, one in zip(said, plain)
               for value in closures(voice, phonemes, gain * one)) > max(found)  # which scaling alone opens farther


@pytest.mark.parametrize("before, after", [(50, 130), (130, 50), (100, 50)])
def test_a_change_is_no_jolt(voice: ExportedTables, said: List[Pairs], before: int, after: int) -> None:
    """The third differences around a change, against the largest ones where the larger articulation holds throughout;
    without a step from frame to frame they are up to three times as large."""
    worst = 0.0
    for phonemes in said[:2]:
        loud = stream.synthesise(voice, phonemes, articulation=max(before, after))
        limit = np.abs(np.diff(loud, 3, axis=0)).max(axis=0)
        for at in range(25, len(loud) - 20, 40):
            told = np.where(np.arange(len(loud)) < at, before, after)
            motion = stream.synthesise(voice, phonemes, articulation=told)
            jolt = np.abs(np.diff(motion, 3, axis=0)).max(axis=0) / limit
            worst = max(worst, np.delete(jolt, FAP_17).max())
    assert worst < 1.5


def test_laughter_is_in_proportion() -> None:
    """It makes contact in ``ne`` and ``nasal`` alone; FAP 17 follows the corners as far as its table goes."""
    tables = FloatTables(load("laughter_synthetic"))
    phonemes = [(tables.phonemes.index(label), 130) for label in ("a", "fricative", "a", "fricative", "cackle", "e")]
    plain, wide = (stream.synthesise(tables, phonemes, articulation=percent) for percent in (100, 200))
    solved = [k for k in range(plain.shape[1]) if k != FAP_17]
    assert np.abs(plain).max() > 100 and np.abs(wide - 2.0 * plain)[:, solved].max() < 1e-9


def test_parts_and_the_published_method_have_it_as_well(said: List[Pairs]) -> None:
    model = load("speech_en")
    tables = FloatTables(model)
    whole = stream.synthesise(tables, said[0], articulation=130)
    assert np.array_equal(np.concatenate(list(stream.in_parts(tables, said[0], 50, 130))), whole)
    assert np.array_equal(synthesise(model, said[0], articulation=130), whole)
    plain = published.synthesise(tables, said[0])
    assert np.allclose(synthesise(replace(model, method="paper"), said[0], articulation=50), 0.5 * plain)


def test_contact_is_articulated_at_most_once() -> None:
    """An equation of two frames by hand: what holds a frame is its gain times as far from FAP 0, in contact no more."""
    rng = np.random.default_rng(3)
    one = np.ones((2, 13))
    terms = Equation(rng.uniform(1, 2, (2, 13, 3)), rng.normal(size=(2, 13, 3)), one, rng.normal(size=(2, 13)))
    contact = np.array([[True] * 13, [False] * 13])
    for gain in (0.5, 1.5):
        found = trajectory.articulated(terms, contact, gain * one)
        assert np.allclose(found.target, terms.target * [[min(gain, 1.0)], [gain]])
        assert np.allclose(found.mean, gain * terms.mean)
        assert found.weight is terms.weight and found.anchor is terms.anchor
