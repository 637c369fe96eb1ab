"""The hash by which exceptions are found: it stands for their spelling, which is not stored."""

from __future__ import annotations

from typing import Iterable, Sequence

import numpy as np

from labial.errors import ModelError
from labial.words.dictionary import letters_of

_BASIS, _PRIME = 2166136261, 16777619
_FIRST = 2654435769
_TRIES = 200_000


def hash_of(word: str) -> int:
    """FNV-1a of a word's letters, without the multiplier."""
    value = _BASIS
    for letter in letters_of(word):
        value = ((value ^ letter) * _PRIME) & 0xFFFFFFFF
    return value


def multiplier_for(exceptions: Sequence[str], words: Iterable[str]) -> int:
    """The first odd number by which no two exceptions, and no exception and another of `words`, share 24 bits."""
    others = np.array([hash_of(word) for word in sorted(set(words) - set(exceptions))], dtype=np.uint32)
    own = np.array([hash_of(word) for word in exceptions], dtype=np.uint32)
    taken = np.zeros(1 << 24, dtype=bool)
    for step in range(_TRIES):
        multiplier = (_FIRST + 2 * step) & 0xFFFFFFFF
        places = (own * np.uint32(multiplier)) >> np.uint32(8)
        if len(np.unique(places)) < len(places):
            continue
        taken[places] = True
        if not taken[(others * np.uint32(multiplier)) >> np.uint32(8)].any():
            return multiplier
        taken[places] = False
    raise ModelError("every hash takes some word of the dictionary for an exception: choose fewer exceptions")
