"""Converts text to sound and motion, with espeak-ng or Piper (pip install 'piper-tts[alignment]')."""

from __future__ import annotations

import subprocess
import tempfile
import wave
from pathlib import Path
from typing import List, NamedTuple, Sequence

import labial
from labial.errors import LabialError, missing


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
