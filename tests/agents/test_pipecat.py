"""examples/voices with Pipecat itself: lips in a pipeline whose speech service and transport are stand-ins."""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path
from typing import Any, List, Tuple

import pytest

import labial

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "voices"
sys.path.insert(0, str(EXAMPLES))
pytest.importorskip("pipecat")

from pipecat.frames.frames import EndFrame, InterruptionFrame, TTSSpeakFrame  # noqa: E402
from pipecat.pipeline.pipeline import Pipeline  # noqa: E402
from pipecat.pipeline.worker import PipelineParams, PipelineWorker  # noqa: E402
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor  # noqa: E402
from pipecat.workers.runner import WorkerRunner  # noqa: E402

import pipecat_bot  # noqa: E402
import stand_in  # noqa: E402
from labial.integrations.pipecat import LipsFrame, LipsProcessor  # noqa: E402

TEXT = "Maybe people hum by the pool."


class Output(pipecat_bot.StandInOutput):
    """Notes when each piece of sound begins to be heard."""

    def __init__(self) -> None:
        super().__init__()
        self.begun: List[float] = []

    async def write_audio_frame(self, frame: Any) -> bool:
        self.begun.append(time.monotonic())
        return await super().write_audio_frame(frame)


class Behind(FrameProcessor):
    """What the lips pass on, and when."""

    def __init__(self) -> None:
        super().__init__()
        self.frames: List[Tuple[float, LipsFrame]] = []

    async def process_frame(self, frame: Any, direction: FrameDirection) -> None:
        await super().process_frame(frame, direction)
        if isinstance(frame, LipsFrame):
            self.frames.append((time.monotonic(), frame))
        await self.push_frame(frame, direction)


async def run(*texts: str, interrupt: float = 0.0, words: bool = True) -> Tuple[Output, Behind]:
    output, behind, lips = Output(), Behind(), LipsProcessor(delay=-0.04)
    pipeline = Pipeline([pipecat_bot.StandInTTS(words), lips, output, lips.heard, behind])
    worker = PipelineWorker(pipeline, params=PipelineParams(audio_out_sample_rate=stand_in.RATE), enable_rtvi=False)
    runner = WorkerRunner(handle_sigint=False)
    await runner.add_workers(worker)

    async def speak() -> None:
        for text in texts:
            await worker.queue_frame(TTSSpeakFrame(text))
            if interrupt:
                await asyncio.sleep(interrupt)
                await worker.queue_frame(InterruptionFrame())
                await asyncio.sleep(0.5)
        await worker.queue_frame(EndFrame())

    await asyncio.gather(runner.run(), speak())
    return output, behind


def expected(text: str, origin: float, count: int) -> List[Tuple[int, ...]]:
    """The frames of a text whose sound begins at `origin`."""
    moment = origin
    with labial.Voice() as voice:
        for said in stand_in.say(text):
            for word, start, _ in said.words:
                voice.say(word, moment + start)
            moment += len(said.sound) / (2 * stand_in.RATE)
        return [frame.faps for k in range(count) for frame in voice.played(k / 50)]


def difference(one: List[Tuple[int, ...]], other: List[Tuple[int, ...]]) -> int:
    return max(abs(a - b) for first, second in zip(one, other) for a, b in zip(first, second))


def test_lips_follow_words_in_step_with_the_sound() -> None:
    """The frames are those of the words, whose times Pipecat tells to a millisecond or so: their phonemes may begin a
    frame earlier or later. They are passed on when they are due."""
    output, behind = asyncio.run(run(TEXT))
    frames = [frame for _, frame in behind.frames]
    assert [frame.number for frame in frames] == list(range(len(frames))) and len(frames) > 100
    assert difference([frame.faps for frame in frames], expected(TEXT, 0.0, len(frames))) <= 80
    spoken = round(25 * sum(len(said.sound) for said in stand_in.say(TEXT)) / (2 * stand_in.RATE))
    late = [at - output.begun[frame.number // 2] - frame.number % 2 / 50 for at, frame in behind.frames[: 2 * spoken]]
    print("frames are late by ms:", [round(1000 * sorted(late)[k]) for k in (0, spoken, -1)])
    assert min(late) > -0.03 and sorted(late)[-5] < 0.06


def test_texts_follow_each_other() -> None:
    """The second text's lips begin with its sound."""
    output, behind = asyncio.run(run(TEXT, "Hello again."))
    frames = [frame.faps for _, frame in behind.frames]
    length = sum(len(said.sound) for said in stand_in.say(TEXT)) / (2 * stand_in.RATE)
    begun = [number for number in range(len(frames)) if number / 50 > length - 0.05]
    second = expected("Hello again.", length, len(frames))
    shown = difference(frames[begun[30]:], second[begun[30]:])
    assert shown <= 60, shown  # the transport rounds a sound's length up to 40 ms


def test_a_voice_without_words_is_heard() -> None:
    """The mouth moves with the sound and comes to rest behind it; without hearing it stayed shut."""
    _, behind = asyncio.run(run(TEXT, words=False))
    frames = [frame.faps for _, frame in behind.frames]
    assert sum(faps[0] > 50 for faps in frames) > 30, frames


def test_an_interruption_closes_the_mouth() -> None:
    """Within 200 ms, and the next answer moves it again."""
    _, behind = asyncio.run(run(TEXT, TEXT, interrupt=0.7))
    frames = [frame.faps for _, frame in behind.frames]
    neutral = [number for number, faps in enumerate(frames) if not any(faps)]
    assert neutral and max(faps[0] for faps in frames[: neutral[0]]) > 50 and neutral[0] < 50
    assert max(faps[0] for faps in frames[neutral[0]:]) > 100
