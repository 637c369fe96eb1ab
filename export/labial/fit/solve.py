"""Solves for the rig with which heads show best, in millimetres, what FAPs mean on them.

The weight of shape k is ``clip(b_k + a_k . x, 0, cap_k)``, x being FAPs divided by 1024; b_k <= 0, so that FAP 0 is the
neutral face. Left and right shapes share a and b on mirrored FAPs. What is minimised, over frames of speech and the
heads alike:

    the squared errors of `meaning.rows`, weighted
    + gaps in p, b, m that are wider than `shut`, and gaps anywhere that are below `deep`, squared
    + the weights and their squares, so that few shapes work against each other
    + the coefficients, so that few are needed

The problem is not convex, and a descent from zero stalls. So the solver first finds the best weights of each frame
separately (accelerated projected gradient), then the rig nearest to them, and repeats both with a growing penalty on
their difference. Then it optimises the rig alone (L-BFGS) with a softened corner at 0, and finally removes the least
useful coefficients, one at a time.

Rigs are solved for, and judged on, sentences as motion: ``sentences.flite`` are 24 English sentences as flite times
them (``flite -voice VOICE -t SENTENCE -psdur -o none``), in turn by its voices kal, slt and rms: each phoneme with the
second at which it ends.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from labial.errors import DataError, PathLike
from labial.fit.head import Head, Pair, by_names
from labial.fit.meaning import fap, rows
from labial.runtime.render import render
from labial.runtime.stream import Stream
from labial.tables.visemes import ONE, VISEMES

#: The bundled sentences.
SENTENCES = Path(__file__).with_name("sentences.flite")
_FPS = 50
#: Seconds that a closure may be early or late.
_AROUND = 0.02


@dataclass(frozen=True)
class Motion:
    """Frames, and which phonemes they are of."""

    frames: np.ndarray  #: (T, 13) FAP units
    phonemes: Sequence[Tuple[str, int, int]]  #: label, first frame and end, a frame wider than spoken on either side
    shares: Optional[np.ndarray] = None  #: (T, 15) of the sounds in each frame, 0 .. 1; None if unknown

    @property
    def closures(self) -> List[Tuple[int, int]]:
        """First frame and end of each p, b, m."""
        return [(begin, end) for label, begin, end in self.phonemes if label in ("p", "b", "m")]

    @property
    def contact(self) -> np.ndarray:
        """(T,) bool: the frame of each closure in which the lips are nearest."""
        found = np.zeros(len(self.frames), dtype=bool)
        opening = -(fap(self.frames, 51) + fap(self.frames, 52))
        for begin, end in self.closures:
            found[begin + int(np.argmin(opening[begin:end]))] = True
        return found


def read_sentences(path: PathLike = SENTENCES, laughs: Sequence[float] = ()) -> Motion:
    """The motion of a file of sentences, one a line, with the bundled English model; after them laughs of these
    intensities, two seconds each. Raises DataError naming file and line."""
    parts: List[np.ndarray] = []
    shares: List[np.ndarray] = []
    phonemes: List[Tuple[str, int, int]] = []
    first = 0
    for number, line in enumerate(Path(path).read_text(encoding="ascii").splitlines(), 1):
        timings: List[Tuple[str, float, float]] = []
        begin = 0.0
        for item in line.split():
            label, _, last = item.partition(":")
            try:
                timings.append((label, begin, float(last)))
            except ValueError:
                raise DataError(os.fspath(path), number, f"{item!r} is not LABEL:SECONDS") from None
            begin = timings[-1][2]
        if not timings:
            continue
        with Stream(exact=True) as stream:
            for label, start, end in timings:
                stream.push(label, round(1000.0 * (end - start)))
            stream.end()
            spoken = list(stream)
        frames = np.array([frame.faps for frame in spoken])
        shares.append(np.array([frame.visemes for frame in spoken]) / ONE)
        for label, start, end in timings:
            phonemes.append((label, first + max(int((start - _AROUND) * _FPS), 0),
                             first + min(int((end + _AROUND) * _FPS) + 1, len(frames))))
        parts.append(frames)
        first += len(frames)
    for intensity in laughs:
        parts.append(np.asarray(render([(f"<laugh:{intensity:g}>", 2000), ("SIL", 200)], exact=True)))
        shares.append(np.eye(len(VISEMES))[np.zeros(len(parts[-1]), dtype=int)])  # silence, the first one
    return Motion(np.concatenate(parts).astype(np.float64), phonemes, np.concatenate(shares))


#: What an output may follow, in the names of a description; per side, with left and right alike.
FEATURES: Tuple[str, ...] = ("jaw", "push_b_lip", "push_t_lip", "upper_lip", "lower_lip", "spread", "corner")
#: Their spread in speech, FAP units / 1024: coefficients are compared after this.
_SPREAD = np.array([0.10, 0.06, 0.04, 0.05, 0.13, 0.02, 0.05])
#: Width of the corner at 0 that is rounded while the rig is optimised.
_SOFT = 0.004


@dataclass(frozen=True)
class Group:
    """Outputs that share coefficients: one in the middle, or a left and a right one."""

    name: str
    members: Tuple[Tuple[int, str], ...]  #: place among the shapes, and "left", "right" or "middle"


@dataclass
class Solution:
    """A rig: for each group its coefficients and threshold."""

    groups: List[Group]
    slopes: np.ndarray  #: (G, F) weight per FAP unit / 1024
    offsets: np.ndarray  #: (G,) at most 0
    caps: np.ndarray  #: (G,)


@dataclass(frozen=True)
class Wishes:
    """Requirements of a solution in addition to small errors."""

    shut: float = 0.0  #: mm between the inner lips in contact
    deep: float = -1.5  #: mm of gap below which lips pass through each other
    coefficients: int = 24  #: at most
    caps: Optional[Mapping[str, float]] = None  #: largest weight of a group, default 1
    costs: Optional[Mapping[str, float]] = None  #: dearer groups are used less, default 1
    allowed: Optional[Mapping[str, Sequence[str]]] = None  #: features of a group, default all
    #: Groups that are not solved for: weight per FAP unit / 1024 of each feature, and "offset".
    fixed: Optional[Mapping[str, Mapping[str, float]]] = None
    pairs: Optional[Sequence[Pair]] = None  #: left and right shapes, default those whose names say so


def groups_of(shapes: Sequence[str], pairs: Optional[Sequence[Pair]] = None) -> List[Group]:
    """The shapes, left and right ones together; a group of two is called by what their names begin with."""
    place = {name: number for number, name in enumerate(shapes)}
    pair_of = {name: pair for pair in (by_names(shapes) if pairs is None else pairs)
               if pair[0] in place and pair[1] in place for name in pair}
    found: Dict[Tuple[str, ...], Group] = {}
    for name in shapes:
        members = pair_of.get(name, (name,))
        sides = ("left", "right") if len(members) == 2 else ("middle",)
        found.setdefault(members, Group(os.path.commonprefix(members) or name,
                                        tuple((place[member], side) for member, side in zip(members, sides))))
    return list(found.values())


def features(frames: np.ndarray) -> Dict[str, np.ndarray]:
    """(T, F) of each side."""
    common = [fap(frames, 3), fap(frames, 16), fap(frames, 17), -fap(frames, 51), -fap(frames, 52)]

    def with_corner(stretch: np.ndarray, corner: np.ndarray) -> np.ndarray:
        return np.stack([*common, stretch, corner], axis=1) / 1024.0

    left, right = (with_corner(fap(frames, 53 + side), fap(frames, 59 + side)) for side in (0, 1))
    return {"left": left, "right": right, "middle": (left + right) / 2.0}


class Problem:
    """Heads, frames and wishes, ready to be solved."""

    def __init__(self, heads: Sequence[Head], motion: Motion, wishes: Wishes) -> None:
        shapes = heads[0].shapes
        assert all(head.shapes == shapes for head in heads)
        contact = motion.contact
        keep = contact.copy()
        keep[::3] = True  # neighbouring frames are nearly equal
        frames = motion.frames[keep].astype(np.float64)
        self.contact, self.wishes, self.count = contact[keep], wishes, len(frames)
        self.groups = groups_of(shapes, wishes.pairs)
        self.x = features(frames)
        self.heads = []
        for head in heads:
            table = rows(head, frames)
            self.heads.append((
                np.stack([row.moves for row in table]), np.stack([row.target - row.rest for row in table], axis=1),
                np.array([row.weight for row in table]) ** 2,
                [(place, row.rest, 1.0 if row.name == "opening" else 0.3) for place, row in enumerate(table)
                 if row.name.startswith("opening")],
            ))

        def per_group(given: Optional[Mapping[str, float]]) -> np.ndarray:
            return np.array([(given or {}).get(group.name, 1.0) for group in self.groups])

        self.caps, costs = per_group(wishes.caps), per_group(wishes.costs)
        #: Of every shape: its group, its place among the shapes and its side.
        self.members = [(number, *member) for number, group in enumerate(self.groups) for member in group.members]
        self.owner = np.array([number for number, _, _ in sorted(self.members, key=lambda member: member[1])])
        self.cap, self.cost = self.caps[self.owner], costs[self.owner]
        fixed = wishes.fixed or {}
        self.free_groups = np.array([group.name not in fixed for group in self.groups])
        self.allowed = np.array([[group.name not in fixed
                                  and feature in (wishes.allowed or {}).get(group.name, FEATURES)
                                  for feature in FEATURES] for group in self.groups])
        self.slopes = np.array([[fixed.get(group.name, {}).get(feature, 0.0) for feature in FEATURES]
                                for group in self.groups])
        self.offsets = np.array([fixed.get(group.name, {"offset": -0.02}).get("offset", 0.0) for group in self.groups])
        given = self.weights(self.slopes, self.offsets)[0]
        loose = self.free_groups[self.owner]
        self.low, self.high = np.where(loose, 0.0, given), np.where(loose, self.cap, given)

    def weights(self, slopes: np.ndarray, offsets: np.ndarray, soft: float = 0.0) -> Tuple[np.ndarray, np.ndarray]:
        """(T, K) weights, and their derivatives by what is clipped; `soft` rounds the corner at 0."""
        values = np.empty((self.count, len(self.owner)))
        slope = np.empty_like(values)
        for number, place, side in self.members:
            z = self.x[side] @ slopes[number] + offsets[number]
            cap = self.cap[place]
            if soft:
                t = np.clip(z / soft, -40.0, 40.0)
                raised = np.where(t < 30.0, soft * np.log1p(np.exp(t)), z)
                values[:, place] = np.minimum(raised, cap)
                slope[:, place] = np.where(raised < cap, 1.0 / (1.0 + np.exp(-t)), 0.02)
            else:
                values[:, place] = np.clip(z, 0.0, cap)
                slope[:, place] = (z > 0) & (z < cap)
        return values, slope

    def loss(self, weights: np.ndarray) -> Tuple[float, np.ndarray]:
        """What (T, K) weights cost, and the gradient."""
        total, gradient = 0.0, np.zeros_like(weights)
        touching = 12.0 * max(int(self.contact.sum()), 1)
        for moves, target, importance, gaps in self.heads:
            error = weights @ moves.T - target
            total += float(np.sum(error * error @ importance)) / self.count
            slope = 2.0 * error * importance / self.count
            for place, rest, share in gaps:
                gap = error[:, place] + target[:, place] + rest
                wide = np.where(self.contact, np.maximum(gap - self.wishes.shut, 0.0), 0.0)
                total += 192.0 * share * float(wide @ wide) / touching
                slope[:, place] += 384.0 * share * wide / touching
                through = np.maximum(self.wishes.deep - gap, 0.0)
                total += 36.0 * float(through @ through) / self.count
                slope[:, place] -= 72.0 * through / self.count
            gradient += slope @ moves
        total, gradient = total / len(self.heads), gradient / len(self.heads)
        total += float(np.sum(0.12 * self.cost * weights * weights + 0.08 * self.cost * weights)) / self.count
        gradient += (0.24 * self.cost * weights + 0.08 * self.cost) / self.count
        return total, gradient

    def free(self, steps: int, start: Optional[np.ndarray] = None, rig: Optional[np.ndarray] = None,
             tie: float = 0.0) -> np.ndarray:
        """The best (T, K) weights of each frame separately, tied to those of a rig: accelerated projected gradient."""
        steepest = 0.24 * float(self.cost.max()) + 2.0 * tie
        for moves, _, importance, gaps in self.heads:
            hinge = (384.0 * self.count / (12.0 * max(int(self.contact.sum()), 1)) + 72.0)
            steepest += (2.0 * np.linalg.norm(moves * np.sqrt(importance)[:, None], 2) ** 2
                         + hinge * sum(share * np.sum(moves[place] ** 2) for place, _, share in gaps)) / len(self.heads)
        found = self.low if start is None else start
        ahead, momentum = found, 1.0
        for _ in range(steps):
            slope = self.loss(ahead)[1] * self.count
            if rig is not None:
                slope = slope + 2.0 * tie * (ahead - rig)
            after = np.clip(ahead - slope / steepest, self.low, self.high)
            grown = (1.0 + np.sqrt(1.0 + 4.0 * momentum * momentum)) / 2.0
            ahead, found, momentum = after + (momentum - 1.0) / grown * (after - found), after, grown
        return found

    def nearest(self, wanted: np.ndarray, slopes: np.ndarray, offsets: np.ndarray) -> None:
        """Puts into `slopes` and `offsets` the rig that comes nearest to (T, K) weights: a least-squares fit per group
        over the frames in which either is above 0, repeated until these stay the same."""
        for number, group in enumerate(self.groups):
            if not self.free_groups[number]:
                continue
            use = self.allowed[number]
            scale = _SPREAD[use]
            design = np.concatenate([np.concatenate([self.x[side][:, use] / scale, np.ones((self.count, 1))], axis=1)
                                     for _, side in group.members])
            y = np.concatenate([wanted[:, place] for place, _ in group.members])
            guess = np.append(slopes[number, use] * scale, offsets[number])
            for step in range(10):
                on = (y > 0.004) | (design @ guess > 0.0)
                for columns in (design.shape[1], design.shape[1] - 1):  # again without an offset that would be above 0
                    part = design[on][:, :columns]
                    solved = np.zeros_like(guess)
                    solved[:columns] = np.linalg.solve(part.T @ part + np.eye(columns) * len(y) * 2e-4, part.T @ y[on])
                    if solved[-1] <= 0.0:
                        break
                change = float(np.abs(solved - guess).max())
                guess = solved if step < 6 else (solved + guess) / 2.0
                if change < 1e-4:
                    break
            slopes[number, use], offsets[number] = guess[:-1] / scale, min(guess[-1], 0.0)


def _descend(problem: Problem, slopes: np.ndarray, offsets: np.ndarray, live: np.ndarray,
             steps: int) -> Tuple[np.ndarray, np.ndarray]:
    """Optimises the rig from here on, with only the `live` (G, F) coefficients."""
    from scipy.optimize import minimize

    scaled = np.broadcast_to(_SPREAD, live.shape)[live]
    count = len(scaled)

    def unpack(packed: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        found = problem.slopes.copy()
        found[live] = packed[:count] / scaled
        return found, packed[count:]

    def cost(packed: np.ndarray) -> Tuple[float, np.ndarray]:
        a, b = unpack(packed)
        weights, slope = problem.weights(a, b, _SOFT)
        total, by_weight = problem.loss(weights)
        by_weight *= slope
        by_a, by_b = np.zeros(live.shape), np.zeros(len(b))
        for number, place, side in problem.members:
            by_a[number] += problem.x[side].T @ by_weight[:, place]
            by_b[number] += by_weight[:, place].sum()
        size = packed[:count]
        rounded = np.sqrt(size * size + 1e-6)
        total += 0.02 * float(np.sum(rounded)) + 0.3 * float(size @ size)
        return total, np.concatenate([by_a[live] / scaled + 0.02 * size / rounded + 0.6 * size, by_b])

    start = np.concatenate([slopes[live] * scaled, offsets])
    bounds = [(None, None)] * count + [(-0.6, 0.0) if free else (offset, offset)
                                       for free, offset in zip(problem.free_groups, offsets)]
    done = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": steps, "maxcor": 30})
    return unpack(done.x)


def solve(heads: Sequence[Head], motion: Motion, wishes: Wishes) -> Solution:
    """The rig of the heads' shapes, which all heads must have in the same order. Takes seconds."""
    problem = Problem(heads, motion, wishes)
    slopes, offsets = problem.slopes.copy(), problem.offsets.copy()
    weights = problem.free(200)
    for tie in np.geomspace(0.3, 300.0, 12):
        problem.nearest(weights, slopes, offsets)
        weights = problem.free(40, weights, problem.weights(slopes, offsets)[0], float(tie))
    problem.nearest(weights, slopes, offsets)
    live = problem.allowed & (slopes != 0.0)
    slopes, offsets = _descend(problem, slopes, offsets, live, 150)
    while True:
        # What a coefficient does: how far it moves its outputs, which the loss of one that is hardly on ignores.
        amount = np.zeros(slopes.shape)
        values = problem.weights(slopes, offsets)[0]
        for number, group in enumerate(problem.groups):
            on = max(float(values[:, place].max()) for place, _ in group.members)
            use = max(float((values[:, place] > 0.005).mean()) for place, _ in group.members)
            amount[number] = np.abs(slopes[number]) * _SPREAD * np.sqrt(use) * (on > 0.03)
        dead = live & (amount < 0.002)
        excess = int((live & ~dead).sum()) - wishes.coefficients
        if excess > 0:
            order = np.argsort(np.where(live & ~dead, amount, np.inf), axis=None)
            dead.flat[order[: max(1, excess // 4)]] = True
        if not dead.any():
            break
        live &= ~dead
        slopes, offsets = _descend(problem, np.where(live, slopes, 0.0), offsets, live, 40)
    slopes, offsets = _descend(problem, slopes, offsets, live, 300)
    return Solution(problem.groups, slopes, offsets, problem.caps)
