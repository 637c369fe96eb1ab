"""``labial synth``, ``export``, ``check`` and ``bake``: what is made of a trained model."""

from __future__ import annotations

import argparse
import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Tuple

from labial.commands import common
from labial.core.library import ARTICULATION_MAX
from labial.defaults import PREDECESSORS
from labial.errors import LabialError
from labial.files.c import check_name
from labial.files.grammar import finite, positive, whole
from labial.files.outputs import check, check_folder
from labial.tables.bundled import MODEL_HELP

if TYPE_CHECKING:
    from labial.tables.model import Model
    from labial.tables.quantise import ExportedModel


def add_synth(command: argparse.ArgumentParser) -> None:
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("phones", metavar="PHONES", help="phoneme timings, in a format of --from")
    common.add_source(command)
    command.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    common.add_format(command)
    command.add_argument("--fps", type=functools.partial(whole, 1, 1000), metavar="RATE", help="frames per second of "
                         "the output, resampled; the model's without it. Greta plays 25, whatever a .fap says")
    common.add_labels(command)
    command.add_argument("--articulation", type=functools.partial(whole, 0, ARTICULATION_MAX), metavar="PERCENT",
                         default=100, help="how far the mouth moves: 50 is a mumble, 130 a shout (100)")
    command.add_argument("--exact", action="store_true",
                         help="exactly the frames of the phonemes: the face does not come to rest after the last one")
    command.add_argument("--whole", action="store_true",
                         help="search and solve the whole utterance at once, in place of unit by unit (models of "
                         "--method paper) or as the run-time does (all others)")


def run_synth(options: argparse.Namespace) -> None:
    import numpy as np

    from labial.files.faps import CHANNELS
    from labial.files.frames import at_rate
    from labial.reference.synthesis import delivered
    from labial.rig.animation import with_shares
    from labial.tables.model import load
    from labial.tables.phones import read_stream

    check(options.output)
    form = common.format_of(options)
    model = load(options.model)
    phonemes = read_stream(options.phones, model, options.labels, options.source, options.tier)
    fps, name = options.fps or model.fps, Path(options.model).stem
    motion = np.concatenate([np.zeros((0, CHANNELS)), *delivered(
        model, phonemes, whole=options.whole, articulation=options.articulation, exact=options.exact)])
    spoken = [(model.phonemes[phoneme], milliseconds) for phoneme, milliseconds in phonemes]
    frames = at_rate(with_shares(motion, spoken, model.fps), model.fps, fps)
    with common.opened(options.output) as out:
        form.write(out, [frames], fps, name, len(frames))


def add_export(command: argparse.ArgumentParser) -> None:
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("--name", required=True, help="of the C symbol and the files")
    command.add_argument("-o", "--output", required=True, metavar="DIR")
    command.add_argument("--blob", action="store_true", help="write NAME.lbm for labial_model_load() too")
    add_table_options(command)


def add_table_options(command: argparse.ArgumentParser) -> None:
    """Options of :func:`exported`."""
    command.add_argument("--amplitude", type=finite, default=1.0, metavar="FACTOR",
                         help="widen (over 1) or calm (below 1) the motion about its mean; 1 is the least error (1)")
    command.add_argument("--predecessors", type=positive, default=PREDECESSORS,
                         help=f"transitions kept into each state ({PREDECESSORS})")


def exported(options: argparse.Namespace, name: str) -> Tuple[Model, ExportedModel]:
    """The float model that the options name, with their amplitude, and its exported tables."""
    from labial.tables.model import load, widened
    from labial.tables.quantise import quantise

    model, factor = load(options.model), options.amplitude
    if not 0.0 <= factor <= 4.0:
        raise LabialError(f"amplitude {factor} is not within 0 .. 4")
    if factor != 1.0:
        model = widened(model, factor)
    return model, quantise(model, name, predecessors=options.predecessors)


def run_export(options: argparse.Namespace) -> None:
    from labial.evaluate import loss
    from labial.hearing.model import is_hearing
    from labial.tables import emit
    from labial.tables.phones import drawn_streams
    from labial.words.tables import is_tables

    check_name(options.name)
    check_folder(options.output)
    plain = not options.blob and options.amplitude == 1.0 and options.predecessors == PREDECESSORS
    if is_hearing(options.model):
        if not plain:
            raise LabialError(f"{options.model}: --blob, --amplitude and --predecessors are not for a model of hearing")
        return _export_hearing(options)
    if is_tables(options.model):
        if not plain:
            raise LabialError(f"{options.model}: tables of words; --blob, --amplitude and --predecessors are for "
                              "models")
        return _export_words(options)
    model, tables = exported(options, options.name)
    measured = loss.measure(model, tables, drawn_streams(model))
    for path in emit.write(tables, options.output, binary=options.blob):
        print(path)
    print(loss.memory(tables))
    print(loss.quantisation(measured, model, tables))


def _export_hearing(options: argparse.Namespace) -> None:
    """Writes the C files of a model of hearing, and prints their memory."""
    from labial.hearing import emit
    from labial.hearing.model import load
    from labial.hearing.network import SMOOTHING
    from labial.hearing.quantise import quantise

    tables = quantise(load(options.model), options.name)
    for path in emit.write(tables, options.output):
        print(path)
    print(f"flash {emit.flash_bytes(tables)} B, workspace {emit.workspace_bytes(tables)} B, "
          f"a frame is ready {20 * (tables.ahead + SMOOTHING + 1)} ms after its begin")


def _export_words(options: argparse.Namespace) -> None:
    """Writes tables of words, which `labial train-words` made, and prints their memory."""
    from labial.words import packing
    from labial.words.tables import load

    packed = packing.pack(load(options.model))
    for path in packing.write(packed, options.name, options.output):
        print(path)
    print(f"{packed.size} bytes: trees {len(packed.trees)}, exceptions {len(packed.patches) + 2 * len(packed.buckets)}")


def add_check(command: argparse.ArgumentParser) -> None:
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("phones", metavar="PHONES", nargs="+", help="phoneme timings, as for synth")
    common.add_source(command)
    common.add_labels(command)
    add_table_options(command)


def run_check(options: argparse.Namespace) -> int:
    from labial.evaluate.check import compare
    from labial.tables.phones import read_stream

    model, tables = exported(options, "checked_model")
    streams = [read_stream(path, model, options.labels, options.source, options.tier) for path in options.phones]
    comparison = compare(model, tables, streams)
    print(comparison.table())
    failures = comparison.failures()
    for failure in failures:
        print(f"labial check: {failure}", file=sys.stderr)
    return 1 if failures else 0


def add_bake(command: argparse.ArgumentParser) -> None:
    command.add_argument("file", metavar="FILE", help="phoneme timings, as for synth; a sound, as for align; or frames "
                         "(.csv, .fap)")
    command.add_argument("-o", "--output", required=True, metavar="OUT.h")
    command.add_argument("--as", dest="kind", choices=("track", "phonemes"), default="track",
                         help="a byte per output and frame, which an Arduino Uno plays, or phonemes for boards that "
                         "run Labial (track)")
    command.add_argument("--rig", metavar="FACE.toml", help="what a track moves, as for rig; a jaw without it")
    command.add_argument("--parts", metavar="SECONDS", help="a track in parts of so many seconds at most, cut in "
                         "pauses, each of which can be begun with; pauses: cut in every pause of 0.4 s or more")
    common.add_said(command)
    common.add_source(command)
    common.add_labels(command)
    command.add_argument("--model", metavar="MODEL", help=f"{MODEL_HELP}; without it the one of these that knows the "
                         "phonemes")
    command.add_argument("--name", help="of the C symbols; the header's file name without it")
    common.add_quiet(command)


def run_bake(options: argparse.Namespace) -> None:
    from labial.bake.source import Source
    from labial.bake.track import bake

    source = Source(options.file, options.model, common.said(options), options.labels, options.source,
                    options.tier, common.shows_progress(options))
    for line in bake(source, options.output, options.kind, options.rig, options.name, options.parts):
        print(line)
