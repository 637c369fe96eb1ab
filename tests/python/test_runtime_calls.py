"""Calls of the run-time within calls, by signal handlers and callbacks, and in forked processes."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from typing import Callable, Iterator, List

import pytest

import labial
from labial.errors import StreamError
from runtime import needs_runtime

pytestmark = [needs_runtime, pytest.mark.skipif(sys.platform != "linux", reason="signals and forks are those of Linux")]

REFUSED = "this thread is in a call of the same object"


@pytest.fixture(autouse=True)
def patience() -> Iterator[None]:
    """A deadlock ends the process of the tests, with the line that hangs, in place of hanging it."""
    import faulthandler

    faulthandler.dump_traceback_later(60, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


def speaking(seconds: int = 1) -> labial.Stream:
    stream = labial.Stream()
    for _ in range(10 * seconds):
        stream.push("AA", 60)
        stream.push("M", 40)
    stream.end()
    return stream


class Calling:
    """A number that calls a stream when it is read."""

    def __init__(self, call: Callable[[], object]) -> None:
        self._call = call

    def __float__(self) -> float:
        self._call()
        return 100.0


@pytest.mark.parametrize("call", [
    lambda stream: stream.cancel(), lambda stream: stream.push("AA", 50), lambda stream: stream.tick(),
    lambda stream: next(stream), lambda stream: stream.drain(), lambda stream: stream.latency,
    lambda stream: stream.close(), lambda stream: stream.end(), lambda stream: stream.restart(),
])  # fmt: skip
def test_an_argument_that_calls_the_stream_is_refused(call: Callable[[labial.Stream], object]) -> None:
    """It hung, and the stream is as it was."""
    with labial.Stream() as stream:
        stream.push("AA", 100)
        with pytest.raises(StreamError, match=REFUSED):
            stream.push("M", Calling(lambda: call(stream)))  # type: ignore[arg-type]
        stream.end()
        assert len(list(stream)) == 5 + 12


def test_another_stream_may_be_called_meanwhile() -> None:
    with labial.Stream() as first, labial.Stream() as second:
        first.push("AA", Calling(lambda: second.push("M", 100)))  # type: ignore[arg-type]
        second.end()
        assert len(list(second)) == 5 + 12


def test_a_signal_handler_is_refused_or_served() -> None:
    """A timer that fires hundreds of times, in calls and between them: every call of the handler ends, and the frames
    are those of a stream that nobody interrupted."""
    refused: List[str] = []
    served: List[labial.Latency] = []

    def interrupt(*_: object) -> None:
        try:
            served.append(stream.latency)
        except StreamError as error:
            refused.append(str(error))

    with speaking(20) as quiet:
        expected = list(quiet)
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with speaking(20) as stream:
            frames = []
            signal.setitimer(signal.ITIMER_REAL, 0.0002, 0.0002)
            for frame in stream:
                frames.append(frame)
            deadline = time.monotonic() + 20
            while not refused and time.monotonic() < deadline:
                stream.push("AA", 10) if not stream.done else stream.restart()
                list(stream)
            signal.setitimer(signal.ITIMER_REAL, 0)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert frames == expected and refused and all(REFUSED in text for text in refused)


def test_an_exception_of_a_handler_frees_the_stream() -> None:
    """Ctrl-C in a call: whoever catches it goes on with the same stream. Would catch a call that counts as running for
    ever, at whatever instruction the signal came."""
    def interrupt(*_: object) -> None:
        raise InterruptedError

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with labial.Stream() as stream:
            for turn in range(400):
                try:
                    signal.setitimer(signal.ITIMER_REAL, 0.00005 + 0.000001 * turn)
                    for _ in range(1000):
                        stream.push("AA", 20)
                except InterruptedError:
                    pass
                finally:
                    signal.setitimer(signal.ITIMER_REAL, 0)
                assert stream.latency.delay == 6
                stream.cancel(0)
                list(stream)
                stream.restart()
    finally:
        signal.signal(signal.SIGALRM, before)


def test_a_rig_in_a_handler() -> None:
    face = labial.Rig("arkit")

    class Faps(list):
        def __iter__(self) -> Iterator[int]:
            face.apply([0] * 13)
            return super().__iter__()

    assert face.apply(Faps([0] * 13)) == face.apply([0] * 13)
    face._guard.caller = 1
    with pytest.raises(StreamError, match=REFUSED):
        face.rest()


def forked(work: Callable[[], None]) -> int:
    """The exit status of a child that does `work`: 0 when it raised nothing, 99 when it hung for ten seconds."""
    child = os.fork()
    if not child:
        status = 1
        try:
            signal.signal(signal.SIGALRM, lambda *_: os._exit(99))
            signal.alarm(10)
            work()
            status = 0
        finally:
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def test_a_fork_while_another_thread_is_in_a_call() -> None:
    """All twelve children hung. The stream is refused there, its memory can be freed, and all others work."""
    with labial.Stream() as busy, speaking() as idle, speaking() as calm:
        expected = list(calm)
        go_on = threading.Event()
        thread = threading.Thread(target=lambda: busy.push("AA", Calling(go_on.wait)))  # type: ignore[arg-type]
        thread.start()
        while not busy._guard.caller:
            time.sleep(0)

        def work() -> None:
            for call in (busy.tick, busy.cancel, busy.drain):
                with pytest.raises(StreamError, match="another thread was in a call"):
                    call()
            busy.close()
            assert list(idle) == expected
            with speaking() as new:
                assert list(new) == expected

        statuses = [forked(work) for _ in range(12)]
        go_on.set()
        thread.join()
        assert statuses == [0] * 12
        busy.end()
        assert len(busy.drain()) > 0 and list(idle) == expected


def test_a_fork_within_a_call() -> None:
    """By the thread that is in it: parent and child both end the call."""
    with labial.Stream() as stream:
        children: List[int] = []
        stream.push("AA", Calling(lambda: children.append(os.fork())))  # type: ignore[arg-type]
        stream.end()
        count = len(list(stream))
        if not children[0]:
            os._exit(count)
        assert count == 5 + 12 and os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]) == 5 + 12
