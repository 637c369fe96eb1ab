"""What speech services tell of words, of written characters and of phonemes in their messages, as JSON.

Each service has a function that takes a message and says what it tells; of messages without timings, such as those of
sound, that is nothing. :mod:`labial.corpus.word_files` makes segments of it, and so does a voice that is followed
(:mod:`labial.runtime.timeline`). Where a service tells phonemes as well as words, the phonemes count.

Some services tell the times of each message from its own sound, others from the beginning: a message that begins before
the end of the one before it is taken to begin there.
"""

from __future__ import annotations

import re
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence

from labial.corpus.entries import Entry, entry_of

#: Azure's and Edge's ticks per second.
_TICKS = 1e7
#: Names of the same three lists in messages about characters: of texts, beginnings, and ends or durations.
_CHARACTERS = ("characters", "chars")
_STARTS = ("characterstarttimesseconds", "characterstarttimeseconds", "characterstarttimesms", "charstarttimesms",
           "starttimesseconds", "starttimesms", "starttimes", "starts", "start")  # fmt: skip
_ENDS = ("characterendtimesseconds", "characterendtimeseconds", "characterendtimesms", "charendtimesms",
         "endtimesseconds", "endtimesms", "endtimes", "ends", "end")  # fmt: skip
_DURATIONS = ("charsdurationsms", "chardurationsms", "characterdurationsms", "durationsms")


class Timed(NamedTuple):
    """A text in seconds; the end is None where it is not told."""

    text: str
    start: float
    end: Optional[float]
    place: Entry


class Told(NamedTuple):
    """What a message tells of one kind."""

    kind: str  #: "phonemes", "words" or "characters"
    items: List[Timed]
    key: Optional[float] = None  #: later messages with the same key replace this one


def later(word: Timed, origin: float) -> Timed:
    """The same, `origin` seconds later."""
    return word._replace(start=word.start + origin, end=None if word.end is None else word.end + origin)


def origin_of(items: Sequence[Timed], end: float) -> float:
    """From when on a message's times count: one that begins before `end`, the end of those before it, begins there."""
    return end if items[0].start < end - 1e-3 else 0.0


def end_of(items: Sequence[Timed]) -> float:
    """The latest end of items, or beginning where it is not told."""
    return max(item.end or item.start for item in items)


# ---- What a message tells


def tell_words(item: Entry) -> List[Told]:
    """An object with `word` (or `text`), `start` and `end`, in seconds; `start_time` and `end_time` do as well."""
    return [Told("words", [_word(item)])]


def tell_boundary(item: Entry) -> List[Told]:
    """A word boundary of Azure's libraries or of edge-tts: `text`, `audio_offset` (or `offset`) and `duration`, in
    ticks of 100 ns; boundaries of sentences are passed over."""
    if not is_boundary(item) or "sentence" in str(item.fields.get("type", "")).lower() + _kind(item):
        return []
    start = item.number_of("audiooffset", "privaudiooffset", "offset") / _TICKS
    length = item.number_of("duration", "privduration") / _TICKS if item.has("duration") or item.has(
        "privduration") else None
    text = item.text_of("text", "privtext")
    return [Told("words", [Timed(text, start, None if length is None else start + length, item)])]


def tell_word_mark(item: Entry) -> List[Told]:
    """One of Amazon Polly's speech marks of type "word": `time` in milliseconds."""
    if not item.has("type") or item.get("type") != "word":
        return []
    return [Told("words", [Timed(item.text_of("value"), item.number_of("time") / 1000, None, item)])]


def _tell_google(item: Entry) -> List[Told]:
    """Google's `timepoints`: marks that are named by the word that follows them, and their `timeSeconds`."""
    marks = item.parts("timepoints") if item.has("timepoints") else [item]
    return [Told("words", [Timed(mark.text_of("markname"), mark.number_of("timeseconds"), None, mark)
                           for mark in marks])]


def _tell_kokoro_fastapi(item: Entry) -> List[Told]:
    """An answer of Kokoro-FastAPI's ``/dev/captioned_speech``: `timestamps` of `word`, `start_time` and `end_time`."""
    if not item.has("timestamps") or item.get("timestamps") is None:
        return []
    return [Told("words", [_word(part) for part in item.parts("timestamps")])]


def _tell_cartesia(item: Entry) -> List[Told]:
    """Cartesia's `phoneme_timestamps` or `word_timestamps`: lists of the texts, their `start` and `end` in seconds."""
    return [Told(kind, _lists(_inner(item, name), (kind,), ("start",), ("end",)))
            for name, kind in (("phonemetimestamps", "phonemes"), ("wordtimestamps", "words"))
            if item.has(name) and item.get(name) is not None]


def _tell_hume(item: Entry) -> List[Told]:
    """Hume's timestamps, of phonemes or of words: `text`, `type` and `time` (`begin` and `end`, milliseconds), in
    messages of their own or in the snippets of an answer."""
    found: Dict[str, List[Timed]] = {"phoneme": [], "word": []}
    for stamp in _hume_stamps(item):
        time = _inner(stamp, "time")
        kind = stamp.text_of("type")
        if kind in found:
            found[kind].append(Timed(stamp.text_of("text"), time.number_of("begin") / 1000,
                                     time.number_of("end") / 1000, stamp))
    return [Told(f"{kind}s", items) for kind, items in found.items()]


def _tell_inworld(item: Entry) -> List[Told]:
    """Inworld's `timestampInfo`: the phones of its `phoneticDetails`, words, characters."""
    item = _inner(item, "result") if item.has("result") else item
    if not item.has("timestampinfo") or item.get("timestampinfo") is None:
        return []
    info = _inner(item, "timestampinfo")
    found = []
    if info.has("wordalignment") and info.get("wordalignment"):
        alignment = _inner(info, "wordalignment")
        details = alignment.parts("phoneticdetails") if alignment.has("phoneticdetails") else []
        found = [Told("phonemes", [_phone(part) for detail in details for part in detail.parts("phones")]),
                 Told("words", _lists(alignment, ("words",), ("wordstarttimeseconds",), ("wordendtimeseconds",)))]
    if info.has("characteralignment") and info.get("characteralignment"):
        found.append(Told("characters", _lists(_inner(info, "characteralignment"), _CHARACTERS, _STARTS, _ENDS)))
    return found


def _tell_fish(item: Entry) -> List[Told]:
    """An event of Fish Audio's: `alignment` with `segments` of `text`, `start` and `end`, of which the latest of each
    `chunk_seq` counts, later by `chunk_audio_offset_sec`."""
    if not item.has("alignment") or item.get("alignment") is None:
        return []
    origin = item.number_of("chunkaudiooffsetsec") if item.has("chunkaudiooffsetsec") else 0.0
    key = item.number_of("chunkseq") if item.has("chunkseq") else None
    return [Told("words", [later(_word(part), origin) for part in _inner(item, "alignment").parts("segments")], key)]


def _tell_minimax(item: Entry) -> List[Told]:
    """A sentence of MiniMax's file of subtitles of words: `timestamped_words` of `word`, `time_begin` and `time_end`,
    milliseconds. Pieces of a word, whose places in the text (`word_begin`, `word_end`) adjoin, are joined."""
    if item.get("timestampedwords") is None:
        raise item.error("subtitles of sentences: ask for subtitle_type word")
    found: List[Timed] = []
    behind: Optional[float] = None
    for part in item.parts("timestampedwords"):
        word = Timed(part.text_of("word"), part.number_of("timebegin") / 1000, part.number_of("timeend") / 1000, part)
        if part.has("wordbegin") and part.number_of("wordbegin") == behind and _adjoin(found[-1].text, word.text):
            found[-1] = found[-1]._replace(text=found[-1].text + word.text, end=word.end)
        else:
            found.append(word)
        behind = part.number_of("wordend") if part.has("wordend") else None
    return [Told("words", found)]


def _tell_elevenlabs(item: Entry) -> List[Told]:
    """ElevenLabs' answers and messages: `normalized_alignment`, else `alignment`, with characters and their times in
    seconds (HTTP) or milliseconds (WebSocket)."""
    return [Told("characters", _lists(found, _CHARACTERS, _STARTS, _ENDS, _DURATIONS))
            for found in _first(item, "normalizedalignment", "alignment")]


def _tell_soniox(item: Entry) -> List[Told]:
    """Soniox's messages of characters: the lists may stand in `timestamps`, `alignment` or the message itself."""
    holders = list(_first(item, "timestamps", "alignment", "charactertimestamps"))
    return [Told("characters", _lists(holder, _CHARACTERS, _STARTS, _ENDS, _DURATIONS)) for holder in holders or [item]
            if any(holder.has(name) for name in _CHARACTERS)]


# ---- How a file's first object tells the service


def is_boundary(first: Entry) -> bool:
    """Whether this is a word boundary of Azure's or of edge-tts."""
    offset = first.has("audiooffset") or first.has("privaudiooffset") or first.has("offset", "duration")
    return offset and (first.has("text") or first.has("privtext"))


def _is_elevenlabs(first: Entry) -> bool:
    holders = list(_first(first, "normalizedalignment", "alignment"))
    return first.has("normalizedalignment") or any(holder.has(name) for holder in holders for name in _CHARACTERS)


def _is_fish(first: Entry) -> bool:
    return first.has("chunkseq") or any(holder.has("segments") for holder in _first(first, "alignment"))


def _is_kokoro_fastapi(first: Entry) -> bool:
    stamps = first.fields.get("timestamps")
    return first.has("audioformat", "timestamps") or (
        isinstance(stamps, list) and bool(stamps) and isinstance(stamps[0], dict) and "word" in stamps[0])


def _is_inworld(first: Entry) -> bool:
    return any(item.has("timestampinfo") for item in (first, *_first(first, "result")))


def _is_words(first: Entry) -> bool:
    return any(first.has(text, start, end) for text in ("word", "text")
               for start, end in (("start", "end"), ("starttime", "endtime")))


class WordService(NamedTuple):
    """A service that tells words or characters."""

    title: str
    tell: Callable[[Entry], List[Told]]  #: what a message tells
    told: Callable[[Entry], bool]  #: whether a file's first object is one of it
    joins: bool = False  #: whether the times of a message may count from the end of the one before


#: Every service, in the order of detection.
SERVICES: Dict[str, WordService] = {
    "elevenlabs": WordService("ElevenLabs", _tell_elevenlabs, _is_elevenlabs, True),
    "cartesia": WordService("Cartesia", _tell_cartesia, lambda first: first.has("wordtimestamps")
                            or first.has("phonemetimestamps") or first.has("type", "contextid")),
    "inworld": WordService("Inworld", _tell_inworld, _is_inworld, True),
    "hume": WordService("Hume", _tell_hume, lambda first: first.has("snippetid") or first.has("generations")),
    "fish": WordService("Fish Audio", _tell_fish, _is_fish),
    "minimax": WordService("MiniMax", _tell_minimax, lambda first: first.has("timestampedwords")),
    "kokoro-fastapi": WordService("Kokoro-FastAPI", _tell_kokoro_fastapi, _is_kokoro_fastapi, True),
    "soniox": WordService("Soniox", _tell_soniox, lambda first: first.has("streamid"), True),
    "google": WordService("Google", _tell_google,
                          lambda first: first.has("timepoints") or first.has("markname", "timeseconds")),
    "words": WordService("other programs (word, start, end)", tell_words, _is_words),
}


# ---- Parts of messages


def _word(item: Entry) -> Timed:
    return Timed(item.text_of("word", "text"), item.number_of("start", "starttime"), item.number_of("end", "endtime"),
                  item)


def _phone(item: Entry) -> Timed:
    """One of Inworld's phones, without the digit of its stress."""
    start = item.number_of("starttimeseconds")
    return Timed(re.sub(r"\d+$", "", item.text_of("phonesymbol")), start, start + item.number_of("durationseconds"),
                  item)


def _kind(item: Entry) -> str:
    """What kind of boundary a service says that this is."""
    return str(item.get("boundarytype", "privboundarytype")).lower() if item.has("boundarytype") or item.has(
        "privboundarytype") else ""


def _inner(item: Entry, name: str) -> Entry:
    """A field that must be an object."""
    return entry_of(item.path, item.line, item.number, item.get(name))


def _first(item: Entry, *names: str) -> Iterator[Entry]:
    """The first of the fields that is an object and not empty, or none."""
    for name in names:
        value = item.get(name) if item.has(name) else None
        if isinstance(value, dict) and value:
            yield entry_of(item.path, item.line, item.number, value)
            return


def _hume_stamps(item: Entry) -> Iterator[Entry]:
    """The timestamps of a message, or of the snippets of an answer."""
    if item.has("timestamp"):
        yield _inner(item, "timestamp")
    if item.has("timestamps") and item.get("timestamps") is not None:
        yield from item.parts("timestamps")
    for generation in item.parts("generations") if item.has("generations") else []:
        for snippets in generation.list_of("snippets"):
            for snippet in snippets if isinstance(snippets, list) else [snippets]:
                yield from _hume_stamps(entry_of(item.path, item.line, item.number, snippet))


def _lists(item: Entry, texts: Sequence[str], starts: Sequence[str], ends: Sequence[str],
           durations: Sequence[str] = ()) -> List[Timed]:
    """Texts and their times from lists of equal length; names that end in "ms" are of milliseconds."""
    names = item.list_of(*texts)
    begins = _times(item, starts)
    if durations and any(item.has(name) for name in durations):
        finishes = [begin + length for begin, length in zip(begins, _times(item, durations))]
    else:
        finishes = _times(item, ends)
    if not len(names) == len(begins) == len(finishes) or not all(isinstance(name, str) for name in names):
        raise item.error(f"{texts[0]!r} and their times are not of one length")
    return [Timed(name, begin, end, item) for name, begin, end in zip(names, begins, finishes)]


def _times(item: Entry, names: Sequence[str]) -> List[float]:
    """A list of times in seconds."""
    name = next((name for name in names if item.has(name)), names[0])
    scale = 1000.0 if name.endswith("ms") else 1.0
    return [item.as_number(value, name) / scale for value in item.list_of(name)]


def _adjoin(before: str, after: str) -> bool:
    return bool(before and after) and before[-1].isalnum() and after[0].isalnum()
