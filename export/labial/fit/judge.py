"""Judges weights on a head in millimetres: compares its lips with what the FAPs mean."""

from __future__ import annotations

from typing import Dict, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from labial.fit.head import Head
from labial.fit.meaning import fap, rows

#: Gap of the inner lips, mm, below which they count as closed, and below which they pass through each other.
CLOSED, THROUGH = 1.0, -2.5


class Figures(NamedTuple):
    """Figures of a head's motion. Lengths are millimetres; errors are root mean squares over all frames."""

    ratio: float  #: 95th percentile of the opening shown, divided by that of the opening meant
    shown: float  #: 95th percentile of the opening between the inner lips
    meant: float  #: the same of the opening that the FAPs mean
    opening: float  #: error of the opening
    width: float  #: error of the mouth's width
    corners: float  #: error of the corners' height
    upper: float  #: error of the upper lip's height
    lower: float  #: error of the lower lip's height
    jaw: float  #: error of the chin's height; nan where the chin is not known
    forward: float  #: error of how far both lips are pushed out
    closed: float  #: share of closures in which the inner lips come nearer than `CLOSED`
    through: float  #: share of closures in which they pass through each other by more than `THROUGH`
    deepest: float  #: smallest gap of all frames

    def text(self) -> str:
        """One line."""
        return (f"opening {self.shown:.1f} mm of {self.meant:.1f} ({self.ratio:.2f}); errors, mm: opening "
                f"{self.opening:.2f}, width {self.width:.2f}, corners {self.corners:.2f}, upper lip {self.upper:.2f}, "
                f"lower lip {self.lower:.2f}, jaw {self.jaw:.2f}, forward {self.forward:.2f}; p, b, m closed "
                f"{self.closed:.3f}, through each other {self.through:.3f}, deepest {self.deepest:.1f} mm")


def shown(head: Head, weights: np.ndarray) -> Dict[str, np.ndarray]:
    """(T, 3) mm of each of the head's points where (T, K) weights of its shapes move it."""
    return {point: rest + weights @ head.moves[point] for point, rest in head.rest.items()}


def opening(head: Head, weights: np.ndarray) -> np.ndarray:
    """(T,) mm between the inner lips; below 0 they pass through each other."""
    result: np.ndarray = (head.rest["inner_upper"] - head.rest["inner_lower"])[1] + weights @ (
        head.moves["inner_upper"] - head.moves["inner_lower"])[:, 1]
    return result


def matrix(head: Head, weights: Mapping[str, np.ndarray]) -> np.ndarray:
    """(T, K) weights in the order of the head's shapes, from weights by name; shapes that are not named are 0, and
    weights of shapes that the head lacks move nothing."""
    still = np.zeros(len(next(iter(weights.values()))))
    return np.stack([weights.get(name, still) for name in head.shapes], axis=1)


def judge(head: Head, weights: np.ndarray, frames: np.ndarray, closures: Sequence[Tuple[int, int]]) -> Figures:
    """Figures for the (T, K) weights of (T, 13) frames; `closures` are the frames, first and end, of p, b, m."""
    table = rows(head, frames)
    errors = {row.name: float(np.sqrt(np.mean((weights @ row.moves + row.rest - row.target) ** 2))) for row in table}
    gap = opening(head, weights)
    # The shown opening may be negative, the opening that the FAPs mean is not.
    meant = np.maximum(-(fap(frames, 51) + fap(frames, 52)) * head.mns / 1024.0, 0.0)
    nearest = np.array([gap[begin:end].min() for begin, end in closures])
    high, low = (float(np.percentile(values, 95)) for values in (gap, meant))

    def mean(*names: str) -> float:
        present = [errors[name] for name in names if name in errors]
        return float(np.sqrt(np.mean(np.square(present)))) if present else float("nan")

    return Figures(high / low, high, low, float(np.sqrt(np.mean((gap - meant) ** 2))), errors["width"],
                   mean("corner left", "corner right"), errors["upper lip"], errors["lower lip"], mean("jaw"),
                   mean("upper lip forward", "lower lip forward"), float(np.mean(nearest < CLOSED)),
                   float(np.mean(nearest < THROUGH)), float(gap.min()))
