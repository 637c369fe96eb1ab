"""What all figures share: phonemes along the time axis, and files that are the same bytes every time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import List, Sequence

import matplotlib
import numpy as np
from matplotlib.text import Text

from labial.evaluate.material import Timeline

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

__all__ = ["Span", "label_phonemes", "pyplot", "save", "spans"]


@dataclass(frozen=True)
class Span:
    """A phoneme on the time axis."""

    label: str
    begin: float  #: s
    end: float  #: s


def spans(given: Timeline, phonemes: Sequence[str], fps: int, begin: int = 0, end: int = -1) -> List[Span]:
    """The phonemes that lie whole within the frames from `begin` to before `end`, as they are synthesised; -1: all."""
    end = given.frames if end < 0 else end
    found = []
    for segment in given.held:
        first, last = int(given.start[segment]), int(given.start[segment] + given.length[segment])
        if first >= begin and last <= end:
            found.append(Span(phonemes[given.phoneme[segment]], first / fps, last / fps))
    return found


def label_phonemes(axes: pyplot.Axes, phonemes: Sequence[Span], upright: bool = False, size: float = 7) -> List[Text]:
    """Writes the phonemes above the axes, with a line where each begins; returns the texts.

    `upright` suits names that are longer than their phonemes last. Otherwise a label that would touch the one before
    it is raised. The axes must have their limits; what changes their width afterwards should change it little.
    """
    points = axes.get_window_extent().width * 72 / axes.figure.dpi / np.diff(axes.get_xlim())[0]  # per second
    texts: List[Text] = []
    right, raised = -np.inf, False  # where the last label ends, in points
    for item in phonemes:
        axes.axvline(item.begin, color="0.85", linewidth=0.6, zorder=0)
        middle, half = (item.begin + item.end) / 2, 0.36 * size * len(item.label) + 1.5
        raised = not upright and middle * points - half < right and not raised
        right = middle * points + half
        texts.append(axes.annotate(
            item.label, (middle, 1.0), xycoords=axes.get_xaxis_transform(), xytext=(0, 3 + 1.2 * size * raised),
            textcoords="offset points", ha="center", va="bottom", fontsize=size, rotation=90 if upright else 0,
        ))  # fmt: skip
    return texts


def save(figure: pyplot.Figure, path: Path, dpi: int = 110) -> str:
    """Writes the figure, PNG or SVG, without time or version; returns the file's name."""
    svg = path.suffix == ".svg"
    with pyplot.rc_context({"svg.hashsalt": "labial", "svg.fonttype": "none"}):
        figure.savefig(path, dpi=dpi, metadata={"Date": None, "Creator": None} if svg else {"Software": None})
    pyplot.close(figure)
    return path.name
