"""``labial bake``: a C header that a board plays."""

from __future__ import annotations

import argparse

from labial.commands.common import add_labels, add_quiet, add_said, add_source, said, shows_progress
from labial.tables.bundled import MODEL_HELP


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The input, the form of the output, and the face."""
    command.add_argument("file", metavar="FILE", help="phoneme timings, as for synth; a sound, as for align; or frames "
                         "(.csv, .fap)")
    command.add_argument("-o", "--output", required=True, metavar="OUT.h")
    command.add_argument("--as", dest="kind", choices=("track", "phonemes"), default="track",
                         help="a byte per output and frame, which an Arduino Uno plays, or phonemes for boards that "
                         "run Labial (track)")
    command.add_argument("--rig", metavar="FACE.toml", help="what a track moves, as for rig; a jaw without it")
    command.add_argument("--parts", metavar="SECONDS", help="a track in parts of so many seconds at most, cut in "
                         "pauses, each of which can be begun with; pauses: cut in every pause of 0.4 s or more")
    add_said(command)
    add_source(command)
    add_labels(command)
    command.add_argument("--model", metavar="MODEL", help=f"{MODEL_HELP}; without it the one of these that knows the "
                         "phonemes")
    command.add_argument("--name", help="of the C symbols; the header's file name without it")
    add_quiet(command)


def run(options: argparse.Namespace) -> int:
    """Writes the header and, for a track, its player; prints where parts begin and end."""
    from labial.bake.bake import bake
    from labial.bake.source import Source

    source = Source(options.file, options.model, said(options), options.labels, options.source,
                    progress=shows_progress(options))
    for line in bake(source, options.output, options.kind, options.rig, options.name, options.parts):
        print(line)
    return 0
