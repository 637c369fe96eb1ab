"""Hearing from Python and from the command line: the frames of the exporter's integers, for sound in any pieces."""

from __future__ import annotations

import asyncio
import io
import math
import shutil
import struct
import subprocess
import sys
import wave
from array import array
from pathlib import Path
from typing import Any, AsyncIterator, List

import hears
import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.errors import LabialError, StreamError
from labial.files.frames import opening
from labial.hearing import integer
from labial.hearing.model import load
from labial.hearing.quantise import HearingTables, quantise
from labial.runtime.hearing import models
from labial.tables.visemes import VISEME_OF, VISEMES
from models import write_wav
from packages import SOURCE, needs_runtime
from test_hearing import voice

NAMES = ("hear_small", "hear_large", "hear_host", "hear_ahead")

pytestmark = [needs_runtime, pytest.mark.skipif(not list((SOURCE / "export/models").glob("hear_*.npz")),
                                                reason="no model of hearing is bundled")]

SENTENCES = ("My baby may be happy when you move the blue boat.", "She sells sea shells by the shore on Thursday.",
             "Five fat frogs found a very thin path.", "The judge should choose the red chair.",
             "Look at the good book and cook some food.", "Who would not want to go there with me?",
             "Please show the boy how to use the tools.", "Vera thought that both of them were here.")
#: A level of the stream in the exporter's units.
SCALE = integer.LEVEL_ONE // integer.LOG


def tables(name: str) -> HearingTables:
    """Of a bundled model."""
    return quantise(load(SOURCE / "export" / "models" / f"{name}.npz"), name)


def wanted(sound: np.ndarray, rate: int = 16000, name: str = "hear_small", begin: int = integer.BEGIN) -> integer.Heard:
    """What the exporter's integers make of a sound that begins at a level."""
    return integer.delivered(tables(name), sound, rate, begin=begin)


def measured(sound: np.ndarray, rate: int) -> int:
    """The exporter's largest level of a sound."""
    samples = integer.convert(sound, rate)
    energies = integer.log_energies(samples[: len(samples) // 160 * 160])
    return int(integer.levels(energies, np.zeros(len(energies), dtype=bool), SCALE * 3328).hops.max()) * SCALE


def numbers(frames: List[labial.Frame]) -> List[List[int]]:
    """The FAPs of frames."""
    return [list(frame.faps) for frame in frames]


@pytest.mark.parametrize(("name", "rate"), zip(NAMES, (8000, 16000, 44100, 16000)))
def test_frames_are_the_exporters(name: str, rate: int) -> None:
    """Catches a model in the library that is another than the trained one, and frames that are lost between calls."""
    sound = voice(2.0, rate=rate)
    with labial.Hearing(rate, model=name) as hearing:
        frames = list(hearing.frames(np.array_split(sound, 17)))
        shown = hearing.shown()
        assert hearing.fps == 50 and hearing.latency == pytest.approx(0.28 if name == "hear_ahead" else 0.12, abs=0.002)
    heard = wanted(sound, rate, name)
    assert numbers(frames) == heard.faps.tolist()
    assert [list(frame.visemes) for frame in frames] == integer.visemes(tables(name), sound, rate).tolist()
    assert [frame.number for frame in frames] == list(range(100 + 12))
    assert models()[0] == "hear_host" and set(models()) == set(NAMES) == {
        path.stem for path in (SOURCE / "export/models").glob("hear_*.npz")}
    classes = load(SOURCE / "export" / "models" / f"{name}.npz").classes
    assert [[*item] for item in shown] == [[classes[k], first, length]
                                           for k, first, length in hears.stretches(heard.scores)]


def test_articulation_and_a_slow_cancel() -> None:
    """Catches an articulation that does not reach C, and frames of a cancel that have no room."""
    sound = voice(1.0)
    with labial.Hearing(model="hear_small", exact=True) as hearing:
        plain = np.array(numbers(list(hearing.frames([sound]))))
        hearing.restart()
        hearing.level = 6656
        hearing.articulation(49.6)
        half = np.array(numbers(list(hearing.frames([sound]))))[8:]
        assert np.abs(2 * half - plain[8:]).max() <= 2 and np.abs(plain).max() > 50
        hearing.restart()
        hearing.articulation(0)
        hearing.push(sound)
        assert len(hearing.cancel(1000)) == 50
        hearing.restart()
        assert [len(hearing.cancel(length)) for length in (0, 19.5, 20.5, 10**6)] == [1, 1, 2, 1000]
        for wrong in (-1, 201, float("nan")):
            with pytest.raises(LabialError, match="not within 0 .. 200"):
                hearing.articulation(wrong)


def test_sound_comes_in_many_forms() -> None:
    """Catches bytes that are cut within a sample, and buffers whose items are taken for bytes."""
    long = np.tile(voice(3.0), 4)
    with labial.Hearing(model="hear_small") as hearing:  # has more frames than one call has room for
        assert numbers(hearing.push(long) + hearing.end()) == wanted(long).faps.tolist()
    sound = voice(0.5)
    data = sound.astype("<i2").tobytes()
    whole = wanted(sound).faps.tolist()
    for blocks in ([data], [bytearray(data)], [data[:1], data[1:4], data[4:777], data[777:]], [memoryview(data)],
                   [sound], [sound[:100].reshape(-1, 1), memoryview(sound[100:])], [array("h", sound.tolist())],
                   [np.repeat(sound, 2)[::2]]):
        with labial.Hearing(model="hear_small") as hearing:
            assert numbers(list(hearing.frames(blocks))) == whole
    stereo = np.stack([sound, sound // 2], axis=1)
    for block in (stereo, stereo.astype("<i2").tobytes(), stereo.ravel()):
        with labial.Hearing(model="hear_small", channels=2) as hearing:
            assert numbers(list(hearing.frames([block]))) == wanted(stereo).faps.tolist()


def test_sound_may_come_from_an_asynchronous_source() -> None:
    """Catches frames that are kept back until the end."""
    sound = voice(0.6)
    told: List[int] = []

    async def blocks() -> AsyncIterator[bytes]:
        for piece in np.array_split(sound, 6):
            told.append(-len(piece))
            yield piece.astype("<i2").tobytes()

    async def follow() -> List[List[int]]:
        found = []
        with labial.Hearing(model="hear_small") as hearing:
            async for frame in hearing.follow(blocks()):
                told.append(frame.number)
                found.append(list(frame.faps))
        return found

    assert asyncio.run(follow()) == wanted(sound).faps.tolist()
    assert 0 <= told.index(0) < len(told) - 1 - told[::-1].index(-1600)


def test_the_level_is_known() -> None:
    """Catches a level that is not the stream's, a measurement that looks too rarely or begins too high, and one that
    changes more than the level."""
    sound = voice(1.0) // 64
    with labial.Hearing(model="hear_small") as hearing:
        assert hearing.level == 6656
        data = sound.astype("<i2").tobytes()
        assert hearing.measure(data + b"\x7f") == hearing.measure(data)  # bytes that end within a sample
        assert hearing.measure(sound) == hearing.level == measured(sound, 16000) // SCALE < 6000
        begin = hearing.level * SCALE
        frames = hearing.push(sound)
        with pytest.raises(StreamError, match="not allowed now"):
            hearing.level = 5000
        assert numbers(frames + hearing.end()) == wanted(sound, begin=begin).faps.tolist()
        assert hearing.level == integer.level_after(tables("hear_small"), sound, begin=begin) // SCALE
        for wrong in (-1, 3327, 11777, 2**40):
            with pytest.raises(StreamError, match="level"):
                hearing.level = wrong
        with pytest.raises((LabialError, TypeError)):
            hearing.level = "loud"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seconds", [0.5, 1.0, 4.0])
@pytest.mark.parametrize("scale", [1.0, 0.125])
def test_room_noise_before_the_first_word_does_not_open_the_mouth(name: str, seconds: float, scale: float) -> None:
    """Noise as of a room, 40 dB below the voice: the lips stay together until 100 ms before the first word, and then
    they open; the same after a restart. Catches noise that is taken for a voice."""
    speech, before = voice(1.5).astype(float), round(seconds * 16000) // 320 * 320
    random = np.random.default_rng(1)
    spectrum = np.fft.rfft(random.normal(size=before + len(speech)))
    noise = np.fft.irfft(spectrum / np.sqrt(np.arange(len(spectrum)) + 500.0), before + len(speech))
    noise *= 0.01 * np.sqrt(np.mean(speech**2) / np.mean(noise**2))
    sound = np.rint((np.concatenate([np.zeros(before), speech]) + noise) * scale).astype(np.int16)
    with labial.Hearing(model=name) as hearing:
        for _ in range(2):
            gap = opening(np.array(numbers(list(hearing.frames([sound])))))
            assert gap[: before // 320 - 5].max() <= 60 < gap[before // 320 :].max()
            hearing.restart()


def decibels(sound: np.ndarray, level: float) -> np.ndarray:
    """(N,) int16: a sound whose root mean square is so many dBFS."""
    return np.rint(sound / np.sqrt(np.mean(sound**2)) * 32768 * 10 ** (level / 20)).astype(np.int16)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("tilt", "rests", "opens"), [(0.0, -55, -50), (0.5, -55, -48), (1.0, -40, -35)])
def test_steady_noise_opens_the_mouth_from_a_level_on(name: str, tilt: float, rests: int, opens: int) -> None:
    """White noise, pink and brown, above 20 Hz, of the levels that hear.h and docs/hearing.md state. Catches noise that
    is taken for a voice, and a page that promises too much or too little."""
    spectrum = np.fft.rfft(np.random.default_rng(1).normal(size=4 * 16000)) * (np.arange(2 * 16000 + 1) >= 80)
    noise = np.fft.irfft(spectrum / np.maximum(np.arange(len(spectrum)), 1.0) ** tilt)
    with labial.Hearing(model=name) as hearing:
        assert not np.any(numbers(list(hearing.frames([decibels(noise, rests)]))))
    with labial.Hearing(model=name) as hearing:
        assert np.all(np.any(numbers(list(hearing.frames([decibels(noise, opens)])))[100:150], axis=1))


@pytest.mark.parametrize("name", NAMES)
def test_faint_speech_is_heard(name: str) -> None:
    """With peaks of -44 dBFS, as hear.h and docs/hearing.md state: the same motion, which begins little later."""
    with wave.open(str(SOURCE / "examples" / "talk" / "talk.wav")) as file:
        rate, loud = file.getframerate(), np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    gaps: List[np.ndarray] = []
    for peak in (32767, 200):
        with labial.Hearing(rate, 1, model=name, exact=True) as hearing:
            sound = np.rint(loud / np.abs(loud).max() * peak).astype(np.int16)
            gaps.append(opening(np.array(numbers(list(hearing.frames([sound]))))))
    begins = [int(np.argmax(np.abs(gap) > 20)) for gap in gaps]
    assert np.corrcoef(gaps)[0, 1] > 0.9 and 0 <= begins[1] - begins[0] <= 12


def test_cancel_and_restart() -> None:
    """Catches numbers that begin again, and sound from before a restart."""
    sound = voice(0.5)
    with labial.Hearing(model="hear_small") as hearing:
        with pytest.raises(StreamError, match="restart"):
            hearing.restart()
        before = hearing.push(sound.tobytes() + b"x")
        eased = hearing.cancel(100)
        assert [frame.number for frame in eased] == list(range(len(before), len(before) + 5))
        assert eased[-1].faps == (0,) * 13
        with pytest.raises(StreamError, match="not allowed now"):
            hearing.push(sound)
        assert hearing.end() == []
        hearing.restart()
        again = hearing.push(sound) + hearing.end()
        assert again[0].number == len(before) + 5
        level = integer.levels(integer.log_energies(sound), np.zeros(50, dtype=bool), integer.BEGIN).last
        assert numbers(again)[8:] == wanted(sound, begin=level).faps.tolist()[8:]
    for call in (hearing.end, hearing.restart, hearing.shown, hearing.cancel, hearing.__enter__):
        with pytest.raises(StreamError, match="closed"):
            call()
    with pytest.raises(StreamError, match="closed"):
        hearing.push(b"")


@pytest.mark.parametrize("given, error, message", [
    ({"sample_rate": 11025}, StreamError, "11025 samples per second, channels: 1: sound of so many"),
    ({"channels": 3}, StreamError, "channels: 3"),
    ({"sample_rate": -1}, LabialError, "not supported"),
    ({"sample_rate": "x"}, TypeError, "a sample rate"),
    ({"model": "speech_en"}, LabialError, "'speech_en' is no model of hearing: there are hear_host"),
])
def test_wrong_arguments_are_refused(given: Any, error: type, message: str) -> None:
    """Catches a number that is passed to C as it is."""
    with pytest.raises(error, match=message):
        labial.Hearing(**given)


@pytest.mark.parametrize("sound, error", [
    (np.zeros(4), TypeError), (np.zeros(4, np.int32), TypeError), ("text", TypeError), (None, TypeError),
    (np.zeros((4, 2), np.int16), LabialError), (np.zeros((2, 1, 1), np.int16), LabialError),
    (np.array(3, np.int16), LabialError),
])
def test_other_sounds_are_refused(sound: Any, error: type) -> None:
    """Catches floats that are heard as noise."""
    with labial.Hearing(model="hear_small") as hearing, pytest.raises(error):
        hearing.push(sound)


# ---- The command -----------------------------------------------------------------------------------------------------


def rows(text: str) -> np.ndarray:
    """(T, 13) of a frames file."""
    return np.array([line.split(",")[1:] for line in text.splitlines()[1:]], dtype=float)


def test_the_command_writes_frames(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches a file that is heard at another rate, or one channel of two."""
    sound = voice(0.7, rate=24000)
    stereo = np.stack([sound, -(sound // 3)], axis=1)
    for name, samples in (("one.wav", sound), ("two.wav", stereo)):
        path = str(write_wav(tmp_path / name, samples, 24000))
        assert main(["hear", path, "--model", "small", "--sound-alone"]) == 0
        expected = wanted(samples, 24000, begin=measured(samples, 24000)).faps
        assert rows(capsys.readouterr().out).tolist() == expected.tolist()
    begin = measured(sound, 24000)
    assert main(["hear", str(tmp_path / "one.wav"), "--model", "large", "--sound-alone", "-o",
                 str(tmp_path / "out.csv")]) == 0
    assert rows((tmp_path / "out.csv").read_text()).tolist() == wanted(sound, 24000, "hear_large", begin).faps.tolist()
    assert main(["hear", str(tmp_path / "one.wav"), "--model", "small", "--sound-alone", "--to", "fap"]) == 0
    assert capsys.readouterr().out.splitlines()[0].split()[-1] == "47"
    assert main(["hear", str(tmp_path / "one.wav"), "--sound-alone", "--exact", "--model", "small"]) == 0
    assert rows(capsys.readouterr().out).tolist() == wanted(sound, 24000, begin=begin).faps[:35].tolist()
    assert main(["hear", str(tmp_path / "one.wav"), "--model", "small", "--sound-alone", "--to", "jsonl"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 35 + 12


def test_the_command_reads_standard_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                          capsys: pytest.CaptureFixture) -> None:
    """Or raw samples. Catches these that are heard as a file, a header that is heard as samples, its rate and channels
    that are passed over, bytes lost behind it."""
    sound = voice(0.5, rate=48000)
    stereo = np.stack([sound, sound], axis=1)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stereo.astype("<i2").tobytes())))
    assert main(["hear", "-", "--rate", "48000", "--channels", "2"]) == 0
    assert rows(capsys.readouterr().out).tolist() == wanted(sound, 48000, "hear_host").faps.tolist()
    data = write_wav(tmp_path / "a.wav", stereo, 48000).read_bytes()
    endless = data[:40] + struct.pack("<I", 0x7FFFF000) + data[44:]  # as programs write that do not know the size
    for given in (data, endless.replace(data[4:8], struct.pack("<I", 0x7FFFF024), 1)):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given)))
        assert main(["hear", "-"]) == 0
        assert rows(capsys.readouterr().out).tolist() == wanted(sound, 48000, "hear_host").faps.tolist()
    other = write_wav(tmp_path / "b.wav", sound, 11025).read_bytes()
    for given in (other, b"RF64" + data[4:], data[:30]):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given)))
        assert main(["hear", "-"]) == 1
        assert capsys.readouterr().err == ("labial: standard input: a sound with a header must be a WAV file of 16 "
                                           "bits, one or two channels and a usual rate\n")
    monkeypatch.setattr(sys, "stdin", None)
    assert main(["hear", "-"]) == 1 and capsys.readouterr().err == "labial: standard input is closed\n"


def test_other_files_are_converted(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches a rate that is taken for another: 11025 Hz, 8 bits."""
    pytest.importorskip("soundfile")
    pytest.importorskip("soxr")
    sound = voice(1.0, rate=11025)
    write_wav(tmp_path / "low.wav", (sound >> 8) + 128, 11025, 1)
    assert main(["hear", str(tmp_path / "low.wav"), "--sound-alone", "--exact"]) == 0
    assert len(rows(capsys.readouterr().out)) == 50


@pytest.mark.parametrize("arguments, message", [
    (["none.wav"], "none.wav: No such file"),
    (["text.wav"], "text.wav"),
    (["a.wav", "--rate", "16000"], "--rate and --channels go with -"),
    (["-", "--rate", "11025"], "11025 samples per second"),
])
def test_the_command_says_what_is_wrong(arguments: List[str], message: str, tmp_path: Path,
                                        monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """Catches a traceback."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "text.wav").write_bytes(b"RIFF" + struct.pack("<I", 4) + b"text")
    assert main(["hear", *arguments]) == 1
    assert message in capsys.readouterr().err


@pytest.mark.skipif(not shutil.which("flite"), reason="needs the Debian package flite")
def test_the_leading_sound_is_mostly_that_of_the_phoneme(tmp_path: Path) -> None:
    """Catches shares of another frame, and classes that have another class's viseme. docs/hearing.md has the figures of
    these sentences for other voices and models."""
    right = count = 0
    for text in SENTENCES:
        path = str(tmp_path / "a.wav")
        told = subprocess.run(["flite", "-voice", "rms", "-t", text, "-psdur", "-o", path], check=True, text=True,
                              stdout=subprocess.PIPE).stdout
        with wave.open(path) as file:
            sound, rate = file.readframes(file.getnframes()), file.getframerate()
        with labial.Hearing(rate, model="hear_small", exact=True) as hearing:
            hearing.measure(sound)
            frames = list(hearing.frames([sound]))
        begin = 0.0
        for phoneme, end in (item.split(":") for item in told.split()):
            viseme = VISEME_OF.get(phoneme.upper().replace("AX", "AH"))
            for frame in frames[math.ceil(begin * 50 - 0.5) : math.ceil(float(end) * 50 - 0.5)] if viseme else []:
                right += list(VISEMES)[int(np.argmax(frame.visemes))] == viseme
                count += 1
            begin = float(end)
    assert count > 900 and right / count > 0.72
