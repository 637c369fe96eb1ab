"""``labial say``: the motion of a text, at once."""

from __future__ import annotations

import argparse
import itertools
import re
import shutil
import tempfile
import wave
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

from labial.commands.common import opened, put
from labial.errors import LabialError
from labial.files.outputs import check, check_suffix

if TYPE_CHECKING:
    from labial.hearing.voices import Spoken

#: Milliseconds of silence after a word that ends with such a sign.
_PAUSES = {",": 150, ";": 200, ":": 200, ".": 350, "!": 350, "?": 350}
#: Milliseconds of silence before the first word.
_BEFORE = 100
#: Voices that are looked for, and their programs.
_VOICES = {"flite:slt": "flite", "espeak:en-us": "espeak-ng"}
_SUFFIXES = (".html", ".lab", ".csv", ".fap", ".jsonl")
#: A phoneme, SIL for silence, and its milliseconds.
Timings = List[Tuple[str, int]]


def add_say(command: argparse.ArgumentParser) -> None:
    command.add_argument("text", metavar="TEXT", nargs="+", help="what is said; several are joined by blanks")
    command.add_argument("-o", "--output", metavar="OUT", help="a page (.html), frames (.csv, .fap, .jsonl) or timings "
                         "(.lab); timings on standard output without it")
    group = command.add_mutually_exclusive_group()
    group.add_argument("--audio", metavar="FILE.wav", help="a recording of the text, whose lips are heard")
    group.add_argument("--voice", metavar="VOICE", help="flite:NAME or espeak:NAME; none: no sound, every phoneme as "
                       "long as it usually is, and texts of more than 1,000 characters; without it the "
                       f"first that is installed of {', '.join(_VOICES)}")
    command.add_argument("--language", default="en", help="en, or what espeak-ng calls a language; for others than en "
                         "espeak-ng is needed (en)")


def run_say(options: argparse.Namespace) -> None:
    options.text = " ".join(options.text)
    check(options.output)
    form = check_suffix(options.output, *_SUFFIXES) if options.output else ".lab"
    if not options.text.strip():
        raise LabialError("there is nothing to say: the text is empty")
    with ExitStack() as stack:
        audio, timings = options.audio, None
        if audio is None:
            spoken = _spoken(options, form)
            timings = _timed(options.text, options.language) if spoken is None else _of_segments(spoken)
            _expect_words(options, timings)
            if spoken is not None and form == ".html":
                audio = str(Path(stack.enter_context(tempfile.TemporaryDirectory())) / "said.wav")
                with wave.open(audio, "wb") as file:
                    file.setparams((1, 2, spoken.rate, 0, "NONE", ""))
                    file.writeframes(spoken.samples.astype("<i2").tobytes())
        elif form == ".lab":
            raise LabialError(f"{audio}: labial align finds the phonemes of a recording")
        if form == ".lab":
            rows = [f"{begin / 1000:.3f} {end / 1000:.3f} {label}\n" for label, begin, end in _placed(timings or [])]
            return put("".join(rows), options.output)
        if timings is None:
            frames = _heard(audio)
        else:
            from labial.runtime.render import render

            frames = list(render(timings))
        if form == ".html":
            from labial.see.player import player

            return put(player(options.text.strip()[:80], 50, frames, _bands(timings or []), 0.0, audio), options.output)
        import numpy as np

        from labial.rig.animation import FORMATS

        with opened(options.output) as out:
            FORMATS[form[1:]].write(out, [np.array(frames, dtype=np.float64)], 50, Path(options.output).stem,
                                    len(frames))


def _spoken(options: argparse.Namespace, form: str) -> Optional[Spoken]:
    """The text as a synthesiser says it; None without one."""
    from labial.files.limits import MESSAGE_TEXT

    voice = options.voice
    if voice is None:
        voices = _VOICES if options.language == "en" else {f"espeak:{options.language}": "espeak-ng"}
        voice = next((name for name, program in voices.items() if shutil.which(program)), "none")
        try:
            import numpy  # noqa: F401
        except ImportError:  # the synthesisers' sound needs it, and nothing else here
            voice = "none"
    if voice == "none":
        return None
    if len(options.text) > MESSAGE_TEXT:
        raise LabialError(f"the text has {len(options.text):,} characters, more than the {MESSAGE_TEXT:,} that a voice "
                          "says at once; say it in parts, with --voice none, or give a recording of it with --audio")
    from labial.hearing.voices import speak

    try:
        return next(iter(speak(voice, [options.text])))
    except LabialError:
        if options.voice is not None:
            raise
        return None  # a synthesiser that nobody asked for


def _expect_words(options: argparse.Namespace, timings: Timings) -> None:
    """Raises LabialError where nothing is said: all is silence, or a text that is read as English has no letter or
    digit of English. For such a text the library's tables would move the lips a little all the same."""
    is_english = options.language == "en" and not (options.voice or "").startswith("espeak:")
    is_read = not is_english or re.search("[A-Za-z0-9]", options.text) is not None
    if is_read and any(label != "SIL" for label, _ in timings):
        return
    is_foreign = not is_read and any(character.isalpha() for character in options.text)
    hint = "; for a text that is not English, name its --language" if is_foreign else ""
    raise LabialError(f"{options.text!r:.60} has no word that can be said{hint}")


def _of_segments(spoken: Spoken) -> Timings:
    ends = [round(1000 * segment.end) for segment in spoken.segments]
    return [(segment.label, end - begin) for segment, begin, end in zip(spoken.segments, [0, *ends], ends)
            if end > begin]


def _timed(text: str, language: str) -> Timings:
    """Every word as long as it usually is, and a pause at each sign."""
    from labial.corpus.words import Word, pronunciation, timings_of, words_of

    how = pronunciation(None, language, False)
    found: Timings = [("SIL", _BEFORE)]
    for word in text.split():
        said = [(label, length) for part in words_of(word) if part
                for label, length in timings_of([Word(part, 0, None)], how) if label != "SIL"]
        found += said
        sign = re.search(r"[,;:.!?](?=\W*$)", word)
        if sign and said:
            found.append(("SIL", _PAUSES[sign[0]]))
    return found


def _placed(timings: Timings) -> List[Tuple[str, int, int]]:
    """Phonemes with their beginnings and ends."""
    ends = itertools.accumulate(length for _, length in timings)
    return [(label, end - length, end) for (label, length), end in zip(timings, ends)]


def _bands(timings: Timings) -> List[Dict[str, Any]]:
    placed = ((label, (begin + 10) // 20, (end + 10) // 20) for label, begin, end in _placed(timings))
    return [{"label": label, "start_frame": first, "frames": end - first,
             "kind": "silence" if label == "SIL" else "speech"} for label, first, end in placed if end > first]


def _heard(path: str) -> List[Tuple[int, ...]]:
    """The lips of a recording."""
    from labial.commands.hear import sound_of
    from labial.runtime.hearing import Hearing

    rate, channels, sound = sound_of(path)
    with Hearing(rate, channels) as hearing:
        hearing.measure(sound)
        return [frame.faps for frame in hearing.frames([sound])]
