"""Lips of agents' voices, without the frameworks: words where they are told, else the sound. tests/agents has the
frameworks themselves."""

from __future__ import annotations

import math
import time
from array import array
from functools import cache
from typing import List, Optional, Tuple

import pytest

import labial
from labial.files.faps import CHANNELS, FAP_NUMBERS, TOUCHING
from labial.integrations.lips import Lips, _Fade
from labial.tables.visemes import ONE, VISEMES
from packages import needs_runtime

pytestmark = needs_runtime
RATE = 24000
#: FAP units that sound or words alone move within a frame at most.
STEP = 160


class Time:
    """The time that passes, in a test's hands."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        patch.setattr(time, "monotonic", lambda: self.now)

    def stands(self, lips: Lips, clock: float, seconds: float) -> List[labial.Frame]:
        """What is shown while the clock stands."""
        frames: List[labial.Frame] = []
        for _ in range(round(seconds * 100)):
            self.now += 0.01
            frames += lips.played(clock)
        return frames


def largest_step(frames: List[Tuple[int, ...]]) -> int:
    return max(abs(a - b) for one, other in zip(frames, frames[1:]) for a, b in zip(one, other))


@cache
def syllable() -> List[int]:
    """0.28 s of "ba": the formants of an open vowel, and closed lips."""
    sound = [float(k % (RATE // 120) == 0) for k in range(RATE // 5)]
    for frequency, width in ((730, 60), (1090, 90), (2440, 120)):
        radius = math.exp(-math.pi * width / RATE)
        before = last = 0.0
        for k, sample in enumerate(sound):
            before, last = last, sample + 2 * radius * math.cos(math.tau * frequency / RATE) * last - radius**2 * before
            sound[k] = last
    loudest = max(map(abs, sound))
    ramps = [min(1.0, k / 480, (len(sound) - k) / 480) for k in range(len(sound))]
    return [round(9000 * one / loudest * ramp) for one, ramp in zip(sound, ramps)] + [0] * (RATE * 8 // 100)


def babble(seconds: float) -> bytes:
    """A voice that says "bababa"."""
    count = round(seconds * RATE)
    return array("h", (syllable() * (count // len(syllable()) + 1))[:count]).tobytes()


def test_a_word_that_makes_no_sense_does_not_stop_the_sound(caplog: pytest.LogCaptureFixture) -> None:
    """As of a service whose words end before they begin: it is left out, and the others are said."""
    with Lips() as lips, labial.Voice() as voice:
        lips.begin_sound(0.0)
        for start, end in ((0.1, 0.4), (0.5, 0.3), (-1.0, 0.2), (math.nan, None), (0.6, 0.9)):
            lips.say("maybe", start, end)
        voice.say("maybe", 0.1, 0.4)
        voice.say("maybe", 0.6, 0.9)
        assert shown(lips, 0, 1) == shown(voice, 0, 1)
    assert [message.split(":")[0] for message in caplog.messages] == ["a word is left out"] * 3


def speaking(seconds: float) -> Lips:
    """Lips of a voice whose sound begins at once."""
    lips = Lips()
    lips.begin_sound(0.0)
    lips.sound(babble(seconds), RATE)
    return lips


def shown(lips: labial.Voice, first: float, last: float) -> List[Tuple[int, ...]]:
    frames = [frame for k in range(round(first * 50), round(last * 50)) for frame in lips.played(k / 50)]
    assert [frame.number for frame in frames] == list(range(round(first * 50), round(last * 50)))
    return [frame.faps for frame in frames]


def heard(sound: bytes) -> List[Tuple[int, ...]]:
    with labial.Hearing(RATE) as hearing:
        return [frame.faps for frame in (*hearing.push(sound), *hearing.end())]


@pytest.mark.parametrize("piece", [480, 4800, 1 << 20])
@pytest.mark.parametrize("whole", [False, True])
def test_sound_without_words_moves_lips(piece: int, whole: bool) -> None:
    """After a fade, frame for frame those of Hearing, in pieces of any length; then rest."""
    sound, at = babble(1.5), 0.4
    with Lips() as lips:
        lips.begin_sound(at)
        for place in range(0, len(sound), piece):
            lips.sound(sound[place : place + piece], RATE)
        if whole:
            lips.end_sound()
        found = shown(lips, 0.0, 3.0)
    expected = heard(sound)
    last = 75 if whole else 68  # the ears wait for what may follow
    assert found[28 : last + 20] == expected[8:last] and max(faps[0] for faps in expected) > 50
    assert len(set(found[-20:])) == 1


def test_words_are_followed_bit_for_bit() -> None:
    """Where words are told, sound changes nothing, and no ears are made."""
    with Lips() as lips, labial.Voice() as voice:
        for one in (lips.begin_sound, voice.begin):
            one(0.0)
        for one in (lips, voice):
            one.say("Maybe", 0.1, 0.5)
        lips.sound(babble(1.0), RATE)
        assert shown(lips, 0.0, 1.5) == shown(voice, 0.0, 1.5)


def test_words_that_come_late_take_over() -> None:
    """From sound to words lips fade: no frame jumps more than sound or words alone do."""
    with speaking(2.0) as lips:
        before = shown(lips, 0.0, 0.6)
        lips.say("people", 0.7, 1.2)
        after = shown(lips, 0.6, 2.0)
    with labial.Voice() as voice:
        voice.say("people", 0.7, 1.2)
        alone = shown(voice, 0.0, 2.0)
    assert before[20:] == heard(babble(2.0))[20:30] and after[10:] == alone[40:]
    assert largest_step(before[-1:] + after[:10]) < STEP


@pytest.mark.parametrize("gap", [0.0, 0.04, 0.1])
def test_sounds_that_follow_each_other_are_joined(gap: float) -> None:
    """The second sound's lips are faded to from what is shown, which is open where the first sound ends."""
    with Lips() as lips:
        for at in (0.0, 0.86 + gap):
            lips.begin_sound(at)
            lips.sound(babble(0.86), RATE)
            lips.end_sound()
        found = shown(lips, 0.0, 2.0)
    assert max(faps[0] for faps in found[30:43]) > 100 and largest_step(found) < STEP


@pytest.mark.parametrize("gap", [0.0, 0.04, 0.1])
@pytest.mark.parametrize("cancelled", [0.4, 0.5, 0.66])
def test_an_answer_right_after_an_interruption_is_joined(cancelled: float, gap: float) -> None:
    """What is shown then is neither forgotten nor kept."""
    with speaking(2.0) as lips:
        found = shown(lips, 0.0, cancelled)
        assert found[-1][0] > 100
        lips.cancel(200)
        lips.begin_sound(cancelled + gap)
        lips.sound(babble(1.0), RATE)
        found += shown(lips, cancelled, cancelled + 1.0)
    first = round((cancelled + gap) * 50 + 8)
    assert largest_step(found) < STEP and found[first : first + 30] == heard(babble(1.0))[8:38]


@pytest.mark.parametrize("ahead", range(6))
def test_lips_meet_in_time_on_the_way_to_another_sound(ahead: int) -> None:
    """Lips that are wide apart meet within three frames of a p, b or m, where the way there takes eight."""
    upper, lower = FAP_NUMBERS.index(51), FAP_NUMBERS.index(52)

    def pose(opening: int, viseme: str) -> labial.Frame:
        faps = [0] * CHANNELS
        faps[upper] = faps[lower] = -opening // 2
        return labial.Frame(0, tuple(faps), tuple(ONE * (name == viseme) for name in VISEMES))

    fade = _Fade()
    fade.to(pose(640, "aa"))
    fade.begin(8)
    aims = [pose(300, "ih")] * ahead + [pose(0, "PP")] * 4 + [pose(300, "ih")] * 8
    found = [-(frame.faps[upper] + frame.faps[lower]) for frame in map(fade.to, aims)]
    assert max(found[ahead + 2 : ahead + 4]) <= TOUCHING and found[-1] == 300 and fade.is_over


def test_heard_sounds_are_shown() -> None:
    """Tongue and teeth, which the FAPs do not tell; behind a fade they are those of Hearing."""
    sound = babble(1.0)
    with Lips() as lips, labial.Hearing(RATE) as hearing:
        lips.begin_sound(0.0)
        lips.sound(sound, RATE)
        found = [lips.played(k / 50)[0] for k in range(40)]
        expected = [*hearing.push(sound), *hearing.end()]
    assert [frame.visemes for frame in found[8:]] == [frame.visemes for frame in expected[8:40]]
    assert all(abs(sum(frame.visemes) - ONE) < 4 for frame in found) and len({frame.visemes for frame in found}) > 5


@pytest.mark.parametrize("has_sound", [False, True])
def test_an_answer_does_not_wait_for_the_end_of_a_cancel(has_sound: bool) -> None:
    """Its words move the mouth when they are heard."""
    with Lips() as lips, labial.Voice() as voice:
        lips.say("Papa", 0.0, 0.4)
        shown(lips, 0.0, 0.2)
        lips.cancel(2000)
        (lips.begin_sound if has_sound else lips.begin)(0.24)
        voice.begin(0.24)
        for one in (lips, voice):
            one.say("Papa", 0.1, 0.5)
        assert shown(lips, 0.2, 1.0)[16:] == shown(voice, 0.0, 1.0)[26:]


@pytest.mark.parametrize("milliseconds", [20, 60, 140, 200, 400])
def test_a_cancel_closes_the_mouth_while_the_clock_stands(milliseconds: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In as many frames as it takes, however few they are."""
    passing = Time(monkeypatch)
    with speaking(2.0) as lips:
        assert shown(lips, 0.0, 0.5)[-1][0] > 100
        lips.cancel(milliseconds)
        frames = passing.stands(lips, 0.48, 1.0)
        assert len(frames) == milliseconds // 20 and not any(frames[-1].faps) and lips.done


@pytest.mark.parametrize("words", [False, True])
def test_lips_rest_while_the_clock_stands(words: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A pause closes the mouth within 0.3 s. Where the sound goes on, lips fade in; where some of it was left out, so
    are its lips."""
    passing = Time(monkeypatch)
    with Lips() as lips:
        lips.begin_sound(0.0)
        for k in range(5 if words else 0):
            lips.say("Papa", k * 0.4, k * 0.4 + 0.4)
        lips.sound(babble(2.0), RATE)
        before = [lips.played(k / 50)[-1] for k in range(32)]
        assert before[-1].faps[0] > 100
        assert not passing.stands(lips, 0.62, 0.09)
        resting = passing.stands(lips, 0.62, 0.21)
        assert not any(resting[-1].faps) and not passing.stands(lips, 0.62, 5.0)
        assert {frame.number for frame in resting} == {31}
        after = [frame for k in range(43, 80) for frame in lips.played(k / 50)]
    assert [frame.number for frame in after] == list(range(43, 80))
    assert largest_step([frame.faps for frame in before[-1:] + resting + after[:9]]) < 1.2 * STEP
    assert max(frame.faps[0] for frame in after) > 100


def test_a_clock_that_is_read_often_does_not_stand(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program that is slow, or a clock that is, gets the same frames."""
    passing = Time(monkeypatch)
    found: List[labial.Frame] = []
    with speaking(1.0) as lips:
        for k in range(800):
            passing.now += 0.05
            found += lips.played(k / 1000)
    assert [frame.number for frame in found] == list(range(40))
    assert [frame.faps for frame in found[8:]] == heard(babble(1.0))[8:40]


def test_sound_goes_on_after_a_gap() -> None:
    """A server that is late, while the clock stands: what comes then is heard as well."""
    with speaking(0.5) as lips:
        shown(lips, 0.0, 0.6)
        lips.sound(babble(1.0), RATE)
        assert max(faps[0] for faps in shown(lips, 0.6, 1.6)) > 50


@pytest.mark.parametrize("rate, words", [(24001, "is not heard"), (None, "changed from 24000")])
def test_sounds_that_cannot_be_heard_are_said_once(rate: Optional[int], words: str,
                                                   caplog: pytest.LogCaptureFixture) -> None:
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(babble(0.5), rate or RATE)
        for _ in range(3):
            lips.sound(babble(0.5), rate or 16000)
        shown(lips, 0.0, 1.0)
    assert [words in record.getMessage() for record in caplog.records] == [True]


def test_lips_are_done_when_the_sound_is() -> None:
    with speaking(1.0) as lips:
        lips.finish()
        lips.played(0.5)
        assert not lips.done
        shown_to_end = [lips.played(k / 50) for k in range(26, 100)]
        assert lips.done and shown_to_end
