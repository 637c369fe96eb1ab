#!/usr/bin/env python3
"""Measures the Python run-time: microseconds per frame, rendered whole and one by one.

    PYTHONPATH=export LABIAL_RUNTIME=build/bench/flat/labial_runtime.so python3 bench/runtime.py

prints the microseconds per frame of each way, the best of `RUNS` runs, as JSON. numpy is not needed.
"""

from __future__ import annotations

import json
import time
from typing import Callable, Dict, List, Optional, Tuple

import labial

#: All sorts of phonemes, closures, a pause: 1.26 s.
SENTENCE = [("SIL", 120), ("M", 70), ("AY", 160), ("B", 60), ("EY", 110), ("B", 55), ("IY", 90), ("M", 65), ("EY", 120),
            ("B", 50), ("IY", 80), ("HH", 60), ("AE", 110), ("P", 75), ("IY", 35)]
#: Repetitions in a run: 6,300 frames.
TIMES = 100
RUNS = 5


def rendered(timings: List[Tuple[str, int]]) -> int:
    return len(labial.render(timings, exact=True))


def one_by_one(timings: List[Tuple[str, int]], face: Optional[labial.Rig] = None) -> int:
    """Frames of an utterance, each a :class:`labial.Frame`, and the outputs of a `face`."""
    with labial.Stream() as stream:
        for phoneme, milliseconds in timings:
            stream.push(phoneme, milliseconds)
        stream.end()
        return sum(1 for frame in stream if face is None or frame.rig(face))


def rigged(timings: List[Tuple[str, int]]) -> int:
    return one_by_one(timings, labial.Rig("arkit"))


def microseconds(way: Callable[[List[Tuple[str, int]]], int]) -> float:
    """Per frame, the best of `RUNS` runs; the first call, which loads the library, is not timed."""
    way(SENTENCE)
    best = float("inf")
    for _ in range(RUNS):
        begin = time.perf_counter()
        frames = way(SENTENCE * TIMES)
        best = min(best, (time.perf_counter() - begin) / frames * 1e6)
    return best


def main() -> None:
    found: Dict[str, float] = {"rendered whole": microseconds(rendered), "one by one": microseconds(one_by_one),
                               "one by one, with ARKit's blendshapes": microseconds(rigged)}
    print(json.dumps({way: round(value, 2) for way, value in found.items()}))


if __name__ == "__main__":
    main()
