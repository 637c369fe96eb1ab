"""The method as published: each unit is searched as a whole, solved as a whole, and cross-faded with the next.

The run-time continues search and solution from frame to frame instead, and is compared with this module: with models of
`--method paper` this is exactly the published method (docs/method.md, States to Equation 3); with `whole`, search and
solution cover the whole utterance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np

from labial.files.faps import CHANNELS
from labial.reference import stream
from labial.reference.stream import targets
from labial.reference.tables import Equation, Tables
from labial.reference.units import frame_counts

#: Most frames that are decoded at once, and most that two pieces share.
PIECE_MAX = 40
OVERLAP = 8


@dataclass(frozen=True)
class Piece:
    """Frames begin .. end - 1, of which the first `fade_in` are shared with the piece before and the last `fade_out`
    with the piece after."""

    begin: int
    end: int
    fade_in: int
    fade_out: int


def whole_piece(frames: Sequence[int]) -> List[Piece]:
    """One piece for the whole utterance."""
    total = sum(frames)
    return [Piece(0, total, 0, 0)] if total else []


def pieces(frames: Sequence[int], boundary: Sequence[bool], least: int = 1) -> List[Piece]:
    """Cuts phonemes of the given frames into pieces. A unit lasts from one boundary phoneme to the next, inclusive; a
    piece has as many units as `least` frames require (one in the published method) and PIECE_MAX allows. Neighbours
    share the boundary phoneme, its last OVERLAP frames if it is longer. A longer unit is cut, and the parts share
    OVERLAP frames. Phonemes without frames are omitted. The last phoneme always ends a unit."""
    spans = []
    start = 0
    for count, is_boundary in zip(frames, boundary):
        if count:
            spans.append((start, start + count, is_boundary))
            start += count
    result: List[Piece] = []
    begin = fade_in = 0
    while begin < start:
        limit = begin + PIECE_MAX
        end, fade_out = limit, OVERLAP
        for from_frame, to_frame, is_boundary in spans[:-1]:
            if is_boundary and from_frame >= begin + fade_in and from_frame > begin and to_frame <= limit:
                end, fade_out = to_frame, min(to_frame - from_frame, (to_frame - begin) // 2, OVERLAP)
                if end - begin >= least:
                    break
        else:
            if start <= limit:
                end, fade_out = start, 0
        result.append(Piece(begin, end, fade_in, fade_out))
        if not fade_out:
            break
        begin, fade_in = end - fade_out, fade_out
    return result


def synthesise(tables: Tables, phonemes: Sequence[Tuple[int, int]], *, whole: bool = False) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion of `phonemes`, pairs of phoneme number and milliseconds, decoded unit by
    unit, or with `whole` the utterance at once."""
    stream.check(tables, phonemes)
    numbers, durations = [number for number, _ in phonemes], [milliseconds for _, milliseconds in phonemes]
    frames = frame_counts(durations, tables.fps)
    if not sum(frames):
        return np.zeros((0, CHANNELS))
    cut = whole_piece(frames) if whole else pieces(frames, [bool(tables.boundary[number]) for number in numbers])
    target = targets(tables, numbers, durations, frames)
    motion = []
    for piece in cut:
        positions = target[piece.begin : piece.end]
        motion.append(solve(tables.equation(decode(tables, positions), positions)))
    return tables.complete(join(cut, motion))


def decode(tables: Tables, target: np.ndarray) -> np.ndarray:
    """(T, C) int64: the most probable state path for targets (T, C), a state for every stride's frames; the search
    sees the target of the middle frame, or of the later of two."""
    seen = target[looked_at(len(target), tables.stride)]
    states = np.arange(tables.chains.mean.shape[1])
    emission = tables.chains.emission(seen, np.broadcast_to(states, (len(tables.solved), len(states))))
    path = viterbi(emission, tables.chains.transition, tables.chains.initial)
    return np.repeat(path, tables.stride, axis=0)[: len(target)]


def viterbi(emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """The state path of least total cost. `emission` is (T, ..., Q), the cost of each state in each step; `transition`
    (..., Q, Q) that of going [from, to]; `initial` (..., Q) that of starting. Costs are negative log-probabilities,
    +inf forbids. Any leading axes (channels) are searched independently, each with its own tables. Returns (T, ...)
    int64. Ties go to the lower state, and for a step's predecessor to the lower predecessor."""
    emission = np.asarray(emission, dtype=np.float64)
    steps = len(emission)
    into = np.ascontiguousarray(np.swapaxes(transition, -1, -2), dtype=np.float64)  # [to, from]
    path = np.empty(emission.shape[:-1], dtype=np.int64)
    if steps == 0:
        return path
    back = np.empty(emission.shape, dtype=np.int64)
    cost = initial + emission[0]
    for t in range(1, steps):
        total = into + cost[..., None, :]
        back[t] = total.argmin(axis=-1)
        cost = np.take_along_axis(total, back[t][..., None], axis=-1)[..., 0] + emission[t]
    path[-1] = cost.argmin(axis=-1)
    for t in range(steps - 1, 0, -1):
        path[t - 1] = np.take_along_axis(back[t], path[t][..., None], axis=-1)[..., 0]
    return path


def looked_at(frames: int, stride: int) -> np.ndarray:
    """(S,) the frames among `frames` whose targets the search sees."""
    return np.minimum(np.arange(0, frames, stride) + stride // 2, frames - 1)


def path_cost(path: np.ndarray, emission: np.ndarray, transition: np.ndarray, initial: np.ndarray) -> np.ndarray:
    """(...) total cost of a path (T, ...) under the tables of :func:`viterbi`."""
    frames = len(path)
    index = tuple(np.indices(path.shape[1:]))
    cost = initial[index + (path[0],)] + emission[(0,) + index + (path[0],)]
    for t in range(1, frames):
        cost = cost + transition[index + (path[t - 1], path[t])] + emission[(t,) + index + (path[t],)]
    return cost


def solve(terms: Equation) -> np.ndarray:
    """(T, 13) trajectories m that solve (W' U^-1 W + A) m = W' U^-1 mu + A x, per channel. W stacks the static, delta
    ((m[t+1] - m[t-1]) / 2) and delta-delta (m[t+1] - 2 m[t] + m[t-1]) rows of every frame; those whose window would
    leave the piece are dropped. The matrix is pentadiagonal; it is factored as L D L'."""
    weight, mean = terms.weight.copy(), terms.mean
    frames = len(weight)
    weight[0, :, 1:] = 0.0
    weight[-1, :, 1:] = 0.0
    static, delta, delta2 = weight[..., 0], weight[..., 1] / 4.0, weight[..., 2]
    diagonal = static + terms.anchor + 4.0 * delta2
    diagonal[1:] += delta[:-1] + delta2[:-1]
    diagonal[:-1] += delta[1:] + delta2[1:]
    first = np.zeros_like(diagonal)  # [t, t + 1]
    first[:-1] = -2.0 * (delta2[:-1] + delta2[1:])
    second = np.zeros_like(diagonal)  # [t, t + 2]
    second[:-2] = (delta2 - delta)[1:-1]
    delta_pull, delta2_pull = 2.0 * delta * mean[..., 1], delta2 * mean[..., 2]
    right = static * mean[..., 0] + terms.anchor * terms.target - 2.0 * delta2_pull
    right[1:] += delta_pull[:-1] + delta2_pull[:-1]
    right[:-1] += delta2_pull[1:] - delta_pull[1:]
    return _solve_pentadiagonal(diagonal, first, second, right) if frames else right


def _solve_pentadiagonal(diagonal: np.ndarray, first: np.ndarray, second: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solves symmetric positive definite pentadiagonal systems, one per column; all arguments are (T, K)."""
    frames = len(diagonal)
    pivot, lower1, lower2, solution = (np.zeros_like(right) for _ in range(4))
    for t in range(frames):
        pivot[t] = diagonal[t]
        above = first[t].copy()
        solution[t] = right[t]
        if t >= 1:
            pivot[t] -= lower1[t - 1] ** 2 * pivot[t - 1]
            above -= lower2[t - 1] * lower1[t - 1] * pivot[t - 1]
            solution[t] -= lower1[t - 1] * solution[t - 1]
        if t >= 2:
            pivot[t] -= lower2[t - 2] ** 2 * pivot[t - 2]
            solution[t] -= lower2[t - 2] * solution[t - 2]
        lower1[t] = above / pivot[t]
        lower2[t] = second[t] / pivot[t]
    solution /= pivot
    for t in range(frames - 2, -1, -1):
        solution[t] -= lower1[t] * solution[t + 1]
        if t + 2 < frames:
            solution[t] -= lower2[t] * solution[t + 2]
    return solution


def join(pieces: Sequence[Piece], trajectories: Sequence[np.ndarray]) -> np.ndarray:
    """(T, 13): the pieces' trajectories in sequence, cross-faded linearly where two share frames."""
    result = np.zeros((pieces[-1].end if pieces else 0, trajectories[0].shape[1] if trajectories else 0))
    for piece, motion in zip(pieces, trajectories):
        fade = piece.fade_in
        share = (np.arange(1, fade + 1) / (fade + 1))[:, None]
        shared = slice(piece.begin, piece.begin + fade)
        result[shared] += (motion[:fade] - result[shared]) * share
        result[piece.begin + fade : piece.end] = motion[fade:]
    return result
