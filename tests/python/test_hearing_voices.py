"""Speech for hearing: what flite, festival and espeak-ng say, and when."""

from __future__ import annotations

import ctypes.util
import shutil
import stat
import subprocess
import sys
import warnings
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

soundfile = pytest.importorskip("soundfile")

from labial.__main__ import main  # noqa: E402
from labial.corpus.episode import Segment  # noqa: E402
from labial.corpus.languages import speakable  # noqa: E402
from labial.errors import DataError, LabialError  # noqa: E402
from labial.files.frames import opening  # noqa: E402
from labial.hearing import targets  # noqa: E402
from labial.hearing.voices import (  # noqa: E402
    Spoken,
    Written,
    closure,
    phonemes,
    read_sentences,
    speak,
    write_corpus,
)
from packages import needs_runtime  # noqa: E402
from test_speak import REST, TEXT, sound_and_motion  # noqa: E402

needs_flite = pytest.mark.skipif(not shutil.which("flite"), reason="the Debian package flite is not installed")
needs_espeak = pytest.mark.skipif(not ctypes.util.find_library("espeak-ng"), reason="espeak-ng is not installed")


def one(voice: str, text: str = "Peter bought a map.") -> Spoken:
    return next(iter(speak(voice, [text])))


def labels(segments: Tuple[Segment, ...]) -> List[str]:
    return [item.label for item in segments if item.label != "SIL"]


def without_gaps(spoken: Spoken) -> bool:
    ends = [0.0, *(item.end for item in spoken.segments)]
    return (all(item.start == end for item, end in zip(spoken.segments, ends))
            and ends[-1] == pytest.approx(len(spoken.samples) / spoken.rate, abs=0.002))


@needs_flite
def test_flite_tells_its_phonemes() -> None:
    """Would catch ends taken for beginnings: P's burst, the loudest rise of the sound, is at its end."""
    spoken = one("flite:kal16", "pa")
    assert labels(spoken.segments) == ["P", "AA"] and without_gaps(spoken) and spoken.rate == 16000
    stop = next(item for item in spoken.segments if item.label == "P")
    vowel = spoken.samples[round(stop.end * 16000) :].astype(float)
    closed = spoken.samples[round(stop.start * 16000) : round((stop.start + 0.03) * 16000)].astype(float)
    assert np.abs(vowel).max() > 10 * np.abs(closed).max()


@needs_flite
@needs_espeak
@needs_runtime
@pytest.mark.parametrize(("program", "voice"), [("flite", "flite:slt"), ("espeak", "espeak:en-us")])
def test_times_are_those_of_the_programs(program: str, voice: str, tmp_path: Path) -> None:
    """Would catch times other than those of labial-say-flite and labial-say-espeak, which are written in C: closures of
    p, t, k before their bursts, pauses, marks. The motion that follows from both is the same but for what the end of
    the sound changes, and roundings to milliseconds."""
    text = TEXT.split(".")[0] + "."
    samples, rate, true, _ = sound_and_motion(program, tmp_path, text)
    spoken = one(voice, text)
    assert spoken.rate == rate and abs(len(spoken.samples) - len(samples)) < 0.02 * rate
    if program == "flite":  # espeak-ng's noise depends on what it said before
        assert np.array_equal(spoken.samples, samples[: len(spoken.samples)].astype(np.int16))
    true = true[:-REST]
    found = opening(targets.frames(targets.durations(spoken.segments), len(true)))
    assert np.abs(found - true)[:-12].max() <= 30 and np.corrcoef(found, true)[0, 1] > 0.995


@needs_espeak
def test_chinese_and_japanese_are_said() -> None:
    """Would catch Chinese characters that espeak-ng spells as English, and kanji that it leaves out."""
    text = "\u4f60\u597d"  # ni hao
    for voice in ("espeak:cmn", "espeak:cmn+f3", "espeak:zh"):
        assert [item.label for item in one(voice, text).segments if item.label != "SIL"] == "N IY HH AW".split()
    assert speakable("ni3 hao3", "cmn") == ("ni3 hao3", "cmn")
    assert speakable("\u306f\u306f", "ja+f2") == ("\u306f\u306f", "ja+f2")
    assert speakable("Hello", "en-us") == ("Hello", "en-us")


@needs_espeak
def test_voices_of_espeak_follow_each_other() -> None:
    """Would catch a library that is ended and begun again, in which espeak-ng hangs, and settings of the voice before:
    the first voice says the same, about as fast, after a faster one."""
    first = one("espeak:en-us+f3")
    faster = next(iter(speak("espeak:en-gb-scotland+m2", ["Peter bought a map."], pace=1.4, pitch=0.8)))
    again = one("espeak:en-us+f3")
    british = one("espeak:en-gb")  # a voice by its language
    assert len(faster.samples) < 0.85 * len(first.samples)
    assert len(again.samples) == pytest.approx(len(first.samples), rel=0.02)
    assert labels(first.segments) == labels(again.segments)
    assert without_gaps(first) and "B" in labels(first.segments) and "B" in labels(british.segments)


def test_a_closure_is_the_silence_before_the_burst() -> None:
    """Worked by hand, steps of 5 ms: silence from 40 to 70 ms belongs to the stop; where the sound does not fall by 24
    dB there is none; at most 100 ms, and 20 ms of the phoneme before, are kept."""
    levels = np.array([1600] * 8 + [100] * 6 + [2000] * 6)
    assert closure(levels, 0, 70) == 40
    assert closure(np.where(levels == 100, 101, levels), 0, 70) == 70
    assert closure(levels, 30, 70) == 50  # 20 ms after 30
    long = np.array([1600] * 8 + [0] * 40)
    assert closure(long, 0, 240) == 140


def test_phonemes_of_events_that_espeak_reports() -> None:
    """By hand: a mark belongs to the phoneme before it, a short stretch without a label too, a long one is a pause, and
    the name of a language is no phoneme."""
    samples = np.full(1000, 1000, np.int16)  # 1 s
    events = [(0, "m"), (100, "(en)"), (100, "a"), (150, "ː"), (200, ""), (230, "n"), (300, ""), (420, "o"), (500, "")]
    found = [(round(end, 3), label) for end, label in phonemes(events, samples, 1000)]
    assert found == [(0.0, ""), (0.1, "m"), (0.23, "a"), (0.3, "n"), (0.42, ""), (0.5, "o"), (1.0, "")]


def fake_festival(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A festival that answers the commands of its script as the real one does: a WAV and the ends of segments."""
    folder.mkdir()
    program = folder / "festival.py"
    program.write_text("""import re, sys, wave
text = open(sys.argv[2]).read()
assert sys.argv[1] == "-b" and "(voice_kal_diphone)" in text
for path in re.findall(r'save.wave said "([^"]+)"', text):
    with wave.open(path, "wb") as out:
        out.setparams((1, 2, 16000, 0, "NONE", ""))
        out.writeframes(bytes(2 * 8000))
for path in re.findall(r'save.segs said "([^"]+)"', text):
    open(path, "w").write("#\\n0.1000 \\t100 \\tpau\\n0.2000 \\t100 \\tm\\n0.4000 \\t100 \\tax\\n")
""")
    script = folder / "festival"
    script.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{program}" "$@"\n')  # "#!" takes no path with a space
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(folder))


def test_festival_speaks_all_texts_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Would catch wrong columns of its segments, and quotation marks that end its strings."""
    fake_festival(tmp_path / "bin", monkeypatch)
    first, second = speak("festival:kal_diphone", ['Say "ma".', "Ma."])
    expected = [(0.0, 0.1, "SIL"), (0.1, 0.2, "M"), (0.2, 0.4, "AH"), (0.4, 0.5, "SIL")]
    assert [(item.start, item.end, item.label) for item in first.segments] == expected
    assert second.segments == first.segments and len(first.samples) == 8000


@pytest.mark.parametrize(("voice", "message"), [
    ("slt", "is not a voice: flite:NAME"), ("flite:", "is not a voice"), ("espeak:mb-us1", "MBROLA"),
    ("espeak:us-mbrola-1", "no voice"), ("espeak:none-such", "no voice 'none-such'"), ("flite:nobody", "it has "),
    ("festival:a)(exit", "not a name"),
])  # fmt: skip
def test_voices_that_there_are_not(voice: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Would catch flite's own choice of another voice, and commands in the name of one."""
    if voice.startswith("flite:n") and not shutil.which("flite"):
        pytest.skip("flite is not installed")
    if voice.startswith("espeak:n") or voice.startswith("espeak:us"):
        if not ctypes.util.find_library("espeak-ng"):
            pytest.skip("espeak-ng is not installed")
    if voice.startswith("festival"):
        fake_festival(tmp_path / "bin", monkeypatch)
    with pytest.raises(LabialError, match=message.replace("(", r"\(")):
        list(speak(voice, ["Hello."]))


def test_texts_that_cannot_be_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing to say, a pace out of range, and a synthesiser that is not installed."""
    with pytest.raises(LabialError, match="cannot say"):
        speak("flite:slt", ["Hello.", " "])
    with pytest.raises(LabialError, match="pace 3 and pitch 1"):
        speak("flite:slt", ["Hello."], pace=3.0)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(LabialError, match="this voice needs flite: apt-get install flite"):
        list(speak("flite:slt", ["Hello."]))


def test_sentences_of_a_text_and_of_a_table(tmp_path: Path) -> None:
    """Lines without letters are none; of LJ Speech's table the last column is read; long lines end at a word."""
    (tmp_path / "a.txt").write_text("Hello  there.\n\n---\n" + "word " * 80 + "\n")
    first, second = read_sentences(tmp_path / "a.txt")
    assert first == "Hello there." and 210 < len(second) <= 220 and second.endswith("word")
    (tmp_path / "metadata.csv").write_text("a|10 men|ten men\nb|a cat|a cat\n")
    assert read_sentences(tmp_path / "metadata.csv") == ["ten men", "a cat"]
    (tmp_path / "none.txt").write_text("\n1 2\n")
    with pytest.raises(DataError, match="none.txt: no sentences"):
        read_sentences(tmp_path / "none.txt")


@needs_flite
@needs_espeak
def test_a_corpus_is_spoken(tmp_path: Path) -> None:
    """Sounds with their timings until there is enough; the same bytes in another process; another seed says other
    sentences."""
    sentences = ["A map.", "My papa.", "Blue bees.", "Five."]
    voices = ["flite:kal16", "espeak:en-us"]
    code = ("import sys; from labial.hearing.voices import write_corpus\n"
            "print(*write_corpus(sys.argv[1], {}, {}, .15, {}))")
    for name, seed in (("a", 0), ("b", 0), ("c", 1)):
        given = [sys.executable, "-c", code.format(sentences, voices, seed), str(tmp_path / name)]
        told = subprocess.run(given, capture_output=True, encoding="utf-8", check=True).stdout.split()
        if name == "a":
            done = Written(int(told[0]), float(told[1]))
    sounds = sorted((tmp_path / "a").glob("*.flac"))
    assert done.sounds == len(sounds) > 6 and 9 <= done.seconds < 14
    assert {item.stem[6:] for item in sounds} == {"flite-kal16", "espeak-en-us"}
    every = [{item.name: item.read_bytes() for item in (tmp_path / name).iterdir()} for name in "abc"]
    assert every[0] == every[1] != every[2]
    total = sum(soundfile.info(str(item)).duration for item in sounds)
    assert total == pytest.approx(done.seconds, abs=0.01)
    for item in sounds:
        assert item.with_suffix(".lab").read_text().splitlines()[-1].split()[1] == pytest.approx(
            f"{soundfile.info(str(item)).duration:.4f}")
    with pytest.raises(LabialError, match="the folder is not empty"):
        write_corpus(tmp_path / "a", sentences, voices, 0.1)


@needs_flite
def test_the_command_speaks(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """And leaves no folder behind where a voice is unknown."""
    (tmp_path / "a.txt").write_text("A blue map.\nMaybe.\n")
    given = ["speech-corpus", str(tmp_path / "out"), "--sentences", str(tmp_path / "a.txt"), "--minutes", "0.05"]
    assert main([*given, "--voices", "flite:nobody"]) == 1
    assert "flite has no voice 'nobody'" in capsys.readouterr().err and not (tmp_path / "out").exists()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main([*given, "--voices", "flite:kal16"]) == 0
    assert "minutes" in capsys.readouterr().out and list((tmp_path / "out").glob("*.lab"))
