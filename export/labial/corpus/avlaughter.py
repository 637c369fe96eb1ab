"""AVLaughterCycle: laughs with a phonetic annotation, ``[subject]_[startMs]_[endMs].TextGrid``, and their motion.

The corpus is available on request, for research. Tier 1 of a TextGrid has phonetic symbols and words such as "hum" or
"vocal_fry", tier 2 the direction of the air: "e" out, "i" in.

This reader does not know the format of the corpus's face tracking: **convert it first**, to a frames file of the Labial
corpus folder (``time,fap3,...``: seconds from the start of the laugh, FAP units) with the TextGrid's name and ``.csv``,
beside the TextGrid. Laughs without such a file are omitted.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple, Union

from labial.corpus.episode import Episode, Segment
from labial.corpus.folder import check_span, check_unit, read_frames
from labial.corpus.phonesets import LAUGHTER, PhoneSet
from labial.corpus.timings import SourceSegment, phoneme_segments, read_segments
from labial.errors import DataError

PathLike = Union[str, os.PathLike[str]]

#: Names of the corpus's files: subject, begin and end in milliseconds.
NAME = re.compile(r"\d+_\d+_\d+")
#: Label of an interval of tier 2 that holds speech.
SPEECH_TAG = "speech"


def read_avlaughter(
    path: PathLike, phone_set: PhoneSet = LAUGHTER, refused: Optional[List[DataError]] = None
) -> List[Episode]:
    """Reads all laughs under `path` (sub-folders included) that have motion, sorted by name.

    Malformed files raise DataError, and so does motion without annotation. Laughs without motion and those that contain
    speech are omitted, with the reasons appended to `refused` if it is given.
    """
    reasons: List[DataError] = [] if refused is None else refused
    annotations: Dict[str, Path] = {}
    for file in laugh_files(path):
        if file.stem in annotations:
            raise DataError(file, None, f"there is also {annotations[file.stem]}")
        annotations[file.stem] = file
    for file in sorted(Path(path).rglob("*.csv")):
        beside = file.stem in annotations and annotations[file.stem].parent == file.parent
        if NAME.fullmatch(file.stem) and not beside:
            raise DataError(file, None, f"no {file.stem}.TextGrid beside it")
    episodes: List[Episode] = []
    for name in sorted(annotations):
        annotation = annotations[name]
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
    """The laughter phonemes of one annotation, or None when tier 2 marks speech in it.

    Audible breath through the nose is "ne" in either direction. Where tier 1 is empty, tier 2 decides: with an airflow
    in half of the interval or more it is breath, "ne", otherwise silence.
    """
    marks = read_segments(path, "textgrid", number=1)
    if not marks:
        raise DataError(path, None, "no interval tier with phonetic symbols")
    airflow = read_segments(path, "textgrid", number=2)
    if any(item.label.lower() == SPEECH_TAG for item in airflow):
        return None
    symbols = []
    for item in marks:
        breath = not item.label and _airflow(item, airflow) >= 0.5 * item.duration
        symbols.append(SourceSegment(item.start, item.end, "ne" if breath else item.label))
    return phoneme_segments(path, symbols, phone_set)


def _airflow(item: Segment, airflow: Sequence[Segment]) -> float:
    """Seconds of `item` in which air flows."""
    flows = (other for other in airflow if other.label.lower() in ("e", "i"))
    return sum(max(0.0, min(item.end, other.end) - max(item.start, other.start)) for other in flows)
