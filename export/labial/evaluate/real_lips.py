"""``labial evaluate-hear --lips``: lips from sound against lips that were measured in video.

A folder is a corpus of motion and phonemes (:mod:`labial.corpus.folder`). Its sounds lie beside the episodes, with
their names, or ``energies.npz`` holds what hearing's front end makes of them: for each episode whose sound was there
``NAME.npy``, (n, 24) log2 energies, two rows to a frame of 20 ms (:func:`labial.hearing.features.log_energies`). So a
corpus that may not hold sound can be judged by. Episodes without either are left out.

What is measured is the correlation with the real lips in frames of speech. Each clip is centred, as the rest of a face
in a video is uncertain; the frames of a talker's clips count together, and talkers count alike.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.corpora import read_corpus
from labial.corpus.episode import Episode
from labial.corpus.formats import SOUNDS
from labial.errors import DataError, PathLike, needs
from labial.evaluate.hearing import loudness_of
from labial.files.arrays import ArrayError, array, read_zip
from labial.files.faps import FAP_NUMBERS
from labial.files.frames import opening, sampled
from labial.hearing import integer, network, targets
from labial.hearing.features import BANDS, FLOOR, FRAME, HOPS, log_energies
from labial.hearing.measures import RATE
from labial.hearing.model import CLASSES, HearingModel
from labial.hearing.quantise import quantise
from labial.runtime.hearing import with_sound

#: The file of log energies, and the most bytes that it may have, unpacked: some hours.
ENERGIES, LARGEST = "energies.npz", 128_000_000
#: The largest log2 energy of a band: that of a full-scale square wave is below.
_MOST = 48.0
#: Frames of digital silence after a sound, more than any network looks ahead.
_AFTER = 27

_SILENCE = CLASSES.index("SIL")
_JAW, _UPPER, _LOWER, _LEFT, _RIGHT = (FAP_NUMBERS.index(number) for number in (3, 51, 52, 53, 54))


class Clip(NamedTuple):
    """T frames of a talker's speech with its sound."""

    talker: str
    energies: np.ndarray  #: (n, 24) float32 log2 energies, n of at least 2 T
    real: np.ndarray  #: (T, 13) FAP units, measured in video
    timings: List[Tuple[str, int]]  #: phonemes with their milliseconds
    speech: np.ndarray  #: (T,) bool


class Group(NamedTuple):
    """Clips that are judged together."""

    name: str
    clips: List[Clip]


class Row(NamedTuple):
    """What a method reaches on a group: correlations, the means over talkers; NaN where nothing moves."""

    group: str
    talkers: int
    clips: int
    seconds: float  #: of speech
    method: str
    opening: float
    jaw: float
    upper: float
    lower: float
    corners: float

    @property
    def five(self) -> float:
        """The mean of the five correlations."""
        return float(np.mean([self.opening, self.jaw, self.upper, self.lower, self.corners]))


#: A clip -> (T, 13) frames.
Method = Callable[[Clip], np.ndarray]


def group(folders: Sequence[PathLike]) -> Group:
    """The clips of several corpora, in which talkers of the same name are one person. Raises DataError as
    :func:`labial.corpus.corpora.read_corpus`, for energies that are not what this module describes, and for a folder
    without sound."""
    clips: List[Clip] = []
    for folder in map(Path, folders):
        episodes = {episode.name: episode for episode in read_corpus(folder)}
        path = folder / ENERGIES
        found = _kept(path, episodes) if path.exists() else {
            name: energies for name in episodes if (energies := _sound(folder, name)) is not None}
        if not found:
            raise DataError(folder, None, f"no episode has its sound: neither {ENERGIES} nor sounds are there")
        clips += [_clip(episodes[name], energies) for name, energies in found.items()]
    return Group("+".join(Path(folder).resolve().name for folder in folders), clips)


def _clip(episode: Episode, energies: np.ndarray) -> Clip:
    count = _frames(episode)
    timings = targets.durations(episode.segments)
    speech = targets.classes(timings, count) != _SILENCE
    return Clip(episode.source.talker, energies, sampled(episode.times, episode.frames, RATE, count), timings, speech)


def _frames(episode: Episode) -> int:
    """How many frames the phonemes of an episode last."""
    return int(episode.segments[-1].end * RATE)


def _kept(path: Path, episodes: Dict[str, Episode]) -> Dict[str, np.ndarray]:
    """The energies of a file by episode, checked."""
    try:
        members = read_zip(path, None, LARGEST)
    except (ArrayError, OSError) as error:
        raise DataError(path, None, getattr(error, "strerror", None) or str(error)) from None
    found = {}
    for member in sorted(members):
        name, suffix = os.path.splitext(member)
        if suffix != ".npy" or name not in episodes:
            raise DataError(path, None, f"{member!r:.80} is not the energies of an episode of this folder")
        try:
            value = array(member, members[member])
        except ArrayError as error:
            raise DataError(path, None, str(error)) from None
        if value.ndim != 2 or value.shape[1] != BANDS or value.dtype.kind != "f":
            raise DataError(path, None, f"{member} has shape {value.shape} and type {value.dtype}, not (n, {BANDS}) of "
                            "real numbers")
        if not ((value >= FLOOR) & (value <= _MOST)).all():
            raise DataError(path, None, f"{member} has an energy that is not within {FLOOR:g} .. {_MOST:g}")
        rows = HOPS * _frames(episodes[name])
        if len(value) < rows or len(value) % HOPS:
            raise DataError(path, None, f"{member} has {len(value)} rows; {name} takes an even number, at least {rows}")
        found[name] = value.astype(np.float32)
    return found


def _sound(folder: Path, name: str) -> Optional[np.ndarray]:
    """The energies of the sound beside an episode, if there is one."""
    for suffix in SOUNDS:
        path = folder / (name + suffix)
        if path.is_file():
            with needs(f"{path}: reading sounds", "hear"):
                from labial.sound.samples import read_sound
            return log_energies(np.clip(np.rint(read_sound(path) * 32767), -32768, 32767))
    return None


def _padded(clip: Clip) -> np.ndarray:
    """The energies of a clip with silence after them, as far as a network may look ahead."""
    missing = max(HOPS * (len(clip.real) + _AFTER) - len(clip.energies), 0)
    return np.pad(clip.energies, ((0, missing), (0, 0)), constant_values=FLOOR)


def methods(model: HearingModel) -> Dict[str, Method]:
    """The network in floating point and in the library's integers, what follows loudness, Labial's own frames of the
    phonemes at their true times, and these with the sound's share (:func:`labial.with_sound`)."""
    tables = quantise(model, "hear")

    def integers(clip: Clip) -> np.ndarray:
        energies = np.rint(_padded(clip).astype(np.float64) * integer.LOG).astype(np.int64)
        return integer.hear_energies(tables, energies, len(clip.real)).faps

    def loudness(clip: Clip) -> np.ndarray:
        power = np.exp2(clip.energies.astype(np.float64)).sum(axis=1)[: HOPS * len(clip.real)]
        return loudness_of(10 * np.log10(power.reshape(-1, HOPS).mean(axis=1) / FRAME))

    def phonemes(clip: Clip) -> np.ndarray:
        return targets.frames(clip.timings, len(clip.real))

    return {"network": lambda clip: network.hear_energies(model, _padded(clip), len(clip.real)).faps,
            "integers": integers, "loudness": loudness,
            "phonemes": phonemes,
            "phonemes and sound": lambda clip: np.array(with_sound(phonemes(clip).tolist(), integers(clip).tolist()))}


def channels(frames: np.ndarray) -> np.ndarray:
    """(T, 5) opening, jaw, upper lip, lower lip and corners of frames (T, 13), FAP units."""
    frames = np.asarray(frames, dtype=np.float64)
    return np.stack([opening(frames), frames[:, _JAW], frames[:, _UPPER], frames[:, _LOWER],
                     frames[:, _LEFT] + frames[:, _RIGHT]], axis=1)


def correlations(clips: Sequence[Tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """(C,) correlation of the columns of pairs (T, C), each of which is centred; NaN where one does not move."""
    one, other = (np.concatenate([item - item.mean(axis=0) for item in side if len(item)]) for side in zip(*clips))
    scale = np.sqrt((one**2).sum(axis=0) * (other**2).sum(axis=0))
    return np.where(scale > 1e-9, (one * other).sum(axis=0) / np.maximum(scale, 1e-9), np.nan)


def evaluated(groups: Sequence[Group], judged: Dict[str, Method]) -> Iterator[Row]:
    """A row for each group and method."""
    for item in groups:
        clips = [clip for clip in item.clips if clip.speech.any()]
        talkers = sorted({clip.talker for clip in clips})
        seconds = sum(int(clip.speech.sum()) for clip in clips) / RATE
        for name, method in judged.items():
            pairs: Dict[str, List[Tuple[np.ndarray, np.ndarray]]] = {talker: [] for talker in talkers}
            for clip in clips:
                real, heard = channels(clip.real), channels(method(clip))
                pairs[clip.talker].append((real[clip.speech], heard[clip.speech]))
            each = np.array([correlations(pairs[talker]) for talker in talkers]).reshape(-1, 5)
            mean = each.mean(axis=0) if len(each) else np.full(5, np.nan)
            yield Row(item.name, len(talkers), len(clips), seconds, name, *(float(value) for value in mean))


COLUMNS = ("lips of", "method", "opening", "jaw", "upper lip", "lower lip", "corners", "mean of five", "talkers",
           "clips", "speech, s")


def table(rows: Sequence[Row]) -> str:
    """A table in Markdown."""
    lines = [f"| {' | '.join(COLUMNS)} |", f"|{'---|' * 2}{'---:|' * (len(COLUMNS) - 2)}"]
    for row in rows:
        values = (row.opening, row.jaw, row.upper, row.lower, row.corners, row.five)
        lines.append(f"| {row.group} | {row.method} | {' | '.join(f'{value:.3f}' for value in values)} | {row.talkers} "
                     f"| {row.clips} | {row.seconds:.0f} |")
    return "\n".join(lines) + "\n"
