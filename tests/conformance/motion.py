"""What a conformance stream's frames should be, in float64: the exporter's reference of each step, and here what it
leaves to the stream - passing from model to model, cancelling, taking up again (``lib/units.c``, ``lib/stream.c``)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.files.faps import CHANNELS
from labial.reference.fade import FADE, closing_steps, eased, faded, rests
from labial.reference.stream import aims, gains, solution
from labial.reference.tables import Tables
from labial.reference.trajectory import WINDOW
from labial.reference.units import frame_counts
from labial.reference.viterbi import LAG
from scripts import Part, Push, Script, ease_frames


@dataclass(frozen=True)
class Run:
    """Phonemes of one model that follow each other, with their frames: what is solved at once, as if silence were
    before and after."""

    model: str
    begin: int  #: frame of the part
    phonemes: Tuple[Tuple[int, int], ...]
    counts: Tuple[int, ...]


def runs(pushes: Sequence[Push], fps: int) -> List[Run]:
    """The runs of a part. Phonemes without frames leave no trace but their time."""
    counts = frame_counts([push.milliseconds for push in pushes], fps)
    held = [(push, count) for push, count in zip(pushes, counts) if count]
    result: List[Run] = []
    begin = 0
    for model, group in groupby(held, key=lambda item: item[0].model):
        own = list(group)
        result.append(Run(model, begin, tuple((push.phoneme, push.milliseconds) for push, _ in own),
                          tuple(count for _, count in own)))
        begin += sum(result[-1].counts)
    return result


def part_gain(part: Part, frames: int, stride: int, percent: int, window: int = WINDOW, lag: int = LAG) -> np.ndarray:
    """(frames, 13) the articulation of the frames of a part, which begins with `percent`. When n frames are delivered,
    n and the delay are taken in."""
    wanted = np.full(frames, percent)
    for after, later in part.articulation:
        wanted[after + window + lag + stride if after else 0 :] = later
    return gains(wanted, stride, lag)


def part_motion(
    tables: Dict[str, Tables], part: Part, held: np.ndarray, percent: int = 100, **limits: int
) -> np.ndarray:
    """(T, 13) float64, FAP: the frames of one part up to its end or cancel, without the way to rest. `held` (13,) is
    the pose from which it fades in; `percent` the articulation that it begins with; `limits` are the
    `window`, `lag` and `searched` of a library that is built for others. A contact is known as far ahead as a frame
    that is taken in waits for its delivery."""
    motion = np.zeros((0, CHANNELS))
    faded_until = 0  # the frame behind the last that a fade has touched
    own_runs = runs(part.pushes, tables["speech"].fps)
    until = [run.begin + sum(run.counts) for run in own_runs]
    gain = part_gain(part, max(until, default=0), tables["speech"].stride, percent,
                     **{name: value for name, value in limits.items() if name != "searched"})
    for run, end in zip(own_runs, until):
        own = tables[run.model]
        articulated = gain[run.begin : end, : len(own.solved)]
        target, contact, ends = aims(own, run.phonemes, run.counts)
        fresh = solution(own, target, contact, ends, articulated, begin=run.begin, **limits)
        stands = run.begin < 2 or run.begin <= faded_until
        moved = np.zeros(CHANNELS) if stands else motion[-1] - motion[-2]
        pose = motion[-1] if run.begin else held
        delay = limits.get("window", WINDOW) + limits.get("lag", LAG) + own.stride
        closing = closing_steps(pose, contact[: delay + 1].any(axis=1))
        fresh = faded(pose, moved, fresh, closing=closing)
        faded_until = run.begin + FADE
        motion = np.concatenate([motion, fresh])
    return motion[: part.cancel[0]] if part.cancel else motion


def script_motion(tables: Dict[str, Tables], script: Script, **limits: int) -> np.ndarray:
    """(T, 13) float64, FAP: all frames of a stream; `limits` as in :func:`part_motion`."""
    rate = tables["speech"].fps
    held, percent = np.zeros(CHANNELS), 100
    shown: List[np.ndarray] = [np.zeros((0, CHANNELS))]
    for part in script.parts:
        motion = part_motion(tables, part, held, percent, **limits)
        percent = part.articulation[-1][1] if part.articulation else percent
        shown.append(motion)
        held = motion[-1] if len(motion) else held
        if part.cancel:
            over = [part.cancel[1], *(milliseconds for _, milliseconds in part.again)]
            until = [frames for frames, _ in part.again]
            for milliseconds, frames in zip(over, [*until, None]):
                length = ease_frames(milliseconds, rate)
                shown.append(eased(held, length)[:frames])
                held = shown[-1][-1] if len(shown[-1]) else held
            held = np.zeros(CHANNELS)
        elif not rests(held):
            shown.append(eased(held))
            held = np.zeros(CHANNELS)
    return np.concatenate(shown)
