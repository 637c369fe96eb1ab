"""The command ``labial align``: its text, its progress bar and its .lab."""

from __future__ import annotations

from typing import Optional, Tuple

from tqdm import tqdm

from labial.align.align import align
from labial.corpus.episode import Segment
from labial.corpus.timings import lab_of
from labial.grammar import read_text


def run(sound: str, text: Optional[str], text_file: Optional[str], progress: bool) -> str:
    """The phonemes of `sound` as the text of a .lab; the words are `text`, those of `text_file`, or unknown. `progress`
    shows a bar on standard error."""
    return lab_of(aligned(sound, said(text, text_file), progress))


def said(text: Optional[str], text_file: Optional[str]) -> Optional[str]:
    """What is said, from either of the two options."""
    return text if text_file is None else read_text(text_file)


def aligned(sound: str, text: Optional[str], progress: bool) -> Tuple[Segment, ...]:
    """As :func:`labial.align.align.align`, with a bar on standard error."""
    with tqdm(unit=" s", disable=not progress, bar_format="{desc}{n:.0f} of {total:.0f} s {bar} {remaining}") as bar:
        def told(done: float, length: float) -> None:
            bar.total = length
            bar.update(done - bar.n)

        return align(sound, text, told)
