"""Numbers on a command line: types for :mod:`argparse`, with the grammar of numbers in files."""

from __future__ import annotations

import argparse
import functools
import math

from labial.files.grammar import is_number, is_whole


def whole(low: int, high: int, text: str) -> int:
    """`text` as a whole number within `low` .. `high`; with both given, a type of :mod:`argparse`."""
    value = int(text) if is_whole(text) else -1
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number within {low} .. {high}")
    return value


def number(text: str) -> float:
    """`text` as a finite number: a type of :mod:`argparse`."""
    if not is_number(text) or math.isinf(float(text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return float(text)


#: Counts, up to any useful number. Seeds, as NumPy and scikit-learn accept them.
positive = functools.partial(whole, 1, 1_000_000)
seed = functools.partial(whole, 0, 2**32 - 1)
