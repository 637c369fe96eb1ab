"""The talkers of a corpus: the file ``corpus.toml`` in its folder, and several talkers on one scale.

Faces differ in the rest position and the range of their channels, and so do recordings of one face. So every
recording's motion is brought to the first corpus's mean and standard deviation, channel by channel, both measured
outside silence. Where a corpus says that a channel's ``scale`` is its own, the standard deviation is that corpus's.

docs/record.md says what ``corpus.toml`` may contain.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Dict, FrozenSet, Iterable, List, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Episode, Source
from labial.errors import PathLike
from labial.files.faps import FAP_COLUMNS
from labial.files.toml import Table, meant, read_toml

#: The name of the file.
FILE = "corpus.toml"
#: The largest weight: beyond it the other corpora have no effect.
LARGEST_WEIGHT = 1000.0

_KEYS = ("weight", "leave_out", "scale", "silences", "talkers")


def with_sources(folder: PathLike, episodes: Sequence[Episode]) -> List[Episode]:
    """The episodes with their properties from ``corpus.toml``; without that file they are one talker's, in one
    recording. Raises DataError, which names the file and the line or the key."""
    where, path = Path(folder).resolve(), Path(folder) / FILE
    if not path.is_file():
        return [replace(item, source=Source(where.name, str(where))) for item in episodes]
    table = Table(path, "", read_toml(path), _KEYS)
    weight = table.number("weight") if "weight" in table.content else 1.0
    if not 0.0 < weight <= LARGEST_WEIGHT:
        raise table.error("weight", f"{weight:g} is not above 0 and at most {LARGEST_WEIGHT:g}")
    left_out = _channels(table, "leave_out")
    if len(left_out) == len(FAP_COLUMNS):
        raise table.error("leave_out", "nothing is left to learn from")
    common = Source(where.name, str(where), weight, left_out, table.flag("silences", True), _channels(table, "scale"))
    if "talkers" not in table.content:
        return [replace(item, source=common) for item in episodes]
    told = _talkers(table, [item.name for item in episodes])
    return [replace(item, source=replace(common, talker=told[item.name][0], recording=str(where / told[item.name][1])))
            for item in episodes]


def _channels(table: Table, key: str) -> FrozenSet[int]:
    given = table.content.get(key, [])
    if not isinstance(given, list):
        raise table.error(key, "is not a list of channels, such as [\"fap17\"]")
    for name in given:
        if name not in FAP_COLUMNS:
            raise table.error(key, f"no channel is called {name!r}{meant(str(name), FAP_COLUMNS)}")
    return frozenset(FAP_COLUMNS.index(name) for name in given)


def _talkers(table: Table, names: Iterable[str]) -> Dict[str, Tuple[str, str]]:
    """Talker and pattern by the episode's name."""
    given = table.content["talkers"]
    if not isinstance(given, dict) or not given:
        raise table.error("talkers", "is not a table of talkers, NAME = [PATTERN, ...]")
    told: Dict[str, Tuple[str, str]] = {}
    for talker, patterns in given.items():
        if not isinstance(patterns, list) or not patterns or not all(isinstance(item, str) for item in patterns):
            raise table.error(f"talkers.{talker}", "is not a list of names or patterns of episodes")
        for pattern in patterns:
            held = [name for name in names if fnmatchcase(name, pattern)]
            if not held:
                raise table.error(f"talkers.{talker}", f"no episode is called {pattern!r}")
            for name in held:
                if name in told:
                    raise table.error(f"talkers.{talker}",
                                      f"{name} is {pattern!r}, but also {told[name][1]!r} of {told[name][0]}")
                told[name] = (talker, pattern)
    nobody = next((name for name in names if name not in told), None)
    if nobody is not None:
        raise table.error("talkers", f"nobody is told to speak in {nobody}")
    return told


def with_something_left(corpora: Sequence[Sequence[Episode]]) -> List[List[Episode]]:
    """The corpora, including what all of them exclude, since there is nothing better; warns of it."""
    sources = [item.source for corpus in corpora for item in corpus]
    nowhere = frozenset.intersection(*(source.left_out for source in sources)) if sources else frozenset()
    silences = not any(source.silences for source in sources)
    if not nowhere and not silences:
        return [list(corpus) for corpus in corpora]
    names = [FAP_COLUMNS[channel] for channel in sorted(nowhere)] + ["silences"] * silences
    warnings.warn(f"every corpus leaves out {', '.join(names)}: learnt all the same, for want of anything better",
                  stacklevel=3)
    return [[replace(item, source=replace(item.source, left_out=item.source.left_out - nowhere,
                                          silences=item.source.silences or silences)) for item in corpus]
            for corpus in corpora]


def brought_together(corpora: Sequence[Sequence[Episode]], silence: str) -> List[List[Episode]]:
    """The corpora with each recording's mean and standard deviation per channel, outside `silence`, brought to those of
    the first corpus: the means over its recordings' frames. In channels whose scale a further corpus says to be its
    own, the standard deviation is that of the last such corpus, and the mean is as far from the first corpus's rest
    position as that scale makes it. One recording alone stays as it is."""
    values = _sounding((item for corpus in corpora for item in corpus), silence)
    if len(values) < 2:
        return [list(corpus) for corpus in corpora]
    moments = {name: _moments(frames) for name, frames in values.items()}
    share = {name: len(frames) for name, frames in values.items()}
    first = list(dict.fromkeys(item.source.recording for item in corpora[0]))
    if not sum(share[name] for name in first):
        return [list(corpus) for corpus in corpora]
    mean = np.average([moments[name][0] for name in first], axis=0, weights=[share[name] for name in first])
    deviation = _common_deviation(first, moments, share)
    rescaled = False
    for corpus in corpora[1:]:
        channels = sorted(frozenset().union(*(item.source.scales for item in corpus)))
        own = list(dict.fromkeys(item.source.recording for item in corpus))
        if channels and sum(share[name] for name in own):
            factor = _common_deviation(own, moments, share)[channels] / np.maximum(deviation[channels], 1e-9)
            rest = _rest(corpora[0], silence, mean)[channels]
            mean[channels] = rest + (mean[channels] - rest) * factor
            deviation[channels] *= factor
            rescaled = True
    stays = first if len(first) == 1 and not rescaled else []
    return [[item if item.source.recording in stays else _brought(item, moments[item.source.recording], mean, deviation)
             for item in corpus] for corpus in corpora]


def _sounding(corpus: Iterable[Episode], silence: str) -> Dict[str, np.ndarray]:
    """The frames (T, 13) of each recording outside `silence`."""
    values: Dict[str, List[np.ndarray]] = {}
    for item in corpus:
        values.setdefault(item.source.recording, []).append(item.frames[item.sounding(silence)])
    return {name: np.concatenate(frames) for name, frames in values.items()}


def _rest(corpus: Sequence[Episode], silence: str, default: np.ndarray) -> np.ndarray:
    """(13,) FAP: the median pose of the corpus's silences that are learnt from, or `default` if it has none."""
    frames = [item.frames[~item.sounding(silence)] for item in corpus if item.source.silences]
    return np.median(np.concatenate(frames), axis=0) if sum(map(len, frames)) else default


def _common_deviation(names: Sequence[str], moments: Dict[str, Tuple[np.ndarray, np.ndarray]],
                      share: Dict[str, int]) -> np.ndarray:
    """(13,) the standard deviation of several recordings, each about its own mean."""
    return np.sqrt(np.average([moments[name][1] ** 2 for name in names], axis=0, weights=[share[n] for n in names]))


def brought_to(corpus: Sequence[Episode], silence: str, mean: np.ndarray, deviation: np.ndarray) -> List[Episode]:
    """The corpus with each recording's `mean` and `deviation` (13,), FAP, outside `silence`, brought to these."""
    moments = {name: _moments(frames) for name, frames in _sounding(corpus, silence).items()}
    return [_brought(item, moments[item.source.recording], mean, deviation) for item in corpus]


def _brought(item: Episode, own: Tuple[np.ndarray, np.ndarray], mean: np.ndarray, deviation: np.ndarray) -> Episode:
    """The episode with its recording's mean and standard deviation, `own`, brought to others."""
    own_mean, own_deviation = own
    scale = np.divide(deviation, own_deviation, out=np.ones(len(own_mean)), where=own_deviation > 1e-9)
    source = replace(item.source, stretch=tuple(scale.tolist()))
    return replace(item, frames=mean + (item.frames - own_mean) * scale, source=source)


def _moments(frames: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(13,) mean and standard deviation of (T, 13) frames; 0 without frames."""
    frames = frames if len(frames) else np.zeros((1, frames.shape[1]))
    return frames.mean(axis=0), frames.std(axis=0)
