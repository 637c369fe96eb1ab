"""``labial synth``: motion from a model and phoneme timings, by the float64 reference."""

from __future__ import annotations

import argparse
import functools
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any, ContextManager

from labial.commands.common import add_format, add_labels, add_source, format_of
from labial.core.library import ARTICULATION_MAX
from labial.files.arguments import whole
from labial.tables.bundled import MODEL_HELP


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A model, timings and the format of the frames."""
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("phones", metavar="PHONES", help="phoneme timings, in a format of --from")
    add_source(command)
    command.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    add_format(command)
    command.add_argument("--fps", type=functools.partial(whole, 1, 1000), metavar="RATE", help="frames per second of "
                         "the output, resampled; the model's without it. Greta plays 25, whatever a .fap says")
    add_labels(command)
    command.add_argument("--articulation", type=functools.partial(whole, 0, ARTICULATION_MAX), metavar="PERCENT",
                         default=100, help="how far the mouth moves: 50 is a mumble, 130 a shout (100)")
    command.add_argument("--exact", action="store_true",
                         help="exactly the frames of the phonemes: the face does not come to rest after the last one")
    command.add_argument("--whole", action="store_true",
                         help="search and solve the whole utterance at once, in place of unit by unit (models of "
                         "--method paper) or as the run-time does (all others)")


def run(options: argparse.Namespace) -> int:
    """Writes the frames."""
    import numpy as np

    from labial.files.frames import at_rate, count_at
    from labial.files.outputs import check, writing
    from labial.reference.synthesis import delivered
    from labial.rig.animation import with_shares
    from labial.tables.model import load
    from labial.tables.phones import read_stream

    check(options.output)
    model = load(options.model)
    phonemes = read_stream(options.phones, model, options.labels, options.source)
    form = format_of(options)
    fps, name = options.fps or model.fps, Path(options.model).stem
    frames = list(delivered(model, phonemes, whole=options.whole, articulation=options.articulation,
                            exact=options.exact))  # all of them: some formats tell their number first
    count = sum(map(len, frames))
    spoken = [(model.phonemes[phoneme], milliseconds) for phoneme, milliseconds in phonemes]
    frames = [with_shares(np.concatenate(frames), spoken, model.fps)] if count else []
    parts = at_rate(frames, count, model.fps, fps)
    opened: ContextManager[Any] = writing(options.output, "ascii") if options.output else nullcontext(sys.stdout)
    with opened as out:
        form.write(out, parts, fps, name, count_at(count, model.fps, fps))
    return 0
