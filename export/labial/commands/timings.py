"""``labial timings``: phoneme timings of any format as a .lab."""

from __future__ import annotations

import argparse

from labial.commands.common import add_labels, add_source, put
from labial.files.arguments import number


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Timings and the output file."""
    command.add_argument("phones", metavar="FILE", help="phoneme timings, as for synth")
    add_source(command)
    add_labels(command)
    command.add_argument("--offset-ms", type=number, default=0.0, metavar="MS", help="added to all times: over 0 for a "
                         "voice that reports them too early (0)")
    command.add_argument("--language", default="en", help="of words and characters; another than en is pronounced by "
                         "espeak-ng, as it calls a language or a voice (en)")
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")


def run(options: argparse.Namespace) -> int:
    """Writes the .lab."""
    from labial.corpus.formats import as_lab
    from labial.corpus.words import Pronunciation
    from labial.files.outputs import check

    check(options.output)
    how = Pronunciation(language=options.language)
    put(as_lab(options.phones, options.labels, options.source, how, options.offset_ms / 1000.0), options.output)
    return 0
