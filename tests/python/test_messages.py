"""Messages of services as they arrive: what users hold, what makes no sense, and limits for those of strangers."""

from __future__ import annotations

import json
import logging
import re
import sys
import time
from collections import namedtuple
from dataclasses import dataclass
from datetime import timedelta
from enum import Enum
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any, Callable, Dict, List, Sequence, Tuple

import pytest

import labial
from labial.corpus.formats import read_service
from labial.corpus.messages import Messages, Stats
from labial.corpus.phonesets import SPEECH
from labial.corpus.services import SERVICES
from labial.errors import LabialError
from labial.files import limits
from messages import SAMPLES
from packages import SOURCE, needs_runtime

GO = {"word": "go", "start": 0.5, "end": 0.75}
#: An object of Gradium's client has the fields of another service, without values, and no type.
GRADIUM = {"text": "go", "start_s": 0.5, "stop_s": 0.75, "client_req_id": None, "stream_id": None}


def told(*messages: Any) -> List[Tuple[str, float, Any]]:
    """The items that messages tell."""
    reader = Messages()
    return [(item.text, item.start, item.end) for message in messages for heard in reader.read(message)
            for one in heard.told for item in one.items]


class _Dumps:
    """An object of a client library: `name` is what makes a dictionary of it."""

    def __init__(self, name: str, fields: Dict[str, Any]) -> None:
        setattr(self, name, lambda: fields)


@dataclass
class _Word:
    word: str
    start: float
    end: float


class _Boundary(Enum):
    WORD = "WordBoundary"


class _Event:
    """As Azure's event arguments are: properties, one of which has no value."""

    audio_offset, duration, boundary_type = 5_000_000, timedelta(seconds=0.25), _Boundary.WORD

    @property
    def text(self) -> str:
        return "go"

    @property
    def result_id(self) -> str:
        raise RuntimeError("no result")


class _Repeated(Sequence[Any]):
    """As protobuf's repeated fields are: neither a list nor a tuple."""

    def __init__(self, *items: Any) -> None:
        self._items = items

    def __getitem__(self, index: Any) -> Any:
        return self._items[index]

    def __len__(self) -> int:
        return len(self._items)


@dataclass
class _Derived:
    """As Kokoro's results are: what tells is a property, another has no value."""

    item: Dict[str, Any]
    word = property(lambda self: self.item["word"])
    start = property(lambda self: self.item["start"])
    end = property(lambda self: self.item["end"])

    @property
    def none(self) -> str:
        raise RuntimeError("no value")


@pytest.mark.parametrize("message", [
    GO, [GO], _Repeated(GO), _Repeated(_Word("go", 0.5, 0.75)), _Derived(GO),
    json.dumps(GO), json.dumps(GO).encode(), f"data: {json.dumps(GO)}\n\n",
    b"data: " + json.dumps(GO).encode(),
    f"id: 7\nevent: word\ndata: {json.dumps(GO)}\n\n".encode(), f"retry: 9\ndata: {json.dumps(GO)}\n\n".encode(),
    f"event: word\nid: 7\ndata: {json.dumps(GO)}\n\n: waits\ndata: [DONE]\n\n", f"{{}}\n{json.dumps(GO)}\n",
    _Word("go", 0.5, 0.75), [_Word("go", 0.5, 0.75)], namedtuple("Word", GO)(**GO), _Event(),
    namedtuple("TextWithTimestamps", GRADIUM)(**GRADIUM),
    *(_Dumps(name, GO) for name in ("model_dump", "to_dict", "dict")),
    {"text": "go", "audio_offset": 5_000_000, "duration": timedelta(milliseconds=250)},
    {"word_timestamps": _Dumps("model_dump", {"words": ["go"], "start": [0.5], "end": [0.75]})},
    {"word_timestamps": {"words": _Repeated("go"), "start": _Repeated(0.5), "end": _Repeated(0.75)}},
    {"word": "go", "start": timedelta(seconds=0.5), "end": timedelta(seconds=0.75)},
])  # fmt: skip
def test_what_users_hold(message: Any) -> None:
    """The same word from each; catches a timedelta that is divided by a unit, and events that are no documents."""
    assert told(message) == [("go", 0.5, 0.75)]


def test_times_may_be_missing() -> None:
    """An end that is not known; 0 in the JSON of protobuf, with which Google answers."""
    assert told({**GRADIUM, "stop_s": None}) == [("go", 0.5, None)]
    found = told({"timepoints": [{"markName": "go"}, {"markName": "on", "timeSeconds": 0.5}]})
    assert [(text, start) for text, start, _ in found] == [("go", 0.0), ("on", 0.5)]


@pytest.mark.parametrize("message", ["", "\r\n", "data: [DONE]\n\n", ": keepalive\n\n", "event: x", "id: 5\n",
                                     "event: done\ndata: [DONE]\n\n"])
def test_an_event_may_have_no_document(message: str) -> None:
    """Those that end a stream or keep it open come by themselves."""
    assert not told(message) and not told(message.encode())


@pytest.mark.parametrize("message", [7, None, {1}, 1.5, True, Messages, object()])
def test_other_types_are_refused(message: Any) -> None:
    with pytest.raises(TypeError, match="a message is a dict, an object"):
        told(message)


def test_stats_count_what_became_of_messages() -> None:
    reader = Messages()
    odd = [{**GO, "end": None}, {**GO, "start": -1}, {**GO, "start": 0.76}, {**GO, "word": None}]
    for message in (b"\x00\x01", {}, [GO, *odd, GO]):
        reader.read(message)
    assert reader.stats == Stats(messages=3, told=2, skipped=4) and reader.skipped == 4


@pytest.mark.parametrize("message, words", [
    ({"type": "SentenceBoundary", "offset": 0, "duration": 5, "text": "Go."}, r"boundary='WordBoundary'$"),
    ({"audio": "", "normalizedAlignment": None, "isFinal": None}, r"ElevenLabs .*with-timestamps"),
    (b"\x00\x01\x02", r"none is of a known service \(kokoro, .*words"),
])  # fmt: skip
def test_silence_is_said_once(message: Any, words: str, caplog: pytest.LogCaptureFixture) -> None:
    """One sentence, after 50 messages that told nothing, which says what to ask the service for."""
    reader = Messages()
    with caplog.at_level(logging.INFO, "labial"):
        for _ in range(200):
            reader.read(message)
    assert len(caplog.records) == 1 and re.search(words, caplog.records[0].getMessage()), caplog.text


def test_messages_of_another_service_are_told_of_once(caplog: pytest.LogCaptureFixture) -> None:
    """A program that falls back to another service with the same voice would see the mouth stay shut; events of the
    program's own, which seem to be words, are not told of."""
    first = {"alignment": {"chars": ["a"], "charStartTimesMs": [0], "charDurationsMs": [90]}}
    other = {"type": "timestamps", "context_id": "c", "word_timestamps": {"words": ["go"], "start": [0], "end": [0.5]}}
    for form, count in ((None, 1), ("elevenlabs", 0)):
        reader = Messages(form)
        with caplog.at_level(logging.INFO, "labial"):
            for message in (first, GO, other, other):
                reader.read(message)
        assert len(caplog.records) == count, caplog.text
        assert not count or re.search("message 3 .* Cartesia .* ElevenLabs: name the format", caplog.text)
        caplog.clear()


@needs_runtime
@pytest.mark.parametrize("messages, count", [([], 0), ([GO, {}], 0), ([{}], 1), ([{}] * 60, 1)])
def test_silence_of_a_short_answer_is_said_at_its_end(messages: List[Any], count: int,
                                                      caplog: pytest.LogCaptureFixture) -> None:
    """One warning, also where fewer than 50 messages told nothing."""
    with caplog.at_level(logging.INFO, "labial"), labial.Voice() as voice:
        for message in messages:
            voice.feed(message)
        voice.finish()
        voice.finish()
    assert len(caplog.records) == count, caplog.text


# ---- Limits


def _hostile() -> Dict[str, Any]:
    """Messages of 100 kB that told nothing of use when this was written."""
    def phonemes(*texts: str) -> str:
        times = list(range(len(texts)))
        return json.dumps({"phoneme_timestamps": {"phonemes": texts, "start": times, "end": times}})

    chars = {"chars": ["a"] * 9000, "charStartTimesMs": [-1] * 9000, "charDurationsMs": [-1] * 9000}
    return {
        "brackets": "[" * 100_000, "objects in each other": '{"a":' * 20_000,
        "objects": "[" + ",".join(["{}"] * 33_000) + "]",
        "objects of nothing": json.dumps([{"type": "x" * 36}] * 1000),
        "words": json.dumps([{**GO, "start": -1}] * 1000),
        "fields": json.dumps({f"k{number}": number for number in range(7000)}), "label": phonemes("q" * 99_000),
        "digits": phonemes("7" * 99_000), "marks": phonemes("?" * 99_000), "labels": phonemes(*["ЖЯ" * 8] * 3000),
        "labels of their own": phonemes(*(f"{number:04}#=%" * 4 + "Ж" for number in range(1800))),
        "characters": json.dumps({"alignment": chars}),
        "lines": '{"a":1}\n' * 12_500, "text": "lorem { ipsum " * 7000, "number": "9" * 100_000,
        "bytes": bytes(range(256)) * 400, "bytes of an object": b"{" + bytes(range(256)) * 400,
    }  # fmt: skip


@pytest.mark.parametrize("name, message", _hostile().items(), ids=list(_hostile()))
def test_garbage_is_answered_at_once(name: str, message: Any) -> None:
    """100 kB within 20 ms of processor time on the machine where this was written; here the best of several runs, with
    room for slower ones. Catches rules that are quadratic: they took seconds to minutes."""
    def run() -> None:
        try:
            Messages().read(message)
        except LabialError as error:
            assert "\n" not in str(error) and len(str(error)) < 200

    assert _seconds(run, 5) < 0.1


def test_limits_are_the_same_in_javascript_and_c() -> None:
    text = (SOURCE / "web" / "entries.js").read_text(encoding="utf-8")
    found = re.search(r"LIMITS = \{ nesting: (\d+), documents: (\d+), items: (\d+), text: (\d+) \}", text)
    assert found and [int(value) for value in found.groups()] == [
        limits.MESSAGE_NESTING, limits.MESSAGE_DOCUMENTS, limits.MESSAGE_ITEMS, limits.MESSAGE_TEXT]
    header = (SOURCE / "include" / "labial" / "timings.h").read_text(encoding="utf-8")
    assert f"LABIAL_TIMINGS_LABEL_MAX {limits.LABEL - 1}\n" in header


def _seconds(run: Callable[[], Any], count: int) -> float:
    """The least processor time of several runs."""
    times = []
    for _ in range(count):
        begin = time.process_time()
        run()
        times.append(time.process_time() - begin)
    return min(times)


def _operations(run: Callable[[], Any]) -> int:
    """How many operations Python executes."""
    count = 0

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal count
        frame.f_trace_opcodes = True
        count += event == "opcode"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        run()
    finally:
        sys.settrace(before)
    return count


def _assert_linear(run: Callable[[int], Any]) -> None:
    """Twice as much takes at most three times as many operations."""
    count = 16
    while (few := _operations(partial(run, count))) < 100_000:
        count *= 2
    assert _operations(partial(run, 2 * count)) <= 3 * few


#: A label that no set of labels knows any part of.
UNKNOWN = "0123456789#=%0123456789#=%0123Ж"


def test_an_unknown_label_costs_little() -> None:
    """Its parts are compared only with names that begin as they do; with all others, too, it took 2,750 operations."""
    SPEECH.nearest("Ж0")  # names are listed once
    assert _operations(lambda: SPEECH.nearest(UNKNOWN, first="ipa")) < 1500


@pytest.mark.parametrize("name", {sample.service: name for name, sample in SAMPLES.items()}.values())
def test_readers_are_linear(name: str, tmp_path: Path) -> None:
    """Catches a rule that looks at all that came before with each message, of files and of messages as they arrive."""
    sample = SAMPLES[name]

    def follow(count: int) -> None:
        reader = Messages(sample.service)
        for _ in range(count):
            for message in sample.messages:
                reader.read(message)

    _assert_linear(follow)
    if SERVICES[sample.service].times != "chained":
        return
    path = tmp_path / "a.json"

    def read_file(count: int) -> None:
        path.write_text(json.dumps(sample.messages * count), encoding="utf-8")
        read_service(path, sample.service)

    _assert_linear(read_file)


@needs_runtime
@pytest.mark.parametrize("ahead", [True, False])
def test_feed_is_linear(ahead: bool) -> None:
    """Words that become known one by one, all before the sound begins, or each while the one before is heard."""
    def run(count: int) -> None:
        with labial.Voice() as voice:
            for number in range(count):
                voice.feed({"word": "go", "start": number * 0.1, "end": number * 0.1 + 0.1})
                if not ahead:
                    voice.played(number * 0.1)
            voice.played(1.0)

    _assert_linear(run)
