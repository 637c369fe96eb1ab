"""The comparison: fit every method on each split's training part, measure it on the rest (docs/method.md, How it is
judged)."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Episode
from labial.corpus.phonesets import PHONE_SETS, PhoneSet
from labial.errors import LabialError
from labial.evaluate.baselines import steps
from labial.evaluate.kept import Kept
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
from labial.train.workers import Workers

#: The human's own motion goes through the same measures under this name.
HUMAN = "human"


def _processor_seconds() -> float:
    """This process's and its finished children's."""
    spent = os.times()
    return spent.user + spent.system + spent.children_user + spent.children_system


def _stretch(item: Utterance, phone_set: PhoneSet, split: Split) -> Optional[Tuple[int, int]]:
    """The part of an utterance for plots: its longest judged word, or its longest train of pulses."""
    if has_pulses(phone_set):
        return longest_train(item, phone_set)
    return item.longest_word(silence_of(phone_set), split.words)


def _most_shown(test: Sequence[Utterance], phone_set: PhoneSet, split: Split) -> int:
    """The utterance with the most plotted segments, the first of equals."""
    shown = [_stretch(item, phone_set, split) or (0, -1) for item in test]
    return int(np.argmax([last - first + 1 for first, last in shown]))


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
    shown = _most_shown(test, phone_set, split)
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
        item = test[shown]
        held = steps.fit(training).predict(item.timeline)
        example = Example(options.kind, judged[shown][0], item, _stretch(item, phone_set, split), held, motion)
    return Outcome(split, judge.frames, measures, seconds, example)


def _run(task: Tuple[List[Utterance], Split, Options]) -> Outcome:
    return run_split(*task)


def evaluate(
    episodes: Sequence[Episode], options: Options, *, further: Sequence[Episode] = (), jobs: int = 1,
    engine: Optional[str] = None, progress: bool = True, folder: Optional[Path] = None,
) -> List[Outcome]:
    """All splits of `episodes` in order; Labial's models are trained on `further` ones, too, unless the options
    say otherwise. With `leave_out_talkers` each talker of `further` in turn is left out and judged. The outcomes do not
    depend on `jobs`, the number of processes, nor on `engine` (:class:`labial.train.workers.Workers`). Finished splits
    are stored in `folder`, that of the report, and reused from there (:mod:`labial.evaluate.kept`)."""
    phone_set = PHONE_SETS[options.kind]
    corpus = utterances(episodes, phone_set, options.fps)
    first = len(corpus)
    corpus += utterances(further, phone_set, options.fps)
    if options.leave_out_talkers:
        splits = leave_talkers_out(corpus, first)
    else:
        splits = [replace(split, added=tuple(range(first, len(corpus))))
                  for split in make_splits(corpus[:first], options.splits, options.seed, options.held_out)]
    if folder is None:
        with Workers(jobs, progress, engine) as workers:
            return workers.run("splits", _run, [(corpus, split, options) for split in splits])
    kept = Kept(folder, corpus, options)
    found = {split.number: outcome for split in splits for outcome in [kept.find(split)] if outcome is not None}
    if found:
        print(f"{folder}: {len(found)} of {len(splits)} splits were finished before")
    left = [split for split in splits if split.number not in found]
    with Workers(jobs, progress, engine) as workers:
        new = workers.run("splits", _run, [(corpus, split, options) for split in left], kept.keep)
    return sorted([*found.values(), *new], key=lambda outcome: outcome.split.number)
