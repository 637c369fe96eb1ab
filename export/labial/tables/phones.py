"""Phoneme timings as the input of a model: phoneme numbers and integer milliseconds."""

from __future__ import annotations

import os
import warnings
from typing import List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.formats import read_timings
from labial.corpus.phonesets import AUTO, PhoneSet, aliases_for
from labial.corpus.timings import phoneme_segments
from labial.errors import PathLike
from labial.tables.model import Model

#: Seconds of motion from which on a warning says why a command takes long.
_LONG = 3600.0
#: A phoneme stream: (phoneme number, milliseconds) pairs.
Stream = List[Tuple[int, int]]


def phone_set(model: Model) -> PhoneSet:
    """The phone set of a model."""
    return PhoneSet(kind=model.kind, phonemes=model.phonemes, classes=model.classes,
                    viseme_class=tuple(int(c) for c in model.viseme_class),
                    boundary=tuple(bool(b) for b in model.boundary), silence=model.silence,
                    aliases=aliases_for(model.kind, model.phonemes, model.aliases))


def read_stream(path: PathLike, model: Model, labels: str = AUTO, source: Optional[str] = None,
                tier: Optional[str] = None) -> Stream:
    """Reads phoneme timings of the format `source`, or of any that :func:`read_timings` tells; gaps are silence.
    `labels` is the set of the labels: "arpabet", "ipa", "xsampa" or "auto"; `tier` names the tier of a TextGrid. The
    first phoneme lasts from time 0. Raises DataError, which names the file and the line, for malformed timings; unknown
    labels become the nearest phoneme, with one warning each."""
    segments = read_timings(path, source, tier=tier)
    if segments[-1].end > _LONG:
        warnings.warn(f"{os.fspath(path)}: its motion lasts {segments[-1].end / 3600:.1f} hours, which takes time and "
                      "memory", stacklevel=2)
    return stream_of(phoneme_segments(path, segments, phone_set(model), False, labels), model, 0)


def stream_of(segments: Sequence[Segment], model: Model, begin: int) -> Stream:
    """Phonemes of the model that follow each other without gaps as a stream from `begin`, milliseconds. Boundaries are
    rounded to milliseconds, so that rounding errors do not accumulate."""
    bounds = [begin, *(round(1000 * segment.end) for segment in segments)]
    return [(model.phonemes.index(segment.label), after - before)
            for segment, before, after in zip(segments, bounds, bounds[1:])]


def drawn_streams(model: Model, count: int = 24, length: int = 24, seed: int = 0) -> List[Stream]:
    """Random streams for measuring a model without its corpus: phonemes in random order, durations drawn from the
    model's own mixtures, silence at both ends."""
    rng = np.random.default_rng(seed)
    first = model.first_component()
    silence = model.phonemes.index(model.silence)

    def duration(phoneme: int) -> int:
        own = np.arange(first[phoneme], first[phoneme + 1])
        share = np.exp(model.log_weight[own])
        c = rng.choice(own, p=share / share.sum())
        return int(np.clip(rng.normal(model.duration_mean[c], np.sqrt(model.duration_variance[c])) * 1000, 20, 1000))

    return [[(int(p), duration(int(p))) for p in (silence, *rng.integers(len(model.phonemes), size=length), silence)]
            for _ in range(count)]
