"""What synthesisers say, and when: labial-say-flite and labial-say-espeak, whose sound and motion begin, go on and end
together; and speech for hearing, of flite, festival and espeak-ng, from Python.

The environment variables LABIAL_SAY_FLITE and LABIAL_SAY_ESPEAK hold the programs' paths."""

from __future__ import annotations

import ctypes
import ctypes.util
import io
import shutil
import stat
import subprocess
import sys
import warnings
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest
import soundfile

from labial.__main__ import main
from labial.corpus.languages import speakable
from labial.errors import DataError, LabialError
from labial.files.frames import opening
from labial.hearing import targets, voices
from labial.hearing.voices import Spoken, Written, read_sentences, write_corpus
from labial.hearing.voices import speak as speak_texts
from packages import CC, SOURCE, needs_runtime
from packages import run as ran
from test_say import run

PROGRAMS = ("flite", "espeak")
#: Frames after the sound, in which the face comes to rest.
REST = 12
TEXT = "Mama may be home. Papa may be happy. Bob made a map, maybe. Pam bombed a baby mob."


def speak(program: str, *arguments: str, text: str = "") -> subprocess.CompletedProcess:
    return run(f"labial-say-{program}", *arguments, data=text.encode())


def sound_and_motion(program: str, folder: Path, text: str) -> Tuple[np.ndarray, int, np.ndarray, List[str]]:
    """Samples, samples per second, (T,) lip opening in FAP units at 50 frames per second, and messages."""
    done = speak(program, str(folder / "a.wav"), text)
    assert done.returncode == 0, done.stderr
    samples, rate = soundfile.read(folder / "a.wav", dtype="int16")
    assert samples.ndim == 1 and (folder / "a.wav").stat().st_size == 44 + 2 * len(samples)
    rows = np.loadtxt(io.BytesIO(done.stdout), delimiter=",", skiprows=1)
    assert rows[-1, 0] == pytest.approx((len(rows) - 1) / 50)
    return samples.astype(np.float64), rate, opening(rows[:, 1:]), done.stderr.decode().splitlines()


@pytest.mark.parametrize("program", PROGRAMS)
def test_sound_and_motion_are_in_step(program: str, tmp_path: Path) -> None:
    """Catches motion of another length: lips that open when the sound swells fit best where neither is shifted."""
    samples, rate, opening, messages = sound_and_motion(program, tmp_path, TEXT)
    assert messages == []
    assert abs(len(opening) - REST - 50 * len(samples) / rate) <= 1
    assert len(opening) > 150 and np.abs(samples).max() > 3000
    hop = rate // 50
    loud = [np.sqrt(np.mean(np.square(samples[i * hop : (i + 1) * hop]))) for i in range(len(samples) // hop)]
    count = min(len(loud), len(opening))
    swell, open_lips = np.log(np.array(loud[:count]) + 30), opening[:count]
    fits = {lag: np.corrcoef(open_lips[max(lag, 0) : count + min(lag, 0)],
                             swell[max(-lag, 0) : count - max(lag, 0)])[0, 1] for lag in range(-12, 13)}
    best = max(fits, key=lambda lag: fits[lag])
    assert abs(best) <= 2 and fits[best] > 0.25, fits


@pytest.mark.parametrize("program", PROGRAMS)
def test_text_of_many_lines_comes_from_standard_input(program: str, tmp_path: Path) -> None:
    """Catches an utterance whose times start from 0 again, and text that is cut off."""
    one = speak(program, str(tmp_path / "a.wav"), "Mama may be happy.")
    many = speak(program, str(tmp_path / "b.wav"), "-", text="Mama may be happy.\n\nMama may be happy.\r\n")
    assert one.returncode == many.returncode == 0
    short, long = (soundfile.info(str(tmp_path / f"{name}.wav")).duration for name in "ab")
    assert long > 1.7 * short and abs(len(many.stdout.splitlines()) - 1 - REST - 50 * long) <= 1


@pytest.mark.parametrize("program", PROGRAMS)
def test_errors(program: str, tmp_path: Path) -> None:
    """Catches a failure that passes for success, or that says nothing."""
    for arguments in ([str(tmp_path / "none" / "a.wav"), "Mama."], [str(tmp_path / "a.wav"), " \n"]):
        done = speak(program, *arguments)
        assert done.returncode == 1 and done.stdout == b"", arguments
        assert done.stderr.startswith(f"labial-say-{program}: ".encode()) and done.stderr.count(b"\n") == 1


#: A sentence each; those of the Slavic and Asian languages hold signs and tones that espeak-ng reports as phonemes.
ENGLISH = ("The quick brown fox jumps over the lazy dog. Thursday's vision of leisure; church judges, a poor tour, "
           "fire, an hour, here and there, a button, a bottle, the city, music, oil and cows.")
LANGUAGES = {
    "en-us": ENGLISH, "en-gb": ENGLISH,
    "de": "Schöne Grüße, lieber Jürgen, es ist fünf Uhr.", "fr-fr": "Une lune bleue, un peu de beurre, bien sûr.",
    "ru": "Привет, мир. Семь дней, пять минут.", "pl": "Dzień dobry, pięć minut.", "tr": "Süpürge üstünde bir kuş.",
    "cmn": "你好，我们今天去北京。", "vi": "Xin chào thế giới, tiếng Việt.", "fa": "سلام دنیا. پدر و مادر خوب.",
    "nl": "Goedemorgen, het huis is duur.", "sv": "Sju sjösjuka sjömän.", "fi": "Hyvää yötä, työ on hyvä.",
}


def test_languages_of_espeak(tmp_path: Path) -> None:
    """Catches IPA of espeak's that no alias table knows, and marks of it that are taken for phonemes: no warnings."""
    for voice, text in LANGUAGES.items():
        done = speak("espeak", "--voice", voice, str(tmp_path / "a.wav"), text)
        assert done.returncode == 0 and done.stderr == b"" and len(done.stdout.splitlines()) > 50, voice
    done = speak("espeak", "--voice", "nobody", str(tmp_path / "a.wav"), "x")
    assert done.returncode == 1 and b"no voice 'nobody'" in done.stderr


def silences(samples: np.ndarray, rate: int) -> List[Tuple[float, float]]:
    """Where the sound is zero for 25 to 120 ms, in seconds: closures, since pauses are longer."""
    sounding = np.flatnonzero(np.abs(samples) > 8)
    gaps = np.flatnonzero(np.diff(sounding) > 0.025 * rate)
    found = [(sounding[i] / rate, sounding[i + 1] / rate) for i in gaps]
    return [(start, end) for start, end in found if end - start < 0.12]


def test_lips_are_shut_while_espeak_is_silent(tmp_path: Path) -> None:
    """All short silences are of p here. As espeak-ng reports them, lips are open in 11 of 17."""
    text = "A happy papa may hope a puppy will whip up a purple apple. Happy people hop up a slope."
    samples, rate, opening, _ = sound_and_motion("espeak", tmp_path, text)
    closures = silences(samples, rate)
    assert len(closures) >= 12
    shut = [opening[round(start * 50) : round(end * 50) + 2].min() < 120 for start, end in closures]
    assert sum(shut) >= 0.9 * len(shut), shut


@pytest.fixture(scope="module")
def closure(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """tools/speak/closure.c as a library."""
    target = tmp_path_factory.mktemp("closure") / "closure.so"
    ran(CC, "-O1", "-shared", "-fPIC", SOURCE / "tools/speak/closure.c", "-o", target)
    library = ctypes.CDLL(str(target))
    library.closure_begin.restype = ctypes.c_uint64
    return library


def begin(closure: ctypes.CDLL, levels: List[Tuple[int, int]], before: int, burst: int, rate: int, piece: int) -> int:
    """Where a stop begins in sound of (milliseconds, amplitude), taken `piece` samples at a time."""
    noise = np.random.default_rng(0)
    sound = np.concatenate([noise.integers(-level, level + 1, ms * rate // 1000) for ms, level in levels or [(0, 0)]])
    data = sound.astype("<i2").tobytes()
    state = (ctypes.c_uint64 * 256)()
    closure.closure_init(state, rate)
    for at in range(0, len(sound), piece):
        chunk = data[2 * at : 2 * (at + piece)]
        closure.closure_sound(state, chunk, ctypes.c_size_t(len(chunk) // 2))
    return closure.closure_begin(state, ctypes.c_uint64(before), ctypes.c_uint64(burst))


@pytest.mark.parametrize("rate", [8000, 22050, 44100])
@pytest.mark.parametrize(("levels", "before", "burst", "expected"), [
    ([(100, 8000), (50, 0), (40, 3000)], 0, 150, 100),  # silence
    ([(100, 8000), (50, 300), (40, 3000)], 0, 150, 100),  # noise, a 27th of the vowel
    ([(100, 8000), (50, 1000), (40, 3000)], 0, 150, 150),  # voicing, an eighth of it
    ([(100, 8000), (50, 0), (40, 3000)], 130, 150, 150),  # the phoneme before keeps what it has
    ([(100, 8000), (50, 0), (40, 3000)], 90, 150, 110),  # and at least 20 ms
    ([(100, 8000), (300, 0), (40, 3000)], 0, 400, 300),  # a pause that nobody reported: 100 ms at most
    ([(100, 8000), (20, 0), (30, 8000), (40, 3000)], 0, 150, 150),  # a silence that ends before the burst
    ([(900, 8000), (60, 0), (40, 3000)], 0, 960, 900),  # more sound than is remembered
    ([(10, 8000)], 0, 5, 5), ([], 0, 0, 0), ([(10, 8000)], 0, 900, 900), ([(10, 8000)], 900, 5, 5),
])
def test_stops_begin_where_the_sound_falls_silent(closure: ctypes.CDLL, levels: List[Tuple[int, int]], before: int,
                                                  burst: int, expected: int, rate: int) -> None:
    """Catches a closure that is not the silence, whatever the rate and the pieces that the sound comes in."""
    for piece in (97, 100000):
        assert abs(begin(closure, levels, before, burst, rate, piece) - expected) <= 5


def test_stops_by_their_labels(closure: ctypes.CDLL) -> None:
    """Catches a label of a stop that is passed over, and a vowel or fricative that is taken for one."""
    for label in "p t k b d ɡ g c q ʈ ɖ ɟ ɢ pʰ tʃ dʒ k-".split():
        assert closure.closure_is_stop(label.encode()), label
    for label in ["m", "s", "f", "ɑː", "ə", "ɾ", "ʔ", "β", "ɣ", ""]:
        assert not closure.closure_is_stop(label.encode()), label


# ---- The same voices in Python, for hearing --------------------------------------------------------------------------


needs_flite = pytest.mark.skipif(not shutil.which("flite"), reason="the Debian package flite is not installed")
needs_espeak = pytest.mark.skipif(not ctypes.util.find_library("espeak-ng"), reason="espeak-ng is not installed")


def one(voice: str, text: str = "Peter bought a map.") -> Spoken:
    return next(iter(speak_texts(voice, [text])))


def labels(spoken: Spoken) -> List[str]:
    return [item.label for item in spoken.segments if item.label != "SIL"]


def without_gaps(spoken: Spoken) -> bool:
    ends = [0.0, *(item.end for item in spoken.segments)]
    return (all(item.start == end for item, end in zip(spoken.segments, ends))
            and ends[-1] == pytest.approx(len(spoken.samples) / spoken.rate, abs=0.002))


@needs_flite
def test_flite_tells_its_phonemes() -> None:
    """Would catch ends taken for beginnings: P's burst, the loudest rise of the sound, is at its end."""
    spoken = one("flite:kal16", "pa")
    assert labels(spoken) == ["P", "AA"] and without_gaps(spoken) and spoken.rate == 16000
    stop = next(item for item in spoken.segments if item.label == "P")
    vowel = spoken.samples[round(stop.end * 16000) :].astype(float)
    closed = spoken.samples[round(stop.start * 16000) : round((stop.start + 0.03) * 16000)].astype(float)
    assert np.abs(vowel).max() > 10 * np.abs(closed).max()


@needs_flite
@needs_espeak
@needs_runtime
@pytest.mark.parametrize(("program", "voice"), [("flite", "flite:slt"), ("espeak", "espeak:en-us")])
def test_times_are_those_of_the_programs(program: str, voice: str, tmp_path: Path) -> None:
    """Would catch times other than those of labial-say-flite and labial-say-espeak: closures, pauses, marks."""
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
        assert labels(one(voice, text)) == "N IY HH AW".split()
    assert speakable("ni3 hao3", "cmn") == ("ni3 hao3", "cmn")
    assert speakable("\u306f\u306f", "ja+f2") == ("\u306f\u306f", "ja+f2")
    assert speakable("Hello", "en-us") == ("Hello", "en-us")


@needs_espeak
def test_voices_of_espeak_follow_each_other() -> None:
    """Would catch a library that is begun again, in which espeak-ng hangs, and settings of the voice before."""
    first = one("espeak:en-us+f3")
    faster = next(iter(speak_texts("espeak:en-gb-scotland+m2", ["Peter bought a map."], pace=1.4, pitch=0.8)))
    again = one("espeak:en-us+f3")
    british = one("espeak:en-gb")  # a voice by its language
    assert len(faster.samples) < 0.85 * len(first.samples)
    assert len(again.samples) == pytest.approx(len(first.samples), rel=0.02)
    assert labels(first) == labels(again)
    assert without_gaps(first) and "B" in labels(first) and "B" in labels(british)


def test_a_closure_is_the_silence_before_the_burst() -> None:
    """By hand, in steps of 5 ms: 24 dB below, at most 100 ms, and 20 ms of the phoneme before are kept."""
    levels = np.array([1600] * 8 + [100] * 6 + [2000] * 6)
    assert voices.closure(levels, 0, 70) == 40
    assert voices.closure(np.where(levels == 100, 101, levels), 0, 70) == 70
    assert voices.closure(levels, 30, 70) == 50  # 20 ms after 30
    long = np.array([1600] * 8 + [0] * 40)
    assert voices.closure(long, 0, 240) == 140


def test_phonemes_of_events_that_espeak_reports() -> None:
    """A mark and a short stretch without a label belong to the phoneme before, a long one is a pause."""
    samples = np.full(1000, 1000, np.int16)  # 1 s
    events = [(0, "m"), (100, "(en)"), (100, "a"), (150, "ː"), (200, ""), (230, "n"), (300, ""), (420, "o"), (500, "")]
    found = [(round(end, 3), label) for end, label in voices.phonemes(events, samples, 1000)]
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
    first, second = speak_texts("festival:kal_diphone", ['Say "ma".', "Ma."])
    expected = [(0.0, 0.1, "SIL"), (0.1, 0.2, "M"), (0.2, 0.4, "AH"), (0.4, 0.5, "SIL")]
    assert [(item.start, item.end, item.label) for item in first.segments] == expected
    assert second.segments == first.segments and len(first.samples) == 8000


@pytest.mark.parametrize(("voice", "message"), [
    ("slt", "is not a voice: flite:NAME"), ("flite:", "is not a voice"), ("espeak:mb-us1", "MBROLA"),
    pytest.param("espeak:us-mbrola-1", "no voice", marks=needs_espeak),
    pytest.param("espeak:none-such", "no voice 'none-such'", marks=needs_espeak),
    pytest.param("flite:nobody", "it has ", marks=needs_flite), ("festival:a)(exit", "not a name"),
])
def test_voices_that_there_are_not(voice: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Would catch flite's own choice of another voice, and commands in the name of one."""
    if voice.startswith("festival"):
        fake_festival(tmp_path / "bin", monkeypatch)
    with pytest.raises(LabialError, match=message.replace("(", r"\(")):
        list(speak_texts(voice, ["Hello."]))


def test_texts_that_cannot_be_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing to say, a pace out of range, and a synthesiser that is not installed."""
    with pytest.raises(LabialError, match="cannot say"):
        speak_texts("flite:slt", ["Hello.", " "])
    with pytest.raises(LabialError, match="pace 3 and pitch 1"):
        speak_texts("flite:slt", ["Hello."], pace=3.0)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(LabialError, match="this voice needs flite: apt-get install flite"):
        list(speak_texts("flite:slt", ["Hello."]))


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
            f"print(*write_corpus(sys.argv[1], {sentences}, {voices}, .15, int(sys.argv[2])))")
    told, _, _ = (ran(sys.executable, "-c", code, tmp_path / name, seed).split()
                  for name, seed in (("a", 0), ("b", 0), ("c", 1)))
    done = Written(int(told[0]), float(told[1]))
    sounds = sorted((tmp_path / "a").glob("*.flac"))
    assert done.sounds == len(sounds) > 6 and 9 <= done.seconds < 14
    assert {item.stem[6:] for item in sounds} == {"flite-kal16", "espeak-en-us"}
    every = [{item.name: item.read_bytes() for item in (tmp_path / name).iterdir()} for name in "abc"]
    assert every[0] == every[1] != every[2]
    durations = {item: soundfile.info(str(item)).duration for item in sounds}
    assert sum(durations.values()) == pytest.approx(done.seconds, abs=0.01)
    for item, duration in durations.items():
        assert item.with_suffix(".lab").read_text().splitlines()[-1].split()[1] == f"{duration:.4f}"
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
