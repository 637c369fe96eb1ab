"""Names of shapes: compared across spellings, and the side that one tells; pairs of a left and a right shape, which a
rig moves alike."""

from __future__ import annotations

import re
from itertools import islice
from typing import Dict, Iterator, List, Sequence, Set, Tuple

import numpy as np

from labial.fit.head import Head

#: A side in a name: a word anywhere, or a letter that stands apart from others: ``L_smile``, ``smile.l``, ``smileL``,
#: ``LSmile``.
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
    result: np.ndarray = flat / np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)
    return result
