"""examples/microphone: a mouth that follows a file, sounddevice and arecord."""

from __future__ import annotations

import json
import os
import sys
import types
from pathlib import Path
from typing import Any, List

import follow
import numpy as np
import pytest

import labial
from labial.program import run
from runtime import needs_runtime
from test_hearing import voice
from test_runtime_hearing import write_wav

pytestmark = needs_runtime

SOUND = voice(0.6)


def command(arguments: List[str]) -> int:
    """The program's exit status."""
    return run("follow", lambda: follow.main(arguments))


def wanted() -> List[List[int]]:
    """The frames of SOUND."""
    with labial.Hearing() as hearing:
        return [list(frame.faps) for frame in hearing.frames([SOUND])]


def shown(text: str) -> List[List[int]]:
    """The frames of --to jsonl, which also have numbers and blendshapes."""
    items = [json.loads(line) for line in text.splitlines()]
    assert [item["frame"] for item in items] == list(range(len(items)))
    assert all(0 <= item["arkit"]["jawOpen"] <= 1 for item in items)
    return [item["faps"] for item in items]


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
    module.RawInputStream = RawInputStream  # type: ignore[attr-defined]
    module.PortAudioError = type("PortAudioError", (Exception,), {})  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "sounddevice", module)
    assert command(["--to", "jsonl"]) == 0
    told = capsys.readouterr()
    found = shown(told.out)
    assert 20 < len(found) < 30 and found == wanted()[: len(found)]
    assert told.err == "follow: this computer is too slow: sound was lost\n"
    assert opened == [160, "closed"]
    assert command([]) == 1
    assert "follow: the microphone: Error querying device -1\n" in capsys.readouterr().err


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
