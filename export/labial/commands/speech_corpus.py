"""``labial speech-corpus``: sentences spoken by free synthesisers, with the times of their phonemes."""

from __future__ import annotations

import argparse

from labial.commands.common import add_quiet, shows_progress
from labial.errors import needs
from labial.files.arguments import number, seed


def add_arguments(command: argparse.ArgumentParser) -> None:
    """A folder, sentences, voices and how long they speak."""
    command.add_argument("output", metavar="OUT", help="folder, new or empty, for sounds, each with a .lab")
    command.add_argument("--sentences", required=True, nargs="+", metavar="FILE", help="texts, a sentence in each "
                         "line, or metadata.csv of LJ Speech")
    command.add_argument("--voices", required=True, nargs="+", metavar="VOICE", help="flite:slt, festival:kal_diphone, "
                         "espeak:en-us+f3 and so on; they take turns")
    command.add_argument("--minutes", type=number, default=30.0, help="of sound in all (30)")
    command.add_argument("--seed", type=seed, default=0)
    add_quiet(command)


def run(options: argparse.Namespace) -> int:
    """Speaks and writes the folder."""
    with needs("speaking", "hear"):
        from tqdm import tqdm

        from labial.hearing.speech_corpus import read_sentences, write_corpus
    from labial.files.outputs import check_folder

    check_folder(options.output)
    sentences = [line for path in options.sentences for line in read_sentences(path)]
    with tqdm(total=round(60 * options.minutes), unit=" s", disable=not shows_progress(options)) as bar:
        done = write_corpus(options.output, sentences, options.voices, options.minutes, options.seed,
                            lambda seconds: bar.update(round(seconds) - bar.n) and None)
    print(f"{options.output}: {done.sounds} sounds, {done.seconds / 60:.1f} minutes")
    return 0
