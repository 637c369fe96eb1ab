"""``labial train-words``: from a pronouncing dictionary to tables of words."""

from __future__ import annotations

import argparse
import functools
import sys

from labial.commands.common import add_quiet, shows_progress
from labial.files.arguments import positive, whole


def add_train_words(command: argparse.ArgumentParser) -> None:
    """The dictionary, the sizes and the output file."""
    command.add_argument("dictionary", metavar="CMUDICT", help="the CMU Pronouncing Dictionary (cmudict.dict)")
    command.add_argument("-o", "--output", required=True, metavar="WORDS.npz")
    command.add_argument("--common", metavar="LIST", help="words by frequency, one per line, from which exceptions are "
                         "chosen (a list that Labial comes with)")
    command.add_argument("--leaves", type=positive, default=13_000, help="of all trees (13000)")
    command.add_argument("--exceptions", type=functools.partial(whole, 0, 8000), default=1_000,
                         help="words that are stored beside the trees (1000)")
    command.add_argument("--held-out", action="store_true", help="first train on 85 %% of the words and print how well "
                         "the trees read the others")
    add_quiet(command, "lines")


def run_train_words(options: argparse.Namespace) -> int:
    """Trains, writes the tables, and prints what they consist of."""
    from labial.errors import needs

    with needs("training", "tools"):
        from labial.words import dictionary, tables, training
    from labial.files.outputs import check, check_suffix

    check(options.output)
    check_suffix(options.output, ".npz")
    report = functools.partial(print, file=sys.stderr) if shows_progress(options) else None
    entries = dictionary.read_dictionary(options.dictionary)
    common = dictionary.read_common(options.common or dictionary.COMMON)
    if options.held_out:
        scores = training.held_out(entries, leaves=options.leaves, report=report)
        size = int(scores.pop("words"))
        print(f"{size} held-out words: " + ", ".join(f"{value:.2f} % of {name}" for name, value in scores.items()))
    found = training.train(entries, common, leaves=options.leaves, exceptions=options.exceptions, report=report)
    tables.save(found, options.output)
    print(f"{options.output}: {found.leaves} leaves, {len(found.sounds)} labels, {len(found.exceptions)} exceptions")
    return 0
