"""Alignment with a progress bar."""

from __future__ import annotations

from typing import Optional, Tuple

from tqdm import tqdm

from labial.align.align import align
from labial.corpus.episode import Segment


def align_with_bar(sound: str, text: Optional[str], progress: bool) -> Tuple[Segment, ...]:
    """As :func:`labial.align.align.align`; `progress` shows a bar on standard error."""
    with tqdm(unit=" s", disable=not progress, bar_format="{desc}{n:.0f} of {total:.0f} s {bar} {remaining}") as bar:
        def told(done: float, length: float) -> None:
            bar.total = length
            bar.update(done - bar.n)

        return align(sound, text, told)
