"""Where Labial's method leaves the published one: a trained model with each departure taken back, on held-out data.

    python -m labial.evaluate.departures CORPUS [--kind laughter] [--splits N] [--jobs N] -o TABLE.md

Each row leaves one departure out, without training again, so that it tells what the others do without it.
docs/method.md, Where the default leaves the paper, has the figures.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from typing import Callable, Dict, List, Optional

import numpy as np

from labial.evaluate.choices import Task, compare, setting
from labial.evaluate.material import Timeline
from labial.reference import published, stream
from labial.reference.tables import FloatTables
from labial.tables.model import Model


def _as_the_run_time(model: Model, timeline: Timeline) -> np.ndarray:
    """(T, 13) FAP, as the device does it."""
    return stream.synthesise(FloatTables(model), timeline.stream)


def _over_all_states(model: Model, timeline: Timeline) -> np.ndarray:
    """The same, with each unit searched as a whole over all states."""
    states = model.log_initial.shape[1]
    return stream.synthesise(FloatTables(model), timeline.stream, lag=max(timeline.frames, 1), searched=states)


def _unit_by_unit(model: Model, timeline: Timeline) -> np.ndarray:
    """The same, with units that are searched, solved and joined as published."""
    tables = FloatTables(model)
    counts = timeline.length.tolist()
    target, contact, _ = stream.aims(tables, timeline.stream)
    cut = published.pieces(counts, model.boundary[timeline.phoneme].tolist())
    motion = []
    for piece in cut:
        frames = slice(piece.begin, piece.end)
        path = published.decode(tables, target[frames])
        motion.append(published.solve(tables.equation(path, target[frames], contact[frames])))
    return tables.complete(published.join(cut, motion))


def _without_contexts(model: Model) -> Model:
    none = np.zeros((len(model.log_weight), 0))
    return replace(model, log_previous=none, log_next=none)


@dataclass(frozen=True)
class Departure:
    """A departure and how to leave it out."""

    title: str
    back: Callable[[Model], Model] = lambda model: model
    synthesise: Callable[[Model, Timeline], np.ndarray] = _as_the_run_time


#: In the order in which a frame passes through them; the first row takes nothing back.
DEPARTURES = (
    Departure("nothing: Labial, float64"),
    Departure("context", _without_contexts),
    Departure("mean of the components: the best one alone", lambda model: replace(model, soft=False)),
    Departure("slopes of durations", lambda model: replace(model, slope=np.zeros_like(model.slope))),
    Departure("pairs", lambda model: replace(model, pair_key=model.pair_key[:0], pair_shape=model.pair_shape[:0])),
    Departure("temporal kernels", lambda model: replace(
        model, kernel=model.kernel[:, :0], kernel_lag=model.kernel_lag[:0])),
    Departure("floors, contact and rest", lambda model: replace(
        model, floor=np.full_like(model.floor, -np.inf), contact=np.zeros_like(model.contact))),
    Departure("anchors", lambda model: replace(model, state_anchor=np.zeros_like(model.state_anchor))),
    Departure("search of eight states, decided at once: whole units, all states", synthesise=_over_all_states),
    Departure("window of the solution: whole utterances", synthesise=lambda model, timeline: stream.synthesise(
        FloatTables(model), timeline.stream, whole=True)),
    Departure("continuous operation: units searched, solved and joined as published", synthesise=_unit_by_unit),
)


def run_split(task: Task) -> List[Dict[str, float]]:
    """The measures of every departure on one split, and those of the published method."""
    training, timelines, judge = setting(task)
    model, paper = training.model("labial"), FloatTables(training.model("paper"))
    motions = [[item.synthesise(item.back(model), timeline) for timeline in timelines] for item in DEPARTURES]
    motions.append([published.synthesise(paper, timeline.stream) for timeline in timelines])
    return [judge.measure(motion) for motion in motions]


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line; see the module."""
    titles = [*(item.title for item in DEPARTURES), "everything: the published method"]
    return compare("departures", __doc__.split("\n")[0], "taken back", lambda _: titles, run_split, 2, arguments)


if __name__ == "__main__":
    sys.exit(main())
