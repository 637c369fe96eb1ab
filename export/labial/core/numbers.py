"""Checks numbers from callers before they reach C."""

from __future__ import annotations

import math
import operator
import warnings
from typing import Any

from labial.core.library import DURATION_MAX, ERROR_DURATION, failure
from labial.errors import StreamError

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


def expect_milliseconds(longest: float) -> None:
    """Warns the caller of the function that calls this where the longest duration it was given is so short that all of
    them must be seconds."""
    if 0.0 < longest < SHORTEST:
        warnings.warn(f"no duration is longer than {longest:g} ms: they are milliseconds, not seconds", stacklevel=3)
