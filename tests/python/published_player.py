"""Plays streams by a run-time that is built for the published method, and by its reference on the same tables.

    LABIAL_RUNTIME=... python published_player.py SEED

prints ``{stream: [[frames of the run-time], [frames of the reference]]}`` for a random model of this seed: of
all kinds of streams, and ``articulated`` for one that is played at 130 percent.
"""

from __future__ import annotations

import json
import sys
from typing import List, Sequence, Tuple

import numpy as np

from labial.core.library import method
from labial.evaluate.check import device_model
from labial.reference.fade import delivered
from labial.reference.published import synthesise
from labial.reference.tables import ExportedTables
from labial.runtime.stream import Stream
from labial.tables.quantise import quantise
from models import random_model, streams


def main() -> None:
    assert method() == "paper"
    seed = int(sys.argv[1])
    model = random_model(seed, "paper", states=50 if seed % 2 else 12)
    exported = quantise(model, "tested_model", predecessors=50)
    device, tables = device_model(exported), ExportedTables(exported)

    def played(phonemes: Sequence[Tuple[int, int]], articulation: int = 100) -> List[List[int]]:
        with Stream(device, exact=True) as stream:
            stream.articulation(articulation)
            frames: List[List[int]] = []
            for number, milliseconds in phonemes:
                stream.push(number, milliseconds)
                frames += [list(frame.faps) for frame in stream]  # as far as they are known
            stream.end()
            return frames + [list(frame.faps) for frame in stream]

    def wanted(phonemes: Sequence[Tuple[int, int]], gain: float = 1.0) -> List[List[float]]:
        frames: List[List[float]] = delivered(gain * synthesise(tables, phonemes), exact=True).tolist()
        return frames

    asked = streams(len(model.phonemes), model.boundary, seed)
    found = {name: [played(phonemes), wanted(phonemes)] for name, phonemes in asked.items()}
    gain = np.floor(130 * 2.56 + 0.5) / 256.0
    found["articulated"] = [played(asked["ordinary"], 130), wanted(asked["ordinary"], gain)]
    print(json.dumps(found))


if __name__ == "__main__":
    main()
