"""Frames files: ``time,fap3,fap16,...``, seconds and FAP units."""

from __future__ import annotations

from typing import TextIO

import numpy as np

from labial.faps import FAP_COLUMNS


def write_csv(out: TextIO, frames: np.ndarray, fps: int) -> None:
    """Writes (T, 13) frames, whose times are those of their beginnings, with two decimals."""
    out.write(",".join(("time", *FAP_COLUMNS)) + "\n")
    for t, frame in enumerate(frames):
        out.write(f"{t / fps:.3f}," + ",".join(f"{value:.2f}" for value in frame) + "\n")
