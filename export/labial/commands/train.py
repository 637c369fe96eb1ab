"""``labial train``: from corpora to a model, and from a model to that of one talker. ``labial train-words``: from a
pronouncing dictionary to tables of words. ``labial train-hear``: from folders of speech to a model of hearing."""

from __future__ import annotations

import argparse
import functools
import hashlib
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Sequence, Tuple

from labial.commands.common import add_engine, add_fps, add_kind, add_quiet, add_talker_variance, shows_progress
from labial.defaults import CODEBOOK, COMPONENTS, LOOK_AHEAD, METHODS, SEARCH_STRIDE, SIZES
from labial.errors import LabialError, needs
from labial.files.grammar import finite, positive, seed, whole
from labial.files.outputs import check

if TYPE_CHECKING:
    from labial.corpus.episode import Episode

#: Seconds of speech that a model is trained on at the least, and below which a warning says that it is little.
LEAST, FEW = 15, 120
#: The same of what a model is adapted to: what is learnt is less, the less there is.
LEAST_OF_TALKER, FEW_OF_TALKER = 5, 30
#: Prepared takes of each clip of ``train-hear`` without --takes.
TAKES = 2
#: The options that ``--adapt`` does not use.
_OF_TRAINING = ("kind", "method", "fps", "codebook", "components", "look_ahead", "search_stride", "talker_variance",
                "asymmetric", "normalise", "seed", "engine")


def add_train(command: argparse.ArgumentParser) -> None:
    command.add_argument("corpus", nargs="+", help="Labial corpus folder, IEMOCAP or AVLaughterCycle; of several, all "
                         "talkers are brought to the first one's mean and scale, and corpus.toml in a folder tells "
                         "more")
    command.add_argument("-o", "--output", required=True, metavar="MODEL.npz")
    add_kind(command)
    command.add_argument("--method", choices=METHODS, default=METHODS[-1])
    add_fps(command)
    states, components = SIZES["laughter"]
    command.add_argument("--codebook", type=positive,
                         help=f"states per channel ({CODEBOOK}; Labial's of laughter {states})")
    command.add_argument("--components", type=positive, help=f"mixture components per phoneme ({COMPONENTS}; Labial's "
                         f"of laughter {components})")
    command.add_argument("--look-ahead", type=functools.partial(whole, 0, 360), metavar="MS", help="--method labial: "
                         f"how far the kernels reach into what follows, 0 .. 360 ms ({1000 * LOOK_AHEAD:.0f}); less "
                         "is less latency")
    command.add_argument("--search-stride", type=positive, metavar="FRAMES", help="--method labial: frames that "
                         f"share a state of the decoded path ({SEARCH_STRIDE}); 1 decodes every frame, as --method "
                         "paper always does")
    add_talker_variance(command)
    command.add_argument("--asymmetric", action="store_true", help="--method labial: learn each side of the mouth by "
                         "itself, as --method paper always does, instead of the mean of both")
    command.add_argument("--normalise", action="store_true", help="--method paper: divide features by their standard "
                         "deviations before they are clustered, as --method labial always does; the paper does "
                         "not")
    command.add_argument("--seed", type=seed, default=0)
    command.add_argument("--jobs", type=positive, default=os.cpu_count() or 1, help="processes; the result is the same")
    add_engine(command)
    command.add_argument("--adapt", metavar="MODEL", help="do not train: give a model that was trained with "
                         "--talker-variance the deviation of one talker, from half a minute of him or more")
    command.add_argument("--attribution", default="",
                         help="what whoever passes the model on must say; kept in the model")
    add_quiet(command, "bars")


def run_train(options: argparse.Namespace) -> None:
    with needs("training", "train"):
        from labial.train import backed_off, check_options, train, without_apex
    from labial.corpus import read_corpora
    from labial.tables.model import save

    check(options.output, ".npz")
    if options.adapt is not None:
        return _adapt(options)
    own = _labials_own(options)
    own.update((name, getattr(options, name)) for name in (
        "kind", "method", "fps", "codebook", "components", "jobs", "engine"))
    check_options(**own)
    corpora = read_corpora(options.corpus, options.kind,
                           even_sides=options.method == "labial" and not options.asymmetric)
    episodes = [episode for corpus in corpora for episode in corpus]
    seconds = _seconds(episodes)
    if options.kind == "speech" and 0.0 < seconds < LEAST:
        raise LabialError(f"{seconds:.1f} s of motion are too little to train on: {LEAST} s are the least, and a voice "
                          "needs minutes; --adapt gives a trained model the motion of one talker from half a minute")
    model = train(episodes, seed=options.seed, progress=shows_progress(options), attribution=options.attribution,
                  normalise=options.normalise, symmetric=not options.asymmetric, **own)
    save(model, options.output)
    if options.kind == "speech" and seconds < FEW:
        warnings.warn(f"{seconds:.0f} s of motion are little to train on: rare phonemes have the shapes of others; ten "
                      "minutes are better", stacklevel=1)
    for line in [*without_apex(episodes), *backed_off(model)]:
        print(line)
    print(f"{options.output}: {len(model.phonemes)} phonemes, {int(model.component_count.sum())} components, "
          f"{model.log_initial.shape[1]} states, {len(model.kernel_lag)} kernel taps")


def _seconds(episodes: Sequence[Episode]) -> float:
    return sum(float(episode.times[-1] - episode.times[0]) for episode in episodes)


def _adapt(options: argparse.Namespace) -> None:
    """``--adapt``: writes the model of one talker."""
    from labial.corpus.corpora import read_each
    from labial.tables.model import load, save
    from labial.train import adapted

    usual = argparse.ArgumentParser()
    add_train(usual)
    ignored = [name for name in _OF_TRAINING if getattr(options, name) != usual.get_default(name)]
    if ignored:
        names = " and ".join("--" + name.replace("_", "-") for name in ignored)
        warnings.warn(f"{names}: of no effect with --adapt", stacklevel=1)
    shared = load(options.adapt)
    episodes = [episode for corpus in read_each(options.corpus, shared.kind) for episode in corpus]
    seconds = _seconds(episodes)
    if seconds < LEAST_OF_TALKER:
        raise LabialError(f"{seconds:.1f} s of motion are too little to adapt a model to: {LEAST_OF_TALKER} s are the "
                          "least, and half a minute is better")
    model = adapted(shared, episodes, options.attribution)
    save(model, options.output)
    if seconds < FEW_OF_TALKER:
        warnings.warn(f"{seconds:.0f} s of motion are little to adapt a model to; half a minute is better",
                      stacklevel=1)
    about: Any = model.training["adapted"]
    print(f"{options.output}: {options.adapt}, adapted to {about['episodes']} episodes, "
          f"{about['frames'] / model.fps:.0f} s")


def _labials_own(options: argparse.Namespace) -> Dict[str, Any]:
    """The options of ``--method labial``; warns if an option has no effect with the chosen method."""
    own: Dict[str, Any] = {name: value for name in ("look_ahead", "search_stride", "talker_variance")
                           if (value := getattr(options, name)) is not None}
    if "look_ahead" in own:
        own["look_ahead"] /= 1000.0
    if own and options.method == "paper":
        names = " and ".join("--" + name.replace("_", "-") for name in own)
        warnings.warn(f"{names}: of no effect with --method paper", stacklevel=1)
    if options.normalise and options.method != "paper":
        warnings.warn("--normalise: --method labial always does", stacklevel=1)
    return own


def add_train_words(command: argparse.ArgumentParser) -> None:
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


def run_train_words(options: argparse.Namespace) -> None:
    with needs("training", "tools"):
        from labial.words import dictionary, tables, training

    check(options.output, ".npz")
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


def add_train_hear(command: argparse.ArgumentParser) -> None:
    command.add_argument("folder", nargs="+", metavar="FOLDER", help="sounds in any depth, each with timings or a text "
                         "(.txt) beside it, or with a metadata.csv in LJ Speech's layout")
    command.add_argument("-o", "--output", required=True, metavar="HEAR.npz")
    command.add_argument("--model", choices=("small", "large", "host", "ahead"), default="small",
                         help="size of the network: host and ahead are for computers, and ahead knows a frame 160 ms "
                         "later (small)")
    command.add_argument("--steps", type=positive, default=30000, help="batches of 160 s that are learned (30000)")
    command.add_argument("--rate", type=finite, default=0.003, help="of learning, its highest (0.003)")
    command.add_argument("--smoothness", type=finite, default=6.0, help="weight of the error of the frames' second "
                         "differences (6)")
    command.add_argument("--start", metavar="HEAR.npz", help="begin with what this model hears, which has as many "
                         "blocks and no more units, rather than anew")
    command.add_argument("--teacher", metavar="HEAR.npz", help="also learn what this model hears")
    command.add_argument("--taught", type=finite, default=0.5, help="with --teacher: its share where the truth is "
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


def run_train_hear(options: argparse.Namespace) -> None:
    with needs("training", "hear"):
        import torch  # noqa: F401
        from tqdm import tqdm

        from labial.hearing import clips, prepared, train
        from labial.hearing.model import load, save
    from labial.files.grammar import read_text

    check(options.output, ".npz")
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
    report = None if options.quiet else functools.partial(print, file=sys.stderr, flush=True)
    model = train.train(folders[:known], asked, checkpoint, report, Path(options.output),
                        start, folders[known:], teacher)
    save(model, options.output)
    Path(checkpoint).unlink()
    reached: Any = model.training["held_out"]
    print(f"{options.output}: {options.model}, {options.steps} steps; held out: "
          + ", ".join(f"{name} {value:g}" for name, value in reached.items()))


def _values(text: Any, option: str, count: int) -> Tuple[float, ...]:
    if text is None:
        return ()
    try:
        values = tuple(finite(item) for item in text.split(","))
    except argparse.ArgumentTypeError as error:
        raise LabialError(f"{option}: {error}") from None
    if len(values) != count:
        raise LabialError(f"{option}: {len(values)} numbers for {count} folders")
    return values


def _tell(bar: Any, done: int, total: int) -> None:
    bar.total = total
    bar.update(done - bar.n)
