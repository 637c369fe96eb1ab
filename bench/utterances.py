"""Prints a corpus's utterances for labial-bench-delay, with numpy and the exporter on the path:

    utterances.py MODEL.npz CORPUS

A line for each: phoneme numbers and milliseconds, alternating.
"""

from __future__ import annotations

import sys
from typing import List

from labial.corpus import read_corpus
from labial.errors import LabialError
from labial.tables.model import load
from labial.tables.phones import stream_of


def main(arguments: List[str]) -> int:
    """Prints the lines; status 1 and a message for invalid input."""
    try:
        model = load(arguments[0])
        for episode in read_corpus(arguments[1], model.kind):
            stream = stream_of(episode.segments, model, round(1000 * episode.segments[0].start))
            print(" ".join(f"{phoneme} {milliseconds}" for phoneme, milliseconds in stream))
    except LabialError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
