"""``labial export``: a model, or tables of words, as C tables."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Tuple

from labial.defaults import PREDECESSORS
from labial.errors import LabialError
from labial.files.arguments import number, positive
from labial.tables.bundled import MODEL_HELP

if TYPE_CHECKING:
    from labial.tables.model import Model
    from labial.tables.quantise import ExportedModel


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A model and its name in C."""
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("--name", required=True, help="of the C symbol and the files")
    command.add_argument("-o", "--output", required=True, metavar="DIR")
    command.add_argument("--blob", action="store_true", help="write NAME.lbm for labial_model_load() too")
    add_table_options(command)


def add_table_options(command: argparse.ArgumentParser) -> None:
    """Options of :func:`exported`."""
    command.add_argument("--amplitude", type=number, default=1.0, metavar="FACTOR",
                         help="widen (over 1) or calm (below 1) the motion about its mean; 1 is the least error (1)")
    command.add_argument("--predecessors", type=positive, default=PREDECESSORS,
                         help=f"transitions kept into each state ({PREDECESSORS})")


def exported(options: argparse.Namespace, name: str) -> Tuple[Model, ExportedModel]:
    """The float model that the options name, with their amplitude, and its exported tables."""
    from labial.tables.amplitude import widened
    from labial.tables.model import load
    from labial.tables.quantise import quantise

    model, factor = load(options.model), options.amplitude
    if not 0.0 <= factor <= 4.0:
        raise LabialError(f"amplitude {factor} is not within 0 .. 4")
    if factor != 1.0:
        model = widened(model, factor)
    return model, quantise(model, name, predecessors=options.predecessors)


def run(options: argparse.Namespace) -> int:
    """Writes the C files, and prints their memory and the loss."""
    from labial.evaluate import loss
    from labial.files.c import check_name
    from labial.files.outputs import check_folder
    from labial.hearing.model import is_hearing
    from labial.tables import emit
    from labial.tables.phones import drawn_streams
    from labial.words.tables import is_tables

    check_name(options.name)
    check_folder(options.output)
    if is_hearing(options.model):
        return _export_hearing(options)
    if is_tables(options.model):
        return _export_words(options)
    model, tables = exported(options, options.name)
    streams = drawn_streams(model)
    measured = loss.measure(model, tables, streams)
    for path in emit.write(tables, options.output, binary=options.blob):
        print(path)
    print(loss.memory(tables))
    print(loss.quantisation(measured, model, tables))
    return 0


def _export_hearing(options: argparse.Namespace) -> int:
    """Writes the C files of a model of hearing, and prints their memory."""
    from labial.hearing import emit
    from labial.hearing.model import load
    from labial.hearing.network import SMOOTHING
    from labial.hearing.quantise import quantise

    if options.blob or options.amplitude != 1.0 or options.predecessors != PREDECESSORS:
        raise LabialError(f"{options.model}: --blob, --amplitude and --predecessors are not for a model of hearing")
    tables = quantise(load(options.model), options.name)
    for path in emit.write(tables, options.output):
        print(path)
    print(f"flash {emit.flash_bytes(tables)} B, workspace {emit.workspace_bytes(tables)} B, "
          f"a frame is known {20 * (tables.ahead + SMOOTHING + 1)} ms after its begin")
    return 0


def _export_words(options: argparse.Namespace) -> int:
    """Writes tables of words, which `labial train-words` made, and prints their memory."""
    from labial.words import emit
    from labial.words.packing import pack
    from labial.words.tables import load

    if options.blob or options.amplitude != 1.0 or options.predecessors != PREDECESSORS:
        raise LabialError(f"{options.model}: tables of words; --blob, --amplitude and --predecessors are for models")
    packed = pack(load(options.model))
    for path in emit.write(packed, options.name, options.output):
        print(path)
    print(f"{packed.size} bytes: trees {len(packed.trees)}, exceptions {len(packed.patches) + 2 * len(packed.buckets)}")
    return 0
