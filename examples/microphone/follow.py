#!/usr/bin/env python3
"""A mouth in the terminal that follows the microphone.

    python3 follow.py                    # the microphone, until Ctrl-C
    python3 follow.py --sound hello.wav  # a file in its place, as fast as it is spoken
    python3 follow.py --to jsonl         # an object per frame for another program: number, FAPs, ARKit's blendshapes

The microphone is read by the package sounddevice where that is installed (`pip install sounddevice`), else by arecord.
A frame is shown `latency` of labial.Hearing after its sound, plus what the sound device needs.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
import wave
from typing import Callable, Iterator, List, Optional, Tuple

import labial
from labial.errors import LabialError, apt, missing
from labial.program import Parser, complain, run

#: Of the microphone: samples per second, of one channel.
RATE = 16000
#: Samples that are heard at once, 10 ms.
BLOCK = RATE // 100
#: FAP units between the lips that fill the bar.
WIDE, BAR = 600, 40


def microphone() -> Iterator[bytes]:
    """Blocks of 16-bit samples from the default microphone, without end."""
    try:
        import sounddevice
    except (ImportError, OSError):  # not installed; or it is, and the library PortAudio is not
        yield from arecord()
        return
    try:
        with sounddevice.RawInputStream(samplerate=RATE, channels=1, dtype="int16", blocksize=BLOCK) as stream:
            while True:
                block, lost = stream.read(BLOCK)
                if lost:
                    complain("follow", "this computer is too slow: sound was lost")
                yield bytes(block)
    except sounddevice.PortAudioError as error:
        raise LabialError(f"the microphone: {error}") from None


def arecord() -> Iterator[bytes]:
    """The same from ALSA's program."""
    try:
        recorder = subprocess.Popen(["arecord", "-q", "-t", "raw", "-f", "S16_LE", "-c", "1", "-r", str(RATE)],
                                    stdout=subprocess.PIPE)
    except FileNotFoundError:
        raise missing("the microphone", "sounddevice or arecord",
                      f"pip install sounddevice, or {apt('alsa-utils')}") from None
    assert recorder.stdout is not None
    try:
        while block := recorder.stdout.read(2 * BLOCK):
            yield block
        if recorder.wait() != 0:
            raise LabialError("arecord cannot record")
    finally:
        recorder.kill()
        recorder.wait()
        recorder.stdout.close()


def file(path: str, sleep: Callable[[float], None] = time.sleep,
         clock: Callable[[], float] = time.monotonic) -> Tuple[int, int, Iterator[bytes]]:
    """Rate, channels and blocks of a WAV file of 16 bits; a block comes when a microphone would have it."""
    try:
        sound = wave.open(path, "rb")  # closed by the generator
    except (wave.Error, EOFError) as error:
        raise LabialError(f"{path}: {str(error) or 'the file is cut off'}") from None
    if sound.getsampwidth() != 2:
        raise LabialError(f"{path}: {8 * sound.getsampwidth()} bits per sample, not 16")

    def blocks() -> Iterator[bytes]:
        with sound:
            begin, read = clock(), 0
            while block := sound.readframes(sound.getframerate() // 100):
                read += sound.getframerate() // 100
                sleep(max(begin + read / sound.getframerate() - clock(), 0.0))
                yield block

    return sound.getframerate(), sound.getnchannels(), blocks()


def bar(frame: labial.Frame) -> str:
    """The opening of the mouth as a line that replaces itself."""
    opening = -(frame.faps[3] + frame.faps[4])  # FAP 51 and 52, the lips' distances from rest
    filled = min(max(round(opening * BAR / WIDE), 0), BAR)
    return "\r|" + "#" * filled + " " * (BAR - filled) + "|"


def line(frame: labial.Frame) -> str:
    """The frame for another program."""
    return json.dumps({"frame": frame.number, "faps": frame.faps, "arkit": frame.rig("arkit")}) + "\n"


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line."""
    parser = Parser(prog="follow", description="Follows the microphone with a mouth.")
    parser.add_argument("--sound", metavar="FILE.wav", help="in place of the microphone")
    parser.add_argument("--to", choices=("bar", "jsonl"), default="bar", help="a bar in the terminal, or text (bar)")
    parser.add_argument("--model", choices=("small", "large", "host", "ahead"), default="host")
    options = parser.parse_args(arguments)
    write = bar if options.to == "bar" else line
    try:
        rate, channels, blocks = file(options.sound) if options.sound else (RATE, 1, microphone())
        with labial.Hearing(rate, channels, model=f"hear_{options.model}") as hearing:
            for frame in hearing.frames(blocks):
                sys.stdout.write(write(frame))
                sys.stdout.flush()
    except KeyboardInterrupt:
        pass
    if options.to == "bar":
        print()
    return 0


if __name__ == "__main__":
    sys.exit(run("follow", main))
