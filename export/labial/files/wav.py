"""The samples of WAV files."""

from __future__ import annotations

import warnings
import wave
from typing import Iterator

from labial.errors import DataError

#: What the module `wave` raises for a file that it cannot read.
ERRORS = (wave.Error, EOFError, RuntimeError)
#: Samples of each channel that are read at once.
_BLOCK = 65_536
#: Samples, from which on a head says that whoever wrote it did not know their number.
_UNKNOWN = 0x7FFFF000 // 8


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
