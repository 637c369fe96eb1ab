"""Corpora: motion with its phonemes, from files of several kinds, and as frames of a fixed rate."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from labial.corpus.corpora import Resampled, read_corpora, read_corpus, resample
    from labial.corpus.episode import Episode, Segment, Source

__all__ = ["Episode", "Segment", "Source", "Resampled", "read_corpora", "read_corpus", "resample"]


def __getattr__(name: str) -> Any:
    """Loads modules that need numpy on first use, so that timings can be read without numpy."""
    if name not in __all__:
        raise AttributeError(f"module 'labial.corpus' has no attribute {name!r}")
    home = "episode" if name in ("Episode", "Segment", "Source") else "corpora"
    return getattr(import_module(f"labial.corpus.{home}"), name)
