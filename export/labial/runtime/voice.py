"""A voice: messages of a speech service in, as they arrive while its sound plays; frames out, when they are due."""

from __future__ import annotations

import asyncio
import math
from typing import Any, AsyncIterator, Callable, List, Mapping, Optional, Sequence, Tuple, Union

from labial.core.guard import Guard, alone
from labial.core.library import CANCEL_MAX, DURATION_MAX, ERROR_STATE
from labial.core.numbers import duration, number
from labial.corpus.messages import Messages
from labial.corpus.words import ENGLISH, pronunciation
from labial.errors import LabialError, StreamError
from labial.files.faps import CHANNELS
from labial.runtime.frame import Frame
from labial.runtime.models import LABELS, Model, bundled
from labial.runtime.stream import Stream
from labial.runtime.timeline import Item, Segment, Timeline, milliseconds
from labial.runtime.words import Sounds, offset

#: A changed frame fades in over so many frames.
_FADE = 8
#: Seconds of what was shown that a new stream is given, besides the part of a second before.
_HISTORY = 2
#: Seconds from the end of the last word until lips are at rest.
_REST = 0.5
#: Seconds between two looks at a clock that has not begun.
_PATIENCE = 0.01
#: Times are believed up to this many seconds, a year.
_LATEST = 3.2e7

_NEUTRAL = (0,) * CHANNELS


class Voice:
    """Lips that follow a voice whose words or phonemes become known while it is heard.

        voice = labial.Voice()
        ...
        voice.feed(message)                  # whenever the service sends one
        ...
        for frame in voice.played(seconds):  # often: how much of the sound was heard
            show(frame)

    Frame k is due when k / :attr:`fps` seconds of the sound were heard. What becomes known late, or otherwise than
    before, changes the frames that were not returned yet: they fade over 8 frames to what they would have been.
    docs/streams.md has the rules.

    Calls from several threads wait for each other, as those of :class:`labial.Stream`. Closing frees the memory.

    Args:
        format: what the service's messages are, a name of docs/timings.md such as "elevenlabs"; None to recognise it.
        model: ``labial.speech_en`` without it. labels: the set of phoneme labels, as for :class:`labial.Stream`.
        nearest: unknown labels of :meth:`push` move like the nearest known ones, as those of services always do.
        own, language, numbers: how words are pronounced, as for :func:`labial.phonemes`. offset_ms: milliseconds that
        are added to all times: a positive number for a service that reports them too early.
    """

    def __init__(self, format: Optional[str] = None, *, model: Optional[Model] = None, labels: str = "auto",
                 nearest: bool = False, own: Optional[Mapping[str, Sounds]] = None, language: str = ENGLISH,
                 numbers: bool = False, offset_ms: float = 0.0) -> None:
        self._model = bundled("speech_en") if model is None else model
        if not isinstance(self._model, Model):
            raise TypeError(f"a model is a labial.Model, not {type(model).__name__}")
        if not isinstance(labels, str) or labels not in LABELS:
            raise LabialError(f"{labels!r} is no set of labels, {', '.join(LABELS)}")
        self._labels, self._nearest = labels, bool(nearest)
        self._guard = Guard()
        self._messages = Messages(format, labels)
        self._timeline = Timeline(self._model.number, self._model.silence, pronunciation(own, language, numbers),
                                  offset(offset_ms))
        self._timeline.begin(0)
        self._closed = self._finished = self._cancelled = False
        self._changed = True  # something was told since the last frame
        self._next = 0  # the frame that comes next
        self._shown: Optional[Tuple[int, ...]] = None  # FAPs of the frame before
        # The stream that makes the frames, and the phonemes that it has; None: the face is neutral.
        self._stream: Optional[Stream] = None
        self._plan: List[Segment] = []
        self._pushed: List[Segment] = []
        # A fade: what is added to the stream's frames, less with each step.
        self._fade: Tuple[int, ...] = _NEUTRAL
        self._step = self._steps = 0

    # ---- What becomes known

    @alone
    def feed(self, message: Any) -> None:
        """A message of the service: parsed JSON, its text or bytes. Messages without timings are passed over.

        Raises DataError for one that is malformed and TypeError for one of another type; what was known stays known.
        """
        self._open()
        for heard in self._messages.read(message):
            if self._listens():
                self._timeline.tell(heard)

    @alone
    def say(self, text: str, start: float, end: Optional[float] = None) -> None:
        """A word as it is written, with its punctuation, from `start` to `end`, seconds from the beginning of the
        utterance; without an end it lasts until the next word, or as long as it usually does.

        Raises LabialError for times that are negative, turned round or beyond a year.
        """
        self._open()
        if not isinstance(text, str):
            raise TypeError(f"a word is a str, not {type(text).__name__}")
        begin, stop = _seconds(start), None if end is None else _seconds(end)
        _check_times(begin, begin if stop is None else stop, f"{text!r:.40}")
        if text.strip() and self._listens():
            self._timeline.put("words", Item(milliseconds(begin), None if stop is None else milliseconds(stop),
                                             text.strip()))

    @alone
    def push(self, phoneme: Union[str, int], start: float, end: float) -> None:
        """A phoneme, by its label or its number in the model, from `start` to `end`, seconds from the beginning of the
        utterance. Where an utterance has phonemes, its words are not read.

        Raises StreamError for an unknown label or number; LabialError as :meth:`say`, and for more than an hour.
        """
        self._open()
        found = self._model.number(phoneme, self._labels, self._nearest)
        begin, stop = _seconds(start), _seconds(end)
        _check_times(begin, stop, "a phoneme")
        if self._listens():
            self._timeline.put("phonemes", Item(milliseconds(begin), milliseconds(stop), found))

    @alone
    def begin(self, at: Optional[float] = None) -> None:
        """The next utterance, whose sound begins when `at` seconds were heard: times that are told count from there.

        Without `at` it begins where the former one ends, as far as is known, or now if that is over.
        """
        self._open()
        self._begin(None if at is None else milliseconds(_seconds(at)))

    @alone
    def finish(self) -> None:
        """Nothing more follows: :attr:`done` tells when all was shown. What is told afterwards nevertheless begins the
        next utterance."""
        self._open()
        self._finished = True

    @alone
    def cancel(self, milliseconds: float = 200) -> None:
        """Drops all that is not shown yet, and eases to the neutral face over so many milliseconds, rounded up to whole
        frames, 1 to 1,000. What is told of the cancelled utterance is ignored until :meth:`begin`."""
        self._open()
        steps = math.ceil(duration(milliseconds) * self.fps / 1000.0 - 1e-6)
        self._timeline.clear()
        self._cancelled = self._changed = True
        self._drop_stream()
        self._fade_from(_NEUTRAL, max(1, min(steps, CANCEL_MAX)))

    # ---- What is shown

    @alone
    def played(self, seconds: Optional[float]) -> List[Frame]:
        """The frames that became due since the last call, when so many seconds of the sound were heard; usually none
        to three.

        A clock that goes back, or None from one that has not begun, yields none. More than a second after the last
        call, only the latest frame is returned. Raises LabialError for more than a year and what is no number.
        """
        self._open()
        if seconds is None:
            return []
        heard = number(seconds, "a time")
        if not heard <= _LATEST:
            raise LabialError(f"{heard:g} s is no time")
        last = math.floor(heard * self.fps + 1e-6) if heard >= 0.0 else -1
        if last < self._next:
            return []
        late = last - self._next >= self.fps
        if late:
            self._next = last
        if self._changed or late:
            self._follow_changes(late)
        frames = []
        while self._next <= last:
            faps = self._faded(self._frame())
            frames.append(Frame(self._next, faps))
            self._shown = faps
            self._next += 1
        return frames

    async def follow(self, clock: Callable[[], Optional[float]]) -> AsyncIterator[Frame]:
        """The frames as they become due, until the voice is closed or, after :meth:`finish`, :attr:`done`. `clock`
        returns how many seconds of the sound were heard, or None as long as it has not begun."""
        while not self._closed:
            heard = clock()
            for frame in self.played(heard):
                yield frame
                if self._closed:
                    return
            if self._finished and self.done:
                return
            wait = _PATIENCE if heard is None else self._next / self.fps - heard
            await asyncio.sleep(min(max(wait, 0.001), 1.0 / self.fps))

    @property
    def done(self) -> bool:
        """Whether nothing more will move: after :meth:`finish`, half a second after the last word, if there was any;
        after :meth:`cancel`, when the face is neutral."""
        if self._cancelled:
            return self._step == self._steps
        if self._timeline.is_empty:
            return self._finished
        return self._finished and self._next >= (self._timeline.end / 1000 + _REST) * self.fps

    @property
    def time(self) -> float:
        """When the next frame is due, seconds of the sound."""
        return self._next / self.fps

    @property
    def fps(self) -> int:
        """Frames per second."""
        return self._model.fps

    # ---- Closing

    @alone
    def close(self) -> None:
        """Frees the memory; may be called again. Every other call then raises StreamError."""
        self._closed = True
        self._timeline.clear()
        self._drop_stream()

    @alone
    def __enter__(self) -> Voice:
        self._open()
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # ---- With the lock held

    def _open(self) -> None:
        if self._closed:
            raise StreamError(ERROR_STATE, "the voice is closed")

    def _listens(self) -> bool:
        """Whether what is told counts; then the stream may change."""
        if self._finished and not self._cancelled:
            self._begin(None)
        self._changed = True
        return not self._cancelled

    def _begin(self, at: Optional[int]) -> None:
        now = self._now()
        self._timeline.begin(max(self._timeline.end, now) if at is None else at)
        self._cancelled = self._finished = False
        self._changed = True

    def _now(self) -> int:
        """When the next frame is due, milliseconds."""
        return self._next * 1000 // self.fps

    def _follow_changes(self, late: bool) -> None:
        """Looks whether the stream has phonemes that are no longer right, and if so makes a new one."""
        self._changed = False
        start = max(0, self._now() // 1000 - _HISTORY) * 1000
        self._timeline.forget(start)
        if self._stream is None and self._timeline.is_empty and self._shown is not None:
            return  # the neutral face after a cancel
        plan = self._timeline.plan(start)
        pushed = [item._replace(start=max(item.start, start)) for item in self._pushed if item.end > start]
        if self._stream is None or late or plan[: len(pushed)] != pushed:
            self._renew(plan)
        else:
            self._plan, self._pushed = plan[len(pushed) :], pushed

    def _renew(self, plan: List[Segment]) -> None:
        """A new stream, which is given `plan`; the difference from what was shown fades."""
        self._drop_stream()
        self._stream, self._plan = Stream(self._model), plan
        base = _NEUTRAL
        for _ in range(plan[0].start // 1000 * self.fps, self._next):
            base = self._frame()
        self._fade_from(base, _FADE)

    def _fade_from(self, base: Sequence[int], steps: int) -> None:
        """Begins to fade from what was shown, where the stream is at `base`."""
        shown = base if self._shown is None else self._shown
        self._fade = tuple(one - other for one, other in zip(shown, base))
        self._step, self._steps = 0, steps

    def _frame(self) -> Tuple[int, ...]:
        """The next frame of the stream."""
        if self._stream is None:
            return _NEUTRAL
        while True:
            for frame in self._stream:
                return frame.faps
            if self._plan:
                self._pushed.append(self._plan.pop(0))
            start, end, phoneme = self._pushed[-1]  # the endless silence again when an hour of it is over
            length = DURATION_MAX if math.isinf(end) else int(end) - start
            for passed in range(0, length, DURATION_MAX):
                self._stream.push(phoneme, min(length - passed, DURATION_MAX))

    def _faded(self, base: Tuple[int, ...]) -> Tuple[int, ...]:
        """A frame of the stream as it is shown."""
        if self._step == self._steps:
            return base
        self._step += 1
        left = 16384 - _ease(self._step, self._steps)
        return tuple(max(-32768, min(value + ((more * left + 8192) >> 14), 32767))
                     for value, more in zip(base, self._fade))

    def _drop_stream(self) -> None:
        if self._stream is not None:
            self._stream.close()
        self._stream, self._plan, self._pushed = None, [], []


def _ease(step: int, steps: int) -> int:
    """Progress of a smooth transition, 0 to 16384 (labial_ease of lib/fixed.h)."""
    share = (step << 14) // steps
    return ((share * share >> 14) * (3 * 16384 - 2 * share)) >> 14


def _seconds(value: Any) -> float:
    found = number(value, "a time")
    if not 0.0 <= found <= _LATEST:
        raise LabialError(f"{found:g} s is no time from 0 on")
    return found


def _check_times(begin: float, end: float, what: str) -> None:
    if not begin <= end <= begin + DURATION_MAX / 1000:
        raise LabialError(f"{what} from {begin:g} to {end:g} s ends before it begins, or lasts more than an hour")
