"""The comparison: fit every method on each split's training part, measure it on the rest (docs/method.md, How it is
judged).

Finished splits are stored on the disk, so that an interrupted evaluation can continue. Each is a file of the folder
``.splits`` in the report's folder: the measures as JSON, and the motion for plots as arrays. A file is valid only for
the same corpus, options and versions; the folder is removed when the report is written.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import warnings
from contextlib import suppress
from dataclasses import astuple, replace
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

import labial
from labial.core.library import library_path
from labial.corpus.episode import Episode
from labial.corpus.phonesets import PHONE_SETS, PhoneSet
from labial.errors import LabialError
from labial.evaluate.baselines import steps
from labial.evaluate.material import (
    Example,
    Options,
    Outcome,
    Split,
    Utterance,
    leave_talkers_out,
    make_splits,
    utterances,
)
from labial.evaluate.measures import Judge, has_pulses, judged_frames, longest_train, silence_of
from labial.evaluate.methods import predict_all, select
from labial.evaluate.readability import LipReader
from labial.evaluate.training import Training
from labial.files.arrays import array, read_zip, write_model
from labial.train.workers import Workers, versions

#: Their folder in the report's folder.
FOLDER = ".splits"
#: Most bytes of a file.
_LARGEST = 500_000_000


class Kept:
    """The finished splits of one evaluation in `folder`, that of the report."""

    def __init__(self, folder: Path, corpus: Sequence[Utterance], options: Options) -> None:
        self._folder = folder / FOLDER
        self._corpus = corpus
        self._of = _fingerprint(corpus, options)

    def find(self, split: Split) -> Optional[Outcome]:
        """The stored split, or None."""
        try:
            members = read_zip(self._path(split), None, _LARGEST)
            about = json.loads(json.loads(members["model.json"])["outcome"])
            if about["of"] != self._of or about["split"] != json.loads(json.dumps(astuple(split))):
                return None
            example = about["example"]
            if example is not None:
                shown, stretch = example["index"], example["stretch"]
                motion = {name: array(name, members[f"{number}.npy"]) for number, name in enumerate(example["motion"])}
                example = Example(example["kind"], shown, self._corpus[shown], stretch and tuple(stretch),
                                  array("steps", members["steps.npy"]), motion)
            return Outcome(split, about["frames"], about["measures"], about["seconds"], example)
        except (OSError, LabialError, ValueError, KeyError, TypeError, IndexError):  # none, or another version's
            return None

    def keep(self, outcome: Outcome) -> None:
        """Stores a split; warns if that fails, since the evaluation can continue without."""
        example = outcome.example
        arrays = {"steps": example.steps, **{str(n): item for n, item in enumerate(example.motion.values())}
                  } if example else {}
        about = {"of": self._of, "split": astuple(outcome.split), "frames": outcome.frames,
                 "measures": outcome.measures, "seconds": outcome.seconds,
                 "example": example and {"kind": example.kind, "index": example.index, "stretch": example.stretch,
                                         "motion": list(example.motion)}}
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            write_model(self._path(outcome.split), {"outcome": json.dumps(about)}, arrays.items())
        except (OSError, LabialError) as error:
            warnings.warn(f"split {outcome.split.number} is not kept for another start: {error}", stacklevel=1)

    def _path(self, split: Split) -> Path:
        return self._folder / f"{split.number}.zip"


def remove_kept(folder: Path) -> None:
    """Removes the stored splits of the report in `folder`."""
    shutil.rmtree(folder / FOLDER, ignore_errors=True)


def _fingerprint(corpus: Sequence[Utterance], options: Options) -> str:
    """A checksum of everything that outcomes depend on, Labial's code too, so that no report mixes two versions."""
    found = hashlib.sha256()
    sources = list(Path(labial.__file__).parent.rglob("*.py"))
    with suppress(LabialError):  # without the library the methods that need it report an error
        sources.append(library_path())
    for path in sorted(sources):
        found.update(path.read_bytes())
    named = replace(options, methods=",".join(method.name for method in select(options.methods)))
    found.update(repr((named, sorted(versions().items()))).encode())
    for item in corpus:
        of = item.episode.source
        found.update(repr((item.episode.name, item.episode.segments, replace(of, left_out=frozenset()),
                           sorted(of.left_out))).encode())
        for values in (item.episode.times, item.episode.frames):
            found.update(np.ascontiguousarray(values).tobytes())
    return found.hexdigest()


#: The human's own motion goes through the same measures under this name.
HUMAN = "human"


def _processor_seconds() -> float:
    """This process's and its finished children's, of user and system."""
    return sum(os.times()[:4])


def _stretch(item: Utterance, phone_set: PhoneSet, split: Split) -> Optional[Tuple[int, int]]:
    """The part of an utterance for plots: its longest judged word, or its longest train of pulses."""
    if has_pulses(phone_set):
        return longest_train(item, phone_set)
    return item.longest_word(silence_of(phone_set), split.words)


def run_split(corpus: Sequence[Utterance], split: Split, options: Options) -> Outcome:
    """Fits and measures all methods on one split."""
    phone_set = PHONE_SETS[options.kind]
    learnt = [corpus[i] for i in split.training]
    training = Training(learnt, phone_set, options.fps, options.seed + split.number, unseen_words=bool(split.words),
                        added=[] if options.first_corpus_alone else [corpus[i].episode for i in split.added],
                        talker_variance=options.talker_variance)
    masks = judged_frames([corpus[i] for i in split.test], phone_set, split.words or ())
    judged = [(i, mask) for i, mask in zip(split.test, masks) if mask.any()]
    if not judged:
        raise LabialError(f"split {split.number}: no frame to judge")
    test, kept = [corpus[i] for i, _ in judged], [mask for _, mask in judged]
    judge = Judge(test, kept, training.scale, phone_set, options.fps)
    reader = LipReader(training, test, split.words)

    def measured(made: Sequence[np.ndarray]) -> Dict[str, float]:
        return {**judge.measure(made), **reader.measure(made)}

    measures = {HUMAN: measured([item.human for item in test])}
    stretches = [_stretch(item, phone_set, split) for item in test]
    # The utterance with the most plotted segments, the first of equals.
    shown = int(np.argmax([found[1] - found[0] + 1 if found else 0 for found in stretches]))
    motion: Dict[str, np.ndarray] = {}
    seconds: Dict[str, float] = {}
    for method in select(options.methods):
        begun = _processor_seconds()
        made = predict_all(method.fit(training), [item.timeline for item in test])
        measures[method.name] = measured(made)
        seconds[method.name] = _processor_seconds() - begun
        motion[method.name] = made[shown]
    example = None
    if split.number == 0:
        held = steps.fit(training)(test[shown].timeline)
        example = Example(options.kind, judged[shown][0], test[shown], stretches[shown], held, motion)
    return Outcome(split, judge.frames, measures, seconds, example)


def _run(task: Tuple[List[Utterance], Split, Options]) -> Outcome:
    return run_split(*task)


def evaluate(episodes: Sequence[Episode], options: Options, *, further: Sequence[Episode] = (), jobs: int = 1,
             engine: Optional[str] = None, progress: bool = True, folder: Optional[Path] = None) -> List[Outcome]:
    """All splits of `episodes` in order; Labial's models are trained on `further` ones, too, unless the options
    say otherwise. With `leave_out_talkers` each talker of `further` in turn is left out and judged. The outcomes do not
    depend on `jobs`, the number of processes, nor on `engine` (:class:`labial.train.workers.Workers`). Finished splits
    are stored in `folder`, that of the report, and reused from there."""
    phone_set = PHONE_SETS[options.kind]
    corpus = utterances(episodes, phone_set, options.fps)
    first = len(corpus)
    corpus += utterances(further, phone_set, options.fps)
    if options.leave_out_talkers:
        splits = leave_talkers_out(corpus, first)
    else:
        splits = [replace(split, added=tuple(range(first, len(corpus))))
                  for split in make_splits(corpus[:first], options.splits, options.seed, options.held_out)]
    kept = Kept(folder, corpus, options) if folder else None
    found = {split.number: outcome for split in splits if kept and (outcome := kept.find(split))}
    if found:
        print(f"{folder}: {len(found)} of {len(splits)} splits were finished before")
    left = [split for split in splits if split.number not in found]
    with Workers(jobs, progress, engine) as workers:
        new = workers.run("splits", _run, [(corpus, split, options) for split in left], kept.keep if kept else None)
    return sorted([*found.values(), *new], key=lambda outcome: outcome.split.number)
