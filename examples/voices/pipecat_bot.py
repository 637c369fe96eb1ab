"""A Pipecat pipeline whose lips move: a stand-in for a speech service, and a transport that only keeps time.

    python3 pipecat_bot.py "Maybe people hum by the pool."

With your own service and transport, the lines that lips need are those of main().
"""

from __future__ import annotations

import asyncio
import sys
from typing import Any, AsyncGenerator, Optional

import labial
import stand_in

try:
    from pipecat.frames.frames import EndFrame, Frame, OutputAudioRawFrame, StartFrame, TTSAudioRawFrame, TTSSpeakFrame
    from pipecat.pipeline.pipeline import Pipeline
    from pipecat.pipeline.worker import PipelineParams, PipelineWorker
    from pipecat.services.settings import TTSSettings
    from pipecat.services.tts_service import TTSService
    from pipecat.transports.base_output import BaseOutputTransport
    from pipecat.transports.base_transport import TransportParams
    from pipecat.workers.runner import WorkerRunner

    from labial.integrations.pipecat import LipsProcessor
except ModuleNotFoundError as error:
    sys.exit(f"pipecat_bot: this needs the package {error.name}: pip install pipecat-ai")


class StandInTTS(TTSService):
    """Hums, and times its words if `words` is true."""

    def __init__(self, words: bool = True) -> None:
        self._words = words
        super().__init__(sample_rate=stand_in.RATE, push_start_frame=True, push_stop_frames=True,
                         push_text_frames=False, stop_frame_timeout_s=0.3,
                         settings=TTSSettings(model=None, voice=None, language=None))

    async def run_tts(self, text: str, context_id: str) -> AsyncGenerator[Optional[Frame], None]:
        """The sound of a text."""
        moment = 0.0
        for said in stand_in.say(text):
            if self._words:
                await self.add_word_timestamps([(word, moment + start) for word, start, _ in said.words], context_id)
            yield TTSAudioRawFrame(said.sound, stand_in.RATE, 1, context_id=context_id)
            moment += len(said.sound) / (2 * stand_in.RATE)


class StandInOutput(BaseOutputTransport):
    """Takes as long for a piece of sound as hearing it takes."""

    def __init__(self) -> None:
        super().__init__(TransportParams(audio_out_enabled=True, audio_out_sample_rate=stand_in.RATE))

    async def start(self, frame: StartFrame) -> None:
        """Begins at once."""
        await super().start(frame)
        await self.set_transport_ready(frame)

    async def write_audio_frame(self, frame: OutputAudioRawFrame) -> bool:
        """A piece of sound."""
        await asyncio.sleep(frame.num_frames / frame.sample_rate)
        return True


async def main(*texts: str, show: Any = None) -> None:
    """Says texts."""
    async def printed(frame: labial.Frame) -> None:
        print(f"{frame.number:4} jaw {frame.rig('arkit')['jawOpen']:.3f}", flush=True)

    lips = LipsProcessor(show or printed)
    pipeline = Pipeline([StandInTTS(), lips, StandInOutput(), lips.heard])
    worker = PipelineWorker(pipeline, params=PipelineParams(audio_out_sample_rate=stand_in.RATE), enable_rtvi=False)
    await worker.queue_frames([*map(TTSSpeakFrame, texts), EndFrame()])
    runner = WorkerRunner(handle_sigint=False)
    await runner.add_workers(worker)
    await runner.run()


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:] or ["Maybe people hum by the pool."]))
