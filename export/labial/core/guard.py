"""What stands between callers and the C library: numbers are checked before they reach it; and objects have one call at
a time: threads wait for each other, nested calls are refused, and a fork causes no deadlock."""

from __future__ import annotations

import functools
import math
import operator
import os
import threading
import warnings
import weakref
from typing import Any, Callable, TypeVar, cast

from labial.core.library import ARTICULATION_MAX, DURATION_MAX, ERROR_DURATION, ERROR_STATE, failure
from labial.errors import LabialError, StreamError

Method = TypeVar("Method", bound=Callable[..., Any])
#: Milliseconds: no sound of speech is shorter.
SHORTEST = 5.0


def number(value: Any, what: str) -> float:
    """`value` as a float, infinite where it exceeds the range. Raises TypeError for anything else, such as True."""
    if not isinstance(value, (bool, str, bytes, bytearray)):
        try:
            return float(value)
        except OverflowError:
            return math.inf
        except (TypeError, ValueError):
            pass
    raise TypeError(f"{what} is a number, not {type(value).__name__}")


def whole(value: Any, what: str) -> int:
    """`value` as an int. Raises TypeError for anything but an integer."""
    if not isinstance(value, bool):
        try:
            return operator.index(value)
        except TypeError:
            pass
    raise TypeError(f"{what} is a whole number, not {type(value).__name__}")


def duration(value: Any) -> float:
    """Milliseconds, 0 to DURATION_MAX. Raises TypeError, and StreamError for a time out of range."""
    found = number(value, "a duration")
    if found > DURATION_MAX:
        raise failure(ERROR_DURATION, f"{found:g} ms")
    if not found >= 0.0:
        raise StreamError(ERROR_DURATION, f"{found:g} ms: a duration is a number from 0 on")
    return found


def articulation(percent: Any) -> int:
    """Percent, 0 to ARTICULATION_MAX, rounded. Raises TypeError, and LabialError for a number out of range."""
    found = number(percent, "an articulation")
    if not 0.0 <= found <= ARTICULATION_MAX:
        raise LabialError(f"an articulation of {found:g} is not within 0 .. {ARTICULATION_MAX}")
    return math.floor(found + 0.5)


def expect_milliseconds(longest: float) -> None:
    """Warns the caller of the function that calls this where the longest duration it was given is so short that all of
    them must be seconds."""
    if 0.0 < longest < SHORTEST:
        warnings.warn(f"no duration is longer than {longest:g} ms: they are milliseconds, not seconds", stacklevel=3)


class Guard:
    """The thread that is in a call of an object. Objects with :func:`alone` methods have one as ``_guard``."""

    __slots__ = ("lock", "caller", "lost", "whole", "__weakref__")

    def __init__(self, whole: bool = False) -> None:
        """`whole` objects can be used even if a call never ended."""
        self.whole = whole
        self.lock = threading.RLock()  # reentrant, so that a nested call gets an error instead of a deadlock
        self.caller = 0  # the thread that is in a call, or 0
        self.lost = False  # another thread was in a call when this process was forked
        _guards.add(self)


_guards: weakref.WeakSet[Guard] = weakref.WeakSet()


def alone(method: Method) -> Method:
    """A method that waits for other threads' calls of its object. Raises StreamError where the thread is in such a call
    already, as a signal handler or an argument's ``__float__`` can be, and where another thread was in a call when this
    process was forked."""
    return _alone(method, False)


def opened(method: Method) -> Method:
    """An :func:`alone` method of what is :class:`Closing`; raises StreamError where it is closed."""
    return _alone(method, True)


def _alone(method: Method, opens: bool) -> Method:
    @functools.wraps(method)
    def call(self: Any, *arguments: Any, **named: Any) -> Any:
        guard, thread = self._guard, threading.get_ident()
        with guard.lock:
            if guard.caller:
                raise StreamError(ERROR_STATE, f"{method.__name__}: this thread is in a call of the same object, which "
                                  "a signal handler or a callback interrupted")
            if guard.lost and method.__name__ != "close":
                raise StreamError(ERROR_STATE, f"{method.__name__}: another thread was in a call of this object when "
                                  "the process was forked")
            try:  # the next statement, since a signal handler may raise after any call
                guard.caller = thread
                if opens:
                    self._open()
                return method(self, *arguments, **named)
            finally:
                guard.caller = 0

    return cast(Method, call)


Owner = TypeVar("Owner", bound="Closing")


class Closing:
    """What has memory of the library, which closing frees, as leaving a ``with`` block does."""

    _what: str  #: how errors call it

    def __init__(self) -> None:
        self._guard = Guard()
        self._memory: Any = None
        self._address = 0  # of the memory

    @alone
    def close(self) -> None:
        """Frees the memory; may be called again. Every other call then raises StreamError."""
        self._free()

    @opened
    def __enter__(self: Owner) -> Owner:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _free(self) -> None:
        self._memory, self._address = None, 0

    def _open(self) -> None:
        if self._memory is None:
            raise StreamError(ERROR_STATE, f"the {self._what} is closed")


def _forked() -> None:
    """In a child process: resets the lock, since the parent's threads do not exist here."""
    for guard in list(_guards):
        if guard.caller != threading.get_ident():
            guard.lost = guard.lost or (guard.caller != 0 and not guard.whole)
            guard.lock, guard.caller = threading.RLock(), 0


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)
