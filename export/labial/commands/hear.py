"""``labial hear``: motion from the sound of speech, and from its words where they are given or found."""

from __future__ import annotations

import argparse
import functools
import importlib.util
import sys
import warnings
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from labial.commands.common import add_format, add_phones, add_said, format_of, opened, said
from labial.errors import DataError, LabialError, needs
from labial.files import wav
from labial.files.grammar import whole
from labial.files.outputs import check

if TYPE_CHECKING:
    import numpy as np

    from labial.corpus.episode import Segment
    from labial.runtime.hearing import Hearing

#: Rates that labial/hear.h lists.
_RATES = (8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000)
#: The sound's share beside words that were found in it, and the frames to both sides in which it passes to another one.
_FOUND, _PASSING = 0.5, 5
#: Bytes that are read at once: 20 ms of 16 kHz, so that frames of a pipe are written as they come.
_BLOCK = 640
#: What is heard without conversion.
_PLAIN = "a WAV file of 16 bits, one or two channels and a usual rate"


def add_hear(command: argparse.ArgumentParser) -> None:
    command.add_argument("sound", metavar="SOUND", help="speech: a WAV file; a file of another format, if "
                         "the extra align is installed; or - for standard input: a WAV file, or samples of 16 bits "
                         "without a header, low byte first")
    command.add_argument("-o", "--output", metavar="FRAMES", help="standard output without it")
    add_format(command)
    command.add_argument("--model", choices=("small", "large", "host", "ahead"),
                         default="host", help="the network: small and large are those of small chips, host is better; "
                         "ahead looks 160 ms further ahead, and knows a frame 280 ms after its begin instead of 120 "
                         "(host)")
    add_said(command)
    add_phones(command)
    command.add_argument("--sound-alone", action="store_true", help="look for no words. Without this, and without a "
                         "text or phonemes, English words are looked for where the extra align is installed")
    command.add_argument("--exact", action="store_true",
                         help="exactly the frames of the sound: the face does not come to rest after the last one")
    command.add_argument("--rate", type=functools.partial(whole, 1, 1_000_000), metavar="RATE",
                         help=f"of samples without a header: one of {', '.join(map(str, _RATES))} a second (16000)")
    command.add_argument("--channels", type=functools.partial(whole, 1, 2), metavar="N",
                         help="of samples without a header: 1 or 2 channels (1)")


def run_hear(options: argparse.Namespace) -> None:
    import numpy as np

    from labial.runtime.hearing import FPS, Hearing

    check(options.output)
    form = format_of(options)
    told = [name for name, value in (("--text", options.text), ("--text-file", options.text_file),
                                     ("--phones", options.phones)) if value is not None]
    if told and (options.sound == "-" or options.sound_alone):
        raise LabialError(f"{told[0]} does not go with {'-' if options.sound == '-' else '--sound-alone'}")
    if options.phones is not None and len(told) > 1:
        raise LabialError(f"--phones does not go with {told[0]}")
    if options.sound != "-" and (options.rate or options.channels):
        raise LabialError("--rate and --channels go with -, a sound from standard input")
    whole_sound: Optional[bytes] = None
    if options.sound == "-":
        rate, channels, blocks = _piped(options.rate or 16000, options.channels or 1)
    else:
        rate, channels, whole_sound = sound_of(options.sound)
        blocks = iter([whole_sound])
    words = None if whole_sound is None else _words(options)
    with Hearing(rate, channels, model=f"hear_{options.model}", exact=options.exact or words is not None) as hearing:
        if whole_sound is not None:
            hearing.measure(whole_sound)
        parts = _parts(hearing, blocks)
        if words is not None:
            parts = iter([_mixed(words, np.concatenate(list(parts)), options.exact)])
        count = 0
        if options.to == "fap":  # whose head has the number of frames
            whole_motion = np.concatenate([np.zeros((0, 13)), *parts])
            parts, count = iter([whole_motion]), len(whole_motion)
        with opened(options.output) as out:
            form.write(out, _flushed(parts, out), FPS, Path(options.sound).stem, count)


class _Words(NamedTuple):
    """What a sound says."""

    timings: List[Tuple[str, float]]  #: phonemes with their milliseconds
    share: float  #: of the sound's frames in the mixed ones
    unsure: List[Tuple[float, float]]  #: seconds in which the words may be others, so that the sound alone is heard


def _words(options: argparse.Namespace) -> Optional[_Words]:
    """The phonemes of a file's sound: given ones, those of its text or of words that are found; None without any."""
    from labial.runtime.hearing import SHARE

    if options.phones is not None:
        from labial.runtime.render import read_timings

        return _Words(read_timings(options.phones, labels=options.labels, source=options.source,
                                   tier=options.tier), SHARE, [])
    text = said(options)
    if options.sound_alone or (text is None and importlib.util.find_spec("pocketsphinx") is None):
        return None
    with needs("finding a text in a sound", "align"):
        from labial.sound.align import aligned
        from labial.sound.recogniser import LOW
    if text is not None:
        return _Words(_timings(aligned(options.sound, text).segments), SHARE, [])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # where words are unsure, the sound alone counts
        found = aligned(options.sound)
    unsure = [(item.start, item.end) for item in found.stretches if item.confidence < LOW]
    return _Words(_timings(found.segments), _FOUND, unsure) if len(unsure) < len(found.stretches) else None


def _timings(segments: Sequence[Segment]) -> List[Tuple[str, float]]:
    return [(item.label, 1000 * (item.end - item.start)) for item in segments]


def _mixed(words: _Words, heard: np.ndarray, exact: bool) -> np.ndarray:
    """(n, 13) frames of the phonemes with their share of those that are heard (T, 13), and the way to rest."""
    import numpy as np

    from labial.reference.fade import eased, rests
    from labial.runtime.hearing import FPS, with_sound
    from labial.runtime.render import render

    count = len(heard)
    share = np.full(count, words.share)
    for begin, end in words.unsure:
        share[round(begin * FPS) : round(end * FPS)] = 1.0
    if words.unsure and count:
        width = 2 * _PASSING + 1
        share = np.clip(np.convolve(np.pad(share, _PASSING, mode="edge"), np.full(width, 1 / width), "valid"), 0, 1)
    timings = list(words.timings)
    after = timings.pop()[1] if timings and timings[-1][0] == "SIL" else 0.0  # silence, one with that behind the sound
    spoken = render([*timings, ("SIL", after + 1000 * (count + 1) / FPS)], exact=True)[:count]
    frames = np.array(with_sound(spoken, heard.tolist(), share.tolist()), dtype=np.float64)
    frames = frames.reshape(-1, 13)
    if exact or not count or rests(frames[-1]):
        return frames
    return np.concatenate([frames, np.rint(eased(frames[-1]))])


def sound_of(path: str) -> Tuple[int, int, bytes]:
    """Rate, channels and samples of a file, converted as for ``labial align`` unless it is a WAV file of 16 bits."""
    try:
        with open(path, "rb") as content, wav.Sound(content) as file:
            if _is_plain(file):
                blocks = _in_phase(wav.blocks(file, path), file.getnchannels(), path)
                return file.getframerate(), file.getnchannels(), b"".join(blocks)
    except OSError as error:
        raise DataError(path, None, error.strerror or str(error)) from None
    except wav.ERRORS:
        pass
    import numpy as np

    with needs(f"{path}: a sound that is not {_PLAIN}", "align"):
        from labial.sound.samples import read_sound
    return 16000, 1, np.clip(np.rint(read_sound(path) * 32767), -32768, 32767).astype("<i2").tobytes()


def _is_plain(file: wav.Sound) -> bool:
    """Whether a file is heard without conversion."""
    return file.getsampwidth() == 2 and file.getnchannels() <= 2 and file.getframerate() in _RATES


def _in_phase(blocks: Iterator[bytes], channels: int, path: str) -> Iterator[bytes]:
    """Blocks of 16 bits. Of two channels that cancel each other to silence, the second becomes the first."""
    import numpy as np

    phase = wav.Phase(path)
    for block in blocks:
        whole = len(block) // 4 * 4
        if channels == 2:
            samples = np.frombuffer(block[:whole], "<i2").reshape(-1, 2)
            if phase.cancels(samples):
                block = np.repeat(samples[:, :1], 2, axis=1).tobytes() + block[whole:]
        yield block


def _piped(rate: int, channels: int) -> Tuple[int, int, Iterator[bytes]]:
    """Rate, channels and samples of standard input: of a WAV file, or as given for samples without a header."""
    if rate not in _RATES:  # before waiting for the sound
        raise LabialError(f"{rate} samples per second are not one of {', '.join(map(str, _RATES))}")
    if sys.stdin is None:
        raise LabialError("standard input is closed")
    sound, name = sys.stdin.buffer, "standard input"
    head = sound.read(wav.HEAD)
    if head[:4] not in (b"RIFF", b"RF64", b"BW64") or head[8:] != b"WAVE":
        blocks = chain([head], iter(lambda: sound.read(_BLOCK), b""))
        return rate, channels, _in_phase(blocks, channels, name)
    with suppress(*wav.ERRORS):
        file = wav.Sound(sound, head)
        if _is_plain(file):
            rate, channels = file.getframerate(), file.getnchannels()
            return rate, channels, _in_phase(wav.blocks(file, name, _BLOCK // (2 * channels)), channels, name)
    raise DataError(name, None, f"a sound with a header must be {_PLAIN}")


def _parts(hearing: Hearing, blocks: Iterator[bytes]) -> Iterator[np.ndarray]:
    """(n, 13) frames as they become known."""
    import numpy as np

    for block in blocks:
        if found := hearing.push(block):
            yield np.array([frame.faps for frame in found], dtype=np.float64)
    yield np.array([frame.faps for frame in hearing.end()], dtype=np.float64).reshape(-1, 13)


def _flushed(parts: Iterator[np.ndarray], out: Any) -> Iterator[np.ndarray]:
    """The same; what was written before is on its way when the next part is asked for."""
    for part in parts:
        yield part
        out.flush()
