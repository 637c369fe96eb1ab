"""``labial plot``: trajectories over time, one panel per channel, phonemes behind them, several files overlaid.

The style is that of all of Labial's plots: colours, phonemes over and behind the curves, output of figures.
"""

from __future__ import annotations

import os
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, List, NamedTuple, Sequence, Union

import matplotlib
import numpy as np
from matplotlib import pyplot as pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from labial.errors import LabialError, PathLike
from labial.files import limits
from labial.files.faps import FAP_COLUMNS, FAP_NAMES
from labial.files.outputs import writing
from labial.rig.description import POSES, Rig
from labial.rig.table import convert, expected
from labial.see.motion import KINDS, Band, Motion, laughs

matplotlib.use("Agg")

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


def label(axes: Axes, bands: Sequence[Band], upright: bool = False) -> None:
    """Writes the bands' labels above the axes, which must have their limits and about their width. Labels of successive
    short bands are stepped upwards to stay apart, and a label without room is omitted. `upright` suits names that are
    wider than their bands, such as those of laughter."""
    size, scale = 7.0, 72.0 / axes.figure.dpi
    points = axes.get_window_extent().width * scale
    left, right = axes.get_xlim()
    taken = [-1e9] * (1 if upright else 3)  # where the last label of each row ends, points
    for band in bands:
        middle = (band.start + band.end) / 2
        if not left <= middle <= right:
            continue
        place = (middle - left) / (right - left) * points
        text = axes.annotate(band.label, (middle, 1.0), xycoords=axes.get_xaxis_transform(), xytext=(0, 3),
                             textcoords="offset points", ha="center", va="bottom", rotation=90 if upright else 0,
                             fontsize=size, color=LABELS.get(band.kind, "0.1"),
                             fontweight="bold" if band.kind in ("closed", "labiodental") else "normal")
        half = 0.4 * size if upright else 0.5 * text.get_window_extent().width * scale + 1.0
        row = next((number for number, end in enumerate(taken) if place - half >= end), None)
        if row is None:
            text.remove()
            continue
        taken[row] = place + half
        text.set_position((0, 3 + row * size * 1.15))


def legend_patches(bands: Iterable[Band]) -> Sequence[Patch]:
    """One entry of a legend for each kind of band that occurs."""
    present = {band.kind for band in bands}
    return [Patch(facecolor=colour, edgecolor="0.8", linewidth=0.5, label=name)
            for kind, (colour, name) in BANDS.items() if kind in present]


def write(figure: Figure, path: PathLike, dpi: int = 110) -> None:
    """Writes the figure, in the format that the suffix tells and with the same bytes each time, and closes it."""
    unstamped = {".png": {"Software": None}, ".svg": {"Date": None, "Creator": None}, ".pdf": {"CreationDate": None}}
    suffix = Path(path).suffix.lower()
    with writing(path) as file:
        figure.savefig(file, dpi=dpi, format=suffix[1:] or None, metadata=unstamped.get(suffix))
    pyplot.close(figure)


#: Default channels.
DEFAULT = "fap3,opening,stretch,fap17"
_WIDTH_FAPS = ("fap53", "fap54")
_SUFFIXES = (".png", ".svg", ".pdf")
_LONGEST_AXIS = 40.0  # inches; longer motion is drawn closer together


class _Panel(NamedTuple):
    """One panel: its two-line label and the function that computes its curve from (T, 13) frames."""

    title: str
    unit: str
    of: Callable[[np.ndarray], np.ndarray]


def _fap(index: int) -> _Panel:
    column = FAP_COLUMNS[index]
    name = FAP_NAMES[index].replace("_", " ")
    return _Panel(f"{column[:3].upper()} {column[3:]}\n{name}", "MW" if column in _WIDTH_FAPS else "MNS",
                  lambda frames: frames[:, index])


def _sum(title: str, unit: str, factor: int, *columns: str) -> _Panel:
    indices = [FAP_COLUMNS.index(column) for column in columns]
    return _Panel(title, unit, lambda frames: factor * frames[:, indices].sum(axis=1))


#: Sums that can be plotted, in addition to single FAPs.
SUMS = {
    "opening": _sum("lip opening\n\u2212(FAP 51 + 52)", "MNS", -1, "fap51", "fap52"),
    "stretch": _sum("corner stretch\nFAP 53 + 54", "MW", 1, "fap53", "fap54"),
}


def panels(channels: str) -> List[_Panel]:
    """The panels that a list names: FAPs as "fap3", "3" or "open_jaw", `SUMS`, or "all" for the 13 FAPs."""
    found: List[_Panel] = []
    for asked in (name.strip().lower() for name in channels.split(",") if name.strip()):
        if asked == "all":
            found += [_fap(index) for index in range(len(FAP_COLUMNS))]
        elif asked in SUMS:
            found.append(SUMS[asked])
        else:
            names = [FAP_COLUMNS, [column[3:] for column in FAP_COLUMNS], FAP_NAMES]
            index = next((list(known).index(asked) for known in names if asked in known), None)
            if index is None:
                raise LabialError(f"no channel is called {asked!r}; there are {', '.join(FAP_COLUMNS)}, "
                                  f"{', '.join(SUMS)} and all")
            found.append(_fap(index))
    if not found:
        raise LabialError("no channel to plot")
    return found


def plot(motions: Sequence[Motion], bands: Sequence[Band], path: PathLike, channels: str = DEFAULT) -> None:
    """Writes the plot of one motion or more, .png, .svg or .pdf. Raises LabialError for others and unknown channels."""
    if Path(path).suffix.lower() not in _SUFFIXES:
        raise LabialError(f"{os.fspath(path)}: the name of a plot ends in {', '.join(_SUFFIXES)}")
    rows = panels(channels)
    first = min([float(motion.times[0]) for motion in motions] + [band.start for band in bands[:1]])
    last = max([float(motion.times[-1]) for motion in motions] + [band.end for band in bands[-1:]])
    last = last if last > first else first + 0.04
    width = min(max(9.0, 2.2 + 2.6 * (last - first)), _LONGEST_AXIS)
    upright = laughs(bands)
    top = 0.75 if upright else 0.45
    height = 0.7 + top + (1.45 if len(rows) <= 6 else 1.05) * len(rows)
    with style():
        figure, every = pyplot.subplots(len(rows), 1, figsize=(width, height), sharex=True, squeeze=False)
        # Margins in inches, whatever the size: labels at the left, phonemes above, legend and time below.
        figure.subplots_adjust(left=1.95 / width, right=1 - 0.2 / width, top=1 - top / height, bottom=0.75 / height,
                               hspace=0.14)
        for axes, row in zip(every[:, 0], rows):
            shade(axes, bands)
            axes.axhline(0, color="0.6", linewidth=0.6, zorder=1)
            for index, motion in enumerate(motions):
                axes.plot(motion.times, row.of(motion.frames), color=COLOURS[index % len(COLOURS)], linewidth=1.5,
                          linestyle="-" if index < len(COLOURS) else "--", label=motion.name, zorder=2)
            axes.set_ylabel(f"{row.title}\n{row.unit}/1024", fontsize=7.5, rotation=0, ha="right", va="center")
            axes.margins(y=0.1)
            axes.locator_params(axis="y", nbins=5)
        every[0, 0].set_xlim(first, last)
        label(every[0, 0], bands, upright=upright)
        figure.align_ylabels(every[:, 0])
        every[-1, 0].set_xlabel("seconds")
        curves = every[0, 0].get_legend_handles_labels()[0]
        patches = list(legend_patches(bands))
        figure.legend(handles=[*curves, *patches], loc="lower left", bbox_to_anchor=(1.85 / width, 0.06 / height),
                      ncol=len(curves) + len(patches) if len(curves) + len(patches) <= 7 else 5, frameon=False,
                      fontsize=8, handlelength=1.6, columnspacing=1.6, borderaxespad=0.2)
        write(figure, path, dpi=150)


#: Drawn shares of a pose; a quarter beyond it shows limits.
_SHARES = np.linspace(0.0, 1.25, 51)


def draw_rig(rig: Rig, path: Union[str, Path]) -> None:
    """Writes how each output moves from rest to a few poses, as SVG; the same rig gives the same bytes."""
    limits.refuse(rig.path, "it has", len(rig.outputs), limits.DRAWN, "outputs (--no-figure leaves the drawing out)")
    table = convert(rig)
    columns = min(len(table), 3)
    rows = -(-len(table) // columns)
    with style():
        figure, every = pyplot.subplots(rows, columns, figsize=(3.4 * columns + 0.4, 2.5 * rows + 0.7), squeeze=False,
                                        sharex=True, layout="constrained")
        for (pose, faps), colour in zip(POSES.items(), COLOURS):
            values = expected(rig, table, _SHARES[:, None] * faps)
            for number in range(len(table)):
                every.flat[number].plot(100 * _SHARES, values[:, number], color=colour, label=pose, linewidth=1.6)
        for axes, whole in zip(every.flat, table):
            for limit in (whole.minimum, whole.maximum):
                axes.axhline(limit, color="0.55", linewidth=0.8, linestyle="--")
            margin = 0.06 * max(whole.maximum - whole.minimum, 1)
            axes.set_ylim(whole.minimum - margin, whole.maximum + margin)
            axes.set_title(whole.name)
            axes.set_xlim(0, 125)
            axes.grid(alpha=0.25)
        for axes in list(every.flat)[len(table):]:
            axes.set_visible(False)
        for axes in list(every.flat)[max(len(table) - columns, 0) : len(table)]:  # each column's last
            axes.tick_params(labelbottom=True)
        for axes in every[:, 0]:
            axes.set_ylabel(rig.unit.text.split(" (")[0])
        figure.supxlabel("percent of the pose")
        figure.legend(*every.flat[0].get_legend_handles_labels(), loc="outside upper center", frameon=False,
                      ncols=2 if columns == 1 else len(POSES))
        write(figure, path)
