"""Variants of a method side by side on held-out data: the command and the table of :mod:`labial.evaluate.choices` and
:mod:`labial.evaluate.departures`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus import read_corpus
from labial.corpus.phonesets import PHONE_SETS
from labial.defaults import FPS, KINDS
from labial.errors import LabialError
from labial.evaluate.material import Split, Timeline, Utterance, make_splits, utterances
from labial.evaluate.measures import Judge, judged_frames
from labial.evaluate.training import Training
from labial.files.grammar import positive, seed
from labial.files.outputs import check, writing
from labial.train.workers import Workers

#: Columns of the tables: title and measure.
COLUMNS = (("diff", "diff/mean"), ("correlation", "correlation/mean"), ("amplitude", "amplitude/mean"),
           ("closure", "closure/rate"), ("jitter", "jitter"), ("seam", "seam/mean"))

#: A split of a corpus, what kind of sounds it has, and the seed of the first split's training.
Task = Tuple[List[Utterance], Split, str, int]


class Setting(NamedTuple):
    """What the variants of one split have in common."""

    training: Training
    timelines: List[Timeline]  #: of the held-out utterances
    judge: Judge  #: of their motion


def setting(task: Task) -> Setting:
    """The setting of a split."""
    corpus, split, kind, first_seed = task
    phone_set = PHONE_SETS[kind]
    training = Training([corpus[i] for i in split.training], phone_set, FPS, first_seed + split.number)
    test = [corpus[i] for i in split.test]
    judge = Judge(test, judged_frames(test, phone_set, ()), training.scale, phone_set, FPS)
    return Setting(training, [item.timeline for item in test], judge)


def table(head: str, titles: Sequence[str], outcomes: Sequence[Sequence[Dict[str, float]]]) -> str:
    """Markdown: variants by `titles` down, means over the splits across. An outcome has the measures of each variant on
    one split."""
    rows = [f"| {head} | " + " | ".join(name for name, _ in COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for index, title in enumerate(titles):
        values = [np.mean([split[index][measure] for split in outcomes]) for _, measure in COLUMNS]
        rows.append(f"| {title} | " + " | ".join(f"{value:.4f}" if i == 0 else f"{value:.3f}"
                                                 for i, value in enumerate(values)) + " |")
    return "\n".join(rows) + "\n"


def main(name: str, description: str, head: str, titles: Callable[[str], Sequence[str]],
         run_split: Callable[[Task], List[Dict[str, float]]], splits: int, arguments: Optional[List[str]]) -> int:
    """The command ``python -m labial.evaluate.NAME``; returns its exit status. `titles` are those of a kind's variants,
    `run_split`, a module-level function, measures them on one split, and `splits` is how many there are by default."""
    parser = argparse.ArgumentParser(prog=f"python -m labial.evaluate.{name}", description=description)
    parser.add_argument("corpus", help="a corpus, as for labial train")
    parser.add_argument("--kind", choices=KINDS, default=KINDS[0])
    parser.add_argument("--splits", type=positive, default=splits, help=f"random 80/20 splits by episode ({splits})")
    parser.add_argument("--seed", type=seed, default=0)
    parser.add_argument("--jobs", type=positive, default=2, help="splits at a time (2); the result is the same")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="TABLE.md")
    options = parser.parse_args(arguments)
    try:
        check(options.output)
        corpus = utterances(read_corpus(options.corpus, options.kind), PHONE_SETS[options.kind], FPS)
        tasks = [(corpus, split, options.kind, options.seed)
                 for split in make_splits(corpus, options.splits, options.seed)]
        with Workers(options.jobs, sys.stderr.isatty(), None) as workers:
            outcomes = workers.run("splits", run_split, tasks)
        text = table(head, titles(options.kind), outcomes)
        with writing(options.output, "utf-8") as out:
            out.write(text)
    except (LabialError, OSError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    print(text, end="")
    return 0
