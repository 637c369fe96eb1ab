"""``labial check``: the C library against the float64 reference."""

from __future__ import annotations

import argparse
import sys

from labial.commands.common import add_labels, add_source
from labial.commands.export import add_table_options, exported
from labial.tables.bundled import MODEL_HELP


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A model and timings."""
    command.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    command.add_argument("phones", metavar="PHONES", nargs="+", help="phoneme timings, as for synth")
    add_source(command)
    add_labels(command)
    add_table_options(command)


def run(options: argparse.Namespace) -> int:
    """Prints the comparison; 1 where a limit is exceeded."""
    from labial.evaluate.check import compare
    from labial.tables.phones import read_stream

    model, tables = exported(options, "checked_model")
    streams = [read_stream(path, model, options.labels, options.source) for path in options.phones]
    comparison = compare(model, tables, streams)
    print(comparison.table())
    failures = comparison.failures()
    for failure in failures:
        print(f"labial check: {failure}", file=sys.stderr)
    return 1 if failures else 0
