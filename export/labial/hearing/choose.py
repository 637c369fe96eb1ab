"""How lips close by the scores of a trained network, chosen on takes that were held out of its training."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Dict, Iterator, List, Sequence, Tuple

import numpy as np

from labial.hearing.features import HOPS, normalise
from labial.hearing.measures import Figures, measured, pooled
from labial.hearing.model import HearingModel
from labial.hearing.network import Heard, closed, run, smoothed
from labial.hearing.prepared import Prepared

#: Scores of closed lips at which they begin to close, and by how much more they are closed, to choose from.
_BEGIN = (-3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0)
_WIDTH = (0.8, 1.5, 2.5, 3.5)
#: What a choice is judged by: correlation, closures, false ones per second and jerk above that of Labial's frames.
_WEIGHTS = (1.0, 0.5, 0.5, 0.25)
#: False closures per second, and jerk relative to Labial's, that cost nothing.
_FALSE, _JERK = 0.05, 1.05


@dataclass(frozen=True)
class Choice:
    """The scores at which lips begin to close and are closed, and what a model reaches with them."""

    edges: Tuple[float, float]
    reached: Figures

    def figures(self) -> Dict[str, float]:
        """The figures by name, rounded."""
        return {name: round(value, 4) for name, value in self.reached._asdict().items()}

    def __str__(self) -> str:
        return f"closes from {self.edges[0]:g} to {self.edges[1]:g}: {self.reached}"


def choose(model: HearingModel, folders: Sequence[Prepared], shares: np.ndarray) -> Choice:
    """The best edges by the takes of `folders`, which count by their `shares`."""
    heard = [[(run(model, features), frames, classes) for features, frames, classes in _takes(item)]
             for item in folders]
    best, chosen = -np.inf, None
    for begin, width in itertools.product(_BEGIN, _WIDTH):
        edges = (begin, begin + width)
        tried = replace(model, close_from=edges[0], close_to=edges[1])
        reached = pooled([_figures(tried, item) for item in heard], shares.tolist())
        value = worth(reached)
        if value > best:
            best, chosen = value, Choice(edges, reached)
    if chosen is None:
        raise ValueError("no takes are held out")
    return chosen


def worth(reached: Figures) -> float:
    """A number by which choices are compared; more is better."""
    correlation, closures, false, jerk = _WEIGHTS
    return (correlation * reached.opening + closures * reached.closed
            - false * max(reached.false - _FALSE, 0.0) - jerk * max(reached.jerk - _JERK, 0.0))


def _takes(item: Prepared) -> Iterator[Tuple[np.ndarray, np.ndarray, np.ndarray]]:
    ends = np.cumsum(item.lengths)
    for begin, end in zip(ends - item.lengths, ends):
        energies = item.energies[HOPS * begin : HOPS * end].astype(np.float32)
        yield normalise(energies).reshape(end - begin, -1), item.frames[begin:end], item.classes[begin:end]


def _figures(model: HearingModel, heard: List[Tuple[Heard, np.ndarray, np.ndarray]]) -> Figures:
    return measured([(frames, smoothed(closed(model, item).faps), classes) for item, frames, classes in heard])
