"""Shared parts of commands: groups of arguments, progress and output."""

from __future__ import annotations

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ContextManager, Dict, List, Optional, Tuple

from labial.defaults import FPS, KINDS
from labial.errors import LabialError
from labial.files.grammar import finite, positive, read_text
from labial.files.outputs import check_suffix, writing

if TYPE_CHECKING:
    import numpy as np

    from labial.rig.animation import Format
    from labial.rig.description import Rig as Description


def add_kind(command: argparse.ArgumentParser) -> None:
    command.add_argument("--kind", choices=KINDS, default=KINDS[0])


def add_fps(command: argparse.ArgumentParser) -> None:
    command.add_argument("--fps", type=positive, default=FPS, help=f"frames per second ({FPS})")


def add_talker_variance(command: argparse.ArgumentParser) -> None:
    """``--talker-variance``; see :mod:`labial.train.talkers`."""
    command.add_argument("--talker-variance", type=finite, metavar="V", help="--method labial: learn what talkers "
                         "share and let each stray from it, by this variance relative to that of what is shared (1 "
                         "is what was chosen on talkers left out); a corpus's weight then counts for each of its "
                         "talkers")


def add_engine(command: argparse.ArgumentParser) -> None:
    """``--engine``, for :class:`labial.train.workers.Workers`."""
    command.add_argument("--engine", metavar="dask=ADDRESS", help="work on the Dask cluster whose scheduler is at "
                         "ADDRESS, in place of this machine's processes; the result is the same")


def add_source(command: argparse.ArgumentParser) -> None:
    """``--from``, the format of timings, as `options.source`, and ``--tier``."""
    from labial.corpus.formats import names

    try:
        known: Optional[Tuple[str, ...]] = names()
    except LabialError:  # without the library; readers of timings report that
        known = None
    command.add_argument("--from", dest="source", choices=known, metavar="FORMAT",
                         help=f"format of the timings: {', '.join(known or ())} (default: told by the file's contents)")
    command.add_argument("--tier", metavar="NAME", help="the tier of a TextGrid; without it that of phones")


def add_format(command: argparse.ArgumentParser) -> None:
    """``--to`` and ``--rig``, the format of frames, for :func:`format_of`."""
    from labial.rig.animation import FORMATS

    names: Dict[str, List[str]] = {}
    for name, item in FORMATS.items():
        names.setdefault(item.about, []).append(name)
    about = "; ".join(f"{', '.join(same)}: {text}" for text, same in names.items())
    command.add_argument("--to", choices=tuple(FORMATS), metavar="FORMAT", help=f"{about} (default: that of "
                         "the output's extension, else csv)")
    command.add_argument("--rig", metavar="FACE.toml", help="with --to jsonl: a face of your own in place of ARKit's, "
                         "as labial rig reads it")


class Limited:
    """A rig's outputs within their limits of speed, as the library moves them, from rest on."""

    def __init__(self, rig: Description) -> None:
        from labial.runtime.rig import Rig

        self._unit, self._rig = rig.unit, Rig.of(rig)

    def __call__(self, frames: np.ndarray, shares: Optional[np.ndarray], first: int) -> Dict[str, np.ndarray]:
        """What ``animation.outputs`` gives, for frames from number `first` on, which go on from those before."""
        import numpy as np

        from labial.files.frames import whole_faps, whole_shares

        if first == 0:  # another motion
            self._rig.rest()
        values = self._rig.play(whole_faps(frames), 65535, None if shares is None else whole_shares(shares))
        found = np.array(values, dtype=np.float64).reshape(len(frames), len(self._rig.outputs)) / self._unit.scale
        return dict(zip(self._rig.outputs, found.T))


def format_of(options: argparse.Namespace) -> Format:
    """The format of frames that the options of :func:`add_format` name."""
    from labial.rig.animation import FORMATS
    from labial.rig.description import read

    if options.to is None:
        options.to = check_suffix(options.output, ".csv", ".fap", ".jsonl")[1:] if options.output else "csv"
    if not options.rig:
        return FORMATS[options.to]
    if options.to != "jsonl":
        raise LabialError("--rig goes with --to jsonl")
    name = Path(options.rig).stem
    if name in ("frame", "time", "faps"):
        raise LabialError(f"{options.rig}: {name!r} is taken in a line of JSON: name the file otherwise")
    rig = read(options.rig, name)
    slow = any(output.slew or output.acceleration or output.deadband for output in rig.outputs)
    return FORMATS[options.to].of_rig(rig, Limited(rig) if slow else None)


def add_labels(command: argparse.ArgumentParser) -> None:
    from labial.corpus.phonesets import AUTO, LABEL_SETS

    command.add_argument("--labels", choices=(AUTO, *LABEL_SETS), default=AUTO,
                         help="what set the phonemes' labels are of; auto takes any, and where they differ X-SAMPA "
                         "in .pho and MaryTTS, the IPA of Piper, HeadTTS and Kokoro, elsewhere ARPABET (auto)")


def add_phones(command: argparse.ArgumentParser) -> None:
    command.add_argument("--phones", metavar="FILE", help="phoneme timings, as for synth")
    add_source(command)
    add_labels(command)


def add_said(command: argparse.ArgumentParser) -> None:
    group = command.add_mutually_exclusive_group()
    group.add_argument("--text", help="what is said in a sound; without it the likeliest words are looked for, which "
                       "is less sure")
    group.add_argument("--text-file", metavar="FILE", help="a file with the text, UTF-8")


def said(options: argparse.Namespace) -> Optional[str]:
    """The text of the sound, None if unknown."""
    return read_text(options.text_file) if options.text_file is not None else options.text


def add_quiet(command: argparse.ArgumentParser, bars: str = "bar") -> None:
    command.add_argument("--quiet", action="store_true", help=f"no progress {bars}")


def shows_progress(options: argparse.Namespace) -> bool:
    """Whether to show a progress bar: on a terminal, unless ``--quiet``."""
    return not options.quiet and sys.stderr.isatty()


def opened(path: Optional[str], encoding: str = "ascii") -> ContextManager[Any]:
    """A file to write text to, or standard output without one."""
    return writing(path, encoding) if path else nullcontext(sys.stdout)


def put(text: str, path: Optional[str]) -> None:
    """Writes a text to a file, or to standard output without one."""
    with opened(path, "utf-8") as out:
        out.write(text)
