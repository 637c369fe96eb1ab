"""A head: a few points in millimetres, and the displacements that each of its shapes adds."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Mapping, Sequence, Tuple, Union

import numpy as np

from labial.errors import DataError

#: Points of a head. Left and right are the head's own; x grows to its left, y upwards, z forwards. `upper` and `lower`
#: are the middles of the lips, inner ones where the lips meet, outer ones on the red of the lips seen from the front;
#: with `_left` and `_right` halfway to the corners.
POINTS: Tuple[str, ...] = (
    "nose", "chin", "corner_left", "corner_right",
    "inner_upper", "inner_lower", "outer_upper", "outer_lower",
    "inner_upper_left", "inner_upper_right", "inner_lower_left", "inner_lower_right",
    "outer_upper_left", "outer_upper_right", "outer_lower_left", "outer_lower_right",
)  # fmt: skip

#: Required points.
NEEDED: Tuple[str, ...] = ("nose", "corner_left", "corner_right", "inner_upper", "inner_lower")

#: Columns of a table of lip points in Multi-PIE's numbering, whose 48 is the corner on the viewer's left: the face's
#: right one.
_MULTI_PIE: Mapping[str, str] = {
    "nose": "nose_base", "chin": "chin", "corner_right": "lip_48", "corner_left": "lip_54",
    "inner_upper": "lip_62", "inner_lower": "lip_66", "outer_upper": "lip_51", "outer_lower": "lip_57",
    "inner_upper_right": "lip_61", "inner_upper_left": "lip_63", "inner_lower_left": "lip_65",
    "inner_lower_right": "lip_67", "outer_upper_right": "lip_50", "outer_upper_left": "lip_52",
    "outer_lower_left": "lip_56", "outer_lower_right": "lip_58",
}  # fmt: skip

#: Millimetres between the nose's base and the inner upper lip of a grown-up, by which heads of unknown units are
#: scaled: that of ICT-FaceKit's mean head.
USUAL_MNS = 21.2


@dataclass(frozen=True)
class Head:
    """Points of a head and their displacements by its shapes, in millimetres."""

    name: str
    shapes: Tuple[str, ...]
    rest: Mapping[str, np.ndarray]  #: (3,) of each point; a point may be missing
    moves: Mapping[str, np.ndarray]  #: (K, 3) of each point: what weight 1 of each shape adds

    @property
    def mns(self) -> float:
        """Mouth-nose separation, MPEG-4's 9.15 to 2.2: from the nose's base down to the inner upper lip."""
        return float(self.rest["nose"][1] - self.rest["inner_upper"][1])

    @property
    def mw(self) -> float:
        """Mouth width, MPEG-4's 8.3 to 8.4: between the outer corners."""
        return float(self.rest["corner_left"][0] - self.rest["corner_right"][0])

    def only(self, shapes: Sequence[str]) -> Head:
        """The head with these shapes in this order; a missing shape moves nothing."""
        place = {name: number for number, name in enumerate(self.shapes)}
        still = np.zeros(3)
        moves = {point: np.stack([move[place[name]] if name in place else still for name in shapes])
                 for point, move in self.moves.items()}
        return Head(self.name, tuple(shapes), self.rest, moves)


def from_points(where: str, shapes: Sequence[str], rest: Mapping[str, np.ndarray],
                moves: Mapping[str, np.ndarray]) -> Head:
    """The head of these points of the file `where`. Raises DataError for an impossible position of the mouth."""
    missing = [point for point in NEEDED if point not in rest]
    if missing:
        raise DataError(where, None, f"these points are missing: {', '.join(missing)}")
    head = Head(Path(where).stem, tuple(shapes), rest, moves)
    if not head.mns > 0 or not head.mw > 0:
        raise DataError(where, None, "the nose must lie above the lips, and the left corner to the left of the right "
                        f"one: mouth to nose {head.mns:.3g}, width {head.mw:.3g}")
    return head


def read_table(path: Union[str, os.PathLike[str]]) -> Head:
    """A head from a CSV table, millimetres: a row ``neutral`` and one per shape; columns ``POINT_x``, ``POINT_y``,
    ``POINT_z``, where POINT is one of `POINTS` or a point of Multi-PIE (``lip_48`` .. ``lip_67``, ``chin``,
    ``nose_base``). Raises DataError naming file and line."""
    where = os.fspath(path)
    rows: Dict[str, np.ndarray] = {}
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        header = next(reader, [])
        if header[:1] != ["shape"] or len(header) < 4:
            raise DataError(where, 1, "the first line must name the columns: shape,POINT_x,POINT_y,POINT_z,...")
        for row in reader:
            if not row:
                continue
            try:
                values = np.array([float(value) for value in row[1:]])
            except ValueError:
                raise DataError(where, reader.line_num, "a value is no number") from None
            if len(row) != len(header) or not np.isfinite(values).all():
                raise DataError(where, reader.line_num, f"{len(header)} columns of finite numbers are needed")
            if row[0] in rows:
                raise DataError(where, reader.line_num, f"duplicate shape {row[0]!r}")
            rows[row[0]] = values
    if "neutral" not in rows or len(rows) < 2:
        raise DataError(where, None, "a row `neutral` and at least one shape are needed")
    place = {column: number for number, column in enumerate(header[1:])}
    shapes = [name for name in rows if name != "neutral"]
    rest, moves = {}, {}
    for point in POINTS:
        for prefix in (point, _MULTI_PIE[point]):
            columns = [f"{prefix}_{axis}" for axis in "xyz"]
            if all(column in place for column in columns):
                picked = [place[column] for column in columns]
                rest[point] = rows["neutral"][picked]
                moves[point] = np.stack([rows[shape][picked] for shape in shapes])
                break
    return from_points(where, shapes, rest, moves)
