"""Lips of agents' voices, without the frameworks: words where they are told, else the sound. tests/agents has the
frameworks themselves."""

from __future__ import annotations

import math
from array import array
from typing import List, Optional, Tuple

import pytest

import labial
from labial.integrations.lips import Lips
from packages import needs_runtime

pytestmark = needs_runtime
RATE = 24000


def tone(seconds: float) -> bytes:
    """A voice that swells and fades four times a second, as syllables do."""
    swell = [abs(math.sin(4 * math.pi * k / RATE)) for k in range(round(seconds * RATE))]
    pitch = [math.sin(2 * math.pi * (140 + 60 * (k % 40)) * k / RATE) for k in range(len(swell))]
    return array("h", [round(9000 * one * other) for one, other in zip(swell, pitch)]).tobytes()


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
    sound, at = tone(1.5), 0.4
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
        lips.sound(tone(1.0), RATE)
        assert shown(lips, 0.0, 1.5) == shown(voice, 0.0, 1.5)


def test_words_that_come_late_take_over() -> None:
    """From sound to words lips fade: no frame jumps more than sound or words alone do."""
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(tone(2.0), RATE)
        before = shown(lips, 0.0, 0.6)
        lips.say("people", 0.7, 1.2)
        after = shown(lips, 0.6, 2.0)
    with labial.Voice() as voice:
        voice.say("people", 0.7, 1.2)
        alone = shown(voice, 0.0, 2.0)
    assert before[20:] == heard(tone(2.0))[20:30] and after[10:] == alone[40:]
    steps = [abs(a - b) for one, other in zip(before[-1:] + after[:10], after[:10]) for a, b in zip(one, other)]
    assert max(steps) < 150


def test_an_interruption_closes_the_mouth_and_the_next_answer_opens_it() -> None:
    """What was left of the interrupted sound moves nothing."""
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(tone(3.0), RATE)
        shown(lips, 0.0, 1.0)
        lips.cancel(200)
        lips.sound(tone(1.0), RATE)
        closing = shown(lips, 1.0, 1.5)
        assert not any(closing[12])
        lips.begin_sound(1.5)
        lips.sound(tone(1.0), RATE)
        assert max(faps[0] for faps in shown(lips, 1.5, 2.5)) > 50


def test_sound_goes_on_after_a_gap() -> None:
    """A server that is late, while the clock stands: what comes then is heard as well."""
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(tone(0.5), RATE)
        shown(lips, 0.0, 0.6)
        lips.sound(tone(1.0), RATE)
        assert max(faps[0] for faps in shown(lips, 0.6, 1.6)) > 50


@pytest.mark.parametrize("rate, words", [(24001, "is not heard"), (None, "changed from 24000")])
def test_sounds_that_cannot_be_heard_are_said_once(rate: Optional[int], words: str,
                                                   caplog: pytest.LogCaptureFixture) -> None:
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(tone(0.5), rate or RATE)
        for _ in range(3):
            lips.sound(tone(0.5), rate or 16000)
        shown(lips, 0.0, 1.0)
    assert [words in record.getMessage() for record in caplog.records] == [True]


def test_lips_are_done_when_the_sound_is() -> None:
    with Lips() as lips:
        lips.begin_sound(0.0)
        lips.sound(tone(1.0), RATE)
        lips.finish()
        lips.played(0.5)
        assert not lips.done
        shown_to_end = [lips.played(k / 50) for k in range(26, 100)]
        assert lips.done and shown_to_end
