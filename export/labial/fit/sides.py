"""Pairs of a left and a right shape, which a rig moves alike."""

from __future__ import annotations

from typing import Dict, List, Sequence, Set, Tuple

import numpy as np

from labial.fit.head import Head
from labial.fit.names import sided

#: A left and a right shape, by name.
Pair = Tuple[str, str]

#: Cosine between one shape and the other's mirror image, of which shapes that are called a pair are one, and of which
#: others are; and by how much it must exceed that between the shapes themselves.
_CALLED, _ALIKE, _BEYOND = 0.5, 0.9, 0.1


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
