"""One call at a time: threads wait for each other, nested calls are refused, and a fork causes no deadlock."""

from __future__ import annotations

import functools
import os
import threading
import weakref
from typing import Any, Callable, TypeVar, cast

from labial.core.library import ERROR_STATE
from labial.errors import StreamError

Method = TypeVar("Method", bound=Callable[..., Any])


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
                return method(self, *arguments, **named)
            finally:
                guard.caller = 0

    return cast(Method, call)


def _forked() -> None:
    """In a child process: resets the lock, since the parent's threads do not exist here."""
    for guard in list(_guards):
        if guard.caller != threading.get_ident():
            guard.lost = guard.lost or (guard.caller != 0 and not guard.whole)
            guard.lock, guard.caller = threading.RLock(), 0


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)
