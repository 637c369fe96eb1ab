"""``labial speech-corpus``: sentences spoken by free synthesisers, with the exact times of their phonemes.

The folder that it writes is one of those that ``labial train-hear`` reads: sounds in FLAC, each with a .lab beside it.
"""

from __future__ import annotations

import io
import zlib
from pathlib import Path
from typing import Callable, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from labial.corpus.timings import PathLike, lab_of
from labial.errors import DataError, LabialError, needs
from labial.files.grammar import read_text
from labial.files.outputs import folder
from labial.hearing.voices import Spoken, speak

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
    found = [_short(" ".join(line.split())) for line in lines if any(c.isalpha() for c in line)]
    if not found:
        raise DataError(path, None, "no sentences")
    return found


def _short(line: str) -> str:
    return line if len(line) <= _LONGEST else line[:_LONGEST].rpartition(" ")[0] or line[:_LONGEST]


def write_corpus(
    path: PathLike, sentences: Sequence[str], voices: Sequence[str], minutes: float, seed: int = 0,
    told: Optional[Callable[[float], None]] = None, strays: bool = True,
) -> Written:
    """Speaks random `sentences` with all of `voices` in turn until there are `minutes` of sound, into the folder
    `path`, new or empty. With `strays` pace and pitch change every few sentences. `told` receives the seconds so far.

    The same arguments give the same sounds in a new process, with the same versions of the synthesisers; espeak-ng
    remembers a little of what it said before. Raises LabialError as
    :func:`labial.hearing.voices.speak`, and for a folder with files.
    """
    with needs("writing sounds", "hear"):
        import soundfile

    if Path(path).is_dir() and any(Path(path).iterdir()):
        raise LabialError(f"{path}: the folder is not empty")
    if not sentences or not voices or minutes <= 0:
        raise LabialError("a corpus of speech needs sentences, voices and minutes")
    seconds, sounds = 0.0, 0
    with folder(path) as place:
        for voice, said in _turns(sentences, voices, seed, strays):
            for spoken in said:
                name = f"{sounds:05d}_{''.join(c if c.isalnum() else '-' for c in voice)}"
                sound = io.BytesIO()  # so that a full disk is an error of the file, not of the sound's library
                soundfile.write(sound, spoken.samples, spoken.rate, format="FLAC")
                (place / f"{name}.flac").write_bytes(sound.getvalue())
                (place / f"{name}.lab").write_text(lab_of(spoken.segments), "utf-8")
                seconds += len(spoken.samples) / spoken.rate
                sounds += 1
                if told:
                    told(seconds)
                if seconds >= 60 * minutes:
                    return Written(sounds, seconds)
    raise AssertionError("the voices never end")


def _turns(
    sentences: Sequence[str], voices: Sequence[str], seed: int, strays: bool
) -> Iterator[Tuple[str, Iterator[Spoken]]]:
    """Voices in turn, each with what it says in one go."""
    turn = 0
    while True:
        for voice in voices:
            random = np.random.default_rng([seed, turn, zlib.crc32(voice.encode("utf-8"))])
            texts = [sentences[k] for k in random.integers(len(sentences), size=_RUN)]
            pace, pitch = (float(high ** random.uniform(-1, 1)) for high in (PACE, PITCH)) if strays else (1.0, 1.0)
            yield voice, speak(voice, texts, pace, pitch)
        turn += 1
