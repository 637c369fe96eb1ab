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
from labial.evaluate.drawing import Span, label_phonemes, pyplot, save, spans
from labial.evaluate.material import timeline
from labial.evaluate.trajectories import labial_parameters
from labial.faps import FAP_NUMBERS
from labial.model import Model, load
from labial.phones import read_stream
from labial.reference.stream import synthesise
from labial.reference.tables import FloatTables

#: Titles of the panels, in the order of labial_parameters().
PANELS = (
    "distance of the lips\n\u2212(FAP 51 + 52)",
    "width of the mouth\nFAP 53 + 54",
    "top lip forward\nFAP 17",
    "bottom lip forward\nFAP 16",
)

#: Colours of the first models, from pale to strong, and of phonemes that close the lips, and of vowels.
COLOURS = ("#d1802f", "#1f5fa8", "#2f8f5b", "#8a4fa3")
CLOSING, VOWEL = "#d64550", "#eef1f4"


@dataclass(frozen=True)
class Drawn:
    """What is drawn: `motion` holds (T, 4) labial parameters by the model's name, FAP units."""

    fps: int
    phonemes: List[Span]
    closing: List[Span]
    vowels: List[Span]
    motion: Dict[str, np.ndarray]
    contact: Optional[float]  #: distance of the lips in firm contact, FAP units, where a model knows it


def _contact(models: Sequence[Model]) -> Optional[float]:
    """The distance of the lips at which a model holds its bilabials at most; None where no model holds them."""
    for model in models:
        upper, lower = (model.floor[:, FAP_NUMBERS.index(number)] for number in (51, 52))
        held = np.isfinite(upper + lower) & (model.phoneme_class == _bilabial(model))
        if held.any():
            return float(-(upper + lower)[held].mean())
    return None


def _bilabial(model: Model) -> int:
    return model.classes.index("bilabial") if "bilabial" in model.classes else -1


def synthesise_all(phones: Path, models: Dict[str, Model]) -> Drawn:
    """The motion of all models, which must have the same phonemes and frame rate."""
    first = next(iter(models.values()))
    stream = read_stream(phones, first)
    for name, model in models.items():
        if (model.phonemes, model.fps) != (first.phonemes, first.fps):
            raise LabialError(f"{name}: its phonemes or its frame rate are not those of the first model")
    given = timeline((p for p, _ in stream), (ms for _, ms in stream), first.fps)
    phonemes = spans(given, first.phonemes, first.fps)
    closes = {label for label, c in zip(first.phonemes, first.phoneme_class) if c == _bilabial(first)}
    opens = {label for label, boundary in zip(first.phonemes, first.boundary) if boundary} - closes
    return Drawn(
        first.fps,
        phonemes,
        [item for item in phonemes if item.label in closes],
        [item for item in phonemes if item.label in opens],
        {name: labial_parameters(synthesise(FloatTables(model), stream)) for name, model in models.items()},
        _contact(list(models.values())),
    )


def least(drawn: Drawn, name: str) -> List[float]:
    """Each closure's least distance of the lips, FAP units, at its own frames."""
    opening = drawn.motion[name][:, 0]
    return [float(opening[round(s.begin * drawn.fps) : round(s.end * drawn.fps)].min()) for s in drawn.closing]


def draw(drawn: Drawn, path: Path) -> None:
    """Writes the figure, SVG or PNG."""
    ratios = {"height_ratios": (1.7, 1, 1, 1)}  # closures are seen in the first
    figure, every = pyplot.subplots(len(PANELS), 1, figsize=(11, 7.2), sharex=True, gridspec_kw=ratios)
    total = len(next(iter(drawn.motion.values())))
    time = (np.arange(total) + 0.5) / drawn.fps
    for index, (axes, title) in enumerate(zip(every, PANELS)):
        for item in drawn.vowels:
            axes.axvspan(item.begin, item.end, color=VOWEL, linewidth=0, zorder=0)
        for item in drawn.closing:
            axes.axvspan(item.begin, item.end, color=CLOSING, alpha=0.22, linewidth=0, zorder=0)
        for (name, motion), colour in zip(drawn.motion.items(), COLOURS):
            axes.plot(time, motion[:, index], color=colour, linewidth=1.8, label=name, solid_capstyle="round")
        axes.set_ylabel(title, fontsize=9)
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=8)
    if drawn.contact is not None:
        every[0].axhline(drawn.contact, color=CLOSING, linewidth=1, linestyle=(0, (4, 3)), zorder=1)
        every[0].text(total / drawn.fps, drawn.contact, " firm\n contact", color=CLOSING, fontsize=8, va="center")
    every[0].set_xlim(0, total / drawn.fps)
    for text, item in zip(label_phonemes(every[0], drawn.phonemes, size=8.5), drawn.phonemes):
        if item in drawn.closing:
            text.set(color=CLOSING, fontweight="bold")
    every[0].legend(fontsize=10, frameon=False, loc="upper right", ncol=len(drawn.motion))
    every[-1].set_xlabel("seconds; vertical axes in FAP units", fontsize=9)
    figure.align_ylabels(every)
    figure.tight_layout(h_pad=0.6)
    save(figure, path)


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
