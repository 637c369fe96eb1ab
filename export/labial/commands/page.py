"""``labial page``: a page on which a drawn mouth moves."""

from __future__ import annotations

import argparse
from pathlib import Path

from labial.commands.common import add_phones, put
from labial.errors import LabialError


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A motion, its phonemes and its sound."""
    command.add_argument("frames", metavar="FRAMES", help="a frames file (.csv), .fap, or a model (.npz), which speaks "
                         "the timings")
    add_phones(command)
    command.add_argument("--audio", metavar="FILE", help="sound in step: WAV, MP3, Ogg, FLAC, AAC, M4A or WebM")
    command.add_argument("--title", help="the file's name without it")
    command.add_argument("-o", "--output", required=True, metavar="OUT.html")


def run(options: argparse.Namespace) -> int:
    """Writes the page."""
    from labial.see.motion import read_bands, read_motion, spoken
    from labial.see.page import page

    bands = read_bands(options.phones, options.labels, options.source)
    if Path(options.frames).suffix.lower() == ".npz":
        if options.phones is None:
            raise LabialError(f"{options.frames}: a model speaks phoneme timings: give --phones")
        motion = spoken(options.frames, options.phones, options.labels, options.source)
    else:
        motion = read_motion(options.frames)
    put(page(motion, bands, options.audio, options.title), options.output)
    return 0
