"""Corpora: motion with the phonemes that go with it, from whichever files, and as frames of a fixed rate."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from labial.corpus.corpora import Resampled, read_corpora, read_corpus, resample
    from labial.corpus.episode import Episode, Segment, Source

__all__ = ["Episode", "Segment", "Source", "Resampled", "read_corpora", "read_corpus", "resample"]


def __getattr__(name: str) -> Any:
    """What needs numpy is loaded when it is asked for: timings are also read where numpy is not installed."""
    if name not in __all__:
        raise AttributeError(f"module 'labial.corpus' has no attribute {name!r}")
    home = "episode" if name in ("Episode", "Segment", "Source") else "corpora"
    return getattr(import_module(f"labial.corpus.{home}"), name)
