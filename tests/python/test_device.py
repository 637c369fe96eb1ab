"""The C library against the float64 reference, on phoneme streams of all kinds."""

from __future__ import annotations

import numpy as np
import pytest

from labial.evaluate.check import device_frames
from labial.reference.stream import synthesise
from labial.reference.tables import ExportedTables
from labial.tables.quantise import quantise
from models import random_model, streams
from runtime import needs_runtime

pytestmark = needs_runtime


@pytest.mark.parametrize("method", ["paper", "labial"])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 6))])
def test_library_follows_the_reference(method: str, seed: int) -> None:
    """At most one FAP unit anywhere and RMS 0.25: any wrong decision or overflow is far beyond."""
    model = random_model(seed, method, states=50 if seed % 2 else 12)
    exported = quantise(model, "tested_model")
    asked = list(streams(len(model.phonemes), model.boundary, seed).values())
    if seed == 0:
        rng = np.random.default_rng(0)
        asked.append([(int(rng.integers(9)), int(rng.integers(20, 150))) for _ in range(2000)])
    tables = ExportedTables(exported)
    differences = []
    for stream, found in zip(asked, device_frames(exported, asked)):
        expected = synthesise(tables, stream)
        assert found.shape == expected.shape
        difference = found - np.floor(expected + 0.5)
        assert np.abs(difference).max(initial=0) <= 1
        assert np.abs(found - expected).max(initial=0) <= 0.6
        differences.append(difference)
    assert np.sqrt(np.mean(np.concatenate(differences) ** 2)) <= 0.25  # over all: a held pose may lie on a half
