"""A voice: messages of a speech service in, as they arrive while its sound plays; frames out, when they are due.

The rules are the library's (include/labial/voice.h); docs/streams.md explains them.
"""

from __future__ import annotations

import asyncio
import ctypes
import math
import time
import warnings
from contextlib import suppress
from typing import Any, AsyncIterator, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from labial.core.guard import Closing, alone, duration, number, opened
from labial.core.library import CANCEL_MAX, ERROR_FULL, OK, PRONOUNCE, VISEMES, WAITING, checked, library, memory
from labial.core.words import OwnWords, labels
from labial.corpus import words
from labial.corpus.languages import is_chinese
from labial.corpus.messages import Messages, Stats
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from labial.runtime.models import Model, bundled, expected, set_of
from labial.runtime.render import Sounds, offset
from labial.runtime.stream import Frame

#: Room for words and phonemes ahead of the sound: a server is not trusted. A phoneme or character takes
#: one place, a word up to 20 letters two (LABIAL_VOICE_SIZE of include/labial/voice.h).
PLACES = 20_000
#: Seconds between two looks at a clock that has not begun.
_PATIENCE = 0.01
#: The clock is believed up to this many seconds, a year; items up to a day after their utterance's beginning, and those
#: that last an hour at most.
_LATEST, _DAY, _HOUR = 3.2e7, 86_400.0, 3600.0
#: Seconds beyond which the time of a word or phoneme is doubted.
_LONG = 10.0
#: Words of other languages whose pronunciations are kept.
_SPOKEN = 10_000
#: Kinds of items (labial_voice_kind_t), and from when on their times count (labial_voice_times_t).
_KINDS = {"phonemes": 0, "azure": 1, "polly": 2, "words": 3, "characters": 4}
_ABSOLUTE, _CHAINED, _JOINED = range(3)
#: Text, beginning and end of an item in seconds; the end is None if unknown.
_Item = Tuple[Union[str, int], float, Optional[float]]


class Voice(Closing):
    """Lips that follow a voice whose words or phonemes become known while it is heard.

        voice = labial.Voice()
        ...
        voice.feed(message)                  # whenever the service sends one
        ...
        for frame in voice.played(seconds):  # often: how much of the sound was heard
            show(frame)

    Frame k is due when k / :attr:`fps` seconds of the sound were heard. Late or corrected timings change the frames not
    yet returned; these fade to their new values over 8 frames. docs/streams.md has the rules.

    Calls from several threads wait for each other, as those of :class:`labial.Stream`. Closing frees the memory.

    Args:
        format: what the service's messages are, a name of docs/timings.md such as "elevenlabs"; None to recognise it.
        model: ``labial.speech_en`` without it. labels: the set of phoneme labels, as for :class:`labial.Stream`.
        nearest: unknown labels of :meth:`push` move like the nearest known ones, as those of services always do.
        own, language, numbers: how words are pronounced, as for :func:`labial.phonemes`. offset_ms: milliseconds that
        are added to all times: a positive number for a service that reports them too early.
    """

    _what = "voice"

    def __init__(self, format: Optional[str] = None, *, model: Optional[Model] = None, labels: str = "auto",
                 nearest: bool = False, own: Optional[Mapping[str, Sounds]] = None, language: str = words.ENGLISH,
                 numbers: bool = False, offset_ms: float = 0.0) -> None:
        super().__init__()
        self._model = expected(bundled("speech_en") if model is None else model)
        set_of(labels)
        self._labels, self._nearest = labels, bool(nearest)
        self._messages = Messages(format, labels)
        self._library = library()
        self._memory = memory(self._library.voice_size(self._model.address, PLACES))
        self._numbers = _numbers_in(self._model)
        checked(self._library.voice_init(self._memory, self._model.address, PLACES, self._numbers, offset(offset_ms)),
                self._model.name)
        self._speaker = _Speaker(words.pronunciation(own, language, numbers))
        if self._speaker.asks:
            checked(self._library.voice_pronounce(self._memory, self._speaker.callback))
        else:
            checked(self._library.voice_words(self._memory, self._speaker.own.place))
        self._faps, self._shares = (ctypes.c_int16 * CHANNELS)(), (ctypes.c_uint8 * VISEMES)()
        self._since, self._eased = 0.0, 0  # when the clock moved last, or a cancel was, and the poses since then
        self._heard = -math.inf  # the time of the call before

    # ---- What becomes known

    @opened
    def feed(self, message: Any) -> None:
        """A message of the service: parsed JSON, an object of its client library, a list of these; text or bytes of
        JSON, of lines of JSON or of server-sent events. Messages without timings are passed over, and items that make
        no sense are skipped: :attr:`stats` counts them, and the logger ``labial`` names them at level DEBUG.

        Raises DataError for a message that is no JSON or beyond a limit of :mod:`labial.files.limits`, and TypeError
        for one of another type; what was known stays known.
        """
        for heard in self._messages.read(message):
            counted = _CHAINED if heard.chained else _JOINED if heard.joins else _ABSOLUTE
            for told in heard.told:
                self._tell(told.kind, [(item.text, item.start, item.end) for item in told.items], counted,
                           heard.utterance, 0 if told.key is None else int(told.key) + 1,
                           round(heard.gap * 1000))

    @opened
    def say(self, text: str, start: float, end: Optional[float] = None) -> None:
        """A word as it is written, with its punctuation, from `start` to `end`, seconds from the beginning of the
        utterance; without an end it lasts until the next word, or as long as it usually does.

        Raises LabialError for times that are negative, turned round or beyond a day, and for more than an hour.
        """
        if not isinstance(text, str):
            raise TypeError(f"a word is a str, not {type(text).__name__}")
        item = _timed(text.strip(), start, end, f"{text!r:.40}")
        if text.strip():
            self._tell("words", [item])

    @opened
    def push(self, phoneme: Union[str, int], start: float, end: float) -> None:
        """A phoneme, by its label or its number in the model, from `start` to `end`, seconds from the beginning of the
        utterance. Where an utterance has phonemes, its words are not read.

        Raises StreamError for an unknown label or number; LabialError as :meth:`say`.
        """
        found = self._model.number(phoneme, self._labels, self._nearest)
        self._tell("phonemes", [_timed(found, start, _seconds(end), "a phoneme")])

    @opened
    def begin(self, at: Optional[float] = None, utterance: Optional[str] = None) -> None:
        """The next utterance, whose sound begins when `at` seconds were heard: times count from there.

        Without `at` it begins where the former one ends, as far as is known, or now if that is over. `utterance` is
        what the service calls it in its messages; without it, it is that of the first message that tells one. What
        waits, since it was told before its sound began, is moved to `at`: the utterance of this name, or without a name
        the first one that is not over.
        """
        self._checked(self._library.voice_begin(self._memory, -1.0 if at is None else _seconds(at),
                                                self._identity(utterance)))

    @opened
    def finish(self) -> None:
        """Nothing more follows: :attr:`done` tells when the last frame is over. A later message nevertheless begins the
        next utterance. If no message told timings, a warning says so."""
        self._messages.expect_timings()
        self._checked(self._library.voice_finish(self._memory))

    @opened
    def cancel(self, milliseconds: float = 200) -> None:
        """Drops all frames that are still to come, and eases to the neutral face over so many milliseconds, rounded up
        to whole frames, 1 to 1,000. Messages of the cancelled utterance are ignored until :meth:`begin`, and if the
        service tells which one that is, also afterwards."""
        length = min(duration(milliseconds), CANCEL_MAX * 1000.0)
        self._checked(self._library.voice_cancel(self._memory, math.ceil(length - 1e-6)))
        self._since, self._eased = time.monotonic(), 0

    # ---- Frames

    @opened
    def played(self, seconds: Optional[float]) -> List[Frame]:
        """The frames that became due since the last call, when so many seconds of the sound were heard; usually none
        to three.

        A clock that goes back, or None from one that has not begun, yields none; but while it stands with the sound
        after :meth:`cancel`, or after :meth:`finish` at the end of the last item, the face comes to rest in time that
        passes. More than a second after the last call, only the latest frame is returned. Raises LabialError for more
        than a year and what is no number.
        """
        heard = -1.0 if seconds is None else number(seconds, "a time")
        if not heard <= _LATEST:
            raise LabialError(f"{heard:g} s is no time")
        frames: List[Frame] = []
        due = math.floor(heard * self.fps + 1e-6)
        while due >= 0 and self._checked(self._library.voice_frame(self._memory, due, self._faps)) == OK:
            frames.append(self._frame())
        now = time.monotonic()
        if heard > self._heard and not self._library.voice_cancelled(self._memory):
            self._since, self._eased = now, 0
        passed = math.floor((now - self._since) * self.fps) if heard <= self._heard else 0
        result = OK
        while self._eased < passed and result in (OK, WAITING):
            result = self._library.voice_ease(self._memory, self._faps)
            if result == OK:
                frames.append(self._frame())
            self._eased += result == WAITING
        self._heard = heard
        return frames

    async def follow(self, clock: Callable[[], Optional[float]]) -> AsyncIterator[Frame]:
        """The frames as they become due, until the voice is closed or, after :meth:`finish`, :attr:`done`. `clock`
        returns how many seconds of the sound were heard, or None as long as it has not begun."""
        while self._memory is not None:
            heard = clock()
            for frame in self.played(heard):
                yield frame
                if self._memory is None:
                    return
            if self._is_finished() and self.done:
                return
            wait = _PATIENCE if heard is None else self.time - heard
            await asyncio.sleep(min(max(wait, 0.001), 1.0 / self.fps))

    @property
    @alone
    def done(self) -> bool:
        """Whether nothing more will move: after :meth:`finish`, half a second after the last word, if there was any,
        also where the clock stands; after :meth:`cancel`, when the face is neutral; and when the voice is closed."""
        return self._memory is None or bool(self._library.voice_done(self._memory))

    @property
    @alone
    def cancelled(self) -> bool:
        """Whether nothing has begun since :meth:`cancel`."""
        return self._memory is not None and bool(self._library.voice_cancelled(self._memory))

    @property
    @opened
    def time(self) -> float:
        """When the next frame is due, seconds of the sound."""
        return int(self._library.voice_next(self._memory)) / self.fps

    @property
    def fps(self) -> int:
        """Frames per second."""
        return self._model.fps

    @property
    @opened
    def stats(self) -> Stats:
        """What became so far of the messages and their items."""
        found = (ctypes.c_uint32 * 3)()
        self._library.voice_counts(self._memory, found)
        read = self._messages.stats
        return Stats(read.messages, found[0], read.skipped + found[1], found[2])

    @alone
    def _is_finished(self) -> bool:
        return self._memory is None or bool(self._library.voice_finished(self._memory))

    # ---- With the lock held

    def _frame(self) -> Frame:
        """The pose that was computed."""
        self._eased += 1
        checked(self._library.voice_visemes(self._memory, self._shares))
        return Frame(self._library.voice_next(self._memory) - 1, tuple(self._faps), tuple(self._shares))

    def _checked(self, result: int) -> int:
        if result == ERROR_FULL:
            raise LabialError("too many words, phonemes or utterances are told ahead of the sound: there is room for "
                              f"{PLACES:,} phonemes")
        return checked(result)

    def _identity(self, utterance: Optional[str]) -> int:
        if utterance is None:
            return 0
        if not isinstance(utterance, str):
            raise TypeError(f"an utterance is named by a str, not {type(utterance).__name__}")
        name = utterance.encode("utf-8", "replace")
        return int(self._library.voice_identity(name, len(name)))

    def _tell(self, kind: str, items: Sequence[_Item], counted: int = _ABSOLUTE, utterance: Optional[str] = None,
              key: int = 0, gap: int = 0) -> None:
        """Gives the library what a message tells of one kind."""
        if kind == "phonemes":
            numbers = {text: bytes([self._model.number(text)]) for text in {text for text, _, _ in items}}
            texts = [numbers[text] for text, _, _ in items]
        else:
            self._model.nearest("SIL")  # raises an error for a model of other phonemes
            if kind == "characters" and self._speaker.apart:
                items = words.characters_apart([(str(text), start, end) for text, start, end in items])
            texts = [str(text).encode("utf-8", "replace")[:0xFFFF] for text, _, _ in items]
        if kind in ("words", "characters"):
            self._speaker.prepare([str(text) for text, _, _ in items], kind == "characters")
        times = [time for _, start, end in items for time in (start, -1.0 if end is None else end)]
        self._checked(self._library.voice_tell(
            self._memory, memory(self._library.voice_items_size(len(items))), len(items),
            (ctypes.c_double * len(times))(*times), (ctypes.c_uint16 * len(texts))(*map(len, texts)),
            b"".join(texts), self._identity(utterance), key, gap, _KINDS[kind], counted))


class _Speaker:
    """How the words of a voice are pronounced: by the library with `own` words, or, where it `asks` for each text, by
    `callback`."""

    def __init__(self, how: words.Pronunciation) -> None:
        self.asks = how.language != words.ENGLISH or how.numbers
        self.apart = is_chinese(how.language)  # each character is a word
        self.own = words.own_words([], how)  # an error in a word of the caller's own, or in the language, is raised now
        if self.asks:
            words.known_words(["1"], how)
        self.callback = PRONOUNCE(self._ask)
        self._how, self._tail = how, ""
        self._spoken: Dict[str, Optional[Sequence[str]]] = {}  # what other programs said; None for nothing
        self._texts: Dict[bytes, OwnWords] = {}

    def prepare(self, texts: Sequence[str], joined: bool) -> None:
        """Asks other programs for unknown words, once for all of these texts. Raises LabialError as
        :func:`labial.phonemes`."""
        if not self.asks:
            return
        if joined:  # characters: the last word may go on in the next message
            texts = words.words_of(self._tail + "".join(texts))
            self._tail = texts[-1]
        asked = words.stretches_of(texts, {**self._spoken, **self._how.own}, self._how.language)
        if asked:
            if len(self._spoken) > _SPOKEN:
                self._spoken, self._texts = {}, {}
            self._spoken.update({**dict.fromkeys(asked), **words.known_words(asked, self._how._replace(own={}))})

    def _ask(self, _: Any, text: int, size: int) -> int:
        """The library's question: the own words for a text."""
        said = ctypes.string_at(text, size)
        if said not in self._texts:
            if len(self._texts) > _SPOKEN:
                self._texts = {}
            wanted = words.stretches_of([said.decode("utf-8", "replace")], (), self._how.language)
            with suppress(LabialError):  # it said so when the text came
                self.prepare(wanted, False)
            spoken = {word: self._spoken.get(word) for word in wanted}
            known = {word: phonemes for word, phonemes in spoken.items() if phonemes is not None}
            self._texts[said] = OwnWords({**self._how.own, **words.longest_first(known)})
        return int(self._texts[said].place)


def _numbers_in(model: Model) -> Optional[ctypes.Array[ctypes.c_uint8]]:
    """A model's number of each phoneme of words; None where they are the same, or where it has other phonemes."""
    if not model.phonemes or model.phonemes == labels():
        return None
    return (ctypes.c_uint8 * len(labels()))(*(model.nearest(label, "arpabet") for label in labels()))


def _timed(text: Union[str, int], start: float, end: Optional[float], what: str) -> _Item:
    begin, stop = _seconds(start), None if end is None else _seconds(end)
    if stop is not None and not begin <= stop <= begin + _HOUR:
        raise LabialError(f"{what} from {begin:g} to {stop:g} s ends before it begins, or lasts more than an hour")
    if max(begin, stop or 0.0) > _DAY:
        raise LabialError(f"{what} at {begin:g} s is more than a day after the beginning; are these seconds?")
    if stop is not None and stop - begin > _LONG:
        warnings.warn(f"{what} lasts {stop - begin:g} s; are these seconds?", stacklevel=4)
    return text, begin, stop


def _seconds(value: Any) -> float:
    found = number(value, "a time")
    if not 0.0 <= found <= _LATEST:
        raise LabialError(f"{found:g} s is no time from 0 on")
    return found
