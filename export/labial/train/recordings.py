"""Training material: recordings on the model's frame grid, with phonemes as numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Iterable, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus import resample
from labial.corpus.episode import Episode, Source
from labial.corpus.phonesets import PhoneSet
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.reference.contact import REST
from labial.reference.shape import neighbours
from labial.reference.units import pause_cut


@dataclass(frozen=True)
class Recording:
    """One episode with S phonemes, of at least a frame each, in T frames. Frame t of the human motion is sampled at
    (t + 1/2) / fps."""

    name: str
    phoneme: np.ndarray  #: (S,) int64, index into the phone set
    duration: np.ndarray  #: (S,) seconds
    length: np.ndarray  #: (S,) int64, frames of each phoneme; sums to T
    apex: np.ndarray  #: (S,) int64, the frame of the audio envelope's maximum, or of the middle
    frames: np.ndarray  #: (T, 13) human motion, FAP
    weight: Optional[np.ndarray] = None  #: (T, 13) weight of each value; None: 1 everywhere
    resting: Optional[np.ndarray] = None  #: (T,) int64, progress to rest in pauses; None: 0 everywhere
    talker: str = ""
    stretch: Optional[np.ndarray] = None  #: (13,) what his motion was multiplied by; None: 1

    @property
    def own_scale(self) -> np.ndarray:
        """(13,) what brings the motion back to the talker's own scale."""
        return np.ones(self.frames.shape[1]) if self.stretch is None else 1.0 / np.maximum(self.stretch, 1e-9)

    @property
    def rest(self) -> np.ndarray:
        """(T,) int64: progress to rest in divided pauses, of :data:`REST`."""
        return np.zeros(len(self.frames), dtype=np.int64) if self.resting is None else self.resting

    @property
    def weights(self) -> np.ndarray:
        """(T, 13): the weight of each value."""
        return np.ones(self.frames.shape) if self.weight is None else self.weight

    def learnt(self) -> np.ndarray:
        """(S,) bool: whether anything of a phoneme's occurrence is learnt."""
        return np.maximum.reduceat(self.weights.max(axis=1), np.cumsum(self.length) - self.length) > 0

    def phoneme_at(self) -> np.ndarray:
        """(T,) int64: the phoneme of each frame."""
        return np.repeat(self.phoneme, self.length)

    def sounds(self, silence: int) -> np.ndarray:
        """(T,) bool: the frames outside silence."""
        return self.phoneme_at() != silence

    def learnt_sounds(self, silence: int) -> np.ndarray:
        """(T, 13) bool: the values outside silence that are learnt."""
        return self.sounds(silence)[:, None] & (self.weights > 0)


def taught(material: Sequence[Recording], channel: int) -> np.ndarray:
    """(N,) the values of a channel that count."""
    return np.concatenate([item.frames[item.weights[:, channel] > 0, channel] for item in material])


def recordings(corpus: Iterable[Episode], phone_set: PhoneSet, fps: int) -> List[Recording]:
    """Resamples every episode to `fps` frames per second and converts its labels to numbers."""
    number = {label: index for index, label in enumerate(phone_set.phonemes)}
    silence = number[phone_set.silence]
    result = []
    for episode in corpus:
        resampled = resample(episode, fps)
        if len(resampled.motion) < 3:
            continue  # too short for a delta-delta
        labels = [segment.label for segment in episode.segments]
        unknown = sorted(set(labels) - set(number))
        if unknown:
            raise LabialError(f"{episode.name}: labels {', '.join(unknown)} are not in the {phone_set.kind} phone set")
        seen = np.flatnonzero(resampled.length > 0)  # the run-time skips phonemes without frames
        phoneme = np.array([number[labels[index]] for index in seen], dtype=np.int64)
        length = resampled.length[seen]
        centre = episode.segments[0].start + (np.arange(len(resampled.motion)) + 0.5) / fps
        missing = np.zeros(len(centre), dtype=bool)
        for start, end in episode.unseen(phone_set.silence):
            missing |= (centre > start) & (centre < end)
        result.append(
            Recording(name=episode.name, phoneme=phoneme,
                      duration=np.array([episode.segments[index].duration for index in seen]), length=length,
                      apex=resampled.apex[seen], frames=resampled.motion,
                      weight=_weights(episode.source, np.repeat(phoneme, length) == silence, missing),
                      talker=episode.source.talker,
                      stretch=np.array(episode.source.stretch) if episode.source.stretch else None))
    if not result:
        raise LabialError("the corpus holds no episode that is long enough to train on")
    return result


def with_pauses_cut(item: Recording, silence: int, ahead: int, fps: int) -> Recording:
    """The recording with its pauses divided like in the run-time with kernels that look `ahead` frames ahead. The apex
    stays with its part; that of the other part is its middle."""
    rows: List[Tuple[int, float, int, int]] = []
    resting = np.zeros(len(item.frames), dtype=np.int64)
    begin = 0
    for phoneme, duration, length, apex in zip(item.phoneme, item.duration, item.length, item.apex):
        parts = pause_cut(int(length), round(1000 * duration), ahead, fps) if phoneme == silence else []
        if len(parts) > 1:
            last = begin + length == len(resting)
            count = int(length) if last else parts[0][0]
            resting[begin : begin + count] = np.minimum(np.arange(1, count + 1), REST) if begin else REST
        for frames, milliseconds in parts if len(parts) > 1 else [(int(length), 1000 * duration)]:
            middle = begin + frames // 2
            rows.append((phoneme, milliseconds / 1000.0, frames, apex if begin <= apex < begin + frames else middle))
            begin += frames
    phoneme, duration, length, apex = map(np.array, zip(*rows))
    return replace(item, phoneme=phoneme, duration=duration, length=length, apex=apex, resting=resting)


def _weights(source: Source, silent: np.ndarray, missing: np.ndarray) -> Optional[np.ndarray]:
    """(T, 13) weights of the values of an episode, of which `silent` (T,) are silence, and of `missing` (T,) the
    motion is unknown; None if all are 1."""
    if source == replace(source, weight=1.0, left_out=frozenset(), silences=True) and not missing.any():
        return None
    weight = np.full((len(silent), CHANNELS), source.weight)
    weight[:, sorted(source.left_out)] = 0.0
    if not source.silences:
        weight[silent] = 0.0
    weight[missing] = 0.0
    return weight


@dataclass(frozen=True)
class Occurrences:
    """All S phoneme occurrences of a set of recordings, one after the other."""

    phoneme: np.ndarray  #: (S,) int64
    duration: np.ndarray  #: (S,) seconds
    previous: np.ndarray  #: (S,) int64, viseme class of the phoneme before; that of silence at the start
    next: np.ndarray  #: (S,) int64, viseme class of the phoneme after; that of silence at the end
    apex_shape: np.ndarray  #: (S, 13) human motion at the apex, FAP
    learnt: np.ndarray  #: (S,) bool, whether its apex is learnt

    def vectors(self) -> np.ndarray:
        """(S, 14): the training vectors of equation 1, shape (FAP) at the apex joined with the duration (seconds)."""
        return np.concatenate([self.apex_shape, self.duration[:, None]], axis=1)


def neighbour_classes(phoneme: np.ndarray, viseme_class: np.ndarray, silence: int) -> Tuple[np.ndarray, np.ndarray]:
    """Viseme classes of the phonemes before and after each of (S,) phonemes."""
    before, after = neighbours(phoneme, silence)
    return viseme_class[before], viseme_class[after]


def occurrences(material: List[Recording], phone_set: PhoneSet) -> Occurrences:
    """Gathers the phoneme occurrences of `material` in order."""
    silence = phone_set.phonemes.index(phone_set.silence)
    viseme_class = np.asarray(phone_set.viseme_class, dtype=np.int64)
    previous, following = np.concatenate([neighbour_classes(item.phoneme, viseme_class, silence) for item in material],
                                         axis=1)
    return Occurrences(phoneme=np.concatenate([item.phoneme for item in material]),
                       duration=np.concatenate([item.duration for item in material]),
                       previous=previous, next=following,
                       apex_shape=np.concatenate([item.frames[item.apex] for item in material]),
                       learnt=np.concatenate([item.weights[item.apex].any(axis=1) for item in material]))
