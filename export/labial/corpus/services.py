"""Phoneme timings as JSON, as speech services and neural synthesisers report them.

Each reader returns segments in seconds, as those of :mod:`labial.corpus.timings` do, and checks them the same way. A
file is one JSON document, or one per line. Errors are DataErrors with the line where each line is a document of its
own, else with the number of the entry.

Characters, as from Piper and Kokoro, become phonemes: a stress mark's time goes to the vowel after it, that of a length
mark or diacritic to the phoneme before it, the two halves of a diphthong or affricate are one phoneme, and punctuation
is silence. The blank between two words takes time, too, but lips do not rest there: up to `LONGEST_BLANK`, its time is
added to the phoneme before it. What services tell of words and of written characters is read by
:mod:`labial.corpus.word_files`.
"""

from __future__ import annotations

import math
import unicodedata
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

from labial.corpus import word_files, word_services
from labial.corpus.entries import Entry, entry_of, read_entries, shown
from labial.corpus.timings import PathLike, SourceSegment, checked
from labial.corpus.visemes import AZURE, AZURE_PAIRS, POLLY, stand_ins
from labial.corpus.words import PLAIN, Pronunciation
from labial.errors import DataError

#: A blank between words, or a gap between a service's phonemes, is a pause if it is longer, in seconds.
LONGEST_BLANK = 0.15
#: Duration of the last viseme, seconds: services report only its beginning.
LAST_VISEME = 0.1
#: Kokoro's frames per second: 600 samples each, 24,000 samples per second.
KOKORO_RATE = 40.0
#: Azure's ticks per second, of 100 ns.
AZURE_RATE = 1e7

_STRESS = ("ˈ", "ˌ")
#: Two characters that are one phoneme.
_PAIRS = ("aɪ", "aʊ", "ɔɪ", "eɪ", "oʊ", "əʊ", "tʃ", "dʒ", "ɜɹ")
#: Kokoro's letters (its grapheme-to-phoneme step Misaki's) that are not the IPA's.
_MISAKI = {"A": "eɪ", "I": "aɪ", "O": "oʊ", "Q": "əʊ", "W": "aʊ", "Y": "ɔɪ", "T": "ɾ", "ᵊ": "ə"}


def read_plain(path: PathLike) -> List[SourceSegment]:
    """Reads a list of objects with `phoneme`, `start` and `end`, in seconds."""
    return checked(path, [
        SourceSegment(item.number_of("start"), item.number_of("end"), item.text_of("phoneme"), line=item.line)
        for item in read_entries(path)])


def read_piper(path: PathLike) -> List[SourceSegment]:
    """Reads Piper's alignments: audio chunks with `sample_rate` and `phoneme_alignments` (`phoneme`, `num_samples`), or
    what its HTTP server's ``/info`` answers (`alignments` of `phoneme` and `seconds`)."""
    tokens: List[SourceSegment] = []
    moment = 0.0
    for item in _piper_phonemes(read_entries(path)):
        label, end = item.text_of("phoneme"), moment + item.number_of("seconds")
        tokens.append(SourceSegment(moment, end, label, line=item.line))
        moment = end
    return checked(path, phonemes_of(tokens))


def read_kokoro(path: PathLike) -> List[SourceSegment]:
    """Reads results of Kokoro's pipeline: `phonemes`, a string, and `pred_dur`, the frames of the silence before it, of
    each of its characters and of the silence behind it; 40 frames per second."""
    tokens: List[SourceSegment] = []
    frames = 0.0
    for item in read_entries(path):
        characters = ["", *item.text_of("phonemes"), ""]
        durations = [item.as_number(value, "pred_dur") for value in item.list_of("preddur")]
        if len(durations) != len(characters):
            raise item.error(f"{len(durations)} durations for {len(characters) - 2} characters and the silence around "
                             "them: Kokoro left out characters that it does not know")
        for character, duration in zip(characters, durations):
            start, frames = frames, frames + duration
            label = _MISAKI.get(character, character)
            tokens.append(SourceSegment(start / KOKORO_RATE, frames / KOKORO_RATE, label, line=item.line))
    return checked(path, phonemes_of(tokens))


def read_headtts(path: PathLike) -> List[SourceSegment]:
    """Reads HeadTTS's answers: `phonemes` with `vtimes` and `vdurations`, milliseconds; each answer begins where the
    one before ends, as when their sounds are joined.

    The times overlap and leave out blanks and h; so a phoneme lasts until the next one, or to its own end where that
    is a pause.
    """
    segments: List[SourceSegment] = []
    origin = 0.0
    for item in read_entries(path):
        if not item.has("vtimes") and isinstance(item.fields.get("data"), dict):
            item = entry_of(path, item.line, item.number, item.fields["data"])  # as the client library returns it
        labels = item.list_of("phonemes")
        starts = [item.as_number(value, "vtimes") / 1000 for value in item.list_of("vtimes")]
        lengths = [item.as_number(value, "vdurations") / 1000 for value in item.list_of("vdurations")]
        if not len(labels) == len(starts) == len(lengths) or not all(isinstance(label, str) for label in labels):
            raise item.error("'phonemes', 'vtimes' and 'vdurations' are not of one length")
        nexts = [*starts[1:], math.inf]
        for label, start, length, after in zip(labels, starts, lengths, nexts):
            end = start + length
            end = after if end > after or after - end <= LONGEST_BLANK else end
            segments.append(SourceSegment(origin + start, origin + end, _MISAKI.get(label, label), line=item.line))
        origin = segments[-1].end if segments else origin
    return checked(path, phonemes_of(segments))


def read_azure(path: PathLike) -> List[SourceSegment]:
    """Reads Azure's viseme events: `viseme_id` (0 .. 21) and `audio_offset`, ticks of 100 ns, under the names of any of
    its libraries."""
    marks = []
    for item in read_entries(path):
        name = shown(item.get("visemeid", "privvisemeid"))
        marks.append((item.number_of("audiooffset", "privaudiooffset") / AZURE_RATE, name, item.line))
    return _from_visemes(path, marks, AZURE, AZURE_PAIRS)


def read_polly(path: PathLike) -> List[SourceSegment]:
    """Reads Amazon Polly's speech marks, one object per line: those of type "viseme", `time` in milliseconds."""
    marks = [(item.number_of("time") / 1000, item.text_of("value"), item.line)
             for item in read_entries(path) if item.get("type") == "viseme"]
    if not marks:
        raise DataError(path, None, "no speech marks of type 'viseme'")
    return _from_visemes(path, marks, POLLY, {})


def read_azure_events(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Azure's visemes, or its word boundaries (and Edge's) where the file has no others."""
    has_visemes = any(not word_services.is_boundary(item) for item in read_entries(path))
    return read_azure(path) if has_visemes else word_files.read(path, word_services.tell_boundary, how)


def read_polly_marks(path: PathLike, how: Pronunciation = PLAIN) -> List[SourceSegment]:
    """Amazon Polly's visemes, or its words where there are none."""
    kinds = [item.get("type") for item in read_entries(path)]
    if "viseme" in kinds:
        return read_polly(path)
    if "word" not in kinds:
        raise DataError(path, None, "no speech marks of type 'viseme' or 'word'")
    return word_files.read(path, word_services.tell_word_mark, how)


class Service(NamedTuple):
    """A shape of JSON."""

    title: str  #: the service's name, for messages
    read: Callable[..., List[SourceSegment]]  #: takes a path and, if it may tell words, a Pronunciation
    told: Callable[[Entry], bool]  #: whether the first object of a file is one of it
    words: bool = False  #: whether it may tell words or characters


def _is_piper(first: Entry) -> bool:
    known = (("phonemealignments",), ("alignments",), ("last",), ("phoneme", "numsamples"), ("phoneme", "seconds"))
    return any(first.has(*names) for names in known) and not _is_plain(first)


def _is_headtts(first: Entry) -> bool:
    data = first.fields.get("data")
    return first.has("vtimes") or (isinstance(data, dict) and "vtimes" in data)


def _is_plain(first: Entry) -> bool:
    return first.has("phoneme", "start", "end")


#: Every shape by its name for --from, in the order of detection.
SERVICES: Dict[str, Service] = {
    "kokoro": Service("Kokoro", read_kokoro, lambda first: first.has("preddur")),
    "headtts": Service("HeadTTS", read_headtts, _is_headtts),
    "azure": Service("Azure", read_azure_events, lambda first: first.has("visemeid") or first.has("privvisemeid")
                     or word_services.is_boundary(first), True),
    "polly": Service("Polly", read_polly_marks, lambda first: first.has("type", "time", "value"), True),
    **{name: Service(service.title, word_files.reader(name), service.told, True)
       for name, service in word_services.SERVICES.items()},
    "piper": Service("Piper", read_piper, _is_piper),
    "json": Service("other programs (phoneme, start, end)", read_plain, _is_plain),
}


def service_of(path: PathLike) -> Optional[str]:
    """The service in `SERVICES` that wrote a JSON file, by the fields of its first object; None for others."""
    entries = read_entries(path)
    return next((name for name, service in SERVICES.items() if entries and service.told(entries[0])), None)


def phonemes_of(tokens: Sequence[SourceSegment]) -> List[SourceSegment]:
    """Phonemes, in the IPA, of successive characters (see above); "" is silence, and so is every gap."""
    result: List[SourceSegment] = []
    begin: Optional[float] = None  # of the stress mark before the next phoneme
    joins = False  # the next character may be the second half of the phoneme before it
    for token in tokens:
        label = token.label
        last = result[-1] if result and result[-1].label else None
        if label in _STRESS:
            begin = token.start if begin is None else begin
        elif last and begin is None and _is_mark(label):
            result[-1] = _grown(last, token, last.label + label)
        elif last and begin is None and joins and last.label + label in _PAIRS and token.start <= last.end:
            result[-1] = _grown(last, token, last.label + label)
        elif last and label.isspace() and token.duration <= LONGEST_BLANK:
            result[-1] = _grown(last, token, last.label)
            joins = False
        elif _is_silence(label):
            if result and not last:
                result[-1] = _grown(result[-1], token, "")
            else:
                result.append(SourceSegment(token.start, token.end, "", line=token.line))
            begin = None
        else:
            start = token.start if begin is None else begin
            result.append(SourceSegment(start, token.end, label, line=token.line, labels="ipa"))
            begin, joins = None, True
    return result


def _grown(segment: SourceSegment, token: SourceSegment, label: str) -> SourceSegment:
    return SourceSegment(segment.start, token.end, label, line=segment.line, labels=segment.labels)


def _is_mark(label: str) -> bool:
    """Whether `label` only modifies the phoneme before it: length, release, nasality, tone."""
    return bool(label) and all(unicodedata.category(c) in ("Lm", "Mn", "Sk", "Nd") for c in label)


def _is_silence(label: str) -> bool:
    return all(unicodedata.category(c)[0] in "PSZC" for c in label)


def _piper_phonemes(entries: Sequence[Entry]) -> List[Entry]:
    """Objects of `phoneme` and `seconds` from any of Piper's shapes."""
    result: List[Entry] = []
    for item in entries:
        if item.has("last"):
            last = item.get("last")
            if not isinstance(last, dict):
                raise item.error("the server has not spoken yet: ask for /info after /synthesize")
            item = entry_of(item.path, item.line, item.number, last)
        if item.has("phonemealignments"):
            if item.get("phonemealignments") is None:
                raise item.error("Piper told no alignments: ask for them by include_alignments=True, of a voice that "
                                 "has them; python3 -m piper.patch_voice_with_alignment VOICE.onnx adds them to one")
            rate = item.number_of("samplerate")
            if rate < 1:
                raise item.error(f"'sample_rate' is {rate:g}")
            result += [entry_of(part.path, part.line, part.number, {
                "phoneme": part.get("phoneme"), "seconds": part.number_of("numsamples") / rate,
            }) for part in item.parts("phonemealignments")]
        elif item.has("alignments"):
            result += item.parts("alignments")
        elif item.has("phoneme", "numsamples"):
            raise item.error("samples without a rate: keep the chunk's sample_rate beside its phoneme_alignments")
        else:
            result.append(item)
    return result


def _from_visemes(
    path: PathLike, marks: Sequence[Tuple[float, str, Optional[int]]], table: Dict[str, str],
    pairs: Dict[Tuple[str, str], str],
) -> List[SourceSegment]:
    """Segments of visemes with only their beginnings."""
    for number, (_, name, line) in enumerate(marks, 1):
        if name not in table:
            raise DataError(path, line, f"{'' if line else f'entry {number}: '}no viseme is called {name!r}")
    ends = [start for start, _, _ in marks[1:]] + [marks[-1][0] + LAST_VISEME] if marks else []
    segments: List[SourceSegment] = []
    for (first, last), phoneme in stand_ins([name for _, name, _ in marks], table, pairs):
        segments.append(SourceSegment(marks[first][0], ends[last], phoneme, line=marks[first][2], labels="arpabet"))
    return checked(path, segments)
