"""The lip-reader on made motion of which it is known what can be read from it."""

from __future__ import annotations

from typing import Dict, List, Optional, Sequence

import numpy as np
import pytest

from labial.corpus.phonesets import SPEECH
from labial.evaluate.material import Utterance, timeline
from labial.evaluate.readability import MARGIN, POINTS, LipReader, features, spoken, word_classes
from labial.evaluate.training import Training
from test_evaluate import planted

FPS = 50
WORDS = (("lay", "set", "bin"), ("one", "two"))
PLACES = 13 * POINTS
CHANNEL = np.arange(13)


def sentence(words: Sequence[Optional[str]], seed: int, shape: Dict[str, float], noise: float = 0.0) -> Utterance:
    """Three phonemes a word, of random lengths, between silences: a wave in each word, of the word's own phase."""
    rng = np.random.default_rng(seed)
    labels, names, lengths = ["SIL"], [None], [8]
    for word in words:
        labels += ["L", "AA", "T"]
        names += [word] * 3
        lengths += [int(n) for n in rng.integers(2, 9, 3)]
    given = timeline([SPEECH.phonemes.index(label) for label in [*labels, "SIL"]],
                     [20 * n for n in [*lengths, 12]], FPS)  # fmt: skip
    item = Utterance(planted(lambda t: np.zeros((t.frames, 13)), 1)[0], given, (*names, None), np.zeros(0))
    motion = rng.normal(0, noise, (given.frames, 13)) if noise else np.zeros((given.frames, 13))
    motion += rng.normal(0, 80, 13)  # where the lips rest in this utterance
    for word, begin, end in spoken(item, 0):
        place = np.linspace(0, 1, end - begin)[:, None]
        motion[begin:end] += 50 * np.sin(2 * np.pi * place + shape.get(word, 0.0) + CHANNEL)
    return Utterance(item.episode, given, item.words, motion)


def corpus(count: int, first: int, noise: float = 2.0) -> List[Utterance]:
    shape = {word: 2 * np.pi * n / len(own) for own in WORDS for n, word in enumerate(own)}
    return [sentence([WORDS[0][n % 3], WORDS[1][n // 3 % 2]], first + n, shape, noise) for n in range(count)]


def training(items: Sequence[Utterance]) -> Training:
    return Training(items, SPEECH, FPS, seed=0)


def still(items: Sequence[Utterance]) -> List[np.ndarray]:
    return [np.zeros_like(item.human) for item in items]


def test_words_that_differ_are_read_at_any_length_and_from_any_rest() -> None:
    """Catches a reader that is thrown off by durations or by where an utterance's lips rest, both random here."""
    test = corpus(30, first=1000)
    measured = LipReader(training(corpus(60, first=0)), test).measure([item.human for item in test])
    assert measured == {"readability": 1.0, "readability/with residual": 1.0}


def test_motion_without_words_is_read_at_chance() -> None:
    """Catches a reader that knows what it is to read: 1/3 and 1/2 is what one word for everything gets."""
    test = corpus(60, first=1000)
    reader = LipReader(training(corpus(60, first=0)), test)
    assert reader.measure(still(test))["readability"] == pytest.approx((1 / 3 + 1 / 2) / 2)
    rng = np.random.default_rng(1)
    noise = [rng.normal(0, 50, item.human.shape) for item in test]
    assert reader.measure(noise)["readability"] == pytest.approx((1 / 3 + 1 / 2) / 2, abs=0.12)


def test_another_words_motion_is_read_as_that_word() -> None:
    """Catches a share that does not compare with the word that was to be said."""
    test = corpus(60, first=1000)
    swapped = {"lay": "set", "set": "bin", "bin": "lay", "one": "two", "two": "one"}
    wrong = [Utterance(item.episode, item.timeline, tuple(swapped.get(word or "") for word in item.words), item.human)
             for item in test]  # fmt: skip
    reader = LipReader(training(corpus(60, first=0)), wrong)
    assert reader.measure([item.human for item in wrong])["readability"] == 0.0


@pytest.mark.slow
def test_the_residual_is_the_humans_variation_within_words() -> None:
    """Catches a residual of another size, or with the words in it: motion that is each word's true mean is read as
    often with it as people are, neither always, as without, nor at chance."""
    loud = 250.0
    test = corpus(120, first=5000, noise=loud)
    clean = [item.human for item in corpus(120, first=5000, noise=0.0)]
    reader = LipReader(training(corpus(400, first=0, noise=loud)), test)
    people, perfect = reader.measure([item.human for item in test]), reader.measure(clean)
    assert perfect["readability"] == 1.0 and 0.6 < people["readability"] < 0.97
    assert perfect["readability/with residual"] == pytest.approx(people["readability"], abs=0.08)
    assert people["readability/with residual"] < people["readability"] - 0.02
    assert reader.measure(still(test))["readability/with residual"] < 0.5
    again = LipReader(training(corpus(400, first=0, noise=loud)), test)
    assert again.measure(clean) == perfect  # drawn by the seed


@pytest.mark.slow
def test_unseen_words_are_learned_from_other_utterances_than_those_read() -> None:
    """Catches a reader that was trained on the tokens it reads: each utterance's motion here tells which utterance it
    is, and nothing about the word, so that who has seen it reads it, and nobody else does."""
    rng = np.random.default_rng(0)
    items = [Utterance(item.episode, item.timeline, item.words, rng.normal(0, 50, item.human.shape))
             for item in corpus(240, first=0)]  # fmt: skip
    human = [item.human for item in items]
    own = LipReader(training(items), items).measure(human)["readability"]
    cross = LipReader(training(items[:1]), items, ["lay", "set", "bin"]).measure(human)["readability"]
    assert own > 0.8 and cross < 0.5


def test_unseen_words_are_told_apart_among_themselves() -> None:
    """Catches readers of all words, and words that only the test part has counted as unknown."""
    test = corpus(60, first=0)
    reader = LipReader(training([sentence(["other", "one"], 900, {})]), test, ["lay", "set"])
    assert reader.measure([item.human for item in test])["readability"] == 1.0
    assert {token.word for own in reader._classes for part in own for token in part.tokens} == {"lay", "set"}


def test_without_words_there_is_nothing_to_read() -> None:
    """Catches a corpus of phonemes alone, of one word, or of words that occur once, that ends in an error."""
    for words in ([None, None], ["same", "same"]):
        items = [sentence(words, n, {}, 2.0) for n in range(12)]
        assert np.isnan(list(LipReader(training(items), items).measure(still(items)).values())).all()
    rare = [sentence([f"w{n}"], n, {}, 2.0) for n in range(12)]
    assert np.isnan(LipReader(training(rare), rare).measure(still(rare))["readability"])


def test_words_are_runs_of_segments() -> None:
    """Catches words over silence, pronunciations of one word taken for two, a command grammar read as one class of 51
    words, and free speech cut into classes by chance."""
    item = sentence(["with(2)", "red"], 3, {})
    first, second = spoken(item, 0)
    assert first[0] == "with" and first[1:] == (8, int(item.timeline.start[4])) and second[0] == "red"
    assert spoken(item, SPEECH.phonemes.index("AA"))[0][1:] == (8, int(item.timeline.start[2]))
    assert word_classes([["bin", "red"], ["lay", "blue"], ["lay", "red"]]) == [("bin", "lay"), ("blue", "red")]
    assert word_classes([["a", "b"], ["b", "a"]]) == [("a", "b")]
    assert word_classes([["a", "b"], ["a"]]) == [("a", "b")] and word_classes([[], []]) == []


def test_features_are_the_time_normalised_motion_without_its_mean() -> None:
    """Catches points that are not spread from the margin before a word to that after it."""
    ramp = np.arange(100.0)[:, None] * np.ones(13)
    seen = features(ramp, 40, 61, FPS).reshape(POINTS, 13)
    begin, end = 40 - MARGIN * FPS, 60 + MARGIN * FPS
    np.testing.assert_allclose(seen[:, 3], np.linspace(begin, end, POINTS) - (begin + end) / 2)
    assert features(ramp, 0, 3, FPS).shape == (PLACES,) and np.isfinite(features(ramp, 98, 100, FPS)).all()
