"""Lips of an agent's voice: from the words that its speech service times, else from its sound."""

from __future__ import annotations

import logging
import math
import time
from collections import deque
from typing import Any, Deque, List, Optional, Tuple, Union

from labial.core.library import CANCEL_MAX
from labial.errors import LabialError
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.runtime.hearing import FPS, Hearing
from labial.runtime.stream import Frame
from labial.runtime.voice import Voice
from labial.tables.visemes import ONE, VISEMES

_logger = logging.getLogger("labial")
#: From words to sound, and back, from sound to sound and to rest, lips fade over so many frames.
_FADE = 8
#: Lips that are apart meet for a p, b or m in so many frames, where a fade would take longer.
_MEET = 3
#: Jaw and lips, which have to meet.
_LIPS = frozenset(map(FAP_NUMBERS.index, (3, 51, 52, 55, 56, 57, 58)))
_PRESSED = list(VISEMES).index("PP")
#: The neutral face.
_NEUTRAL = Frame(-1, (0,) * CHANNELS, (ONE, *[0] * (len(VISEMES) - 1)))
#: Seconds from the end of a sound until lips are at rest.
REST = 0.5
#: Seconds for which a clock stands until lips ease to rest.
_PATIENCE = 0.1


class Lips(Voice):
    """A :class:`labial.Voice`, and beside it the sound, which is heard where there are no words.

    An utterance without words so far moves by :class:`labial.Hearing`. Its sound is heard when it is due, so that
    sound that has words costs nothing. Where the clock stands, as in a pause, the mouth closes. All arguments are those
    of :class:`labial.Voice`.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._sounds: Deque[_Sound] = deque()
        self._fade = _Fade()
        self._source: Union[None, Frame, _Sound] = None  # what the lips follow: words, _NEUTRAL, or a sound
        self._closing = 0  # frames of a cancel that are to come, until the next utterance begins
        self._begins = 0.0
        self._moved = 0.0  # the time at which the clock moved last
        self._has_stood = False  # since the frame before
        self._level: Optional[int] = None  # of the voice, as hearing found it

    def begin(self, at: Optional[float] = None, utterance: Optional[str] = None) -> None:
        """The next utterance, as :meth:`labial.Voice.begin`."""
        super().begin(at, utterance)
        self._begins = self.time if at is None else at

    def begin_sound(self, at: float) -> None:
        """The next utterance, whose sound begins when `at` seconds were heard."""
        self.begin(at)
        self._sounds.append(_Sound(at))

    def say(self, text: str, start: float, end: Optional[float] = None) -> None:
        """A word of the utterance, as :meth:`labial.Voice.say`: from now on the utterance moves by its words. A word
        whose times make no sense is logged and left out: an agent's sound must not stop for it."""
        try:
            super().say(text, start, end)
        except LabialError as error:
            _logger.warning("a word is left out: %s", error)
            return
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
        """Drops all frames that are still to come, and eases to the neutral face."""
        super().cancel(milliseconds)
        self._sounds.clear()
        self._closing = min(max(math.ceil(milliseconds * self.fps / 1000 - 1e-6), 1), CANCEL_MAX)
        self._begins = math.inf
        self._source = _NEUTRAL
        self._fade.begin(self._closing)

    def played(self, seconds: Optional[float]) -> List[Frame]:
        """The frames that became due since the last call, as :meth:`labial.Voice.played`. Where the clock stands for a
        tenth of a second, the face comes to rest in time that passes; when it moves again, lips fade in, and of the
        frames that are due then the latest alone is returned."""
        before = self._heard
        due = super().played(seconds)
        if due and self._has_stood:
            due, self._has_stood = due[-1:], False
        frames = [self._mixed(frame) for frame in due]
        now = time.monotonic()
        if frames or self._heard > before:
            self._moved = now
        elif now - self._moved >= _PATIENCE and any(self._fade.shown.faps):
            self._moved += 1 / self.fps
            self._has_stood = True
            frames.append(self._toward(_NEUTRAL, self._fade.shown.number, _NEUTRAL))
        return frames

    @property
    def done(self) -> bool:
        """Whether nothing more will move: after :meth:`finish`, when words and sounds are over."""
        return super().done and self._fade.is_over and all(sound.is_over(self.time) for sound in self._sounds)

    def _mixed(self, frame: Frame) -> Frame:
        """A frame of the words, or that of the sound where there are none."""
        moment = frame.number / self.fps + 1e-6
        while len(self._sounds) > 1 and self._sounds[1].at <= moment:
            self._level = self._sounds.popleft().level or self._level
        if self._sounds and self._sounds[0].at <= moment:
            sound = self._sounds[0]
            heard = None if sound.has_words else sound.lips(moment, self._level)
            if heard:
                return self._toward(sound, frame.number, heard)
        if self._closing and moment < self._begins:
            self._closing -= 1
            return self._toward(_NEUTRAL, frame.number, _NEUTRAL)
        return self._toward(None, frame.number, frame)

    def _toward(self, source: Union[None, Frame, _Sound], number: int, aim: Frame) -> Frame:
        """The next pose, which follows `source` or fades to it."""
        if source is not self._source:
            self._source = source
            self._fade.begin(_FADE)
        return self._fade.to(Frame(number, aim.faps, aim.visemes))


class _Fade:
    """The way from the present face to other motion, in even steps."""

    def __init__(self) -> None:
        self.shown = self._start = _NEUTRAL
        self._step = self._length = 0
        self._apart = 0.0  # what is left of the way of jaw and lips

    @property
    def is_over(self) -> bool:
        return self._step == self._length

    def begin(self, length: int) -> None:
        """The way begins, and takes so many frames."""
        self._start = self.shown
        self._step, self._length, self._apart = 0, length, 1.0

    def to(self, aim: Frame) -> Frame:
        """The next frame on the way to this one."""
        if not self.is_over:
            self._step += 1
            left = 1 - self._step / self._length
            meets = aim.visemes[_PRESSED] >= ONE // 2
            self._apart = max(0.0, min(left, self._apart - 1 / _MEET if meets else self._apart))
            shares = [self._apart if channel in _LIPS else left for channel in range(CHANNELS)]
            aim = Frame(aim.number, _between(aim.faps, self._start.faps, shares),
                        _between(aim.visemes, self._start.visemes, [left] * len(VISEMES)))
        self.shown = aim
        return aim


def _between(one: Tuple[int, ...], other: Tuple[int, ...], shares: List[float]) -> Tuple[int, ...]:
    """`one` with these shares of `other`."""
    return tuple(math.floor(a + (b - a) * share + 0.5) for a, b, share in zip(one, other, shares))


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
        self._shown: Optional[Frame] = None

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
        return self.has_words or self._is_deaf or moment > self.at + self._length + REST

    def lips(self, moment: float, level: Optional[int]) -> Optional[Frame]:
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
            self._shown = self._frames.popleft()
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
