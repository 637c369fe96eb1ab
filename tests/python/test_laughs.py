"""Laughs of a wanted length: the C generator against the exporter's, and both against the synthetic corpus."""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from labial.corpus import laughter
from labial.laughs import FULL, _Laugh, pieces, table_header
from labial.phonesets import LAUGHTER, LAUGHTER_GRADES

SOURCE = Path(os.environ.get("LABIAL_SOURCE", Path(__file__).resolve().parents[2]))


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """lib/laugh.c."""
    target = tmp_path_factory.mktemp("laugh") / "laugh.so"
    subprocess.run([os.environ.get("LABIAL_CC", "cc"), "-O1", "-shared", "-fPIC", f"-I{SOURCE}/include",
                    str(SOURCE / "lib/laugh.c"), "-o", str(target)], check=True)
    return ctypes.CDLL(str(target))


def test_the_table_is_the_corpus() -> None:
    """Catches statistics that were changed in the corpus and not on the device: run python -m labial.laughs then."""
    assert (SOURCE / "lib/laugh_table.h").read_text(encoding="ascii") == table_header()


def test_the_c_suite_knows_the_laughs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Catches laughs that changed and are not written for test_laugh.c: run tests/c/laughs.py then."""
    monkeypatch.syspath_prepend(str(SOURCE / "tests/c"))
    assert (SOURCE / "tests/c/laughs.h").read_text(encoding="ascii") == __import__("laughs").table()


def test_library_and_exporter_laugh_alike(library: ctypes.CDLL) -> None:
    """Catches a step of the grammar, a draw or a rounding that one of the two makes otherwise."""
    state, phoneme, length = (ctypes.c_uint32 * 16)(), ctypes.c_uint(), ctypes.c_uint32()
    for seed in range(300):
        asked = (37 * seed) % 2500 if seed % 3 else 60000
        intensity = seed * 57 % 257
        assert library.labial_laugh_begin(state, ctypes.c_uint32(asked), intensity, ctypes.c_uint32(seed * 7919)) == 0
        for label, milliseconds in pieces(asked, intensity, seed * 7919):
            assert library.labial_laugh_next(state, ctypes.byref(phoneme), ctypes.byref(length)) == 0
            assert (LAUGHTER.phonemes[phoneme.value], length.value) == (label, milliseconds)
        assert library.labial_laugh_next(state, ctypes.byref(phoneme), ctypes.byref(length)) > 0


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
