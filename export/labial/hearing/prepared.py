"""Clips as the network learns them: log energies of distorted sounds, Labial's frames and lip classes, kept in a cache.

Each clip is prepared as several *takes*: the first is undistorted but for its level, each of the others has a
distortion drawn by the seed, the clip's name and the number of the take.
"""

from __future__ import annotations

import hashlib
import json
import os
import zlib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Callable, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import PathLike
from labial.errors import needs
from labial.files.faps import CHANNELS
from labial.files.outputs import writing
from labial.hearing import targets
from labial.hearing.clips import Clip
from labial.hearing.distort import Distortion, distorted, drawn
from labial.hearing.features import BANDS, HOPS, RATE, frames_of, log_energies

#: Version of what is kept; changes with anything that these functions compute.
_VERSION = 3
#: One clip of so many is held out, by its name.
HELD_OUT = 20
#: Seconds of silence before and after a clip.
_PAUSE = (0.05, 0.6)


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


def prepare(
    clips: Sequence[Clip], takes: int, seed: int, cache: PathLike, jobs: int = 1,
    told: Optional[Callable[[int, int], None]] = None,
) -> Prepared:
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
    for count, found in enumerate(_prepared(clips, takes, seed, jobs), 1):
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


def _prepared(clips: Sequence[Clip], takes: int, seed: int, jobs: int) -> Iterable[List[_Take]]:
    each = partial(prepare_clip, takes=takes, seed=seed)
    if jobs == 1:
        yield from map(each, clips)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(each, clips, chunksize=8)


_Take = Tuple[np.ndarray, np.ndarray, np.ndarray]


def prepare_clip(clip: Clip, takes: int, seed: int) -> List[_Take]:
    """Energies, frames and classes of each take of a clip, as in :class:`Prepared`."""
    from labial.sound.samples import read_sound

    samples = read_sound(clip.sound)
    random = np.random.default_rng([seed, zlib.crc32(Path(clip.sound).stem.encode("utf-8"))])
    found = []
    for take in range(takes):
        before, after = (float(random.uniform(*_PAUSE)) for _ in range(2))
        padded, segments = with_pauses(samples, clip.segments, before, after)
        distortion = drawn(random) if take else Distortion(peak=float(random.uniform(-25, -3)))
        found.append(_take(distorted(padded, distortion, random), targets.durations(segments, distortion.speed)))
    return found


def with_pauses(
    samples: np.ndarray, segments: Sequence[Segment], before: float, after: float
) -> Tuple[np.ndarray, List[Segment]]:
    """A sound between digital silence of `before` and `after` seconds, and its segments."""
    lead, tail = round(before * RATE), round(after * RATE)
    shift = lead / RATE
    padded = np.concatenate([np.zeros(lead, np.float32), samples, np.zeros(tail, np.float32)])
    moved = [Segment(item.start + shift, item.end + shift, item.label) for item in segments]
    return padded, [Segment(0.0, shift, SPEECH.silence), *moved]


def _take(sound: np.ndarray, timings: Sequence[Tuple[str, int]]) -> _Take:
    count = frames_of(len(sound))
    frames = targets.frames(timings, count)
    return (log_energies(sound).astype(np.float16), np.clip(np.round(frames), -32768, 32767).astype(np.int16),
            targets.classes(timings, count))


def _key(clips: Sequence[Clip], takes: int, seed: int) -> str:
    """A name for what `prepare` makes: of the sounds' names, sizes and times, their segments, the voice whose frames
    are learned, and the options."""
    rows = []
    for clip in clips:
        status = os.stat(clip.sound)
        labels = [[round(item.start, 4), round(item.end, 4), item.label] for item in clip.segments]
        rows.append([os.path.basename(clip.sound), status.st_size, status.st_mtime_ns, labels])
    text = json.dumps([_VERSION, takes, seed, CHANNELS, BANDS, _voice(), rows])
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:24]


def _voice() -> str:
    """A name for the voice whose frames are learned: of the frames of all its phonemes."""
    said = [(phoneme, 5 * targets.FRAME_MS) for phoneme in SPEECH.phonemes]
    return hashlib.sha256(targets.frames(said, 5 * len(said)).tobytes()).hexdigest()
