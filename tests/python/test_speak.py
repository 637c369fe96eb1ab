"""labial-say-flite and labial-say-espeak: sound and motion that begin, go on and end together.

The environment variables LABIAL_SAY_FLITE and LABIAL_SAY_ESPEAK hold the programs' paths.
"""

from __future__ import annotations

import csv
import ctypes
import io
import os
import subprocess
import wave
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

from packages import SOURCE
from test_say import run

PROGRAMS = ("flite", "espeak")
#: Frames after the sound, in which the face comes to rest.
REST = 12
TEXT = "Mama may be home. Papa may be happy. Bob made a map, maybe. Pam bombed a baby mob."


def speak(program: str, *arguments: str, text: str = "") -> subprocess.CompletedProcess:
    """Runs a program; skips where it is not built."""
    return run(f"labial-say-{program}", *arguments, data=text.encode())


def sound_and_motion(program: str, folder: Path, text: str) -> Tuple[np.ndarray, int, np.ndarray, List[str]]:
    """Samples, samples per second, (T,) lip opening in FAP units at 50 frames per second, and messages."""
    done = speak(program, str(folder / "a.wav"), text)
    assert done.returncode == 0, done.stderr
    with wave.open(str(folder / "a.wav")) as sound:
        assert (sound.getnchannels(), sound.getsampwidth()) == (1, 2)
        rate = sound.getframerate()
        samples = np.frombuffer(sound.readframes(sound.getnframes()), dtype="<i2").astype(np.float64)
        assert len(samples) == sound.getnframes(), "the header tells the length"
    rows = list(csv.DictReader(io.StringIO(done.stdout.decode())))
    opening = np.array([-float(row["fap51"]) - float(row["fap52"]) for row in rows])
    assert float(rows[-1]["time"]) == pytest.approx((len(rows) - 1) / 50)
    return samples, rate, opening, done.stderr.decode().splitlines()


@pytest.mark.parametrize("program", PROGRAMS)
def test_sound_and_motion_are_in_step(program: str, tmp_path: Path) -> None:
    """Catches motion of another length than the sound, and motion that runs ahead or behind: lips that open when the
    sound swells fit best where neither is shifted, give or take two frames."""
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
    lengths = {}
    for name in "ab":
        with wave.open(str(tmp_path / f"{name}.wav")) as sound:
            lengths[name] = sound.getnframes() / sound.getframerate()
    assert lengths["b"] > 1.7 * lengths["a"]
    assert abs(len(many.stdout.splitlines()) - 1 - REST - 50 * lengths["b"]) <= 1


@pytest.mark.parametrize("program", PROGRAMS)
def test_other_formats(program: str, tmp_path: Path) -> None:
    """Catches a format that only labial-say writes."""
    done = speak(program, "--to", "fap", str(tmp_path / "a.wav"), "Mama.")
    count = int(done.stdout.splitlines()[0].split()[3])
    assert done.returncode == 0 and len(done.stdout.splitlines()) == 1 + 2 * count and count > 10


@pytest.mark.parametrize("program", PROGRAMS)
def test_errors(program: str, tmp_path: Path) -> None:
    """Catches a failure that passes for success, or that says nothing."""
    for arguments in ([str(tmp_path / "none" / "a.wav"), "Mama."], [str(tmp_path / "a.wav"), " \n"]):
        done = speak(program, *arguments)
        assert done.returncode == 1 and done.stdout == b"", arguments
        assert done.stderr.startswith(f"labial-say-{program}: ".encode()) and done.stderr.count(b"\n") == 1


#: A sentence each; those of the Slavic and Asian languages hold signs and tones that espeak-ng reports as phonemes.
LANGUAGES = {
    "de": "Schöne Grüße, lieber Jürgen, es ist fünf Uhr.", "fr-fr": "Une lune bleue, un peu de beurre, bien sûr.",
    "ru": "Привет, мир. Семь дней, пять минут.", "pl": "Dzień dobry, pięć minut.", "tr": "Süpürge üstünde bir kuş.",
    "cmn": "你好，我们今天去北京。", "vi": "Xin chào thế giới, tiếng Việt.", "fa": "سلام دنیا. پدر و مادر خوب.",
    "nl": "Goedemorgen, het huis is duur.", "sv": "Sju sjösjuka sjömän.", "fi": "Hyvää yötä, työ on hyvä.",
}  # fmt: skip


def test_languages_of_espeak(tmp_path: Path) -> None:
    """Catches IPA of espeak's that no alias table knows, and marks of it that are taken for phonemes: no warnings."""
    text = ("The quick brown fox jumps over the lazy dog. Thursday's vision of leisure; church judges, a poor tour, "
            "fire, an hour, here and there, a button, a bottle, the city, music, oil and cows.")
    for voice in ("en-us", "en-gb"):
        done = speak("espeak", "--voice", voice, str(tmp_path / "a.wav"), text)
        assert done.returncode == 0 and done.stderr == b""
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
    """Catches the shut lips before a burst, which espeak-ng gives to the vowel: there is no stop here but p, so that
    all short silences are of shut lips. As espeak-ng reports them, lips are open in 11 of 17."""
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
    subprocess.run([os.environ.get("LABIAL_CC", "cc"), "-O1", "-shared", "-fPIC",
                    str(SOURCE / "tools/speak/closure.c"), "-o", str(target)], check=True)
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
])  # fmt: skip
def test_stops_begin_where_the_sound_falls_silent(closure: ctypes.CDLL, levels: List[Tuple[int, int]], before: int,
                                                  burst: int, expected: int, rate: int) -> None:
    """Catches a closure that is longer or shorter than the silence, one in a voiced stop, and more taken from the vowel
    than it has; whatever the rate and the pieces that the sound comes in."""
    for piece in (97, 100000):
        assert abs(begin(closure, levels, before, burst, rate, piece) - expected) <= 5


def test_stops_by_their_labels(closure: ctypes.CDLL) -> None:
    """Catches a label of a stop that is passed over, and a vowel or fricative that is taken for one."""
    for label in "p t k b d ɡ g c q ʈ ɖ ɟ ɢ pʰ tʃ dʒ k-".split():
        assert closure.closure_is_stop(label.encode()), label
    for label in ["m", "s", "f", "ɑː", "ə", "ɾ", "ʔ", "β", "ɣ", ""]:
        assert not closure.closure_is_stop(label.encode()), label
