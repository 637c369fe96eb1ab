"""``labial align``: the phonemes of a recording."""

from __future__ import annotations

import argparse

from labial.commands.common import add_quiet, add_said, put, said, shows_progress
from labial.errors import needs


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A sound, and what is said in it."""
    command.add_argument("sound", metavar="SOUND", help="WAV, FLAC, Ogg, MP3; any rate and number of channels")
    add_said(command)
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")
    add_quiet(command)


def run(options: argparse.Namespace) -> int:
    """Writes the .lab."""
    with needs("aligning", "align"):
        from labial.align.progress import align_with_bar
    from labial.corpus.timings import lab_of
    from labial.outputs import check

    check(options.output)
    put(lab_of(align_with_bar(options.sound, said(options), shows_progress(options))), options.output)
    return 0
