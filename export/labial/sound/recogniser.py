"""PocketSphinx with its English models: phonemes of a piece of sound, with or without its words.

The confidence of a stretch of an alignment is the expected share of it with the right phonemes. The recogniser gives
each phoneme a score, the mean of its frames: 0 for a sound that the models expect for that phoneme, far below for
another sound. The confidence is a logistic function of the mean score of a stretch and of the share of its time that
lies in phonemes longer than people speak. Its numbers were fitted to 27 recordings of LibriSpeech, LibriTTS, VCTK and
ARCTIC whose text was cut or another recording's, or whose sound was faster or under noise or music; the alignment of
the same unchanged recording served as the truth. There the confidence and the share that was right correlate by .82; 84
% of the stretches that were mostly wrong are below `LOW`, 7 % of the others.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from pocketsphinx import Decoder, get_model_path

from labial.corpus.episode import Segment
from labial.corpus.phonesets import ARPABET, VOWELS
from labial.sound.samples import RATE

#: Frames per second, and how far a frame's middle lies behind its number: its window is longer than its step.
FRAME_RATE = 100
_OFFSET = (0.025625 - 1 / FRAME_RATE) / 2
#: Beam width that follows even a text that fits badly.
_BEAM = 1e-200
_WIDE = {"beam": _BEAM, "wbeam": _BEAM, "pbeam": _BEAM, "bestpath": False}
#: Beam width that suffices for the second pass.
_NARROW = {"beam": 1e-64, "wbeam": 1e-48, "pbeam": 1e-64, "bestpath": False}
#: Of the search without words, as PocketSphinx's documentation recommends them.
_PHONE_LOOP = {"lw": 2.0, "beam": 1e-20, "pbeam": 1e-20}
#: Words of one phoneme, which stand for what the text lacks, are called by this and the phoneme.
_PHONE = "_"
#: Probabilities of such a word between two phrases, and of a phrase left out; the decoder weighs them by 6.5.
_BETWEEN, _LEFT_OUT = 1e-5, 1e-6
#: A second pass on 30 ms of sound at least: a phoneme has three states.
_SHORTEST = int(0.1 * RATE)


class Found(NamedTuple):
    """Phonemes in seconds of a piece of sound."""

    segments: List[Segment]
    score: float  #: of the mean frame
    heard: List[Heard]  #: the same, each with its score


class Recogniser:
    """Four decoders, each made on first use: for words, for phrases with any phonemes between them, to find words, and
    to find phonemes alone."""

    def __init__(self) -> None:
        self._loose: Optional[Decoder] = None
        self._learnt: Dict[str, str] = {}

    @cached_property
    def follower(self) -> Decoder:
        """The decoder that follows words; its dictionary can be extended."""
        return Decoder(lm=None, loglevel="FATAL", **_WIDE)

    @cached_property
    def _finder(self) -> Decoder:
        return Decoder(loglevel="FATAL", fwdflat=False, maxhmmpf=5000)

    @cached_property
    def _loop(self) -> Decoder:
        model = get_model_path("en-us/en-us-phone.lm.bin")
        return Decoder(allphone=model, lm=None, dict=None, loglevel="FATAL", **_PHONE_LOOP)

    def lookup(self, word: str) -> Optional[str]:
        """The dictionary's phonemes of a word, or None."""
        found = self.follower.lookup_word(word)
        return str(found) if found else None

    def learn(self, pronunciations: Dict[str, str]) -> None:
        """Adds words to the dictionary."""
        self._learnt.update(pronunciations)
        for decoder in (self.follower, self._loose):
            if decoder is not None:
                _learn(decoder, pronunciations)

    def follow(self, samples: np.ndarray, words: Sequence[str]) -> Optional[List[Tuple[str, float, float]]]:
        """`words` and the silences between them with begin and end in seconds; None where they do not fit at all.
        `samples` is (N,) int16 at `RATE`. All of the words are in it."""
        if len(samples) < _SHORTEST or not words:
            return None
        self.follower.set_align_text(" ".join(words))
        return _words(self.follower, samples)

    def follow_part(self, samples: np.ndarray, words: Sequence[str]) -> List[Tuple[str, float, float]]:
        """Like :meth:`follow`, but `words` may continue after the end of `samples`; [] if they do not fit at all."""
        states = len(words)
        steps = [(state, state + 1, 1.0, word) for state, word in enumerate(words)]
        ways_out = [(state, states + 1, 1.0) for state in range(states + 1)]
        self.follower.add_fsg("part", self.follower.create_fsg("part", 0, states + 1, [*steps, *ways_out]))
        self.follower.activate_search("part")
        return _words(self.follower, samples)

    def loosely(self, samples: np.ndarray, phrases: Sequence[Sequence[str]]) -> Optional[Tuple[Found, int]]:
        """Phonemes where any of `phrases`, which may be none, may be missing and anything may be said between them, and
        how many words of them are behind when the sound ends; None where no phoneme is found."""
        if len(samples) < _SHORTEST:
            return None
        if self._loose is None:
            self._loose = Decoder(lm=None, loglevel="FATAL", **_NARROW)
            phones = {_PHONE + phone: phone for phone in ARPABET}
            _learn(self._loose, {**self._learnt, **phones})
            _learn(self.follower, phones)
        words = [word for phrase in phrases for word in phrase]
        bounds = [0, *itertools.accumulate(map(len, phrases))]
        end = len(words) + 1
        steps = [(state, state + 1, 1.0, word) for state, word in enumerate(words)]
        steps += [(bound, bound, _BETWEEN, _PHONE + phone) for bound in bounds for phone in ARPABET]
        left_out = [(bound, after, _LEFT_OUT) for bound, after in zip(bounds, bounds[1:])]
        ways_out = [(state, end, 1.0) for state in range(end)]
        self._loose.add_fsg("loose", self._loose.create_fsg("loose", 0, end, [*steps, *left_out, *ways_out]))
        self._loose.activate_search("loose")
        told = [word.split("(")[0] for word, _, _ in _words(self._loose, samples)
                if word[0] not in "<[("]  # neither silence nor a step without a word
        found = self.phonemes(samples, told)
        return None if found is None else (found, _behind(phrases, told))

    def phonemes(self, samples: np.ndarray, words: Sequence[str]) -> Optional[Found]:
        """Phonemes of `words` in seconds of `samples`, as of :func:`_phonemes`; None as above."""
        return _phonemes(self.follower, samples) if self.follow(samples, words) else None

    def find(self, samples: np.ndarray) -> Optional[Found]:
        """Phonemes of the most probable words of `samples`; None without any."""
        if len(samples) < _SHORTEST:
            return None
        self._finder.activate_search()
        return _phonemes(self._finder, samples) if _words(self._finder, samples) else None

    def loop(self, samples: np.ndarray) -> List[Segment]:
        """The most probable phonemes of `samples`, whatever the words, in seconds; noises are silence."""
        if len(samples) < _SHORTEST:
            return []
        return [Segment(start + (_OFFSET if start else 0.0), end + _OFFSET, phone if phone.isalpha() else "SIL")
                for phone, start, end in _words(self._loop, samples)]


def _behind(phrases: Sequence[Sequence[str]], told: Sequence[str]) -> int:
    """How many words of `phrases` are behind when `told`, words of some of them in order, end."""
    told = [word for word in told if not word.startswith(_PHONE)]
    at = count = behind = 0
    for phrase in phrases:
        count += len(phrase)
        rest = told[at : at + len(phrase)]
        if rest and list(phrase[: len(rest)]) == rest:
            at += len(rest)
            behind = count - len(phrase) + len(rest)
    return behind


def _learn(decoder: Decoder, pronunciations: Dict[str, str]) -> None:
    for number, (word, phonemes) in enumerate(pronunciations.items(), 1):
        decoder.add_word(word, phonemes, number == len(pronunciations))


def _decode(decoder: Decoder, samples: np.ndarray) -> None:
    decoder.start_utt()
    decoder.process_raw(samples.tobytes(), full_utt=True)
    decoder.end_utt()


def _words(decoder: Decoder, samples: np.ndarray) -> List[Tuple[str, float, float]]:
    _decode(decoder, samples)
    if decoder.hyp() is None:
        return []
    return [(segment.word, segment.start_frame / FRAME_RATE, (segment.end_frame + 1) / FRAME_RATE)
            for segment in decoder.seg()]


def _phonemes(decoder: Decoder, samples: np.ndarray) -> Optional[Found]:
    """The second pass, behind :func:`_words`: phonemes, each with the mean score of its frames, and that of all of
    them, which is 0 where each frame is what the models expect and falls where they do not know the sound."""
    try:
        decoder.set_alignment()
        _decode(decoder, samples)  # no hyp() from here on: it crashes in this search
        found = [(word.name, phone) for word in decoder.get_alignment() for phone in word]
    except RuntimeError:
        return None
    segments, heard = [], []
    for word, phone in found:
        start = phone.start / FRAME_RATE + (_OFFSET if phone.start else 0.0)
        label = phone.name if phone.name.isalpha() else "SIL"
        segments.append(Segment(start, (phone.start + phone.duration) / FRAME_RATE + _OFFSET, label))
        score = UNTOLD if word.startswith(_PHONE) else phone.score / max(phone.duration, 1)
        heard.append(Heard(start, segments[-1].end, label, score))
    sounding = [item for item in heard if item.label != "SIL"]
    if not sounding:
        return None
    length = np.array([item.end - item.start for item in sounding])
    return Found(segments, float(np.average([item.score for item in sounding], weights=length)), heard)


# ---- Silent stretches of a sound contain no phoneme, except for stops ------------------------------------------------

#: Longest closure of a stop before it is heard, seconds; a longer silence is a pause. The same as for espeak-ng's stops
#: (tools/speak/closure.c).
LONGEST_CLOSURE = 0.1
#: A recogniser's pause in sound that is not silent counts if it is longer, in seconds.
LONGEST_PAUSE_UNHEARD = 0.15
#: Shorter gaps between phonemes are closed, in seconds.
_SHORTEST_PAUSE = 0.05

_STOPS = ("P", "B", "T", "D", "K", "G", "CH", "JH")


def with_silences(segments: Sequence[Segment], silences: Sequence[Tuple[float, float]],
                  length: float) -> List[Segment]:
    """`segments` of ARPABET phonemes brought to the sound's own silences (begin and end, seconds): they end where a
    silence begins and begin where it ends, a stop `LONGEST_CLOSURE` before. `length` is the sound's, in seconds.
    Silence in the segments remains only where the sound is silent. The result has no gaps."""
    sounding = [segment for segment in segments if segment.label != "SIL"]
    times = [[segment.start, segment.end] for segment in sounding]
    for begin, end in silences:
        middle = (begin + end) / 2
        after = next((i for i, (a, b) in enumerate(times) if (a + b) / 2 >= middle), len(times))
        if after < len(times):
            stop = sounding[after].label in _STOPS
            onset = max(begin, end - LONGEST_CLOSURE) if stop else end
            heard = times[after][0] < end + _SHORTEST_PAUSE  # the silence is right before it
            if times[after][0] < onset or (stop and heard):
                times[after][0] = onset
        for time in times[:after]:
            time[0], time[1] = min(time[0], begin), min(time[1], begin)
        for time in times[after:]:
            time[0], time[1] = max(time[0], times[after][0]), max(time[1], times[after][0])
    # Without gaps: a gap is silence where the sound is silent for long enough; else the stop behind it begins there, or
    # the phoneme before it goes on.
    result: List[Segment] = []
    moment = 0.0
    for segment, (start, end) in zip(sounding, times):
        if end <= start:
            continue
        if start > moment:
            silent = any(a < start and b > moment for a, b in silences)
            if not result or (silent and start - moment >= _SHORTEST_PAUSE):
                result.append(Segment(moment, start, "SIL"))
            elif segment.label in _STOPS:
                start = moment
            else:
                result[-1] = Segment(result[-1].start, start, result[-1].label, word=result[-1].word)
        start = max(start, moment)
        if end > start:
            result.append(Segment(start, end, segment.label, word=segment.word))
            moment = end
    if length > moment:
        result.append(Segment(moment, length, "SIL"))
    return result


#: Below this a stretch is named in a warning.
LOW = 0.6
#: A stretch ends at a pause that is longer, or when it is longer itself; seconds.
_PAUSE, _LONGEST = 0.15, 3.0
#: Shorter sounds without a phoneme, such as a breath, are not missing text; seconds.
_UNSPOKEN = 0.6
#: The logistic function: constant, factor of the mean score, factor of the share of time in long phonemes.
_CONSTANT, _SCORE, _LONG = 3.64, 0.0587, -2.59
#: Lower scores carry no more information.
_LEAST = -90.0
#: The score of a phoneme that is not from a text.
UNTOLD = -70.0
#: Durations in seconds that vowels and consonants hardly ever exceed.
_LONG_VOWEL, _LONG_CONSONANT = 0.35, 0.25

_VOWELS = frozenset(VOWELS.split())


@dataclass(frozen=True)
class Heard:
    """A phoneme found by the recogniser; times in seconds."""

    start: float
    end: float
    label: str  #: SIL for silence and noises
    score: float  #: of the mean frame


@dataclass(frozen=True)
class Stretch:
    """A part of a sound, in seconds, and the confidence that its phonemes are right, 0 .. 1."""

    start: float
    end: float
    confidence: float


def stretches(heard: Sequence[Heard], start: float) -> List[Stretch]:
    """The speech between pauses, at most three seconds of it, in phonemes whose times count from `start`."""
    parts: List[List[Heard]] = []
    open_part = False
    for item in heard:
        if item.label == "SIL":
            open_part = open_part and item.end - item.start < _PAUSE
            continue
        if not open_part or item.end - parts[-1][0].start > _LONGEST:
            parts.append([])
        parts[-1].append(item)
        open_part = True
    return [Stretch(start + part[0].start, start + part[-1].end, confidence(part)) for part in parts]


def unspoken(segments: Sequence[Segment], silences: Sequence[Tuple[float, float]], start: float) -> List[Stretch]:
    """Stretches of confidence 0: `segments` have no phoneme, though the sound is not silent, as if the text lacks
    words. `silences` are the sound's, begin and end; their times and those of `segments` count from `start`."""
    found: List[Stretch] = []
    for item in segments:
        moment = item.start
        for begin, end in [*silences, (item.end, item.end)] if item.label == "SIL" else []:
            until = min(begin, item.end)
            if until - moment >= _UNSPOKEN:
                found.append(Stretch(start + moment, start + until, 0.0))
            moment = max(moment, end)
    return found


def confidence(part: Sequence[Heard]) -> float:
    """The confidence in phonemes that sound."""
    length = np.array([item.end - item.start for item in part])
    score = np.array([item.score for item in part])
    most = np.array([_LONG_VOWEL if item.label in _VOWELS else _LONG_CONSONANT for item in part])
    total = max(float(length.sum()), 1e-9)
    mean = max(float((score * length).sum()) / total, _LEAST)
    return float(1 / (1 + np.exp(-(_CONSTANT + _SCORE * mean + _LONG * float(length[length > most].sum()) / total))))


def comments(found: Sequence[Stretch]) -> str:
    """The stretches as comments of a .lab: start and end in seconds, and the confidence."""
    if not found:
        return ""
    return "# confidence of stretches: start, end, 0 to 1\n" + "".join(
        f"# {item.start:.2f} {item.end:.2f} {item.confidence:.2f}\n" for item in found)


def summary(found: Sequence[Stretch]) -> str:
    """A line: the mean confidence and the lowest, with its place."""
    length = np.array([item.end - item.start for item in found])
    mean = float(np.average([item.confidence for item in found], weights=length))
    worst = min(found, key=lambda item: item.confidence)
    return f"confidence {mean:.2f}, lowest {worst.confidence:.2f} from {worst.start:.1f} to {worst.end:.1f} s"


def unsure(found: Sequence[Stretch]) -> str:
    """The stretches of low confidence, neighbours as one, for a message; "" where there are none."""
    runs = [list(run) for low, run in itertools.groupby(found, lambda item: item.confidence < LOW) if low]
    more = f" and {len(runs) - 6} more" if len(runs) > 6 else ""
    return ", ".join(f"{run[0].start:.1f} to {run[-1].end:.1f} s" for run in runs[:6]) + more
