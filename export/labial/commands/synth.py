"""``labial synth``: motion from a model and phoneme timings, by the float64 reference."""

from __future__ import annotations

import argparse
import functools
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ContextManager, Dict, List

from labial.commands.common import add_labels, add_source
from labial.core.library import ARTICULATION_MAX
from labial.errors import LabialError
from labial.files.arguments import whole
from labial.tables.bundled import MODEL_HELP

if TYPE_CHECKING:
    from labial.rig.animation import Format


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A model, timings and the format of the frames."""
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("phones", metavar="PHONES", help="phoneme timings, in a format of --from")
    add_source(command)
    command.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    _add_format(command)
    command.add_argument("--fps", type=functools.partial(whole, 1, 1000), metavar="RATE", help="frames per second of "
                         "the output, resampled; the model's without it. Greta plays 25, whatever a .fap says")
    command.add_argument("--rig", metavar="FACE.toml", help="with --to jsonl: a face of your own in place of ARKit's, "
                         "as labial rig reads it")
    add_labels(command)
    command.add_argument("--articulation", type=functools.partial(whole, 0, ARTICULATION_MAX), metavar="PERCENT",
                         default=100, help="how far the mouth moves: 50 is a mumble, 130 a shout (100)")
    command.add_argument("--whole", action="store_true",
                         help="search and solve the whole utterance at once, in place of unit by unit (models of "
                         "--method paper) or as the run-time does (all others)")


def _add_format(command: argparse.ArgumentParser) -> None:
    from labial.rig.animation import FORMATS

    names: Dict[str, List[str]] = {}
    for name, item in FORMATS.items():
        names.setdefault(item.about, []).append(name)
    about = "; ".join(f"{', '.join(same)}: {text}" for text, same in names.items())
    command.add_argument("--to", choices=tuple(FORMATS), metavar="FORMAT", default="csv", help=f"{about} (csv)")


def run(options: argparse.Namespace) -> int:
    """Writes the frames."""
    from labial.files.frames import at_rate, count_at
    from labial.files.outputs import check, writing
    from labial.reference.synthesis import frames_of, in_parts
    from labial.rig.animation import FORMATS
    from labial.tables.model import load
    from labial.tables.phones import read_stream

    check(options.output)
    model = load(options.model)
    phonemes = read_stream(options.phones, model, options.labels, options.source)
    form = _of_rig(options) if options.rig else FORMATS[options.to]
    count, fps, name = frames_of(model, phonemes), options.fps or model.fps, Path(options.model).stem
    motion = in_parts(model, phonemes, whole=options.whole, articulation=options.articulation)
    parts = at_rate(motion, count, model.fps, fps)
    opened: ContextManager[Any] = writing(options.output, "ascii") if options.output else nullcontext(sys.stdout)
    with opened as out:
        form.write(out, parts, fps, name, count_at(count, model.fps, fps))
    return 0


def _of_rig(options: argparse.Namespace) -> Format:
    from labial.rig.animation import FORMATS
    from labial.rig.description import read

    if options.to != "jsonl":
        raise LabialError("--rig goes with --to jsonl")
    name = Path(options.rig).stem
    if name in ("frame", "time", "faps"):
        raise LabialError(f"{options.rig}: {name!r} is taken in a line of JSON: name the file otherwise")
    return FORMATS[options.to].of_rig(read(options.rig, name))
