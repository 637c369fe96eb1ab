"""The style of Labial's plots: colours, phonemes over and behind the curves, output of figures."""

from __future__ import annotations

import os
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterable, Iterator, List, Sequence, Union

import matplotlib

from labial.files.outputs import writing
from labial.see.motion import KINDS, Band

matplotlib.use("Agg")
from matplotlib import pyplot as pyplot  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402
from matplotlib.text import Text  # noqa: E402

#: Colours of curves that red-green blind people can distinguish (Okabe and Ito).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
#: Background and legend of each kind of band. Plain consonants have none.
BANDS = {
    "vowel": ("#fdf0d2", "vowel"),
    "closed": ("#f6c9c9", "p b m: lips closed"),
    "labiodental": ("#d9cdf0", "f v: lip to teeth"),
    "silence": ("#e4e7eb", "silence"),
}
#: Colour of the labels of each kind; of others "0.1". Those of consonants that have a band are bold.
LABELS = {"closed": "#b3202c", "labiodental": "#5b3f99", "silence": "0.55"}
assert set(BANDS) | set(LABELS) <= set(KINDS)

_STYLE: Any = {
    "font.size": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "0.55",
    "axes.linewidth": 0.7,
    "axes.labelcolor": "0.15",
    "xtick.color": "0.35",
    "ytick.color": "0.35",
    "svg.hashsalt": "labial",
    "svg.fonttype": "none",
}


@contextmanager
def style() -> Iterator[None]:
    """Figures are drawn and written within this, which sets how all of them look."""
    with pyplot.rc_context(_STYLE):
        yield


def shade(axes: Axes, bands: Iterable[Band]) -> None:
    """Draws the bands behind the curves: a colour by kind, a thin line where each begins and ends."""
    for band in bands:
        if band.kind in BANDS:
            axes.axvspan(band.start, band.end, color=BANDS[band.kind][0], linewidth=0, zorder=0)
        for edge in (band.start, band.end):
            axes.axvline(edge, color="0.82", linewidth=0.5, zorder=0.5)


def label(axes: Axes, bands: Sequence[Band], size: float = 7.0, upright: bool = False) -> List[Text]:
    """Writes the bands' labels above the axes and returns them; labels of successive short bands are stepped upwards to
    stay apart, and a label without room is omitted. `upright` suits names that are wider than their bands, such as
    those of laughter.

    The axes must have their limits and their place in the figure; what changes their width afterwards changes it
    little.
    """
    texts: List[Text] = []
    scale = 72.0 / axes.figure.dpi
    points = axes.get_window_extent().width * scale
    left, right = axes.get_xlim()
    taken = [-1e9] * (1 if upright else 3)  # where the last label of each row ends, points
    for band in bands:
        middle = (band.start + band.end) / 2
        if not left <= middle <= right:
            continue
        place = (middle - left) / (right - left) * points
        text = axes.annotate(
            band.label, (middle, 1.0), xycoords=axes.get_xaxis_transform(), xytext=(0, 3), textcoords="offset points",
            ha="center", va="bottom", rotation=90 if upright else 0, fontsize=size, color=LABELS.get(band.kind, "0.1"),
            fontweight="bold" if band.kind in ("closed", "labiodental") else "normal")  # fmt: skip
        half = 0.4 * size if upright else 0.5 * text.get_window_extent().width * scale + 1.0
        row = next((number for number, end in enumerate(taken) if place - half >= end), None)
        if row is None:
            text.remove()
            continue
        taken[row] = place + half
        text.set_position((0, 3 + row * size * 1.15))
        texts.append(text)
    return texts


def legend_patches(bands: Iterable[Band]) -> Sequence[Patch]:
    """One entry of a legend for each kind of band that occurs."""
    present = {band.kind for band in bands}
    return [Patch(facecolor=colour, edgecolor="0.8", linewidth=0.5, label=name)
            for kind, (colour, name) in BANDS.items() if kind in present]


def write(figure: Figure, path: Union[str, os.PathLike[str]], dpi: int = 110) -> None:
    """Writes the figure, in the format that the suffix tells and with the same bytes each time, and closes it.

    Figures are drawn and written within :func:`style`.
    """
    unstamped = {".png": {"Software": None}, ".svg": {"Date": None, "Creator": None}, ".pdf": {"CreationDate": None}}
    suffix = Path(path).suffix.lower()
    with writing(path) as file:
        figure.savefig(file, dpi=dpi, format=suffix[1:] or None, metadata=unstamped.get(suffix))
    pyplot.close(figure)
