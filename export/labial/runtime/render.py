"""Whole utterances: timings in, motion out."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any, Iterable, List, Optional, Tuple, Union

from labial.errors import LabialError
from labial.faps import CHANNELS
from labial.runtime.models import Model
from labial.runtime.numbers import duration
from labial.runtime.stream import Stream

if TYPE_CHECKING:
    import numpy as np

#: A phoneme, by label or number, or a laugh (``<laugh:0.7>``), and how many milliseconds it lasts.
Timing = Tuple[Union[str, int], float]

_LAUGH = re.compile(r"<laugh(?:[: ]\s*([^\s>]+))?>")


def render(timings: Iterable[Timing], *, model: Optional[Model] = None, laughter: Optional[Model] = None,
           labels: str = "auto", nearest: bool = False) -> Union[np.ndarray, List[Tuple[int, ...]]]:
    """All frames of an utterance at once: (T, 13) int16, FAP units, ``model.fps`` frames per second.

    `timings` are pairs of a phoneme, by label or number, and its milliseconds; ``<laugh>`` or ``<laugh:0.7>`` in a
    label's place is a laugh of that intensity. The other arguments are those of :class:`labial.Stream`, whose frames
    these are. Where numpy is not installed the result is a list of T tuples of 13 ints. Raises LabialError, with the
    number of the timing from 1, and TypeError for what is no timing.
    """
    with Stream(model, laughter=laughter, labels=labels, nearest=nearest) as stream:
        for place, timing in enumerate(timings, 1):
            _push(stream, place, timing)
        stream.end()
        frames = stream.rest()
    try:
        import numpy as np
    except ModuleNotFoundError:
        return list(zip(*[iter(frames)] * CHANNELS))
    return np.frombuffer(frames, dtype=np.int16).reshape(-1, CHANNELS)


def _push(stream: Stream, place: int, timing: Any) -> None:
    if not isinstance(timing, (tuple, list)) or len(timing) != 2:
        raise TypeError(f"timing {place} is no pair of a phoneme and milliseconds")
    phoneme, milliseconds = timing
    laugh = _LAUGH.fullmatch(phoneme) if isinstance(phoneme, str) else None
    try:
        if laugh:
            stream.laugh(duration(milliseconds) / 1000.0, _intensity(laugh[1]))
        else:
            stream.push(phoneme, milliseconds)
    except (LabialError, TypeError) as error:
        error.args = (f"timing {place}: {error}",)
        raise


def _intensity(text: Optional[str]) -> float:
    try:
        return 0.5 if text is None else float(text)
    except ValueError:
        raise LabialError(f"a laugh's intensity is a number, not {text!r}") from None


def read_timings(path: Union[str, os.PathLike], *, labels: str = "auto",
                 source: Optional[str] = None) -> List[Tuple[str, float]]:
    """What :func:`render` takes, from a file of any format that ``labial timings`` reads (docs/timings.md): phonemes
    with their milliseconds, from time 0 on and without gaps.

    `labels` is the set that the file's labels are of, `source` the format where it is not to be told by the file.
    Raises DataError with the file and, where there is one, the line.
    """
    from labial.corpus.formats import phone_set_of, phoneme_segments
    from labial.corpus.formats import read_timings as read

    segments = read(path, source)
    found = phoneme_segments(path, segments, phone_set_of(segments, labels), False, labels)
    ends = [round(segment.end * 1000.0) for segment in found]
    return [(segment.label, end - begin) for segment, begin, end in zip(found, [0, *ends], ends)]
