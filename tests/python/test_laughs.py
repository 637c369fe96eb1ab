"""Laughs of a wanted length: the exporter's, to which test_laugh.c holds the library, against the synthetic corpus."""

from __future__ import annotations

from collections import Counter

import known_laughs
import numpy as np
import pytest

from labial.corpus import laughter
from labial.corpus.phonesets import LAUGHTER, LAUGHTER_GRADES
from labial.reference.laughs import FULL, _Laugh, pieces, table_header
from packages import SOURCE


def test_the_table_is_the_corpus() -> None:
    """Catches statistics that were changed in the corpus and not on the device: run
    python -m labial.reference.laughs then."""
    assert (SOURCE / "lib/laugh_table.h").read_text(encoding="ascii") == table_header()


def test_the_c_suite_knows_the_laughs() -> None:
    """Catches laughs that changed and are not written for test_laugh.c, which holds the library to the exporter's: run
    tests/c/known_laughs.py then."""
    assert (SOURCE / "tests/c/laughs.h").read_text(encoding="ascii") == known_laughs.table()


def test_statistics_are_those_of_the_corpus() -> None:
    """Catches a grammar that drifted from the corpus: at half intensity phonemes have its medians and, within a
    quarter, its frequencies; pulses follow each other every 210 ms; most of a laugh is silence or breath."""
    rng = np.random.Generator(np.random.PCG64(3))
    corpus = [item for _ in range(150) for item in laughter._bout(rng)[0][1:-1]]
    # Intensities of the corpus are 0 to 1, half in the mean; the number of trains, not their making, depends on it.
    laughs = [item for seed in range(60) for item in pieces(20000, 128, seed)]
    laughs = [(label.split("_")[0], ms) for label, ms in laughs]  # whatever their grade
    corpus = [(label.split("_")[0], ms) for label, ms, _ in corpus]
    ours, theirs = Counter(label for label, _ in laughs), Counter(label for label, _ in corpus)
    for label in LAUGHTER.phonemes[:12]:
        share, expected = ours[label] / len(laughs), theirs[label] / len(corpus)
        assert share == pytest.approx(expected, rel=0.25, abs=0.01), label
        median = np.median([ms for name, ms in laughs if name == label])
        assert median == pytest.approx(np.median([ms for name, ms in corpus if name == label]), rel=0.12), label
    total = sum(ms for _, ms in laughs)
    assert sum(ms for label, ms in laughs if label in ("silence", "fricative", "ne")) > 0.5 * total
    onsets, at = [], 0
    for label, ms in laughs:
        if label in (*laughter.VOWELS, "cackle", "nasal"):
            onsets.append(at)
        at += ms
    gaps = np.diff(onsets)
    assert np.median(gaps[gaps < 300]) == pytest.approx(210, abs=10)


def grade(label: str) -> int:
    return {"soft": 0, "loud": 2}.get(label.split("_")[-1], 1)


def test_intensity_goes_through_all_grades() -> None:
    """Catches a laugh that is louder than a hum at 0, not loud from the first pulse on at full intensity, or a step
    between them at which nothing changes."""
    means = []
    for intensity in range(0, FULL + 1, 32):
        laughs = [list(pieces(4000, intensity, seed)) for seed in range(40)]
        graded = [[grade(label) for label, _ in laugh if label.split("_")[0] in LAUGHTER_GRADES] for laugh in laughs]
        means.append(np.mean(np.concatenate(graded)))
        if intensity == 0:
            assert not np.concatenate(graded).any()
        if intensity == FULL:
            assert all(laugh[0] == 2 for laugh in graded) and np.mean([laugh[:4] for laugh in graded]) > 1.8
    assert means[0] == 0 and means[-1] > 1.5 and np.diff(means).min() > 0.03


def test_grades_are_mixed_evenly() -> None:
    """Catches grades in clusters, where a laugh between two grades would be now one, now the other: of any ten in a row
    as many are of the louder grade, but for two, as the share says, a laugh of one long train without its fading."""
    laugh = _Laugh(10**6, 0, 5)
    for intensity in (60, 100, 128, 150, 200):
        laugh.intensity, laugh.queue = intensity, []
        for _ in range(200):
            laugh.add_graded("a", 100, 255)
        grades = np.array([grade(label) for label, _ in laugh.queue])
        tens = np.lib.stride_tricks.sliding_window_view(grades, 10).sum(axis=1)
        expected = 2 * (intensity / FULL - laughter.SOFT) / (laughter.LOUD - laughter.SOFT)
        assert abs(tens - 10 * expected).max() < 2.0 and grades.mean() == pytest.approx(expected, abs=0.05)
