"""examples/voices with LiveKit's agents themselves: a session without a room; its service and output are stand-ins."""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path
from typing import List, Tuple

import pytest

import labial

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "voices"
sys.path.insert(0, str(EXAMPLES))
pytest.importorskip("livekit.agents")

from livekit import rtc  # noqa: E402
from livekit.agents.types import USERDATA_TIMED_TRANSCRIPT, TimedString  # noqa: E402

import livekit_agent  # noqa: E402
import stand_in  # noqa: E402

TEXT = "Maybe people hum by the pool."


def expected(texts: List[str], count: int) -> List[Tuple[int, ...]]:
    """The frames of texts that follow each other."""
    with labial.Voice() as voice:
        moment = 0.0
        for text in texts:
            for said in stand_in.say(text):
                for word, start, end in said.words:
                    voice.say(word, moment + start, moment + end)
                moment += len(said.sound) / (2 * stand_in.RATE)
        return [frame.faps for k in range(count) for frame in voice.played(k / 50)]


def test_lips_follow_an_agents_words() -> None:
    """The frames are those of the words, bit for bit."""
    frames = asyncio.run(livekit_agent.main(TEXT))
    assert [frame.number for frame in frames] == list(range(len(frames))) and len(frames) > 100
    assert [frame.faps for frame in frames] == expected([TEXT], len(frames))


def test_answers_follow_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second answer's words count from where its sound begins, which is behind the first one's."""
    begun: List[float] = []
    told = labial.Voice.begin
    monkeypatch.setattr(labial.Voice, "begin", lambda voice, at: (begun.append(at), told(voice, at)))
    frames = [frame.faps for frame in asyncio.run(livekit_agent.main(TEXT, "Hello again."))]
    length = sum(len(said.sound) for said in stand_in.say(TEXT)) / (2 * stand_in.RATE)
    assert begun[0] == 0.0 and length <= begun[1] < length + 0.5
    with labial.Voice() as voice:
        for at, text in zip(begun, (TEXT, "Hello again.")):
            voice.begin(at)
            moment = 0.0
            for said in stand_in.say(text):
                for word, start, end in said.words:
                    voice.say(word, moment + start, moment + end)
                moment += len(said.sound) / (2 * stand_in.RATE)
        whole = [frame.faps for k in range(len(frames)) for frame in voice.played(k / 50)]
    second = int(50 * begun[1]) + 9  # a fade, for the words were not known before
    assert frames[: int(50 * length) - 15] == whole[: int(50 * length) - 15] and frames[second:] == whole[second:]


def test_a_voice_without_words_is_heard() -> None:
    """The mouth moves with the sound and comes to rest behind it; without hearing it stayed shut."""
    frames = [frame.faps for frame in asyncio.run(livekit_agent.main(TEXT, words=False))]
    assert sum(faps[0] > 50 for faps in frames[:-30]) > 30 and len(set(frames[-5:])) == 1


def test_an_interruption_closes_the_mouth() -> None:
    """Within 200 ms."""
    frames = [frame.faps for frame in asyncio.run(livekit_agent.main(TEXT, interrupt_after=0.7))]
    neutral = [number for number, faps in enumerate(frames) if not any(faps)]
    assert neutral and 25 < neutral[0] < 50


def test_a_clock_that_does_not_pause_goes_on() -> None:
    """Agents resume their output before each answer; a clock that went back would show nothing until it caught up."""
    async def clock() -> float:
        lips = livekit_agent.LipsOutput(livekit_agent.StandInOutput())
        lips.on_playback_started(created_at=time.time() - 2)
        lips.resume()
        return lips.clock()

    assert 2 <= asyncio.run(clock()) < 3


def test_a_segment_at_another_rate_is_passed_on_whole() -> None:
    """What a resampler keeps of a segment would be heard before the next one."""
    class Output(livekit_agent.StandInOutput):
        async def capture_frame(self, frame: rtc.AudioFrame) -> None:
            passed[-1] += frame.duration

        def flush(self) -> None:
            passed.append(0.0)

        def clear_buffer(self) -> None:
            passed.append(0.0)

    async def run() -> None:
        lips = livekit_agent.LipsOutput(Output())
        for ends in (lips.flush, lips.flush, lips.clear_buffer, lips.flush):
            for _ in range(20):
                await lips.capture_frame(rtc.AudioFrame(bytes(2 * 1102), 22050, 1, 1102))
            ends()
        await asyncio.sleep(0.05)

    passed = [0.0]
    asyncio.run(run())
    assert len(passed) == 5 and passed[2] < 1.0
    assert all(abs(passed[k] - 20 * 1102 / 22050) < 0.005 for k in (0, 1, 3)), passed


def test_sentences_of_one_word_are_heard() -> None:
    """A service without times is told in sentences, where each begins; as a word it would silence the sound's lips."""
    async def told() -> int:
        lips = livekit_agent.LipsOutput(livekit_agent.StandInOutput())
        frame = rtc.AudioFrame(bytes(4800), 24000, 1, 2400)
        frame.userdata[USERDATA_TIMED_TRANSCRIPT] = [TimedString("Thanks!", start_time=0.0)]
        await lips.capture_frame(frame)
        return lips.voice.stats.told

    assert asyncio.run(told()) == 0
