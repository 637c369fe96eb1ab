"""The samples of WAV files."""

from __future__ import annotations

import wave
from typing import Iterator

#: What the module `wave` raises for a file that it cannot read.
ERRORS = (wave.Error, EOFError, RuntimeError)
#: Samples of each channel that are read at once.
_BLOCK = 65_536


def blocks(sound: wave.Wave_read) -> Iterator[bytes]:
    """The content of an open file, block by block: reading all at once takes as much memory as its head says."""
    while True:
        block = sound.readframes(_BLOCK)
        if not block:
            return
        yield block
