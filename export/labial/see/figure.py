"""Draws how each output moves from rest to a few poses, which shows errors in a description."""

from __future__ import annotations

from pathlib import Path
from typing import Union

import numpy as np

from labial.errors import needs
from labial.files import limits
from labial.rig.description import POSES, Rig
from labial.rig.table import convert, expected

#: Drawn shares of a pose; a quarter beyond it shows limits.
_SHARES = np.linspace(0.0, 1.25, 51)


def draw(rig: Rig, path: Union[str, Path]) -> None:
    """Writes the drawing as SVG; the same rig gives the same bytes. Raises LabialError without matplotlib."""
    with needs("drawing (--no-figure leaves it out)", "rig"):
        from labial.see.drawing import COLOURS, pyplot, style, write

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
