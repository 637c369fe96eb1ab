"""``labial record``: a corpus from tracked video."""

from __future__ import annotations

import argparse

from labial.commands.common import add_kind
from labial.errors import needs
from labial.files.arguments import number


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Landmarks, properties that their files do not state, and the smoothing."""
    command.add_argument("landmarks", metavar="LANDMARKS", nargs="+", help="one talker's .npz, .npy or .csv files, or "
                         "folders of them, each with its phoneme timings (NAME.lab, .TextGrid, ...) beside it")
    command.add_argument("-o", "--output", required=True, metavar="CORPUS", help="folder, new or empty")
    add_kind(command)
    command.add_argument("--fps", type=number, metavar="RATE", help="frames per second, where the files do not tell")
    command.add_argument("--size", metavar="WIDTHxHEIGHT", help="of the video in pixels, where coordinates are shares "
                         "of it and the files do not tell")
    command.add_argument("--offset", type=number, default=0.0, metavar="MS", help="how much later than its sound the "
                         "picture is, negative where it is earlier (0); an estimate is printed")
    command.add_argument("--cutoff", type=number, default=12.0, metavar="HZ",
                         help="what moves faster is smoothed as the tracker's noise; 0 smooths nothing (12)")


def run(options: argparse.Namespace) -> int:
    """Writes the corpus."""
    with needs("recording", "train"):
        from labial.capture.record import record
    from labial.capture.landmarks import Given, parse_size
    from labial.corpus.phonesets import PHONE_SETS

    size = parse_size(options.size) if options.size else None
    print(record(options.landmarks, options.output, PHONE_SETS[options.kind], Given(options.fps, size), options.cutoff,
                 options.offset / 1000))
    return 0
