"""Plays sound while it comes, and knows how much of it was heard."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import time
from typing import Optional


class Player:
    """Samples of 16 bits, one channel, low byte first, played by aplay where it is installed.

    Args:
        rate: samples per second. delay: seconds from a sample's way to aplay until it is heard; measure it once: if the
        lips are early, increase it. silent: only the clock runs.
    """

    def __init__(self, rate: int, delay: float = 0.1, silent: bool = False) -> None:
        self._rate, self._written = rate, 0
        self._began: Optional[float] = None
        self._delay = delay
        self._aplay: Optional[subprocess.Popen[bytes]] = None
        if not silent and shutil.which("aplay"):
            command = ["aplay", "-q", "-t", "raw", "-f", "S16_LE", "-c", "1", "-r", str(rate)]
            self._aplay = subprocess.Popen(command, stdin=subprocess.PIPE)
        else:
            self._delay = 0.0

    def play(self, sound: bytes) -> None:
        """Plays this after what came before."""
        now = time.monotonic()
        if self._began is None:
            self._began = now + self._delay
        else:  # a gap, in which nothing was left to play, shifts what follows
            self._began = max(self._began, now + self._delay - self.written)
        self._written += len(sound) // 2
        if self._aplay and self._aplay.stdin:
            try:
                self._aplay.stdin.write(sound)
                self._aplay.stdin.flush()
            except BrokenPipeError:  # aplay has said why: go on without it
                self.close()

    @property
    def written(self) -> float:
        """Seconds of sound so far."""
        return self._written / self._rate

    def heard(self) -> Optional[float]:
        """Seconds that were heard; None before the first sound."""
        if self._began is None or time.monotonic() < self._began:
            return None
        return time.monotonic() - self._began

    def close(self) -> None:
        """Waits for the end of the sound."""
        aplay, self._aplay = self._aplay, None
        if aplay:
            with contextlib.suppress(BrokenPipeError):
                aplay.communicate()
