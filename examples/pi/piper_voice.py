"""Speech by Piper (pip install 'piper-tts[alignment]'), whose voices tell how long each phoneme lasts."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

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
            phonemes = [{"phoneme": one.phoneme, "num_samples": int(one.num_samples)}
                        for one in chunk.phoneme_alignments]
            chunks.append({"sample_rate": rate, "phoneme_alignments": phonemes})
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "utterance.json"
            path.write_text(json.dumps(chunks), encoding="utf-8")
            return Utterance(sound, rate, labial.read_timings(path, source="piper"), "auto")
