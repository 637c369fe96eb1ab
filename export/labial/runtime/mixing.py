"""Lips from phonemes and from the sound, mixed."""

from __future__ import annotations

import math
from typing import Iterable, List, Sequence, Tuple, Union

from labial.core.guard import number
from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.runtime.rig import faps_of
from labial.runtime.stream import Frame

#: The share of the sound's lips that is nearest to people's where the phonemes are known (docs/hearing.md).
SHARE = 0.3
#: Openings of the phonemes' lips, FAP units: up to the first one the sound has no say over lips and jaw, from the
#: second one on its whole share.
_CLOSED, _FREE = 72.0, 200.0
_UPPER, _LOWER = FAP_NUMBERS.index(51), FAP_NUMBERS.index(52)
#: The jaw, and what moves lips up and down, but for their corners.
_LIPS = tuple(FAP_NUMBERS.index(fap) for fap in (3, 51, 52, 55, 56, 57, 58))

Pose = Union[Frame, Sequence[float]]


def with_sound(spoken: Iterable[Pose], heard: Iterable[Pose],
               share: Union[float, Sequence[float]] = SHARE) -> List[Tuple[int, ...]]:
    """Frames of phonemes with a share of the frames that are heard in their sound.

    The phonemes tell what is said, the sound how: which syllables are stressed, and when exactly. So the mix is nearer
    to people's lips than either. Closures are the phonemes': lips that touch in them stay as they are.

        spoken = labial.render(timings, exact=True)
        with labial.Hearing(rate, exact=True) as hearing:
            heard = list(hearing.frames([sound]))
        frames = labial.with_sound(spoken, heard)

    Args:
        spoken: frames or their 13 FAPs, as of :func:`labial.render`. heard: those of :class:`labial.Hearing`, from the
        same moment on. share: of what is heard, 0 .. 1, or one for each frame. Where one motion is longer than the
        other, it goes on alone.

    Returns whole FAP units. Raises LabialError for a share out of range, and for a frame that has not 13 numbers.
    """
    one, other = [_pose(pose) for pose in spoken], [_pose(pose) for pose in heard]
    both = min(len(one), len(other))
    shares = list(share) if isinstance(share, Sequence) else [share] * both
    if len(shares) < both:
        raise LabialError(f"there are {len(shares)} shares for {both} frames")
    frames = [_mixed(one[k], other[k], _share(shares[k])) for k in range(both)]
    rest = one[both:] or other[both:]
    return [tuple(math.floor(value + 0.5) for value in pose) for pose in [*frames, *rest]]


def _pose(pose: Pose) -> List[float]:
    values = [float(value) for value in faps_of(pose)]
    if len(values) != CHANNELS:
        raise LabialError(f"a frame has {len(values)} numbers, not {CHANNELS}")
    return values


def _share(share: float) -> float:
    found = number(share, "a share")
    if not 0.0 <= found <= 1.0:
        raise LabialError(f"a share of {found:g} is not within 0 .. 1")
    return found


def _mixed(spoken: List[float], heard: List[float], share: float) -> List[float]:
    way = min(max((-spoken[_UPPER] - spoken[_LOWER] - _CLOSED) / (_FREE - _CLOSED), 0.0), 1.0)
    free = share * way * way * (3.0 - 2.0 * way) if share < 1.0 else share
    return [one + (free if k in _LIPS else share) * (other - one) for k, (one, other) in enumerate(zip(spoken, heard))]
