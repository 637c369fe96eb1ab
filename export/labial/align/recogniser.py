"""PocketSphinx with the English models that it brings: phonemes of a piece of sound, from its words or without."""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from pocketsphinx import Decoder

from labial.align.confidence import Heard
from labial.align.sound import RATE
from labial.corpus.episode import Segment

#: Frames per second, and how far a frame's middle lies behind its number: its window is longer than its step.
FRAME_RATE = 100
_OFFSET = (0.025625 - 1 / FRAME_RATE) / 2
#: So wide that a text is followed where it fits badly.
_BEAM = 1e-200
_WIDE = {"beam": _BEAM, "wbeam": _BEAM, "pbeam": _BEAM, "bestpath": False}
#: A second pass on 30 ms of sound at least: a phoneme has three states.
_SHORTEST = int(0.1 * RATE)


class Found(NamedTuple):
    """Phonemes in seconds of a piece of sound."""

    segments: List[Segment]
    score: float  #: of the mean frame
    heard: List[Heard]  #: the same, each with its score


class Recogniser:
    """Two decoders, each made when it is first needed: one that follows words, one that finds them."""

    def __init__(self) -> None:
        self._follower: Optional[Decoder] = None
        self._finder: Optional[Decoder] = None

    @property
    def follower(self) -> Decoder:
        """The decoder that follows words; its dictionary takes further ones."""
        if self._follower is None:
            self._follower = Decoder(lm=None, loglevel="FATAL", **_WIDE)
        return self._follower

    def lookup(self, word: str) -> Optional[str]:
        """The dictionary's phonemes of a word, or None."""
        found = self.follower.lookup_word(word)
        return str(found) if found else None

    def learn(self, pronunciations: Dict[str, str]) -> None:
        """Adds words to the dictionary."""
        for number, (word, phonemes) in enumerate(pronunciations.items(), 1):
            self.follower.add_word(word, phonemes, number == len(pronunciations))

    def follow(self, samples: np.ndarray, words: Sequence[str]) -> Optional[List[Tuple[str, float, float]]]:
        """`words` and the silences between them with begin and end in seconds; None where they do not fit at all.

        `samples` is (N,) int16 at `RATE`. All of the words are in it.
        """
        if len(samples) < _SHORTEST or not words:
            return None
        self.follower.set_align_text(" ".join(words))
        return _words(self.follower, samples)

    def follow_part(self, samples: np.ndarray, words: Sequence[str]) -> List[Tuple[str, float, float]]:
        """As :meth:`follow`, but `words` may go on behind the end of `samples`; [] where they do not fit at all."""
        states = len(words)
        steps = [(state, state + 1, 1.0, word) for state, word in enumerate(words)]
        ways_out = [(state, states + 1, 1.0) for state in range(states + 1)]
        self.follower.add_fsg("part", self.follower.create_fsg("part", 0, states + 1, [*steps, *ways_out]))
        self.follower.activate_search("part")
        return _words(self.follower, samples)

    def phonemes(self, samples: np.ndarray, words: Sequence[str]) -> Optional[Found]:
        """Phonemes of `words` in seconds of `samples`, as of :func:`_phonemes`; None as above."""
        return _phonemes(self.follower, samples) if self.follow(samples, words) else None

    def find(self, samples: np.ndarray) -> Optional[Found]:
        """Phonemes of the words that are most likely in `samples`; None where there are none."""
        if len(samples) < _SHORTEST:
            return None
        if self._finder is None:
            self._finder = Decoder(loglevel="FATAL", fwdflat=False, maxhmmpf=5000)
        self._finder.activate_search()
        return _phonemes(self._finder, samples) if _words(self._finder, samples) else None


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
        found = [phone for word in decoder.get_alignment() for phone in word]
    except RuntimeError:
        return None
    segments, heard = [], []
    for phone in found:
        start = phone.start / FRAME_RATE + (_OFFSET if phone.start else 0.0)
        label = phone.name if phone.name.isalpha() else "SIL"
        segments.append(Segment(start, (phone.start + phone.duration) / FRAME_RATE + _OFFSET, label))
        heard.append(Heard(start, segments[-1].end, label, phone.score / max(phone.duration, 1)))
    sounding = [phone for phone in found if phone.name.isalpha() and phone.name != "SIL"]
    if not sounding:
        return None
    return Found(segments, sum(phone.score for phone in sounding) / sum(phone.duration for phone in sounding), heard)
