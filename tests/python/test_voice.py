"""A voice that is followed: what is told late or otherwise, how it ends, and what a server may send.

test_voice_sessions.py compares whole sessions with an oracle.
"""

from __future__ import annotations

import asyncio
import json
import math
import random
import shutil
import sys
import time
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple

import pytest

import labial
from labial.core.words import OwnWords
from labial.integrations.lips import Lips
from oracle import Plan, rested, times
from packages import needs_runtime, run
from regenerate_voices import WORDS

pytestmark = needs_runtime


def played(voice: labial.Voice, first: float, last: float) -> List[Tuple[int, ...]]:
    return [frame.faps for time in times(["plays", first, last, 0.02]) for frame in voice.played(time)]


def motion(timings: Iterable[Tuple[str, float]], count: int) -> List[Tuple[int, ...]]:
    """The first frames of timings, and of the silence after them, in which the face comes to rest."""
    plan: Plan = []
    end = 0.0
    for label, length in timings:
        plan.append((int(end), end + length, label))
        end += length
    return [rested([*plan, (int(end), math.inf, "SIL")], number) for number in range(count)]


def said(words: Sequence[Tuple[str, float, float]]) -> List[Tuple[str, int]]:
    return labial.word_timings([(text, round(start * 1000), round(end * 1000)) for text, start, end in words])


def test_times_that_seem_to_be_milliseconds_are_doubted() -> None:
    with labial.Voice() as voice:
        voice.say("Hello,", 0, 10)
        with pytest.warns(UserWarning, match=r"'world!' lasts 400 s; are these seconds\?") as found:
            voice.say("world!", 100, 500)
        assert found[0].filename == __file__


def test_a_face_comes_to_rest_while_the_clock_stands() -> None:
    """An interrupted sound stops, and its clock with it."""
    with labial.Voice() as voice:
        voice.push("AA", 0.0, 2.0)
        assert played(voice, 0, 0.6)[-1][0] > 100
        voice.cancel(100)
        poses: List[labial.Frame] = []
        end = time.monotonic() + 5.0
        while len(poses) < 5 and time.monotonic() < end:
            assert voice.cancelled and not voice.done
            poses += voice.played(0.6)
            time.sleep(0.005)
        assert poses[-1].faps == (0,) * 13 != poses[0].faps
        assert {pose.number for pose in poses} == {30} and voice.played(0.6) == [] and voice.time == 0.62
        assert voice.done and voice.cancelled


def test_lips_that_come_to_rest_at_the_end_do_not_part_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of agents ease wherever a clock stands, a little later."""
    passed = 100.0
    monkeypatch.setattr("labial.runtime.voice.time.monotonic", lambda: passed)
    with Lips() as lips:
        lips.push("AA", 0.0, 1.0)
        lips.finish()
        opening = [-sum(lips.played(number / 50)[-1].faps[3:5]) for number in range(49)][-1:]
        for _ in range(60):
            passed += 0.0101
            opening += [-sum(frame.faps[3:5]) for frame in lips.played(48 / 50)]
        assert opening[0] > 400 and opening[-1] == 0 and opening == sorted(opening, reverse=True)
        assert lips.done


async def followed(voice: labial.Voice, clock: Callable[[], Optional[float]]) -> List[labial.Frame]:
    return [frame async for frame in voice.follow(clock)]


def test_following_a_clock_that_stops_with_the_sound_ends() -> None:
    with labial.Voice() as voice:
        voice.push("AA", 0.0, 0.3)
        voice.finish()
        begin = time.monotonic()
        frames = asyncio.run(asyncio.wait_for(followed(voice, lambda: min(time.monotonic() - begin, 0.3)), 20))
        assert frames[-1].faps == (0,) * 13 and frames[-1].number == 15
    with labial.Voice() as voice:  # a service fails before its first message: the sound never begins
        assert not voice.done
        voice.finish()
        assert voice.done and asyncio.run(followed(voice, lambda: None)) == []


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="no espeak-ng: install the Debian package")
@pytest.mark.parametrize("language, text, closed", [
    ("cmn", "妈妈爸爸明天不跑步，朋友们买苹果和面包。", "妈爸明不跑步朋们买苹面包"),
    ("ja", "ままとぱぱはぱんをたべます。ばなながすきです。", "まぱばべ")])
def test_lips_close_in_long_texts_without_blanks(language: str, text: str, closed: str) -> None:
    """With each p, b, m, and between words; as :func:`labial.read_timings` has them, in short messages."""
    rng, moment = random.Random(1), 0.1
    times: List[Tuple[str, float, float]] = []
    for character in text * 10:
        length = 0.4 if character in "，。" else round(rng.uniform(0.12, 0.25), 3)
        times.append((character, moment, moment + length))
        moment += length
    messages = [{"alignment": {"chars": [character for character, _, _ in part],
                               "charStartTimesMs": [1000 * start for _, start, _ in part],
                               "charDurationsMs": [1000 * (end - start) for _, start, end in part]}}
                for part in (times[first : first + 7] for first in range(0, len(times), 7))]
    with labial.Voice("elevenlabs", language=language) as voice:
        for message in messages:
            voice.feed(message)
        frames = played(voice, 0, moment)
    timings = labial.read_timings(messages, source="elevenlabs", language=language)
    assert frames == motion(timings, len(frames))
    opening = [-(faps[3] + faps[4]) for faps in frames]
    for character, start, end in times:
        shown = opening[math.ceil(50 * (start - 0.06)) : math.floor(50 * (start + 0.12))]
        assert character not in closed or min(shown) < 60, (character, start)
        pause = opening[math.ceil(50 * (start + 0.16)) : math.floor(50 * (end - 0.12))]
        assert character not in "，。" or max(pause) < 120, start


def test_follow_waits_for_a_late_clock_and_ends() -> None:
    """An asynchronous loop: nothing while the sound has not begun, then each frame once, until all is shown."""
    looks: Iterator[Optional[float]] = iter([None, None, *(k * 0.03 for k in range(200))])

    async def closed(voice: labial.Voice) -> int:
        count = 0
        clock = iter(range(1, 9))
        voice.cancel()  # a conversation goes on behind an interruption
        async for _ in voice.follow(lambda: next(clock)):
            count += 1
            if count == 30:
                voice.close()
        return count

    waits: List[float] = []

    async def sleep(seconds: float) -> None:
        waits.append(seconds)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("labial.runtime.voice.asyncio.sleep", sleep)
        with labial.Voice() as voice:
            for word in WORDS:
                voice.say(*word)
            voice.finish()
            frames = asyncio.run(followed(voice, lambda: next(looks)))
            assert voice.done
        assert asyncio.run(closed(labial.Voice())) == 30
    assert [frame.number for frame in frames] == list(range(140))
    assert waits[:2] == [0.01, 0.01] and all(0.001 <= wait <= 0.02 for wait in waits)
    assert [frame.faps for frame in frames] == motion(said(WORDS), 140)


def test_messages_that_tell_nothing() -> None:
    """Sound, in JSON or in bytes, and notices; the format is recognised by the first message that tells something."""
    with labial.Voice() as voice:
        for message in (b"\x00\x01\xff", b"", b"RIFF....", {"audio": "AAAA"}, {"type": "done"}, [], '{"a": 1}',
                        {"audio": "AAAA", "alignment": None}):
            voice.feed(message)
        voice.feed(b' {"word": "hum", "start": 0.1, "end": 0.5}')
        voice.feed({"audio": "AAAA", "sequence": 1})
        voice.feed(json.dumps([{"word": "by", "start": 0.6, "end": 0.9}]))
        assert played(voice, 0, 1.4) == motion(said([("hum", 0.1, 0.5), ("by", 0.6, 0.9)]), 71)


@pytest.mark.parametrize("form, message, problem", [
    (None, "{", "not JSON"),
    (None, "7", "7 is not an object"),
    (None, b'{"a": "\xff"}', "not UTF-8"),
    (None, '{"a": ' + "[" * 100_000, "nested too deeply"),
    (None, [7], "7 is not an object"),
    (None, [{}] * 10_001, "10001 objects, more than the 10000 that are read"),
    ("elevenlabs", {"alignment": {"chars": ["a"] * 10001, "charStartTimesMs": [0] * 10001,
                                  "charDurationsMs": [0] * 10001}}, "more than 10000 words or phonemes"),
])  # fmt: skip
def test_malformed_messages_change_nothing(form: Optional[str], message: Any, problem: str) -> None:
    with labial.Voice(form) as voice:
        voice.say("hum", 0.1, 0.5)
        voice.feed({})
        with pytest.raises(labial.errors.DataError) as caught:
            voice.feed(message)
        assert problem in str(caught.value)
        assert "\n" not in str(caught.value) and str(caught.value).startswith("message 2:")
        assert played(voice, 0, 1) == motion(said([("hum", 0.1, 0.5)]), 51)


@pytest.mark.parametrize("form, message, problem", [
    (None, {"word": "a", "start": 2, "end": 4000}, "more than an hour"),
    (None, {"word": "a" * 1001, "start": 2, "end": 3}, "a text of 1001 characters"),
    (None, {"word": "a", "start": -1, "end": 3}, "not a number from 0 on"),
    (None, {"word": "a", "start": 0, "end": None}, "'end' is null, not a number from 0 on"),
    (None, '{"word": "hum", "start": 0.1, "end": 0.5}\n{"word": ', "not JSON"),
    ("azure", {"viseme_id": 77, "audio_offset": 0}, "no viseme is called '77'"),
    ("cartesia", {"word_timestamps": {"words": ["a"], "start": [0, 1], "end": [1]}}, "are not of one length"),
    ("elevenlabs", {"alignment": {"chars": ["a"]}}, "no field"),
    ("kokoro-fastapi", {"timestamps": [{"word": "hum", "start_time": 0.1, "end_time": 0.5},
                                       {"word": ",", "start_time": 0.5, "end_time": 0.49}]}, "before its start"),
])  # fmt: skip
def test_odd_items_are_skipped_and_counted(form: Optional[str], message: Any, problem: str,
                                           caplog: pytest.LogCaptureFixture) -> None:
    """An item that makes no sense loses itself alone."""
    with caplog.at_level("DEBUG", "labial"), labial.Voice(form) as voice:
        voice.say("hum", 0.1, 0.5)
        voice.feed(message)
        assert played(voice, 0, 1) == motion(said([("hum", 0.1, 0.5)]), 51)
    assert [problem in record.getMessage() for record in caplog.records] == [True]


def test_misuse() -> None:
    with labial.Voice() as voice:
        for call in (lambda: voice.feed(7), lambda: voice.feed(None), lambda: voice.feed({1}), lambda: voice.say(1, 0),
                     lambda: voice.say("a", "0"), lambda: voice.push("AA", None, 1), lambda: voice.played("1"),
                     lambda: voice.begin(1, 7),
                     lambda: labial.Voice(model="a")):
            with pytest.raises(TypeError):
                call()
        for call, problem in ((lambda: labial.Voice("morse"), "'morse' is no format of messages: there are kokoro"),
                              (lambda: labial.Voice(labels="x"), "no set of labels"),
                              (lambda: labial.Voice(own={"a": "QQ"}), "no phoneme of ARPABET"),
                              (lambda: voice.say("a", 2, 1), "ends before it begins"),
                              (lambda: voice.say("a", -1), "no time from 0 on"),
                              (lambda: voice.say("a", 86401), "more than a day"),
                              (lambda: voice.say("a", 1, 4000), "more than an hour"),
                              (lambda: voice.say("a", math.nan), "no time from 0 on"),
                              (lambda: voice.push("AA", 0, 4000), "more than an hour"),
                              (lambda: voice.push("QQ", 0, 1), "no phoneme of this name"),
                              (lambda: voice.played(math.inf), "inf s is no time"),
                              (lambda: voice.played(math.nan), "nan s is no time"),
                              (lambda: voice.begin(-1), "no time from 0 on"),
                              (lambda: voice.cancel(-1), "a duration is a number")):
            with pytest.raises(labial.errors.LabialError, match=problem):
                call()
        assert len(played(voice, 0, 1)) == 51
    for call in (lambda: voice.feed({}), lambda: voice.played(1), voice.finish, voice.begin, voice.cancel):
        with pytest.raises(labial.errors.StreamError, match="the voice is closed"):
            call()
    voice.close()


def test_a_server_cannot_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """So much ahead of the sound is too much, and what was known stays known."""
    monkeypatch.setattr("labial.runtime.voice.PLACES", 500)
    with labial.Voice() as voice, labial.Voice() as other:
        found = []
        for one in (voice, other):
            one.feed([{"word": "a", "start": k / 100, "end": k / 100} for k in range(10)])
            found.append(played(one, 0, 0.1))
        with pytest.raises(labial.errors.LabialError, match="there is room for 500"):
            for k in range(500):
                voice.say("a", k + 1, k + 1)
                other.say("a", k + 1, k + 1)
        found = [shown + played(one, 0.12, 1.2) for shown, one in zip(found, (voice, other))]
        assert found[0] == found[1] and len(set(found[0])) > 30
    characters = {"normalizedAlignment": {"chars": ["a"] * 501, "charStartTimesMs": list(range(501)),
                                          "charDurationsMs": [1] * 501}}
    with labial.Voice() as voice, pytest.raises(labial.errors.LabialError, match="there is room for 500"):
        voice.feed(characters)


def test_utterances_have_names() -> None:
    """Words come before the sound, which begins later than the clock; what is cancelled is counted as skipped."""
    with labial.Voice() as voice:
        for name, text in (("a", "Maybe"), ("b", "people")):
            voice._tell("words", [(text, 0.0, 0.5)], utterance=name)
        voice.begin(0.2, "a")
        voice.begin(1.0, "b")
        voice.finish()
        shown = played(voice, 0, 2)
        assert voice.done
        voice.cancel()
        voice.say("hum", 0.1, 0.5)
        assert voice.stats[1:] == (2, 0, 1)
    silence = ("SIL", 300)
    assert shown == motion([("SIL", 200), *said([("Maybe", 0, 0.5)]), silence, *said([("people", 0, 0.5)])], 101)


def test_pronunciations_and_labels() -> None:
    """Words are pronounced as `labial.word_timings` does, labels are those of the set that is named."""
    own = {"kokoro": "K OW K AO R OW"}
    word = ("Kokoro!", 0.1, 0.7)
    with labial.Voice(own=own) as voice:
        voice.say(*word)
        assert played(voice, 0, 1) == motion(labial.word_timings([("Kokoro!", 100, 700)], own=own), 51)
    with labial.Voice(labels="xsampa") as voice:
        voice.push("{", 0.1, 0.5)
        assert played(voice, 0, 1) == motion([("SIL", 100), ("AE", 400)], 51)
    with labial.Voice(nearest=True) as voice:
        voice.push("ɓ", 0.1, 0.5)
        voice.push(labial.speech_en.find("AA"), 0.5, 0.7)
        assert played(voice, 0, 1) == motion([("SIL", 100), ("B", 400), ("AA", 200)], 51)


@pytest.mark.skipif(not shutil.which("espeak-ng"), reason="no espeak-ng: install the Debian package")
def test_characters_of_another_language() -> None:
    """The danda ends a word of Hindi, and is no part of it."""
    text = "प्रेम। बाबा।"
    starts = [100.0 * k for k in range(len(text))]
    timings = labial.character_timings(text, starts, [start + 100.0 for start in starts], language="hi")
    assert [label for label, _ in timings if label != "SIL"] == labial.phonemes("प्रेम बाबा", language="hi")
    with labial.Voice("elevenlabs", language="hi") as voice:
        voice.feed({"alignment": {"characters": list(text), "character_start_times_seconds": [s / 1000 for s in starts],
                                  "character_end_times_seconds": [s / 1000 + 0.1 for s in starts]}})
        assert played(voice, 0, 2) == motion(timings, 101)


@pytest.mark.parametrize("options", [{"language": "de"}, {"numbers": True}])
def test_other_pronouncers_are_asked_once(options: Dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """espeak-ng and num2words are asked for each word once, however many messages follow it."""
    asked: List[str] = []
    monkeypatch.setattr("labial.corpus.words.pronounced", lambda words, language: asked.extend(words) or [
        None if word == "?" else ["AA", "M"] for word in words])
    monkeypatch.setitem(sys.modules, "num2words", None if "language" in options else sys)
    monkeypatch.setattr("labial.corpus.words._written_out", lambda digits, language: asked.append(digits) or "two")
    with labial.Voice(**options) as voice:
        assert asked.pop() == "1" and not asked  # whether they can be asked at all
        for k in range(5):
            voice.say("ja" if k % 2 else "21", k / 2, k / 2 + 0.4)
        assert max(frame[0] for frame in played(voice, 0, 2)) > 100
        voice.begin()
        for text in (" ", "j", "a", " "):  # characters: a word that is not whole yet is asked for as well
            voice._tell("characters", [(text, 0.1, 0.2)])
        assert voice._speaker._tail == ""
    if "language" in options:
        asked.remove("j")
    assert sorted(asked) == (["21", "ja"] if "language" in options else ["21"])


def test_what_others_said_is_kept_within_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """A text is looked up once, until there are too many."""
    made: List[Any] = []
    monkeypatch.setattr("labial.runtime.voice._SPOKEN", 20)
    monkeypatch.setattr("labial.runtime.voice.OwnWords", lambda words: made.append(words) or OwnWords(words))
    monkeypatch.setattr("labial.corpus.words.pronounced", lambda words, _: [["AA", "M"] for _ in words])
    with labial.Voice(language="de") as voice:
        for k in range(100):
            voice.say(f"ja{k % 10 if k < 50 else k}", k, k + 0.4)
            voice.played(k)
            assert len(made) <= (10 if k < 50 else 2 * k)
            assert len(voice._speaker._texts) <= 21 and len(voice._speaker._spoken) <= 21


def test_a_voice_needs_no_numpy() -> None:
    script = ("import sys\nsys.modules['numpy'] = None\nimport labial\nvoice = labial.Voice()\n"
              "voice.feed({'word': 'hum', 'start': 0, 'end': 1})\nprint(len(voice.played(0.5)))\n")
    assert run(sys.executable, "-c", script) == "26\n"
