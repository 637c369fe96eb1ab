"""``labial page``: a page on which a drawn mouth moves."""

from __future__ import annotations

import argparse

from labial import BUNDLED
from labial.commands.common import add_phones, put
from labial.errors import LabialError


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A motion, its phonemes and its sound."""
    command.add_argument("frames", metavar="FRAMES", help="a frames file (.csv), .fap, or a model (.npz, or "
                         f"{' or '.join(BUNDLED)}), which speaks the timings")
    add_phones(command)
    command.add_argument("--audio", metavar="FILE", help="sound in step: WAV, MP3, Ogg, FLAC, AAC, M4A or WebM")
    command.add_argument("--head", metavar="AVATAR.glb", help="show this avatar instead of a drawn mouth")
    command.add_argument("--rig", metavar="FACE.toml", help="with --head: what moves it, such as labial fit writes")
    command.add_argument("--three", metavar="DIR", help="with --head: the npm package three; node_modules/three "
                         "without it")
    command.add_argument("--title", help="the file's name without it")
    command.add_argument("-o", "--output", required=True, metavar="OUT.html")


def run(options: argparse.Namespace) -> int:
    """Writes the page."""
    from labial.files.outputs import check
    from labial.see.motion import read_bands, read_motion
    from labial.see.page import page

    check(options.output)
    bands = read_bands(options.phones, options.labels, options.source)
    motion = read_motion(options.frames, options.phones, options.labels, options.source)
    if options.head is None:
        if options.rig is not None or options.three is not None:
            raise LabialError("--rig and --three go with --head")
        text = page(motion, bands, options.audio, options.title)
    else:
        from labial.see.head import head_page

        text = head_page(motion, options.head, options.rig, options.audio, options.title, options.three)
    put(text, options.output)
    return 0
