"""Hearing: sound in, in blocks of any length; frames out; and lips from phonemes and from the sound, mixed."""

from __future__ import annotations

import ctypes
import math
import sys
from array import array
from collections.abc import AsyncIterable, AsyncIterator, Iterable, Iterator, Sequence
from functools import cache
from typing import Any, List, NamedTuple, Optional, Tuple, Union

from labial.core.guard import Closing, articulation, duration, number, opened, whole
from labial.core.library import CANCEL_MAX, checked, library, memory, texts
from labial.errors import LabialError, did_you_mean
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.runtime.rig import faps_of
from labial.runtime.stream import Frame
from labial.tables.visemes import VISEMES

#: Frames per second, LABIAL_HEAR_FPS.
FPS = 50
#: The models that are used where none is named.
_FIRST = ("hear_host", "hear_small")
#: Bytes of a sample.
_SAMPLE = 2
#: Most frames that the end delivers, and a cancel before it eases.
_LAST = 64
#: LABIAL_HEAR_LEVEL_MIN, and how often a second the level is looked at.
_LEVEL_MIN, _LOOKS = 3328, 100
#: Samples that are heard in one call of C.
_PIECE = 1 << 16
#: A block of sound: bytes of int16, low byte first; or an object with a buffer of int16, such as array("h") or a numpy
#: array, of shape (N,) or (N, channels).
Sound = Union[bytes, bytearray, memoryview, "array[int]", Any]


class Shown(NamedTuple):
    """A stretch of frames in which one lip class leads."""

    name: str  #: an ARPABET phoneme that stands for the class: "M" for p, b, m
    frame: int  #: the first frame
    frames: int  #: how many


@cache
def models() -> Tuple[str, ...]:
    """The names of the models of hearing that the library has, the first of which is used where none is named:
    hear_host, or hear_small in a library that has no room for it."""
    return tuple(sorted(texts(library().hearing_name),
                        key=lambda item: (_FIRST.index(item) if item in _FIRST else len(_FIRST), item)))


class Hearing(Closing):
    """Ears: hears speech, and makes frames of it.

        with labial.Hearing(24000) as hearing:
            for block in microphone:
                for frame in hearing.push(block):
                    show(frame)
            for frame in hearing.end():
                show(frame)

    Frame k shows the lips in the 20 ms of sound that begin at 20 k ms, and is ready :attr:`latency` later. The sound
    should be speech alone; its level does not matter down to peaks of 1/100 of full scale. The face begins and ends at
    rest, and is there in silence.

    Calls from several threads wait for each other, as those of :class:`labial.Stream`. Closing frees the memory.

    Args:
        sample_rate: samples per second: 8000, 12000, 16000, 22050, 24000, 32000, 44100 or 48000. channels: 1 or 2, of
        which the mean is heard. model: "hear_host" (the default); "hear_ahead", which looks 160 ms further ahead, for
        files and for sound that waits before it is played; "hear_large" or "hear_small", which are
        those of small chips. exact: the end returns the frames of the sound alone, without the 12 in which the face
        comes to rest.
    """

    _what = "hearing"

    def __init__(self, sample_rate: int = 16000, channels: int = 1, *, model: Optional[str] = None,
                 exact: bool = False) -> None:
        super().__init__()
        core, names = library(), models()
        model = names[0] if model is None and names else model or ""
        if model not in names:
            raise LabialError(f"{model!r} is no model of hearing: {did_you_mean(model, names)}")
        self._sample_rate, self._channels = whole(sample_rate, "a sample rate"), whole(channels, "a number of channels")
        number = texts(core.hearing_name).index(model)
        self._names = [core.hearing_class(number, k).decode("ascii") for k in range(core.hearing_classes(number))]
        self._model = model
        self._library = core
        self._memory = memory(core.ears_size())
        self._address = ctypes.addressof(self._memory)
        if not (0 <= self._sample_rate < 2**32 and 0 <= self._channels < 2**32):
            raise LabialError(f"a rate of {sample_rate} and {channels} channels are not supported")
        checked(core.ears_init(self._address, core.hearing_model(number), self._sample_rate, self._channels),
                f"{sample_rate} samples per second, channels: {channels}")
        checked(core.ears_exact(self._address, bool(exact)))
        self._number = 0  # of the next frame
        self._part = b""  # the beginning of a sample whose end has not come
        self._shown: List[Shown] = []

    # ---- Sound in, frames out

    @opened
    def push(self, sound: Sound) -> List[Frame]:
        """Hears a block of any length, and returns the frames that are ready by now. Bytes may end within a sample.

        Raises StreamError after :meth:`end` or :meth:`cancel`; TypeError for anything but int16 or bytes; LabialError
        for an array whose shape does not fit the channels.
        """
        samples = self._samples(sound)
        frames: List[Frame] = []
        step = _PIECE * self._channels
        for first in range(0, len(samples), step):
            piece = samples[first : first + step]
            count = len(piece) // self._channels
            room = count * FPS // self._sample_rate + 2
            frames += self._called(self._library.ears_push, room, piece.buffer_info()[0], count)
        return frames

    @opened
    def end(self) -> List[Frame]:
        """No more sound will come: returns the frames that are still to come, and the way to rest."""
        self._part = b""
        return self._called(self._library.ears_end, _LAST)

    @opened
    def cancel(self, milliseconds: float = 200) -> List[Frame]:
        """Drops what is not yet delivered, and returns the frames of the way back to the neutral face, over so many
        milliseconds, rounded up to whole frames, 1 to 1,000."""
        self._part = b""
        length = math.ceil(duration(milliseconds))
        return self._called(self._library.ears_cancel, min(length * FPS // 1000, CANCEL_MAX) + _LAST, length)

    @opened
    def restart(self) -> None:
        """Continues after :meth:`end` or :meth:`cancel`: frame numbers continue, and the first frames fade in from the
        last one. Raises StreamError before the end."""
        checked(self._library.ears_restart(self._address), "restart")

    @property
    @opened
    def level(self) -> int:
        """The level of the voice: 1/256 of log2, 85 for a decibel (``labial_hear_level()``). A sound begins at that of
        the sound before. Set it before a sound if you know it; StreamError is raised while one is heard, and
        for a level out of range."""
        return int(self._library.ears_level(self._address))

    @level.setter
    @opened
    def level(self, level: int) -> None:
        value = whole(level, "a level")
        checked(self._library.ears_set_level(self._address, min(max(value, 0), 2**31 - 1)), f"the level {level}")

    def measure(self, sound: Sound) -> int:
        """Sets the level to the largest one of a whole sound that is there before it is heard, and returns it: so the
        first word, too, is heard at its level. To be called before the first sound; it hears all of the sound, in
        another stream."""
        with Hearing(self._sample_rate, self._channels, model=self._model) as other:
            other.level = found = _LEVEL_MIN
            samples = other._samples(sound)
            other._part = b""  # bytes behind the last sample, which would shift the blocks
            step = self._sample_rate // _LOOKS * self._channels
            for first in range(0, len(samples), step):
                other.push(samples[first : first + step])
                found = max(found, other.level)
        self.level = found
        return found

    @opened
    def articulation(self, percent: float) -> None:
        """How far the mouth moves, 0 to 200 percent, as :meth:`labial.Stream.articulation`. Raises LabialError for a
        number out of range."""
        checked(self._library.ears_articulation(self._address, articulation(percent)), "articulation")

    def frames(self, blocks: Iterable[Sound]) -> Iterator[Frame]:
        """The frames of all blocks, to their end."""
        for block in blocks:
            yield from self.push(block)
        yield from self.end()

    async def follow(self, blocks: AsyncIterable[Sound]) -> AsyncIterator[Frame]:
        """The same for blocks that come from an asynchronous iterator, such as a cloud's voice."""
        async for block in blocks:
            for frame in self.push(block):
                yield frame
        for frame in self.end():
            yield frame

    @opened
    def shown(self) -> List[Shown]:
        """The stretches of lip classes that ended since the last call."""
        found, self._shown = self._shown, []
        return found

    @property
    @opened
    def latency(self) -> float:
        """Seconds from a frame's begin until it is ready: .12, with hear_ahead .28."""
        return float(self._library.ears_latency(self._address)) / 1000.0

    @property
    def fps(self) -> int:
        """Frames per second."""
        return FPS

    # ---- With the lock held

    def _samples(self, sound: Sound) -> array[int]:
        """The whole samples of a block, with what was left of the one before."""
        try:
            view = memoryview(sound)
        except TypeError:
            raise TypeError(f"sound is bytes or int16, not {type(sound).__name__}") from None
        data = view.tobytes()
        if view.itemsize == _SAMPLE and view.format in ("h", "<h", "=h", "@h"):
            shape = view.shape or ()
            if len(shape) != 1 and (len(shape) != 2 or shape[1] != self._channels):
                raise LabialError(f"a block of shape {shape} does not have {self._channels} channels")
            if sys.byteorder == "big" and view.format != "<h":
                data = _swapped(data)
        elif view.format not in ("B", "b", "c"):
            raise TypeError(f"sound is bytes or int16, not items of the format {view.format!r}")
        data = self._part + data
        cut = len(data) - len(data) % (_SAMPLE * self._channels)
        self._part = data[cut:]
        samples = array("h", data[:cut])
        if sys.byteorder == "big":
            samples.byteswap()
        return samples

    def _called(self, function: Any, room: int, *arguments: int) -> List[Frame]:
        """The frames of a call."""
        faps, shown = array("h", bytes(_SAMPLE * CHANNELS * room)), (ctypes.c_uint32 * (3 * room))()
        sounds = array("B", bytes(len(VISEMES) * room))
        count = checked(function(self._address, *arguments, faps.buffer_info()[0], sounds.buffer_info()[0],
                                 ctypes.addressof(shown), room))
        rows = zip(*[iter(faps[: CHANNELS * count])] * CHANNELS)
        shares = zip(*[iter(sounds)] * len(VISEMES))
        frames = [Frame(self._number + k, row, own) for k, (row, own) in enumerate(zip(rows, shares))]
        self._number += count
        for k in range(min(self._library.ears_stretches(self._address), room)):
            name, first, length = shown[3 * k : 3 * k + 3]
            self._shown.append(Shown(self._names[name], first, length))
        return frames


def _swapped(data: bytes) -> bytes:
    samples = array("h", data)
    samples.byteswap()
    return samples.tobytes()


#: The share of the sound's lips that is nearest to people's beside phonemes (docs/hearing.md).
SHARE = 0.3
#: Openings of the phonemes' lips, FAP units: up to the first one the sound has no say over lips and jaw, from the
#: second one on its whole share.
_CLOSED, _FREE = 72.0, 200.0
_UPPER, _LOWER = FAP_NUMBERS.index(51), FAP_NUMBERS.index(52)
#: The jaw, and what moves lips up and down, but for their corners.
_LIPS = tuple(FAP_NUMBERS.index(fap) for fap in (3, 51, 52, 55, 56, 57, 58))

Pose = Union[Frame, Sequence[float]]


def with_sound(spoken: Iterable[Pose], heard: Iterable[Pose],
               share: Union[float, Sequence[float]] = SHARE) -> List[Tuple[int, ...]]:
    """Frames of phonemes with a share of the frames that are heard in their sound.

    The phonemes tell what is said, the sound how: which syllables are stressed, and when exactly. So the mix is nearer
    to people's lips than either. Closures are the phonemes': lips that touch in them stay as they are.

        spoken = labial.render(timings, exact=True)
        with labial.Hearing(rate, exact=True) as hearing:
            heard = list(hearing.frames([sound]))
        frames = labial.with_sound(spoken, heard)

    Args:
        spoken: frames or their 13 FAPs, as of :func:`labial.render`. heard: those of :class:`labial.Hearing`, from the
        same moment on. share: of what is heard, 0 .. 1, or one for each frame. Where one motion is longer than the
        other, it goes on alone.

    Returns whole FAP units. Raises LabialError for a share out of range, and for a frame that has not 13 numbers.
    """
    one, other = [_pose(pose) for pose in spoken], [_pose(pose) for pose in heard]
    both = min(len(one), len(other))
    shares = list(share) if isinstance(share, Sequence) else [share] * both
    if len(shares) < both:
        raise LabialError(f"there are {len(shares)} shares for {both} frames")
    frames = [_mixed(one[k], other[k], _share(shares[k])) for k in range(both)]
    rest = one[both:] or other[both:]
    return [tuple(math.floor(value + 0.5) for value in pose) for pose in [*frames, *rest]]


def _pose(pose: Pose) -> List[float]:
    values = [float(value) for value in faps_of(pose)]
    if len(values) != CHANNELS:
        raise LabialError(f"a frame has {len(values)} numbers, not {CHANNELS}")
    return values


def _share(share: float) -> float:
    found = number(share, "a share")
    if not 0.0 <= found <= 1.0:
        raise LabialError(f"a share of {found:g} is not within 0 .. 1")
    return found


def _mixed(spoken: List[float], heard: List[float], share: float) -> List[float]:
    way = min(max((-spoken[_UPPER] - spoken[_LOWER] - _CLOSED) / (_FREE - _CLOSED), 0.0), 1.0)
    free = share * way * way * (3.0 - 2.0 * way) if share < 1.0 else share
    return [one + (free if k in _LIPS else share) * (other - one) for k, (one, other) in enumerate(zip(spoken, heard))]
