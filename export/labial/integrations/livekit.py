"""Lips for a LiveKit agent, in step with the sound that is played.

    from labial.integrations.livekit import LipsOutput

    await session.start(agent, room=room)
    session.output.audio = lips = LipsOutput(session.output.audio)
    async for frame in lips: ...

They follow the words that the speech service times, which come with the sound as TimedStrings if its capability
aligned_transcript is true. Where none come, they follow the sound (:class:`labial.Hearing`). An interruption closes the
mouth, and so does a pause.
"""

from __future__ import annotations

import asyncio
import time
from typing import Any, AsyncIterator, List, Optional

from livekit import rtc
from livekit.agents.types import USERDATA_TIMED_TRANSCRIPT
from livekit.agents.utils import is_given
from livekit.agents.voice.io import AudioOutput, AudioOutputCapabilities

from labial.integrations.lips import REST, Lips
from labial.runtime.stream import Frame


class LipsOutput(AudioOutput):
    """An audio output that watches the sound on its way to another one, `sink`. Iterating yields frames as they are
    due.

    Args:
        delay: seconds from the beginning of the playback, as the sink tells it, until it is heard. options: those of
        :class:`labial.Voice`.
    """

    def __init__(self, sink: AudioOutput, *, delay: float = 0.0, **options: Any) -> None:
        super().__init__(label="Labial", capabilities=AudioOutputCapabilities(pause=True), next_in_chain=sink)
        self.voice = Lips(**options)
        self._delay = delay
        self._resampler: Optional[rtc.AudioResampler] = None
        self._rest: Optional[asyncio.Task[None]] = None  # passes on what the resampler kept of a segment
        self._segment = False  # within the sound between two flushes
        self._origin = self._queued = 0.0  # seconds of the clock: where the latest segment begins and ends
        self._at, self._moment = 0.0, 0.0  # the clock, and the time at which it was there
        self._begun = False  # any sound was heard
        self._started = True  # and of the latest segment, too
        self._paused = False

    # ---- Sound on its way

    async def capture_frame(self, frame: rtc.AudioFrame) -> None:
        """Takes words and the length of the sound, and passes it on."""
        await super().capture_frame(frame)
        if self._rest is not None:
            rest = self._rest
            await asyncio.wait([rest])  # an interruption cancels it, and not this call
            if not rest.cancelled():
                rest.result()
        if not self._segment:
            self._origin = self._queued = max(self._queued, self.clock() or 0.0)
            self._segment, self._started = True, False
            self.voice.begin_sound(self._origin)
        elif self._begun and self.clock() == self._queued:  # it comes late
            self._at, self._moment = self._queued, time.time() + self._delay
        for text in frame.userdata.get(USERDATA_TIMED_TRANSCRIPT, []):
            # Of a sentence, whose end is not given, the sound says more.
            if is_given(text.start_time) and is_given(text.end_time) and len(text.split()) == 1:
                self.voice.say(text, text.start_time, text.end_time)
        self.voice.sound(bytes(frame.data), frame.sample_rate, frame.num_channels)
        self._queued += frame.duration
        for piece in self._resampled(frame):
            await self._sink.capture_frame(piece)

    def flush(self) -> None:
        """The end of a segment."""
        super().flush()
        self._segment = False
        self.voice.end_sound()
        if self._resampler is None:
            self._sink.flush()
        else:
            self._rest = asyncio.create_task(self._end(self._resampler.flush()))
            self._resampler = None

    def clear_buffer(self) -> None:
        """An interruption."""
        self.voice.cancel()
        self._hold()
        self._queued, self._segment = self._at, False
        if self._rest is not None:
            self._rest.cancel()
        self._rest = self._resampler = None
        self._sink.clear_buffer()

    def pause(self) -> None:
        """Stops the clock."""
        self._hold()
        self._paused = True
        super().pause()

    def resume(self) -> None:
        """Lets it run again, behind what the pause took. Agents also call it where there was no pause."""
        self._hold()
        if self._paused and self._started:
            self._at = max(self._at, self._origin + self._passed() - self._delay)
        self._paused = False
        super().resume()

    # ---- The clock

    def on_playback_started(self, *, created_at: float) -> None:
        """The sink tells when a segment begins to be heard."""
        super().on_playback_started(created_at=created_at)
        self._at, self._moment, self._begun, self._started = self._origin, created_at + self._delay, True, True

    def on_playback_finished(self, *, playback_position: float, interrupted: bool, **told: Any) -> None:
        """Behind the sound the clock runs on, so that lips come to rest."""
        super().on_playback_finished(playback_position=playback_position, interrupted=interrupted, **told)
        self._hold()
        if self._paused and self._started and not interrupted:  # the sink played on to the end; lips are at rest there
            self._at = max(self._at, self._queued + REST)

    def clock(self) -> Optional[float]:
        """Seconds that were heard. Until the sink tells that a segment is heard, it waits where that begins; and where
        sound is missing, until more comes."""
        if not self._begun:
            return None
        now = self._at if self._paused else max(self._at, self._at + time.time() - self._moment)
        return min(now, self._origin if not self._started else self._queued if self._segment else now)

    def __aiter__(self) -> AsyncIterator[Frame]:
        return self.voice.follow(self.clock)

    def _hold(self) -> None:
        self._at, self._moment = self.clock() or 0.0, time.time()

    # ---- The sink

    def _passed(self) -> float:
        """Seconds of the segment that a room's output has left behind. In a pause it drops what it has queued, up to a
        quarter of a second, and tells that only when the next stretch was heard: so its own counts are read."""
        sink = self._sink
        while sink.next_in_chain is not None:
            sink = sink.next_in_chain
        source = getattr(sink, "_audio_source", None)
        return getattr(sink, "_source_pushed_duration", 0.0) - getattr(source, "queued_duration", 0.0)

    @property
    def _sink(self) -> AudioOutput:
        assert self.next_in_chain is not None
        return self.next_in_chain

    def _resampled(self, frame: rtc.AudioFrame) -> List[rtc.AudioFrame]:
        """A frame at the sink's rate."""
        rate = self._sink.sample_rate
        if rate in (None, frame.sample_rate):
            return [frame]
        if self._resampler is None:
            self._resampler = rtc.AudioResampler(frame.sample_rate, rate, num_channels=frame.num_channels)
        return list(self._resampler.push(frame))

    async def _end(self, frames: List[rtc.AudioFrame]) -> None:
        """The last frames of a segment."""
        for frame in frames:
            await self._sink.capture_frame(frame)
        self._sink.flush()
