"""The trained tables of a language's words, and the .npz file in which they are stored.

:func:`read` is the reference of the decoder in C: it walks the trees node by node and looks exceptions up by their
spelling, so that it shares nothing with the packed bytes, which are compared with it.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.errors import ModelError, PathLike, expect
from labial.files import limits
from labial.files.arrays import ArrayError, array, read_zip
from labial.files.outputs import writing
from labial.words.alignment import SOUNDS, phonemes_of
from labial.words.dictionary import LETTERS, LONGEST, PHONEMES, letters_of
from labial.words.trees import LABELS_MOST, QUESTIONS, answer, features

#: Version of the file's layout.
FORMAT = 1
#: Questions on the way to a leaf, at most.
_DEEPEST = 250
_ARRAYS = ("format", "sounds", "first", "question", "yes", "no", "label", "multiplier", "patch_count", "patch_letter",
           "patch_label")

Nodes = Tuple[Sequence[int], Sequence[int], Sequence[int], Sequence[int]]


@dataclass(frozen=True)
class WordTables:
    """Trees and exceptions. The trees of all letters are stored one after the other, each with its root first."""

    sounds: Tuple[int, ...]  #: L sounds (:mod:`labial.words.alignment`) by label; label 0 is silent
    first: np.ndarray  #: (28,) the root of each letter's tree, and the number of nodes; letter 1 comes first
    question: np.ndarray  #: (K,) a question, or -1 for a leaf
    yes: np.ndarray  #: (K,) the node to go to, from the tree's root on
    no: np.ndarray  #: (K,)
    label: np.ndarray  #: (K,) of a leaf
    exceptions: Dict[str, Tuple[Tuple[int, int], ...]]  #: word -> places of letters and the labels to give them
    multiplier: int = 1  #: of the exceptions' hashes (:mod:`labial.words.packing`), odd
    attribution: str = ""  #: what redistribution must say
    training: Dict[str, Any] = field(default_factory=dict)  #: options and figures of the training

    def __post_init__(self) -> None:
        _check(self)

    @cached_property
    def _nodes(self) -> List[Nodes]:
        columns = (self.question, self.yes, self.no, self.label)
        return list(zip(*([part.tolist() for part in np.split(item, self.first[1:-1])] for item in columns)))

    def nodes_of(self, letter: int) -> Nodes:
        """Questions, yes-nodes, no-nodes and labels of a letter's tree."""
        return self._nodes[letter - 1]

    @property
    def leaves(self) -> int:
        """Leaves of all trees."""
        return int((self.question < 0).sum())


def _check(tables: WordTables) -> None:
    """Raises ModelError unless every number is in range, every node's successors follow it within its tree, and
    exceptions name letters of their words."""
    labels, nodes = len(tables.sounds), len(tables.question)
    expect(1 <= labels <= LABELS_MOST and tables.sounds[0] == 0, f"there are {labels} labels, not 1 to {LABELS_MOST}")
    valid = all(0 <= sound < SOUNDS and (not sound or 0 not in phonemes_of(sound)) for sound in tables.sounds)
    expect(valid and len(set(tables.sounds)) == labels, "a label's sound does not exist or is there twice")
    columns = (tables.yes, tables.no, tables.label)
    expect(all(column.shape == (nodes,) for column in (tables.question, *columns)), "the trees' columns differ")
    first = tables.first
    expect(first.shape == (len(LETTERS),) and first[0] == 0 and first[-1] == nodes
            and bool((np.diff(first) > 0).all()), "the trees' roots are out of order")
    expect(bool(((tables.question >= -1) & (tables.question < QUESTIONS)).all()), "a question does not exist")
    expect(bool(((tables.label >= 0) & (tables.label < labels)).all()), "a node's label does not exist")
    expect(0 < tables.multiplier < 1 << 32 and tables.multiplier % 2 == 1, "the multiplier is not an odd number")
    sizes, inner = np.diff(first), tables.question >= 0
    here, size = np.arange(nodes) - np.repeat(first[:-1], sizes), np.repeat(sizes, sizes)
    for column in columns[:2]:
        expect(bool(((column > here) & (column < size))[inner].all()), "a node does not follow the one above it")
    _check_shape(tables)
    for word, patches in tables.exceptions.items():
        known = word and len(word) <= LONGEST and all(character in LETTERS[1:] for character in word)
        expect(bool(known), f"the exception {word!r:.40} is not a word of a to z and apostrophes")
        places = [place for place, _ in patches]
        expect(bool(places) and places == sorted(set(places)) and 0 <= places[0] and places[-1] < len(word)
                and all(0 <= label < labels for _, label in patches), f"the exception {word!r} is out of range")


def _check_shape(tables: WordTables) -> None:
    """Raises ModelError unless every node but the roots is below one other, and none below more than `_DEEPEST`."""
    for letter in range(1, len(LETTERS)):
        question, yes, no, _ = tables.nodes_of(letter)
        depth = [0] + [-1] * (len(question) - 1)
        for node in range(len(question)):
            for below in (yes[node], no[node]) if question[node] >= 0 else ():
                expect(depth[below] < 0 <= depth[node] < _DEEPEST, "a tree's node is below two others, or too deep")
                depth[below] = depth[node] + 1
        expect(min(depth) >= 0, "a node belongs to no tree")


def is_tables(path: PathLike) -> bool:
    """Whether a file contains tables of words; False for other files, models among them."""
    try:
        return "words.npy" in read_zip(path, ["words.npy"], limits.WORDS)
    except (OSError, ArrayError):
        return False


def save(tables: WordTables, path: PathLike) -> None:
    """Writes the tables as a compressed .npz; the same tables give the same bytes."""
    patches = list(tables.exceptions.values())
    letters, labels = zip(*chain(*patches)) if patches else ((), ())
    about = json.dumps({"attribution": tables.attribution, "training": tables.training}, sort_keys=True)
    content: Dict[str, np.ndarray] = {
        "format": np.array([FORMAT]), "sounds": np.array(tables.sounds, dtype=np.uint16),
        "first": tables.first.astype(np.uint16), "question": tables.question.astype(np.int16),
        "yes": tables.yes.astype(np.uint16), "no": tables.no.astype(np.uint16), "label": tables.label.astype(np.uint8),
        "multiplier": np.array([tables.multiplier], dtype=np.uint32),
        "patch_count": np.array([len(item) for item in patches], dtype=np.uint8),
        "patch_letter": np.array(letters, dtype=np.uint8), "patch_label": np.array(labels, dtype=np.uint8),
        "words": np.frombuffer("\n".join(tables.exceptions).encode("ascii"), dtype=np.uint8),
        "about": np.frombuffer(about.encode("utf-8"), dtype=np.uint8),
    }
    with writing(path) as file:
        np.savez_compressed(file, **content)  # type: ignore[arg-type]


def load(path: PathLike) -> WordTables:
    """Reads tables. Raises ModelError, with the file, for any other content."""
    try:
        return _load(path)
    except OSError as error:
        raise ModelError(f"{os.fspath(path)}: {error.strerror or error}") from None
    except (ModelError, ArrayError, ValueError, RecursionError) as error:
        raise ModelError(f"{os.fspath(path)}: {error}") from None


def _load(path: PathLike) -> WordTables:
    names = (*_ARRAYS, "words", "about")
    found = read_zip(path, [f"{name}.npy" for name in names], limits.WORDS)
    missing = [name for name in names if f"{name}.npy" not in found]
    expect(not missing, f"not tables of words: no array {', '.join(missing)}")
    content = {name: array(name, found[f"{name}.npy"]) for name in names}
    about = json.loads(content["about"].astype(np.uint8).tobytes().decode("utf-8"))
    words = content["words"].astype(np.uint8).tobytes().decode("ascii").split("\n")
    numbers = {name: content[name].astype(np.int64) for name in _ARRAYS}
    expect(all(column.ndim == 1 for column in numbers.values()), "an array has more than one axis")
    expect(numbers["format"].tolist() == [FORMAT], f"not format {FORMAT} of tables of words: train them again")
    expect(isinstance(about, dict) and isinstance(about.get("attribution"), str)
            and isinstance(about.get("training"), dict), "what it says of itself is damaged")
    expect(len(numbers["multiplier"]) == 1, "there is not one multiplier")
    counts = numbers["patch_count"]
    words = words if words != [""] else []
    total = int(counts.sum())
    expect(len(set(words)) == len(words) == len(counts) and bool((counts >= 0).all())
            and total == len(numbers["patch_letter"]) == len(numbers["patch_label"]), "exceptions and patches differ")
    pairs = list(zip(numbers["patch_letter"].tolist(), numbers["patch_label"].tolist()))
    ends = np.cumsum(counts).tolist()
    exceptions = {word: tuple(pairs[end - count : end]) for word, count, end in zip(words, counts.tolist(), ends)}
    first, question, yes, no, label = (numbers[name] for name in ("first", "question", "yes", "no", "label"))
    return WordTables(tuple(numbers["sounds"].tolist()), first, question, yes, no, label, exceptions,
                      int(numbers["multiplier"][0]), about["attribution"], about["training"])


def names(numbers: Sequence[int]) -> str:
    """Phonemes as text."""
    return " ".join(PHONEMES[number] for number in numbers)


#: Phonemes that a letter has by its accent, or None.
Accent = Optional[Tuple[str, ...]]


def labels_by_trees(tables: WordTables, letters: Sequence[int], sounds: Sequence[Accent] = ()) -> List[int]:
    """The label of each letter, from the last to the first, without exceptions. `sounds` are those of accented letters;
    they hold where the letter's tree has a label for them."""
    labels = [0] * len(letters)
    for place in reversed(range(len(letters))):
        values, node = features(letters, place, labels), 0
        question, yes, no, label = tables.nodes_of(letters[place])
        while question[node] >= 0:
            node = yes[node] if answer(question[node], values, tables.sounds) else no[node]
        forced = _label_of(tables, letters, place, sounds) if sounds else None
        labels[place] = label[node] if forced is None else forced
    return labels


def _label_of(tables: WordTables, letters: Sequence[int], place: int, sounds: Sequence[Accent]) -> Optional[int]:
    """The label of a letter with an accent: an e behind é is silent, and ë at the end of a word is IY."""
    sound = sounds[place]
    if sound is None:
        behind = LETTERS[letters[place]] == "e" and place > 0 and sounds[place - 1] == ("EY",)
        return 0 if behind else None
    if sound == ("EH", "IY"):
        is_last = place + 1 == len(letters) or LETTERS[letters[place + 1]] == "'"
        sound = ("IY",) if is_last else ("EH",)
    wanted = tuple(PHONEMES.index(name) for name in sound)
    question, _, _, label = tables.nodes_of(letters[place])
    return next((given for asked, given in zip(question, label)
                 if asked < 0 and phonemes_of(tables.sounds[given]) == wanted), None)


def labels_of(tables: WordTables, word: str, sounds: Sequence[Accent] = ()) -> List[int]:
    """The label of each letter of a word of a to z and apostrophes, at most `LONGEST` letters."""
    accented = any(sounds)
    labels = labels_by_trees(tables, letters_of(word), sounds if accented else ())
    for place, label in () if accented else tables.exceptions.get(word, ()):
        labels[place] = label
    return labels


def read(tables: WordTables, word: str, sounds: Sequence[Accent] = ()) -> Tuple[Tuple[int, int], ...]:
    """The phonemes of such a word, each with the place of its letter."""
    return tuple((phoneme, place) for place, label in enumerate(labels_of(tables, word, sounds))
                 for phoneme in phonemes_of(tables.sounds[label]))


def phonemes(tables: WordTables, word: str) -> Tuple[int, ...]:
    """The phonemes of such a word."""
    return tuple(phoneme for phoneme, _ in read(tables, word))
