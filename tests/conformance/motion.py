"""What a conformance stream's frames should be, in float64: the exporter's reference of each step, and here what it
leaves to the stream - passing from model to model, cancelling, taking up again (``lib/units.c``, ``lib/stream.c``)."""

from __future__ import annotations

from typing import Dict, List, Sequence, Tuple

import numpy as np

from labial.faps import CHANNELS
from labial.reference.shape import targets
from labial.reference.stream import frame_counts
from labial.reference.tables import Tables
from labial.reference.trajectory import join, solve
from labial.reference.units import OVERLAP, PIECE, WINDOW, Piece
from scripts import Part, Script, ease_frames


def mixed_pieces(frames: Sequence[int], boundary: Sequence[bool], model: Sequence[str]) -> List[Tuple[Piece, str]]:
    """As :func:`labial.reference.units.pieces`, for phonemes of several models; each piece with its own.

    A run of one model's phonemes is cut as if it were alone, but its last piece runs on over the next run: for OVERLAP
    frames, the rest of the window, the length of that run or its own frames of the first, whichever is least.
    """
    spans = []
    at = 0
    for count, is_boundary, name in zip(frames, boundary, model):
        if count:
            spans.append((at, at + count, is_boundary, name))
            at += count
    result: List[Tuple[Piece, str]] = []
    begin = fade_in = 0
    while begin < at:
        own = next(name for first, last, _, name in spans if first <= begin < last)
        change = next((first for first, _, _, name in spans if first > begin and name != own), at)
        after = next((first for first, _, _, name in spans if first > change and name == own), at)
        limit = begin + WINDOW
        end, fade_out = limit, OVERLAP
        for first, last, is_boundary, _ in spans[:-1]:
            if is_boundary and max(begin + fade_in, begin + 1) <= first < change and last <= limit:
                end, fade_out = last, min(last - first, (last - begin) // 2, OVERLAP)
                if end - begin >= PIECE:
                    break
        else:
            if change < limit or change == at == limit:
                fade_out = min(OVERLAP, limit - change, after - change, change - begin)
                end = change + fade_out
        result.append((Piece(begin, end, fade_in, fade_out), own))
        if not fade_out:
            break
        begin, fade_in = end - fade_out, fade_out
    return result


def part_motion(tables: Dict[str, Tables], part: Part, held: np.ndarray, resumed: bool) -> np.ndarray:
    """(T, 13) float64, FAP: the frames of one part up to its end or cancel, without easing. `held` (13,) is the pose
    from which it fades in when it is `resumed`."""
    rate = tables["speech"].fps
    durations = [push.milliseconds for push in part.pushes]
    frames = frame_counts(durations, rate)
    names = [push.model for push in part.pushes]
    boundary = [bool(tables[push.model].boundary[push.phoneme]) for push in part.pushes]
    wanted = part.cancel[0] if part.cancel else sum(frames)
    cut = [(piece, name) for piece, name in mixed_pieces(frames, boundary, names) if piece.begin < wanted]
    if not cut:
        return np.zeros((0, CHANNELS))
    # Each model takes the other's phonemes for silence.
    aims = {name: targets(tables[name], [push.phoneme if push.model == name else tables[name].silence
                                         for push in part.pushes], durations, frames) for name in set(names)}
    motion = []
    for piece, name in cut:
        aim = aims[name][piece.begin : piece.end]
        motion.append(solve(tables[name].equation(tables[name].search(aim), aim)))
    pieces = [piece for piece, _ in cut]
    if resumed:
        first = pieces[0]
        fade = min(first.end - first.begin - first.fade_out, OVERLAP)
        motion[0][:fade] = held + (motion[0][:fade] - held) * smooth(np.arange(1, fade + 1) / (fade + 1))
    return join(pieces, motion)[:wanted]


def smooth(s: np.ndarray) -> np.ndarray:
    """(T, 1) how far a transition has gone at `s` (T,), 0 .. 1."""
    return (s * s * (3.0 - 2.0 * s))[:, None]


def script_motion(tables: Dict[str, Tables], script: Script) -> np.ndarray:
    """(T, 13) float64, FAP: all frames of a stream."""
    rate = tables["speech"].fps
    held = np.zeros(CHANNELS)
    shown: List[np.ndarray] = [np.zeros((0, CHANNELS))]
    for part in script.parts:
        resumed = any(len(frames) for frames in shown)
        motion = part_motion(tables, part, held, resumed)
        shown.append(motion)
        if len(motion):
            held = np.floor(motion[-1] + 0.5)  # what the program was given
        if part.cancel:
            eased = [part.cancel[1], *(milliseconds for _, milliseconds in part.again)]
            until = [frames for frames, _ in part.again]
            for milliseconds, frames in zip(eased, [*until, None]):
                length = ease_frames(milliseconds, rate)
                shown.append((held * (1.0 - smooth(np.arange(1, length + 1) / length)))[:frames])
                if len(shown[-1]):
                    held = np.floor(shown[-1][-1] + 0.5)
            held = np.zeros(CHANNELS)
    return np.concatenate(shown)
