"""The command ``labial``: train, synth, timings, align, bake, export, check, evaluate, laughter-corpus, rig, plot,
page, landmarks, record."""

from __future__ import annotations

import argparse
import functools
import io
import math
import os
import sys
import traceback
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Callable, Dict, List, NoReturn, Optional

from labial import __version__
from labial.errors import LabialError, needs
from labial.grammar import is_number, is_whole

#: Predecessors that are kept for each state by default.
PREDECESSORS = 4

if TYPE_CHECKING:
    from labial.model import Model


class _Parser(argparse.ArgumentParser):
    """Says in one line what is wrong with the arguments."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {_one_line(message)}\n")


def _one_line(text: str) -> str:
    """`text` as one line that shows: of control characters and of bytes of a name that are no UTF-8 the escapes."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def _whole(low: int, high: int, text: str) -> int:
    value = int(text) if is_whole(text) else -1
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number within {low} .. {high}")
    return value


def _number(text: str) -> float:
    if not is_number(text) or math.isinf(float(text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return float(text)


#: Counts; more of nothing here is of use. Seeds, as NumPy and scikit-learn take them.
_positive = functools.partial(_whole, 1, 1_000_000)
_seed = functools.partial(_whole, 0, 2**32 - 1)


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = _Parser(
        prog="labial", description="Trains lip-motion models and exports them for the C library."
    )
    top.add_argument("--version", action="version", version=f"labial {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    train = commands.add_parser("train", help="train a model on a corpus")
    train.add_argument("corpus", nargs="+", help="Labial corpus folder, IEMOCAP or AVLaughterCycle; of several, all "
                       "talkers are brought to the first one's mean and scale, and corpus.toml in a folder tells more")
    train.add_argument("-o", "--output", required=True, metavar="MODEL.npz")
    train.add_argument("--kind", choices=("speech", "laughter"), default="speech")
    train.add_argument("--method", choices=("paper", "labial"), default="labial")
    train.add_argument("--fps", type=_positive, default=50, help="frames per second (50)")
    train.add_argument("--codebook", type=_positive, default=50, help="states per channel (50)")
    train.add_argument("--components", type=_positive, default=5, help="mixture components per phoneme (5)")
    train.add_argument("--look-ahead", type=functools.partial(_whole, 0, 360), metavar="MS", help="--method labial: "
                       "how far the kernels reach into what follows, 0 .. 360 ms (120); less is less latency")
    train.add_argument("--search-stride", type=_positive, metavar="FRAMES", help="--method labial: frames that "
                       "share a state of the decoded path (3); 1 decodes every frame, as --method paper always does")
    train.add_argument("--seed", type=_seed, default=0)
    train.add_argument("--jobs", type=_positive, default=os.cpu_count() or 1, help="processes; the result is the same")
    _add_engine(train)
    train.add_argument("--attribution", default="", help="what whoever passes the model on must say; kept in the model")
    train.add_argument("--quiet", action="store_true", help="no progress bars")
    train.set_defaults(run=_train)

    synth = commands.add_parser("synth", help="synthesise frames with the float64 reference")
    synth.add_argument("model", metavar="MODEL.npz")
    synth.add_argument("phones", metavar="PHONES",
                       help="phoneme timings: .lab, HTK, .TextGrid, .phseg, .pho, MaryTTS, flite -psdur, JSON of "
                       "Piper, Azure, Polly, HeadTTS or Kokoro")
    _add_source(synth)
    synth.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    _add_format(synth)
    synth.add_argument("--rig", metavar="FACE.toml", help="with --to jsonl: a face of your own in place of ARKit's, as "
                       "labial rig reads it")
    _add_labels(synth)
    synth.add_argument("--whole", action="store_true",
                       help="search and solve the whole utterance at once, not as the run-time does")
    synth.set_defaults(run=_synth)

    timings = commands.add_parser("timings", help="turn phoneme timings of any format into a .lab")
    timings.add_argument("phones", metavar="FILE", help="phoneme timings, as for synth")
    _add_source(timings)
    _add_labels(timings)
    timings.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")
    timings.set_defaults(run=_timings)

    align = commands.add_parser("align", help="find the phonemes of a recording (English)")
    align.add_argument("sound", metavar="SOUND", help="WAV, FLAC, Ogg, MP3; any rate and number of channels")
    _add_said(align)
    align.add_argument("-o", "--output", metavar="OUT.lab", help="standard output without it")
    align.add_argument("--quiet", action="store_true", help="no progress bar")
    align.set_defaults(run=_align)

    bake = commands.add_parser("bake", help="turn timings, a sound or frames into a C header that a board plays")
    bake.add_argument("file", metavar="FILE", help="phoneme timings, as for synth; a sound, as for align; or frames "
                      "(.csv, .fap)")
    bake.add_argument("-o", "--output", required=True, metavar="OUT.h")
    bake.add_argument("--as", dest="kind", choices=("track", "phonemes"), default="track",
                      help="a byte per output and frame, which an Arduino Uno plays, or phonemes for boards that run "
                      "Labial (track)")
    bake.add_argument("--rig", metavar="FACE.toml", help="what a track moves, as for rig; a jaw without it")
    _add_said(bake)
    _add_source(bake)
    _add_labels(bake)
    bake.add_argument("--model", metavar="MODEL.npz", help="the one that Labial comes with that knows the phonemes, "
                      "without it")
    bake.add_argument("--name", help="of the C symbols; the header's file name without it")
    bake.add_argument("--quiet", action="store_true", help="no progress bar")
    bake.set_defaults(run=_bake)

    export = commands.add_parser("export", help="write a model as C tables")
    export.add_argument("model", metavar="MODEL.npz")
    export.add_argument("--name", required=True, help="of the C symbol and the files")
    export.add_argument("-o", "--output", required=True, metavar="DIR")
    export.add_argument("--blob", action="store_true", help="write NAME.lbm for labial_model_load() too")
    _add_export_options(export)
    export.set_defaults(run=_export)

    check = commands.add_parser("check", help="compare the C library with the float64 reference")
    check.add_argument("model", metavar="MODEL.npz")
    check.add_argument("phones", metavar="PHONES", nargs="+", help="phoneme timings, as for synth")
    check.add_argument("--library", metavar="DIR", help="folder of the C library; that of this package without it")
    _add_source(check)
    _add_labels(check)
    _add_export_options(check)
    check.set_defaults(run=_check)

    evaluate = commands.add_parser("evaluate", help="compare all methods with the human's motion on held-out episodes")
    evaluate.add_argument("corpus", nargs="+", help="as for train; episodes of the first are held out, and Labial's "
                          "models are trained on all of the others too")
    evaluate.add_argument("-o", "--output", required=True, metavar="REPORT", help="folder for tables and plots")
    evaluate.add_argument("--kind", choices=("speech", "laughter"), default="speech")
    evaluate.add_argument("--splits", type=_positive, default=20, help="random 80/20 splits by episode (20)")
    evaluate.add_argument("--seed", type=_seed, default=0)
    evaluate.add_argument("--methods", default="all", metavar="A,B,...", help="methods to compare (all)")
    evaluate.add_argument("--fps", type=_positive, default=50, help="frames per second (50)")
    evaluate.add_argument("--jobs", type=_positive, default=2, help="splits at a time (2); the result is the same")
    _add_engine(evaluate)
    evaluate.add_argument("--hold-out-words", default="", metavar="W1,W2,...",
                          help="train without the episodes that hold these words, judge these words' frames alone")
    evaluate.add_argument("--leave-out-talkers", action="store_true", help="train without each talker of the second "
                          "and further corpora in turn, judge that talker, in place of random splits")
    evaluate.add_argument("--quiet", action="store_true", help="no progress bar")
    evaluate.set_defaults(run=_evaluate)

    laughter = commands.add_parser("laughter-corpus", help="generate the synthetic laughter corpus")
    laughter.add_argument("output", metavar="OUT", help="folder, new or empty")
    laughter.add_argument("--episodes", type=_positive, default=200)
    laughter.add_argument("--seed", type=_seed, default=0)
    laughter.set_defaults(run=_laughter_corpus)

    rig = commands.add_parser("rig", help="write a description of servos or blendshapes as a C table")
    rig.add_argument("description", metavar="FACE.toml")
    rig.add_argument("-o", "--output", required=True, metavar="DIR")
    rig.add_argument("--name", help="of the C symbol and the files; the description's file name without it")
    rig.add_argument("--no-figure", action="store_true", help="do not draw NAME.svg")
    rig.set_defaults(run=_rig)

    plot = commands.add_parser("plot", help="draw trajectories with their phonemes")
    plot.add_argument("frames", metavar="FRAMES", nargs="+", help="frames files (.csv) or .fap; several are overlaid")
    plot.add_argument("--phones", metavar="FILE", help="phoneme timings, as for synth")
    _add_source(plot)
    _add_labels(plot)
    plot.add_argument("-o", "--output", required=True, metavar="OUT.png", help=".png, .svg or .pdf")
    plot.add_argument("--channels", metavar="A,B,...", help="fap3, open_jaw, ..., opening, stretch or all; one panel "
                      "each (fap3,opening,stretch,fap17)")
    plot.set_defaults(run=_plot)

    page = commands.add_parser("page", help="write a page that plays motion")
    page.add_argument("frames", metavar="FRAMES", help="a frames file (.csv), .fap, or a model (.npz), which speaks "
                      "the timings")
    page.add_argument("--phones", metavar="FILE", help="phoneme timings, as for synth")
    _add_source(page)
    _add_labels(page)
    page.add_argument("--audio", metavar="FILE", help="sound in step: WAV, MP3, Ogg, FLAC, AAC, M4A or WebM")
    page.add_argument("--title", help="the file's name without it")
    page.add_argument("-o", "--output", required=True, metavar="OUT.html")
    page.set_defaults(run=_page)

    landmarks = commands.add_parser("landmarks", help="track the face in a video, for record")
    landmarks.add_argument("video", metavar="VIDEO")
    landmarks.add_argument("-o", "--output", required=True, metavar="LANDMARKS.npz")
    landmarks.add_argument("--face", choices=("largest", "left", "right"), help="which is the talker's, where there is "
                           "more than one, as seen in the picture")
    landmarks.add_argument("--task", metavar="FILE", help="the model of MediaPipe's Face Landmarker, "
                           "face_landmarker.task, for a MediaPipe that brings none")
    landmarks.add_argument("--quiet", action="store_true", help="no progress bar")
    landmarks.set_defaults(run=_landmarks)

    record = commands.add_parser("record", help="make a corpus of tracked video (face landmarks)")
    record.add_argument("landmarks", metavar="LANDMARKS", nargs="+", help="one talker's .npz, .npy or .csv files, or "
                        "folders of them, each with its phoneme timings (NAME.lab, .TextGrid, ...) beside it")
    record.add_argument("-o", "--output", required=True, metavar="CORPUS", help="folder, new or empty")
    record.add_argument("--kind", choices=("speech", "laughter"), default="speech")
    record.add_argument("--fps", type=_number, metavar="RATE", help="frames per second, where the files do not tell")
    record.add_argument("--size", metavar="WIDTHxHEIGHT", help="of the video in pixels, where coordinates are shares "
                        "of it and the files do not tell")
    record.add_argument("--offset", type=_number, default=0.0, metavar="MS", help="how much later than its sound the "
                        "picture is, negative where it is earlier (0); an estimate is printed")
    record.add_argument("--cutoff", type=_number, default=12.0, metavar="HZ",
                        help="what moves faster is smoothed as the tracker's noise; 0 smooths nothing (12)")
    record.set_defaults(run=_record)
    return top


def _add_engine(command: argparse.ArgumentParser) -> None:
    command.add_argument("--engine", metavar="dask=ADDRESS", help="work on the Dask cluster whose scheduler is at "
                         "ADDRESS, in place of this machine's processes; the result is the same")


def _add_format(command: argparse.ArgumentParser) -> None:
    from labial.animation import FORMATS

    names: Dict[str, List[str]] = {}
    for name, item in FORMATS.items():
        names.setdefault(item.about, []).append(name)
    about = "; ".join(f"{', '.join(same)}: {text}" for text, same in names.items())
    command.add_argument("--to", choices=tuple(FORMATS), metavar="FORMAT", default="csv", help=f"{about} (csv)")


def _add_source(command: argparse.ArgumentParser) -> None:
    from labial.corpus.formats import READERS

    command.add_argument("--from", dest="source", choices=tuple(READERS), metavar="FORMAT",
                         help=f"format of the timings: {', '.join(READERS)} (told by the file)")


def _add_labels(command: argparse.ArgumentParser) -> None:
    command.add_argument("--labels", choices=("auto", "arpabet", "ipa", "xsampa"), default="auto",
                         help="what set the phonemes' labels are of; auto takes any, and where they differ X-SAMPA "
                         "in .pho and MaryTTS, the IPA of Piper, HeadTTS and Kokoro, elsewhere ARPABET (auto)")


def _add_said(command: argparse.ArgumentParser) -> None:
    said = command.add_mutually_exclusive_group()
    said.add_argument("--text", help="what is said in a sound; without it the likeliest words are looked for, which is "
                      "less sure")
    said.add_argument("--text-file", metavar="FILE", help="a file with the text, UTF-8")


def _add_export_options(command: argparse.ArgumentParser) -> None:
    command.add_argument("--amplitude", type=_number, default=1.0, metavar="FACTOR",
                         help="widen (over 1) or calm (below 1) the motion about its mean; 1 is the least error (1)")
    command.add_argument("--predecessors", type=_positive, default=PREDECESSORS,
                         help=f"transitions kept into each state ({PREDECESSORS})")


def _train(options: argparse.Namespace) -> int:
    with needs("training", "train"):
        from labial.train import backed_off, train
    from labial.corpus import read_corpora
    from labial.model import save

    own = {}  # what only --method labial has
    if options.look_ahead is not None:
        own["look_ahead"] = options.look_ahead / 1000.0
    if options.search_stride is not None:
        own["search_stride"] = options.search_stride
    if own and options.method == "paper":
        names = " and ".join("--" + name.replace("_", "-") for name in own)
        warnings.warn(f"{names}: of no effect with --method paper", stacklevel=1)
    episodes = [episode for corpus in read_corpora(options.corpus, options.kind) for episode in corpus]
    model = train(episodes, kind=options.kind, method=options.method, fps=options.fps,
                  codebook=options.codebook, components=options.components, seed=options.seed, jobs=options.jobs,
                  engine=options.engine, progress=not options.quiet and sys.stderr.isatty(),
                  attribution=options.attribution, **own)
    save(model, options.output)
    for line in backed_off(model):
        print(line)
    print(f"{options.output}: {len(model.phonemes)} phonemes, {int(model.component_count.sum())} components, "
          f"{model.log_initial.shape[1]} states, {len(model.kernel_lag)} kernel taps")
    return 0


def _synth(options: argparse.Namespace) -> int:
    from labial.animation import FORMATS
    from labial.model import load
    from labial.phones import read_stream
    from labial.reference import published, stream
    from labial.reference.tables import FloatTables

    model = load(options.model)
    tables, phonemes = FloatTables(model), read_stream(options.phones, model, options.labels, options.source)
    write, whole = FORMATS[options.to].write, options.whole
    if options.rig:
        write = _rig_writer(options)
    frames = published.synthesise(tables, phonemes, whole=True) if whole else stream.synthesise(tables, phonemes)
    name = Path(options.model).stem
    if options.output:
        with open(options.output, "w", encoding="ascii", newline="\n") as out:
            write(out, frames, model.fps, name)
    else:
        write(sys.stdout, frames, model.fps, name)
    return 0


def _rig_writer(options: argparse.Namespace) -> Callable[..., None]:
    from labial.animation import write_json_lines
    from labial.rig.description import read

    if options.to != "jsonl":
        raise LabialError("--rig goes with --to jsonl")
    name = Path(options.rig).stem
    if name in ("frame", "time", "faps"):
        raise LabialError(f"{options.rig}: {name!r} is taken in a line of JSON: name the file otherwise")
    return functools.partial(write_json_lines, rig=read(options.rig, name))


def _timings(options: argparse.Namespace) -> int:
    from labial.corpus.formats import as_lab

    _put(as_lab(options.phones, options.labels, options.source), options.output)
    return 0


def _align(options: argparse.Namespace) -> int:
    with needs("aligning", "align"):
        from labial.align.command import run

    text = run(options.sound, options.text, options.text_file,
               progress=not options.quiet and sys.stderr.isatty())
    _put(text, options.output)
    return 0


def _bake(options: argparse.Namespace) -> int:
    from labial.bake.command import run
    from labial.bake.source import Source

    source = Source(options.file, options.model, options.text, options.text_file, options.labels, options.source,
                    progress=not options.quiet and sys.stderr.isatty())
    for path in run(source, options.output, options.kind, options.rig, options.name):
        print(path)
    return 0


def _put(text: str, path: Optional[str]) -> None:
    """Writes to a file, or to standard output without one."""
    if path:
        with open(path, "w", encoding="utf-8", newline="\n") as out:
            out.write(text)
    else:
        sys.stdout.write(text)


def _widened(model: Model, factor: float) -> Model:
    from labial.amplitude import widened

    if not 0.0 <= factor <= 4.0:
        raise LabialError(f"amplitude {factor} is not within 0 .. 4")
    return model if factor == 1.0 else widened(model, factor)


def _export(options: argparse.Namespace) -> int:
    from labial import emit, report
    from labial.loss import measure
    from labial.model import load
    from labial.phones import drawn_streams
    from labial.quantise import quantise

    emit.check_name(options.name)
    model = _widened(load(options.model), options.amplitude)
    exported = quantise(model, options.name, predecessors=options.predecessors)
    loss = measure(model, exported, drawn_streams(model))
    for path in emit.write(exported, options.output, binary=options.blob):
        print(path)
    print(report.memory(exported))
    print(report.quantisation(loss, model, exported))
    return 0


def _check(options: argparse.Namespace) -> int:
    from labial.check import compare
    from labial.model import load
    from labial.phones import read_stream
    from labial.quantise import quantise

    model = _widened(load(options.model), options.amplitude)
    exported = quantise(model, "checked_model", predecessors=options.predecessors)
    streams = [read_stream(path, model, options.labels, options.source) for path in options.phones]
    comparison = compare(model, exported, streams, options.library)
    print(comparison.table())
    failures = comparison.failures()
    for failure in failures:
        print(f"labial check: {failure}", file=sys.stderr)
    return 1 if failures else 0


def _evaluate(options: argparse.Namespace) -> int:
    with needs("evaluating", "train,evaluate"):
        from labial.evaluate.command import run
        from labial.evaluate.protocol import Options

    words = tuple(word.strip() for word in options.hold_out_words.split(",") if word.strip())
    if words and options.leave_out_talkers:
        raise LabialError("--hold-out-words and --leave-out-talkers do not go together")
    asked = Options(options.kind, options.methods, options.splits, options.seed, options.fps, words,
                    options.leave_out_talkers)
    for path in run(options.corpus, options.output, asked, jobs=options.jobs, engine=options.engine,
                    progress=not options.quiet and sys.stderr.isatty()):
        print(path)
    return 0


def _laughter_corpus(options: argparse.Namespace) -> int:
    from labial.corpus.laughter import generate

    generate(options.output, episodes=options.episodes, seed=options.seed)
    print(f"{options.output}: {options.episodes} synthetic episodes")
    return 0


def _rig(options: argparse.Namespace) -> int:
    from labial.rig.command import run

    for path in run(options.description, options.output, name=options.name, drawing=not options.no_figure):
        print(path)
    return 0


def _plot(options: argparse.Namespace) -> int:
    with needs("plotting", "plot"):
        from labial.see.plot import DEFAULT, plot
    from labial.see.motion import read_bands, read_motions

    plot(read_motions(options.frames), read_bands(options.phones, options.labels, options.source), options.output,
         options.channels or DEFAULT)
    return 0


def _page(options: argparse.Namespace) -> int:
    from labial.see.motion import read_bands, read_motion, spoken
    from labial.see.page import page

    bands = read_bands(options.phones, options.labels, options.source)
    if Path(options.frames).suffix.lower() == ".npz":
        if options.phones is None:
            raise LabialError(f"{options.frames}: a model speaks phoneme timings: give --phones")
        motion = spoken(options.frames, options.phones, options.labels, options.source)
    else:
        motion = read_motion(options.frames)
    text = page(motion, bands, options.audio, options.title)
    with open(options.output, "w", encoding="utf-8", newline="\n") as out:
        out.write(text)
    return 0


def _landmarks(options: argparse.Namespace) -> int:
    with needs("tracking", "record"):
        from labial.record.track import landmarks

    print(landmarks(options.video, options.output, options.face, options.task,
                    progress=not options.quiet and sys.stderr.isatty()))
    return 0


def _record(options: argparse.Namespace) -> int:
    with needs("recording", "train"):
        from labial.record.record import record
    from labial.phonesets import PHONE_SETS
    from labial.record.landmarks import Given, parse_size

    size = parse_size(options.size) if options.size else None
    print(record(options.landmarks, options.output, PHONE_SETS[options.kind], Given(options.fps, size), options.cutoff,
                 options.offset / 1000))
    return 0


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status: 0; 1 when something given cannot be used; 3 for a defect of ours."""
    options = parser().parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # names of files are written as they are
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: _complain(f"warning: {message}")
        try:
            with needs(f"labial {options.command}", "tools"):
                return int(options.run(options))
        except LabialError as error:
            _complain(str(error))
        except BrokenPipeError:  # whoever reads the output has seen enough
            sys.stderr.close()
        except OSError as error:
            _complain(f"{_name(error)}: {error.strerror or error}")
        except MemoryError:
            _complain("there is not enough memory for this")
        except KeyboardInterrupt:
            _complain("interrupted")
            return 130
        except Exception as error:
            _complain(_defect(error))
            return 3
    return 1


def _complain(text: str) -> None:
    print(f"labial: {_one_line(text)}", file=sys.stderr)


def _name(error: OSError) -> str:
    return os.fsdecode(error.filename) if isinstance(error.filename, (str, bytes, os.PathLike)) else "the output"


def _defect(error: Exception) -> str:
    """What to say of an error that is none of the user's."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return (f"this is a defect of labial, please report it: {type(error).__name__}: {error} "
            f"({Path(place.filename).name}, line {place.lineno})")


if __name__ == "__main__":
    sys.exit(main())
