"""From a dictionary to tables: alignment, trees, exceptions, and how well unknown words are read."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.phonesets import SPEECH
from labial.errors import ModelError
from labial.words.alignment import align, learn, loosened
from labial.words.dictionary import LETTERS, PHONEMES, Entry, letters_of, pronunciations
from labial.words.packing import multiplier_for
from labial.words.tables import WordTables, labels_of
from labial.words.tables import phonemes as spoken
from labial.words.trees import FIRST, LABELS_MOST, OTHER, Asked, Samples, features, grow, prune

#: Leaves of all trees, and exceptions, of the bundled tables.
LEAVES, EXCEPTIONS = 13_000, 1_000
#: What whoever passes the tables on must say; :data:`labial.words.dictionary.NOTICE` has the whole notice.
ATTRIBUTION = ("Trained on the CMU Pronouncing Dictionary. Copyright (C) 1993-2015 Carnegie Mellon University. All "
               "rights reserved.")


#: Sounds that dictionaries lack, or have otherwise than lips make them: the h of hmm is spoken with closed lips.
SOUNDS = {"hm": ("M",), "hmm": ("M",), "hmmm": ("M",), "hmmmm": ("M",), "hmph": ("M", "F"), "psst": ("P", "S", "T"),
          "pst": ("P", "S", "T"), "pfft": ("P", "F", "T"), "pft": ("P", "F", "T"), "pff": ("P", "F")}

Report = Callable[[str], Any]
Sounds = Sequence[Optional[Tuple[int, ...]]]


def train(entries: Sequence[Entry], common: Sequence[str], *, leaves: int = LEAVES, exceptions: int = EXCEPTIONS,
          report: Optional[Report] = None) -> WordTables:
    """The tables of a dictionary; of SOUNDS and the `common` words, in their order, the first `exceptions` that the
    trees read wrongly become exceptions. `report` gets the steps of the work."""
    report = report or str  # which tells nobody
    tables, aligned, loose = _trees(entries, leaves, report)
    pairs: List[Tuple[Entry, Optional[Tuple[int, ...]]]] = [
        (Entry(word, letters_of(word), tuple(map(PHONEMES.index, sounds)), 0), None) for word, sounds in SOUNDS.items()]
    pairs += [pair for pair in zip(entries, aligned) if pair[0].word not in SOUNDS]
    known, given = zip(*pairs)
    # Entries that have no alignment, such as "of", get the best one of the probabilities `loose`.
    others = [place for place, sounds in enumerate(given) if sounds is None]
    further = dict(zip(others, align([known[place] for place in others], loose)))
    completed = [further.get(place, sounds) for place, sounds in enumerate(given)]
    found = _exceptions(tables, known, completed, [*SOUNDS, *common], exceptions)
    report(f"{tables.leaves} leaves, {len(tables.sounds)} labels, {len(found)} exceptions")
    about: Dict[str, Any] = {"entries": len(entries), "words": sum(entry.variant == 0 for entry in entries),
                             "not_aligned": sum(item is None for item in aligned), "leaves": leaves,
                             "exceptions": exceptions}
    multiplier = multiplier_for(list(found), (entry.word for entry in entries))
    return replace(tables, exceptions=found, multiplier=multiplier, attribution=ATTRIBUTION, training=about)


def held_out(entries: Sequence[Entry], *, leaves: int = LEAVES, report: Optional[Report] = None) -> Dict[str, float]:
    """How well trees that were trained on 85 % of the words read the others, without exceptions (:func:`score`)."""
    tables = _trees([entry for entry in entries if not entry.held_out], leaves, report or str)[0]
    return score(tables, pronunciations([entry for entry in entries if entry.held_out]))


def score(tables: WordTables, words: Dict[str, List[Tuple[int, ...]]]) -> Dict[str, float]:
    """Per cent of phonemes, viseme classes and words that are read as one of the word's pronunciations says: 100 less
    the insertions, deletions and substitutions against the nearest pronunciation, per phoneme of that."""
    classes = SPEECH.viseme_class
    size = wrong = wrong_classes = wrong_words = 0
    for word, known in words.items():
        got = spoken(tables, word)
        errors, length = min((_distance(got, other), len(other)) for other in known)
        seen = [classes[p] for p in got]
        size += length
        wrong += errors
        wrong_words += errors > 0
        wrong_classes += min(_distance(seen, [classes[p] for p in other]) for other in known)
    return {"words": float(len(words)), "phonemes": 100 - 100 * wrong / size,
            "viseme classes": 100 - 100 * wrong_classes / size,
            "whole words": 100 - 100 * wrong_words / len(words)}


def _distance(a: Sequence[int], b: Sequence[int]) -> int:
    """The least number of insertions, deletions and substitutions from a to b."""
    row = list(range(len(b) + 1))
    for i, item in enumerate(a, 1):
        corner, row[0] = row[0], i
        for j, other in enumerate(b, 1):
            corner, row[j] = row[j], min(corner + (item != other), row[j] + 1, row[j - 1] + 1)
    return row[-1]


def _trees(entries: Sequence[Entry], leaves: int, report: Report) -> Tuple[WordTables, Sounds, np.ndarray]:
    """Tables without exceptions, the alignment of each entry, and probabilities that can align the others."""
    report(f"aligning {len(entries)} pronunciations")
    probability = learn(entries)
    aligned = align(entries, probability)
    sounds = tuple(sorted({0, *(sound for item in aligned if item for sound in item)}))  # a label is a place in these
    if len(sounds) > LABELS_MOST:
        raise ModelError(f"the letters have {len(sounds)} sounds, and there is room for {LABELS_MOST}")
    asked = Asked(sounds)
    report(f"{len(sounds)} labels; growing trees")
    grown = [grow(samples, asked) for samples in _samples(entries, aligned, sounds)]
    pruned = prune(grown, leaves)
    first = np.cumsum([0, *(len(tree.question) for tree in pruned)])
    question, yes, no, label = (np.concatenate([getattr(tree, name) for tree in pruned])
                                for name in ("question", "yes", "no", "label"))
    return WordTables(sounds, first, question, yes, no, label, {}), aligned, loosened(probability, sounds)


def _samples(entries: Sequence[Entry], aligned: Sounds, known: Sequence[int]) -> List[Samples]:
    """The samples of each letter; raises ModelError if one does not occur."""
    labels = {sound: label for label, sound in enumerate(known)}
    rows: Dict[int, List[Tuple[List[int], int, int]]] = defaultdict(list)
    for entry, sounds in zip(entries, aligned):
        given = [labels[sound] for sound in sounds or ()]
        for place, (letter, label) in enumerate(zip(entry.letters, given)):
            rows[letter].append((features(entry.letters, place, given), label, OTHER if entry.variant else FIRST))
    missing = [LETTERS[letter] for letter in range(1, len(LETTERS)) if letter not in rows]
    if missing:
        raise ModelError(f"no word of the dictionary that could be aligned has the letter {missing[0]}")
    columns = (zip(*rows[letter]) for letter in range(1, len(LETTERS)))
    return [Samples(np.array(asked, dtype=np.uint8), *map(np.array, others)) for asked, *others in columns]


def _exceptions(tables: WordTables, entries: Sequence[Entry], aligned: Sounds, common: Sequence[str],
                most: int) -> Dict[str, Tuple[Tuple[int, int], ...]]:
    """The first `most` words of `common` that are read as none of their pronunciations, with the labels that make them
    the first one that is aligned."""
    given: Dict[str, Tuple[int, ...]] = {}
    for entry, sounds in zip(entries, aligned):
        if sounds is not None:
            given.setdefault(entry.word, tuple(map(tables.sounds.index, sounds)))
    known = pronunciations(entries)
    found: Dict[str, Tuple[Tuple[int, int], ...]] = {}
    for word in dict.fromkeys(common):
        if len(found) == most:
            break
        if word in given and spoken(tables, word) not in known[word]:
            pairs = zip(labels_of(tables, word), given[word])
            found[word] = tuple((place, right) for place, (wrong, right) in enumerate(pairs) if wrong != right)
    return found
