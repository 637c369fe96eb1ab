"""``labial train``: from corpora to a model, and from a model to that of one talker."""

from __future__ import annotations

import argparse
import functools
import os
import warnings
from typing import TYPE_CHECKING, Any, Dict, Sequence

from labial.commands.common import add_engine, add_fps, add_kind, add_quiet, add_talker_variance, shows_progress
from labial.defaults import CODEBOOK, COMPONENTS, LOOK_AHEAD, METHODS, SEARCH_STRIDE, SIZES
from labial.errors import LabialError, needs
from labial.files.arguments import positive, seed, whole

if TYPE_CHECKING:
    from labial.corpus.episode import Episode

#: Seconds of speech that a model is trained on at the least, and below which a warning says that it is little.
LEAST, FEW = 15, 120
#: The same of what a model is adapted to: what is learnt is less, the less there is.
LEAST_OF_TALKER, FEW_OF_TALKER = 5, 30

#: The options that ``--adapt`` does not use.
_OF_TRAINING = ("kind", "method", "fps", "codebook", "components", "look_ahead", "search_stride", "talker_variance",
                "asymmetric", "normalise", "seed", "engine")


def add_train(command: argparse.ArgumentParser) -> None:
    """Corpora, the method and its sizes, and the workers."""
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
    command.add_argument("--jobs", type=positive, default=os.cpu_count() or 1,
                         help="processes; the result is the same")
    add_engine(command)
    command.add_argument("--adapt", metavar="MODEL", help="do not train: give a model that was trained with "
                         "--talker-variance the deviation of one talker, from half a minute of him or more")
    command.add_argument("--attribution", default="",
                         help="what whoever passes the model on must say; kept in the model")
    add_quiet(command, "bars")


def run_train(options: argparse.Namespace) -> int:
    """Trains, writes the model, and prints unknown apexes and substitutes of phonemes."""
    with needs("training", "train"):
        from labial.train import backed_off, check_options, train, without_apex
    from labial.corpus import read_corpora
    from labial.files.outputs import check, check_suffix
    from labial.tables.model import save

    check(options.output)
    check_suffix(options.output, ".npz")
    if options.adapt is not None:
        return _adapt(options)
    own = _labials_own(options)
    check_options(kind=options.kind, method=options.method, fps=options.fps, codebook=options.codebook,
                  components=options.components, jobs=options.jobs, engine=options.engine, **own)
    corpora = read_corpora(options.corpus, options.kind,
                           even_sides=options.method == "labial" and not options.asymmetric)
    episodes = [episode for corpus in corpora for episode in corpus]
    seconds = _seconds(episodes)
    if options.kind == "speech" and 0.0 < seconds < LEAST:
        raise LabialError(f"{seconds:.1f} s of motion are too little to train on: {LEAST} s are the least, and a voice "
                          "needs minutes; --adapt gives a trained model the motion of one talker from half a minute")
    model = train(episodes, kind=options.kind, method=options.method, fps=options.fps,
                  codebook=options.codebook, components=options.components, seed=options.seed, jobs=options.jobs,
                  engine=options.engine, progress=shows_progress(options), attribution=options.attribution,
                  normalise=options.normalise, symmetric=not options.asymmetric, **own)
    save(model, options.output)
    if options.kind == "speech" and seconds < FEW:
        warnings.warn(f"{seconds:.0f} s of motion are little to train on: rare phonemes have the shapes of others; ten "
                      "minutes are better", stacklevel=1)
    for line in [*without_apex(episodes), *backed_off(model)]:
        print(line)
    print(f"{options.output}: {len(model.phonemes)} phonemes, {int(model.component_count.sum())} components, "
          f"{model.log_initial.shape[1]} states, {len(model.kernel_lag)} kernel taps")
    return 0


def _seconds(episodes: Sequence[Episode]) -> float:
    return sum(float(episode.times[-1] - episode.times[0]) for episode in episodes)


def _adapt(options: argparse.Namespace) -> int:
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
    return 0


def _labials_own(options: argparse.Namespace) -> Dict[str, Any]:
    """The options of ``--method labial``; warns if an option has no effect with the chosen method."""
    own: Dict[str, Any] = {}
    if options.look_ahead is not None:
        own["look_ahead"] = options.look_ahead / 1000.0
    if options.search_stride is not None:
        own["search_stride"] = options.search_stride
    if options.talker_variance is not None:
        own["talker_variance"] = options.talker_variance
    if own and options.method == "paper":
        names = " and ".join("--" + name.replace("_", "-") for name in own)
        warnings.warn(f"{names}: of no effect with --method paper", stacklevel=1)
    if options.normalise and options.method != "paper":
        warnings.warn("--normalise: --method labial always does", stacklevel=1)
    return own
