"""Readability: how well a lip-reader trained on people reads the words of a method's motion.

The reader is Fisher's linear discriminant analysis with a shrunk covariance (scikit-learn), one for each class of
interchangeable words. Its features of a word are the motion of all 13 channels from MARGIN before to MARGIN after it,
at POINTS moments spread evenly, so that durations carry no information, less each channel's mean over them, so that the
talker's resting position carries none either.

* **Known words.** Trained on human motion of the training part, it reads the test part. Classes are by place where all
  utterances have the same number of words and each word one place, as in a command grammar; else all words are one
  class. Words that occur less than LEAST times in the training part are omitted.
* **Unseen words**, held out of training: only these are distinguished. A reader cannot read a word without having seen
  people say it, so it is trained on human motion of the test part, in FOLDS parts, which the seed draws by utterances:
  a reader of the human tokens of all other parts reads the tokens of each part, in every method's motion.

Readability is the share of correctly read tokens, the mean over classes; it is not corrected for chance.

Synthetic motion is a mean, without people's variation between utterances, so that a reader trained on people misjudges
its clarity. *With residual* each token therefore gets that variation as the reader expects it: the features of a human
token of its training, less the mean over the n human tokens of that word, times sqrt(n / (n - 1)). These tokens are
drawn by the seed, REPEATS times each, the same for every method. The human's motion with a residual varies twice, so
compare methods with residual with the human without.
"""

from __future__ import annotations

import itertools
import re
from collections import Counter
from dataclasses import dataclass
from typing import Dict, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

from labial.evaluate.material import Utterance
from labial.evaluate.training import Training

#: Sampling of a word: moments, and seconds beyond it to both sides.
POINTS = 20
MARGIN = 0.1
#: Least tokens of a word to be learned, and the number of parts of the test part for unseen words.
LEAST = 5
FOLDS = 10
#: Readings of each token with a residual.
REPEATS = 5

_VARIANT = re.compile(r"\(\d+\)$")


class Token(NamedTuple):
    """A spoken word: the number of its utterance, its first frame and the frame after its last."""

    word: str
    utterance: int
    begin: int
    end: int


def spoken(item: Utterance, silence: int) -> List[Tuple[str, int, int]]:
    """The words of an utterance in order: word, first frame and the frame after the last, of each run of segments with
    its name; there may be no frame. "with" and "with(2)", which aligners use for pronunciations, are one word."""
    start, end = item.timeline.start, item.timeline.start + item.timeline.length
    said = [None if word is None or phoneme == silence else _VARIANT.sub("", word)
            for word, phoneme in zip(item.words, item.timeline.phoneme)]
    runs = ((word, list(run)) for word, run in itertools.groupby(range(len(said)), said.__getitem__))
    return [(word, int(start[run[0]]), int(end[run[-1]])) for word, run in runs if word is not None]


def word_classes(sentences: Sequence[Sequence[str]]) -> List[Tuple[str, ...]]:
    """The words, ascending, in classes that stand for each other: by place in the sentence where all sentences have the
    same number of words and each word one place, else all in one class."""
    places: Dict[str, Set[int]] = {}
    for sentence in sentences:
        for place, word in enumerate(sentence):
            places.setdefault(word, set()).add(place)
    grammar = len({len(sentence) for sentence in sentences}) == 1 and all(len(own) == 1 for own in places.values())
    classes: Dict[int, List[str]] = {}
    for word in sorted(places):
        classes.setdefault(min(places[word]) if grammar else 0, []).append(word)
    return [tuple(classes[place]) for place in sorted(classes)]


def features(frames: np.ndarray, begin: int, end: int, fps: int) -> np.ndarray:
    """(13 POINTS,) FAP: what the reader sees of frames (T, 13) from `begin` to before `end`. Edges repeat."""
    margin = MARGIN * fps
    moments = np.linspace(begin - margin, end - 1 + margin, POINTS)
    seen = np.stack([np.interp(moments, np.arange(len(frames)), channel) for channel in frames.T], axis=1)
    return (seen - seen.mean(axis=0)).ravel()


class Reader:
    """Reads words of one class."""

    def __init__(self, seen: np.ndarray, words: Sequence[str]) -> None:
        """`seen` (n, 13 POINTS) of tokens of known words, at least two different ones."""
        names, number, count = np.unique(np.array(words), return_inverse=True, return_counts=True)
        mean = np.stack([seen[number == index].mean(axis=0) for index in range(len(names))])
        spread = np.sqrt(count / np.maximum(count - 1, 1))
        self.residual = (seen - mean[number]) * spread[number][:, None]  #: (n, 13 POINTS) FAP
        self._analysis = LinearDiscriminantAnalysis(solver="lsqr", shrinkage="auto").fit(seen, np.array(words))

    def read(self, seen: np.ndarray) -> np.ndarray:
        """(n,) the words that (n, 13 POINTS) look like."""
        return self._analysis.predict(seen)


@dataclass(frozen=True)
class _Test:
    """Tokens that are read by one reader, and the rows of its residuals that they borrow."""

    reader: Reader
    tokens: List[Token]
    borrowed: np.ndarray  #: (REPEATS, n) int64

    def right(self, seen: np.ndarray, with_residual: bool) -> np.ndarray:
        """(n,) or (REPEATS n,) bool: which of the tokens, seen as (n, 13 POINTS), are read as what they are."""
        words = np.array([item.word for item in self.tokens])
        if not with_residual:
            return self.reader.read(seen) == words
        return np.concatenate([self.reader.read(seen + self.reader.residual[rows]) == words for rows in self.borrowed])


class LipReader:
    """Reads the words of a test part in motion of any origin."""

    def __init__(self, training: Training, test: Sequence[Utterance], words: Optional[Sequence[str]] = None) -> None:
        """`words`: those that no utterance of `training` holds and that alone are read; None: all words."""
        self._fps, self._silence = training.fps, training.silence
        self._test = list(test)
        self._random = np.random.default_rng([training.seed, 3])
        said = [[word for word, _, _ in spoken(item, self._silence)] for item in [*training.utterances, *test]]
        classes = word_classes(said)
        if words is None:
            tests = [self._make(training.utterances, self._tokens(training.utterances, own),
                                self._tokens(self._test, own)) for own in classes]
        else:
            part = self._random.permutation(len(self._test)) % FOLDS
            judged = {_VARIANT.sub("", word) for word in words}
            tests = [self._unseen([word for word in own if word in judged], part) for own in classes]
        self._classes = [found for found in tests if found]

    def _tokens(self, items: Sequence[Utterance], words: Sequence[str]) -> List[Token]:
        return [Token(word, number, begin, end) for number, item in enumerate(items)
                for word, begin, end in spoken(item, self._silence) if word in words and begin < end]

    def _seen(self, motion: Sequence[np.ndarray], tokens: Sequence[Token]) -> np.ndarray:
        return np.stack([features(motion[item.utterance], item.begin, item.end, self._fps) for item in tokens])

    def _make(self, items: Sequence[Utterance], learned: Sequence[Token], read: Sequence[Token]) -> List[_Test]:
        """A test of those tokens of `read` whose words have LEAST tokens to learn from, `learned`, which are of
        `items`; none where these words are not two or nothing is left to read."""
        count = Counter(item.word for item in learned)
        learned = [item for item in learned if count[item.word] >= LEAST]
        read = [item for item in read if count[item.word] >= LEAST]
        if len({item.word for item in learned}) < 2 or not read:
            return []
        reader = Reader(self._seen([item.human for item in items], learned), [item.word for item in learned])
        return [_Test(reader, read, self._random.integers(0, len(learned), (REPEATS, len(read))))]

    def _unseen(self, words: Sequence[str], part: np.ndarray) -> List[_Test]:
        """`part` (n,) is the part of each test utterance."""
        tokens, tests = self._tokens(self._test, words), []
        for fold in range(FOLDS):
            learned = [item for item in tokens if part[item.utterance] != fold]
            tests += self._make(self._test, learned, [item for item in tokens if part[item.utterance] == fold])
        return tests

    def _score(self, motion: Sequence[np.ndarray], with_residual: bool) -> float:
        shares = []
        for tests in self._classes:
            right = [item.right(self._seen(motion, item.tokens), with_residual) for item in tests]
            shares.append(np.concatenate(right).mean())
        return float(np.mean(shares)) if shares else float("nan")

    def measure(self, motion: Sequence[np.ndarray]) -> Dict[str, float]:
        """Readability of motion, one (T, 13) per utterance of the test part; NaN where there are no words to read."""
        return {"readability": self._score(motion, False), "readability/with residual": self._score(motion, True)}
