"""``labial timings``: phoneme timings of any format as a .lab."""

from __future__ import annotations

import argparse

from labial.commands.common import add_labels, add_source, put


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Timings and the output file."""
    command.add_argument("phones", metavar="FILE", help="phoneme timings, as for synth")
    add_source(command)
    add_labels(command)
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")


def run(options: argparse.Namespace) -> int:
    """Writes the .lab."""
    from labial.corpus.formats import as_lab
    from labial.files.outputs import check

    check(options.output)
    put(as_lab(options.phones, options.labels, options.source), options.output)
    return 0
