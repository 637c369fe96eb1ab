"""labial-say-flite and labial-say-espeak: sound and motion that begin, go on and end together.

The environment variables LABIAL_SAY_FLITE and LABIAL_SAY_ESPEAK hold the programs' paths.
"""

from __future__ import annotations

import csv
import io
import os
import subprocess
import wave
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

PROGRAMS = {name: os.environ.get(f"LABIAL_SAY_{name.upper()}", "") for name in ("flite", "espeak")}
TEXT = "Mama may be home. Papa may be happy. Bob made a map, maybe. Pam bombed a baby mob."


def speak(program: str, *arguments: str, text: str = "") -> subprocess.CompletedProcess:
    """Runs a program; skips where it is not built."""
    if not PROGRAMS[program]:
        pytest.skip(f"LABIAL_SAY_{program.upper()} does not name the built labial-say-{program}")
    return subprocess.run([PROGRAMS[program], *arguments], input=text.encode(), capture_output=True, timeout=60,
                          check=False)


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
    assert abs(len(opening) - 50 * len(samples) / rate) <= 1
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
    assert abs(len(many.stdout.splitlines()) - 1 - 50 * lengths["b"]) <= 1


@pytest.mark.parametrize("program", PROGRAMS)
def test_other_formats(program: str, tmp_path: Path) -> None:
    """Catches a format that only labial-say writes."""
    done = speak(program, "--to", "fap", str(tmp_path / "a.wav"), "Mama.")
    count = int(done.stdout.splitlines()[0].split()[3])
    assert done.returncode == 0 and len(done.stdout.splitlines()) == 1 + 2 * count and count > 10


@pytest.mark.parametrize("program", PROGRAMS)
def test_errors(program: str, tmp_path: Path) -> None:
    """Catches a failure that passes for success, or that says nothing."""
    for status, arguments in ((2, []), (2, [str(tmp_path / "a.wav")]), (2, ["--to", "x", "a", "b"]), (2, ["--what"]),
                              (2, ["a", "b", "c"]), (1, [str(tmp_path / "none" / "a.wav"), "Mama."]),
                              (1, [str(tmp_path / "a.wav"), " \n"])):
        done = speak(program, *arguments)
        assert done.returncode == status and done.stdout == b"", arguments
        assert done.stderr.startswith(f"labial-say-{program}: ".encode()) and done.stderr.count(b"\n") == 1
    assert speak(program, "--help").returncode == 0


def test_languages_of_espeak(tmp_path: Path) -> None:
    """Catches IPA of espeak's that no alias table knows: English of two kinds without a warning, others at work."""
    text = ("The quick brown fox jumps over the lazy dog. Thursday's vision of leisure; church judges, a poor tour, "
            "fire, an hour, here and there, a button, a bottle, the city, music, oil and cows.")
    for voice in ("en-us", "en-gb"):
        done = speak("espeak", "--voice", voice, str(tmp_path / "a.wav"), text)
        assert done.returncode == 0 and done.stderr == b""
    done = speak("espeak", "--voice", "de", str(tmp_path / "a.wav"), "Schöne Grüße, lieber Jürgen.")
    assert done.returncode == 0 and len(done.stdout.splitlines()) > 50
    done = speak("espeak", "--voice", "nobody", str(tmp_path / "a.wav"), "x")
    assert done.returncode == 1 and b"no voice 'nobody'" in done.stderr
