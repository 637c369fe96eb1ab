"""``labial align``: phonemes of a recording with their times, from its text or from the sound alone."""

from __future__ import annotations

import os
import re
import unicodedata
import warnings
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
from tqdm import tqdm

from labial.corpus.episode import Segment
from labial.corpus.timings import lab_of
from labial.corpus.words import PLAIN, phonemes_of
from labial.errors import DataError, LabialError, PathLike
from labial.sound.recogniser import (
    LONGEST_PAUSE_UNHEARD,
    LOW,
    Found,
    Recogniser,
    Stretch,
    comments,
    stretches,
    unspoken,
    unsure,
    with_silences,
)
from labial.sound.samples import RATE, prepared, read_sound, silences

#: Characters of a word; all others are punctuation.
_WORD = re.compile(r"[^\W_]+(?:['\u2019][^\W_]+)*['\u2019]?")
_LETTERS = re.compile(r"[a-z']+")
#: Letters of other alphabets' Latin, as English spells them.
_PLAIN = str.maketrans({"\u2019": "'", "æ": "ae", "œ": "oe", "ø": "o", "ß": "ss", "ð": "th", "þ": "th", "ł": "l"})
#: The end of a phrase, and its most words.
_MARK = re.compile(r"[.,;:!?\n]")
_LONGEST = 5

Lookup = Callable[[str], Optional[str]]


def phrases_of(text: str) -> List[List[str]]:
    """The words of a text in small letters, as the dictionary writes them, in phrases: what stands between punctuation
    marks or in a line, in even parts where it has more than `_LONGEST` words. Raises LabialError for what cannot be
    read aloud by rule, figures and other alphabets, and names it."""
    phrases: List[List[str]] = []
    strange: List[str] = []
    last = 0
    for match in _WORD.finditer(text):
        plain = unicodedata.normalize("NFKD", match.group().lower().translate(_PLAIN))
        word = "".join(c for c in plain if not unicodedata.combining(c))
        if not _LETTERS.fullmatch(word):
            strange.append(word)
        elif not phrases or _MARK.search(text, last, match.start()):
            phrases.append([word])
        else:
            phrases[-1].append(word)
        last = match.end()
    if strange:
        some = ", ".join(repr(word) for word in dict.fromkeys(strange[:8]))
        raise LabialError(f"the text must be English words, figures written out as they are spoken; not {some}")
    return [phrase[len(phrase) * part // parts : len(phrase) * (part + 1) // parts]
            for phrase in phrases for parts in [-(-len(phrase) // _LONGEST)] for part in range(parts)]


def pronunciations(words: Sequence[str], lookup: Lookup) -> Dict[str, str]:
    """Phonemes, separated by blanks, of the words that `lookup` does not know, as the library reads them."""
    missing = [word for word in dict.fromkeys(words) if lookup(word) is None]
    return {word: " ".join(phoneme for spoken in phonemes_of([word], PLAIN) for phoneme in spoken.phonemes) or "AH"
            for word in missing}


Progress = Callable[[float, float], None]
#: Most seconds that are searched at once, and the end of such a piece that is searched again with the next.
LONGEST_PIECE, OVERLAP = 30.0, 6.0
#: Words per second: an upper bound of speech.
_FASTEST = 7.0
#: Mean score of a frame below which phonemes are not those of the sound. Of speech by synthesisers that the text fits,
#: -9 .. -32 were measured, of texts of other sentences -56 .. -87.
MISFIT = -45.0
#: Least share of the audible sound that words cover, if the sound is only speech with its noises.
LEAST_SPOKEN = 1 / 3


@dataclass(frozen=True)
class Piece:
    """The result for a piece of the sound; times are those of the whole sound."""

    segments: List[Segment]
    start: float
    end: float
    score: float  #: of the mean frame, see :class:`Recogniser`; 0 for a silent one
    stretches: List[Stretch]

    @property
    def doubtful(self) -> bool:
        """Whether a part is likely to be wrong."""
        return self.score < MISFIT or any(item.confidence < LOW for item in self.stretches)

    @property
    def confidence(self) -> float:
        """The mean of the stretches'."""
        length = sum(item.end - item.start for item in self.stretches)
        return sum(item.confidence * (item.end - item.start) for item in self.stretches) / max(length, 1e-9)


@dataclass(frozen=True)
class Alignment:
    """The phonemes of a sound, and their confidence."""

    segments: Tuple[Segment, ...]  #: ARPABET and SIL, without gaps from time 0 to the sound's end
    stretches: Tuple[Stretch, ...]  #: the stretches of speech, each with its confidence

    def lab(self) -> str:
        """The segments as a .lab, followed by comments with the confidence of each stretch."""
        return lab_of(self.segments) + comments(self.stretches)


def aligned(path: PathLike, text: Optional[str] = None, progress: Optional[Progress] = None) -> Alignment:
    """English phonemes of a sound file. `text` is its text; without it the most probable words are searched. `progress`
    receives the processed seconds. Warns of words with guessed pronunciations, of a text that does not fit the sound or
    continues beyond its end, and of stretches of low confidence. Raises DataError for a sound that cannot be read or a
    text that cannot be found in it, LabialError for a text without words or in another language."""
    samples = read_sound(path)
    recogniser = Recogniser()
    sound = Sound(samples, prepared(samples), silences(samples))
    if text is None:
        pieces = _found(sound, recogniser, progress)
    else:
        phrases = phrases_of(text)
        if not phrases:
            raise LabialError("the text has no words")
        _learn(recogniser, [word for phrase in phrases for word in phrase])
        pieces = _followed(path, sound, phrases, recogniser, progress)
    _judge(path, sound, pieces, text is not None)
    segments = [segment for piece in pieces for segment in piece.segments]
    return Alignment(tuple(_joined(segments)), tuple(stretch for piece in pieces for stretch in piece.stretches))


@dataclass(frozen=True)
class Sound:
    """A sound, its version for the recogniser, and its silences."""

    samples: np.ndarray  #: (N,) float32 at `RATE`
    prepared: np.ndarray  #: (N,) int16 at `RATE`
    silences: Sequence[Tuple[float, float]]  #: seconds

    @property
    def length(self) -> float:
        """Seconds."""
        return len(self.samples) / RATE

    def part(self, start: float, end: float) -> np.ndarray:
        """The recogniser's samples of a piece."""
        return self.prepared[round(start * RATE) : round(end * RATE)]

    def silent(self, start: float, end: float) -> bool:
        """Whether all of a piece is silence."""
        return any(a <= start and b >= end for a, b in self.silences)

    def cut(self, start: float, longest: float) -> float:
        """The end of a piece from `start`: the sound's if near; else in its latter half's last silence, or quietest
        moment."""
        if self.length - start <= longest:
            return self.length
        middles = [(a + b) / 2 for a, b in self.silences if start + longest / 2 < (a + b) / 2 <= start + longest]
        if middles:
            return middles[-1]
        hop = RATE // 20
        begin = round((start + longest / 2) * RATE)
        frames = self.samples[begin : begin + round(longest / 2 * RATE) // hop * hop].reshape(-1, hop)
        return (begin + (int(np.argmin(np.square(frames).sum(axis=1))) + 0.5) * hop) / RATE

    def piece(self, start: float, end: float, found: Optional[Found]) -> Piece:
        """Phonemes from `start` brought to the silences and to the time of the whole sound; silence without any."""
        if found is None:
            return Piece([Segment(start, end, "SIL")], start, end, 0.0, [])
        within = [(max(a, start) - start, min(b, end) - start) for a, b in self.silences if a < end and b > start]
        unheard = [(s.start, s.end) for s in found.segments if s.label == "SIL" and s.duration > LONGEST_PAUSE_UNHEARD]
        segments = with_silences(found.segments, _united([*within, *unheard]), end - start)
        spoken = [*stretches(found.heard, start), *unspoken(segments, within, start)]
        return Piece([Segment(start + s.start, start + s.end, s.label) for s in segments], start, end, found.score,
                     sorted(spoken, key=lambda item: item.start))


def _learn(recogniser: Recogniser, words: List[str]) -> None:
    new = pronunciations(words, recogniser.lookup)
    if new:
        recogniser.learn(new)
        guessed = list(new)
        more = f" and {len(guessed) - 8} more" if len(guessed) > 8 else ""
        warnings.warn(f"not in the dictionary, pronounced as they are spelt: {', '.join(guessed[:8])}{more}",
                      stacklevel=3)


def _found(sound: Sound, recogniser: Recogniser, progress: Optional[Progress]) -> List[Piece]:
    """Pieces from silence to silence, each with its most probable words."""
    pieces: List[Piece] = []
    start = 0.0
    while start < sound.length:
        end = sound.cut(start, LONGEST_PIECE)
        found = None if sound.silent(start, end) else recogniser.find(sound.part(start, end))
        pieces.append(sound.piece(start, end, found))
        start = end
        if progress:
            progress(start, sound.length)
    return pieces


def _followed(path: PathLike, sound: Sound, phrases: Sequence[Sequence[str]], recogniser: Recogniser,
              progress: Optional[Progress]) -> List[Piece]:
    """Pieces that follow the text: each is searched with a part of the next one, since the sound after a word helps to
    place it. A piece that does not fit is searched again, for phrases of the text and phonemes between them."""
    words = [word for phrase in phrases for word in phrase]
    pieces: List[Piece] = []
    start, at = 0.0, 0
    while start < sound.length:
        end, count = sound.length, len(words) - at
        if sound.length - start > LONGEST_PIECE + OVERLAP:
            end, count = _next_piece(sound, start, words[at:], recogniser)
        part = sound.part(start, end)
        found = recogniser.phonemes(part, words[at : at + count]) if count else None
        if count and found is None and end == sound.length:
            count, found = _heard_of(part, words[at:], recogniser)
        piece = sound.piece(start, end, found)
        if (found is None and not sound.silent(start, end)) or piece.doubtful:
            loose = recogniser.loosely(part, _between(phrases, at, at + int(_FASTEST * (end - start)) + 1))
            other = sound.piece(start, end, loose[0]) if loose is not None else piece
            if loose is not None and (found is None or other.confidence > piece.confidence):
                piece, count, found = other, loose[1], loose[0]
            if found is None and count:
                raise DataError(path, None, f"the text does not fit the sound from {start:.1f} s on: "
                                f"'{' '.join(words[at : at + 6])} ...' is not found there")
        pieces.append(piece)
        start, at = end, at + count
        if progress:
            progress(start, sound.length)
    if at < len(words):
        warnings.warn(f"{os.fspath(path)}: the text goes on behind the sound: '{' '.join(words[at : at + 6])} ...' is "
                      "left out", stacklevel=3)
    return pieces


def _between(phrases: Sequence[Sequence[str]], begin: int, end: int) -> List[Sequence[str]]:
    """The phrases, or parts of them, of the words from `begin` to before `end`."""
    result: List[Sequence[str]] = []
    at = 0
    for phrase in phrases:
        result.append(phrase[max(begin - at, 0) : max(end - at, 0)])
        at += len(phrase)
    return [phrase for phrase in result if phrase]


def _heard_of(samples: np.ndarray, words: Sequence[str], recogniser: Recogniser) -> Tuple[int, Optional[Found]]:
    """How many of the first `words` the last piece of a sound has, and their phonemes; all and None if none fit."""
    count = sum(not word.startswith(("<", "[")) for word, _, _ in recogniser.follow_part(samples, words))
    found = recogniser.phonemes(samples, words[:count]) if count else None
    return (count, found) if found is not None else (len(words), None)


def _next_piece(sound: Sound, start: float, words: Sequence[str], recogniser: Recogniser) -> Tuple[float, int]:
    """Where the next piece ends, and how many of `words` are in it."""
    end = sound.cut(start, LONGEST_PIECE)
    rows = recogniser.follow_part(sound.part(start, end), words[: int(_FASTEST * (end - start)) + 1])
    count, best, pause = 0, (end, 0), 0.0
    for word, begin, stop in rows:
        if word.startswith(("<", "[")):
            if stop - begin >= pause and begin > LONGEST_PIECE / 4 and stop < end - start - OVERLAP:
                best, pause = (start + (begin + stop) / 2, count), 0.1
        else:
            count += 1
            if not pause and stop < end - start - OVERLAP:
                best = (start + stop, count)
    return best


def _judge(path: PathLike, sound: Sound, pieces: Sequence[Piece], has_text: bool) -> None:
    """Warns where phonemes do not match the sound, or are few for the audible sound."""
    name = os.fspath(path)
    spoken = sum(segment.duration for piece in pieces for segment in piece.segments if segment.label != "SIL")
    heard = sound.length - sum(end - begin for begin, end in sound.silences)
    if not spoken:
        warnings.warn(f"{name}: no speech is found in the sound", stacklevel=3)
        return
    what = "the text does not fit the sound" if has_text else "the sound is hardly clear English speech"
    worst = min(pieces, key=lambda piece: piece.score)
    if worst.score < MISFIT:
        where = "" if len(pieces) == 1 else f" from {worst.start:.1f} to {worst.end:.1f} s"
        warnings.warn(f"{name}: {what}{where}; the mouth may not match what is heard", stacklevel=3)
    elif spoken < LEAST_SPOKEN * heard:
        warnings.warn(f"{name}: {what}: words are in {spoken:.1f} of {heard:.1f} s that are not silent", stacklevel=3)
    where = unsure([stretch for piece in pieces for stretch in piece.stretches])
    if where:
        warnings.warn(f"{name}: low confidence from {where}: the text or the sound there may be another", stacklevel=3)


def _united(spans: Sequence[Tuple[float, float]]) -> List[Tuple[float, float]]:
    """Spans in order, those that overlap as one."""
    result: List[Tuple[float, float]] = []
    for start, end in sorted(spans):
        if result and start <= result[-1][1]:
            result[-1] = (result[-1][0], max(end, result[-1][1]))
        else:
            result.append((start, end))
    return result


def _joined(segments: Sequence[Segment]) -> List[Segment]:
    """Segments with neighbouring silences as one."""
    result: List[Segment] = []
    for segment in segments:
        if result and segment.label == result[-1].label == "SIL":
            result[-1] = Segment(result[-1].start, segment.end, "SIL")
        else:
            result.append(segment)
    return result


def align_with_bar(sound: str, text: Optional[str], progress: bool) -> Alignment:
    """Like :func:`aligned`; `progress` shows a bar on standard error."""
    with tqdm(unit=" s", disable=not progress, bar_format="{desc}{n:.0f} of {total:.0f} s {bar} {remaining}") as bar:
        def told(done: float, length: float) -> None:
            bar.total = length
            bar.update(done - bar.n)

        return aligned(sound, text, told)
