#!/usr/bin/env python3
"""A talking head on a Raspberry Pi: text to sound and to servos that move with it.

    python3 speak.py "Hello there."
    python3 speak.py --piper en_US-lessac-medium.onnx < lines.txt

speaks the text, or every line of standard input, with espeak-ng or Piper, plays it with aplay and moves the servos of
face.toml in step.
"""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
import tempfile
import time
import wave
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence

import labial
from servos import Printer, open_servos
from voices import Espeak, Piper, Utterance

#: Look-ahead of the face in frames: more than any servo needs for its full range.
AHEAD = 50


def moves(utterance: Utterance, face: labial.Rig) -> List[Dict[str, int]]:
    """Values of the servos for each frame. All frames are applied in order, since limits of speed are per frame; and
    since all are known, slow servos start early enough."""
    return list(face.ahead(utterance.motion, AHEAD))


def follow(frames: Sequence[Any], rate: int, show: Callable[[int, Any], None], begin: float,
           clock: Callable[[], float] = time.monotonic, sleep: Callable[[float], None] = time.sleep) -> None:
    """Shows each of `frames` when it is due by the clock, `rate` per second from `begin` on. Late frames are skipped: a
    busy moment costs a frame, but the lips stay in step."""
    shown = -1
    while shown + 1 < len(frames):
        due = min(math.floor((clock() - begin) * rate + 1e-6), len(frames) - 1)
        if due > shown:
            shown = due
            show(shown, frames[shown])
        else:
            sleep(max(begin + (shown + 1) / rate - clock(), 0.0))


def speak(utterance: Utterance, face: labial.Rig, servos: Any, device: str, delay: float) -> None:
    """Plays an utterance and moves the servos in step; `delay` is the latency of the sound device, seconds."""
    rate = labial.speech_en.fps
    frames = moves(utterance, face)
    with tempfile.TemporaryDirectory() as folder:
        sound = Path(folder) / "utterance.wav"
        with wave.open(str(sound), "wb") as out:
            out.setparams((1, 2, utterance.rate, 0, "NONE", ""))
            out.writeframes(utterance.sound)
        player = None if device == "none" else subprocess.Popen(["aplay", "-q", "-D", device, str(sound)])
        begin = time.monotonic() + delay
        try:
            follow(frames, rate, lambda number, values: servos.show(number * 1000 // rate, values), begin)
            if player and player.wait() != 0:
                raise RuntimeError("aplay could not play the sound")
        finally:
            if player:  # after Ctrl-C no sound continues with closed lips
                player.kill()
                player.wait()
            servos.show(len(frames) * 1000 // rate, face.rest())


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status."""
    parser = argparse.ArgumentParser(description="Speaks and moves servos with it.")
    parser.add_argument("text", nargs="?", help="what to say; every line of standard input without it")
    parser.add_argument("--face", default=str(Path(__file__).with_name("face.toml")), metavar="FACE.toml")
    parser.add_argument("--voice", default="en-us", help="of espeak-ng (en-us)")
    parser.add_argument("--piper", metavar="VOICE.onnx", help="speak with Piper's voice instead")
    parser.add_argument("--servos", choices=("i2c", "print"), default="i2c", help="print where there are none (i2c)")
    parser.add_argument("--sound", default="default", metavar="DEVICE", help="of aplay, or none (default)")
    parser.add_argument("--delay", type=float, default=0.06, metavar="SECONDS",
                        help="from handing sound to the device until it is heard (0.06)")
    options = parser.parse_args(arguments)
    try:
        face = labial.Rig(options.face)
        voice = Piper(options.piper) if options.piper else Espeak(options.voice)
        servos = Printer() if options.servos == "print" else open_servos(face)
        try:
            for line in [options.text] if options.text else sys.stdin:
                if line.strip():
                    speak(voice.say(line.strip()), face, servos, options.sound, options.delay)
        finally:
            servos.close()
    except KeyboardInterrupt:
        return 130
    except (labial.errors.LabialError, RuntimeError, ValueError, OSError) as error:
        print(f"speak: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
