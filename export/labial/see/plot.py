"""``labial plot``: trajectories over time, one panel per channel, phonemes behind them, several files overlaid."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, List, NamedTuple, Sequence, Tuple, Union

import numpy as np

from labial.errors import LabialError
from labial.files.faps import FAP_COLUMNS, FAP_NAMES
from labial.see.drawing import COLOURS, label, legend_patches, pyplot, shade, style, write
from labial.see.motion import Band, Motion, laughs

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


def _span(motions: Sequence[Motion], bands: Sequence[Band]) -> Tuple[float, float]:
    starts = [float(motion.times[0]) for motion in motions] + [band.start for band in bands[:1]]
    ends = [float(motion.times[-1]) for motion in motions] + [band.end for band in bands[-1:]]
    first, last = min(starts), max(ends)
    return first, last if last > first else first + 0.04


def plot(motions: Sequence[Motion], bands: Sequence[Band], path: Union[str, os.PathLike[str]],
         channels: str = DEFAULT) -> None:
    """Writes the plot of one motion or more to `path` (.png, .svg or .pdf).

    Raises LabialError for another suffix and for channels that do not exist.
    """
    if Path(path).suffix.lower() not in _SUFFIXES:
        raise LabialError(f"{os.fspath(path)}: the name of a plot ends in {', '.join(_SUFFIXES)}")
    rows = panels(channels)
    first, last = _span(motions, bands)
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
