"""Messages of speech services, one at a time, as they arrive while the sound plays.

The formats are those of :data:`labial.corpus.services.SERVICES`. Messages without timings, such as those of sound, tell
nothing. Items that make no sense are skipped and counted; :mod:`labial.files.limits` says how much of a message is
read.
"""

from __future__ import annotations

import logging
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

from labial.corpus.entries import Entry, documents, fields_of, is_list, shown
from labial.corpus.formats import LONGEST_GAP, phoneme_segments_of
from labial.corpus.phonesets import AUTO, SPEECH
from labial.corpus.services import SERVICES, Odd, Timed, Told, service_of
from labial.errors import DataError, LabialError, did_you_mean
from labial.files.limits import MESSAGE_DOCUMENTS, MESSAGE_ITEMS, MESSAGE_TEXT

#: After so many messages without a timing, one sentence is logged.
_PATIENCE = 50

_logger = logging.getLogger("labial")


class Heard(NamedTuple):
    """What a message tells: times are seconds, and texts of the kind "phonemes" labels of ARPABET."""

    told: Tuple[Told, ...] = ()  #: of the kinds "phonemes", visemes, "words" and "characters"
    chained: bool = False  #: times count from the end of the message before
    joins: bool = False  #: they may do so, as docs/streams.md says
    gap: float = 0.0  #: a gap between phonemes, in seconds, is silence if it is longer
    utterance: Optional[str] = None  #: what the service calls the utterance


class Stats(NamedTuple):
    """What became of the messages so far."""

    messages: int = 0  #: those that were fed, sound included
    told: int = 0  #: words, characters, phonemes and visemes with their times
    skipped: int = 0  #: those that made no sense
    dropped: int = 0  #: messages of utterances that are over, and those that came twice


class Messages:
    """Reads the messages of one service: of the format `form`, a name of `SERVICES`, or of that which the first message
    with timings tells. `labels` is the set of phoneme labels where the format does not tell it."""

    def __init__(self, form: Optional[str] = None, labels: str = AUTO) -> None:
        if form is not None and form not in SERVICES:
            raise LabialError(f"{shown(form)!r} is no format of messages: {did_you_mean(form, SERVICES)}")
        self._form, self._labels = form, labels
        self._silent: Optional[str] = None  # a service whose messages had no timings
        self._phonemes: Dict[Tuple[str, str], str] = {}
        self._recognises = form is None
        self._has_warned = self._has_told_of_others = False
        self.stats = Stats()

    @property
    def skipped(self) -> int:
        """How many items made no sense."""
        return self.stats.skipped

    def read(self, message: Any) -> List[Heard]:
        """What a message tells: a dictionary, an object of a service's client library, a list of these; text or bytes
        of JSON, of lines of JSON or of server-sent events. Bytes that are neither are sound. Raises DataError for
        malformed messages and those beyond a limit, TypeError for other types."""
        name = f"message {self.stats.messages + 1}"
        self.stats = self.stats._replace(messages=self.stats.messages + 1)
        odd = Odd(strict=False)
        try:
            heard = [self._read(item, odd) for item in self._entries(message, name, odd)]
        finally:
            self.stats = self.stats._replace(skipped=self.stats.skipped + odd.count)
        if odd.first is not None:
            _logger.debug("%s%s", odd.first, f" ({odd.count} items are skipped)" if odd.count > 1 else "")
        count = sum(len(told.items) for one in heard for told in one.told)
        self.stats = self.stats._replace(told=self.stats.told + count)
        if self.stats.messages == _PATIENCE:
            self.expect_timings()
        return [one for one in heard if one.told]

    def expect_timings(self) -> None:
        """Warns, once, if there were messages and none of them told timings."""
        if not self.stats.messages or self.stats.told or self._has_warned:
            return
        self._has_warned = True
        service = SERVICES.get(self._form or self._silent or "")
        if service is None:
            problem = f"none is of a known service ({', '.join(SERVICES)})"
        else:
            problem = f"{service.title} has to be asked for them" + (f": {service.advice}" if service.advice else "")
        _logger.warning("%d messages told no timings: %s", self.stats.messages, problem)

    def _entries(self, message: Any, name: str, odd: Odd) -> List[Entry]:
        lines: List[Tuple[Optional[int], int, Any]]
        if isinstance(message, (bytes, bytearray, memoryview)):
            message = bytes(message)
            first = message[:64].lstrip()[:1]
            if first not in (b"{", b"[", b"d", b"e", b"i", b"r", b":"):
                return []
            try:
                message = message.decode("utf-8")
            except UnicodeDecodeError:
                if first not in (b"{", b"["):
                    return []
                raise DataError(name, None, "not UTF-8") from None
        if isinstance(message, str):
            lines = documents(name, message, MESSAGE_DOCUMENTS, odd.count_of)
        else:
            items = message if is_list(message) and fields_of(message) is None else [message]
            lines = [(None, number, item) for number, item in enumerate(items, 1)]
        if len(lines) > MESSAGE_DOCUMENTS:
            raise DataError(name, None, f"{len(lines)} objects, more than the {MESSAGE_DOCUMENTS} that are read")
        found = []
        for line, number, item in lines:
            fields = fields_of(item)
            if fields is not None:
                found.append(Entry(name, line, number, fields))
            elif isinstance(message, str) or is_list(message):
                raise Entry(name, line, number, {}).error(f"{shown(item)} is not an object")
            else:
                raise TypeError(f"a message is a dict, an object, a list, text or bytes, not {type(message).__name__}")
        return found

    def _read(self, item: Entry, odd: Odd) -> Heard:
        form = self._form or service_of(item)
        if form is None:
            return Heard()
        service = SERVICES[form]
        told = service.read(item, odd) if service.told(item) or not service.is_bare else []
        if sum(len(one.items) for one in told) > MESSAGE_ITEMS:
            raise item.error(f"more than {MESSAGE_ITEMS} words or phonemes in a message")
        found = [one for one in (self._converted(one, odd) for one in told) if one.items or one.key is not None]
        if found:
            self._form = form
        else:
            self._silent = form
            if self._recognises and self._form is not None:
                self._expect_others(item, form)
        return Heard(tuple(found), service.times == "chained", service.times == "restart",
                     LONGEST_GAP if any(one.kind == "phonemes" for one in told) else 0.0, service.utterance(item))

    def _converted(self, told: Told, odd: Odd) -> Told:
        """Phonemes by their labels of ARPABET; no text that is too long."""
        items = told.items
        if told.kind in ("sounds", "labels"):
            items = [Timed(self._phoneme(segment.label, segment.labels), segment.start, segment.end, items[0].place)
                     for segment in phoneme_segments_of(items, told.kind)]
        elif told.kind == "phonemes":
            items = [item._replace(text=self._phoneme(item.text, "ipa")) for item in items]
        short = [item for item in items if len(item.text) <= MESSAGE_TEXT]
        if len(short) < len(items):
            long = next(item for item in items if len(item.text) > MESSAGE_TEXT)
            odd.add(long.place, f"a text of {len(long.text)} characters, more than {MESSAGE_TEXT}")
            odd.count += len(items) - len(short) - 1
        return Told("phonemes" if told.kind in ("sounds", "labels") else told.kind, short, told.key)

    def _phoneme(self, label: str, labels: str) -> str:
        """The phoneme that a label of the set `labels` means, or the one nearest to it; an empty one is silence."""
        known = self._phonemes.get((label, labels))
        if known is None:
            first = labels if self._labels == AUTO else ""
            known = SPEECH.nearest(label, self._labels, first) if label else SPEECH.silence
            if len(self._phonemes) < MESSAGE_ITEMS:
                self._phonemes[label[:MESSAGE_TEXT], labels] = known
        return known

    def _expect_others(self, item: Entry, form: str) -> None:
        """Warns, once, of a message of another service than `form`, of which earlier ones told timings."""
        other = service_of(item)
        if other in (None, form) or SERVICES[other].is_bare or self._has_told_of_others:
            return
        self._has_told_of_others = True
        _logger.warning("message %d seems to be of %s and is not read, since earlier ones are of %s: name the format, "
                        "or use a voice for each service", self.stats.messages, SERVICES[other].title,
                        SERVICES[form].title)
