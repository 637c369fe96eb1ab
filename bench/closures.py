"""Measures how often servos with limits of speed and acceleration close in p, b, m, and how far they open.

    closures.py SENTENCES.txt VOICE ...

prints a table for a jaw of 500 us. SENTENCES.txt has a sentence a line; a voice is flite's, `flite:slt`, or
espeak-ng's, `espeak:en-gb` or `espeak:en-us+f2`. It needs flite, espeak-ng, numpy and the exporter with the run-time on
the path.
"""

from __future__ import annotations

import subprocess
import sys
from array import array
from dataclasses import replace
from pathlib import Path
from typing import Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

import labial
from labial.bake.track import JAW
from labial.rig.description import Rig
from labial.rig.table import convert, expected
from labial.runtime.rig import Rig as Face

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples" / "pi"))

#: Limits of servos: units per frame, and per frame and frame: a common servo, a slow one, a heavy jaw.
SERVOS = ((None, None), (90, None), (90, 30), (60, None), (60, 20), (40, None), (40, 10))
#: Frames in sight; the last value is that of `labial bake`.
SIGHTS = (1, 6, 10, 32)
#: Frames that a closure may be early or late, and its tolerance in us.
AROUND, CLOSED = 1, 10
_STOPS = ("p", "b", "m")


class Said(NamedTuple):
    """A sentence's motion."""

    frames: np.ndarray  #: (T, 13) whole FAPs
    closures: List[Tuple[int, int]]  #: first frame and end of each p, b, m, a frame wider than spoken


def _flite(voice: str, text: str) -> List[Tuple[str, float]]:
    done = subprocess.run(["flite", "-voice", voice, "-t", text, "-psdur", "-o", "none"], check=True,
                          capture_output=True, text=True)
    items = [item.rpartition(":") for item in done.stdout.split()]
    ends = [0.0, *(float(end) for _, _, end in items)]
    return [(label, 1000.0 * (end - begin)) for (label, _, _), begin, end in zip(items, ends, ends[1:])]


def _timings(voice: str, texts: Sequence[str]) -> Iterator[List[Tuple[str, float]]]:
    engine, _, name = voice.partition(":")
    if engine == "espeak":
        from espeak import Espeak

        speaker = Espeak(name)
        return (speaker.say(text).timings for text in texts)
    return (_flite(name, text) for text in texts)


def moving(timings: Sequence[Tuple[str, float]]) -> Said:
    """The motion of phonemes with their milliseconds."""
    spoken = [(label or "SIL", round(length)) for label, length in timings]
    frames = np.asarray(labial.render(spoken, nearest=True), dtype=np.int64)
    closures, at = [], 0.0
    for label, length in timings:
        if label.strip("ˈˌː̩ʰ") in _STOPS:
            begin, end = int(at / 20.0) - AROUND, int((at + length) / 20.0) + 1 + AROUND
            closures.append((max(begin, 0), min(end, len(frames))))
        at += length
    return Said(frames, [span for span in closures if span[0] < span[1]])


def jaw(slew: Optional[int], acceleration: Optional[int]) -> Rig:
    """A jaw of 500 us with these limits."""
    described = replace(JAW.outputs[0], slew=slew or 0.0, acceleration=acceleration or 0.0)
    return replace(JAW, outputs=(described,))


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


def main(arguments: Sequence[str]) -> int:
    """Runs the command; returns its exit status."""
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    texts = [line for line in Path(arguments[0]).read_text(encoding="utf-8").splitlines() if line.strip()]
    said = [moving(timings) for voice in arguments[1:] for timings in _timings(voice, texts)]
    print(f"{sum(len(item.closures) for item in said)} p, b, m in {len(said)} sentences")
    print("slew acceleration | closed, opening with " + ", ".join(map(str, SIGHTS)) + " frames in sight")
    for slew, acceleration in SERVOS:
        described = jaw(slew, acceleration)
        cells = [measure(said, described, sight) for sight in SIGHTS]
        print(f"{slew or '-':>4} {acceleration or '-':>12} | " + "  ".join(f"{a:.3f} {b:.2f}" for a, b in cells))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
