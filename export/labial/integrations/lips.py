"""Lips of an agent's voice: from the words that its speech service times, else from its sound."""

from __future__ import annotations

import logging
from collections import deque
from typing import Any, Deque, List, Optional, Tuple

from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.runtime.hearing import FPS, Hearing
from labial.runtime.stream import Frame
from labial.runtime.voice import Voice

_logger = logging.getLogger("labial")

_NEUTRAL = (0,) * CHANNELS
#: From words to sound, and back, lips fade over so many frames.
_FADE = 8
#: Seconds from the end of a sound until lips are at rest.
_REST = 0.5


class Lips(Voice):
    """A :class:`labial.Voice`, and beside it the sound, which is heard where no words are known.

    An utterance without words so far moves by :class:`labial.Hearing`. Its sound is heard when it is due, so that
    sound that has words costs nothing. All arguments are those of :class:`labial.Voice`.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._sounds: Deque[_Sound] = deque()
        self._last: Tuple[int, ...] = _NEUTRAL  # the lips that were heard last
        self._share = 0  # of the lips that are heard, in steps of a fade
        self._level: Optional[int] = None  # of the voice, as hearing found it

    def begin_sound(self, at: float) -> None:
        """The next utterance, whose sound begins when `at` seconds were heard."""
        self.begin(at)
        self._sounds.append(_Sound(at))

    def say(self, text: str, start: float, end: Optional[float] = None) -> None:
        """A word of the utterance, as :meth:`labial.Voice.say`: from now on the utterance moves by its words."""
        super().say(text, start, end)
        if text.strip() and self._sounds:
            self._sounds[-1].has_words = True

    def sound(self, samples: bytes, sample_rate: int, channels: int = 1) -> None:
        """The next piece of the utterance's sound: 16 bits, low byte first."""
        if self._sounds:
            self._sounds[-1].add(samples, sample_rate, channels)

    def end_sound(self) -> None:
        """The utterance's sound is whole. Without this call it ends where it is not continued in time."""
        if self._sounds:
            self._sounds[-1].is_whole = True

    def cancel(self, milliseconds: float = 200) -> None:
        """Drops all that was not shown yet, and eases to the neutral face."""
        super().cancel(milliseconds)
        self._sounds.clear()

    def played(self, seconds: Optional[float]) -> List[Frame]:
        """The frames that became due since the last call, as :meth:`labial.Voice.played`."""
        return [self._mixed(frame) for frame in super().played(seconds)]

    @property
    def done(self) -> bool:
        """Whether nothing more will move: after :meth:`finish`, when words and sounds are over."""
        return super().done and not self._share and all(sound.is_over(self.time) for sound in self._sounds)

    def _mixed(self, frame: Frame) -> Frame:
        """A frame of the words, or that of the sound where there are none."""
        moment = frame.number / self.fps + 1e-6
        while len(self._sounds) > 1 and self._sounds[1].at <= moment:
            self._level = self._sounds.popleft().level or self._level
        sound = self._sounds[0] if self._sounds and self._sounds[0].at <= moment else None
        heard = None if sound is None or sound.has_words else sound.lips(moment, self._level)
        self._share += 1 if heard and self._share < _FADE else -1 if not heard and self._share else 0
        self._last = heard or self._last
        if not self._share:
            return frame
        return Frame(frame.number, tuple(
            (one * (_FADE - self._share) + other * self._share) // _FADE for one, other in zip(frame.faps, self._last)))


class _Sound:
    """The sound of an utterance, which begins when `at` seconds were heard."""

    def __init__(self, at: float) -> None:
        self.at = at
        self.has_words = False
        self.is_whole = False  #: no more sound will come
        self.level: Optional[int] = None
        self._blocks: Deque[bytes] = deque()  # that were not heard
        self._format: Tuple[int, int] = (0, 0)
        self._length = self._heard = 0.0  # seconds that there are, and that were heard
        self._ears: Optional[Hearing] = None
        self._is_deaf = self._has_ended = False
        self._first, self._origin = 0, at  # the ears' frame, and its time, from which on frames count
        self._count = 0  # frames since then
        self._frames: Deque[Frame] = deque()  # that are not due
        self._shown: Optional[Tuple[int, ...]] = None

    def add(self, samples: bytes, sample_rate: int, channels: int) -> None:
        """The next piece."""
        if self.has_words or self._is_deaf:
            return
        if self._format not in ((0, 0), (sample_rate, channels)):
            _logger.warning("the rate of a sound changed from %d to %d Hz: its lips rest", self._format[0], sample_rate)
            self._is_deaf = True
            return
        self._format = sample_rate, channels
        self._blocks.append(samples)
        self._length += len(samples) / (2 * channels * sample_rate)

    def is_over(self, moment: float) -> bool:
        """Whether nothing of it is left to be seen."""
        return self.has_words or self._is_deaf or moment > self.at + self._length + _REST

    def lips(self, moment: float, level: Optional[int]) -> Optional[Tuple[int, ...]]:
        """The lips when they are due; None where nothing is heard."""
        if self._ears is None and not self._is_deaf and self._blocks:
            self._listen(level)
        if self._ears is None:
            return None
        ears, passed = self._ears, moment - self.at
        while self._blocks and self._heard <= passed + ears.latency + 2 / FPS:
            if self._has_ended:  # sound that comes after a gap
                ears.restart()
                self._first, self._origin, self._has_ended = self._first + self._count, self.at + self._heard, False
                self._count = 0
            block = self._blocks.popleft()
            self._heard += len(block) / (2 * self._format[0] * self._format[1])
            self._keep(ears.push(block))
        if not self._blocks and not self._has_ended and (self.is_whole or passed > self._length):
            self._keep(ears.end())
            self._has_ended, self.level = True, ears.level
        while self._frames and self._time(self._frames[0]) <= moment:
            self._shown = self._frames.popleft().faps
        return None if self._has_ended and not self._frames else self._shown

    def _keep(self, frames: List[Frame]) -> None:
        self._count += len(frames)
        self._frames.extend(frames)

    def _time(self, frame: Frame) -> float:
        return self._origin + (frame.number - self._first) / FPS

    def _listen(self, level: Optional[int]) -> None:
        try:
            self._ears = Hearing(*self._format)
            if level is not None:
                self._ears.level = level
        except LabialError as error:
            _logger.warning("a voice without words is not heard, its lips rest: %s", error)
            self._is_deaf = True
            self._blocks.clear()
