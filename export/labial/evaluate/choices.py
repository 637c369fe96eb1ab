"""Choices that the paper leaves open: the published method with each choice changed, on held-out data.

    python -m labial.evaluate.choices CORPUS [--kind laughter] [--splits N] [--jobs N] -o TABLE.md

Each choice is a constant or a function of the training or of the published reference, and is replaced during training
and synthesis. docs/reproduction.md has the tables.

:func:`compare`, variants of a method side by side, is also the command of :mod:`labial.evaluate.departures`.
"""

from __future__ import annotations

import argparse
import sys
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus import read_corpus
from labial.corpus.phonesets import PHONE_SETS, PhoneSet
from labial.defaults import FPS, KINDS
from labial.errors import LabialError
from labial.evaluate.material import Split, Timeline, Utterance, make_splits, utterances
from labial.evaluate.measures import Judge, judged_frames
from labial.evaluate.training import Training
from labial.files.faps import CHANNELS
from labial.files.grammar import positive, seed
from labial.files.outputs import check, writing
from labial.reference import published, synthesis
from labial.reference.stream import targets
from labial.reference.tables import FloatTables
from labial.tables.model import Model
from labial.train import codebook, pipeline, shapes, train
from labial.train.recordings import recordings
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
    """Markdown: variants by `titles` down, means over the splits across, of which each outcome has all variants'."""
    rows = [f"| {head} | " + " | ".join(name for name, _ in COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for index, title in enumerate(titles):
        values = [np.mean([split[index][measure] for split in outcomes]) for _, measure in COLUMNS]
        rows.append(f"| {title} | " + " | ".join(f"{value:.4f}" if i == 0 else f"{value:.3f}"
                                                 for i, value in enumerate(values)) + " |")
    return "\n".join(rows) + "\n"


def compare(name: str, description: str, head: str, titles: Callable[[str], Sequence[str]],
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


@dataclass(frozen=True)
class Choice:
    """A reading of the paper: its differences from ``--method paper``."""

    title: str
    replaced: Dict[Tuple[object, str], object] = field(default_factory=dict)  #: by module and name
    options: Dict[str, object] = field(default_factory=dict)  #: of :func:`labial.train.train`
    with_apex: bool = True  #: whether to use the sound's apex if the corpus states it
    whole: bool = False  #: utterances are searched and solved at once
    full: bool = False  #: states have full covariances


def _cut_in_the_middle(pieces: Sequence[published.Piece], trajectories: Sequence[np.ndarray]) -> np.ndarray:
    """:func:`labial.reference.published.join`, but pieces are cut in the middle of the frames that they share."""
    result = np.zeros((pieces[-1].end if pieces else 0, CHANNELS))
    for piece, motion in zip(pieces, trajectories):
        begin = piece.fade_in - piece.fade_in // 2
        result[piece.begin + begin : piece.end] = motion[begin:]
    return result


def _every_transition(paths: Sequence[np.ndarray], size: int, stride: int = 1) -> np.ndarray:
    """:func:`labial.train.codebook.transitions` with half a count added to every transition."""
    counts = np.full((size, size), 0.5)
    for path in paths:
        np.add.at(counts, (path[:-stride], path[stride:]), 1)
    return np.log(counts / counts.sum(axis=1, keepdims=True))


def _ending_units(phonemes: Sequence[str]) -> Dict[str, PhoneSet]:
    """The phone set of laughter with units that end at these phonemes."""
    given = PHONE_SETS["laughter"]
    return {"laughter": replace(given, boundary=tuple(label in phonemes for label in given.phonemes))}


#: The readings for both kinds; the first is that of ``--method paper``.
COMMON = (
    Choice("as `--method paper` does"),
    Choice("another seed of the mixtures (1)", options={"seed": 1}),
    Choice("another seed of the mixtures (2)", options={"seed": 2}),
    Choice("features normalised before clustering (`--normalise`)", options={"normalise": True}),
    Choice("states with full covariances", full=True),
    Choice("least variance of a state 1e-6 of the corpus's, not 1e-3", {(codebook, "VARIANCE_FLOOR"): 1e-6}),
    Choice("half a count for every transition, not only to neighbours", {(codebook, "transitions"): _every_transition}),
    Choice("five components from 10 samples on, not one for every 15", {(shapes, "SAMPLES_PER_COMPONENT"): 2}),
    Choice("regularisation of the mixtures 1e-6, not 0.02", {(shapes, "REGULARISATION"): 1e-6}),
    Choice("units join by a cut, not by a cross-fade", {(published, "join"): _cut_in_the_middle}),
    Choice("cross-fade of 20 frames at most, not 8", {(published, "OVERLAP"): published.PIECE_MAX // 2}),
    Choice("units of any length, not cut at 40 frames", {(published, "PIECE_MAX"): 10**6}),
    Choice("whole utterances, not units", whole=True),
)
#: By kind of corpus.
CHOICES: Dict[str, Tuple[Choice, ...]] = {
    "speech": (*COMMON, Choice("a phoneme's middle, not the apex of its sound", with_apex=False)),
    "laughter": (
        *COMMON,
        Choice("every phoneme ends a unit", {(pipeline, "PHONE_SETS"): _ending_units(PHONE_SETS["laughter"].phonemes)}),
        Choice("silence alone ends a unit", {(pipeline, "PHONE_SETS"): _ending_units(("silence",))}),
    ),
}


@contextmanager
def _made(choice: Choice) -> Iterator[None]:
    with ExitStack() as stack:
        for (module, name), value in choice.replaced.items():
            stack.callback(setattr, module, name, getattr(module, name))
            setattr(module, name, value)
        yield


def _motion(choice: Choice, training: Training, timelines: Sequence[Timeline]) -> List[np.ndarray]:
    """(T, 13) FAP of every timeline, by a model trained on the part with this choice made."""
    episodes = [item.episode for item in training.utterances]
    if not choice.with_apex:
        episodes = [replace(item, segments=tuple(replace(segment, apex=None) for segment in item.segments))
                    for item in episodes]
    options = {"seed": training.seed, **choice.options}
    with _made(choice):
        model = train(episodes, kind=training.phone_set.kind, method="paper", fps=training.fps, jobs=1, progress=False,
                      divide=training.divide, **options)  # type: ignore[arg-type]
        if choice.full:
            inverse = _inverse_covariances(model, training)
            return [_with_full_covariances(model, inverse, item) for item in timelines]
        return [synthesis.synthesise(model, item.stream, whole=choice.whole) for item in timelines]


def _inverse_covariances(model: Model, training: Training) -> np.ndarray:
    """(13, Q, 3, 3) the inverses of the full covariances of the cells that the states of a model are."""
    material = recordings([item.episode for item in training.utterances], training.phone_set, training.fps)
    states = model.log_initial.shape[1]
    inverse = np.empty((CHANNELS, states, 3, 3))
    for k in range(CHANNELS):
        points = np.concatenate([codebook.features(item.frames[:, k]) for item in material])
        _, cell, _ = training.divide(points, states)
        least = np.diag(np.maximum(codebook.VARIANCE_FLOOR * points.var(axis=0), 1e-6))
        means = np.stack([points[cell == q].mean(axis=0) for q in range(states)])
        for q, own in enumerate(np.lexsort((means[:, 2], means[:, 1], means[:, 0]))):
            inverse[k, q] = np.linalg.inv(np.cov(points[cell == own].T, bias=True) + least)
    return inverse


def _solve_full(model: Model, inverse: np.ndarray, path: np.ndarray) -> np.ndarray:
    """(T, 13): equation 3 for states (T, 13) whose inverse covariances are (13, Q, 3, 3), its matrix written out."""
    frames = len(path)
    window = np.zeros((frames, 3, frames))  # makes each frame's features of the positions
    at = np.arange(frames)
    window[at, 0, at] = 1.0
    inner = at[1:-1]
    window[inner, 1, inner - 1], window[inner, 1, inner + 1] = -0.5, 0.5
    window[inner, 2, inner - 1], window[inner, 2, inner], window[inner, 2, inner + 1] = 1.0, -2.0, 1.0
    result = np.empty((frames, CHANNELS))
    for k in range(CHANNELS):
        weight, mean = inverse[k, path[:, k]].copy(), model.state_mean[k, path[:, k]]
        for edge in (0, -1):  # delta rows that would leave the unit are dropped: what is left is m's own variance
            weight[edge] = np.diag([1.0 / np.linalg.inv(weight[edge])[0, 0], 0.0, 0.0])
        pulled = np.einsum("tfi,tfg->tig", window, weight)
        matrix = np.einsum("tig,tgj->ij", pulled, window)
        result[:, k] = np.linalg.solve(matrix, np.einsum("tig,tg->i", pulled, mean))
    return result


def _with_full_covariances(model: Model, inverse: np.ndarray, timeline: Timeline) -> np.ndarray:
    """(T, 13): :func:`labial.reference.published.synthesise` with full covariances in equation 3."""
    tables = FloatTables(model)
    target = targets(tables, timeline.phoneme.tolist(), timeline.milliseconds.tolist(), timeline.length.tolist())
    cut = published.pieces(timeline.length.tolist(), model.boundary[timeline.phoneme].tolist())
    paths = [published.decode(tables, target[piece.begin : piece.end]) for piece in cut]
    return published.join(cut, [_solve_full(model, inverse, path) for path in paths])


def run_split(task: Task) -> List[Dict[str, float]]:
    """The measures of every choice on one split."""
    training, timelines, judge = setting(task)
    return [judge.measure(_motion(choice, training, timelines)) for choice in CHOICES[training.phone_set.kind]]


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line; see the module."""
    return compare("choices", __doc__.split("\n")[0], "choice",
                   lambda kind: [choice.title for choice in CHOICES[kind]], run_split, 4, arguments)


if __name__ == "__main__":
    sys.exit(main())
