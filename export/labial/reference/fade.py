"""How a delivered face passes to motion that begins anew, and to rest (``lib/fade.c``): a stream begins and ends with
the neutral face, all FAPs 0."""

from __future__ import annotations

from typing import Iterable, Iterator, Optional

import numpy as np

from labial.files.faps import CHANNELS

#: Frames over which motion that begins anew fades in, unless a contact hurries it.
FADE = 8
#: Frames in which a face comes to rest, LABIAL_EASE_FRAMES.
EASE = 12
#: FAP units: a contact hurries no way that begins with a face no channel of which is farther from the neutral one.
NEAR = 8


def smooth(way: np.ndarray) -> np.ndarray:
    """(T, 1) how far a transition has gone at `way` (T,), 0 .. 1: 3 s^2 - 2 s^3."""
    result: np.ndarray = (way * way * (3.0 - 2.0 * way))[:, None]
    return result


def way_length(held: np.ndarray, contact: np.ndarray) -> int:
    """Steps from the pose `held` (13,) to motion that begins anew, the frames of which are in contact as `contact` (T,)
    says. Where the face is not near rest, it is there with the second frame of the first contact."""
    touching = np.flatnonzero(contact[:FADE])
    return FADE + 1 if within(held, NEAR) or not len(touching) else int(touching[0]) + 2


def faded(held: np.ndarray, moved: np.ndarray, fresh: np.ndarray, step: int = 0, length: int = FADE + 1) -> np.ndarray:
    """(T, 13): frames `fresh` (T, 13) of motion that began anew `step` frames before. The first ones fade in, in
    `length` steps, from the pose `held` (13,), which goes on as far as its last frame `moved` it (13,), half as far
    with each frame."""
    steps = np.arange(step + 1, step + len(fresh) + 1)
    base = held + moved * (1.0 - 0.5 ** np.minimum(steps, FADE)[:, None])
    result: np.ndarray = np.where(steps[:, None] >= length, fresh, base + (fresh - base) * smooth(steps / length))
    return result


def eased(held: np.ndarray, frames: int = EASE) -> np.ndarray:
    """(frames, 13): the way of the pose `held` (13,) to rest."""
    result: np.ndarray = held * (1.0 - smooth(np.arange(1, frames + 1) / frames))
    return result


def within(pose: np.ndarray, most: int) -> bool:
    """Whether no channel of the pose (13,), FAP, is more than `most` units from the neutral face, as the library rounds
    it, first to sixteenths."""
    return bool((np.abs(np.floor((np.rint(16.0 * pose) + 8.0) / 16.0)) <= most).all())


def rests(pose: np.ndarray) -> bool:
    """Whether the pose (13,), FAP, is the neutral face."""
    return within(pose, 0)


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
