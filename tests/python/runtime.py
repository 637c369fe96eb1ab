"""What the tests of the Python run-time share: where it is not built they are skipped, and the conformance streams."""

from __future__ import annotations

import functools
import os
from typing import Any, Dict, List

import pytest

from packages import SOURCE
from regenerate import bundled_models
from scripts import Frames, read, read_frames

CONFORMANCE = SOURCE / "tests" / "conformance"

needs_runtime = pytest.mark.skipif(
    not os.environ.get("LABIAL_RUNTIME"),
    reason="LABIAL_RUNTIME names no build of the run-time: cmake --build builds it as labial-python")


@functools.cache
def conformance_scripts() -> List[Dict[str, Any]]:
    """``streams.txt`` as runtime_player.py takes it."""
    return [{"name": script.name,
             "parts": [{"pushes": [[push.model, push.phoneme, push.milliseconds] for push in part.pushes],
                        "cancel": part.cancel, "again": part.again, "articulation": part.articulation}
                       for part in script.parts]}
            for script in read(CONFORMANCE / "streams.txt", bundled_models())]


@functools.cache
def conformance_frames() -> Frames:
    """``frames.txt``, which test_conformance.py holds to the float64 reference."""
    return read_frames((CONFORMANCE / "frames.txt").read_text(encoding="ascii"))
