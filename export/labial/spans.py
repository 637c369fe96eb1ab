"""Stretches of frames in which something holds, and how a message names them."""

from __future__ import annotations

from typing import List, Tuple

import numpy as np


def spans(holds: np.ndarray) -> List[Tuple[int, int]]:
    """The first frame of each stretch in which `holds` (T,) is true, and the frame after its last."""
    changes = np.flatnonzero(np.diff(holds.astype(np.int8), prepend=0, append=0)).tolist()
    return list(zip(changes[::2], changes[1::2]))


def spans_told(times: np.ndarray, holds: np.ndarray, most: int) -> str:
    """When `holds` (T,) is true, such as "0.10 to 0.32, 1.00 to 1.20 s and 3 times more": the first `most` stretches,
    each from the time of its first frame to that of its last; `times` (T,) are in seconds."""
    every = [f"{times[first]:.2f} to {times[end - 1]:.2f}" for first, end in spans(holds)]
    more = f" and {len(every) - most} times more" if len(every) > most else ""
    return f"{', '.join(every[:most])} s{more}"
