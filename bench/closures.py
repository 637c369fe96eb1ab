"""Measures how often servos with limits of speed and acceleration close in p, b, m, and how far they open.

    closures.py SENTENCES.txt VOICE ...

prints how far the lips open in p, b, m and in f, v, and a table for a jaw of 500 us. SENTENCES.txt has a sentence a
line; a voice is flite's, `flite:slt`, or espeak-ng's, `espeak:en-us+f2`. It needs flite, espeak-ng, numpy and the
exporter with the run-time on the path.
"""

from __future__ import annotations

import sys
from array import array
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

import labial
from labial.bake.track import JAW
from labial.files.frames import opening
from labial.hearing.voices import speak
from labial.rig.description import Rig
from labial.rig.table import convert, expected
from labial.runtime.rig import Rig as Face

#: Limits of servos: units per frame, and per frame and frame: a common servo, a slow one, a heavy jaw.
SERVOS = ((None, None), (90, None), (90, 30), (60, None), (60, 20), (40, None), (40, 10))
#: Frames in sight; the last value is that of `labial bake`.
SIGHTS = (1, 6, 10, 32)
#: Frames that a closure may be early or late, and its tolerance in us.
AROUND, CLOSED = 1, 10
_STOPS = ("p", "b", "m")
_LABIODENTALS = ("f", "v")


class Said(NamedTuple):
    frames: np.ndarray  #: (T, 13) whole FAPs
    closures: List[Tuple[int, int]]  #: first frame and end of each p, b, m, a frame wider than spoken
    labiodentals: List[Tuple[int, int]]  #: those of each f, v


def moving(spoken: Sequence[Tuple[str, float]]) -> Said:
    pushed = [(label or "SIL", round(length)) for label, length in spoken]
    frames = np.asarray(labial.render(pushed, nearest=True, exact=True), dtype=np.int64)
    spans: Dict[str, List[Tuple[int, int]]] = {name: [] for name in (*_STOPS, *_LABIODENTALS)}
    at = 0.0
    for label, length in spoken:
        begin, end = int(at / 20.0) - AROUND, int((at + length) / 20.0) + 1 + AROUND
        span = max(begin, 0), min(end, len(frames))
        if span[0] < span[1]:
            spans.get(label.lower(), []).append(span)
        at += length

    def of(names: Sequence[str]) -> List[Tuple[int, int]]:
        return sorted(span for name in names for span in spans[name])

    return Said(frames, of(_STOPS), of(_LABIODENTALS))


def least_openings(frames: np.ndarray, spans: Sequence[Tuple[int, int]]) -> List[int]:
    """The least opening in each span, FAP units."""
    return [int(opening(frames)[begin:end].min()) for begin, end in spans]


def jaw(slew: Optional[int], acceleration: Optional[int]) -> Rig:
    return replace(JAW, outputs=(replace(JAW.outputs[0], slew=slew or 0.0, acceleration=acceleration or 0.0),))


def measure(said: Sequence[Said], described: Rig, sight: int) -> Tuple[float, float]:
    """The share of p, b, m that close, and the 95th percentile of the opening as a share of that without limits."""
    closed, opened, meant = [], [], []
    for item in said:
        values = np.array(Face.of(described).play(array("h", item.frames.astype(np.int16).tobytes()), sight))
        closed += [abs(values[begin:end] - 1400).min() <= CLOSED for begin, end in item.closures]
        opened.append(values - 1400)
        meant.append(expected(described, convert(described), item.frames)[:, 0] - 1400)
    share = np.percentile(np.concatenate(opened), 95) / np.percentile(np.concatenate(meant), 95)
    return float(np.mean(closed)), float(share)


def short_of_rest(said: Sequence[Said]) -> np.ndarray:
    """How far a jaw that only follows the opening stays above 1400 us in each p, b, m."""
    described = replace(JAW, outputs=(replace(JAW.outputs[0], closed=None, slew=0.0),))
    found = []
    for item in said:
        values = np.array(Face.of(described).play(array("h", item.frames.astype(np.int16).tobytes()), 1))
        found += [values[begin:end].min() - 1400 for begin, end in item.closures]
    return np.array(found)


def main(arguments: Sequence[str]) -> int:
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    texts = [line for line in Path(arguments[0]).read_text(encoding="utf-8").splitlines() if line.strip()]
    said = [moving([(segment.label, 1000.0 * (segment.end - segment.start)) for segment in spoken.segments])
            for voice in arguments[1:] for spoken in speak(voice, texts)]
    stops = [least for item in said for least in least_openings(item.frames, item.closures)]
    others = [least for item in said for least in least_openings(item.frames, item.labiodentals)]
    print(f"{len(stops)} p, b, m in {len(said)} sentences: at most {max(stops)} FAP units open")
    print(f"{len(others)} f, v: at least {np.percentile(others, 5):.0f} in 95 %, {np.median(others):.0f} in half")
    rests = short_of_rest(said)
    reach = 100 * np.mean(rests <= CLOSED)
    print(f"without `closed`: {np.median(rests):.0f} us short in the median, {reach:.0f} % reach it")
    print("slew acceleration | closed, opening with " + ", ".join(map(str, SIGHTS)) + " frames in sight")
    for slew, acceleration in SERVOS:
        described = jaw(slew, acceleration)
        cells = [measure(said, described, sight) for sight in SIGHTS]
        print(f"{slew or '-':>4} {acceleration or '-':>12} | " + "  ".join(f"{a:.3f} {b:.2f}" for a, b in cells))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
