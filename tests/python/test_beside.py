"""Lips beside the audio: the packets of labial.Beside, and from end to end, examples/beside/server.py to a toy in C
with a simulated loudspeaker."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np
import pytest

import labial
from labial.bake.source import RATE
from labial.bake.track import as_bytes
from labial.errors import LabialError
from labial.rig.description import read
from labial.rig.table import convert
from packages import SOURCE
from runtime import needs_runtime

CC = os.environ.get("LABIAL_CC", "")
pytestmark = needs_runtime
EXAMPLE = SOURCE / "examples" / "beside"
FACE = EXAMPLE / "face.toml"
HELLO = [("pau", 120), ("HH", 70), ("AH", 60), ("L", 80), ("OW", 250), ("M", 90), ("AA", 120), ("pau", 300)]


class Parsed(NamedTuple):
    """A packet as docs/beside.md describes it."""

    cancels: int
    first: int
    rest: bytes
    frames: List[bytes]


def parse(data: bytes) -> Parsed:
    form, cancels, outputs, count, first = struct.unpack("<4BI", data[:8])
    assert form == 1 and len(data) == 8 + outputs * (count + 1)
    rows = [data[at : at + outputs] for at in range(8, len(data), outputs)]
    return Parsed(cancels, first, rows[0], rows[1:])


def expected(motion: Sequence[Sequence[int]], face: Path = FACE) -> List[bytes]:
    """The bytes of frames as `labial bake` writes them."""
    rig = read(str(face), "face")
    return [bytes(row) for row in as_bytes(rig, convert(rig), np.array(motion, dtype=np.float64))]


def test_packets_have_the_bytes_of_baked_motion() -> None:
    """Catches another rounding than that of `labial bake`, whose player the toy's units are those of, and frames that
    are lost, doubled or numbered otherwise."""
    motion = labial.render(HELLO)
    wanted = expected(motion)
    lips = labial.Beside(FACE)
    packets = lips.packets(motion, sample=48000, rate=24000)
    assert [packet.frame for packet in packets] == list(range(100, 100 + len(motion), 10))
    assert lips.frame == 100 + len(motion)
    found = []
    for packet in packets:
        parsed = parse(packet.data)
        assert (parsed.cancels, parsed.first) == (0, packet.frame) and parsed.rest == bytes([0, 128])
        found += parsed.frames
    assert found == wanted and len({row[0] for row in found}) > 20
    values = [labial.Frame(0, frame).rig(labial.Rig(FACE)) for frame in motion]
    for row, value in zip(found, values):
        assert abs(1400 + 500 * row[0] / 255 - value["jaw"]) <= 500 / 255 / 2 + 1e-9
        assert abs(1300 + 400 * row[1] / 255 - value["upper_lip"]) <= 400 / 255 / 2 + 1e-9
    assert 8 * len(packets) + 2 * (len(packets) + len(motion)) < len(motion) / RATE * 160, "bytes a second"


def test_a_servo_with_a_limit_of_speed_sees_the_utterance(tmp_path: Path) -> None:
    """Catches packets whose frames are converted one by one: a slow jaw would not be closed in M."""
    slow = tmp_path / "slow.toml"
    slow.write_text('[output.jaw]\nfrom = "opening"\nclosed = 1400\nfull = 1900\nslew = 40\n', encoding="utf-8")
    motion = labial.render(HELLO)
    found = b"".join(b"".join(parse(packet.data).frames)
                     for packet in labial.Beside(slow, frames=3).packets(motion, sample=0, rate=16000))
    assert found == b"".join(expected(motion, slow))
    times = np.cumsum([0, *(length for _, length in HELLO)])
    assert min(found[times[5] // 20 : times[6] // 20]) == 0


def test_a_stream_is_packed_as_it_comes() -> None:
    """Catches frames that are kept back for ever, and others than those of a whole utterance."""
    motion, lips, packets = labial.render(HELLO), labial.Beside(FACE, frames=7), []
    with labial.Stream() as stream:
        for label, length in HELLO:
            stream.push(label, length)
        stream.end()
        for frame in stream:
            packets += lips.push([frame])
    assert lips.frame == len(motion)
    with pytest.raises(LabialError, match="flush them first"):
        lips.at(0, 16000)
    packets += lips.flush()
    assert lips.flush() == []
    assert [len(parse(packet.data).frames) for packet in packets] == [7] * (len(motion) // 7) + [len(motion) % 7]
    assert [row for packet in packets for row in parse(packet.data).frames] == expected(motion)


def test_repeated_frames_make_up_for_a_lost_packet() -> None:
    """Catches repeats that are not the frames before, and ones across a gap."""
    motion = labial.render(HELLO)
    lips = labial.Beside(FACE, frames=5, repeat=5)
    first, second = lips.packets(motion, sample=0, rate=16000), lips.packets(motion, sample=32000, rate=16000)
    wanted = expected(motion)
    for start, packets in ((0, first), (100, second)):
        assert [packet.frame for packet in packets] == list(range(start, start + len(motion), 5))
        for lost in range(len(packets) - 1):
            rows = {}
            for packet in packets[:lost] + packets[lost + 1 :]:
                parsed = parse(packet.data)
                rows.update({parsed.first + k: row for k, row in enumerate(parsed.frames)})
            assert [rows[start + k] for k in range(len(motion))] == wanted


def test_hello_and_cancel() -> None:
    """Catches a rest that is not the rig's, frames that survive a cancel, and numbers that begin again."""
    lips = labial.Beside(FACE)
    assert parse(lips.hello()) == (0, 0, bytes([0, 128]), [])
    lips.push(labial.render(HELLO)[:15])
    assert parse(lips.cancel(24000, 16000)) == (1, 75, bytes([0, 128]), [])
    assert lips.flush() == [] and lips.rig.values == {"jaw": 1400, "upper_lip": 1500}
    assert lips.packets([(0,) * 13] * 3, sample=24000 + 161, rate=16000)[0].frame == 76, "the nearest frame"
    assert parse(lips.cancel(2**32 * 320, 16000)).first == 0, "modulo 2^32"


@pytest.mark.parametrize(("options", "message"), [
    ({"frames": 0}, "cannot have 0 frames"), ({"frames": 200, "repeat": 56}, "200 frames and 56 repeated"),
    ({"repeat": -1}, "-1 repeated"),
])
def test_wrong_sizes_are_refused(options: dict, message: str) -> None:
    with pytest.raises(LabialError, match=message):
        labial.Beside(FACE, **options)


def test_wrong_frames_and_times_are_refused(tmp_path: Path) -> None:
    lips = labial.Beside(FACE)
    with pytest.raises(LabialError, match="a frame has 13 FAPs, not 12"):
        lips.push([(0,) * 12])
    with pytest.raises(LabialError, match="beyond 16 bits"):
        lips.push([(40000,) * 13])
    with pytest.raises(TypeError, match="whole numbers"):
        lips.push([(0.5,) * 13])  # type: ignore[arg-type]
    assert lips.frame == 0 and lips.flush() == []
    with pytest.raises(LabialError, match="sample -1 at 16000"):
        lips.at(-1, 16000)
    with pytest.raises(LabialError, match="sample 0 at 0"):
        lips.cancel(0, 0)
    with pytest.raises(TypeError):
        lips.at(0.5, 16000)  # type: ignore[arg-type]
    wide = tmp_path / "wide.toml"
    wide.write_text('unit = "plain"\n[output.jaw]\nfrom = "opening"\nneutral = 0\nfull = 1\nminimum = -8000000\n'
                    "maximum = 1\n", encoding="utf-8")
    with pytest.raises(LabialError, match="limits of jaw are more than 8000000 apart"):
        labial.Beside(wide)


# ---- What boards show ------------------------------------------------------------------------------------------------


class Player:
    """The player of labial/beside.h as its comments say, on a dictionary of frames and exact times."""

    HOLD, EASE = 5, 6

    def __init__(self, rate: int, room: int) -> None:
        self.rate, self.room, self.now, self.quiet = rate, room, 0, self.HOLD + self.EASE
        self.frames: Dict[int, Tuple[bytes, bool]] = {}  #: by number: values, and whether they were shown
        self.rest = self.pose = bytes(2)

    def feed(self, cancels: bool, first: int, rest: bytes, frames: Sequence[bytes]) -> None:
        self.rest = rest
        if cancels:
            self.frames.clear()
            self.quiet = max(self.quiet, self.HOLD)
            self.now = max(self.now, first)
        for number, row in enumerate(frames, first):
            if self.now <= number < self.now + self.room and not self.frames.get(number, (b"", False))[1]:
                self.frames[number] = (row, False)

    def at(self, sample: int) -> bool:
        frame = sample * 50 // self.rate
        if frame <= self.now - self.room:
            self.frames.clear()
            self.now = frame
        self.now = max(self.now, frame)
        self.frames = {number: found for number, found in self.frames.items() if number >= self.now}
        row, old = self.frames.get(frame, (b"", True))
        if old:
            self.quiet = min(self.quiet + 1, self.HOLD + self.EASE)
            if self.quiet > self.HOLD:
                left = self.HOLD + self.EASE + 1 - self.quiet
                self.pose = bytes(value + int((to - value) / left) for value, to in zip(self.pose, self.rest))
        else:
            self.frames[frame], self.pose, self.quiet = (row, True), row, 0
        return self.quiet <= self.HOLD


def test_what_boards_show() -> None:
    """Catches a number in tests/device/beside_works.c that the library itself made."""
    seed, shown = 1, bytearray()

    def draw(below: int) -> int:
        nonlocal seed
        seed = (seed * 1664525 + 1013904223) % 2**32
        return (seed >> 8) % below

    def packet(frame: int) -> Tuple[bool, int, bytes, List[bytes]]:
        first = frame + draw(40) - 8
        cancels, frames = draw(20) == 0, draw(17)
        rows = [bytes((draw(256), draw(256))) for _ in range(frames + 1)]
        return cancels, first, rows[0], rows[1:]

    for rate in (8000, 11025, 48000):
        player, sample, frame = Player(rate, 32), 0, 0
        for call in range(3000):
            if draw(4) == 0 or call == 0:
                given = packet(frame)
                player.feed(*given)
                shown.append(2 if given[0] else 0)
            speaks = player.at(sample)
            unit = 1900 - (3300 * player.pose[0] + 127) // 255
            shown += bytes([speaks, *player.pose, unit >> 4 & 255])
            if draw(50) == 0:
                sample += draw(3) * rate
                frame += draw(100)
            elif draw(20) > 0:
                sample += rate // 50 + draw(64) - 32
                frame += 1
    device = (SOURCE / "tests" / "device" / "beside_works.c").read_text(encoding="utf-8")
    assert f"#define SHOWN {zlib.crc32(shown):#010x}u\n" in device
    assert len(set(shown[1::5])) > 1


# ---- From end to end -------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """examples/beside/toy.c as its comment compiles it, with warnings."""
    if not CC:
        pytest.skip("LABIAL_CC names no compiler")
    if not shutil.which("flite"):
        pytest.skip("no flite: install the Debian package flite")
    program = tmp_path_factory.mktemp("toy") / "toy"
    subprocess.run([CC, "-std=c99", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror",
                    f"-I{SOURCE / 'include'}", str(EXAMPLE / "toy.c"), str(SOURCE / "lib" / "beside.c"), "-o",
                    str(program)], check=True, timeout=120)
    return program


@pytest.fixture(scope="module")
def server(request: pytest.FixtureRequest) -> Iterator[Tuple[int, int]]:
    """The port of a server that sends as fast as the toy takes it, and how many frames its packets repeat: 0, or the
    parameter."""
    repeat = getattr(request, "param", 0)
    with subprocess.Popen([sys.executable, str(EXAMPLE / "server.py"), "--port", "0", "--ahead", "60", "--repeat",
                           str(repeat)], stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "PYTHONPATH": str(SOURCE / "export")}) as process:
        try:
            assert process.stdout
            yield int(process.stdout.readline().split()[1]), repeat
        finally:
            process.terminate()


class Shown(NamedTuple):
    """A line of the toy: 20 ms."""

    sample: int  #: below 0 when the clock is early
    speaks: bool
    row: bytes
    pulses: Tuple[int, ...]


def play(toy: Path, port: int, script: str, *options: str) -> List[Shown]:
    done = subprocess.run([str(toy), str(port), *options], input=script, capture_output=True, text=True, check=True,
                          timeout=60)
    numbers = [list(map(int, line.split())) for line in done.stdout.splitlines()]
    return [Shown((row[0] ^ 2**31) - 2**31, bool(row[1]), bytes(row[2:4]), tuple(row[4:])) for row in numbers]


RATE_OF_VOICE = 16000
STEP = RATE_OF_VOICE // 50


class Said(NamedTuple):
    """What the server's voice makes of a text."""

    timings: List[Tuple[str, float]]
    rows: List[bytes]
    values: List[Tuple[int, ...]]  #: of the rig


def said(text: str) -> Said:
    done = subprocess.run(["flite", "-voice", "slt", "-t", text, "-psdur", "-o", "none"], check=True, text=True,
                          capture_output=True)
    ends, timings = 0, []
    for item in done.stdout.split():
        label, end = item.split(":")
        milliseconds = round(float(end) * 1000)
        timings.append((label, float(milliseconds - ends)))
        ends = milliseconds
    motion = labial.render(timings)
    face = labial.Rig(FACE)
    return Said(timings, expected(motion), [tuple(map(int, face.apply(frame).values())) for frame in motion])


def compare(lines: Sequence[Shown], spoken: Said, start: int) -> int:
    """Checks that what is shown is the rig's value at the sample that is heard; returns how many were compared."""
    newest, compared = -1, 0
    for line in lines:
        newest = max(newest, (line.sample - start) // STEP)  # the clock jitters, the mouth does not turn back
        if not 0 <= newest < len(spoken.rows):
            continue
        assert line.speaks and line.row == spoken.rows[newest], line
        for pulse, value, span in zip(line.pulses, spoken.values[newest], (500, 400)):
            assert abs(pulse - value) <= span / 255 / 2 + 0.5
        compared += 1
    return compared


def closures(lines: Sequence[Shown], spoken: Said, start: int) -> int:
    """Checks that the jaw is closed, up to 3 %, in each p, b, m that the lines reach; returns how many there are."""
    found, begin = 0, 0.0
    for label, length in spoken.timings:
        end = begin + length
        inside = [line.row[0] for line in lines
                  if begin - 10 <= (line.sample - start) * 1000 / RATE_OF_VOICE < end + 10]
        if label in ("p", "b", "m") and len(inside) >= length // 20:
            assert min(inside) <= 8, (label, begin)
            found += 1
        begin = end
    return found


@pytest.mark.parametrize("jitter", [[], ["jitter"]])
def test_a_toy_shows_what_is_heard(toy: Path, server: Tuple[int, int], jitter: List[str]) -> None:
    """Catches lips that are not in step with the samples, in one utterance and in the next; lips that are open in p, b,
    m; and pulses that are not the rig's."""
    lines = play(toy, server[0], "say Mama may pop a bubble.\nplay 60000\nsay Bob may be happy.\nplay 60000\n", *jitter)
    first, second = said("Mama may pop a bubble."), said("Bob may be happy.")
    blocks = [line.sample for line in lines]
    start = -(-round(sum(length for _, length in first.timings)) // 60) * 60 * RATE_OF_VOICE // 1000
    assert compare([line for line in lines if line.sample < start], first, 0) > 70
    assert closures([line for line in lines if line.sample < start], first, 0) >= 6
    late = [line for line in lines if start <= line.sample and line.speaks]
    assert compare(late, second, start) > 50
    assert closures(late, second, start) >= 3
    assert blocks[-1] > start and lines[-1].row == bytes([0, 128]) and not lines[-1].speaks


@pytest.mark.parametrize("server", [0, 10], indirect=True)
def test_a_lost_packet(toy: Path, server: Tuple[int, int]) -> None:
    """Catches a player that needs every packet. With repeats nothing is lost; without, what was not lost is shown, and
    the mouth eases to rest in between."""
    port, repeat = server
    lines = play(toy, port, "say Mama may pop a bubble.\nplay 60000\n", "lose", "4")
    spoken = said("Mama may pop a bubble.")
    if repeat:
        assert compare(lines[: len(spoken.rows) - 12], spoken, 0) > 60
        return
    lost = [k for packet in range(2, len(spoken.rows) // 10, 4) for k in range(packet * 10, packet * 10 + 10)]
    assert len(lost) >= 20, "the hello is the first packet"
    kept = [line for line in lines if line.sample // STEP not in lost and line.speaks]
    assert compare(kept, spoken, 0) > 40
    for k in range(lost[0], lost[0] + 10):
        assert lines[k].speaks == (k < lost[0] + 5)
        assert (lines[k].row == lines[lost[0] - 1].row) == (k < lost[0] + 5)


def test_a_cancel(toy: Path, server: Tuple[int, int]) -> None:
    """Catches lips that speak on after a cancel, and ones that are late by the dropped sound from then on."""
    lines = play(toy, server[0], "say Mama may pop a bubble, and another one.\nplay 400\nstop\n"
                                 "say Bob may be happy.\nplay 60000\n", "jitter")
    first, second = said("Mama may pop a bubble, and another one."), said("Bob may be happy.")
    stopped = next(k for k, line in enumerate(lines) if not line.speaks and k)
    assert stopped == 20 and compare(lines[:stopped], first, 0) >= 19, "the clock begins before the first sample"
    assert [line.speaks for line in lines[stopped : stopped + 6]] == [False] * 6
    assert lines[stopped + 5].row == bytes([0, 128])
    assert lines[stopped - 1].row != lines[stopped].row != lines[stopped + 5].row, "it eases"
    after = [line for line in lines[stopped + 6 :] if line.speaks]
    start = round(after[0].sample / 960) * 960  # behind all blocks of 60 ms that were sent
    assert start > 20 * STEP + 960
    assert compare(after, second, start) > 50
    assert closures(after, second, start) >= 3
