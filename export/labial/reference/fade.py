"""How a delivered face passes to motion that begins anew, and to rest (``lib/fade.c``): a stream begins and ends with
the neutral face, all FAPs 0."""

from __future__ import annotations

from typing import Iterable, Iterator, Optional

import numpy as np

from labial.files.faps import CHANNELS, FAP_NUMBERS

#: Frames over which motion that begins anew fades in, unless a contact hurries it.
FADE = 8
#: Frames in which a face comes to rest, LABIAL_EASE_FRAMES.
EASE = 12
#: FAP units: lips that are no farther apart close in time by themselves.
CLOSED = 24
#: (13,) the channels of the jaw and the lips: FAPs 3, 51, 52 and 55 to 58.
CLOSING = np.isin(FAP_NUMBERS, (3, 51, 52, 55, 56, 57, 58))


def smooth(way: np.ndarray) -> np.ndarray:
    """How far transitions have gone at `way`, 0 .. 1: 3 s^2 - 2 s^3."""
    return way * way * (3.0 - 2.0 * way)


def closing_steps(held: np.ndarray, contact: np.ndarray) -> int:
    """Steps in which jaw and lips go from the pose `held` (13,) to motion that begins anew, whose frames are in contact
    as `contact` (T,) says: where lips that are apart must meet before the way's end, as many as lead to the second
    frame of their contact."""
    touching = np.flatnonzero(contact[:FADE])
    return FADE + 1 if -rounded(held)[3:5].sum() <= CLOSED or not len(touching) else int(touching[0]) + 2


def faded(held: np.ndarray, moved: np.ndarray, fresh: np.ndarray, step: int = 0, closing: int = FADE + 1) -> np.ndarray:
    """(T, 13): frames `fresh` (T, 13) of motion that began anew `step` frames before. The first FADE fade in from the
    pose `held` (13,), which goes on as far as its last frame `moved` it (13,), half as far with each frame; jaw and
    lips arrive with step `closing`."""
    steps = np.arange(step + 1, step + len(fresh) + 1)[:, None]
    base = held + moved * (1.0 - 0.5 ** np.minimum(steps, FADE))
    way = np.where(CLOSING, steps / closing, steps / (FADE + 1.0))
    return np.where(way >= 1.0, fresh, base + (fresh - base) * smooth(way))


def eased(held: np.ndarray, frames: int = EASE) -> np.ndarray:
    """(frames, 13): the way of the pose `held` (13,) to rest."""
    return held * (1.0 - smooth(np.arange(1, frames + 1)[:, None] / frames))


def rounded(pose: np.ndarray) -> np.ndarray:
    """The pose (13,) in whole FAP units, as the library rounds it, first to sixteenths."""
    return np.floor((np.rint(16.0 * pose) + 8.0) / 16.0)


def rests(pose: np.ndarray) -> bool:
    """Whether the pose (13,), FAP, is the neutral face."""
    return not rounded(pose).any()


def delivered_in_parts(parts: Iterable[np.ndarray], exact: bool = False) -> Iterator[np.ndarray]:
    """The frames of a stream whose motion comes in `parts` (n, 13): the first ones lead from rest to the motion and,
    unless only the `exact` frames of the phonemes are wanted, the face comes to rest after the last one."""
    still = np.zeros(CHANNELS)
    count = 0
    last: Optional[np.ndarray] = None
    for part in parts:
        fresh = faded(still, still, part, count)
        count += len(fresh)
        last = fresh[-1] if len(fresh) else last
        yield fresh
    if last is not None and not exact and not rests(last):
        yield eased(last)


def delivered(motion: np.ndarray, exact: bool = False) -> np.ndarray:
    """The frames (T, 13) of a stream with this `motion` (T, 13), as :func:`delivered_in_parts`."""
    return np.concatenate(list(delivered_in_parts([motion], exact)))
