"""``labial evaluate``: all methods against human motion."""

from __future__ import annotations

import argparse

from labial.commands.common import add_engine, add_fps, add_kind, add_quiet, add_talker_variance, shows_progress
from labial.defaults import SPLITS
from labial.errors import LabialError, needs
from labial.files.arguments import positive, seed


def add_evaluate(command: argparse.ArgumentParser) -> None:
    """Corpora, the data to hold out, and the workers."""
    command.add_argument("corpus", nargs="+", help="as for train; episodes of the first are held out, and Labial's "
                         "models are trained on all of the others too")
    command.add_argument("-o", "--output", required=True, metavar="REPORT", help="folder for tables and plots")
    add_kind(command)
    command.add_argument("--splits", type=positive, default=SPLITS,
                         help=f"random 80/20 splits by episode ({SPLITS})")
    command.add_argument("--seed", type=seed, default=0)
    command.add_argument("--methods", default="all", metavar="A,B,...", help="methods to compare (all)")
    add_fps(command)
    command.add_argument("--jobs", type=positive, default=2, help="splits at a time (2); the result is the same")
    add_engine(command)
    command.add_argument("--hold-out-words", default="", metavar="W1,W2,...",
                         help="train without the episodes that hold these words, judge these words' frames alone")
    command.add_argument("--leave-out-talkers", action="store_true", help="train without each talker of the second "
                         "and further corpora in turn, judge that talker, in place of random splits")
    command.add_argument("--first-corpus-alone", action="store_true", help="with --leave-out-talkers: train Labial's "
                         "models on the first corpus alone, as all other methods")
    add_talker_variance(command)
    add_quiet(command)


def run_evaluate(options: argparse.Namespace) -> int:
    """Evaluates, writes the report and prints its first table."""
    with needs("evaluating", "train,evaluate"):
        from labial.evaluate.material import Options
        from labial.evaluate.run import run as evaluated

    words = tuple(word.strip() for word in options.hold_out_words.split(",") if word.strip())
    if words and options.leave_out_talkers:
        raise LabialError("--hold-out-words and --leave-out-talkers do not go together")
    if options.first_corpus_alone and not options.leave_out_talkers:
        raise LabialError("--first-corpus-alone needs --leave-out-talkers")
    asked = Options(options.kind, options.methods, options.splits, options.seed, options.fps, words,
                    options.leave_out_talkers, talker_variance=options.talker_variance,
                    first_corpus_alone=options.first_corpus_alone)
    for path in evaluated(options.corpus, options.output, asked, jobs=options.jobs, engine=options.engine,
                          progress=shows_progress(options)):
        print(path)
    return 0
