"""``labial align``: the phonemes of a recording."""

from __future__ import annotations

import argparse
import sys

from labial.commands.common import add_quiet, add_said, put, said, shows_progress
from labial.errors import needs


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A sound and its text."""
    command.add_argument("sound", metavar="SOUND", help="WAV, FLAC, Ogg, MP3; any rate and number of channels")
    add_said(command)
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")
    add_quiet(command)


def run(options: argparse.Namespace) -> int:
    """Writes the .lab."""
    with needs("aligning", "align"):
        from labial.sound.align import align_with_bar
        from labial.sound.confidence import summary
    from labial.files.outputs import check

    check(options.output)
    found = align_with_bar(options.sound, said(options), shows_progress(options))
    put(found.lab(), options.output)
    if found.stretches and not options.quiet:
        print(f"{options.sound}: {summary(found.stretches)}", file=sys.stderr)
    return 0
