"""Numbers that callers give, checked before C sees them."""

from __future__ import annotations

import math
import operator
from typing import Any

from labial.errors import StreamError
from labial.runtime.library import DURATION_MAX, ERROR_DURATION, failure


def number(value: Any, what: str) -> float:
    """`value` as a float, infinite where it is beyond one. Raises TypeError for what is no number, such as True."""
    if not isinstance(value, (bool, str, bytes, bytearray)):
        try:
            return float(value)
        except OverflowError:
            return math.inf
        except (TypeError, ValueError):
            pass
    raise TypeError(f"{what} is a number, not {type(value).__name__}")


def whole(value: Any, what: str) -> int:
    """`value` as an int. Raises TypeError for what is no whole number."""
    if not isinstance(value, bool):
        try:
            return operator.index(value)
        except TypeError:
            pass
    raise TypeError(f"{what} is a whole number, not {type(value).__name__}")


def duration(value: Any) -> float:
    """Milliseconds, 0 to DURATION_MAX. Raises TypeError, and StreamError for a time that no phoneme lasts."""
    found = number(value, "a duration")
    if found > DURATION_MAX:
        raise failure(ERROR_DURATION, f"{found:g} ms")
    if not found >= 0.0:
        raise StreamError(ERROR_DURATION, f"{found:g} ms: a duration is a number from 0 on")
    return found
