"""The errors of integers and of deciding early in each step: the solver against float64, the window and the state paths
against solutions of the whole utterance.

A separate program, with numpy and the exporter on the path, that prints JSON:

    accuracy.py MODEL.npz NAME SOLVER KIND [CORPUS]

NAME is the bundled model's C name, SOLVER labial-bench-solve, KIND its name of the model. The phoneme streams are those
of the corpus's episodes, or random ones from the model.

    accuracy.py utterances MODEL.npz CORPUS

prints a corpus's utterances for labial-bench-delay: a line for each, phoneme numbers and milliseconds, alternating.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Dict, List, Sequence

import numpy as np

from labial.corpus import Episode, read_corpus
from labial.errors import LabialError
from labial.evaluate.loss import path_loss
from labial.reference.stream import aims, synthesise
from labial.reference.tables import ExportedTables, FloatTables
from labial.reference.trajectory import solve_whole
from labial.tables import emit
from labial.tables.model import Model, load
from labial.tables.phones import Stream, drawn_streams, stream_of
from labial.tables.quantise import ExportedModel, quantise

#: Episodes of a corpus that are used, evenly spread over it.
EPISODES = 60
#: Most frames of SOLVER, BENCH_SOLVE of unit.h.
LONGEST = 400


def said_in(model: Model, episode: Episode) -> Stream:
    return stream_of(episode.segments, model, round(1000 * episode.segments[0].start))


def corpus_streams(path: str, model: Model) -> List[Stream]:
    episodes = list(read_corpus(path, model.kind))
    chosen = np.unique(np.linspace(0, len(episodes) - 1, min(EPISODES, len(episodes))).astype(int))
    return [said_in(model, episodes[i]) for i in chosen]


def check_bundled(exported: ExportedModel, root: Path) -> None:
    """Raises LabialError if the bundled C tables are not those of the trained model."""
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as folder:
        emit.write(exported, Path(folder))
        name = f"{exported.name}.c"
        if (Path(folder) / name).read_bytes() != (root / "lib" / "models" / name).read_bytes():
            raise LabialError(f"lib/models/{name}: not what the trained model exports to; run labial export")


def solver_errors(tables: ExportedTables, solver: Sequence[str], streams: Sequence[Stream]) -> np.ndarray:
    """(frames, C) FAP, each 1/1024 of what positions can be (LABIAL_POSITION_MAX): the library's solution less the
    float64 one, for the same tables, paths and targets, streams being cut that are longer than its program takes."""
    given, expected = [], []
    for stream in streams:
        target, _, ends = aims(tables, stream)
        path = tables.search(target, ends)
        for begin in range(0, len(target), LONGEST):
            span = slice(begin, begin + LONGEST)
            expected.append(solve_whole(tables.equation(path[span], target[span])))
            given.append(np.uint16(len(expected[-1])).tobytes())
            for k in range(target.shape[1]):
                given.append(path[span, k].astype(np.uint8).tobytes() + target[span, k].astype(np.int16).tobytes())
    done = subprocess.run(list(solver), input=b"".join(given), stdout=subprocess.PIPE, check=True)
    found = np.frombuffer(done.stdout, dtype=np.int16)
    errors, begin = [], 0
    for solution in expected:
        size = solution.size
        own = found[begin : begin + size].reshape(solution.shape[1], -1).T
        errors.append(tables.to_fap(own) - solution)
        begin += size
    if begin != len(found):
        raise LabialError(f"{solver[0]}: {len(found)} positions, not {begin}")
    return np.concatenate(errors)


def measure(model: Model, exported: ExportedModel, solver: Sequence[str],
            streams: Sequence[Stream]) -> Dict[str, float]:
    ideal, tables = FloatTables(model), ExportedTables(exported)
    errors = solver_errors(tables, solver, streams)
    # The delivered motion, with a backward pass from each frame's window, less that of one from the last frame.
    lost_by_window = np.concatenate([synthesise(tables, stream) - synthesise(tables, stream, whole=True)
                                     for stream in streams])
    lost = np.concatenate([path_loss(ideal, tables, stream) for stream in streams])
    return {"solver_largest": float(np.abs(errors).max()),
            "solver_rms": float(np.sqrt(np.mean(errors**2))),
            "window_largest": float(np.abs(lost_by_window).max()),
            "window_rms": float(np.sqrt(np.mean(lost_by_window**2))),
            "path_state": float(lost.mean()),
            "path_worst_channel": float(lost.mean(axis=0).max())}


def main(arguments: List[str]) -> int:
    """Prints the figures as JSON, or utterances; status 1 and a message for invalid input."""
    try:
        if arguments[0] == "utterances":
            model = load(arguments[1])
            for episode in read_corpus(arguments[2], model.kind):
                print(" ".join(f"{phoneme} {milliseconds}" for phoneme, milliseconds in said_in(model, episode)))
            return 0
        path, name, solver, kind, *corpus = arguments
        model = load(path)
        exported = quantise(model, name)
        check_bundled(exported, Path(path).resolve().parents[2])
        streams = corpus_streams(corpus[0], model) if corpus else drawn_streams(model)
        print(json.dumps(measure(model, exported, [solver, kind], streams)))
    except LabialError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
