"""examples/pi: text to sound and servos, in step, with the interface that prints."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import types
import wave
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
import servos
import speak
from voices import Piper, Utterance

import labial
from packages import SOURCE
from runtime import needs_runtime

PI = SOURCE / "examples" / "pi"

pytestmark = needs_runtime

SAY = os.environ.get("LABIAL_SAY_ESPEAK", "")
PATH = f"{Path(SAY).parent}{os.pathsep}{os.environ['PATH']}"
needs_espeak = pytest.mark.skipif(not SAY, reason="no espeak-ng: install the Debian package libespeak-ng-dev")


def program(*arguments: object, folder: Path, path: str = PATH) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(PI / "speak.py"), *map(str, arguments)], capture_output=True, text=True,
                          check=False, cwd=folder, timeout=60, input="",
                          env={**os.environ, "PATH": path, "PYTHONPATH": str(SOURCE / "export")})


@needs_espeak
def test_speaks_and_prints(tmp_path: Path) -> None:
    """The sound goes to aplay, the servos move while it is due, close in m and end at rest."""
    (tmp_path / "aplay").write_text('#!/bin/sh\necho "$@" > aplay.txt\nfor last; do :; done\ncp "$last" heard.wav\n')
    (tmp_path / "aplay").chmod(0o755)
    done = program("--servos", "print", "--sound", "hw:1", "--delay", "0", "Mama may pop.", folder=tmp_path,
                   path=f"{tmp_path}{os.pathsep}{PATH}")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "aplay.txt").read_text().startswith("-q -D hw:1 ")
    with wave.open(str(tmp_path / "heard.wav")) as sound:
        seconds = sound.getnframes() / sound.getframerate()
        assert (sound.getnchannels(), sound.getsampwidth()) == (1, 2) and seconds > 0.4
    rows = [re.fullmatch(r" *(\d+) ms: jaw (\d+) upper_lip (\d+) corners (\d+)", line)
            for line in done.stdout.splitlines()]
    assert all(rows)
    times = [int(row[1]) for row in rows if row]
    assert times == sorted(set(times)) and all(moment % 20 == 0 for moment in times)
    assert abs(times[-1] - 1000 * seconds) <= 20
    rest = labial.Rig(PI / "face.toml").values
    assert [int(value) for value in rows[-1].groups()[1:]] == list(rest.values())  # type: ignore[union-attr]
    jaw = [int(row[2]) for row in rows if row]
    assert max(jaw) > rest["jaw"] + 40


@pytest.mark.parametrize(("arguments", "complaint"), [
    (["--face", "nothing.toml", "x"], "nothing.toml"),
    (["--piper", "nothing.onnx", "x"], "Piper is not installed: pip install 'piper-tts[alignment]'"),
    pytest.param(["--voice", "klingonish", "x"], "espeak-ng has no voice 'klingonish'", marks=needs_espeak),
])  # fmt: skip
def test_what_fails_says_so(tmp_path: Path, arguments: List[str], complaint: str) -> None:
    done = program("--servos", "print", "--sound", "none", *arguments, folder=tmp_path)
    assert done.returncode == 1 and complaint in done.stderr and done.stderr.count("\n") == 1


def test_without_the_program_it_says_where_that_is(tmp_path: Path) -> None:
    done = program("--servos", "print", "x", folder=tmp_path, path=str(tmp_path))
    assert done.returncode == 1 and "labial-say-espeak is not installed: see" in done.stderr


class Clock:
    """Time that only passes while the program sleeps or shows; `stalls` are how long showing a frame takes."""

    def __init__(self, stalls: Dict[int, float]) -> None:
        self.now, self.stalls = 100.0, stalls
        self.shown: List[Tuple[int, float]] = []

    def sleep(self, seconds: float) -> None:
        assert seconds >= 0
        self.now += max(seconds, 1e-5)

    def show(self, number: int, values: Any) -> None:
        assert values == number
        self.shown.append((number, self.now))
        self.now += self.stalls.get(number, 0.001)


@pytest.mark.parametrize("stalls", [{}, {10: 0.05, 20: 0.2}, {49: 1.0}, {k: 0.025 for k in range(60)}])
def test_lips_follow_the_clock(stalls: Dict[int, float]) -> None:
    """Each frame is shown while it is due, none twice; a stall costs frames and no step; the last one is shown."""
    clock = Clock(stalls)
    speak.follow(list(range(60)), 50, clock.show, 100.5, lambda: clock.now, clock.sleep)
    numbers = [number for number, _ in clock.shown]
    assert numbers == sorted(set(numbers)) and numbers[0] == 0 and numbers[-1] == 59
    assert all(-1e-6 <= moment - 100.5 - number / 50 < 0.0202 for number, moment in clock.shown if number < 59)
    assert len(numbers) == 60 or stalls


def test_every_frame_moves_the_face() -> None:
    """Limits of speed count in frames: what is passed over when it is shown has moved the face all the same."""
    motion = labial.render([("M", 100), ("AA", 300), ("M", 100)])
    face = labial.Rig(PI / "face.toml")
    frames = speak.moves(Utterance(b"", 22050, motion), face)
    assert len(frames) == 25
    steps = [abs(after["jaw"] - before["jaw"]) for before, after in zip(frames, frames[1:])]
    whole = labial.Rig(SOURCE / "examples" / "pi" / "face.toml")
    after = [[value for row in motion[place + 1 :] for value in row] for place in range(len(motion))]
    assert frames == [whole.apply(row, rest) for row, rest in zip(motion, after)] and max(steps) > 5


class Bus:
    """An I2C bus that keeps what is written."""

    def __init__(self) -> None:
        self.written: List[Tuple[int, int, Any]] = []

    def write_byte_data(self, address: int, register: int, value: int) -> None:
        self.written.append((address, register, value))

    def write_i2c_block_data(self, address: int, register: int, values: List[int]) -> None:
        self.written.append((address, register, values))


def test_pca9685_gets_its_registers() -> None:
    """As its data sheet has it: asleep for the prescaler, four registers for each channel from 6 on, off at the end."""
    bus, rig = Bus(), labial.Rig(PI / "face.toml")
    device = servos.PCA9685(rig, bus)
    prescale = round(25e6 / 4096 / 50) - 1
    assert bus.written[:3] == [(0x40, 0, 0x10), (0x40, 0xFE, prescale), (0x40, 0, 0x20)]
    ticks = round(1400e-6 / ((prescale + 1) / 25e6))  # the jaw's rest
    assert bus.written[3] == (0x40, 6, [0, 0, ticks % 256, ticks // 256])
    assert [register for _, register, _ in bus.written[3:]] == [6, 10, 14]
    bus.written.clear()
    device.show(20, {"jaw": 0x0123, "upper_lip": 0x0FFF, "corners": 5})
    assert bus.written == [(0x40, 6, [0, 0, 0x23, 1]), (0x40, 10, [0, 0, 0xFF, 15]), (0x40, 14, [0, 0, 5, 0])]
    device.close()
    assert bus.written[-1] == (0x40, 0xFD, 0x10)
    with pytest.raises(ValueError, match='jaw is made for us: write unit = "pca9685"'):
        servos.PCA9685(labial.Rig(SOURCE / "examples" / "faces" / "jaw.toml"), bus)


def test_without_i2c_the_servos_are_printed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    rig = labial.Rig(PI / "face.toml")

    def refused(number: int) -> Any:
        raise FileNotFoundError(2, "No such file or directory", f"/dev/i2c-{number}")

    broken = types.SimpleNamespace(SMBus=refused)
    for module, why in ((None, "smbus2 is not installed"), (broken, "no PCA9685 answers")):
        monkeypatch.setitem(sys.modules, "smbus2", module)  # type: ignore[arg-type]
        assert isinstance(servos.open_servos(rig), servos.Printer)
        assert why in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "smbus2", types.SimpleNamespace(SMBus=lambda number: Bus()))
    assert isinstance(servos.open_servos(rig), servos.PCA9685)


def test_piper_tells_its_phonemes(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a stand-in for Piper's package: sound joined, samples as milliseconds, characters as phonemes."""

    def chunk(text: str, samples: int) -> Any:
        return types.SimpleNamespace(
            audio_int16_bytes=b"\1\0" * samples * len(text), sample_rate=22050,
            phoneme_alignments=[types.SimpleNamespace(phoneme=one, num_samples=samples) for one in text])

    voice = types.SimpleNamespace(synthesize=lambda text, include_alignments: [chunk("^ma$", 2205), chunk("bi", 1102)])
    module = types.SimpleNamespace(PiperVoice=types.SimpleNamespace(load=lambda path, include_alignments: voice))
    monkeypatch.setitem(sys.modules, "piper", module)  # type: ignore[arg-type]
    monkeypatch.setattr(labial, "render", lambda timings, **options: timings)
    said = Piper("voice.onnx").say("mabi")
    assert len(said.sound) == 2 * (4 * 2205 + 2 * 1102) and said.rate == 22050
    labels = [label for label, _ in said.motion]
    assert labels[0] == "SIL" and labels[1] == "M" and "B" in labels and labels[-1] in ("IY", "IH")
    assert abs(sum(milliseconds for _, milliseconds in said.motion) - 500 * len(said.sound) / said.rate) <= 1
