"""What speech services tell of words, of written characters and of phonemes in their messages, as JSON.

Words and characters get phonemes by :mod:`labial.corpus.words`, as `how` says: English ones without it. A file holds
one message, a list of messages or one per line, in the order of their arrival; messages without timings, such as those
of sound, are passed over. Where a service tells phonemes as well as words, the phonemes count.

Some services tell the times of each message from its own sound, others from the beginning: a message that begins before
the end of the one before it is taken to begin there.
"""

from __future__ import annotations

import re
from typing import Callable, Dict, Iterable, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from labial.corpus.entries import Entry, entry_of, read_entries
from labial.corpus.timings import PathLike, SourceSegment, checked
from labial.corpus.words import LATEST, PLAIN, Pronunciation, Word, timings_of, words_of_characters
from labial.errors import DataError, StreamError

#: Azure's and Edge's ticks per second.
_TICKS = 1e7
#: A gap between phonemes, in seconds, is silence if it is longer.
_LONGEST_GAP = 0.15
#: Names of the same three lists in messages about characters: of texts, beginnings, and ends or durations.
_CHARACTERS = ("characters", "chars")
_STARTS = ("characterstarttimesseconds", "characterstarttimeseconds", "characterstarttimesms", "charstarttimesms",
           "starttimesseconds", "starttimesms", "starttimes", "starts", "start")  # fmt: skip
_ENDS = ("characterendtimesseconds", "characterendtimeseconds", "characterendtimesms", "charendtimesms",
         "endtimesseconds", "endtimesms", "endtimes", "ends", "end")  # fmt: skip
_DURATIONS = ("charsdurationsms", "chardurationsms", "characterdurationsms", "durationsms")


class _Timed(NamedTuple):
    """A text in seconds; the end is None where it is not told."""

    text: str
    start: float
    end: Optional[float]
    place: Entry


# ---- Readers


def read_words(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads a list of objects with `word` (or `text`), `start` and `end`, in seconds; `start_time` and `end_time` do as
    well."""
    return _from_words(path, [_word(item) for item in read_entries(path)], how)


def read_boundaries(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads word boundaries of Azure's libraries and of edge-tts: `text`, `audio_offset` (or `offset`) and `duration`,
    ticks of 100 ns; boundaries of sentences are passed over."""
    found = []
    for item in read_entries(path):
        if is_boundary(item) and "sentence" not in str(item.fields.get("type", "")).lower() + _kind(item):
            start = item.number_of("audiooffset", "privaudiooffset", "offset") / _TICKS
            length = item.number_of("duration", "privduration") / _TICKS if item.has("duration") or item.has(
                "privduration") else None
            text = item.text_of("text", "privtext")
            found.append(_Timed(text, start, None if length is None else start + length, item))
    return _from_words(path, found, how)


def read_word_marks(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Amazon Polly's speech marks of type "word": `time` in milliseconds."""
    found = [_Timed(item.text_of("value"), item.number_of("time") / 1000, None, item)
             for item in read_entries(path) if item.get("type") == "word"]
    if not found:
        raise DataError(path, None, "no speech marks of type 'viseme' or 'word'")
    return _from_words(path, found, how)


def read_google(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Google's `timepoints`: marks that are named by the word that follows them, and their `timeSeconds`."""
    marks = [mark for item in read_entries(path)
             for mark in (item.parts("timepoints") if item.has("timepoints") else [item])]
    return _from_words(path, [_Timed(mark.text_of("markname"), mark.number_of("timeseconds"), None, mark)
                              for mark in marks], how)


def read_kokoro_fastapi(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads answers of Kokoro-FastAPI's ``/dev/captioned_speech``: `timestamps` of `word`, `start_time` and
    `end_time`."""
    messages = [[_word(part) for part in item.parts("timestamps")] for item in read_entries(path)
                if item.has("timestamps") and item.get("timestamps") is not None]
    return _from_words(path, _joined(messages), how)


def read_cartesia(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Cartesia's messages with `phoneme_timestamps` or `word_timestamps`: lists of the texts, their `start` and
    `end` in seconds."""
    sounds: List[_Timed] = []
    words: List[_Timed] = []
    for item in read_entries(path):
        for name, text, found in (("phonemetimestamps", "phonemes", sounds), ("wordtimestamps", "words", words)):
            if item.has(name) and item.get(name) is not None:
                found += _lists(_inner(item, name), (text,), ("start",), ("end",))
    return _from_phonemes(path, sounds) if sounds else _from_words(path, words, how)


def read_hume(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Hume's timestamps, of phonemes or of words: `text`, `type` and `time` (`begin` and `end`, milliseconds), in
    messages of their own or in the snippets of an answer."""
    found: Dict[str, List[_Timed]] = {"phoneme": [], "word": []}
    for item in read_entries(path):
        for stamp in _hume_stamps(item):
            time = _inner(stamp, "time")
            kind = stamp.text_of("type")
            if kind in found:
                found[kind].append(_Timed(stamp.text_of("text"), time.number_of("begin") / 1000,
                                          time.number_of("end") / 1000, stamp))
    return _from_phonemes(path, found["phoneme"]) if found["phoneme"] else _from_words(path, found["word"], how)


def read_inworld(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Inworld's `timestampInfo`: the phones of its `phoneticDetails`, else words, else characters."""
    sounds: List[List[_Timed]] = []
    words: List[List[_Timed]] = []
    characters: List[List[_Timed]] = []
    for item in read_entries(path):
        item = _inner(item, "result") if item.has("result") else item
        if not item.has("timestampinfo") or item.get("timestampinfo") is None:
            continue
        info = _inner(item, "timestampinfo")
        if info.has("wordalignment") and info.get("wordalignment"):
            alignment = _inner(info, "wordalignment")
            words.append(_lists(alignment, ("words",), ("wordstarttimeseconds",), ("wordendtimeseconds",)))
            details = alignment.parts("phoneticdetails") if alignment.has("phoneticdetails") else []
            sounds.append([_phone(part) for detail in details for part in detail.parts("phones")])
        if info.has("characteralignment") and info.get("characteralignment"):
            characters.append(_lists(_inner(info, "characteralignment"), _CHARACTERS, _STARTS, _ENDS))
    if any(sounds):
        return _from_phonemes(path, _joined(sounds))
    if any(words):
        return _from_words(path, _joined(words), how)
    return _from_characters(path, _joined(characters), how)


def read_fish(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Fish Audio's events: `alignment` with `segments` of `text`, `start` and `end`, of which the latest of each
    `chunk_seq` counts, later by `chunk_audio_offset_sec`."""
    chunks: Dict[float, List[_Timed]] = {}
    for number, item in enumerate(read_entries(path)):
        if not item.has("alignment") or item.get("alignment") is None:
            continue
        origin = item.number_of("chunkaudiooffsetsec") if item.has("chunkaudiooffsetsec") else 0.0
        sequence = item.number_of("chunkseq") if item.has("chunkseq") else float(number)
        parts = _inner(item, "alignment").parts("segments")
        chunks[sequence] = [_later(_word(part), origin) for part in parts]
    return _from_words(path, [word for sequence in sorted(chunks) for word in chunks[sequence]], how)


def read_minimax(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads MiniMax's file of subtitles of words: `timestamped_words` of `word`, `time_begin` and `time_end`,
    milliseconds. Pieces of a word, whose places in the text (`word_begin`, `word_end`) adjoin, are joined."""
    found: List[_Timed] = []
    behind: Optional[float] = None
    for sentence in read_entries(path):
        if sentence.get("timestampedwords") is None:
            raise sentence.error("subtitles of sentences: ask for subtitle_type word")
        for part in sentence.parts("timestampedwords"):
            word = _Timed(part.text_of("word"), part.number_of("timebegin") / 1000, part.number_of("timeend") / 1000,
                          part)
            if part.has("wordbegin") and part.number_of("wordbegin") == behind and _adjoin(found[-1].text, word.text):
                found[-1] = found[-1]._replace(text=found[-1].text + word.text, end=word.end)
            else:
                found.append(word)
            behind = part.number_of("wordend") if part.has("wordend") else None
    return _from_words(path, found, how)


def read_elevenlabs(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads ElevenLabs' answers and messages: `normalized_alignment`, else `alignment`, with characters and their times
    in seconds (HTTP) or milliseconds (WebSocket)."""
    return _from_characters(path, _joined([
        _lists(found, _CHARACTERS, _STARTS, _ENDS, _DURATIONS) for item in read_entries(path)
        for found in _first(item, "normalizedalignment", "alignment")]), how)


def read_soniox(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Reads Soniox's messages of characters: the lists may stand in `timestamps`, `alignment` or the message itself."""
    found = []
    for item in read_entries(path):
        holders = list(_first(item, "timestamps", "alignment", "charactertimestamps"))
        found += [_lists(holder, _CHARACTERS, _STARTS, _ENDS, _DURATIONS) for holder in holders or [item]
                  if any(holder.has(name) for name in _CHARACTERS)]
    return _from_characters(path, _joined(found), how)


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


#: Reads a file; words are pronounced as the second argument says.
Reader = Callable[[PathLike, Pronunciation], List[SourceSegment]]

#: Title, reader and test of each service, in the order of detection.
SERVICES: Dict[str, Tuple[str, Reader, Callable[[Entry], bool]]] = {
    "elevenlabs": ("ElevenLabs", read_elevenlabs, _is_elevenlabs),
    "cartesia": ("Cartesia", read_cartesia, lambda first: first.has("wordtimestamps")
                 or first.has("phonemetimestamps") or first.has("type", "contextid")),
    "inworld": ("Inworld", read_inworld, _is_inworld),
    "hume": ("Hume", read_hume, lambda first: first.has("snippetid") or first.has("generations")),
    "fish": ("Fish Audio", read_fish, _is_fish),
    "minimax": ("MiniMax", read_minimax, lambda first: first.has("timestampedwords")),
    "kokoro-fastapi": ("Kokoro-FastAPI", read_kokoro_fastapi, _is_kokoro_fastapi),
    "soniox": ("Soniox", read_soniox, lambda first: first.has("streamid")),
    "google": ("Google", read_google, lambda first: first.has("timepoints") or first.has("markname", "timeseconds")),
    "words": ("other programs (word, start, end)", read_words, _is_words),
}


# ---- Parts of messages


def _word(item: Entry) -> _Timed:
    return _Timed(item.text_of("word", "text"), item.number_of("start", "starttime"), item.number_of("end", "endtime"),
                  item)


def _phone(item: Entry) -> _Timed:
    """One of Inworld's phones, without the digit of its stress."""
    start = item.number_of("starttimeseconds")
    return _Timed(re.sub(r"\d+$", "", item.text_of("phonesymbol")), start, start + item.number_of("durationseconds"),
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
           durations: Sequence[str] = ()) -> List[_Timed]:
    """Texts and their times from lists of equal length; names that end in "ms" are of milliseconds."""
    names = item.list_of(*texts)
    begins = _times(item, starts)
    if durations and any(item.has(name) for name in durations):
        finishes = [begin + length for begin, length in zip(begins, _times(item, durations))]
    else:
        finishes = _times(item, ends)
    if not len(names) == len(begins) == len(finishes) or not all(isinstance(name, str) for name in names):
        raise item.error(f"{texts[0]!r} and their times are not of one length")
    return [_Timed(name, begin, end, item) for name, begin, end in zip(names, begins, finishes)]


def _times(item: Entry, names: Sequence[str]) -> List[float]:
    """A list of times in seconds."""
    name = next((name for name in names if item.has(name)), names[0])
    scale = 1000.0 if name.endswith("ms") else 1.0
    return [item.as_number(value, name) / scale for value in item.list_of(name)]


def _later(word: _Timed, origin: float) -> _Timed:
    return word._replace(start=word.start + origin, end=None if word.end is None else word.end + origin)


def _joined(messages: Iterable[List[_Timed]]) -> List[_Timed]:
    """Messages one after the other: one that begins before the end of the one before it begins there."""
    found: List[_Timed] = []
    end = 0.0
    for message in messages:
        if message:
            origin = end if message[0].start < end - 1e-3 else 0.0
            found += [_later(word, origin) for word in message]
            end = max(end, *(word.end or word.start for word in found[-len(message) :]))
    return found


def _adjoin(before: str, after: str) -> bool:
    return bool(before and after) and before[-1].isalnum() and after[0].isalnum()


# ---- Segments


def _from_words(path: PathLike, words: Sequence[_Timed], how: Pronunciation) -> List[SourceSegment]:
    return _segments(path, [Word(word.text, _ms(word, word.start), None if word.end is None else _ms(word, word.end))
                            for word in words], words, how)


def _from_characters(path: PathLike, found: Sequence[_Timed], how: Pronunciation) -> List[SourceSegment]:
    starts = [_ms(item, item.start) for item in found]
    ends = [_ms(item, item.end or item.start) for item in found]
    return _segments(path, words_of_characters([item.text for item in found], starts, ends), found, how)


def _segments(path: PathLike, words: Sequence[Word], found: Sequence[_Timed],
              how: Pronunciation) -> List[SourceSegment]:
    if not found:
        raise DataError(path, None, "no words with their times")
    for before, word in zip(words, words[1:]):
        if word.start < before.start:
            raise DataError(path, None, f"{word.text!r:.40} begins before {before.text!r:.40}, which comes first")
    try:
        timings = timings_of(words, how)
    except StreamError as error:
        raise DataError(path, None, str(error)) from None
    segments, moment = [], 0
    for label, length in timings:
        segments.append(SourceSegment(moment / 1000, (moment + length) / 1000, "" if label == "SIL" else label,
                                      labels="arpabet"))
        moment += length
    return checked(path, segments)


def _from_phonemes(path: PathLike, found: Sequence[_Timed]) -> List[SourceSegment]:
    """Segments of phonemes in the IPA; short gaps belong to the phoneme before."""
    nexts = [item.start for item in found[1:]]
    segments = []
    for item, after in zip(found, [*nexts, -1.0]):
        end = item.start if item.end is None else item.end
        end = after if end < after <= end + _LONGEST_GAP else end
        label = item.text.strip()
        segments.append(SourceSegment(item.start, end, label, line=item.place.line, labels="ipa"))
    return checked(path, segments)


def _ms(item: _Timed, seconds: float) -> int:
    if not seconds * 1000 <= LATEST:
        raise item.place.error(f"{seconds:g} s is later than any time that is believed")
    return round(seconds * 1000)
