"""One stream of phonemes through several models, drawn over each other: the labial parameters, closures marked.

    python -m labial.evaluate.side_by_side PHONES -o FIGURE.svg NAME=MODEL.npz [NAME=MODEL.npz ...]
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Sequence

import numpy as np

from labial.errors import LabialError
from labial.evaluate.material import bands, timeline
from labial.evaluate.measures import labial_parameters
from labial.files.faps import FAP_NUMBERS
from labial.reference.synthesis import synthesise
from labial.see import drawing
from labial.see.drawing import pyplot, style
from labial.see.motion import Band
from labial.tables.model import Model, load
from labial.tables.phones import read_stream

#: Titles of the panels, in the order of labial_parameters().
PANELS = (
    "distance of the lips\n\u2212(FAP 51 + 52)",
    "width of the mouth\nFAP 53 + 54",
    "top lip forward\nFAP 17",
    "bottom lip forward\nFAP 16",
)

#: Colours of the models: Labial's, blue, comes second, after the published method.
COLOURS = tuple(drawing.COLOURS[index] for index in (1, 0, 2, 3))


@dataclass(frozen=True)
class Drawn:
    """The data of the figure: `motion` has (T, 4) labial parameters by the model's name, FAP units."""

    fps: int
    phonemes: List[Band]
    motion: Dict[str, np.ndarray]
    contact: Optional[float]  #: distance of the lips in contact, FAP units, if a model has it

    @property
    def closing(self) -> List[Band]:
        """The phonemes that close the lips."""
        return [band for band in self.phonemes if band.kind == "closed"]


def _contact(models: Sequence[Model]) -> Optional[float]:
    """The largest distance of the lips in a model's bilabials; None if no model limits it."""
    for model in models:
        upper, lower = (model.floor[:, FAP_NUMBERS.index(number)] for number in (51, 52))
        held = np.isfinite(upper + lower) & (model.viseme_class == _bilabial(model))
        if held.any():
            return float(-(upper + lower)[held].mean())
    return None


def _bilabial(model: Model) -> int:
    return model.classes.index("bilabial") if "bilabial" in model.classes else -1


def _kinds(model: Model) -> List[str]:
    """(P,) kinds of bands of the model's phonemes."""
    known = {"silence": "silence", "bilabial": "closed", "labiodental": "labiodental"}
    return [known.get(model.classes[number], "vowel" if boundary else "other")
            for number, boundary in zip(model.viseme_class, model.boundary)]


def synthesise_all(phones: Path, models: Dict[str, Model]) -> Drawn:
    """The motion of all models, which must have the same phonemes and frame rate."""
    first = next(iter(models.values()))
    given = read_stream(phones, first)
    for name, model in models.items():
        if (model.phonemes, model.fps) != (first.phonemes, first.fps):
            raise LabialError(f"{name}: its phonemes or its frame rate are not those of the first model")
    spans = timeline((p for p, _ in given), (ms for _, ms in given), first.fps)
    return Drawn(
        first.fps,
        bands(spans, first.phonemes, _kinds(first), first.fps),
        {name: labial_parameters(synthesise(model, given)) for name, model in models.items()},
        _contact(list(models.values())),
    )


def least(drawn: Drawn, name: str) -> List[float]:
    """Each closure's least distance of the lips, FAP units, at its own frames."""
    opening = drawn.motion[name][:, 0]
    return [float(opening[round(b.start * drawn.fps) : round(b.end * drawn.fps)].min()) for b in drawn.closing]


@style()
def draw(drawn: Drawn, path: Path) -> None:
    """Writes the figure, SVG or PNG."""
    ratios = {"height_ratios": (1.7, 1, 1, 1)}  # closures are seen in the first
    figure, every = pyplot.subplots(len(PANELS), 1, figsize=(11, 7.2), sharex=True, gridspec_kw=ratios)
    total = len(next(iter(drawn.motion.values())))
    time = (np.arange(total) + 0.5) / drawn.fps
    for index, (axes, title) in enumerate(zip(every, PANELS)):
        drawing.shade(axes, drawn.phonemes)
        for (name, motion), colour in zip(drawn.motion.items(), COLOURS):
            axes.plot(time, motion[:, index], color=colour, linewidth=1.8, label=name, solid_capstyle="round")
        axes.set_ylabel(title)
    if drawn.contact is not None:
        closed = drawing.LABELS["closed"]
        every[0].axhline(drawn.contact, color=closed, linewidth=1, linestyle=(0, (4, 3)), zorder=1)
        every[0].text(total / drawn.fps, drawn.contact, " firm\n contact", color=closed, fontsize=8, va="center")
    every[0].set_xlim(0, total / drawn.fps)
    every[0].legend(fontsize=10, frameon=False, loc="upper right", ncol=len(drawn.motion))
    every[-1].set_xlabel("seconds; vertical axes in FAP units", loc="right")
    patches = list(drawing.legend_patches(drawn.phonemes))
    figure.legend(handles=patches, loc="lower left", ncol=len(patches), frameon=False, fontsize=8)
    figure.align_ylabels(every)
    figure.tight_layout(h_pad=0.6)
    drawing.label(every[0], drawn.phonemes, size=8.5)
    figure.tight_layout(h_pad=0.6)
    drawing.write(figure, path)


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line; see the module."""
    parser = argparse.ArgumentParser(prog="python -m labial.evaluate.side_by_side", description=__doc__.split("\n")[0])
    parser.add_argument("phones", type=Path, help="phoneme timings, as for labial synth")
    parser.add_argument("models", nargs="+", metavar="NAME=MODEL.npz")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FIGURE", help=".svg or .png")
    options = parser.parse_args(arguments)
    try:
        pairs = [item.partition("=") for item in options.models]
        wrong = [item for item, (name, _, path) in zip(options.models, pairs) if not name or not path]
        if wrong or len({name for name, _, _ in pairs}) < len(pairs) or len(pairs) > len(COLOURS):
            raise LabialError(f"models are one to {len(COLOURS)} of the form NAME=MODEL.npz, each name once")
        drawn = synthesise_all(options.phones, {name: load(path) for name, _, path in pairs})
        draw(drawn, options.output)
    except (LabialError, OSError) as error:
        print(f"side_by_side: {error}", file=sys.stderr)
        return 1
    for name in drawn.motion:
        print(f"{name}: least distance of the lips in each closure, FAP units: "
              + " ".join(f"{item.label} {value:.0f}" for item, value in zip(drawn.closing, least(drawn, name))))
    if drawn.contact is not None:
        print(f"firm contact: {drawn.contact:.0f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
