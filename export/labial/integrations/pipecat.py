"""Lips in a Pipecat pipeline, in step with the sound that is played.

    from labial.integrations.pipecat import LipsProcessor

    lips = LipsProcessor(show)
    pipeline = Pipeline([..., tts, lips, transport.output(), lips.heard])

`lips` reads words and sound on their way to the transport. `lips.heard`, behind it, sees each piece of speech that was
played, and passes a LipsFrame on for each frame of the mouth; `show`, if given, is called with the same frame. Where a
service times no words (TTSTextFrames without pts), lips follow its sound (:class:`labial.Hearing`). An interruption
closes the mouth, and what is left of the interrupted answer is ignored.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Awaitable, Callable, Deque, Optional, Tuple

from pipecat.frames import frames
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor

from labial.integrations.lips import Lips
from labial.runtime import stream

_logger = logging.getLogger("labial")
#: Milliseconds in which the mouth closes when a pipeline is cancelled.
_CLOSING = 200

Show = Callable[[stream.Frame], Awaitable[None]]


@dataclass
class LipsFrame(frames.DataFrame):
    """The mouth when it is due: 13 FAPs, and the shares of the sounds that it shows (:class:`labial.Frame`);
    ``labial.Rig("arkit").apply(frame.faps, visemes=frame.visemes)`` makes blendshapes of them."""

    number: int
    faps: Tuple[int, ...]
    visemes: Tuple[int, ...] = ()


class _Clock:
    """How much of the speech was heard. Sounds that follow each other are one; behind the last one the clock runs on,
    up to where the sound of a context begins that waits."""

    def __init__(self, delay: float) -> None:
        self.starts: Deque[float] = deque()  # of contexts that were not heard yet
        self._delay = delay
        self._begun = self._idle = False
        self._total = self._at = self._moment = 0.0

    def __call__(self) -> Optional[float]:
        if not self._begun:
            return None
        now = self._at + time.monotonic() - self._moment
        if not self._idle:
            return min(now, self._total + max(0.0, -self._delay))
        return min(now, max(self._at, self.starts[0])) if self.starts else now

    def play(self, seconds: float) -> None:
        """A piece of speech was handed to the listener's device."""
        at = self._total
        if self._idle or not self._begun:
            if not self.starts:  # what an interruption left
                return
            at = self.starts.popleft()
        self._begun, self._idle = True, False
        self._at, self._total, self._moment = at, at + seconds, time.monotonic() + self._delay

    def stop(self) -> None:
        """Nothing is left to play."""
        now = self()
        if now is not None and not self._idle:
            self._idle, self._at, self._moment = True, now, time.monotonic()


class LipsProcessor(FrameProcessor):
    """Stands between the speech service and the transport's output.

    Args:
        show: is awaited with each frame of the mouth; an exception that it raises is logged, and lips go on. delay:
        seconds from a piece of sound's leaving the transport until it is heard; below zero if the transport passes it
        on afterwards. options: those of :class:`labial.Voice`.
    """

    def __init__(self, show: Optional[Show] = None, *, delay: float = 0.0, **options: Any) -> None:
        super().__init__()
        self.voice = Lips(**options)
        self._clock = _Clock(delay)
        self.heard = _Heard(self.voice, self._clock, show)
        self._queued = 0.0  # seconds of the clock up to which there is sound
        self._context: Optional[Tuple[Any]] = None  # the service's, whose words count from `_origin`
        self._over: Optional[str] = None  # the context that was interrupted
        self._origin = self._last = 0  # nanoseconds: where the context begins, and the latest word of all
        self._word: Optional[str] = None  # the context's latest

    async def process_frame(self, frame: frames.Frame, direction: FrameDirection) -> None:
        """Tells the voice what passes."""
        await super().process_frame(frame, direction)
        if isinstance(frame, frames.TTSStartedFrame):
            self._context = None
        elif isinstance(frame, frames.TTSStoppedFrame):
            self.voice.end_sound()
        elif isinstance(frame, frames.TTSTextFrame) and frame.pts and self._enter(frame.context_id):
            self._say(frame.text, frame.pts)
        elif isinstance(frame, frames.TTSAudioRawFrame) and self._enter(frame.context_id):
            self.voice.sound(frame.audio, frame.sample_rate, frame.num_channels)
            self._queued += frame.num_frames / frame.sample_rate
        elif isinstance(frame, frames.InterruptionFrame):
            self._over = self._context[0] if self._context else self._over
            self.voice.cancel()
            self._clock.starts.clear()
            self._clock.stop()
            self._context, self._queued = None, self._clock() or 0.0
            self._last = 0
        await self.push_frame(frame, direction)

    def _enter(self, context: Any) -> bool:
        """A service's new stretch of sound begins behind what there is; its words count from now or from the last word,
        as Pipecat's WordTimestampTracker has it. False for what is left of an interrupted one."""
        if context is not None and context == self._over:
            return False
        if self._context == (context,):
            return True
        self._context, self._word = (context,), None
        self._origin = max(self._last, self.get_clock().get_time())
        self._queued = max(self._queued, self._clock() or 0.0)
        self._clock.starts.append(self._queued)
        self.voice.begin_sound(self._queued)
        return True

    def _say(self, text: str, moment: int) -> None:
        """A word. Where a service leaves words out, Pipecat sends the rest of the text with the time of the last word:
        that word is said again, together with the rest. Where no word of a context is timed, the sound says more."""
        if self._word is None and moment <= self._origin and len(text.split()) > 1:
            return
        if self._word is not None and moment == self._last:
            text = f"{self._word} {text}"
        self._last, self._word = moment, text
        self.voice.say(text, max(0, moment - self._origin) / 1e9)


class _Heard(FrameProcessor):
    """Stands behind the transport's output."""

    def __init__(self, voice: Lips, clock: _Clock, show: Optional[Show]) -> None:
        super().__init__()
        self._voice, self._clock, self._show = voice, clock, show
        self._task: Optional[asyncio.Task[None]] = None

    async def process_frame(self, frame: frames.Frame, direction: FrameDirection) -> None:
        """Keeps the clock."""
        if isinstance(frame, frames.CancelFrame):  # behind which nothing can be pushed
            await self._close()
        await super().process_frame(frame, direction)
        if isinstance(frame, frames.StartFrame):
            self._task = self.create_task(self._follow())
        elif isinstance(frame, frames.TTSAudioRawFrame):
            self._clock.play(frame.num_frames / frame.sample_rate)
        elif isinstance(frame, frames.BotStoppedSpeakingFrame):
            self._clock.stop()
        elif isinstance(frame, (frames.EndFrame, frames.CancelFrame)) and self._task:
            await self.cancel_task(self._task)
        await self.push_frame(frame, direction)

    async def _close(self) -> None:
        """Leads the mouth to rest."""
        if self._clock() is None or self._voice.done:
            return
        self._voice.cancel(_CLOSING)
        late = time.monotonic() + 2 * _CLOSING / 1000
        while not self._voice.done and time.monotonic() < late:
            await asyncio.sleep(1 / self._voice.fps)

    async def _follow(self) -> None:
        has_failed = False
        async for frame in self._voice.follow(self._clock):
            await self.push_frame(LipsFrame(frame.number, frame.faps, frame.visemes))
            if not self._show:
                continue
            try:
                await self._show(frame)
                has_failed = False
            except Exception:
                if not has_failed:  # a lost connection fails 50 times a second
                    _logger.exception("show() failed for frame %d; lips go on", frame.number)
                has_failed = True
