"""Compares the states of the run-time's search with those of a Viterbi search of whole units on the same tables.

    python -m labial.evaluate.search MODEL CORPUS [--every N]

MODEL is a model's file or the name of a bundled one, CORPUS a corpus whose phonemes are searched, of every Nth episode.
docs/method.md, What Labial adds, has the figures.
"""

from __future__ import annotations

import argparse
import sys
from typing import Dict, List, Optional, Tuple

import numpy as np

from labial.corpus import read_corpus
from labial.errors import LabialError
from labial.evaluate.loss import channel_extent
from labial.evaluate.material import utterances
from labial.files.grammar import positive
from labial.reference.published import viterbi
from labial.reference.stream import aims, synthesise
from labial.reference.tables import ExportedTables, Tables
from labial.reference.viterbi import Chains, block_at, looked_at, window
from labial.tables.bundled import MODEL_HELP
from labial.tables.fixed import SEARCHED
from labial.tables.model import load
from labial.tables.phones import Stream, phone_set
from labial.tables.quantise import quantise

#: The compared limits: LABIAL_LAG and LABIAL_SEARCHED.
LIMITS = ((0, SEARCHED), (0, 64), (9, SEARCHED), (9, 64), (40, SEARCHED), (40, 64))


def unit_by_unit(chains: Chains, positions: np.ndarray, units: np.ndarray, width: int) -> np.ndarray:
    """(B, C) the states of blocks with targets (B, C): the most probable path of every unit, searched as a whole from
    the last state of the previous unit. `units` (B, C) are the blocks that end a unit. Only the `width` states around
    the one nearest to the target are possible; no transition costs more than the largest cost in the tables."""
    states = chains.mean.shape[1]
    every = np.broadcast_to(np.arange(states), chains.mean.shape)
    emission = np.asarray(chains.emission(positions, every), dtype=np.float64)
    first = window(positions, chains.mean, min(width, states))[..., None]
    emission[(every < first) | (every >= first + width)] = np.inf
    path = np.empty(positions.shape, dtype=np.int64)
    for k in range(len(chains.mean)):
        transition, begin = np.minimum(chains.transition[k], chains.leap), 0
        start = chains.initial[k].astype(np.float64)
        for end in (np.flatnonzero(units[:, k]) + 1).tolist():
            path[begin:end, k] = viterbi(emission[begin:end, k], transition, start)
            begin, start = end, transition[path[end - 1, k]]
    return path


def units_path(tables: Tables, target: np.ndarray, ends: np.ndarray, width: int) -> np.ndarray:
    """(T, C) the states of :func:`unit_by_unit` for the frames of targets (T, C), of which `ends` (T,) end units."""
    channels = target.shape[1]
    number = block_at(len(target), tables.stride, channels=channels)
    units = np.zeros((int(number.max()) + 1, channels), dtype=bool)
    for k in range(channels):
        units[number[np.flatnonzero(ends), k], k] = True
    seen = np.take_along_axis(target, looked_at(len(target), tables.stride, len(units), channels=channels), axis=0)
    return np.take_along_axis(unit_by_unit(tables.chains, seen, units, width), number, axis=0)


def compare(tables: ExportedTables, streams: List[Stream], extent: np.ndarray) -> Dict[Tuple[int, int], np.ndarray]:
    """By LABIAL_LAG and LABIAL_SEARCHED, percent: states that differ from those of whole units among all states; and
    how far the motion is moved, RMS of the range (13,) of a channel, the mean of the channels."""
    differ = {limits: 0 for limits in LIMITS}
    moved: Dict[Tuple[int, int], List[np.ndarray]] = {limits: [] for limits in LIMITS}
    total = 0
    for stream in streams:
        target, _, ends = aims(tables, stream)
        wanted = units_path(tables, target, ends, 64)
        motion = synthesise(tables, stream, whole=True, lag=len(target), searched=64)
        total += wanted.size
        for lag, searched in LIMITS:
            differ[lag, searched] += int((tables.search(target, ends, lag, searched=searched) != wanted).sum())
            moved[lag, searched].append(synthesise(tables, stream, whole=True, lag=lag, searched=searched) - motion)
    far = {limits: np.sqrt(np.mean(np.concatenate(parts) ** 2, axis=0)) for limits, parts in moved.items()}
    return {limits: 100.0 * np.array([differ[limits] / total, np.mean(far[limits] / extent)]) for limits in LIMITS}


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line; see the module."""
    parser = argparse.ArgumentParser(prog="python -m labial.evaluate.search", description=__doc__.split("\n")[0])
    parser.add_argument("model", metavar="MODEL", help=MODEL_HELP)
    parser.add_argument("corpus", metavar="CORPUS", help="as for labial train")
    parser.add_argument("--every", type=positive, default=10, help="every so many episodes are searched (10)")
    options = parser.parse_args(arguments)
    try:
        model = load(options.model)
        corpus = utterances(read_corpus(options.corpus, model.kind)[:: options.every], phone_set(model), model.fps)
        extent = channel_extent(model, np.concatenate([item.human for item in corpus]))
        found = compare(ExportedTables(quantise(model, "model")), [item.timeline.stream for item in corpus], extent)
    except LabialError as error:
        print(f"search: {error}", file=sys.stderr)
        return 1
    print("| `LABIAL_LAG` | `LABIAL_SEARCHED` | other states, % | motion, % of range |\n|---|---|---|---|")
    for (lag, searched), (states, motion) in found.items():
        print(f"| {lag} | {searched} | {states:.2f} | {motion:.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
