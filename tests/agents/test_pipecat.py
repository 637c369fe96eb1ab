"""examples/voices with Pipecat itself: lips in a pipeline whose speech service and transport are stand-ins."""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path
from typing import Any, AsyncGenerator, Awaitable, Callable, List, Optional, Tuple

import pytest

import labial

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "voices"
sys.path.insert(0, str(EXAMPLES))
pytest.importorskip("pipecat")

from pipecat.audio.mixers.base_audio_mixer import BaseAudioMixer  # noqa: E402
from pipecat.frames.frames import (  # noqa: E402
    EndFrame,
    InterruptionFrame,
    OutputAudioRawFrame,
    TTSAudioRawFrame,
    TTSSpeakFrame,
)
from pipecat.pipeline.pipeline import Pipeline  # noqa: E402
from pipecat.pipeline.worker import PipelineParams, PipelineWorker  # noqa: E402
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor  # noqa: E402
from pipecat.workers.runner import WorkerRunner  # noqa: E402

import pipecat_bot  # noqa: E402
import stand_in  # noqa: E402
from labial.integrations.lips import Lips  # noqa: E402
from labial.integrations.pipecat import LipsFrame, LipsProcessor  # noqa: E402

TEXT = "Maybe people hum by the pool."


class Output(pipecat_bot.StandInOutput):
    """Notes when each piece of speech begins to be heard."""

    def __init__(self, mixer: Optional[BaseAudioMixer] = None) -> None:
        super().__init__()
        self._params.audio_out_mixer = mixer
        self.begun: List[float] = []

    async def write_audio_frame(self, frame: Any) -> bool:
        if isinstance(frame, TTSAudioRawFrame):
            self.begun.append(time.monotonic())
        return await super().write_audio_frame(frame)

    def answers(self) -> List[List[float]]:
        """The pieces of each answer."""
        found: List[List[float]] = []
        for before, at in zip([0.0, *self.begun], self.begun):
            found += [[]] if at - before > 0.5 else []
            found[-1].append(at)
        return found


class Mixer(BaseAudioMixer):
    """Background sound, which is always there."""

    async def start(self, sample_rate: int) -> None:
        pass

    async def stop(self) -> None:
        pass

    async def process_frame(self, frame: Any) -> None:
        pass

    async def mix(self, audio: bytes) -> bytes:
        return audio


class Forgetful(pipecat_bot.StandInTTS):
    """Times so many words of each text alone."""

    def __init__(self, *counts: int) -> None:
        super().__init__()
        self._counts = list(counts)

    async def run_tts(self, text: str, context_id: str) -> AsyncGenerator[Any, None]:
        timed, sound, count = [], b"", self._counts.pop(0)
        for said in stand_in.say(text):
            timed += [(word, len(sound) / (2 * stand_in.RATE) + start) for word, start, _ in said.words]
            sound += said.sound
        timed = timed[:count]
        if timed:
            await self.add_word_timestamps(timed, context_id)
        yield TTSAudioRawFrame(sound, stand_in.RATE, 1, context_id=context_id)


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


Script = Callable[[PipelineWorker], Awaitable[None]]


async def follow(script: Script, output: Output, tts: Any = None, delay: float = -0.04, show: Any = None) -> Behind:
    """A whole pipeline, in which `script` makes the bot speak."""
    behind, lips = Behind(), LipsProcessor(show, delay=delay)
    pipeline = Pipeline([tts or pipecat_bot.StandInTTS(), lips, output, lips.heard, behind])
    worker = PipelineWorker(pipeline, params=PipelineParams(audio_out_sample_rate=stand_in.RATE), enable_rtvi=False)
    runner = WorkerRunner(handle_sigint=False)
    await runner.add_workers(worker)

    async def speak() -> None:
        await script(worker)
        await worker.queue_frame(EndFrame())

    await asyncio.gather(runner.run(), speak())
    return behind


async def run(*texts: str, interrupt: float = 0.0, words: bool = True) -> Tuple[Output, Behind]:
    async def script(worker: PipelineWorker) -> None:
        for text in texts:
            await worker.queue_frame(TTSSpeakFrame(text))
            if interrupt:
                await asyncio.sleep(interrupt)
                await worker.queue_frame(InterruptionFrame())
                await asyncio.sleep(0.5)

    output = Output()
    return output, await follow(script, output, pipecat_bot.StandInTTS(words))


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
    """The frames are those of the words, whose times Pipecat tells to a millisecond, or to ten on a busy machine: their
    phonemes may begin a frame earlier or later. They are passed on when they are due."""
    output, behind = asyncio.run(run(TEXT))
    frames = [frame for _, frame in behind.frames]
    assert [frame.number for frame in frames] == list(range(len(frames))) and len(frames) > 100
    assert difference([frame.faps for frame in frames], expected(TEXT, 0.0, len(frames))) <= 120
    spoken = round(25 * sum(len(said.sound) for said in stand_in.say(TEXT)) / (2 * stand_in.RATE))
    late = [at - output.begun[frame.number // 2] - frame.number % 2 / 50 for at, frame in behind.frames[: 2 * spoken]]
    print("frames are late by ms:", [round(1000 * sorted(late)[k]) for k in (0, spoken, -1)])
    assert min(late) > -0.03 and sorted(late)[-5] < 0.06


def test_a_callback_that_fails_does_not_stop_the_lips(caplog: pytest.LogCaptureFixture) -> None:
    """As where an avatar's connection is lost for a while: one message, and all later frames."""
    shown: List[int] = []

    async def show(frame: labial.Frame) -> None:
        if 10 <= frame.number < 20:
            raise ConnectionError("lost")
        shown.append(frame.number)

    async def script(worker: PipelineWorker) -> None:
        await worker.queue_frame(TTSSpeakFrame(TEXT))

    behind = asyncio.run(follow(script, Output(), show=show))
    numbers = [frame.number for _, frame in behind.frames]
    assert shown == [number for number in numbers if not 10 <= number < 20] and len(shown) > 80
    assert [message for message in caplog.messages if "show()" in message] == ["show() failed for frame 10; lips go on"]


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


@pytest.mark.parametrize("delay", [-0.04, 0.2])
@pytest.mark.parametrize("background", [False, True])
def test_other_sound_moves_nothing(background: bool, delay: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sound effect before each answer, or background sound all the time: lips begin with the speech."""
    begun: List[float] = []
    told = Lips.begin_sound
    monkeypatch.setattr(Lips, "begin_sound", lambda voice, at: (begun.append(at), told(voice, at)))

    async def script(worker: PipelineWorker) -> None:
        for _ in range(2):
            if not background:
                await worker.queue_frame(OutputAudioRawFrame(bytes(2 * stand_in.RATE), stand_in.RATE, 1))
            await worker.queue_frame(TTSSpeakFrame("Hello again."))
            await asyncio.sleep(2.6 if background else 2.8)

    output = Output(Mixer() if background else None)
    behind = asyncio.run(follow(script, output, delay=delay))
    for pieces, origin in zip(output.answers(), begun):
        late = []
        for moment, frame in behind.frames:
            passed = frame.number / 50 - origin
            if 0.1 < passed < 0.8:
                late.append(moment - pieces[int(passed / 0.04)] - passed % 0.04 - max(0.0, 0.04 + delay))
        assert late and abs(sorted(late)[len(late) // 2]) < 0.06, late
        assert all(frame.number <= origin * 50 for moment, frame in behind.frames if moment < pieces[0])
    assert len(output.answers()) == len(begun) == 2
    assert all(sum(frame.visemes) for _, frame in behind.frames)


def test_words_that_a_service_leaves_out_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pipecat tells the rest of a text with the last word's time, whose place it took. A text without any word in time
    is told with that of the text before: its lips follow the sound."""
    said: List[Tuple[str, float]] = []
    told = Lips.say
    monkeypatch.setattr(Lips, "say", lambda voice, text, start: (said.append((text, start)), told(voice, text, start)))

    async def script(worker: PipelineWorker) -> None:
        for _ in range(2):
            await worker.queue_frame(TTSSpeakFrame(TEXT))
            await asyncio.sleep(2.8)

    output = Output()
    behind = asyncio.run(follow(script, output, Forgetful(4, 0)))
    assert [text for text, _ in said] == ["Maybe", "people", "hum", "by", "by the pool."]
    assert said[4][1] == said[3][1] > 0.5
    start = output.answers()[1][0]
    assert max(frame.faps[0] for moment, frame in behind.frames if moment > start) > 50


@pytest.mark.parametrize("words", [True, False])
def test_a_cancelled_pipeline_leaves_the_mouth_closed(words: bool) -> None:
    """The last frame that is passed on is the neutral face, and those before lead there."""
    async def script(worker: PipelineWorker) -> None:
        await worker.queue_frame(TTSSpeakFrame(TEXT))
        await asyncio.sleep(1.0)
        await worker.cancel()

    frames = [frame.faps for _, frame in asyncio.run(follow(script, Output(), pipecat_bot.StandInTTS(words))).frames]
    assert max(faps[0] for faps in frames[-20:]) > 20 and not any(frames[-1])
    assert max(abs(one[0] - other[0]) for one, other in zip(frames[-15:], frames[-14:])) < 100
