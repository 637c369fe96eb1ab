"""The motion of a trained model, by the reference of its method."""

from __future__ import annotations

from typing import Iterator, Sequence, Tuple

import numpy as np

from labial.reference import published, stream
from labial.reference.fade import delivered_in_parts
from labial.reference.tables import FloatTables
from labial.reference.units import frame_counts
from labial.tables.model import Model


def is_published(model: Model) -> bool:
    """Whether the model was trained by the published method (``--method paper``)."""
    return model.method == "paper"


def synthesise(model: Model, phonemes: Sequence[Tuple[int, int]], *, whole: bool = False,
               articulation: int = 100) -> np.ndarray:
    """(T, 13) float64, FAP units: the motion of `phonemes`, pairs of phoneme number and milliseconds. A model of the
    published method is searched and solved unit by unit (:mod:`labial.reference.published`), one of Labial's as the
    run-time does it (:mod:`labial.reference.stream`); with `whole` either is searched and solved over the whole
    utterance at once. `articulation`, percent, is how far the mouth moves."""
    if whole or is_published(model):  # without contact, so that all of the motion is in proportion
        gain = float(stream.gains(np.array([articulation]), 1)[0, 0])
        return gain * published.synthesise(FloatTables(model), phonemes, whole=whole)
    return stream.synthesise(FloatTables(model), phonemes, articulation=articulation)


def delivered(model: Model, phonemes: Sequence[Tuple[int, int]], *, whole: bool = False, articulation: int = 100,
              exact: bool = False) -> Iterator[np.ndarray]:
    """The motion of :func:`synthesise` as a stream delivers it, in parts (n, 13) as they are computed: it begins at
    rest and, unless it is to be `exact`, ends there (:mod:`labial.reference.fade`). That of a model of the published
    method is as it was published, all at once."""
    if is_published(model):
        yield synthesise(model, phonemes, whole=whole, articulation=articulation)
        return
    parts = (iter([synthesise(model, phonemes, whole=True, articulation=articulation)]) if whole
             else stream.in_parts(FloatTables(model), phonemes, articulation=articulation))
    yield from delivered_in_parts(parts, exact)


def frames_of(model: Model, phonemes: Sequence[Tuple[int, int]]) -> int:
    """The number of frames of :func:`synthesise` for `phonemes`."""
    return sum(frame_counts([milliseconds for _, milliseconds in phonemes], model.fps))
