"""``labial plot``: drawings of trajectories."""

from __future__ import annotations

import argparse

from labial import BUNDLED
from labial.commands.common import add_phones
from labial.errors import needs


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Motions, their phonemes, and the channels to draw."""
    command.add_argument("frames", metavar="FRAMES", nargs="+",
                         help="frames files (.csv), .fap, or models (.npz, or "
                         f"{' or '.join(BUNDLED)}), which speak the timings; several are overlaid")
    add_phones(command)
    command.add_argument("-o", "--output", required=True, metavar="OUT.png", help=".png, .svg or .pdf")
    command.add_argument("--channels", metavar="A,B,...", help="fap3, open_jaw, ..., opening, stretch or all; one "
                         "panel each (fap3,opening,stretch,fap17)")


def run(options: argparse.Namespace) -> int:
    """Writes the drawing."""
    with needs("plotting", "plot"):
        from labial.see.plot import DEFAULT, plot
    from labial.files.outputs import check
    from labial.see.motion import read_bands, read_motions

    check(options.output)
    timings = options.phones, options.labels, options.source
    plot(read_motions(options.frames, *timings), read_bands(*timings), options.output, options.channels or DEFAULT)
    return 0
