#!/usr/bin/env python3
"""A talking head on a Raspberry Pi: text to sound and to servos that move with it.

    python3 speak.py "Hello there."
    python3 speak.py --piper en_US-lessac-medium.onnx < lines.txt

speaks the text, or every line of standard input, with espeak-ng or Piper (pip install 'piper-tts[alignment]'), plays it
with aplay and moves the servos of face.toml in step.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
import time
import wave
from pathlib import Path
from typing import Any, Callable, List, NamedTuple, Optional, Sequence

import labial
from labial.errors import LabialError, apt, missing
from labial.program import Parser, number, run
from servos import Printer, open_servos

#: Look-ahead of the face in frames: more than any servo needs for its full range.
AHEAD = 50


class Utterance(NamedTuple):
    """Something said."""

    sound: bytes  #: 16-bit samples of one channel, little-endian
    rate: int  #: samples per second
    motion: Sequence[Sequence[int]]  #: FAPs of each frame, labial.speech_en.fps of them per second


class Espeak:
    """espeak-ng with one voice or language, such as "en-us", by the program labial-say-espeak."""

    def __init__(self, voice: str = "en-us") -> None:
        self._voice = voice
        self.say("a")  # whether there is such a voice

    def say(self, text: str) -> Utterance:
        """The sound of a text and its motion. Raises LabialError if espeak-ng cannot speak it."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "utterance.wav"
            try:
                done = subprocess.run(["labial-say-espeak", "--voice", self._voice, path, "-"], input=text, check=True,
                                      capture_output=True, encoding="utf-8")
            except FileNotFoundError:
                raise missing("this voice", "labial-say-espeak", "build it (docs/install.md)") from None
            except subprocess.CalledProcessError as error:
                raise LabialError(error.stderr.strip()) from None
            with wave.open(str(path)) as sound:
                motion: List[List[int]] = [[int(value) for value in row.split(",")[1:]]
                                           for row in done.stdout.splitlines()[1:]]
                return Utterance(sound.readframes(sound.getnframes()), sound.getframerate(), motion)


class Piper:
    """A voice of Piper, from its .onnx file, which reports the durations of phonemes."""

    def __init__(self, voice: str) -> None:
        try:
            from piper import PiperVoice
        except ImportError:
            raise missing("this voice", "the package piper", "pip install 'piper-tts[alignment]'") from None
        try:
            self._voice = PiperVoice.load(voice, include_alignments=True)
        except ValueError as error:  # a .json that is none, for instance
            raise LabialError(f"{voice}: {error}") from None

    def say(self, text: str) -> Utterance:
        """The sound of a text, which is not empty, and its motion."""
        chunks = list(self._voice.synthesize(text, include_alignments=True))
        timings = labial.read_timings(chunks, source="piper")
        sound = b"".join(chunk.audio_int16_bytes for chunk in chunks)
        return Utterance(sound, chunks[0].sample_rate, labial.render(timings, labels="auto", nearest=True))


def follow(motion: Sequence[Sequence[int]], face: labial.Face, rate: int, show: Callable[[int, Any], None],
           begin: float, clock: Callable[[], float] = time.monotonic,
           sleep: Callable[[float], None] = time.sleep) -> None:
    """Moves the servos by the frames of `motion`, `rate` per second from `begin` on, until they rest. Each frame is
    shown while it is due. Late frames are passed over: a busy moment costs frames, but the lips stay in step, and the
    servos within their limits."""
    shown, given = -1, 0
    while given < len(motion) or not face.rests:
        due = math.floor((clock() - begin) * rate + 1e-6)
        if due <= shown:
            sleep(max(begin + (shown + 1) / rate - clock(), 0.0))
            continue
        face.skip(due - shown - 1)
        for frame in motion[given:due + AHEAD + 1]:
            face.frame(frame)
            given += 1
        if shown < 0:
            face.play()
        shown = due
        show(shown, face.tick())


def play(sound: Path, device: str) -> subprocess.Popen[bytes]:
    """Plays a file by aplay. Raises LabialError without it."""
    try:
        return subprocess.Popen(["aplay", "-q", "-D", device, str(sound)])
    except FileNotFoundError:
        raise missing("the sound", "aplay", f"{apt('alsa-utils')}, or --sound none") from None


def speak(utterance: Utterance, face: labial.Face, servos: Any, device: str, delay: float) -> None:
    """Plays an utterance and moves the servos in step; `delay` is the latency of the sound device, seconds."""
    rate, last = labial.speech_en.fps, 0

    def show(number: int, values: Any) -> None:
        nonlocal last
        last = number
        servos.show(number * 1000 // rate, values)

    with tempfile.TemporaryDirectory() as folder:
        sound = Path(folder) / "utterance.wav"
        with wave.open(str(sound), "wb") as out:
            out.setparams((1, 2, utterance.rate, 0, "NONE", ""))
            out.writeframes(utterance.sound)
        player = None if device == "none" else play(sound, device)
        begin = time.monotonic() + delay
        try:
            follow(utterance.motion, face, rate, show, begin)
            if player and player.wait() != 0:
                raise LabialError("aplay could not play the sound")
        finally:
            if player:  # after Ctrl-C no sound continues with closed lips
                player.kill()
                player.wait()
            face.cancel()
            while not face.rests:
                show(last + 1, face.tick())
                time.sleep(1 / rate)


def main(arguments: Optional[List[str]] = None) -> int:
    """The command line."""
    parser = Parser(prog="speak", description="Speaks and moves servos with it.")
    parser.add_argument("text", nargs="?", help="what to say; every line of standard input without it")
    parser.add_argument("--face", default=str(Path(__file__).with_name("face.toml")), metavar="FACE.toml")
    parser.add_argument("--voice", default="en-us", help="of espeak-ng (en-us)")
    parser.add_argument("--piper", metavar="VOICE.onnx", help="speak with Piper's voice instead")
    parser.add_argument("--servos", choices=("i2c", "print"), default="i2c", help="print where there are none (i2c)")
    parser.add_argument("--sound", default="default", metavar="DEVICE", help="of aplay, or none (default)")
    parser.add_argument("--delay", type=number(0, 10), default=0.06, metavar="SECONDS",
                        help="from handing sound to the device until it is heard (0.06)")
    options = parser.parse_args(arguments)
    face = labial.Face(options.face, ahead=AHEAD)
    voice = Piper(options.piper) if options.piper else Espeak(options.voice)
    servos = Printer() if options.servos == "print" else open_servos(face.rig)
    try:
        servos.start(face)
        for line in [options.text] if options.text else sys.stdin:
            if line.strip():
                speak(voice.say(line.strip()), face, servos, options.sound, options.delay)
    finally:
        servos.close()
    return 0


if __name__ == "__main__":
    sys.exit(run("speak", main))
