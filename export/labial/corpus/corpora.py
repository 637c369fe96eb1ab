"""Reads corpora of all kinds, and resamples their episodes to frames of a fixed rate."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import List, NamedTuple, Sequence, Union

import numpy as np

from labial.corpus.avlaughter import laugh_files, read_avlaughter
from labial.corpus.episode import Episode, with_even_sides
from labial.corpus.folder import read_folder
from labial.corpus.iemocap import read_iemocap
from labial.corpus.phonesets import PHONE_SETS
from labial.corpus.talkers import brought_together, with_something_left, with_sources
from labial.errors import DataError, LabialError
from labial.files.frames import sampled


class Resampled(NamedTuple):
    """The T frames of an episode with S segments, at a fixed rate. Frame t covers t/fps to (t + 1)/fps seconds from the
    start of the first segment."""

    motion: np.ndarray  #: (T, 13) float64 FAP
    length: np.ndarray  #: (S,) int64 frames of each segment, T in all; 0 for one that is too short for a frame
    apex: np.ndarray  #: (S,) int64: a segment's frame at its apex, else middle; the nearest frame if it has none


def read_corpus(path: Union[str, os.PathLike[str]], kind: str = "speech") -> List[Episode]:
    """Reads a corpus, whichever kind of files it has; episodes are sorted by name, labels are phonemes of `kind`.

    Recognised: IEMOCAP by its folders ``Session*/sentences``, AVLaughterCycle (laughter only) by its file names,
    anything else as a Labial corpus folder; ``corpus.toml`` names the talkers (:mod:`labial.corpus.talkers`). Raises
    DataError for malformed files; a warning counts recordings that are well-formed but cannot be used.
    """
    if kind not in PHONE_SETS:
        raise LabialError(f"kind is {kind!r}, not one of {', '.join(PHONE_SETS)}")
    phone_set = PHONE_SETS[kind]
    if not Path(path).is_dir():
        raise DataError(path, None, "no such folder")
    refused: List[DataError] = []
    if any(Path(path).glob("Session*/sentences")):
        episodes = read_iemocap(path, phone_set, refused)
    elif kind == "laughter" and laugh_files(path):
        episodes = read_avlaughter(path, phone_set, refused)
    else:
        episodes = read_folder(path, phone_set)
    if refused:
        count = f"{len(refused)} of {len(refused) + len(episodes)}"
        warnings.warn(f"{count} recordings were left out, the first for this reason: {refused[0]}", stacklevel=2)
    return with_sources(path, episodes)


def read_corpora(
    paths: Sequence[Union[str, os.PathLike[str]]], kind: str = "speech", *, even_sides: bool = False
) -> List[List[Episode]]:
    """Reads several corpora as :func:`read_corpus` does, and brings every recording's mean and scale, channel by
    channel, to those of the first; with `even_sides` those of the mean of both sides of the mouth. Includes what every
    corpus excludes, with a warning."""
    corpora = with_something_left([read_corpus(path, kind) for path in paths])
    if even_sides:
        corpora = [with_even_sides(corpus) for corpus in corpora]
    return brought_together(corpora, PHONE_SETS[kind].silence)


def resample(episode: Episode, fps: int) -> Resampled:
    """`episode` at `fps` frames per second.

    Motion is sampled by :func:`labial.files.frames.sampled`. Segments end at the frame nearest to their end, at .5 the
    later one, so that rounding errors do not accumulate.
    """
    if fps <= 0:
        raise LabialError(f"{fps} frames per second")
    if not episode.segments:
        raise LabialError(f"episode {episode.name} has no segments")
    origin = episode.segments[0].start
    ends = [_round((segment.end - origin) * fps) for segment in episode.segments]
    counts = np.diff([0, *ends]).astype(np.int64)
    total = ends[-1]
    if total == 0:
        raise LabialError(f"episode {episode.name} is shorter than a frame")
    frames = sampled(episode.times, episode.frames, fps, total, origin)
    apexes = []
    for segment, first, count in zip(episode.segments, np.cumsum(counts) - counts, counts):
        moment = (segment.start + segment.end) / 2 if segment.apex is None else segment.apex
        frame = min(max(int(np.floor((moment - origin) * fps + 1e-6)), int(first)), int(first + max(count, 1)) - 1)
        apexes.append(min(frame, total - 1))
    return Resampled(frames, counts, np.array(apexes, dtype=np.int64))


def _round(value: float) -> int:
    """To the nearest integer, halves up, also where binary fractions fall just short of a half."""
    return int(np.floor(value + 0.5 + 1e-6))
