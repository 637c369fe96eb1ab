"""Reads corpora of all kinds, and resamples their episodes to frames of a fixed rate.

AVLaughterCycle has laughs with a phonetic annotation, ``[subject]_[startMs]_[endMs].TextGrid``, and their motion. It is
available on request, for research. Tier 1 of a TextGrid has phonetic symbols and words such as "hum" or
"vocal_fry", tier 2 the direction of the air: "e" out, "i" in.

Its reader does not know the format of its face tracking: **convert it first**, to a frames file of the Labial
corpus folder (``time,fap3,...``: seconds from the start of the laugh, FAP units) with the TextGrid's name and ``.csv``,
beside the TextGrid. Laughs without such a file are omitted.
"""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Episode, Segment, with_even_sides
from labial.corpus.folder import check_span, check_unit, read_folder, read_frames
from labial.corpus.iemocap import read_iemocap
from labial.corpus.phonesets import LAUGHTER, PHONE_SETS, PhoneSet
from labial.corpus.talkers import brought_together, with_something_left, with_sources
from labial.corpus.timings import SourceSegment, phoneme_segments, read_segments
from labial.errors import DataError, LabialError, PathLike
from labial.files.frames import sampled

#: Names of the corpus's files: subject, begin and end in milliseconds.
NAME = re.compile(r"\d+_\d+_\d+")
#: Label of an interval of tier 2 that holds speech.
SPEECH_TAG = "speech"


def read_avlaughter(path: PathLike, phone_set: PhoneSet = LAUGHTER,
                    refused: Optional[List[DataError]] = None) -> List[Episode]:
    """Reads all laughs under `path` (sub-folders included) that have motion, sorted by name. Malformed files raise
    DataError, and so does motion without annotation. Laughs without motion and those that contain speech are omitted,
    with the reasons appended to `refused` if it is given."""
    reasons: List[DataError] = [] if refused is None else refused
    annotations: Dict[str, Path] = {}
    for file in laugh_files(path):
        if annotations.setdefault(file.stem, file) != file:
            raise DataError(file, None, f"there is also {annotations[file.stem]}")
    for file in sorted(Path(path).rglob("*.csv")):
        beside = file.stem in annotations and annotations[file.stem].parent == file.parent
        if NAME.fullmatch(file.stem) and not beside:
            raise DataError(file, None, f"no {file.stem}.TextGrid beside it")
    episodes: List[Episode] = []
    for name, annotation in sorted(annotations.items()):
        motion = annotation.with_suffix(".csv")
        if not motion.is_file():
            reasons.append(DataError(annotation, None, f"no motion; convert it to {motion.name} in the same folder"))
            continue
        segments = read_laugh(annotation, phone_set)
        if segments is None:
            reasons.append(DataError(annotation, None, "contains speech"))
            continue
        times, frames = read_frames(motion)
        check_unit(motion, times)
        episode = Episode(name, times, frames, segments)
        check_span(annotation, episode)
        episodes.append(episode)
    if not episodes:
        reason = f"; the first reason is {reasons[0]}" if reasons else ""
        raise DataError(path, None, f"no usable laugh (subject_start_end.TextGrid with .csv){reason}")
    return episodes


def laugh_files(path: PathLike) -> List[Path]:
    """The annotations under `path`, sorted."""
    files = (file for file in Path(path).rglob("*") if file.suffix.lower() == ".textgrid")
    return sorted(file for file in files if NAME.fullmatch(file.stem))


def read_laugh(path: PathLike, phone_set: PhoneSet = LAUGHTER) -> Optional[Tuple[Segment, ...]]:
    """The laughter phonemes of one annotation, or None when tier 2 marks speech in it. Audible breath through the nose
    is "ne" in either direction. Where tier 1 is empty, tier 2 decides: with an airflow in half of the interval or more
    it is breath, "ne", otherwise silence."""
    marks = read_segments(path, "textgrid", number=1)
    if not marks:
        raise DataError(path, None, "no interval tier with phonetic symbols")
    airflow = read_segments(path, "textgrid", number=2)
    if any(item.label.lower() == SPEECH_TAG for item in airflow):
        return None
    flows, symbols = [item for item in airflow if item.label.lower() in ("e", "i")], []
    for item in marks:
        flowing = sum(max(0.0, min(item.end, flow.end) - max(item.start, flow.start)) for flow in flows)
        breath = not item.label and flowing >= 0.5 * item.duration
        symbols.append(SourceSegment(item.start, item.end, "ne" if breath else item.label))
    return phoneme_segments(path, symbols, phone_set)


class Resampled(NamedTuple):
    """The T frames of an episode with S segments, at a fixed rate from the start of the first segment on."""

    motion: np.ndarray  #: (T, 13) float64 FAP
    length: np.ndarray  #: (S,) int64 frames of each segment, T in all; 0 for one that is too short for a frame
    apex: np.ndarray  #: (S,) int64: a segment's frame at its apex, else middle; the nearest frame if it has none


def read_corpus(path: PathLike, kind: str = "speech") -> List[Episode]:
    """Reads a corpus, whichever kind of files it has; episodes are sorted by name, labels are phonemes of `kind`.
    Recognised: IEMOCAP by its folders ``Session*/sentences``, AVLaughterCycle (laughter only) by its file names,
    anything else as a Labial corpus folder; ``corpus.toml`` names the talkers (:mod:`labial.corpus.talkers`). Raises
    DataError for malformed files; a warning counts recordings that are well-formed but cannot be used."""
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
    unseen = [(item.name, *stretch) for item in episodes for stretch in item.unseen(phone_set.silence)]
    if unseen:
        name, start, end = unseen[0]
        more = f" (and {len(unseen) - 1} more)" if unseen[1:] else ""
        warnings.warn(f"{os.path.join(path, name)}: no motion from {start:.2f} to {end:.2f} s{more}: nothing is learnt "
                      "there", stacklevel=2)
    return with_sources(path, episodes)


def read_each(paths: Sequence[PathLike], kind: str = "speech") -> List[List[Episode]]:
    """Reads several corpora as :func:`read_corpus` does. Folders of one name whose ``corpus.toml`` does not say who
    speaks are different talkers. Raises DataError for a folder that is named twice, and for a corpus in which nobody
    speaks or nothing moves."""
    folders: Dict[Path, PathLike] = {}
    for path in paths:
        where = Path(path).resolve()
        if where in folders:
            raise DataError(path, None, f"the same folder as {os.fspath(folders[where])}; name each corpus once")
        folders[where] = path
    corpora = [read_corpus(path, kind) for path in paths]
    silence = PHONE_SETS[kind].silence
    for path, corpus in zip(paths, corpora):
        if all(segment.label == silence for item in corpus for segment in item.segments):
            raise DataError(path, None, f"there is no phoneme of {kind} but silence")
        if not any(np.ptp(item.frames, axis=0).any() for item in corpus):
            raise DataError(path, None, "nothing moves: the FAPs of each episode are the same in all frames")
    for place, where in enumerate(folders):
        alike = [other.parent for other in folders if other.name == where.name]
        if len(alike) > 1:
            talker = os.path.relpath(where, os.path.commonpath(alike))
            corpora[place] = [replace(item, source=replace(item.source, talker=talker))
                              if item.source.recording == str(where) else item for item in corpora[place]]
    return corpora


def read_corpora(paths: Sequence[PathLike], kind: str = "speech", *, even_sides: bool = False,
                 distinct: bool = False) -> List[List[Episode]]:
    """Reads several corpora as :func:`read_each` does, and brings every recording's mean and scale, channel by channel,
    to those of the first; with `even_sides` those of the mean of both sides of the mouth. Includes what every corpus
    excludes, with a warning. With `distinct` raises DataError for two episodes of the same motion."""
    corpora = read_each(paths, kind)
    if distinct:
        known: Dict[bytes, str] = {}
        for path, corpus in zip(paths, corpora):
            for item in corpus:
                name = os.path.join(path, item.name)
                other = known.setdefault(sha256(item.times.tobytes() + item.frames.tobytes()).digest(), name)
                if other != name:
                    raise DataError(name, None, f"the same motion as {other}: one would be judged by a model that was "
                                    "trained on the other")
    corpora = with_something_left(corpora)
    if even_sides:
        corpora = [with_even_sides(corpus) for corpus in corpora]
    return brought_together(corpora, PHONE_SETS[kind].silence)


def resample(episode: Episode, fps: int) -> Resampled:
    """`episode` at `fps` frames per second. Motion is sampled by :func:`labial.files.frames.sampled`. Segments end at
    the frame nearest to their end, at .5 the later one, so that rounding errors do not accumulate."""
    if fps <= 0:
        raise LabialError(f"{fps} frames per second")
    if not episode.segments:
        raise LabialError(f"episode {episode.name} has no segments")
    origin = episode.segments[0].start
    # The nearest integer, halves up, also where binary fractions fall just short of a half.
    ends = np.floor((np.array([segment.end for segment in episode.segments]) - origin) * fps + 0.5 + 1e-6)
    ends = ends.astype(np.int64)
    counts, total = np.diff(ends, prepend=0), int(ends[-1])
    if total == 0:
        raise LabialError(f"episode {episode.name} is shorter than a frame")
    moments = np.array([(segment.start + segment.end) / 2 if segment.apex is None else segment.apex
                        for segment in episode.segments])
    first, apexes = ends - counts, np.floor((moments - origin) * fps + 1e-6).astype(np.int64)
    apexes = np.clip(apexes, first, first + np.maximum(counts, 1) - 1)
    frames = sampled(episode.times, episode.frames, fps, total, origin)
    return Resampled(frames, counts, np.minimum(apexes, total - 1))
