"""The commands that make what models learn from: timings, landmarks and corpora."""

from __future__ import annotations

import argparse
import sys

from labial.commands.common import add_kind, add_labels, add_quiet, add_said, add_source, put, said, shows_progress
from labial.defaults import EPISODES, WHICH_FACE
from labial.errors import needs
from labial.files.grammar import finite, positive, seed
from labial.files.outputs import check, check_folder


def add_timings(command: argparse.ArgumentParser) -> None:
    command.add_argument("phones", metavar="FILE", help="phoneme timings, as for synth")
    add_source(command)
    add_labels(command)
    command.add_argument("--offset-ms", type=finite, default=0.0, metavar="MS", help="added to all times: over 0 for a "
                         "voice that reports them too early (0)")
    command.add_argument("--language", default="en", help="of words and characters; another than en is pronounced by "
                         "espeak-ng, as it calls a language or a voice (en)")
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")


def run_timings(options: argparse.Namespace) -> None:
    from labial.corpus.formats import as_lab
    from labial.corpus.words import pronunciation

    check(options.output, ".lab")
    how = pronunciation(language=options.language)
    offset = options.offset_ms / 1000.0
    put(as_lab(options.phones, options.labels, options.source, how, offset, options.tier), options.output)


def add_align(command: argparse.ArgumentParser) -> None:
    command.add_argument("sound", metavar="SOUND", help="WAV, FLAC, Ogg, MP3; any rate and number of channels")
    add_said(command)
    command.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")
    add_quiet(command)


def run_align(options: argparse.Namespace) -> None:
    with needs("aligning", "align"):
        from labial.sound.align import align_with_bar
        from labial.sound.recogniser import summary

    check(options.output, ".lab")
    found = align_with_bar(options.sound, said(options), shows_progress(options))
    put(found.lab(), options.output)
    if found.stretches and not options.quiet:
        print(f"{options.sound}: {summary(found.stretches)}", file=sys.stderr)


def add_landmarks(command: argparse.ArgumentParser) -> None:
    command.add_argument("video", metavar="VIDEO")
    command.add_argument("-o", "--output", required=True, metavar="LANDMARKS.npz")
    command.add_argument("--face", choices=WHICH_FACE, help="which is the talker's, where there is "
                         "more than one, as seen in the picture")
    command.add_argument("--task", metavar="FILE", help="the model of MediaPipe's Face Landmarker, "
                         "face_landmarker.task, for a MediaPipe that brings none")
    add_quiet(command)


def run_landmarks(options: argparse.Namespace) -> None:
    check(options.output, ".npz")
    with needs("tracking", "record"):
        from labial.capture.track import landmarks

    print(landmarks(options.video, options.output, options.face, options.task, progress=shows_progress(options)))


def add_record(command: argparse.ArgumentParser) -> None:
    command.add_argument("landmarks", metavar="LANDMARKS", nargs="+", help="one talker's .npz, .npy or .csv files, or "
                         "folders of them, each with its phoneme timings (NAME.lab, .TextGrid, ...) beside it")
    command.add_argument("-o", "--output", required=True, metavar="CORPUS", help="folder, new or empty")
    add_kind(command)
    command.add_argument("--fps", type=finite, metavar="RATE", help="frames per second, where the files do not tell")
    command.add_argument("--size", metavar="WIDTHxHEIGHT", help="of the video in pixels, where coordinates are shares "
                         "of it and the files do not tell")
    command.add_argument("--offset", type=finite, default=0.0, metavar="MS", help="how much later than its sound the "
                         "picture is, negative where it is earlier (0); an estimate is printed")
    command.add_argument("--cutoff", type=finite, default=12.0, metavar="HZ",
                         help="what moves faster is smoothed as the tracker's noise; 0 smooths nothing (12)")


def run_record(options: argparse.Namespace) -> None:
    with needs("recording", "record"):
        from labial.capture.record import record
    from labial.capture.landmarks import Given, parse_size
    from labial.corpus.phonesets import PHONE_SETS

    size = parse_size(options.size) if options.size else None
    print(record(options.landmarks, options.output, PHONE_SETS[options.kind], Given(options.fps, size), options.cutoff,
                 options.offset / 1000))


def add_laughter_corpus(command: argparse.ArgumentParser) -> None:
    command.add_argument("output", metavar="OUT", help="folder, new or empty")
    command.add_argument("--episodes", type=positive, default=EPISODES)
    command.add_argument("--seed", type=seed, default=0)


def run_laughter_corpus(options: argparse.Namespace) -> None:
    from labial.corpus.laughter import generate

    generate(options.output, episodes=options.episodes, seed=options.seed)
    print(f"{options.output}: {options.episodes} synthetic episodes")


def add_speech_corpus(command: argparse.ArgumentParser) -> None:
    command.add_argument("output", metavar="OUT", help="folder, new or empty, for sounds, each with a .lab")
    command.add_argument("--sentences", required=True, nargs="+", metavar="FILE", help="texts, a sentence in each "
                         "line, or metadata.csv of LJ Speech")
    command.add_argument("--voices", required=True, nargs="+", metavar="VOICE", help="flite:slt, festival:kal_diphone, "
                         "espeak:en-us+f3 and so on; they take turns")
    command.add_argument("--minutes", type=finite, default=30.0, help="of sound in all (30)")
    command.add_argument("--seed", type=seed, default=0)
    add_quiet(command)


def run_speech_corpus(options: argparse.Namespace) -> None:
    with needs("speaking", "hear"):
        from tqdm import tqdm

        from labial.hearing.voices import read_sentences, write_corpus

    check_folder(options.output)
    sentences = [line for path in options.sentences for line in read_sentences(path)]
    with tqdm(total=round(60 * options.minutes), unit=" s", disable=not shows_progress(options)) as bar:
        done = write_corpus(options.output, sentences, options.voices, options.minutes, options.seed,
                            lambda seconds: bar.update(round(seconds) - bar.n) and None)
    print(f"{options.output}: {done.sounds} sounds, {done.seconds / 60:.1f} minutes")
