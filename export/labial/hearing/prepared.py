"""Clips as the network learns them: log energies of distorted sounds, Labial's frames and lip classes, kept in a cache.

Each clip is prepared as several *takes*: the first is undistorted but for its level, each of the others has a
distortion drawn by the seed, the clip's name and the number of the take.

A lesson is what is learned of each frame: the true frames, classes and closures, or what a teacher hears, or both. A
teacher is a network that was trained before, larger or with more frames ahead. It hears each take as it was prepared;
the network that learns hears it with the noise and channels of a batch. What is learned is a mean of the truth and of
what the teacher tells, as all parts of the loss but the frames' differences are linear in it; of sounds whose text is
not known, the teacher's alone.
"""

from __future__ import annotations

import hashlib
import json
import os
import zlib
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Callable, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.phonesets import SPEECH
from labial.errors import PathLike, needs
from labial.files.faps import CHANNELS
from labial.files.outputs import writing
from labial.hearing import targets
from labial.hearing.clips import Clip, in_processes
from labial.hearing.distort import Distortion, distorted, drawn
from labial.hearing.features import BANDS, HOPS, RATE, frames_of, log_energies, normalise
from labial.hearing.model import CLASSES, CLOSED, HearingModel
from labial.hearing.network import run

#: Version of what is kept; changes with anything that these functions compute.
_VERSION = 3
#: One clip of so many is held out, by its name.
HELD_OUT = 20
#: Seconds of silence before and after a clip.
_PAUSE = (0.05, 0.6)
#: How often frames count for the score of closed lips: others in speech once; those of p, b, m; of n, t, d, f and v,
#: which sound like them; of p, b, m next to silence; of silence, where the face rests anyway.
_PRESSED, _RIVALS, _EDGES, _SILENCE = 4.0, 2.5, 8.0, 0.3
#: Frames to both sides of p, b, m that count as these, and of silence that are next to it.
_NEAR, _NEXT = 2, 6


@dataclass(frozen=True)
class Prepared:
    """Takes of clips, one after the other; T frames in all."""

    energies: np.ndarray  #: (2 T, 24) float16 log2 energies
    frames: np.ndarray  #: (T, 13) int16 FAP units
    classes: np.ndarray  #: (T,) uint8
    lengths: np.ndarray  #: (N,) int64 frames of each take
    held: np.ndarray  #: (N,) bool: kept from training, to choose by

    def part(self, held: bool) -> Prepared:
        """The takes that are held out, or the others."""
        chosen = self.held == held
        at = np.repeat(chosen, self.lengths)
        return Prepared(self.energies[np.repeat(at, HOPS)], self.frames[at], self.classes[at], self.lengths[chosen],
                        self.held[chosen])


def is_held(sound: PathLike) -> bool:
    """Whether a clip is held out, which its name decides alone."""
    return zlib.crc32(Path(sound).stem.encode("utf-8")) % HELD_OUT == 0


def prepare(clips: Sequence[Clip], takes: int, seed: int, cache: PathLike, jobs: int = 1,
            told: Optional[Callable[[int, int], None]] = None) -> Prepared:
    """`takes` of each of `clips`, from the folder `cache` if they were prepared before. `told` receives how many clips
    are done, and how many there are. Raises DataError for a sound that cannot be read."""
    path = os.path.join(cache, f"{_key(clips, takes, seed)}.npz")
    if os.path.exists(path):
        with np.load(path) as kept:
            return Prepared(*(kept[name] for name in ("energies", "frames", "classes", "lengths", "held")))
    with needs("preparing sounds", "hear"):
        import labial.sound.samples  # noqa: F401
    rows: List[Tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    held: List[bool] = []
    each = partial(prepare_clip, takes=takes, seed=seed)
    for count, found in enumerate(in_processes(each, clips, jobs, 8), 1):
        rows += found
        held += [is_held(clips[count - 1].sound)] * len(found)
        if told:
            told(count, len(clips))
    energies, frames, classes = (np.concatenate(parts) for parts in zip(*rows))
    result = Prepared(energies, frames, classes, np.array([len(row[2]) for row in rows]), np.array(held))
    os.makedirs(cache, exist_ok=True)
    with writing(path) as out:
        np.savez(out, energies=energies, frames=frames, classes=classes, lengths=result.lengths, held=result.held)
    return result


def prepare_clip(clip: Clip, takes: int, seed: int) -> List[Tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Energies, frames and classes of each take of a clip, as in :class:`Prepared`."""
    from labial.sound.samples import read_sound

    samples = read_sound(clip.sound)
    random = np.random.default_rng([seed, zlib.crc32(Path(clip.sound).stem.encode("utf-8"))])
    found = []
    for take in range(takes):
        before, after = (float(random.uniform(*_PAUSE)) for _ in range(2))
        padded, segments = with_pauses(samples, clip.segments, before, after)
        distortion = drawn(random) if take else Distortion(peak=float(random.uniform(-25, -3)))
        sound, timings = distorted(padded, distortion, random), targets.durations(segments, distortion.speed)
        count = frames_of(len(sound))
        frames = np.clip(np.round(targets.frames(timings, count)), -32768, 32767).astype(np.int16)
        found.append((log_energies(sound).astype(np.float16), frames, targets.classes(timings, count)))
    return found


def with_pauses(samples: np.ndarray, segments: Sequence[Segment], before: float,
                after: float) -> Tuple[np.ndarray, List[Segment]]:
    """A sound between digital silence of `before` and `after` seconds, and its segments."""
    lead, tail = round(before * RATE), round(after * RATE)
    shift = lead / RATE
    padded = np.concatenate([np.zeros(lead, np.float32), samples, np.zeros(tail, np.float32)])
    moved = [Segment(item.start + shift, item.end + shift, item.label) for item in segments]
    return padded, [Segment(0.0, shift, SPEECH.silence), *moved]


def _key(clips: Sequence[Clip], takes: int, seed: int) -> str:
    """A name for what `prepare` makes: of the sounds' files and segments, the voice to be learned, and options."""
    rows = []
    for clip in clips:
        status = os.stat(clip.sound)
        labels = [[round(item.start, 4), round(item.end, 4), item.label] for item in clip.segments]
        rows.append([os.path.basename(clip.sound), status.st_size, status.st_mtime_ns, labels])
    said = [(phoneme, 5 * targets.FRAME_MS) for phoneme in SPEECH.phonemes]
    voice = hashlib.sha256(targets.frames(said, 5 * len(said)).tobytes()).hexdigest()
    text = json.dumps([_VERSION, takes, seed, CHANNELS, BANDS, voice, rows])
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:24]


@dataclass(frozen=True)
class Lesson:
    """T frames of a folder's takes, one after the other."""

    energies: np.ndarray  #: (2 T, 24) float16 log2 energies
    frames: np.ndarray  #: (T, 13) int16 FAP units
    classes: np.ndarray  #: (T,) uint8: the true, or likeliest, class
    likely: np.ndarray  #: (T, 26) float16: how likely each class is
    closed: np.ndarray  #: (T,) float16: how likely lips touch in p, b, m
    weight: np.ndarray  #: (T,) float16: how often the frame counts for `closed`


def lesson(part: Prepared, teacher: Optional[HearingModel] = None, share: float = 0.0) -> Lesson:
    """What is to be learned of takes; a `teacher` tells this share of it, 1 for takes of which no truth is known."""
    frames, classes = part.frames, part.classes
    likely = np.eye(len(CLASSES), dtype=np.float16)[classes]
    closed = targets.touching(frames.astype(np.float32), classes).astype(np.float16)
    if teacher is not None:
        frames = frames.copy()
        for end, length in zip(np.cumsum(part.lengths), part.lengths):
            at = slice(end - length, end)
            energies = part.energies[HOPS * at.start : HOPS * end].astype(np.float32)
            told = run(teacher, normalise(energies).reshape(length, -1))
            odds = np.exp(told.scores - told.scores.max(axis=1, keepdims=True))
            likely[at] = (1 - share) * likely[at] + share * odds / odds.sum(axis=1, keepdims=True)
            closed[at] = (1 - share) * closed[at] + share / (1 + np.exp(-np.clip(told.closed, -30, 30)))
            frames[at] = np.rint((1 - share) * frames[at] + share * told.faps)
        if share == 1:
            classes = likely.argmax(axis=1).astype(np.uint8)
    pressed, silence = _around(classes == CLASSES.index(CLOSED), _NEAR), classes == CLASSES.index("SIL")
    rivals = np.isin(classes, [CLASSES.index("T"), CLASSES.index("F")])
    weight = np.select([pressed & _around(silence, _NEXT), pressed, rivals, silence],
                       [_EDGES, _PRESSED, _RIVALS, _SILENCE], 1.0)
    return Lesson(part.energies, frames, classes, likely, closed, weight.astype(np.float16))


def _around(where: np.ndarray, reach: int) -> np.ndarray:
    """(T,) bool: within `reach` frames of a true one."""
    counts = np.concatenate([[0], np.cumsum(where)])
    at = np.arange(len(where))
    return counts[np.minimum(at + reach + 1, len(where))] > counts[np.maximum(at - reach, 0)]
