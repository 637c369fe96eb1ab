"""labial-hear from outside: sound in, frames out. The environment variable LABIAL_HEAR holds the program's path."""

from __future__ import annotations

import io
import json
import os
import random
import struct
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest
import soundfile

import labial
from labial.__main__ import main
from models import write_wav
from packages import needs_runtime
from test_animation import read_fap
from test_hearing import voice
from test_say import HEADER, command, run, say

pytestmark = needs_runtime
PCM, FLOAT, EXTENSIBLE = 1, 3, 0xFFFE


hear = partial(run, "labial-hear")


def chunk(name: bytes, data: bytes, size: int = -1) -> bytes:
    """A chunk of RIFF, padded to an even length; of the size that it claims, where one is given."""
    return name + struct.pack("<I", len(data) if size < 0 else size) + data + b"\0" * (len(data) % 2)


def form(rate: int = 16000, channels: int = 1, bits: int = 16, encoding: int = PCM, more: bytes = b"") -> bytes:
    size = channels * bits // 8
    return chunk(b"fmt ", struct.pack("<HHIIHH", encoding, channels, rate, rate * size, size, bits) + more)


def riff(*chunks: bytes) -> bytes:
    body = b"WAVE" + b"".join(chunks)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def pcm(samples: np.ndarray) -> bytes:
    return samples.astype("<i2").tobytes()


def wanted(samples: np.ndarray, rate: int = 16000, model: str = "hear_small", *, file: bool = False) -> List[List[int]]:
    """The frames of labial.Hearing; of a `file` at the level that is measured first."""
    with labial.Hearing(rate, 1 if samples.ndim == 1 else samples.shape[1], model=model) as hearing:
        if file:
            hearing.measure(samples)
        return [list(frame.faps) for frame in hearing.frames([samples])]


def motion(done: subprocess.CompletedProcess) -> List[List[int]]:
    """The frames of a CSV, whose times are checked."""
    assert done.returncode == 0 and done.stderr == b"", done.stderr
    header, *lines = done.stdout.decode().splitlines()
    assert header == HEADER
    rows = [line.split(",") for line in lines]
    assert [row[0] for row in rows] == [f"{k / 50:.3f}" for k in range(len(rows))]
    return [[int(value) for value in row[1:]] for row in rows]


SOUND = voice(0.7)


# ---- Frames ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000])
def test_frames_are_those_of_the_library(rate: int, tmp_path: Path) -> None:
    """Catches a rate or channels that are not those of the file, samples lost between blocks, the other model."""
    mono = voice(0.7, rate=rate)
    stereo = np.stack([mono, -(mono // 3)], axis=1)
    for name, samples in (("mono.wav", mono), ("stereo.wav", stereo)):
        expected = wanted(samples, rate, file=True)
        assert len(expected) == 35 + 12 and len({tuple(row) for row in expected}) > 9
        assert motion(hear(str(write_wav(tmp_path / name, samples, rate)))) == expected
    large = motion(hear("--model=large", str(tmp_path / "mono.wav")))
    assert large == wanted(mono, rate, "hear_large", file=True) != wanted(mono, rate, file=True)


def test_a_file_is_heard_at_its_level(tmp_path: Path) -> None:
    """36 dB below: from a file its lips are those of the loud voice; from a pipe, of unknown level, they are not."""
    loud, faint = voice(0.7), voice(0.7) // 64
    expected = np.array(motion(hear(str(write_wav(tmp_path / "loud.wav", loud)))))
    found = np.array(motion(hear(str(write_wav(tmp_path / "faint.wav", faint)))))
    piped = np.array(motion(hear("-", data=pcm(faint))))
    far, near = (np.sqrt(np.mean((item - expected)[:35] ** 2.0)) for item in (piped, found))
    assert near < 0.25 * far


def test_raw_samples_from_standard_input() -> None:
    """Catches other defaults, options that are passed over, and half a sample that counts as a whole one."""
    stereo = np.stack([SOUND, SOUND[::-1]], axis=1)
    assert motion(hear("-", data=pcm(SOUND))) == wanted(SOUND)
    assert motion(hear("-", "--exact", data=pcm(SOUND))) == wanted(SOUND)[:35]
    assert motion(hear("-", data=pcm(SOUND) + b"\x55")) == wanted(SOUND)
    assert motion(hear("-", "--channels", "2", data=pcm(stereo) + b"\x55\x55\x55")) == wanted(stereo)
    assert motion(hear("--rate=48000", "-", data=pcm(SOUND))) == wanted(SOUND, 48000)
    assert motion(hear("-")) == []
    for samples in (SOUND[:2], SOUND[:6], SOUND[:7]):  # up to as many bytes as tell a WAV file, and one sample more
        assert motion(hear("-", data=pcm(samples))) == wanted(samples)


@pytest.mark.parametrize("seed", range(4))
def test_blocks_of_any_length(seed: int) -> None:
    """Catches frames that depend on how the bytes arrive in a pipe."""
    draw, data = random.Random(seed), pcm(SOUND)
    pipe = subprocess.PIPE
    child = subprocess.Popen(command("labial-hear", "-"), stdin=pipe, stdout=pipe, stderr=pipe, bufsize=0)
    while data:
        size = draw.choice((1, 2, 3, 319, 640, 4097))
        child.stdin.write(data[:size])
        data = data[size:]
    out, errors = child.communicate(timeout=60)
    assert motion(subprocess.CompletedProcess([], child.returncode, out, errors)) == wanted(SOUND)


def test_every_format_has_the_frames() -> None:
    """Catches a format that has other frames than csv, or none of a face's weights."""
    rows = motion(hear("-", data=pcm(SOUND)))
    name, fps, frames = read_fap(hear("-", "--to=fap", data=pcm(SOUND)).stdout.decode())
    assert (name, fps, len(frames)) == ("hear_small", 50, 47)
    assert [[frame[int(name[3:])] for name in HEADER.split(",")[1:]] for frame in frames] == rows
    objects = [json.loads(line) for line in hear("-", "--to", "jsonl", data=pcm(SOUND)).stdout.splitlines()]
    assert [[*item["faps"].values()] for item in objects] == rows
    for face in ("arkit", "vrm", "oculus"):
        weights = [json.loads(line)[face] for line in hear("-", "--to", face, data=pcm(SOUND)).stdout.splitlines()]
        assert len(weights) == 47 and any(value > 0 for item in weights for value in item.values())
        assert face != "arkit" or weights == [item["arkit"] for item in objects]
    assert len(hear("-", "--to", "livelink", data=pcm(SOUND)).stdout.splitlines()) == 1 + 47


def test_classes_are_timings(tmp_path: Path) -> None:
    """Catches classes with the names of others, times that do not join, and labels that labial-say does not know."""
    path = str(write_wav(tmp_path / "voice.wav", SOUND))
    done = hear(path, "--classes")
    assert done.returncode == 0 and done.stderr == b""
    with labial.Hearing(model="hear_small") as hearing:
        hearing.measure(SOUND)
        assert len(list(hearing.frames([SOUND]))) == 35 + 12
        shown = hearing.shown()
    assert done.stdout.decode() == "".join(
        f"{item.frame / 50:.3f} {(item.frame + item.frames) / 50:.3f} {item.name}\n" for item in shown)
    said = say(done.stdout, "--from=lab", "--exact")
    assert said.returncode == 0 and said.stderr == b"" and len(said.stdout.splitlines()) == 36


# ---- WAV files -------------------------------------------------------------------------------------------------------

GUID = bytes.fromhex("000000001000800000aa00389b71")


@pytest.mark.parametrize("data", [
    riff(chunk(b"LIST", b"odd" * 333), form(), chunk(b"fact", b"1"), chunk(b"data", pcm(SOUND))),
    riff(form(), chunk(b"data", pcm(SOUND)), chunk(b"id3 ", b"behind", 0xFFFFFFFF)),
    riff(form(encoding=EXTENSIBLE, more=struct.pack("<HHIH", 22, 16, 4, PCM) + GUID), chunk(b"data", pcm(SOUND))),
    riff(form(more=b"\0\0" + b"x" * 601), chunk(b"data", pcm(SOUND))),
    riff(form(), chunk(b"data", pcm(SOUND), 0xFFFFFFFF)),
    riff(form(), chunk(b"data", pcm(SOUND), 0x7FFFF000)),
    riff(form(48000, 2), form(), chunk(b"data", pcm(SOUND) + b"x")),
    b"RIFF\0\0\0\0" + riff(form(), chunk(b"data", pcm(SOUND)))[8:],
], ids=["chunks", "behind", "extensible", "long-format", "endless", "largest", "half-a-sample", "no-size"])
def test_unusual_files_are_heard(data: bytes, tmp_path: Path) -> None:
    """Catches a reader that expects 44 bytes of header, or believes sizes that writers of pipes do not know."""
    (tmp_path / "a.wav").write_bytes(data)
    assert motion(hear(str(tmp_path / "a.wav"))) == wanted(SOUND, file=True)
    assert motion(hear("-", data=data)) == wanted(SOUND)
    if os.path.exists("/dev/stdin"):
        assert motion(hear("/dev/stdin", data=data)) == wanted(SOUND)


def of_telephone(subtype: str) -> np.ndarray:
    """16 bits of `CODES`, by libsndfile."""
    return soundfile.read(io.BytesIO(CODES.tobytes()), format="RAW", subtype=subtype, samplerate=16000, channels=1,
                          dtype="int16")[0]


CODES = np.frombuffer(SOUND.astype("<i2").tobytes()[: len(SOUND)], np.uint8)


@pytest.mark.parametrize(("bits", "encoding", "data", "heard"), [
    (8, PCM, ((SOUND >> 8) + 128).astype(np.uint8), SOUND >> 8 << 8),
    (24, PCM, np.stack([SOUND & 0, SOUND & 255, SOUND >> 8 & 255], axis=1).astype(np.uint8), SOUND),
    (32, PCM, (SOUND.astype("<i4") << 16) + 65535, SOUND),
    (32, FLOAT, (SOUND / 32767).astype("<f4"), SOUND),
    (64, FLOAT, (SOUND / 32767).astype("<f8") * 4, np.clip(SOUND.astype(int) * 4, -32768, 32767)),
    (8, 6, CODES, of_telephone("ALAW")),
    (8, 7, CODES, of_telephone("ULAW")),
], ids=["8", "24", "32", "float", "double", "a-law", "mu-law"])
@pytest.mark.parametrize("channels", [1, 2])
def test_encodings_are_heard(bits: int, encoding: int, data: np.ndarray, heard: np.ndarray, channels: int,
                             tmp_path: Path) -> None:
    """Catches a wrong scale, sign or order of bytes; of two channels the second is silent, so that half is heard."""
    content = np.ascontiguousarray(data)
    sound = heard.astype(np.int16)
    if channels == 2:
        width = bits // 8
        rows = np.frombuffer(content.tobytes(), np.uint8).reshape(-1, width)
        silent = {(8, PCM): 128, (8, 6): 0xD5, (8, 7): 0xFF}.get((bits, encoding), 0)
        content = np.concatenate([rows, np.full_like(rows, silent)], axis=1)
        sound = np.stack([sound, np.full_like(sound, 8 if encoding == 6 else 0)], axis=1)
    path = tmp_path / "a.wav"
    path.write_bytes(riff(form(16000, channels, bits, encoding), chunk(b"data", content.tobytes())))
    (tmp_path / "pcm.wav").write_bytes(riff(form(16000, channels), chunk(b"data", pcm(sound))))
    done, plain = hear(str(path)), hear(str(tmp_path / "pcm.wav"))
    assert done.returncode == 0 and done.stdout == plain.stdout, done.stderr


WHOLE = riff(form(), chunk(b"data", pcm(SOUND)))


@pytest.mark.parametrize(("data", "told"), [
    (b"", "is not a WAV file"),
    (b"RIFX" + WHOLE[4:], "is not a WAV file"),
    (b"RIFF\0\0\0\0AVI " + WHOLE[12:], "is not a WAV file"),
    (pcm(SOUND), "is not a WAV file"),
    (WHOLE[:12], "ends before its samples"),
    (WHOLE[:30], "ends within its format"),
    (WHOLE[:40], "ends before its samples"),
    (WHOLE[:44], "the sound is empty: it has no samples"),
    (riff(form(), chunk(b"data", b""), chunk(b"LIST", b"INFO")), "the sound is empty: it has no samples"),
    (riff(form(), chunk(b"LIST", b"short", 0xFFFFFFFF), chunk(b"data", pcm(SOUND))), "a chunk is longer than the file"),
    (riff(chunk(b"fmt ", b"\1\0\1\0" + bytes(11)), chunk(b"data", b"")), "its format has less than 16 bytes"),
    (riff(form(more=b"x")[:4] + b"\xff\xff\xff\x7f" + form()[8:], chunk(b"data", pcm(SOUND))),
     "a chunk is longer than the file"),
    (riff(chunk(b"data", pcm(SOUND)), form()), "has no format before its samples"),
    (riff(form(bits=12), chunk(b"data", b"")), "has samples of 12 bits in encoding 1, not PCM, floating point"),
    (riff(form(bits=16, encoding=FLOAT), chunk(b"data", b"")), "has samples of 16 bits in encoding 3"),
    (riff(form(bits=4, encoding=2), chunk(b"data", b"")), "has samples of 4 bits in encoding 2"),
    (riff(form(bits=32, encoding=FLOAT), chunk(b"data", struct.pack("<f", float("inf")))), "a sample is not finite"),
    (riff(form(bits=64, encoding=FLOAT), chunk(b"data", struct.pack("<d", float("nan")))), "a sample is not finite"),
    (riff(form(bits=24)[:-4] + b"\4\0\x18\0", chunk(b"data", b"")), "contradicts itself"),
    (riff(form(encoding=EXTENSIBLE), chunk(b"data", b"")), "has samples of 16 bits in encoding 65534"),
    (riff(form(encoding=EXTENSIBLE, more=struct.pack("<HHIH", 22, 16, 4, 6) + GUID), chunk(b"data", b"")),
     "has samples of 16 bits in encoding 6,"),
    (riff(form(channels=0), chunk(b"data", b"")), "has 0 channels, not 1 or 2"),
    (riff(form(channels=6), chunk(b"data", b"")), "has 6 channels, not 1 or 2"),
    (riff(form(2**32 - 1, 0)[:10] + form(48000, 2)[10:20] + b"\2\0\x10\0", chunk(b"data", b"")), "contradicts itself"),
    (riff(form(11025), chunk(b"data", b"")), "11025 samples per second, channels: 1: sound of so many"),
])
def test_hostile_files_are_refused(data: bytes, told: str, tmp_path: Path) -> None:
    """An error names the file and what is wrong with it, in one line, and the exit status is 1."""
    path = tmp_path / "hostile.wav"
    path.write_bytes(data)
    done = hear(str(path))
    message = done.stderr.decode()
    assert done.returncode == 1
    assert message.startswith(f"labial-hear: {path}: ") and message.count("\n") == 1
    assert told in message
    assert hear(str(path), "--to", "fap").stdout == b"", "a part of the motion under a header of its own"


def both(path: Path, capfd: pytest.CaptureFixture[str]) -> List[Tuple[int, str, str]]:
    """Exit status, motion and what is said of labial-hear and `labial hear`, for a file and for standard input."""
    done = hear(str(path)), hear("-", data=path.read_bytes())
    found = [(one.returncode, one.stdout.decode(), one.stderr.decode().replace("labial-hear: ", "labial: "))
             for one in done]
    stdin = sys.stdin
    for name in (str(path), "-"):
        with open(path, "rb") as file:
            sys.stdin = io.TextIOWrapper(file)
            status = main(["hear", name, "--model", "small", "--sound-alone"])
        sys.stdin = stdin
        captured = capfd.readouterr()
        found.append((status, captured.out, captured.err))
    return found


@pytest.mark.parametrize(("size", "samples"), [(0, 0), (0xFFFFFFFF, 0), (36, 0), (0xFFFFFFFF, 0xFFFFFFFF),
                                               (0, 0xFFFFFFFF)])
def test_sizes_that_a_pipe_does_not_know(size: int, samples: int, tmp_path: Path,
                                         capfd: pytest.CaptureFixture[str]) -> None:
    """What programs write into a pipe, with 0 or the largest number where a size is not known: all sound is heard."""
    path = tmp_path / "piped.wav"
    path.write_bytes(b"RIFF" + struct.pack("<I", size) + riff(form(), chunk(b"data", pcm(SOUND), samples))[8:] + b"x")
    found = both(path, capfd)
    (tmp_path / "whole.wav").write_bytes(WHOLE)
    assert found == both(tmp_path / "whole.wav", capfd)
    assert {(status, said) for status, _, said in found} == {(0, "")}
    assert [len(motion.splitlines()) for _, motion, _ in found] == [1 + 35 + 12] * 4


def rows(motion: str) -> List[List[float]]:
    return np.loadtxt(io.StringIO(motion), delimiter=",", skiprows=1)[:, 1:].tolist()


def test_a_file_that_is_cut_off_is_heard_as_far_as_it_goes(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Catches an error in place of a warning, sound before the end that is lost, and half a sample that counts."""
    path = tmp_path / "cut.wav"
    path.write_bytes(riff(form(), chunk(b"data", pcm(SOUND) + b"x", 4 * len(SOUND)))[:-1])
    told = "the file is cut off: 0.70 of 1.40 s are there\n"
    for name, (status, motion, said) in zip([str(path), "standard input"] * 2, both(path, capfd)):
        assert (status, said) == (0, f"labial: warning: {name}: {told}")
        assert rows(motion) == wanted(SOUND, file=name == str(path))


def test_channels_that_cancel_each_other_are_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """One of two plugs the wrong way round: the first channel is heard. Others are mixed without a word."""
    path = tmp_path / "stereo.wav"
    quiet = np.zeros(1600, np.int16)
    quiet[3] = 5
    cases = [(SOUND, -SOUND, True), (SOUND, -(SOUND - SOUND // 20), True), (SOUND, -(SOUND // 2), False),
             (SOUND, 0 * SOUND, False), (np.append(quiet, SOUND), np.append(-quiet, SOUND), False)]
    for first, second, cancel in cases:
        write_wav(path, np.stack([first, second], axis=1), 16000)
        expected = np.stack([first, first if cancel else second], axis=1)
        for name, (status, motion, said) in zip([str(path), "standard input"] * 2, both(path, capfd)):
            told = f"labial: warning: {name}: its two channels cancel each other, so the first one is heard alone\n"
            assert (status, said) == (0, told if cancel else "")
            assert rows(motion) == wanted(expected, file=name == str(path)) and np.abs(rows(motion)).max() > 100


@pytest.mark.parametrize("name", [b"RF64", b"BW64"])
def test_files_beyond_4_gb_are_refused(name: bytes, tmp_path: Path) -> None:
    """Catches a header of 64-bit sizes that is heard as samples; the name alone is no header."""
    sizes = chunk(b"ds64", struct.pack("<QQQI", 72 + 2 * len(SOUND), 2 * len(SOUND), len(SOUND), 0))
    data = name + b"\xff\xff\xff\xffWAVE" + sizes + form() + chunk(b"data", pcm(SOUND), 0xFFFFFFFF)
    path = tmp_path / "large.wav"
    path.write_bytes(data)
    for done, told in ((hear(str(path)), str(path)), (hear("-", data=data), "standard input")):
        assert done.returncode == 1 and done.stdout == b""
        assert done.stderr.decode() == (f"labial-hear: {told}: is an RF64 or BW64 file; convert it to a WAV file of "
                                        "less than 4 GB\n")
    samples = name + pcm(SOUND)
    assert motion(hear("-", data=samples)) == wanted(np.frombuffer(samples, "<i2"))


@pytest.mark.parametrize("seed", range(4))
def test_any_bytes_are_survived(seed: int, tmp_path: Path) -> None:
    """Catches headers that end the program: bytes changed, and the end cut off."""
    draw, path = random.Random(seed), tmp_path / "any.wav"
    head = len(WHOLE) - len(pcm(SOUND))
    for _ in range(25):
        data = bytearray(WHOLE[: draw.choice((head + 1500, draw.randrange(head)))])
        for _ in range(draw.randrange(1, 5)):
            if data:
                at = draw.randrange(min(len(data), head))
                data[at] = draw.choice((0, 1, 2, 0x7F, 0x80, 0xFF, draw.randrange(256)))
        path.write_bytes(data)
        done = hear(str(path))
        assert done.returncode in (0, 1)
        said = done.stderr.splitlines()
        assert len(said) == done.returncode or (len(said) == 1 and b": warning: " in said[0])
        assert not done.stderr.strip(b"\n").count(b"\x1b")


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    """Catches an error that does not say which file."""
    for path in (tmp_path / "none.wav", tmp_path):
        done = hear(str(path))
        assert done.returncode == 1 and done.stderr.startswith(f"labial-hear: {path}: cannot ".encode())
    done = hear("-", "--rate", "11025")
    assert done.returncode == 1
    assert done.stderr.startswith(b"labial-hear: standard input: 11025 samples per second, channels: 1: ")
