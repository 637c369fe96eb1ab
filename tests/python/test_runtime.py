"""The Python run-time: the order of calls, what it refuses, memory, threads; it answers every conformance stream with
the same bytes as C."""

from __future__ import annotations

import functools
import gc
import sys
import threading
import time
import tracemalloc
from decimal import Decimal
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest

import labial
from labial.errors import LabialError, StreamError
from packages import SOURCE, needs_runtime, run
from regenerate import bundled_models
from runtime_player import FEEDS, play
from scripts import Frames, read, read_frames

pytestmark = needs_runtime

CONFORMANCE = SOURCE / "tests" / "conformance"


def frames_of(stream: labial.Stream) -> List[Tuple[int, ...]]:
    return [frame.faps for frame in stream]


@functools.cache
def conformance_scripts() -> List[Dict[str, Any]]:
    """``streams.txt`` as runtime_player.py takes it."""
    return [{"name": script.name,
             "parts": [{"pushes": [[push.model, push.phoneme, push.milliseconds] for push in part.pushes],
                        "cancel": part.cancel, "again": part.again, "articulation": part.articulation}
                       for part in script.parts]}
            for script in read(CONFORMANCE / "streams.txt", bundled_models())]


@functools.cache
def conformance_frames() -> Frames:
    """``frames.txt``, which test_conformance.py holds to the float64 reference."""
    return read_frames((CONFORMANCE / "frames.txt").read_text(encoding="ascii"))


# ---- What is imported


def test_import_brings_neither_numpy_nor_the_library() -> None:
    """A program that only exports needs no build of the library, one that only plays no numpy."""
    script = ("import sys, labial\n"
              "assert 'numpy' not in sys.modules and 'ctypes' not in sys.modules\n"
              "labial.Stream, labial.Rig, labial.render\n"
              "assert 'numpy' not in sys.modules\n"
              "assert set(labial.__all__) < set(dir(labial))\n"
              "try:\n    labial.nothing\nexcept AttributeError as error:\n    assert 'nothing' in str(error)\n")
    run(sys.executable, "-c", script)


@pytest.mark.parametrize(("path", "complaint"), [
    ("nowhere.so", "nowhere.so is not Labial's run-time"), (__file__, "is not Labial's run-time")])  # fmt: skip
def test_another_library_is_refused(path: str, complaint: str) -> None:
    """One line that names the file, where LABIAL_RUNTIME names none."""
    script = "import labial\ntry:\n    labial.Stream()\nexcept labial.errors.LabialError as error:\n    print(error)\n"
    said = run(sys.executable, "-c", script, env={"LABIAL_RUNTIME": path})
    assert complaint in said and said.count("\n") == 1


# ---- Streams


def test_any_number_of_phonemes_is_held() -> None:
    """More than the library's queue, and many times what is forgotten at a time; latency counts them all."""
    with labial.Stream(exact=True) as stream:
        for number in range(5000):
            stream.push(1 + number % 39, 20)
        held = stream.latency
        assert (held.frames, held.milliseconds, held.phonemes, held.delay) == (5000, 100000, 5000, 6)
        stream.end()
        first = [next(stream).faps for _ in range(3000)]
        assert stream.latency.frames == 2000
        rest = np.frombuffer(stream.drain(), dtype=np.int16).reshape(-1, 13)
    assert len(rest) == 2000
    whole = labial.render([(1 + number % 39, 20) for number in range(5000)], exact=True)
    assert (np.concatenate([first, rest]) == whole).all()


def test_fractions_of_milliseconds_add_up() -> None:
    """A hundred phonemes of 20.4 ms last 2,040 ms, not 2,000."""
    assert len(labial.render([("S", 20.4)] * 100, exact=True)) == 102
    assert len(labial.render([("S", Decimal("20.4")), ("S", np.float32(19.6))], exact=True)) == 2
    assert len(labial.render([("S", 0.3)])) == 0


def test_laughs_differ_unless_the_seed_is_the_same() -> None:
    def laughs(*seeds: Any) -> List[bytes]:
        found = []
        with labial.Stream(exact=True) as stream:
            for seed in seeds:
                stream.laugh(1.0, 1, seed)
                stream.end()
                found.append(stream.drain().tobytes())
                stream.restart()
        return found

    one, two = laughs(None, None)
    assert one != two and len(one) == len(two) == 50 * 13 * 2
    assert laughs(7) == laughs(7) and laughs(7) != laughs(8)
    with labial.Stream() as stream:  # the current model stays speech's
        stream.laugh(0.1)
        stream.push("HH", 40)


@pytest.mark.parametrize(("phoneme", "milliseconds", "error", "complaint"), [
    ("QQ", 70, StreamError, "'QQ' in speech_en: no phoneme of this name is known"),
    ("", 70, StreamError, "no phoneme of this name is known"),
    ("\0" * 300, 70, StreamError, "no phoneme of this name is known"),
    (40, 70, StreamError, "40 in speech_en: the model has no phoneme of this number"),
    (-1, 70, StreamError, "-1 in speech_en: the model has no phoneme of this number"),
    (2**70, 70, StreamError, "the model has no phoneme of this number"),
    (1.0, 70, TypeError, "whole number, not float"),
    (True, 70, TypeError, "whole number, not bool"),
    (None, 70, TypeError, "whole number, not NoneType"),
    (b"HH", 70, TypeError, "whole number, not bytes"),
    ("HH", -1, StreamError, "-1 ms: a duration is a number from 0 on"),
    ("HH", float("nan"), StreamError, "nan ms: a duration is a number from 0 on"),
    ("HH", 3600001, StreamError, "the duration exceeds LABIAL_DURATION_MAX"),
    ("HH", float("inf"), StreamError, "the duration exceeds LABIAL_DURATION_MAX"),
    ("HH", 10**400, StreamError, "the duration exceeds LABIAL_DURATION_MAX"),
    ("HH", "70", TypeError, "a duration is a number, not str"),
    ("HH", None, TypeError, "a duration is a number, not NoneType"),
    ("HH", True, TypeError, "a duration is a number, not bool"),
    ("HH", 1j, TypeError, "a duration is a number, not complex"),
])  # fmt: skip
def test_what_cannot_be_pushed(phoneme: Any, milliseconds: Any, error: type, complaint: str) -> None:
    """Refused with the library's sentence, one line, and without a trace in the stream."""
    with labial.Stream() as stream:
        with pytest.raises(error, match=complaint.replace("(", r"\(")) as raised:
            stream.push(phoneme, milliseconds)
        assert "\n" not in str(raised.value)
        if error is StreamError:
            assert raised.value.result in (-6, -7, -11)
        assert stream.latency[:3] == (0, 0, 0)
    with pytest.raises(error, match="^timing 2: "):
        labial.render([("HH", 1), (phoneme, milliseconds)])


@pytest.mark.parametrize(("call", "arguments", "error", "complaint"), [
    ("laugh", (-1,), StreamError, "a duration is a number from 0 on"),
    ("laugh", (3601,), StreamError, "exceeds LABIAL_DURATION_MAX"),
    ("laugh", (float("nan"),), StreamError, "a duration is a number from 0 on"),
    ("laugh", ("1",), TypeError, "a laugh's length is a number, not str"),
    ("laugh", (1, 1.1), LabialError, "an intensity of 1.1 is not within 0 .. 1"),
    ("laugh", (1, -0.1), LabialError, "is not within 0 .. 1"),
    ("laugh", (1, float("nan")), LabialError, "is not within 0 .. 1"),
    ("laugh", (1, 0.5, -1), LabialError, "a seed of -1"),
    ("laugh", (1, 0.5, 2**32), LabialError, "a seed of 4294967296"),
    ("laugh", (1, 0.5, 1.5), TypeError, "a seed is a whole number, not float"),
    ("articulation", (-0.1,), LabialError, "an articulation of -0.1 is not within 0 .. 200"),
    ("articulation", (200.1,), LabialError, "an articulation of 200.1 is not"),
    ("articulation", (float("nan"),), LabialError, "an articulation of nan"),
    ("articulation", ("50",), TypeError, "an articulation is a number, not str"),
    ("articulation", (True,), TypeError, "an articulation is a number, not bool"),
])  # fmt: skip
def test_what_cannot_be_laughed_or_articulated(call: str, arguments: Tuple[Any, ...], error: type,
                                               complaint: str) -> None:
    with labial.Stream() as stream:
        with pytest.raises(error, match=complaint):
            getattr(stream, call)(*arguments)
        stream.push("AA", 200)
        stream.end()
        assert frames_of(stream) == labial.render([("AA", 200)])


def test_calls_in_the_wrong_order() -> None:
    """The library's own sentence for each, with its number."""
    with labial.Stream() as stream:
        with pytest.raises(StreamError, match="the call is not allowed now") as raised:
            stream.restart()
        assert raised.value.result == -5
        stream.push("AA", 500)
        stream.end()
        stream.end()
        for call in (lambda: stream.push("AA", 1), lambda: stream.laugh(1), stream.restart):
            with pytest.raises(StreamError, match="the call is not allowed now"):
                call()
        stream.cancel(60)
        with pytest.raises(StreamError, match="the call is not allowed now"):
            stream.push("AA", 1)
        assert stream.latency[:3] == (0, 0, 0) and not any(list(stream)[-1].faps)
    for call in (lambda: stream.push("AA", 1), lambda: stream.laugh(1), lambda: stream.use(labial.speech_en),
                 stream.end, stream.cancel, stream.restart, stream.tick, stream.drain, lambda: next(stream),
                 lambda: stream.articulation(50),
                 lambda: stream.latency, stream.__enter__):
        with pytest.raises(StreamError, match="the stream is closed"):
            call()
    stream.close()


@pytest.mark.parametrize("timings", [[("AA",)], ["AA"], [3], [("AA", 1, 2)], [None]])
def test_what_is_no_timing(timings: List[Any]) -> None:
    with pytest.raises(TypeError, match="timing 1 is no pair"):
        labial.render(timings)


def test_labels_are_of_the_set_that_is_named() -> None:
    """`y` is "yes" in ARPABET and German "ue" in the IPA; nearest moves with anything."""
    first, second = labial.render([("y", 200)]), labial.render([("y", 200)], labels="ipa")
    assert first != second
    assert first == labial.render([("Y", 200)])
    assert labial.render([("<noise>", 200)], nearest=True) == labial.render([("SIL", 200)])
    for call in (lambda: labial.Stream(labels="sampa"), lambda: labial.speech_en.find("AA", "sampa")):
        with pytest.raises(LabialError, match="'sampa' is no set of labels, auto, arpabet, ipa, xsampa"):
            call()


# ---- Memory and threads


def test_closed_streams_leave_nothing() -> None:
    """Memory after thousands of streams, closed or forgotten, is that after a few."""

    def use(count: int) -> None:
        for number in range(count):
            stream = labial.Stream()
            stream.push("AA", 100)
            next(stream, None)
            if number % 2:
                stream.close()
        gc.collect()

    use(50)
    tracemalloc.start()
    use(50)
    before = tracemalloc.get_traced_memory()[0]
    use(2000)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20000  # a stream has some 2,500 bytes


def test_rendering_lets_other_threads_run() -> None:
    """With a switch interval of minutes another thread only runs where this one lets go of Python's lock."""
    counted = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(300)
    counter = threading.Thread(target=count)
    try:
        with labial.Stream(exact=True) as stream:
            stream.push("SIL", 3600000)
            stream.end()
            counter.start()
            before = counted[0]
            frames = stream.drain()
            after = counted[0]
    finally:
        done.set()
        counter.join()
        sys.setswitchinterval(interval)
    assert len(frames) == 180000 * 13 and after > before


def test_threads_share_a_stream_without_harm() -> None:
    """Every frame is delivered once, whoever asks for it."""
    with labial.Stream() as stream:
        for _ in range(400):
            stream.push("AA", 60)
            stream.push("M", 40)
        stream.end()
        found: List[List[labial.Frame]] = [[] for _ in range(4)]
        threads = [threading.Thread(target=lambda kept=kept: kept.extend(stream)) for kept in found]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    frames = sorted(frame for kept in found for frame in kept)
    assert [frame.number for frame in frames] == list(range(2000 + 12))
    assert (np.array([frame.faps for frame in frames]) == labial.render([("AA", 60), ("M", 40)] * 400)).all()


# ---- Frames: the same bytes as C's, however it is fed


@pytest.mark.parametrize("feed", FEEDS)
@pytest.mark.parametrize("script", conformance_scripts(), ids=lambda script: script["name"])
def test_stream_has_the_same_frames(script: Dict[str, Any], feed: str) -> None:
    """A push that is lost in the run-time's own queue, a cancel that keeps one, a model that is named too late, a frame
    that is skipped or delivered twice: all of it moves a frame."""
    rows = play(script, feed)
    wanted = conformance_frames()[script["name"]]
    assert len(rows) == len(wanted)
    assert rows == [tuple(row) for row in wanted.tolist()]
