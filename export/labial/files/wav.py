"""The samples of WAV files; channels that cancel each other, as those of a recording with one of two plugs the wrong
way round."""

from __future__ import annotations

import os
import warnings
import wave
from typing import TYPE_CHECKING, BinaryIO, Iterator, cast

from labial.errors import DataError, PathLike

if TYPE_CHECKING:
    import numpy as np

#: What the module `wave` raises for a file that it cannot read.
ERRORS = (wave.Error, EOFError, RuntimeError)
#: Samples of each channel that are read at once.
_BLOCK = 65_536
#: Bytes that tell a WAV file.
HEAD = 12
#: Bytes, from which on a head says that whoever wrote it did not know their number; others write 0.
_UNKNOWN_BYTES = 0x7FFFF000
#: The mean of channels that cancel each other has less than this share of their energy. Nothing is said until they have
#: that of a faint sound: 10 ms of 16 kHz at 80 of 32,768.
_SHARE, _FAINT = 0.01, 1e6


class _Stream:
    """A file of which :mod:`wave` does not see the size that its head gives, which may be unknown."""

    def __init__(self, file: BinaryIO, head: bytes) -> None:
        head += file.read(HEAD - len(head))
        self._size = int.from_bytes(head[4:8], "little")
        self._head, self._rest = head[:4] + b"\xff\xff\xff\x7f"[: len(head[4:8])] + head[8:], file
        self._place = -8  # in what that size counts

    def read(self, count: int) -> bytes:
        part, self._head = self._head[:count], self._head[count:]
        part += self._rest.read(count - len(part))
        self._place += len(part)
        return part

    @property
    def is_last(self) -> bool:
        """Whether no chunk is behind this place."""
        return self._size <= self._place or self._size >= _UNKNOWN_BYTES


class Sound(wave.Wave_read):
    """An open WAV file, also one of a program that writes 0 for sizes it does not know; `head` was read from `file`."""

    def __init__(self, file: BinaryIO, head: bytes = b"") -> None:
        self._stream = _Stream(file, head)
        self._endless = False
        super().__init__(cast(BinaryIO, self._stream))
        self._endless = not self.getnframes() and self._stream.is_last

    def readframes(self, nframes: int) -> bytes:
        """At most so many frames."""
        if not self._endless:
            return super().readframes(nframes)
        size = self.getsampwidth() * self.getnchannels()
        block = self._stream.read(nframes * size)
        return block[: len(block) // size * size]


def blocks(sound: wave.Wave_read, path: str = "the sound", block_frames: int = _BLOCK) -> Iterator[bytes]:
    """The content of an open file, block by block: reading all at once takes as much memory as its head says. Warns
    where the file ends before it should; raises DataError where it has no samples at all."""
    count, wanted = 0, sound.getnframes()
    size = sound.getsampwidth() * sound.getnchannels()
    while block := sound.readframes(block_frames):
        count += len(block) // size
        yield block
    if not count:
        raise DataError(path, None, "the sound is empty: it has no samples")
    if count < wanted < _UNKNOWN_BYTES // 8:
        there, said = (number / sound.getframerate() for number in (count, wanted))
        warnings.warn(f"{path}: the file is cut off: {there:.2f} of {said:.2f} s are there", stacklevel=2)


class Phase:
    """Finds out whether the mean of a sound's channels is nearly silent while they are not; then it warns once."""

    def __init__(self, path: PathLike) -> None:
        self._path = os.fspath(path)
        self._each = self._mean = 0.0
        self._warned = False

    def cancels(self, samples: np.ndarray, full_scale: float = 32768.0) -> bool:
        """Whether the channels of the sound up to and with these samples (N, C) cancel each other."""
        numbers = samples.astype("float64") * (32768.0 / full_scale)
        self._each += float((numbers**2).sum()) / max(1, samples.shape[1])
        self._mean += float((numbers.mean(axis=1) ** 2).sum())
        found = self._each >= _FAINT and self._mean < _SHARE * self._each
        if found and not self._warned:
            self._warned = True
            number = "two" if samples.shape[1] == 2 else str(samples.shape[1])
            warnings.warn(f"{self._path}: its {number} channels cancel each other, so the first one is heard alone",
                          stacklevel=3)
        return found
