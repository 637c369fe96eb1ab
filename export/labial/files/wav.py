"""The samples of WAV files."""

from __future__ import annotations

import warnings
import wave
from typing import BinaryIO, Iterator, cast

from labial.errors import DataError

#: What the module `wave` raises for a file that it cannot read.
ERRORS = (wave.Error, EOFError, RuntimeError)
#: Samples of each channel that are read at once.
_BLOCK = 65_536
#: Bytes that tell a WAV file.
HEAD = 12
#: Bytes, from which on a head says that whoever wrote it did not know their number; others write 0. And samples.
_UNKNOWN_BYTES = 0x7FFFF000
_UNKNOWN = _UNKNOWN_BYTES // 8


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
    if count < wanted < _UNKNOWN:
        there, said = (number / sound.getframerate() for number in (count, wanted))
        warnings.warn(f"{path}: the file is cut off: {there:.2f} of {said:.2f} s are there", stacklevel=2)
