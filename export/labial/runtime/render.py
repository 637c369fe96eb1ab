"""Whole utterances: timings, or words with their times, in; motion out."""

from __future__ import annotations

import os
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, TextIO, Tuple, Union

from labial.core.guard import duration, expect_milliseconds, number, whole
from labial.core.library import VISEMES
from labial.core.lines import LAUGH
from labial.corpus import words
from labial.corpus.words import ENGLISH, Word, pronunciation
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.runtime.models import Model
from labial.runtime.stream import Stream

#: Phonemes in ARPABET: with blanks between them, or a list.
Sounds = Union[str, Sequence[str]]
#: A word, when it begins and when it ends, milliseconds; None for an unknown end.
TimedWord = Tuple[str, float, Optional[float]]


def phonemes(text: str, *, own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH,
             numbers: bool = False) -> List[str]:
    """The phonemes of a text, in ARPABET without stress, word after word, without silences.

    `own` has words that are pronounced otherwise: ``{"google": "G UW G AH L"}``, or lists of phonemes. `language` is
    "en", which the library reads itself, or what espeak-ng, if it is installed, calls a language or a voice; its
    phonemes become those of English that look most like them. With `numbers`, num2words, if it is installed, writes
    out what stands in digits. Raises LabialError.
    """
    if not isinstance(text, str):
        raise TypeError(f"a text is a str, not {type(text).__name__}")
    found = words.phonemes_of(words.words_of(text), pronunciation(own, language, numbers))
    return [label for spoken in found for label in spoken.phonemes]


def word_timings(timed: Iterable[TimedWord], *, offset_ms: float = 0,
                 own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH,
                 numbers: bool = False) -> List[Tuple[str, int]]:
    """The timings of :func:`labial.render` from words and their times.

    `timed` are words as they are written, punctuation included, with their beginnings and ends in milliseconds. An end
    may be None: then the word lasts until the next one, or as long as such a word usually does. `offset_ms` is added to
    all times: a positive number for a voice that reports its words too early. The other arguments are those of
    :func:`labial.phonemes`. Raises LabialError, with the word, for words that are not in order; warns where all
    durations are below 5 ms, as seconds are.
    """
    found, longest, before = [], 0.0, 0.0
    for place, item in enumerate(timed, 1):
        if not isinstance(item, (tuple, list)) or len(item) != 3 or not isinstance(item[0], str):
            raise TypeError(f"word {place} is no text with its beginning and end in milliseconds")
        text, start, end = item
        found.append(Word(text, _time(start), None if end is None else _time(end)))
        longest = max(longest, float(start) - before, 0.0 if end is None else float(end) - float(start))
        before = float(start)
    expect_milliseconds(longest)
    return words.timings_of(found, pronunciation(own, language, numbers), offset(offset_ms))


def character_timings(text: Union[str, Sequence[str]], starts: Sequence[float], ends: Sequence[float], *,
                      offset_ms: float = 0, own: Optional[Mapping[str, Sounds]] = None,
                      language: str = ENGLISH, numbers: bool = False) -> List[Tuple[str, int]]:
    """The same from characters and their times in milliseconds, as ElevenLabs reports them; `text` is a string or a
    list of characters, blanks included. Raises LabialError where the numbers of characters and times differ."""
    if not len(text) == len(starts) == len(ends):
        raise LabialError(f"{len(text)} characters have {len(starts)} beginnings and {len(ends)} ends")
    how = pronunciation(own, language, numbers)
    found = words.words_of_characters(list(text), list(map(_time, starts)), list(map(_time, ends)), how.language)
    expect_milliseconds(max((float(end) - float(start) for start, end in zip(starts, ends)), default=0.0))
    return words.timings_of(found, how, offset(offset_ms))


def _time(value: Any) -> int:
    found = number(value, "a time")
    if not 0.0 <= found <= words.LATEST:
        raise LabialError(f"{found:g} ms is no time from 0 to {words.LATEST} ms")
    return round(found)


def offset(value: Any) -> int:
    """Milliseconds to be added to times. Raises TypeError, and LabialError for more than 1e9."""
    found = number(value, "an offset")
    if not abs(found) <= 1e9:
        raise LabialError(f"an offset of {found:g} ms is not within 1e9 ms")
    return whole(round(found), "an offset")


#: A phoneme, by label or number, or a laugh (``<laugh:0.7>``), and how many milliseconds it lasts.
Timing = Tuple[Union[str, int], float]


class MotionFrame(Tuple[int, ...]):
    """A frame of a motion: its 13 FAPs.

    Attributes:
        visemes: its shares of sounds, as :attr:`labial.Frame.visemes`.
    """

    visemes: Tuple[int, ...]

    def __new__(cls, faps: Iterable[int], visemes: Iterable[int] = ()) -> MotionFrame:
        """A frame."""
        frame = super().__new__(cls, tuple(faps))
        frame.visemes = tuple(visemes)
        return frame


class Motion(List[Tuple[int, ...]]):
    """Frames of an utterance, each 13 FAPs, :attr:`fps` frames per second."""

    def __init__(self, frames: Iterable[Tuple[int, ...]] = (), fps: int = 50) -> None:
        super().__init__(frames)
        self.fps = fps

    def _repr_html_(self) -> str:
        """What a notebook shows: the page of ``labial page``."""
        from labial.see.player import framed, player

        return framed(player("", self.fps, self))


def render(timings: Iterable[Timing], *, model: Optional[Model] = None, laughter: Optional[Model] = None,
           labels: str = "auto", nearest: bool = False, exact: bool = False) -> Motion:
    """All frames of an utterance at once: T tuples of 13 ints, FAP units, ``model.fps`` frames per second. They are a
    list, which a notebook shows as a mouth that moves. Each has the shares of its sounds as `visemes`, for faces that
    show a tongue.

    `timings` are pairs of a phoneme, by label or number, and its milliseconds; the label ``<laugh>`` or ``<laugh:0.7>``
    is a laugh of that intensity. The other arguments, and the frames, are those of :class:`labial.Stream`: they begin
    and end at rest, for which as a rule 12 follow those of the timings unless they are to be `exact`.
    ``numpy.array(frames, "int16")`` makes an array (T, 13) of them. Raises LabialError, with the number of the timing
    from 1, and TypeError for anything but timings; warns where all durations are below 5 ms, as seconds are.
    """
    with Stream(model, laughter=laughter, labels=labels, nearest=nearest, exact=exact) as stream:
        longest = 0.0
        for place, timing in enumerate(timings, 1):
            longest = max(longest, _push(stream, place, timing))
        stream.end()
        shares = bytearray()
        frames = stream.drain(shares)
    expect_milliseconds(longest)
    return Motion(map(MotionFrame, zip(*[iter(frames)] * CHANNELS), zip(*[iter(shares)] * VISEMES)), stream.fps)


def _push(stream: Stream, place: int, timing: Any) -> float:
    """Pushes a timing; returns its milliseconds."""
    if not isinstance(timing, (tuple, list)) or len(timing) != 2:
        raise TypeError(f"timing {place} is no pair of a phoneme and milliseconds")
    phoneme, milliseconds = timing
    laugh = LAUGH.fullmatch(phoneme) if isinstance(phoneme, str) else None
    try:
        if laugh:
            stream.laugh(duration(milliseconds) / 1000.0, _intensity(laugh[1]))
        else:
            stream.push(phoneme, milliseconds)
    except (LabialError, TypeError) as error:
        error.args = (f"timing {place}: {error}",)
        raise
    return float(milliseconds)


def _intensity(text: Optional[str]) -> float:
    try:
        return 0.5 if text is None else float(text)
    except ValueError:
        raise LabialError(f"a laugh's intensity is a number, not {text!r}") from None


def read_timings(given: Union[str, os.PathLike[str], TextIO, List[Any], Dict[str, Any]], *, labels: str = "auto",
                 source: Optional[str] = None, offset_ms: float = 0.0,
                 own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH, numbers: bool = False,
                 tier: Optional[str] = None) -> List[Tuple[str, float]]:
    """The input of :func:`render` from timings in any format that ``labial timings`` reads (docs/timings.md): phonemes
    and laughs with their milliseconds, from time 0 on and without gaps.

    `given` is the path of a file, an open file, such as :class:`io.StringIO`, or the parsed JSON of a service, a list
    or a dict, or the objects of its client library, such as Piper's chunks. `labels` is the set of the labels, `source`
    the format if it should not be detected. `offset_ms` is added to all times: a positive number for a voice that
    reports them too early. For words or characters, the other arguments say how they are pronounced, as for
    :func:`labial.phonemes`. `tier` is the tier of a TextGrid, by its name. Raises DataError with the file and, if
    known, the line.
    """
    from labial.corpus.formats import read_timings as read
    from labial.corpus.timings import phone_set_of, phoneme_segments

    path = given if isinstance(given, (str, os.PathLike)) else _content(given)
    segments = read(path, source, pronunciation(own, language, numbers), offset(offset_ms) / 1000.0, tier)
    found = phoneme_segments(path, segments, phone_set_of(segments, labels), False, labels, laughs=True)
    ends = [round(segment.end * 1000.0) for segment in found]
    return [(segment.label, end - begin) for segment, begin, end in zip(found, [0, *ends], ends)]


def _content(given: Any) -> os.PathLike[str]:
    """Timings that are not in a file."""
    from labial.corpus.entries import Parsed, fields_of
    from labial.files.grammar import Content

    if isinstance(given, (list, tuple)):
        return Parsed(given, "timings")
    if not hasattr(given, "read"):
        if fields_of(given) is None:
            raise TypeError(f"timings are a path, a file, a list or a dict, not {type(given).__name__}")
        return Parsed([given], "timings")
    data = given.read()
    name = getattr(given, "name", "timings")
    return Content(data.encode("utf-8") if isinstance(data, str) else bytes(data),
                   name if isinstance(name, str) else "timings")
