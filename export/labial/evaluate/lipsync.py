"""Compares lip-sync of several programs on one head, in millimetres, from weights in a folder.

    python -m labial.evaluate.lipsync HEAD FOLDER

HEAD is an avatar or a table of lip points, as for ``labial fit``. FOLDER has, for each utterance, its phonemes,
``NAME.lab``, the FAPs for comparison, ``NAME.csv``, and for each lip-sync ``NAME.LIPSYNC.jsonl``: lines as ``labial
synth --to arkit`` writes them, with ``time``, seconds, and an object of weights by the head's names of its shapes, or
by Oculus LipSync's.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Episode
from labial.corpus.folder import read_folder
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError, LabialError
from labial.files.grammar import read_lines
from labial.fit.avatar import read as read_avatar
from labial.fit.head import Head, read_table
from labial.fit.landmarks import read_head
from labial.fit.meaning import Figures, judge, matrix, meant, opening

#: Oculus's names that avatars spell in another way.
_OCULUS = {"ih": "I", "oh": "O", "ou": "U"}
#: Seconds that a closure may be early or late.
_AROUND = 0.02
COLUMNS = ("lip-sync", "opening, mm", "error, mm", "*p, b, m* closed", "gap, mm", "deepest, mm", "jerk, m/s\u00b3",
           "`r`")


class Row(NamedTuple):
    """Figures of a lip-sync on a head. Lengths are millimetres, of the gap between the inner lips."""

    figures: Figures
    gap: float  #: median of the smallest gaps in p, b, m; below 0 the lips pass through each other
    jerk: float  #: root mean square of the gap's third derivative, m/s^3
    correlation: float  #: of the gap and of what the FAPs mean

    def cells(self, name: str) -> str:
        """A row of the table."""
        f = self.figures
        return (f"| {name} | {f.shown:.1f} ({f.ratio:.2f}) | {f.opening:.2f} | {f.closed:.2f} | {self.gap:.1f} | "
                f"{f.deepest:.1f} | {self.jerk:.0f} | {self.correlation:.2f} |")


def read_weights(path: Path, head: Head, times: np.ndarray) -> np.ndarray:
    """(T, K) weights of the head's shapes at `times` (T,), between the lines of a file. Raises DataError, which names
    file and line, for what is no such line, and for a file that names none of the head's shapes."""
    rows: List[Tuple[float, Dict[str, float]]] = []
    for number, line in enumerate(read_lines(path), 1):
        if not line.strip():
            continue
        try:
            entry = json.loads(line)
            weights = next(value for key, value in entry.items() if isinstance(value, dict) and key != "faps")
            rows.append((float(entry["time"]), {str(key): float(value) for key, value in weights.items()}))
            late = len(rows) == 1 or rows[-1][0] > rows[-2][0]
            if not (late and np.isfinite([rows[-1][0], *rows[-1][1].values()]).all()
                    and rows[-1][1].keys() == rows[0][1].keys()):
                raise ValueError
        except (AttributeError, KeyError, StopIteration, TypeError, ValueError):
            raise DataError(path, number, "expected an object with a later time and the same weights, numbers, as the "
                            "lines before it") from None
    if not rows:
        raise DataError(path, None, "no frames")
    at = np.array([time for time, _ in rows])
    found = {}
    for name in rows[0][1]:
        shape = next((one for one in (name, f"viseme_{_OCULUS.get(name, name)}") if one in head.shapes), None)
        if shape:
            found[shape] = np.interp(times, at, [weights[name] for _, weights in rows])
    if not found:
        raise DataError(path, 1, f"none of these weights is a shape of {head.name}: {', '.join(rows[0][1])}")
    return matrix(head, found)


def compare(head: Head, episodes: Sequence[Episode], weights: Sequence[np.ndarray]) -> Row:
    """Figures of `weights`, (T, K) of each episode, on the head."""
    frames = np.concatenate([episode.frames for episode in episodes])
    every = np.concatenate(list(weights))
    gap = opening(head, every)
    wanted, closures = meant(head, frames), closures_of(episodes)
    return Row(judge(head, every, frames, closures),
               float(np.median([gap[begin:end].min() for begin, end in closures])), jerk(gap, episodes),
               float(np.corrcoef(gap, wanted)[0, 1]) if np.ptp(gap) and np.ptp(wanted) else float("nan"))


def closures_of(episodes: Sequence[Episode]) -> List[Tuple[int, int]]:
    """First frame and end of each p, b, m in the frames of all episodes. Raises LabialError where there is none."""
    found, first = [], 0
    for episode in episodes:
        for segment in episode.segments:
            # As in labial.fit.solve: from the last frame before the closure may begin to the last before its end.
            begin, end = np.searchsorted(episode.times, (segment.start - _AROUND, segment.end + _AROUND), side="right")
            if segment.label in ("P", "B", "M") and end > 0:
                found.append((first + max(int(begin) - 1, 0), first + int(end)))
        first += len(episode.times)
    if not found:
        raise LabialError("the folder's utterances have no p, b or m")
    return found


def jerk(gap: np.ndarray, episodes: Sequence[Episode]) -> float:
    """Root mean square of the third derivative of (T,) mm, within episodes, m/s^3."""
    parts, first = [], 0
    for episode in episodes:
        part = gap[first : first + len(episode.times)]
        parts.append(np.diff(part, 3) / np.mean(np.diff(episode.times)) ** 3 / 1000.0)
        first += len(episode.times)
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def lipsyncs(folder: Path, names: Sequence[str]) -> List[str]:
    """The lip-syncs in a folder. Raises DataError if one lacks an utterance."""
    found = sorted({path.name[len(name) + 1 : -len(".jsonl")] for name in names
                    for path in folder.glob(f"{name}.?*.jsonl")})
    for lipsync in found:
        for name in names:
            if not (folder / f"{name}.{lipsync}.jsonl").is_file():
                raise DataError(folder, None, f"no {name}.{lipsync}.jsonl with the weights of {lipsync}")
    if not found:
        raise DataError(folder, None, "no weights (NAME.LIPSYNC.jsonl)")
    return found


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line; see the module."""
    parser = argparse.ArgumentParser(prog="python -m labial.evaluate.lipsync", description=__doc__.split("\n")[0])
    parser.add_argument("head", metavar="HEAD", help="an avatar, or a .csv of lip points")
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    options = parser.parse_args(arguments)
    try:
        table = options.head.lower().endswith(".csv")
        head = read_table(options.head) if table else read_head(read_avatar(options.head), options.head, {}).head
        episodes = read_folder(options.folder, SPEECH)
        short = [episode.name for episode in episodes if len(episode.times) < 4]
        if short:
            raise LabialError(f"{short[0]}.csv has less than four frames")
        rows = {}
        for lipsync in lipsyncs(options.folder, [episode.name for episode in episodes]):
            weights = [read_weights(options.folder / f"{episode.name}.{lipsync}.jsonl", head, episode.times)
                       for episode in episodes]
            rows[lipsync] = compare(head, episodes, weights)
    except (LabialError, OSError) as error:
        print(f"lipsync: {error}", file=sys.stderr)
        return 1
    wanted = meant(head, np.concatenate([episode.frames for episode in episodes]))
    print(f"{len(episodes)} utterances, {sum(np.ptp(e.times) for e in episodes):.0f} s, {len(closures_of(episodes))} "
          f"p, b, m; the FAPs mean an opening of {np.percentile(wanted, 95):.1f} mm (95th percentile) and a jerk of "
          f"{jerk(wanted, episodes):.0f} m/s\u00b3\n")
    print(f"| {' | '.join(COLUMNS)} |\n|{'---|' * len(COLUMNS)}")
    for lipsync, row in rows.items():
        print(row.cells(lipsync))
    return 0


if __name__ == "__main__":
    sys.exit(main())
