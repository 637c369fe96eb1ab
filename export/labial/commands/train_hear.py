"""``labial train-hear``: from folders of speech to a model of hearing."""

from __future__ import annotations

import argparse
import hashlib
import sys
from pathlib import Path
from typing import Any, List, Tuple

from labial.commands.common import add_quiet, shows_progress
from labial.errors import LabialError, needs
from labial.files.arguments import number, positive, seed

#: Prepared takes of each clip without --takes.
TAKES = 2


def add_train_hear(command: argparse.ArgumentParser) -> None:
    """Folders, the network, and how long it learns."""
    command.add_argument("folder", nargs="+", metavar="FOLDER", help="sounds in any depth, each with timings or a text "
                         "(.txt) beside it, or with a metadata.csv in LJ Speech's layout")
    command.add_argument("-o", "--output", required=True, metavar="HEAR.npz")
    command.add_argument("--model", choices=("small", "large", "host", "ahead"), default="small",
                         help="size of the network: host and ahead are for computers, and ahead knows a frame 160 ms "
                         "later (small)")
    command.add_argument("--steps", type=positive, default=30000, help="batches of 160 s that are learned (30000)")
    command.add_argument("--rate", type=number, default=0.003, help="of learning, its highest (0.003)")
    command.add_argument("--smoothness", type=number, default=6.0, help="weight of the error of the frames' second "
                         "differences (6)")
    command.add_argument("--start", metavar="HEAR.npz", help="begin with what this model hears, which has as many "
                         "blocks and no more units, rather than anew")
    command.add_argument("--teacher", metavar="HEAR.npz", help="also learn what this model hears")
    command.add_argument("--taught", type=number, default=0.5, help="with --teacher: its share where the truth is "
                         "known (0.5)")
    command.add_argument("--sounds", nargs="+", default=[], metavar="FOLDER", help="with --teacher: sounds whose text "
                         "is not known; --shares and --takes name these folders last")
    command.add_argument("--shares", metavar="A,B,...", help="shares of the folders in each batch (the square roots of "
                         "their lengths)")
    command.add_argument("--takes", metavar="A,B,...", help="how many times each sound of each folder is prepared, all "
                         f"but the first time distorted ({TAKES})")
    command.add_argument("--cache", metavar="FOLDER", help="for alignments and features (beside the output, .cache)")
    command.add_argument("--seed", type=seed, default=0)
    command.add_argument("--jobs", type=positive, default=1, help="processes that align and prepare; training has one "
                         "thread. The result is the same")
    command.add_argument("--attribution", default="", help="what whoever passes the model on must say; kept in it")
    command.add_argument("--attribution-file", metavar="FILE", help="a file with that")
    add_quiet(command)


def run_train_hear(options: argparse.Namespace) -> int:
    """Reads, aligns, prepares, trains, and writes the model."""
    with needs("training", "hear"):
        import torch  # noqa: F401
        from tqdm import tqdm

        from labial.hearing import clips, prepared, train
        from labial.hearing.model import load, save
    from labial.files.grammar import read_text
    from labial.files.outputs import check, check_suffix

    check(options.output)
    check_suffix(options.output, ".npz")
    if options.sounds and options.teacher is None:
        raise LabialError("--sounds needs a --teacher")
    count = len(options.folder) + len(options.sounds)
    shares = _values(options.shares, "--shares", count)
    takes = [round(value) for value in _values(options.takes, "--takes", count)] or [TAKES] * count
    if min(takes) < 1 or max(takes) > 100:
        raise LabialError("--takes: a sound is prepared 1 to 100 times")
    attribution = options.attribution
    if options.attribution_file is not None:
        attribution = " ".join(read_text(options.attribution_file).split())
    if not 0 < options.rate <= 1:
        raise LabialError(f"--rate {options.rate:g} is not within 0 .. 1")
    if not 0 <= options.smoothness <= 1000:
        raise LabialError(f"--smoothness {options.smoothness:g} is not within 0 .. 1000")
    if not 0 <= options.taught <= 1:
        raise LabialError(f"--taught {options.taught:g} is not within 0 .. 1")
    start, teacher = (None if path is None else load(path) for path in (options.start, options.teacher))
    begun, by = ("" if path is None else hashlib.sha256(Path(path).read_bytes()).hexdigest()
                 for path in (options.start, options.teacher))
    asked = train.Options(options.model, options.steps, options.rate, options.smoothness, options.seed, shares,
                          attribution, begun, by, options.taught if by else 0.0)
    cache = options.cache or f"{options.output}.cache"

    folders: List[Any] = []
    for place, (folder, times) in enumerate(zip([*options.folder, *options.sounds], takes)):
        with tqdm(desc=f"{folder}: aligned", disable=not shows_progress(options)) as bar:
            found = (clips.read(folder, cache, options.jobs, lambda done, total: _tell(bar, done, total))
                     if place < len(options.folder) else clips.untold(folder))
        with tqdm(desc=f"{folder}: prepared", disable=not shows_progress(options)) as bar:
            folders.append(prepared.prepare(found, times, options.seed, cache, options.jobs,
                                            lambda done, total: _tell(bar, done, total)))
        if not options.quiet:
            seconds = len(folders[-1].classes) / 50
            print(f"{folder}: {len(found)} sounds, {seconds / 3600:.2f} hours prepared", file=sys.stderr)
    checkpoint = f"{options.output}.checkpoint"
    known = len(options.folder)
    model = train.train(folders[:known], asked, checkpoint, None if options.quiet else _print, Path(options.output),
                        start, folders[known:], teacher)
    save(model, options.output)
    Path(checkpoint).unlink()
    print(f"{options.output}: {options.model}, {options.steps} steps; {_reached(model.training)}")
    return 0


def _values(text: Any, option: str, count: int) -> Tuple[float, ...]:
    if text is None:
        return ()
    try:
        values = tuple(number(item) for item in text.split(","))
    except argparse.ArgumentTypeError as error:
        raise LabialError(f"{option}: {error}") from None
    if len(values) != count:
        raise LabialError(f"{option}: {len(values)} numbers for {count} folders")
    return values


def _tell(bar: Any, done: int, total: int) -> None:
    bar.total = total
    bar.update(done - bar.n)


def _print(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _reached(training: Any) -> str:
    return "held out: " + ", ".join(f"{name} {value:g}" for name, value in training["held_out"].items())
