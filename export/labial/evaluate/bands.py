"""A timeline's phonemes as the bands that figures draw."""

from __future__ import annotations

from typing import List, Optional, Sequence

from labial.evaluate.material import Timeline
from labial.see.motion import Band


def bands(given: Timeline, phonemes: Sequence[str], kinds: Sequence[str], fps: int, begin: int = 0,
          end: Optional[int] = None) -> List[Band]:
    """The phonemes within the frames from `begin` to before `end` (all), as they are synthesised; cut at both ends.

    `phonemes` and `kinds` (P,) are labels and kinds of bands by phoneme number.
    """
    end = given.frames if end is None else end
    found = []
    for segment in given.held:
        first = max(int(given.start[segment]), begin)
        last = min(int(given.start[segment] + given.length[segment]), end)
        if first < last:
            phoneme = given.phoneme[segment]
            found.append(Band(first / fps, last / fps, phonemes[phoneme], kinds[phoneme]))
    return found
