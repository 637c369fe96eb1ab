"""Free speech synthesisers that report when each phoneme begins, flite, festival and espeak-ng; and ``labial
speech-corpus``.

A voice is called ``SYNTHESISER:VOICE``, such as ``flite:slt``, ``festival:kal_diphone`` or ``espeak:en-us+f3``. Their
sound is free of any licence; MBROLA's voices, which espeak-ng can use, are for non-commercial use and are refused.
flite and festival are called as programs, espeak-ng as a library.

The folder that ``labial speech-corpus`` writes is one of those that ``labial train-hear`` reads: sounds in FLAC, each
with a .lab beside it. Phonemes of espeak-ng have the times that ``labial-say-espeak`` gives them (tools/speak): it
reports p, t and k at their burst, and the silence before it, while lips or tongue are shut, is theirs.
"""

from __future__ import annotations

import ctypes
import io
import os
import shutil
import subprocess
import tempfile
import unicodedata
import wave
import zlib
from itertools import count
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.core import espeak
from labial.corpus.episode import Segment
from labial.corpus.languages import speakable
from labial.corpus.phonesets import SPEECH
from labial.corpus.timings import lab_of
from labial.errors import DataError, LabialError, PathLike, apt, missing, needs
from labial.files import wav
from labial.files.grammar import read_text
from labial.files.outputs import folder

#: Values of espeak-ng's speak_lib.h.
_END, _PHONEME, _RATE, _PITCH, _NORMAL_RATE, _NORMAL_PITCH, _UTF8 = 0, 7, 1, 3, 175, 50, 1
#: Shorter stretches without a label are word boundaries, glottal stops or glides, for which espeak-ng has no IPA: they
#: belong to the phoneme before. Milliseconds; pauses last 150.
SHORTEST_PAUSE = 65
#: Milliseconds: steps in which to measure the sound's level, the longest closure, and what the phoneme before it keeps.
_STEP, _LONGEST_CLOSURE, _KEPT = 5, 100, 20
#: A closure is this many times quieter than the loudest step of the phoneme before it.
_QUIETER = 16
_STOPS = frozenset("ptkbdgcq\u0261\u0288\u0256\u025f\u0262")


class _Event(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("identifier", ctypes.c_uint), ("text_position", ctypes.c_int),
                ("length", ctypes.c_int), ("audio_position", ctypes.c_int), ("sample", ctypes.c_int),
                ("user_data", ctypes.c_void_p), ("id", ctypes.c_char * 8)]


_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event))


class Speaker:
    """A voice of espeak-ng. The library has one state in a process: there is one speaker at a time."""

    def __init__(self, voice: str, pace: float = 1.0, pitch: float = 1.0) -> None:
        """`voice` is a voice or language with an optional variant, such as ``en-us+f3``. Raises LabialError without
        the library or the voice, and for MBROLA's."""
        if "mb" in voice.replace("/", "-").split("+")[0].split("-"):
            raise LabialError(f"espeak-ng's {voice!r} is a voice of MBROLA, which is not for every use")
        self._library, self.rate = espeak.library()
        self._samples: List[np.ndarray] = []
        self._events: List[Tuple[int, str]] = []
        self._callback = _CALLBACK(self._heard)  # kept: the library holds its address
        if not espeak.set_voice(self._library, voice):
            raise LabialError(f"espeak-ng has no voice {voice!r}")
        self._library.espeak_SetParameter(_RATE, round(_NORMAL_RATE * pace), 0)
        self._library.espeak_SetParameter(_PITCH, min(round(_NORMAL_PITCH * pitch), 99), 0)
        self._library.espeak_SetSynthCallback(self._callback)

    def say(self, text: str) -> Tuple[np.ndarray, int, List[Tuple[float, str]]]:
        """The sound of `text`, (N,) int16, its rate, and each phoneme's end in seconds with its IPA; "" is a pause."""
        self._samples, self._events = [], []
        content = text.encode("utf-8")
        failed = self._library.espeak_Synth(content, len(content) + 1, 0, 1, 0, _UTF8, None, None)
        if failed or self._library.espeak_Synchronize() or not self._samples:
            raise LabialError(f"espeak-ng could not say {text[:40]!r}")
        samples = np.concatenate(self._samples)
        return samples, self.rate, phonemes(self._events, samples, self.rate)

    def _heard(self, samples: Any, count: int, events: Any) -> int:
        if samples and count > 0:
            self._samples.append(np.ctypeslib.as_array(samples, (count,)).copy())
        at = 0
        while events and events[at].type != _END:
            event = events[at]
            if event.type == _PHONEME:
                # The bytes of `id` as they are: it has no NUL when it fills all of them.
                raw = ctypes.string_at(ctypes.addressof(event) + _Event.id.offset, 8).split(b"\0")[0]
                self._events.append((max(event.audio_position, 0), raw.decode("utf-8", "ignore")))
            at += 1
        return 0


def phonemes(events: Sequence[Tuple[int, str]], samples: np.ndarray, rate: int) -> List[Tuple[float, str]]:
    """The end of each phoneme, seconds, with its label, from `events`: where each begins, milliseconds, and its label;
    "" where espeak-ng has no IPA. `samples` is the sound, (N,) int16."""
    levels = _levels(samples, rate)
    found: List[Tuple[float, str]] = []
    label, begin = "", 0
    unlabelled: Optional[int] = None

    def close(end: int) -> None:
        nonlocal label, unlabelled
        if unlabelled is not None and end >= unlabelled + SHORTEST_PAUSE:
            found.append((unlabelled / 1000, label))
            label = ""
        unlabelled = None
        found.append((end / 1000, label))

    for start, name in events:
        if name.startswith("("):  # the name of a language, where words of another one begin
            continue
        if not name and not unlabelled:
            unlabelled = start
        if all(c.isdigit() or unicodedata.category(c) in ("Lm", "Sk") for c in name):  # part of the phoneme before
            continue
        pause = unlabelled is not None and start >= unlabelled + SHORTEST_PAUSE
        if label and not pause and name[0] in _STOPS:
            start = closure(levels, begin, start)
        close(start)
        label, begin = name, start
    close(max(round(1000 * len(samples) / rate), begin))
    return found


def closure(levels: np.ndarray, before: int, burst: int) -> int:
    """Where the silence before a burst begins, milliseconds: at `burst` itself if there is none. `levels` is of each
    `_STEP` of the sound; the phoneme before begins at `before`."""
    end = min(burst // _STEP, len(levels))
    first = max(-(-(before + _KEPT) // _STEP), end - _LONGEST_CLOSURE // _STEP, 0)
    loudest = levels[before // _STEP : end].max(initial=0)
    begin = end
    while begin > first and levels[begin - 1] * _QUIETER <= loudest:
        begin -= 1
    return begin * _STEP if begin < end else burst


def _levels(samples: np.ndarray, rate: int) -> np.ndarray:
    """(n,) int64: the mean magnitude of each step of `_STEP` milliseconds."""
    count = len(samples) * 1000 // (_STEP * rate)
    bounds = -(-np.arange(count + 1) * _STEP * rate // 1000)
    sums = np.concatenate([[0], np.cumsum(np.abs(samples.astype(np.int64)))])
    return (sums[bounds[1:]] - sums[bounds[:-1]]) // np.maximum(np.diff(bounds), 1)


#: Seconds after which a program that speaks one text, or all of them, is ended.
_PATIENCE = 600


class Spoken(NamedTuple):
    """What a voice said, and when."""

    samples: np.ndarray  #: (N,) int16
    rate: int  #: samples per second
    segments: Tuple[Segment, ...]  #: ARPABET and SIL, without gaps from time 0 on; seconds


def speak(voice: str, texts: Sequence[str], pace: float = 1.0, pitch: float = 1.0) -> Iterator[Spoken]:
    """Each of `texts` as `voice` says it. `pace` is the speed and `pitch` the height of the voice, relative to the
    voice's own, .5 .. 2; festival ignores both, and flite's slt and rms ignore the pitch. Raises LabialError for an
    unknown voice, for a synthesiser that is not installed, and for a text that it cannot say."""
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
    known = _said([program, "-lv"]).partition(":")[2].split()
    if name not in known:  # flite would speak with another voice
        raise LabialError(f"flite has no voice {name!r}; it has {' '.join(known)}")
    is_high = name in ("kal", "kal16") and pitch != 1.0
    height = ["--setf", f"int_f0_target_mean={95.0 * pitch:.3f}"] if is_high else []
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "said.wav")
        for text in texts:
            said = _said([program, "-voice", name, "--setf", f"duration_stretch={1 / pace:.6f}", *height, "-psdur",
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
        _said([program, "-b", str(script)])
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


def run(name: str, command: List[str], given: bytes = b"") -> bytes:
    """The standard output of a program that must succeed, which is called `name` in errors; `given` is its input."""
    try:
        done = subprocess.run(command, input=given, capture_output=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        raise LabialError(f"{name} took more than {_PATIENCE} s") from None
    if done.returncode != 0:
        told = done.stderr.decode("utf-8", "replace").strip()
        raise LabialError(f"{name} failed: {told[-300:] or f'exit status {done.returncode}'}")
    return done.stdout


def _said(command: List[str]) -> str:
    return run(command[0], command).decode("utf-8", "replace")


def _spoken(voice: str, text: str, path: str, ends: Sequence[Tuple[float, str]]) -> Spoken:
    """The sound at `path`, and the phonemes that end at the seconds of `ends`."""
    try:
        with wave.open(path) as sound:
            rate, shape = sound.getframerate(), (sound.getsampwidth(), sound.getnchannels())
            content = sound.readframes(sound.getnframes())
    except (OSError, *wav.ERRORS) as error:
        raise LabialError(f"{voice} could not say {text[:40]!r}: {error}") from None
    if shape != (2, 1) or not content or not ends:
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


#: How far pace and pitch of a voice stray to both sides of its own, as factors.
PACE, PITCH = 1.25, 1.3
#: Sentences that are spoken at one pace and pitch.
_RUN = 6
#: Characters of a sentence that is spoken; longer ones end at a word before that.
_LONGEST = 220


class Written(NamedTuple):
    """What a corpus has."""

    sounds: int
    seconds: float


def read_sentences(path: PathLike) -> List[str]:
    """The sentences of a text: one in each line, of a metadata.csv in LJ Speech's layout the last column. Raises
    DataError for a file without any."""
    table = Path(path).name == "metadata.csv"
    lines = [line.rpartition("|")[2] if table else line for line in read_text(path).splitlines()]
    found = [" ".join(line.split()) for line in lines if any(c.isalpha() for c in line)]
    if not found:
        raise DataError(path, None, "no sentences")
    return [line if len(line) <= _LONGEST else line[:_LONGEST].rpartition(" ")[0] or line[:_LONGEST] for line in found]


def write_corpus(path: PathLike, sentences: Sequence[str], voices: Sequence[str], minutes: float, seed: int = 0,
                 told: Optional[Callable[[float], None]] = None) -> Written:
    """Speaks random `sentences` with all of `voices` in turn until there are `minutes` of sound, into the folder
    `path`, new or empty. Pace and pitch change every few sentences. `told` receives the seconds so far. The same
    arguments give the same sounds in a new process, with the same versions of the synthesisers; espeak-ng remembers a
    little of what it said before. Raises LabialError as :func:`speak`, and for a folder with files."""
    with needs("writing sounds", "hear"):
        import soundfile

    if Path(path).is_dir() and any(Path(path).iterdir()):
        raise LabialError(f"{path}: the folder is not empty")
    if not sentences or not voices or minutes <= 0:
        raise LabialError("a corpus of speech needs sentences, voices and minutes")
    seconds = 0.0
    with folder(path) as place:
        for sounds, (voice, spoken) in enumerate(_turns(sentences, voices, seed), 1):
            name = f"{sounds - 1:05d}_{''.join(c if c.isalnum() else '-' for c in voice)}"
            sound = io.BytesIO()  # so that a full disk is an error of the file, not of the sound's library
            soundfile.write(sound, spoken.samples, spoken.rate, format="FLAC")
            (place / f"{name}.flac").write_bytes(sound.getvalue())
            (place / f"{name}.lab").write_text(lab_of(spoken.segments), "utf-8")
            seconds += len(spoken.samples) / spoken.rate
            if told:
                told(seconds)
            if seconds >= 60 * minutes:
                return Written(sounds, seconds)
    raise AssertionError("the voices never end")


def _turns(sentences: Sequence[str], voices: Sequence[str], seed: int) -> Iterator[Tuple[str, Spoken]]:
    """What the voices say in turn, each some sentences in one go."""
    for turn, voice in ((turn, voice) for turn in count() for voice in voices):
        random = np.random.default_rng([seed, turn, zlib.crc32(voice.encode("utf-8"))])
        texts = [sentences[k] for k in random.integers(len(sentences), size=_RUN)]
        pace, pitch = (float(high ** random.uniform(-1, 1)) for high in (PACE, PITCH))
        for spoken in speak(voice, texts, pace, pitch):
            yield voice, spoken
