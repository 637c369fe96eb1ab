"""``labial hear``: motion from the sound of speech alone."""

from __future__ import annotations

import argparse
import functools
import sys
import wave
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ContextManager, Iterator, List, Tuple

from labial.commands.common import add_format, format_of
from labial.errors import DataError, LabialError
from labial.files import wav
from labial.files.arguments import whole

if TYPE_CHECKING:
    import numpy as np

    from labial.runtime.hearing import Hearing

#: Rates that labial/hear.h lists.
_RATES = (8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000)
#: Bytes that are read at once: 20 ms of 16 kHz, so that frames of a pipe are written as they come.
_BLOCK = 640


def add_hear(command: argparse.ArgumentParser) -> None:
    """A sound, and the format of the frames."""
    command.add_argument("sound", metavar="SOUND", help="speech: a WAV file; a file of another format, if "
                         "the extra align is installed; or - for 16-bit samples from standard input, low byte first")
    command.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    add_format(command)
    command.add_argument("--model", choices=("small", "large"), default="small",
                         help="the network: small, or large, which is better and costs half as much again (small)")
    command.add_argument("--exact", action="store_true",
                         help="exactly the frames of the sound: the face does not come to rest after the last one")
    command.add_argument("--rate", type=functools.partial(whole, 1, 1_000_000), metavar="RATE",
                         help=f"with -: samples per second, one of {', '.join(map(str, _RATES))} (16000)")
    command.add_argument("--channels", type=functools.partial(whole, 1, 2), metavar="N",
                         help="with -: 1 or 2 channels (1)")


def run_hear(options: argparse.Namespace) -> int:
    """Writes the frames."""
    import numpy as np

    from labial.files.outputs import check, writing
    from labial.runtime.hearing import FPS, Hearing

    check(options.output)
    form = format_of(options)
    if options.sound != "-" and (options.rate or options.channels):
        raise LabialError("--rate and --channels go with -, a sound from standard input")
    if options.sound == "-":
        rate, channels, whole_sound = options.rate or 16000, options.channels or 1, None
        blocks = iter(lambda: sys.stdin.buffer.read(_BLOCK), b"")
    else:
        rate, channels, whole_sound = _sound(options.sound)
        blocks = iter([whole_sound])
    with Hearing(rate, channels, model=f"hear_{options.model}", exact=options.exact) as hearing:
        if whole_sound is not None:
            hearing.measure(whole_sound)
        parts = _parts(hearing, blocks)
        count = 0
        if options.to == "fap":  # whose head has the number of frames
            whole_motion = np.concatenate([np.zeros((0, 13)), *parts])
            parts, count = iter([whole_motion]), len(whole_motion)
        opened: ContextManager[Any] = writing(options.output, "ascii") if options.output else nullcontext(sys.stdout)
        with opened as out:
            form.write(out, _flushed(parts, out), FPS, Path(options.sound).stem, count)
    return 0


def _sound(path: str) -> Tuple[int, int, bytes]:
    """Rate, channels and samples of a file. A WAV file of 16 bits is heard as it is, all else as the reader of ``labial
    align`` converts it."""
    try:
        with wave.open(path, "rb") as file:
            if file.getsampwidth() == 2 and file.getnchannels() <= 2 and file.getframerate() in _RATES:
                return file.getframerate(), file.getnchannels(), b"".join(wav.blocks(file))
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    except wav.ERRORS:
        pass
    return 16000, 1, _converted(path)


def _converted(path: str) -> bytes:
    import numpy as np

    from labial.errors import needs

    with needs(f"{path}: a sound that is not a WAV file of 16 bits, one or two channels and a usual rate", "align"):
        from labial.sound.samples import read_sound
    data: bytes = np.clip(np.rint(read_sound(path) * 32767), -32768, 32767).astype("<i2").tobytes()
    return data


def _parts(hearing: Hearing, blocks: Iterator[bytes]) -> Iterator[np.ndarray]:
    """(n, 13) frames as they become known."""
    import numpy as np

    for block in blocks:
        found: List[Any] = hearing.push(block)
        if found:
            yield np.array([frame.faps for frame in found], dtype=np.float64)
    rest = hearing.end()
    yield np.array([frame.faps for frame in rest], dtype=np.float64).reshape(-1, 13)


def _flushed(parts: Iterator[np.ndarray], out: Any) -> Iterator[np.ndarray]:
    """The same; what was written before is on its way when the next part is asked for."""
    for part in parts:
        yield part
        out.flush()
