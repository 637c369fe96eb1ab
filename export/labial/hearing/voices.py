"""Free speech synthesisers that report when each phoneme begins: flite, festival and espeak-ng.

A voice is called ``SYNTHESISER:VOICE``, such as ``flite:slt``, ``festival:kal_diphone`` or ``espeak:en-us+f3``. Their
sound is free of any licence; MBROLA's voices, which espeak-ng can use, are for non-commercial use and are refused.
flite and festival are called as programs, espeak-ng as a library.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import wave
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np

from labial.corpus.episode import Segment
from labial.corpus.languages import speakable
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError, apt, missing
from labial.files import wav
from labial.hearing.espeak import Speaker

#: Seconds after which a program that speaks one text, or all of them, is ended.
_PATIENCE = 600


class Spoken(NamedTuple):
    """What a voice said, and when."""

    samples: np.ndarray  #: (N,) int16
    rate: int  #: samples per second
    segments: Tuple[Segment, ...]  #: ARPABET and SIL, without gaps from time 0 on; seconds


def speak(voice: str, texts: Sequence[str], pace: float = 1.0, pitch: float = 1.0) -> Iterator[Spoken]:
    """Each of `texts` as `voice` says it.

    `pace` is the speed and `pitch` the height of the voice, relative to the voice's own, .5 .. 2; festival ignores
    both, and flite's slt and rms ignore the pitch. Raises LabialError for an unknown voice, for a synthesiser that is
    not installed, and for a text that it cannot say.
    """
    kind, _, name = voice.partition(":")
    if kind not in _KINDS or not name:
        raise LabialError(f"{voice!r} is not a voice: {', '.join(f'{item}:NAME' for item in _KINDS)}")
    if not (0.5 <= pace <= 2.0 and 0.5 <= pitch <= 2.0):
        raise LabialError(f"pace {pace:g} and pitch {pitch:g} must be .5 .. 2")
    for text in texts:
        if not text.strip() or "\0" in text:
            raise LabialError(f"{voice} cannot say {text!r}")
    return _KINDS[kind](name, texts, pace, pitch)


def _flite(name: str, texts: Sequence[str], pace: float, pitch: float) -> Iterator[Spoken]:
    program = _program("flite")
    known = _run([program, "-lv"]).partition(":")[2].split()
    if name not in known:  # flite would speak with another voice
        raise LabialError(f"flite has no voice {name!r}; it has {' '.join(known)}")
    own = {"kal": 95.0, "kal16": 95.0}.get(name)
    height = ["--setf", f"int_f0_target_mean={own * pitch:.3f}"] if own is not None and pitch != 1.0 else []
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "said.wav")
        for text in texts:
            said = _run([program, "-voice", name, "--setf", f"duration_stretch={1 / pace:.6f}", *height, "-psdur",
                         "-t", text, "-o", path])
            rows = [item.rpartition(":") for item in said.split()]
            yield _spoken(f"flite:{name}", text, path, [(float(end), label) for label, _, end in rows])


def _festival(name: str, texts: Sequence[str], pace: float, pitch: float) -> Iterator[Spoken]:
    program = _program("festival")
    if not name.replace("_", "").isalnum():
        raise LabialError(f"{name!r} is not a name of festival's voices")
    with tempfile.TemporaryDirectory() as folder:
        lines = [f"(voice_{name})"]
        for number, text in enumerate(texts):
            quoted = text.replace("\\", " ").replace('"', " ")
            lines += [f'(set! said (utt.synth (Utterance Text "{quoted}")))',
                      f'(utt.save.wave said "{folder}/{number}.wav" (quote riff))',
                      f'(utt.save.segs said "{folder}/{number}.segs")']
        script = Path(folder, "say.scm")
        script.write_text("\n".join(lines) + "\n", "utf-8")
        _run([program, "-b", str(script)])
        for number, text in enumerate(texts):
            try:
                segs = Path(folder, f"{number}.segs").read_text("utf-8")
            except OSError:
                raise LabialError(f"festival's voice {name!r} could not say {text[:40]!r}") from None
            rows = [line.split() for line in segs.partition("#")[2].splitlines() if line.strip()]
            yield _spoken(f"festival:{name}", text, os.path.join(folder, f"{number}.wav"),
                          [(float(row[0]), row[2]) for row in rows])


def _espeak(name: str, texts: Sequence[str], pace: float, pitch: float) -> Iterator[Spoken]:
    speaker, speaks = None, ""
    for text, (written, voice) in zip(texts, [speakable(text, name) for text in texts]):
        if not written.strip():
            raise LabialError(f"espeak:{name} cannot say {text[:40]!r}")
        if speaker is None or voice != speaks:
            speaker, speaks = Speaker(voice, pace, pitch), voice
        samples, rate, rows = speaker.say(written)
        yield Spoken(samples, rate, tuple(_segments(rows, len(samples) / rate, "ipa")))


_KINDS: Dict[str, Callable[[str, Sequence[str], float, float], Iterator[Spoken]]] = {
    "flite": _flite, "festival": _festival, "espeak": _espeak}


def _program(name: str) -> str:
    found = shutil.which(name)
    if found is None:
        raise missing("this voice", name, apt(name))
    return found


def _run(command: List[str]) -> str:
    """The standard output of a program that must succeed."""
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise LabialError(f"{command[0]} took more than {_PATIENCE} s") from None
    told = done.stderr.decode("utf-8", "replace").strip()
    if done.returncode != 0:
        raise LabialError(f"{command[0]} failed: {told[-300:] or f'exit status {done.returncode}'}")
    return done.stdout.decode("utf-8", "replace")


def _spoken(voice: str, text: str, path: str, ends: Sequence[Tuple[float, str]]) -> Spoken:
    """The sound at `path`, and the phonemes that end at the seconds of `ends`."""
    try:
        with wave.open(path) as sound:
            rate, width, channels = sound.getframerate(), sound.getsampwidth(), sound.getnchannels()
            content = sound.readframes(sound.getnframes())
    except (OSError, *wav.ERRORS) as error:
        raise LabialError(f"{voice} could not say {text[:40]!r}: {error}") from None
    if width != 2 or channels != 1 or not content or not ends:
        raise LabialError(f"{voice} could not say {text[:40]!r}")
    samples = np.frombuffer(content, "<i2").astype(np.int16)
    return Spoken(samples, rate, tuple(_segments(ends, len(samples) / rate, "arpabet")))


def _segments(ends: Sequence[Tuple[float, str]], length: float, labels: str) -> Iterator[Segment]:
    """Segments that end at `ends`, and silence up to `length` seconds."""
    start = 0.0
    for end, label in [*ends, (length, "")]:
        end = min(end, length)
        if end > start:
            yield Segment(start, end, SPEECH.nearest(label, labels) if label else SPEECH.silence)
            start = end
