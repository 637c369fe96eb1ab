"""``labial evaluate`` and ``labial evaluate-hear``."""

from __future__ import annotations

import argparse
import contextlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Dict, List, Optional, Sequence

from labial.commands.common import add_engine, add_fps, add_kind, add_quiet, add_talker_variance, put, shows_progress
from labial.defaults import SPLITS
from labial.errors import LabialError, needs
from labial.files.grammar import positive, seed
from labial.files.outputs import check, check_folder, folder

if TYPE_CHECKING:
    from labial.evaluate.material import Outcome


def add_evaluate(command: argparse.ArgumentParser) -> None:
    command.add_argument("corpus", nargs="+", help="as for train; episodes of the first are held out, and Labial's "
                         "models are trained on all of the others too")
    command.add_argument("-o", "--output", required=True, metavar="REPORT", help="folder for tables and plots")
    add_kind(command)
    command.add_argument("--splits", type=positive, default=SPLITS, help=f"random 80/20 splits by episode ({SPLITS})")
    command.add_argument("--seed", type=seed, default=0)
    command.add_argument("--methods", default="all", metavar="A,B,...", help="methods to compare (all)")
    add_fps(command)
    command.add_argument("--jobs", type=positive, default=2, help="splits at a time (2); the result is the same")
    add_engine(command)
    command.add_argument("--hold-out-words", default="", metavar="W1,W2,...",
                         help="train without the episodes that hold these words, judge these words' frames alone")
    command.add_argument("--leave-out-talkers", action="store_true", help="train without each talker of the second "
                         "and further corpora in turn, judge that talker, in place of random splits")
    command.add_argument("--first-corpus-alone", action="store_true", help="with --leave-out-talkers: train Labial's "
                         "models on the first corpus alone, as all other methods")
    add_talker_variance(command)
    add_quiet(command)


def run_evaluate(options: argparse.Namespace) -> None:
    with needs("evaluating", "train,evaluate"):
        from labial.evaluate import report
        from labial.evaluate.material import Options
        from labial.evaluate.methods import select
        from labial.evaluate.protocol import evaluate, remove_kept
        from labial.train.pipeline import check_jobs
        from labial.train.talkers import check_variance
        from labial.train.workers import Workers
    from labial.corpus import read_corpora
    from labial.corpus.laughter import is_synthetic

    words = tuple(word.strip() for word in options.hold_out_words.split(",") if word.strip())
    if words and options.leave_out_talkers:
        raise LabialError("--hold-out-words and --leave-out-talkers do not go together")
    if options.first_corpus_alone and not options.leave_out_talkers:
        raise LabialError("--first-corpus-alone needs --leave-out-talkers")
    select(options.methods)  # before the corpora are read
    check_folder(options.output)
    check_jobs(options.jobs)
    check_variance(options.talker_variance)
    Workers(options.jobs, False, options.engine)
    asked = Options(options.kind, options.methods, options.splits, options.seed, options.fps, words,
                    options.leave_out_talkers, options.talker_variance, options.first_corpus_alone,
                    is_synthetic(options.corpus[0]))
    first, *others = read_corpora(options.corpus, options.kind, distinct=True)
    output = Path(options.output)  # which also keeps finished splits until the report is written
    outcomes = evaluate(first, asked, further=[episode for corpus in others for episode in corpus], jobs=options.jobs,
                        engine=options.engine, progress=shows_progress(options), folder=output)
    with folder(output) as made:
        drawn = report.draw(outcomes, asked, made)
        written = [path.name for path in report.write(outcomes, asked, made, drawn)]
    remove_kept(output)
    methods = report.methods_of(outcomes)
    if asked.leave_out_talkers:
        print(report.talkers_table(outcomes, methods))
    print(report.caption("Table 1", "diff", asked))
    print(report.markdown_table(outcomes, methods, report.TABLE_1))
    print(_processor_time(outcomes))
    for name in (*written, *drawn):
        print(output / name)


def _processor_time(outcomes: Sequence[Outcome]) -> str:
    """Processor seconds per split, for all methods and each; for the terminal, since they differ in each run."""
    total: Dict[str, float] = {}
    for item in outcomes:
        for method, seconds in item.seconds.items():
            total[method] = total.get(method, 0.0) + seconds / len(outcomes)
    each = ", ".join(f"{method} {seconds:.1f}" for method, seconds in total.items())
    return f"processor time per split: {sum(total.values()):.1f} s ({each})"


def add_evaluate_hear(command: argparse.ArgumentParser) -> None:
    command.add_argument("model", metavar="HEAR.npz")
    command.add_argument("folder", nargs="*", metavar="FOLDER", help="speech, as for train-hear")
    command.add_argument("--lips", nargs="+", action="append", metavar="CORPUS", help="judge by lips that were "
                         "measured in video: corpora, as for train, with the sound beside each episode or with "
                         "energies.npz; once more for another group of them")
    command.add_argument("-o", "--output", metavar="TABLE.md", help="standard output without it")
    command.add_argument("--voices", nargs="*", metavar="VOICE", help="synthesisers' voices that say the bundled "
                         "sentences, as for speech-corpus (four that no bundled network was trained on)")
    command.add_argument("--conditions", metavar="A,B,...", help="of clean, -40 dBFS, white noise 20 dB and so on; all "
                         "of them by default")
    command.add_argument("--methods", metavar="A,B,...", help="of network, integers, loudness, \"loudness and "
                         "crossings\" (these; with --lips phonemes and \"phonemes and sound\" in place of "
                         "the last), and other projects: wawa-lipsync, \"wawa-lipsync unsmoothed\", headaudio, "
                         "pocketsphinx")
    command.add_argument("--npm", metavar="FOLDER", help="where npm installed wawa-lipsync and @met4citizen/headaudio")
    command.add_argument("--most", type=positive, help="clips of each folder (all)")
    command.add_argument("--cache", metavar="FOLDER", help="for alignments")
    command.add_argument("--jobs", type=positive, default=os.cpu_count() or 1, help="processes that align")


def run_evaluate_hear(options: argparse.Namespace) -> None:
    check(options.output)
    put(_by_lips(options) if options.lips else _by_timings(options), options.output)


def _by_lips(options: argparse.Namespace) -> str:
    with needs("evaluating", "hear"):
        from labial.evaluate import real_lips
    from labial.hearing.model import load

    for name in ("folder", "voices", "conditions", "npm", "most"):
        if getattr(options, name):
            raise LabialError(f"{'FOLDER' if name == 'folder' else '--' + name} does not go with --lips")
    own = real_lips.methods(load(options.model))
    judged = {name: own[name] for name in _chosen(options.methods, "--methods", list(own))}
    return real_lips.table(list(real_lips.evaluated([real_lips.group(item) for item in options.lips], judged)))


def _by_timings(options: argparse.Namespace) -> str:
    with needs("evaluating", "hear"):
        from labial.evaluate import hearing, others
    from labial.hearing.model import load
    from labial.hearing.voices import read_sentences

    own = hearing.methods(load(options.model))
    names = _chosen(options.methods, "--methods", list(own), list(others.PACKAGES))
    chosen = {name: own[name] if name in own else others.method(name, options.npm) for name in names}
    conditions = _chosen(options.conditions, "--conditions", list(hearing.CONDITIONS))
    with contextlib.nullcontext(options.cache) if options.cache else tempfile.TemporaryDirectory() as cache:
        sets = [hearing.of_folder(folder, cache, options.jobs, options.most or 0) for folder in options.folder]
        voices = hearing.VOICES if options.voices is None else options.voices
        sets += [hearing.of_voice(voice, read_sentences(hearing.SENTENCES)) for voice in voices]
    if not sets:
        raise LabialError("there is nothing to judge by: neither a folder nor a voice")
    return hearing.table(list(hearing.evaluated(sets, chosen, conditions)))


def _chosen(text: Optional[str], option: str, usual: List[str], more: Sequence[str] = ()) -> List[str]:
    """The names in an option, of `usual` and `more`; without it the usual ones."""
    if text is None:
        return usual
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in (*usual, *more):
            raise LabialError(f"{option}: {name!r} is not one of {'; '.join((*usual, *more))}")
    return names
