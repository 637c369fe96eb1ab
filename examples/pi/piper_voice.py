"""Speech by Piper (pip install 'piper-tts[alignment]'), whose voices tell how long each phoneme lasts."""

from __future__ import annotations

import labial
from utterance import Utterance


class Piper:
    """A voice of Piper, from its .onnx file. Raises RuntimeError where Piper is not installed."""

    def __init__(self, voice: str) -> None:
        try:
            from piper import PiperVoice
        except ImportError:
            raise RuntimeError("Piper is not installed: pip install 'piper-tts[alignment]'") from None
        self._voice = PiperVoice.load(voice, include_alignments=True)

    def say(self, text: str) -> Utterance:
        """The sound of a text and its phonemes."""
        sound, rate, chunks = b"", 22050, []
        for chunk in self._voice.synthesize(text, include_alignments=True):
            sound, rate = sound + chunk.audio_int16_bytes, chunk.sample_rate
            chunks.append(chunk)
        return Utterance(sound, rate, labial.read_timings(chunks, source="piper"), "auto")
