#!/usr/bin/env python3
"""Prints how far laughs of each intensity move the mouth, and how far speech opens it (docs/laughing.md).

    laughs.py SENTENCES.flite

A file of sentences has a line of phonemes and their ends for each, as flite's -psdur prints. It needs numpy and the
exporter with the run-time on the path.
"""

from __future__ import annotations

import io
import sys
from typing import Sequence

import numpy as np

import labial
from labial.files.frames import opening

#: Intensities of `labial_laugh_init()`, of LABIAL_LAUGH_FULL at most.
INTENSITIES, FULL = (0, 64, 128, 192, 256), 256
SECONDS = 3.0
SEEDS = range(1, 13)


def laugh(intensity: int, seed: int) -> np.ndarray:
    """(T, 13) FAPs of a laugh."""
    with labial.Stream(labial.laughter_synthetic) as stream:
        stream.laugh(SECONDS, intensity / FULL, seed)
        stream.end()
        return np.array([frame.faps for frame in stream])


def main(arguments: Sequence[str]) -> int:
    """Prints a line for each intensity: the largest opening, mean, least and most of the laughs; FAP 3, mean of the
    largest; FAP 53, mean of all frames."""
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    for intensity in INTENSITIES:
        laughs = [laugh(intensity, seed) for seed in SEEDS]
        largest = [int(opening(frames).max()) for frames in laughs]
        jaw = np.mean([frames[:, 0].max() for frames in laughs])
        corner = np.concatenate(laughs)[:, 5].mean()
        print(f"intensity {intensity}: {np.mean(largest):.0f} {min(largest)} {max(largest)} {jaw:.0f} {corner:.0f}")
    with open(arguments[0], encoding="utf-8") as file:
        spoken = [labial.render(labial.read_timings(io.StringIO(line), source="flite")) for line in file]
    print(f"speech: {max(int(opening(np.array(frames)).max()) for frames in spoken)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
