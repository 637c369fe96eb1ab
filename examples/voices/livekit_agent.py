"""A LiveKit agent whose lips move, without a server: stand-ins for a speech service, and for an output, which only
keeps time.

    python3 livekit_agent.py "Maybe people hum by the pool."

With your own room and service, the lines that lips need are those of main().
"""

from __future__ import annotations

import asyncio
import sys
import time
from typing import Any, List, Optional

import stand_in

try:
    from livekit import rtc
    from livekit.agents import Agent, AgentSession, APIConnectOptions, tts, utils
    from livekit.agents.types import DEFAULT_API_CONNECT_OPTIONS, TimedString
    from livekit.agents.voice.io import AudioOutput, AudioOutputCapabilities

    from labial.integrations.livekit import LipsOutput
except ModuleNotFoundError as error:
    sys.exit(f"livekit_agent: this needs the package {error.name}: pip install livekit-agents")


class StandInTTS(tts.TTS):
    """Hums, and times its words if `words` is true."""

    def __init__(self, words: bool = True) -> None:
        super().__init__(capabilities=tts.TTSCapabilities(streaming=True, aligned_transcript=words),
                         sample_rate=stand_in.RATE, num_channels=1)

    def synthesize(self, text: str, **options: Any) -> tts.ChunkedStream:
        """It speaks streams alone."""
        raise NotImplementedError

    def stream(self, *, conn_options: APIConnectOptions = DEFAULT_API_CONNECT_OPTIONS) -> tts.SynthesizeStream:
        """A stream of text to sound."""
        return StandInStream(tts=self, conn_options=conn_options)


class StandInStream(tts.SynthesizeStream):
    """Speaks when the text has ended."""

    async def _run(self, output_emitter: tts.AudioEmitter) -> None:
        output_emitter.initialize(request_id=utils.shortuuid(), sample_rate=stand_in.RATE, num_channels=1,
                                  mime_type="audio/pcm", stream=True)
        text = ""
        async for piece in self._input_ch:
            text += piece if isinstance(piece, str) else ""
        self._mark_started()
        output_emitter.start_segment(segment_id=utils.shortuuid())
        moment = 0.0
        for said in stand_in.say(text):
            if self._tts.capabilities.aligned_transcript:
                output_emitter.push_timed_transcript([
                    TimedString(f"{word} ", start_time=moment + start, end_time=moment + end)
                    for word, start, end in said.words])
            output_emitter.push(said.sound)
            moment += len(said.sound) / (2 * stand_in.RATE)
        output_emitter.end_segment()


class StandInOutput(AudioOutput):
    """Tells when sound would have been heard."""

    def __init__(self) -> None:
        super().__init__(label="stand-in", capabilities=AudioOutputCapabilities(pause=False), sample_rate=stand_in.RATE)
        self._began: Optional[float] = None
        self._length = 0.0
        self._ending: Optional[asyncio.TimerHandle] = None

    async def capture_frame(self, frame: rtc.AudioFrame) -> None:
        """Sound."""
        await super().capture_frame(frame)
        if self._began is None:
            self._began, self._length = time.time(), 0.0
            self.on_playback_started(created_at=self._began)
        self._length += frame.duration

    def flush(self) -> None:
        """The end of a segment."""
        super().flush()
        if self._began is not None:
            left = self._began + self._length - time.time()
            self._ending = asyncio.get_running_loop().call_later(max(0.0, left), self._end, False)

    def clear_buffer(self) -> None:
        """An interruption."""
        if self._began is not None:
            if self._ending:
                self._ending.cancel()
            self._end(True)

    def _end(self, interrupted: bool) -> None:
        played = min(self._length, time.time() - (self._began or 0.0))
        self._began = self._ending = None
        self.on_playback_finished(playback_position=played, interrupted=interrupted)


async def main(*texts: str, interrupt_after: Optional[float] = None, words: bool = True) -> List[Any]:
    """Says texts, prints frames and returns them; half a second after the last word it ends."""
    session = AgentSession(tts=StandInTTS(words))
    session.output.audio = lips = LipsOutput(StandInOutput())
    await session.start(Agent(instructions="Hum."))
    frames: List[Any] = []

    async def follow() -> None:
        async for frame in lips:
            frames.append(frame)
            print(f"{frame.number:4} jaw {frame.rig('arkit')['jawOpen']:.3f}", flush=True)

    following = asyncio.create_task(follow())
    for text in texts:
        speech = session.say(text)
        if interrupt_after is not None:
            await asyncio.sleep(interrupt_after)
            speech.interrupt()
        await speech
    lips.voice.finish()
    await following
    await session.aclose()
    return frames


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:] or ["Maybe people hum by the pool."]))
