"""Examples: in Python, text to sound and servos in step on a Pi, and a mouth that follows a file, sounddevice and
arecord; the programs of examples/rig: what a face would do with their output, on the bundled models."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import types
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest
import soundfile

import follow
import labial
import servos
import speak
from labial.errors import LabialError
from labial.program import run
from labial.rig.description import read
from labial.rig.table import convert
from models import write_wav
from packages import SOURCE, needs_runtime
from packages import run as ran
from test_hearing import voice

PI = SOURCE / "examples" / "pi"

SAY = os.environ.get("LABIAL_SAY_ESPEAK", "")
PATH = f"{Path(SAY).parent}{os.pathsep}{os.environ['PATH']}"
needs_espeak = pytest.mark.skipif(not SAY, reason="no espeak-ng: install the Debian package libespeak-ng-dev")


def program(*arguments: object, folder: Path, path: str = PATH) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(PI / "speak.py"), *map(str, arguments)], capture_output=True, text=True,
                          check=False, cwd=folder, timeout=60, input="",
                          env={**os.environ, "PATH": path, "PYTHONPATH": str(SOURCE / "export")})


@needs_runtime
@needs_espeak
def test_speaks_and_prints(tmp_path: Path) -> None:
    """The sound goes to aplay, the servos move while it is due, close in m and end at rest."""
    (tmp_path / "aplay").write_text('#!/bin/sh\necho "$@" > aplay.txt\nfor last; do :; done\ncp "$last" heard.wav\n')
    (tmp_path / "aplay").chmod(0o755)
    done = program("--servos", "print", "--sound", "hw:1", "--delay", "0", "Mama may pop.", folder=tmp_path,
                   path=f"{tmp_path}{os.pathsep}{PATH}")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "aplay.txt").read_text().startswith("-q -D hw:1 ")
    sound = soundfile.info(str(tmp_path / "heard.wav"))
    assert (sound.channels, sound.subtype) == (1, "PCM_16") and sound.duration > 0.4
    rows = [re.fullmatch(r" *(\d+) ms: jaw (\d+) upper_lip (\d+) corners (\d+)", line)
            for line in done.stdout.splitlines()]
    times = [int(row[1]) for row in rows]
    assert times == sorted(set(times)) and all(moment % 20 == 0 for moment in times)
    assert -20 <= times[-1] - 1000 * sound.duration <= 500  # to the end, and then to rest
    rest = labial.Rig(PI / "face.toml").values
    assert [int(value) for value in rows[-1].groups()[1:]] == list(rest.values())
    jaw = [int(row[2]) for row in rows]
    assert max(jaw) > rest["jaw"] + 40


@needs_runtime
@pytest.mark.parametrize(("arguments", "complaint"), [
    (["--face", "nothing.toml", "x"], "nothing.toml"),
    (["--piper", "nothing.onnx", "x"], "this voice needs the package piper: pip install 'piper-tts[alignment]'"),
    (["--delay", "-1", "x"], "argument --delay: '-1' is not a number from 0 to 10"),
    (["--servos", "none", "x"], "argument --servos: invalid choice"),
    pytest.param(["--voice", "klingonish", "x"], "espeak-ng has no voice 'klingonish'", marks=needs_espeak),
])
def test_what_fails_says_so(tmp_path: Path, arguments: List[str], complaint: str) -> None:
    done = program("--servos", "print", "--sound", "none", *arguments, folder=tmp_path)
    assert done.returncode == (2 if complaint.startswith("argument ") else 1) and done.stdout == ""
    assert done.stderr.startswith("speak: ") and complaint in done.stderr and done.stderr.count("\n") == 1


@needs_runtime
@needs_espeak
def test_without_its_programs_it_says_what_to_install(tmp_path: Path) -> None:
    """Catches "[Errno 2] No such file or directory: 'aplay'"."""
    for built, complaint in ((False, "this voice needs labial-say-espeak: build it (docs/install.md)"),
                             (True, "the sound needs aplay: apt-get install alsa-utils, or --sound none")):
        if built:
            (tmp_path / "labial-say-espeak").symlink_to(SAY)
        done = program("--servos", "print", "x", folder=tmp_path, path=str(tmp_path))
        assert (done.returncode, done.stderr) == (1, f"speak: {complaint}\n")


class Clock:
    """Time that only passes while the program sleeps or shows; `stalls` are how long showing a frame takes."""

    def __init__(self, stalls: Dict[int, float]) -> None:
        self.now, self.stalls = 100.0, stalls
        self.shown: List[Tuple[int, float, int]] = []

    def sleep(self, seconds: float) -> None:
        assert seconds >= 0
        self.now += max(seconds, 1e-5)

    def show(self, number: int, values: Any) -> None:
        self.shown.append((number, self.now, values["x"]))
        self.now += self.stalls.get(number, 0.001)


@needs_runtime
@pytest.mark.parametrize("stalls", [{}, {10: 0.05, 20: 0.2}, {49: 0.1}, {0: 1.3}, {k: 0.025 for k in range(60)}])
@pytest.mark.parametrize("frames", [1, 60, 200])
def test_lips_follow_the_clock(tmp_path: Path, stalls: Dict[int, float], frames: int) -> None:
    """Each frame is shown while it is due, none twice; a stall costs frames and no step; then the face rests."""
    (tmp_path / "x.toml").write_text('unit = "plain"\n[output.x]\nfrom = { fap3 = 1.0 }\nneutral = 0\ngain = 1.0\n'
                                     "minimum = 0\nmaximum = 1000\n")
    face, clock = labial.Face(tmp_path / "x.toml", ahead=speak.AHEAD), Clock(stalls)
    motion = [[number + 1] + [0] * 12 for number in range(frames)]
    speak.follow(motion, face, 50, clock.show, 100.5, lambda: clock.now, clock.sleep)
    numbers = [number for number, _, _ in clock.shown]
    assert numbers == sorted(set(numbers)) and numbers[0] == 0 and numbers[-1] >= frames
    assert all(-1e-6 <= moment - 100.5 - number / 50 < 0.0202 for number, moment, _ in clock.shown)
    assert all(value == number + 1 for number, _, value in clock.shown if number < frames)
    assert clock.shown[-1][2] == 0 and face.rests
    assert len(numbers) == numbers[-1] + 1 or stalls


@needs_runtime
def test_no_stall_moves_a_servo_faster_than_its_limit() -> None:
    motion = list(labial.render([("M", 100), ("AA", 300), ("M", 100), ("AY", 300)]))
    clock, face = Clock({5: 0.1, 9: 0.3, 25: 0.2}), labial.Face(PI / "face.toml", ahead=speak.AHEAD)
    pulses: List[int] = []

    def show(number: int, values: Any) -> None:
        pulses.append(values["jaw"])
        clock.show(number, {"x": 0})

    speak.follow(motion, face, 50, show, 100.0, lambda: clock.now, clock.sleep)
    slew = round(160e-6 / (122 / 25e6))  # ticks of the PCA9685
    rest = labial.Rig(PI / "face.toml").values["jaw"]
    steps = [abs(after - before) for before, after in zip([rest, *pulses], pulses)]
    assert 5 < max(steps) <= slew + 1 and pulses[-1] == rest
    assert len(pulses) < clock.shown[-1][0]  # frames were passed over


class Bus:
    def __init__(self) -> None:
        self.written: List[Tuple[int, int, Any]] = []

    def write_byte_data(self, address: int, register: int, value: int) -> None:
        self.written.append((address, register, value))

    def write_i2c_block_data(self, address: int, register: int, values: List[int]) -> None:
        self.written.append((address, register, values))


@needs_runtime
def test_pca9685_gets_its_registers(monkeypatch: pytest.MonkeyPatch) -> None:
    """As its data sheet has it: asleep for the prescaler, four registers a channel; one servo after another."""
    bus, face = Bus(), labial.Face(PI / "face.toml")
    monkeypatch.setattr("servos.time.sleep", lambda seconds: None)
    device = servos.PCA9685(face.rig, bus)
    prescale = round(25e6 / 4096 / 50) - 1
    assert bus.written[:3] == [(0x40, 0, 0x10), (0x40, 0xFE, prescale), (0x40, 0, 0x20)]
    ticks = round(1400e-6 / ((prescale + 1) / 25e6))  # the jaw's rest
    assert len(bus.written) == 3  # no pulse before that of rest
    device.start(face)
    assert bus.written[3] == (0x40, 6, [0, 0, ticks % 256, ticks // 256])
    registers = [register for _, register, _ in bus.written[3:]]
    assert registers == [6] * 24 + [6, 10] * 25 + [6, 10, 14] * 26  # one servo after the other
    bus.written.clear()
    device.show(20, {"jaw": 0x0123, "upper_lip": 0x0FFF, "corners": 5})
    assert bus.written == [(0x40, 6, [0, 0, 0x23, 1]), (0x40, 10, [0, 0, 0xFF, 15]), (0x40, 14, [0, 0, 5, 0])]
    device.close()
    assert bus.written[-1] == (0x40, 0xFD, 0x10)
    with pytest.raises(LabialError, match='jaw is made for us: write unit = "pca9685"'):
        servos.PCA9685(labial.Rig(SOURCE / "examples" / "faces" / "jaw.toml"), bus)


@needs_runtime
def test_without_i2c_the_servos_are_printed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    rig = labial.Rig(PI / "face.toml")

    def refused(number: int) -> Any:
        raise FileNotFoundError(2, "No such file or directory", f"/dev/i2c-{number}")

    broken = types.SimpleNamespace(SMBus=refused)
    for module, why in ((None, "a PCA9685 needs smbus2: apt-get"), (broken, "no PCA9685 answers")):
        monkeypatch.setitem(sys.modules, "smbus2", module)
        assert isinstance(servos.open_servos(rig), servos.Printer)
        assert why in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "smbus2", types.SimpleNamespace(SMBus=lambda number: Bus()))
    assert isinstance(servos.open_servos(rig), servos.PCA9685)


@needs_runtime
def test_piper_tells_its_phonemes(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a stand-in for Piper's package: sound joined, samples as milliseconds, characters as phonemes."""

    def chunk(text: str, samples: int) -> Any:
        return types.SimpleNamespace(
            audio_int16_bytes=b"\1\0" * samples * len(text), sample_rate=22050,
            phoneme_alignments=[types.SimpleNamespace(phoneme=one, num_samples=samples) for one in text])

    voice = types.SimpleNamespace(synthesize=lambda text, include_alignments: [chunk("^ma$", 2205), chunk("bi", 1102)])
    module = types.SimpleNamespace(PiperVoice=types.SimpleNamespace(load=lambda path, include_alignments: voice))
    monkeypatch.setitem(sys.modules, "piper", module)
    monkeypatch.setattr(labial, "render", lambda timings, **options: timings)
    said = speak.Piper("voice.onnx").say("mabi")
    assert len(said.sound) == 2 * (4 * 2205 + 2 * 1102) and said.rate == 22050
    labels = [label for label, _ in said.motion]
    assert labels[0] == "SIL" and labels[1] == "M" and "B" in labels and labels[-1] in ("IY", "IH")
    assert abs(sum(milliseconds for _, milliseconds in said.motion) - 500 * len(said.sound) / said.rate) <= 1


# ---- examples/microphone ---------------------------------------------------------------------------------------------


SOUND = voice(0.6)


def command(arguments: List[str]) -> int:
    return run("follow", lambda: follow.main(arguments))


def wanted() -> List[List[int]]:
    with labial.Hearing() as hearing:
        return [list(frame.faps) for frame in hearing.frames([SOUND])]


def shown(text: str) -> List[List[int]]:
    """The frames of --to jsonl, which also have numbers and blendshapes."""
    items = [json.loads(line) for line in text.splitlines()]
    assert [item["frame"] for item in items] == list(range(len(items)))
    assert all(0 <= item["arkit"]["jawOpen"] <= 1 for item in items)
    return [item["faps"] for item in items]


@needs_runtime
def test_a_file_in_place_of_the_microphone(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches another rate, a channel of two, and the bar of another motion."""
    stereo = np.stack([SOUND, SOUND], axis=1)
    path = write_wav(tmp_path / "a.wav", stereo)
    assert command(["--sound", str(path), "--to", "jsonl"]) == 0
    assert shown(capsys.readouterr().out) == wanted()
    assert command(["--sound", str(path)]) == 0
    bars = capsys.readouterr().out.rstrip("\n").split("\r")[1:]
    assert len(bars) == len(wanted()) == 30 + 12 and len({len(item) for item in bars}) == 1
    for item, faps in zip(bars, wanted()):
        assert item.count("#") == min(max(round(-(faps[3] + faps[4]) / 15), 0), 40)


@needs_runtime
def test_blocks_come_as_from_a_microphone(tmp_path: Path) -> None:
    """Catches a file that is heard at once, and one that falls behind."""
    now = [5.0]
    rate, channels, blocks = follow.file(str(write_wav(tmp_path / "a.wav", SOUND)), clock=lambda: now[0],
                                         sleep=lambda seconds: now.__setitem__(0, now[0] + seconds))
    assert (rate, channels) == (16000, 1)
    for number, block in enumerate(blocks, 1):
        assert len(block) == 320 and now[0] == pytest.approx(5 + number / 100)
        now[0] += 0.003  # the time that hearing takes
    assert number == 60


@needs_runtime
def test_sounddevice(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """Catches arguments that RawInputStream does not have; Ctrl-C ends."""
    opened: List[Any] = []

    class RawInputStream:
        def __init__(self, *, samplerate: int, channels: int, dtype: str, blocksize: int) -> None:
            assert (samplerate, channels, dtype) == (16000, 1, "int16")
            if opened:
                raise module.PortAudioError("Error querying device -1")
            opened.append(blocksize)
            self._data = SOUND.tobytes()

        def __enter__(self) -> Any:
            return self

        def __exit__(self, *exception: object) -> None:
            opened.append("closed")

        def read(self, frames: int) -> Any:
            if not self._data:
                raise KeyboardInterrupt
            block, self._data = self._data[: 2 * frames], self._data[2 * frames :]
            return memoryview(block), not self._data

    module = types.ModuleType("sounddevice")
    module.RawInputStream = RawInputStream
    module.PortAudioError = type("PortAudioError", (Exception,), {})
    monkeypatch.setitem(sys.modules, "sounddevice", module)
    assert command(["--to", "jsonl"]) == 0
    told = capsys.readouterr()
    found = shown(told.out)
    assert 20 < len(found) < 30 and found == wanted()[: len(found)]
    assert told.err == "follow: this computer is too slow: sound was lost\n"
    assert opened == [160, "closed"]
    assert command([]) == 1
    assert "follow: the microphone: Error querying device -1\n" in capsys.readouterr().err


@needs_runtime
@pytest.mark.skipif(os.name != "posix", reason="a script in place of arecord")
def test_arecord(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """Catches options of arecord that are not those of the sound, and one that cannot record."""
    (tmp_path / "sound.raw").write_bytes(SOUND.tobytes())
    program = tmp_path / "arecord"
    program.write_text('#!/bin/sh\n[ "$*" = "-q -t raw -f S16_LE -c 1 -r 16000" ] || exit 3\n'
                       f"exec cat '{tmp_path}/sound.raw'\n")
    program.chmod(0o755)
    monkeypatch.setitem(sys.modules, "sounddevice", None)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    assert command(["--to", "jsonl"]) == 0
    assert shown(capsys.readouterr().out) == wanted()
    program.write_text("#!/bin/sh\nexit 1\n")
    assert command([]) == 1
    assert "follow: arecord cannot record" in capsys.readouterr().err
    monkeypatch.setenv("PATH", str(tmp_path / "none"))
    assert command([]) == 1
    told = capsys.readouterr().err
    assert told == ("follow: the microphone needs sounddevice or arecord: pip install sounddevice, "
                    "or apt-get install alsa-utils\n")


@needs_runtime
@pytest.mark.parametrize(("sound", "message"), [
    (None, "No such file"),
    (b"a text and no sound", "a.wav: file does not start with RIFF id"),
    (b"", "a.wav: the file is cut off"),
    (8, "8 bits per sample, not 16"),
    (11025, "11025 samples per second"),
])
def test_wrong_files_are_named(sound: Any, message: str, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches a traceback."""
    path = tmp_path / "a.wav"
    if isinstance(sound, bytes):
        path.write_bytes(sound)
    elif sound:
        write_wav(path, np.zeros(99, np.int16), 16000 if sound == 8 else sound, 1 if sound == 8 else 2)
    assert command(["--sound", str(path)]) == 1
    told = capsys.readouterr().err
    assert message in told and told.startswith("follow: ") and told.count("\n") == 1


# ---- The example programs of examples/rig ----------------------------------------------------------------------------


FOLDER = os.environ.get("LABIAL_RIG_EXAMPLES", "")


def output(name: str) -> List[str]:
    if not FOLDER:
        pytest.skip("LABIAL_RIG_EXAMPLES does not name the folder of the programs")
    return ran(Path(FOLDER) / f"labial-rig-{name}").splitlines()


def script() -> List[Tuple[str, int, int]]:
    """Label, first frame and end of each phoneme of examples/rig/script.c, 50 frames per second."""
    text = (SOURCE / "examples" / "rig" / "script.c").read_text()
    phonemes, begin = [], 0
    for model, label, length in re.findall(r"\b([SL])\((\w+), (\d+)\)", text):
        end = begin + int(length)
        phonemes.append((label if model == "S" else label.lower(), (begin + 10) // 20, (end + 10) // 20))
        begin = end
    return phonemes


CLOSURES = [(begin, end) for label, begin, end in script() if label in ("P", "B", "M")]
SPEECH_END = max(end for label, _, end in script() if label.isupper())
EASE = 12  # of the way to rest, after the last phoneme
FRAMES = script()[-1][2] + EASE
assert len(script()) == 34 + 23 and len(CLOSURES) == 6 and SPEECH_END == 187 and FRAMES == 314 + EASE


def test_jaw_opens_wide_and_closes() -> None:
    """The default gain must use the servo's range, and p, b, m must close a mouth that has nothing but a jaw."""
    rows = np.array([[int(x) for x in line.split(",")] for line in output("jaw")])
    assert rows[:, 0].tolist() == list(range(len(rows))) and FRAMES < len(rows) < FRAMES + 40
    pulse = rows[:, 1]
    assert pulse[-1] == 1400
    assert pulse.min() >= 1400 and pulse.max() <= 1900 and pulse.max() >= 1800
    for begin, end in CLOSURES:
        assert pulse[begin:end].min() < 1400 + 0.2 * 500
    assert np.ptp(pulse[SPEECH_END:]) > 80  # the laugh's pulses are smaller than speech, but seen


def test_servos_are_written_to_the_chip() -> None:
    """Set-up; servo after servo, half a second each; 20 bytes a frame, within limits and slews; rest at the end."""
    rig = read(SOURCE / "examples" / "faces" / "servos.toml", "servos")
    outputs = convert(rig)
    lines = [[int(x, 16) for x in line.split()] for line in output("servos")]
    assert lines[:3] == [[0x00, 0x10], [0xFE, rig.unit.prescale], [0x00, 0x20]]
    start, lines = lines[3:3 + 25 * len(outputs)], lines[3 + 25 * len(outputs):]
    assert [len(line) for line in start] == [1 + 4 * min(1 + tick // 25, 5) for tick in range(1, 126)]
    begin = next(number for number, line in enumerate(lines) if line != start[-1])
    frames = np.array(lines)
    assert frames.shape[1] == 1 + 4 * len(outputs) and (frames[:, 0] == 0x06).all()
    assert all(line == start[-1][:len(line)] for line in start) and lines[-1] == start[-1]
    assert FRAMES <= len(frames) < FRAMES + 60
    pairs = frames[:, 1:].reshape(len(frames), len(outputs), 4)
    assert (pairs[:, :, :2] == 0).all()
    ticks = pairs[:, :, 2] + 256 * pairs[:, :, 3]
    for column, servo in zip(ticks.T, outputs):
        assert column.min() >= servo.minimum and column.max() <= servo.maximum
        assert np.ptp(column) > 0.5 * (servo.maximum - servo.minimum), servo.name
        if servo.slew:
            assert np.abs(np.diff(column)).max() <= servo.slew
    # The corners are mirror images: in the laugh one goes up as the other goes down.
    left, right = ticks[begin + SPEECH_END + 10:begin + FRAMES - 20, 3:].T
    assert left.min() > outputs[3].neutral and right.max() < outputs[4].neutral


def test_blendshapes_are_weights() -> None:
    """Every shape is used, but for those that follow sounds alone, and stays a weight."""
    header, *rows = output("arkit")
    names = header.split(",")[1:]
    shapes = read(SOURCE / "export" / "labial" / "rig" / "arkit.toml", "arkit").outputs
    assert names == [item.name for item in shapes]
    by_sounds = {item.name for item in shapes if not any(item.weights)}
    values = np.array([[float(x) for x in row.split(",")] for row in rows])
    assert np.allclose(values[:, 0], np.arange(FRAMES) / 50)
    for name, column in zip(names, values[:, 1:].T):
        assert column.min() >= 0 and column.max() <= 1, name
        assert column.max() > (0.04 if name == "mouthClose" else 0.1) or name in by_sounds, name


def test_pictures_are_chosen() -> None:
    """An animation of one picture per frame: closed in p, b, m, smiling in the laugh, without flicker."""
    text = "\n".join(output("sprites"))
    root = ET.fromstring(text)
    space = "{http://www.w3.org/2000/svg}"
    animation = next(root.iter(f"{space}animateTransform"))
    shown = np.array([-int(x) // 120 for x in animation.attrib["values"].split(";")])
    names = [item.text for item in root.iter(f"{space}text")]
    assert len(names) == 12 and len(shown) == FRAMES and 0 <= shown.min() and shown.max() < 12
    assert animation.attrib["dur"] == f"{20 * FRAMES}ms"
    for begin, end in CLOSURES:
        assert "p b m" in {names[number] for number in shown[begin:end]}
    assert {names[number] for number in shown[SPEECH_END + 15:-EASE]} <= {"smile", "laugh"}
    assert names[shown[-1]] == "rest"
    assert len(set(shown)) >= 7
    runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[-1], shown, [-1]]))))
    assert runs[:-1].min() >= 2 and len(runs) < FRAMES / 4
