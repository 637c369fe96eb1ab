"""Each measure on hand-made motion whose answer is known."""

from __future__ import annotations

from typing import List, Tuple

import numpy as np
import pytest

from labial.corpus.phonesets import LAUGHTER, SPEECH
from labial.evaluate.material import Utterance, timeline
from labial.evaluate.measures import Judge, judged_frames, measure_scale
from labial.evaluate.trajectories import amplitude, correlation, differences, joins, labial_parameters
from labial.files.faps import FAP_NAMES
from test_evaluate_material import planted

FPS = 50
BOTTOM, CORNER, TOP = (FAP_NAMES.index(name) for name in ("raise_b_midlip_o", "stretch_l_cornerlip_o", "push_t_lip"))


def item(labels: List[str], frames: List[int], human: np.ndarray, phone_set=SPEECH) -> Utterance:
    given = timeline([phone_set.phonemes.index(label) for label in labels], [20 * n for n in frames], FPS)
    episode = planted(lambda t: np.zeros((t.frames, 13)), 1)[0]
    return Utterance(episode, given, ("word",) * len(labels), human)


def wave(frames: int, period: float = 12.0) -> np.ndarray:
    """(T, 13) FAP: every channel a sine of its own phase."""
    return 100 * np.sin(2 * np.pi * np.arange(frames)[:, None] / period + np.arange(13))


def judge_of(*items: Utterance) -> Judge:
    return Judge(items, judged_frames(items, SPEECH), measure_scale(items, SPEECH, FPS), SPEECH, FPS)


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


def test_the_human_is_perfect() -> None:
    measured = judge_of(vowels()).measure([vowels().human])
    assert measured["diff/mean"] == 0 and measured["correlation/mean"] == pytest.approx(1)
    assert measured["amplitude/mean"] == pytest.approx(1) and measured["jitter"] == pytest.approx(1)


def test_correlation_and_amplitude() -> None:
    human = np.array([[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [2.0, 0.0, 1.0]])
    motion = np.array([[0.0, 1.0, 0.0], [3.0, 0.0, 1.0], [6.0, 1.0, 0.0]])
    np.testing.assert_allclose(correlation(human, motion), [1, -1, 0])
    np.testing.assert_allclose(amplitude(human, motion), [3, 1, np.nan])
    # Catches a channel that was not measured, whose mean is not quite its only value, and which then has an amplitude.
    assert np.isnan(amplitude(np.full((7, 1), 0.1) + np.spacing(0.1) * np.arange(7)[:, None], motion[:7, :1])).all()


def test_correlation_is_pooled_over_utterances() -> None:
    # Catches a mean of correlations per utterance, which hides that levels are wrong.
    a, b = vowels(), vowels()
    low, high = a.human, b.human + 300
    pair = [Utterance(a.episode, a.timeline, a.words, low), Utterance(b.episode, b.timeline, b.words, high)]
    assert judge_of(*pair).measure([high, low])["correlation/open_jaw"] < -0.5


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


def test_joins_are_the_edges_of_cross_fades() -> None:
    assert np.flatnonzero(joins([10], [5], 30)).tolist() == [8, 9, 13, 14]
    assert np.flatnonzero(joins([0, 29], [0, 1], 30)).tolist() == [27]


def kinked(at: Tuple[int, ...]) -> np.ndarray:
    """(50, 13): a slope that changes by 1 at the given frames, and a faint bend everywhere."""
    slope = 0.01 * np.arange(50) + sum(1.0 * (np.arange(50) >= t) for t in at)
    return np.cumsum(slope)[:, None] * np.ones(13)


def test_seams_are_seen_where_units_join_and_only_there() -> None:
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


def test_phone_sets_without_bilabials_have_no_closure() -> None:
    test = item(["a", "fricative", "e"], [20, 20, 20], wave(60), LAUGHTER)
    masks, scale = judged_frames([test], LAUGHTER), measure_scale([test], LAUGHTER, FPS)
    measured = Judge([test], masks, scale, LAUGHTER, FPS).measure([test.human])
    assert np.isnan(measured["closure/rate"]) and measured["correlation/mean"] == pytest.approx(1)


def test_only_the_judged_words_count() -> None:
    test = vowels()
    marked = Utterance(test.episode, test.timeline, (None, "a", "b", "a", "b", None), test.human)
    mask = judged_frames([marked], SPEECH, ["b"])[0]
    assert np.flatnonzero(mask).tolist() == [*range(15, 25), *range(35, 45)]
