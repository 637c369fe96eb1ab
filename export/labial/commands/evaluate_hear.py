"""``labial evaluate-hear``: lips from sound against lips in videos, or against lips from true timings."""

from __future__ import annotations

import argparse
import contextlib
import os
import tempfile
from typing import List, Optional, Sequence

from labial.commands.common import put
from labial.errors import LabialError, needs
from labial.files.arguments import positive


def add_evaluate_hear(command: argparse.ArgumentParser) -> None:
    """A model, and the sounds, conditions and methods to judge."""
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


def run_evaluate_hear(options: argparse.Namespace) -> int:
    """Prints a table."""
    from labial.files.outputs import check

    check(options.output)
    put(_by_lips(options) if options.lips else _by_timings(options), options.output)
    return 0


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

    model = load(options.model)
    own = hearing.methods(model)
    names = _chosen(options.methods, "--methods", list(own), list(others.PACKAGES))
    chosen = {name: own[name] if name in own else others.method(name, options.npm) for name in names}
    conditions = _chosen(options.conditions, "--conditions", list(hearing.CONDITIONS))
    with contextlib.nullcontext(options.cache) if options.cache else tempfile.TemporaryDirectory() as cache:
        sets = [hearing.of_folder(folder, cache, options.jobs, options.most or 0)
                for folder in options.folder]
        voices = hearing.VOICES if options.voices is None else options.voices
        sets += [hearing.of_voice(voice, hearing.default_sentences()) for voice in voices]
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
