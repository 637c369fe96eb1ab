"""Alignment with a progress bar."""

from __future__ import annotations

from typing import Optional

from tqdm import tqdm

from labial.align.align import Alignment, aligned


def align_with_bar(sound: str, text: Optional[str], progress: bool) -> Alignment:
    """As :func:`labial.align.align.aligned`; `progress` shows a bar on standard error."""
    with tqdm(unit=" s", disable=not progress, bar_format="{desc}{n:.0f} of {total:.0f} s {bar} {remaining}") as bar:
        def told(done: float, length: float) -> None:
            bar.total = length
            bar.update(done - bar.n)

        return aligned(sound, text, told)
