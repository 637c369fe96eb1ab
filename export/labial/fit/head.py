"""A head: a few points in millimetres, and the displacements that each of its shapes adds.

Names of shapes are compared across spellings and tell sides; a left and a right shape are a pair, which a rig moves
alike.
"""

from __future__ import annotations

import csv
import os
import re
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Dict, Iterator, List, Mapping, Sequence, Set, Tuple

import numpy as np

from labial.errors import DataError, PathLike

#: Points of a head. Left and right are the head's own; x grows to its left, y upwards, z forwards. `upper` and `lower`
#: are the middles of the lips, inner ones where the lips meet, outer ones on the red of the lips seen from the front;
#: with `_left` and `_right` halfway to the corners.
POINTS: Tuple[str, ...] = (
    "nose", "chin", "corner_left", "corner_right",
    "inner_upper", "inner_lower", "outer_upper", "outer_lower",
    "inner_upper_left", "inner_upper_right", "inner_lower_left", "inner_lower_right",
    "outer_upper_left", "outer_upper_right", "outer_lower_left", "outer_lower_right",
)
#: Required points.
NEEDED: Tuple[str, ...] = ("nose", "corner_left", "corner_right", "inner_upper", "inner_lower")
#: Columns of a table of lip points in Multi-PIE's numbering, whose 48 is the face's right corner.
_MULTI_PIE: Mapping[str, str] = {
    "nose": "nose_base", "chin": "chin", "corner_right": "lip_48", "corner_left": "lip_54",
    "inner_upper": "lip_62", "inner_lower": "lip_66", "outer_upper": "lip_51", "outer_lower": "lip_57",
    "inner_upper_right": "lip_61", "inner_upper_left": "lip_63", "inner_lower_left": "lip_65",
    "inner_lower_right": "lip_67", "outer_upper_right": "lip_50", "outer_upper_left": "lip_52",
    "outer_lower_left": "lip_56", "outer_lower_right": "lip_58",
}
#: Millimetres from nose to mouth (`Head.mns`) of ICT-FaceKit's mean head, by which heads of unknown units are scaled.
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


def read_table(path: PathLike) -> Head:
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


#: A side in a name: a word anywhere, or a letter apart from others: ``L_smile``, ``smile.l``, ``smileL``, ``LSmile``.
_SIDE = re.compile(r"(?i:left|right|(?<![a-z])[lr](?![a-z]))|(?<=[a-z0-9])[LR](?![a-z])"
                   r"|(?<![A-Za-z])[LR](?=[A-Z][a-z])")
#: Sides looked at in one name.
_SIDES = 4
#: A left and a right shape, by name.
Pair = Tuple[str, str]
#: Cosine between one shape and the other's mirror image, of which shapes that are called a pair are one, and of which
#: others are; and by how much it must exceed that between the shapes themselves.
_CALLED, _ALIKE, _BEYOND = 0.5, 0.9, 0.1


def own(name: str) -> str:
    """A shape's name without its mesh's, which stands before a dot (Maya's ``blendShape1.jawOpen``). Sides and numbers
    behind a dot (Blender's ``mouthSmile.L``, ``jawOpen.001``) belong to the shape."""
    parts = name.split(".")
    first = len(parts) - 1
    while first > 0 and (parts[first].isdecimal() or parts[first].lower() in ("l", "r", "left", "right")):
        first -= 1
    return ".".join(parts[first:])


def _letters(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def plain(name: str) -> str:
    """A shape's name for comparing: its own, in lower case, letters and digits."""
    return _letters(own(name))


def sided(name: str) -> Iterator[Tuple[str, str]]:
    """The readings of a name: the plain name without a side, and that side, ``left`` or ``right``. ``brightLeft`` has
    two readings, of which the one that ``brightRight`` shares counts."""
    shape = own(name)
    for found in islice(_SIDE.finditer(shape), _SIDES):
        yield (_letters(shape[: found.start()] + " " + shape[found.end():]),
               "left" if found[0][0] in "lL" else "right")


def by_names(shapes: Sequence[str]) -> List[Pair]:
    """The pairs that are called so: names that differ in their side alone."""
    found: Dict[str, Dict[str, str]] = {}
    for shape in shapes:
        for base, side in sided(shape):
            found.setdefault(base, {}).setdefault(side, shape)
    pairs: List[Pair] = []
    taken: Set[str] = set()
    for sides in found.values():
        both = set(sides.values())
        if len(both) == 2 and taken.isdisjoint(both):
            pairs.append((sides["left"], sides["right"]))
            taken |= both
    return pairs


def of_head(head: Head) -> List[Pair]:
    """The pairs of a head: those that are called so and roughly mirror each other, which the phonemes L and R do not;
    and those that mirror each other, whatever they are called."""
    place = {shape: number for number, shape in enumerate(head.shapes)}
    other = {point: _other(point) for point in head.rest if _other(point) in head.rest}
    moves = _directions(np.stack([head.moves[point] for point in other], axis=1))
    mirrored = _directions(np.stack([head.moves[point] * (-1.0, 1.0, 1.0) for point in other.values()], axis=1))
    likeness = moves @ mirrored.T
    likeness[likeness < moves @ moves.T + _BEYOND] = 0.0
    pairs = [pair for pair in by_names(head.shapes) if likeness[place[pair[0]], place[pair[1]]] >= _CALLED]
    taken = [place[shape] for pair in pairs for shape in pair]
    likeness[taken], likeness[:, taken] = 0.0, 0.0
    best = likeness.argmax(axis=1)
    size = {side: sum(np.linalg.norm(head.moves[point], axis=1) for point in other if point.endswith(side))
            for side in ("_left", "_right")}
    leftness = size["_left"] - size["_right"]
    for one, two in enumerate(best):
        if one < two and best[two] == one and likeness[one, two] >= _ALIKE:
            left, right = (one, two) if leftness[one] >= leftness[two] else (two, one)
            pairs.append((head.shapes[left], head.shapes[right]))
    return pairs


def _other(point: str) -> str:
    """The point on the other side; a point in the middle is its own."""
    name, _, side = point.rpartition("_")
    return f"{name}_{'right' if side == 'left' else 'left'}" if side in ("left", "right") else point


def _directions(moves: np.ndarray) -> np.ndarray:
    """(K, 3 P) unit vectors of (K, P, 3) moves; 0 for what does not move."""
    flat = moves.reshape(len(moves), -1)
    return flat / np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)
