"""Messages of speech services, one at a time, as they arrive while the sound plays.

The formats are those of :data:`labial.corpus.services.SERVICES`. Messages without timings, such as those of sound, tell
nothing.
"""

from __future__ import annotations

import json
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

from labial.corpus import services, word_services
from labial.corpus.entries import Documents, Entry, entry_of, shown
from labial.corpus.phonesets import AUTO, SPEECH
from labial.corpus.timings import Empty, SourceSegment, meaning
from labial.corpus.visemes import AZURE, AZURE_PAIRS, POLLY
from labial.corpus.word_files import LONGEST_GAP
from labial.corpus.word_services import Timed, Told
from labial.errors import DataError, LabialError

#: Visemes: by the kind of what is told, the phoneme of each and of pairs.
VISEMES: Dict[str, Tuple[Dict[str, str], Dict[Tuple[str, str], str]]] = {
    "azure": (AZURE, AZURE_PAIRS), "polly": (POLLY, {})}
#: Characters of a text that are believed.
_LONGEST_TEXT = 1000
#: Formats whose messages begin where the one before ended.
_CHAINED = ("piper", "kokoro", "headtts")
#: Formats whose messages are nothing but timings: others are passed over.
_BARE = ("azure", "polly", "minimax", "google", "words", "json", *_CHAINED)


class Heard(NamedTuple):
    """What a message tells: times are seconds, and texts of the kind "phonemes" labels of ARPABET."""

    told: Tuple[Told, ...] = ()
    chained: bool = False  #: times count from the end of the message before
    joins: bool = False  #: they may do so, see :mod:`labial.corpus.word_services`
    gap: float = 0.0  #: a gap between phonemes, in seconds, is silence if it is longer


#: Of a message without timings.
NOTHING = Heard()


class Messages:
    """Reads the messages of one service.

    Args:
        form: the format, a name of `SERVICES`; None to recognise it by the first message with timings. labels: the set
        of phoneme labels where the format does not tell it.
    """

    def __init__(self, form: Optional[str] = None, labels: str = AUTO) -> None:
        if form is not None and form not in services.SERVICES:
            raise LabialError(f"{shown(form)!r} is no format of messages: {', '.join(services.SERVICES)}")
        self._form, self._labels = form, labels
        self._count = 0

    def read(self, message: Any) -> List[Heard]:
        """What a message tells: parsed JSON, a list of such, its text or bytes, or one of Piper's chunks. Bytes that
        are not JSON are sound. Raises DataError for malformed messages, TypeError for other types."""
        self._count += 1
        name = f"message {self._count}"
        found = [self._read(entry_of(name, None, number, item))
                 for number, item in enumerate(_documents(message, name), 1)]
        return [heard for heard in found if heard.told]

    def _read(self, item: Entry) -> Heard:
        form = self._form or next((name for name, service in services.SERVICES.items() if service.told(item)), None)
        if form is None or (form in _BARE and not services.SERVICES[form].told(item)):
            return NOTHING
        heard = self._told(form, item)
        for told in heard.told:
            for timed in told.items:
                _check(timed, told.kind != "characters")
        if heard.told:
            self._form = form
        return heard

    def _told(self, form: str, item: Entry) -> Heard:
        if form == "azure" and not word_services.is_boundary(item):
            name = shown(item.get("visemeid", "privvisemeid"))
            return _viseme(form, name, item.number_of("audiooffset", "privaudiooffset") / services.AZURE_RATE, item)
        if form == "polly" and item.get("type") == "viseme":
            return _viseme(form, item.text_of("value"), item.number_of("time") / 1000, item)
        if form == "azure":
            return Heard(_full(word_services.tell_boundary(item)))
        if form == "polly":
            return Heard(_full(word_services.tell_word_mark(item)))
        if form in word_services.SERVICES:
            service = word_services.SERVICES[form]
            told = [one if one.kind != "phonemes" else one._replace(items=[
                timed._replace(text=self._phoneme(timed.text.strip(), "ipa")) for timed in one.items])
                for one in service.tell(item)]
            return Heard(_full(told), joins=service.joins, gap=LONGEST_GAP)
        try:
            segments = services.SERVICES[form].read(Documents([item.fields], str(item.path)))
        except Empty:
            return NOTHING
        sounds = [Timed(self._phoneme(segment.label, segment.labels), segment.start, segment.end, item)
                  for segment in segments]
        return Heard(_full([Told("phonemes", sounds)]), chained=form in _CHAINED)

    def _phoneme(self, label: str, labels: str) -> str:
        """The phoneme that a label of the set `labels` means, or the one nearest to it; an empty one is silence."""
        segment = SourceSegment(0.0, 0.0, label, labels=labels)
        return meaning(segment, SPEECH, self._labels) or SPEECH.nearest(label, self._labels)


def _documents(message: Any, name: str) -> List[Any]:
    if isinstance(message, (bytes, bytearray, memoryview)):
        data = bytes(message)
        if data[:64].lstrip(b" \t\r\n")[:1] not in (b"{", b"["):
            return []
        message = _text_of(data, name)
    if isinstance(message, str):
        try:
            message = json.loads(message)
        except json.JSONDecodeError as error:
            raise DataError(name, None, f"not JSON: {error.msg}") from None
        except (RecursionError, ValueError):
            raise DataError(name, None,
                            "JSON that is nested too deeply or has a number of too many digits") from None
        if not isinstance(message, (dict, list)):
            raise DataError(name, None, f"{shown(message)} is not an object")
    if isinstance(message, list):
        return [_plain(item) for item in message]
    found = _plain(message)
    if not isinstance(found, dict):
        raise TypeError(f"a message is a dict, a list, text or bytes, not {type(message).__name__}")
    return [found]


def _text_of(data: bytes, name: str) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise DataError(name, None, "not UTF-8") from None


def _plain(item: Any) -> Any:
    """One of Piper's chunks as what it would be in JSON; all else as it is."""
    if not hasattr(item, "sample_rate") or not hasattr(item, "phoneme_alignments"):
        return item
    return {"sample_rate": int(item.sample_rate), "phoneme_alignments": item.phoneme_alignments and [
        {"phoneme": one.phoneme, "num_samples": int(one.num_samples)} for one in item.phoneme_alignments]}


def _viseme(form: str, name: str, start: float, item: Entry) -> Heard:
    if name not in VISEMES[form][0]:
        raise item.error(f"no viseme is called {name!r}")
    return Heard((Told(form, [Timed(name, start, None, item)]),))


def _full(told: List[Told]) -> Tuple[Told, ...]:
    """Without those that are empty, unless they replace others."""
    return tuple(one for one in told if one.items or one.key is not None)


def _check(timed: Timed, in_order: bool) -> None:
    if len(timed.text) > _LONGEST_TEXT:
        raise timed.place.error(f"a text of {len(timed.text)} characters, more than {_LONGEST_TEXT}")
    if in_order and timed.end is not None and timed.end < timed.start:
        raise timed.place.error(f"{timed.text!r:.40} ends at {timed.end:g} s, before its start {timed.start:g} s")
    if max(timed.start, timed.end or 0.0) > 86400.0:
        raise timed.place.error(f"{max(timed.start, timed.end or 0.0):g} s is more than a day; are these seconds?")
    if timed.end is not None and timed.end - timed.start > 3600.0:
        raise timed.place.error(f"{timed.text!r:.40} lasts {timed.end - timed.start:g} s, more than an hour")
