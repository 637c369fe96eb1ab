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
from livekit.agents.voice.room_io._output import _ParticipantAudioOutput  # noqa: E402

import livekit_agent  # noqa: E402
import stand_in  # noqa: E402
from labial.integrations.lips import Lips  # noqa: E402

TEXT = "Maybe people hum by the pool."
SENTENCES = f"{TEXT} My mom bought a pumpkin pie."


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
    told = Lips.begin_sound
    monkeypatch.setattr(Lips, "begin_sound", lambda voice, at: (begun.append(at), told(voice, at)))
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


def test_an_interruption_between_segments_cancels_no_caller() -> None:
    """A call that waited for the end of the segment before was cancelled with it: its sound was lost."""
    full = asyncio.Event()

    class Output(livekit_agent.StandInOutput):
        async def capture_frame(self, frame: rtc.AudioFrame) -> None:
            await full.wait()

    async def run() -> None:
        lips = livekit_agent.LipsOutput(Output())
        sound = rtc.AudioFrame(bytes(2 * 480), 48000, 1, 480)
        lips._resampler = rtc.AudioResampler(48000, stand_in.RATE)
        lips._resampler.push(sound)
        lips.flush()
        waiting = asyncio.create_task(lips.capture_frame(sound))
        await asyncio.sleep(0.01)
        lips.clear_buffer()
        full.set()
        await asyncio.wait([waiting], timeout=5)
        assert waiting.done() and not waiting.cancelled() and waiting.exception() is None

    asyncio.run(run())


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


class Room(_ParticipantAudioOutput):
    """A room's output without a room: it plays to nobody, in time, and notes what was heard."""

    def __init__(self) -> None:
        super().__init__(None, sample_rate=stand_in.RATE, num_channels=1,  # type: ignore[arg-type]
                         track_publish_options=rtc.TrackPublishOptions())
        self._subscribed_fut.set_result(None)
        self._forwarding_task = asyncio.create_task(self._forward_audio())
        self.heard: List[Tuple[float, float, float]] = []  # time, and place and length in the segment

    def on_playback_progressed(self, *, started_at: float, offset: float, duration: float) -> None:
        self.heard.append((started_at, offset, duration))
        super().on_playback_progressed(started_at=started_at, offset=offset, duration=duration)


class Late(livekit_agent.StandInOutput):
    """Tells 0.4 s later that a segment is heard, because it is."""

    def __init__(self) -> None:
        super().__init__()
        self.starts: List[float] = []

    async def capture_frame(self, frame: rtc.AudioFrame) -> None:
        await livekit_agent.AudioOutput.capture_frame(self, frame)
        if self._began is None:
            self._began, self._length = time.time() + 0.4, 0.0
            self.starts.append(self._began)
            asyncio.get_running_loop().call_later(0.4, lambda at: self.on_playback_started(created_at=at), self._began)
        self._length += frame.duration


class Watched(livekit_agent.LipsOutput):
    """Notes when each frame was due."""

    def __init__(self, sink: livekit_agent.AudioOutput) -> None:
        super().__init__(sink)
        self.frames: List[Tuple[float, labial.Frame]] = []
        self._following = asyncio.create_task(self._follow())

    async def _follow(self) -> None:
        async for frame in self:
            self.frames.append((time.time(), frame))

    async def say(self, text: str, words: bool = True, stall: float = 0.0) -> float:
        """Sends a text; the second sentence comes `stall` seconds after the first one was heard. Returns its length."""
        moment = 0.0
        for k, said in enumerate(stand_in.say(text)):
            if stall and k == 1:
                await asyncio.sleep(moment + stall)
            told = [TimedString(f"{word} ", start_time=moment + start, end_time=moment + end)
                    for word, start, end in said.words if words]
            for place in range(0, len(said.sound), 960):
                piece = said.sound[place : place + 960]
                frame = rtc.AudioFrame(piece, stand_in.RATE, 1, len(piece) // 2)
                frame.userdata[USERDATA_TIMED_TRANSCRIPT], told = told, []
                await self.capture_frame(frame)
            moment += len(said.sound) / (2 * stand_in.RATE)
        self.flush()
        return moment

    def lateness(self, at: float, place: float, until: float) -> float:
        """Seconds by which lips are behind the sound, which was at `place` at the time `at`; the median."""
        late = sorted(moment - at + place - frame.number / 50
                      for moment, frame in self.frames if at + 0.2 < moment < until)
        return late[len(late) // 2]


@pytest.mark.parametrize("words", [True, False])
def test_a_pause_closes_the_mouth_and_lips_go_on_with_the_sound(words: bool) -> None:
    """A session pauses when the user speaks. A room then drops a quarter of a second of sound, and the lips of it."""
    async def run() -> None:
        room = Room()
        lips = Watched(room)
        await lips.say(TEXT, words)
        await asyncio.sleep(0.7)
        lips.pause()
        count = len(lips.frames)
        await asyncio.sleep(0.8)
        assert any(lips.frames[count - 1][1].faps) and not any(lips.frames[-1][1].faps)
        resting = len(lips.frames)
        lips.resume()
        await lips.wait_for_playout()
        await asyncio.sleep(0.6)
        (_, _, before), (at, place, length) = room.heard
        assert place - before > 0.1
        assert abs(lips.lateness(at, place, at + length)) < 0.05
        assert max(frame.faps[0] for _, frame in lips.frames[resting:]) > 50 and not any(lips.frames[-1][1].faps)
        poses = [frame.faps for _, frame in lips.frames[resting - 1 : resting + 8]]
        assert max(abs(one[0] - other[0]) for one, other in zip(poses, poses[1:])) < 100

    asyncio.run(run())


def test_what_a_room_plays_in_a_pause_is_not_shown_behind_it() -> None:
    """The last piece of an answer is heard although the output was paused."""
    async def run() -> None:
        lips = Watched(Room())
        await asyncio.sleep(await lips.say("Hello again.") - 0.15)
        lips.pause()
        await lips.wait_for_playout()
        await asyncio.sleep(0.4)
        count = len(lips.frames)
        assert not any(lips.frames[-1][1].faps)
        lips.resume()
        await asyncio.sleep(0.4)
        assert max(abs(fap) for _, frame in lips.frames[count:] for fap in frame.faps) < 20

    asyncio.run(run())


def test_answers_wait_until_they_are_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second answer's lips began with its first piece, and froze until it was heard."""
    begun: List[float] = []
    told = Lips.begin_sound
    monkeypatch.setattr(Lips, "begin_sound", lambda voice, at: (begun.append(at), told(voice, at)))

    async def run() -> None:
        sink = Late()
        lips = Watched(sink)
        for text in (TEXT, TEXT):
            length = await lips.say(text)
            await lips.wait_for_playout()
            await asyncio.sleep(0.7)
        start, origin = sink.starts[1], begun[1]
        assert max(frame.number for moment, frame in lips.frames if moment < start) <= origin * 50
        assert abs(lips.lateness(start, origin, start + length)) < 0.05

    asyncio.run(run())


def test_lips_wait_for_sound_that_is_missing() -> None:
    """Where a service is late within an answer; they ran on, and were early to its end."""
    async def run() -> None:
        room = Room()
        lips = Watched(room)
        await lips.say(SENTENCES, stall=0.7)
        await lips.wait_for_playout()
        at, place, length = room.heard[-1]
        assert abs(lips.lateness(at, place, at + length)) < 0.08
        assert not any(next(frame for moment, frame in reversed(lips.frames) if moment < at - 0.1).faps)

    asyncio.run(run())
