"""The meaning of FAPs on a head: by how many millimetres each of its points should move.

The units of FAPs are 1/1024 of the head's mouth-nose separation and mouth width. They follow the outer lips, whose
middles are about a millimetre further apart than the inner ones when these meet: in p, b, m of recorded talkers the
outer lips do not return to their rest position, though the lips are shut. `bend` subtracts this millimetre.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from labial.files.faps import FAP_NUMBERS
from labial.fit.head import Head

_COLUMN = {number: place for place, number in enumerate(FAP_NUMBERS)}
#: Millimetres by which outer lips are apart when inner ones meet, and from which opening on both open alike.
_LIFT, _ALIKE = 1.0, 8.0


def fap(frames: np.ndarray, number: int) -> np.ndarray:
    """(T,) of one FAP from (T, 13) frames."""
    return frames[:, _COLUMN[number]]


def bend(opening: np.ndarray) -> np.ndarray:
    """The opening of the inner lips, mm, from that of the outer ones, mm."""
    return np.maximum(opening - _LIFT * np.clip((_ALIKE - opening) / (_ALIKE - 1.0), 0.0, 1.0), 0.0)


class Row(NamedTuple):
    """One visible measure of a head."""

    name: str
    weight: float  #: how much a millimetre counts
    moves: np.ndarray  #: (K,) mm that weight 1 of each shape adds
    target: np.ndarray  #: (T,) mm that the FAPs mean
    rest: float  #: mm where the head rests; targets of gaps are whole, those of other rows are changes


def rows(head: Head, frames: np.ndarray) -> List[Row]:
    """All measures of the head's points with the FAPs' meaning, for (T, 13) frames. Gaps come first."""
    unit, wide = head.mns / 1024.0, head.mw / 1024.0
    found: List[Row] = []

    def gap(name: str, weight: float, upper: str, lower: str, high: int, low: int) -> None:
        if upper in head.rest and lower in head.rest:
            found.append(Row(name, weight, head.moves[upper][:, 1] - head.moves[lower][:, 1],
                             bend(-(fap(frames, high) + fap(frames, low)) * unit),
                             float(head.rest[upper][1] - head.rest[lower][1])))

    def point(name: str, weight: float, where: str, axis: int, number: int, sign: float) -> None:
        if where in head.rest:
            found.append(Row(name, weight, head.moves[where][:, axis], sign * fap(frames, number) * unit, 0.0))

    gap("opening", 3.0, "inner_upper", "inner_lower", 51, 52)
    gap("opening left", 1.5, "inner_upper_left", "inner_lower_left", 55, 57)
    gap("opening right", 1.5, "inner_upper_right", "inner_lower_right", 56, 58)
    found.append(Row("width", 1.5, head.moves["corner_left"][:, 0] - head.moves["corner_right"][:, 0],
                     (fap(frames, 53) + fap(frames, 54)) * wide, 0.0))
    outer = "outer" if "outer_upper" in head.rest and "outer_lower" in head.rest else "inner"
    point("upper lip", 1.5, f"{outer}_upper", 1, 51, -1.0)
    point("lower lip", 1.5, f"{outer}_lower", 1, 52, 1.0)
    for side, numbers in (("left", (55, 57, 59)), ("right", (56, 58, 60))):
        point(f"upper lip {side}", 0.5, f"outer_upper_{side}", 1, numbers[0], -1.0)
        point(f"lower lip {side}", 0.5, f"outer_lower_{side}", 1, numbers[1], 1.0)
        point(f"corner {side}", 0.7, f"corner_{side}", 1, numbers[2], 1.0)
    point("upper lip forward", 0.35, f"{outer}_upper", 2, 17, 1.0)
    point("lower lip forward", 0.15, f"{outer}_lower", 2, 16, 1.0)
    point("jaw", 0.35, "chin", 1, 3, -1.0)
    return found


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
    jaw: float  #: error of the chin's height; nan without a chin
    forward: float  #: error of how far both lips are pushed out
    closed: float  #: share of closures in which the inner lips come nearer than `CLOSED`
    through: float  #: share of closures in which they pass through each other by more than `THROUGH`
    deepest: float  #: smallest gap of all frames

    def text(self) -> str:
        """One line."""
        jaw = f"{self.jaw:.2f}" if np.isfinite(self.jaw) else "unmeasured (no chin)"
        return (f"opening {self.shown:.1f} mm of {self.meant:.1f} ({self.ratio:.2f}); errors, mm: opening "
                f"{self.opening:.2f}, width {self.width:.2f}, corners {self.corners:.2f}, upper lip {self.upper:.2f}, "
                f"lower lip {self.lower:.2f}, jaw {jaw}, forward {self.forward:.2f}; p, b, m closed "
                f"{self.closed:.3f}, through each other {self.through:.3f}, deepest {self.deepest:.1f} mm")


def shown(head: Head, weights: np.ndarray) -> Dict[str, np.ndarray]:
    """(T, 3) mm of each of the head's points where (T, K) weights of its shapes move it."""
    return {point: rest + weights @ head.moves[point] for point, rest in head.rest.items()}


def opening(head: Head, weights: np.ndarray) -> np.ndarray:
    """(T,) mm between the inner lips; below 0 they pass through each other."""
    return (head.rest["inner_upper"] - head.rest["inner_lower"])[1] + weights @ (
        head.moves["inner_upper"] - head.moves["inner_lower"])[:, 1]


def meant(head: Head, frames: np.ndarray) -> np.ndarray:
    """(T,) mm: the opening that (T, 13) frames mean, which is never negative."""
    return np.maximum(-(fap(frames, 51) + fap(frames, 52)) * head.mns / 1024.0, 0.0)


def crooked(head: Head, weights: np.ndarray, frames: np.ndarray) -> Tuple[float, float]:
    """Most millimetres by which (T, K) weights move the mouth sideways, and its corners differ in height, beyond what
    the (T, 13) frames mean."""
    points = shown(head, weights)
    left, right = (points[f"corner_{side}"] - head.rest[f"corner_{side}"] for side in ("left", "right"))
    aside = (left + right)[:, 0] / 2.0 - (fap(frames, 53) - fap(frames, 54)) * head.mw / 2048.0
    tilt = (left - right)[:, 1] - (fap(frames, 59) - fap(frames, 60)) * head.mns / 1024.0
    return float(np.abs(aside).max()), float(np.abs(tilt).max())


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
    wanted = meant(head, frames)
    nearest = np.array([gap[begin:end].min() for begin, end in closures])
    high, low = (float(np.percentile(values, 95)) for values in (gap, wanted))

    def mean(*names: str) -> float:
        present = [errors[name] for name in names if name in errors]
        return float(np.sqrt(np.mean(np.square(present)))) if present else float("nan")

    return Figures(high / low, high, low, float(np.sqrt(np.mean((gap - wanted) ** 2))), errors["width"],
                   mean("corner left", "corner right"), errors["upper lip"], errors["lower lip"], mean("jaw"),
                   mean("upper lip forward", "lower lip forward"), float(np.mean(nearest < CLOSED)),
                   float(np.mean(nearest < THROUGH)), float(gap.min()))
