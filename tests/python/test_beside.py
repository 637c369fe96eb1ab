"""Lips beside the audio: the packets of labial.Beside, and from end to end, examples/beside/server.py to a toy in C
with a simulated loudspeaker."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np
import pytest

import labial
from labial.bake.source import RATE
from labial.bake.track import as_bytes
from labial.errors import LabialError
from labial.rig.description import read
from labial.rig.table import convert
from packages import SOURCE, needs_runtime

CC = os.environ.get("LABIAL_CC", "")
pytestmark = needs_runtime
EXAMPLE = SOURCE / "examples" / "beside"
FACE = EXAMPLE / "face.toml"
HELLO = [("pau", 120), ("HH", 70), ("AH", 60), ("L", 80), ("OW", 250), ("M", 90), ("AA", 120), ("pau", 300)]


class Parsed(NamedTuple):
    """A packet as docs/beside.md describes it."""

    cancels: int
    first: int
    session: int
    rest: bytes
    frames: List[bytes]


def parse(data: bytes) -> Parsed:
    form, cancels, outputs, count, first, session = struct.unpack("<4BIH", data[:10])
    assert form == 2 and len(data) == 10 + outputs * (count + 1)
    rows = [data[at : at + outputs] for at in range(10, len(data), outputs)]
    return Parsed(cancels, first, session, rows[0], rows[1:])


def expected(motion: Sequence[Sequence[int]], face: Path = FACE) -> List[bytes]:
    """The bytes of frames as `labial bake` writes them."""
    rig = read(str(face), "face")
    return [bytes(row) for row in as_bytes(rig, convert(rig), np.array(motion, dtype=np.float64))]


def test_packets_follow_sounds(tmp_path: Path) -> None:
    """A tongue that stays at rest though the frames bring the shares of their sounds; 13 FAPs alone move no tongue."""
    (tmp_path / "tongue.toml").write_text('unit = "weight"\n[output.tongue]\nneutral = 0\nvisemes = { TH = 1.0 }\n'
                                          "full = 1\n")
    motion = labial.render([("TH", 200), ("IH", 200), ("TH", 200)])
    assert all(len(frame.visemes) == 15 and sum(frame.visemes) in range(120, 136) for frame in motion)
    with labial.Stream() as stream:
        for phoneme in ("TH", "IH", "TH"):
            stream.push(phoneme, 200)
        stream.end()
        streamed = list(stream)
    assert [frame.visemes for frame in streamed] == [frame.visemes for frame in motion]

    def tongue(frames: Sequence) -> List[int]:
        packets = labial.Beside(tmp_path / "tongue.toml").packets(frames, sample=0, sample_rate=24000)
        return [row[0] for packet in packets for row in parse(packet.data).frames]

    shown = tongue(motion)
    assert shown == tongue(streamed)
    assert min(shown[2:8]) > 240 and max(shown[14:17]) < 60 and shown[-1] == 0
    assert set(tongue([tuple(frame) for frame in motion])) == {0}


def test_packets_have_the_bytes_of_baked_motion() -> None:
    """Catches another rounding than that of `labial bake`, whose player the toy's units are those of, and frames that
    are lost, doubled or numbered otherwise."""
    motion = labial.render(HELLO)
    wanted = expected(motion)
    lips = labial.Beside(FACE)
    packets = lips.packets(motion, sample=48000, sample_rate=24000)
    assert [packet.frame for packet in packets] == list(range(100, 100 + len(motion), 10))
    assert lips.frame == 100 + len(motion)
    found = []
    for packet in packets:
        parsed = parse(packet.data)
        assert (parsed.cancels, parsed.first) == (0, packet.frame) and parsed.rest == bytes([0, 128])
        found += parsed.frames
    assert found == wanted and len({row[0] for row in found}) > 20
    values = labial.Rig(FACE).ahead(motion, len(motion))
    for row, value in zip(found, values):
        assert abs(1400 + 500 * row[0] / 255 - value["jaw"]) <= 500 / 255 / 2 + 1e-9
        assert abs(1300 + 400 * row[1] / 255 - value["upper_lip"]) <= 400 / 255 / 2 + 1e-9
    assert 10 * len(packets) + 2 * (len(packets) + len(motion)) < len(motion) / RATE * 170, "bytes a second"


def test_a_servo_with_a_limit_of_speed_sees_the_utterance(tmp_path: Path) -> None:
    """Catches packets whose frames are converted one by one: a slow jaw would not be closed in M."""
    slow = tmp_path / "slow.toml"
    slow.write_text('[output.jaw]\nfrom = "opening"\nclosed = 1400\nfull = 1900\nslew = 40\n', encoding="utf-8")
    motion = labial.render(HELLO)
    found = b"".join(b"".join(parse(packet.data).frames)
                     for packet in labial.Beside(slow, frames=3).packets(motion, sample=0, sample_rate=16000))
    assert found == b"".join(expected(motion, slow))
    times = np.cumsum([0, *(length for _, length in HELLO)])
    assert min(found[times[5] // 20 : times[6] // 20]) == 0


def test_a_stream_is_packed_as_it_comes(tmp_path: Path) -> None:
    """Catches frames that are kept back for ever, and others than those of a whole utterance. A servo with a limit of
    speed would see nothing ahead."""
    fast = tmp_path / "fast.toml"
    fast.write_text(re.sub(r"slew = .*", "", FACE.read_text(encoding="utf-8")), encoding="utf-8")
    motion, lips, packets = labial.render(HELLO), labial.Beside(fast, frames=7), []
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
    assert [row for packet in packets for row in parse(packet.data).frames] == expected(motion, fast)


@pytest.mark.parametrize("repeat", [0, 1, 2, 3, 5, 40])
def test_packets_repeat_as_many_frames_as_there_are(repeat: int) -> None:
    """Also more than a packet has, from the first packet on; on from where the one before ended, not across a gap."""
    motion = labial.render(HELLO)[:24]
    lips, wanted = labial.Beside(FACE, frames=2, repeat=repeat), expected(motion)
    packets = lips.packets(motion[:12], sample=0, sample_rate=16000)
    packets += lips.packets(motion[12:], sample=16000 * 12 // 50, sample_rate=16000)
    assert [packet.frame for packet in packets] == list(range(0, 24, 2))
    for packet in packets:
        parsed, first = parse(packet.data), max(packet.frame - repeat, 0)
        assert (parsed.first, parsed.frames) == (first, wanted[first : packet.frame + 2])
    behind = [parse(packet.data) for packet in lips.packets(motion[:4], sample=32000, sample_rate=16000)]
    assert [parsed.first for parsed in behind] == [100, max(102 - repeat, 100)]


def test_hello_and_cancel() -> None:
    """Catches a rest that is not the rig's, frames that survive a cancel, numbers that begin again, and connections
    that all have the same session."""
    lips = labial.Beside(FACE, session=258)
    assert parse(lips.hello()) == (0, 0, 258, bytes([0, 128]), []) and lips.session == 258
    lips.push(labial.render(HELLO)[:15])
    assert parse(lips.cancel(24000, 16000)) == (1, 75, 258, bytes([0, 128]), [])
    assert lips.flush() == [] and lips.rig.values == {"jaw": 1400, "upper_lip": 1500}
    assert lips.packets([(0,) * 13] * 3, sample=24000 + 161, sample_rate=16000)[0].frame == 76, "the nearest frame"
    assert parse(lips.cancel(2**32 * 320, 16000)).first == 0, "modulo 2^32"
    found = {labial.Beside(FACE).session for _ in range(20)}
    assert len(found) > 15 and max(found) > 255, "of their own"


@pytest.mark.parametrize(("options", "message"), [
    ({"session": -1}, "a session is 0 to 65535, not -1"), ({"session": 65536}, "not 65536"),
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


# ---- From end to end -------------------------------------------------------------------------------------------------

PATIENCE = 5  #: seconds that the toy waits for its server


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """examples/beside/toy.c as its comment compiles it, with warnings."""
    if not CC:
        pytest.skip("LABIAL_CC names no compiler")
    if not shutil.which("flite"):
        pytest.skip("no flite: install the Debian package flite")
    program = tmp_path_factory.mktemp("toy") / "toy"
    subprocess.run([CC, "-std=c99", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror",
                    f"-DPATIENCE={PATIENCE}",
                    f"-I{SOURCE / 'include'}", str(EXAMPLE / "toy.c"), str(SOURCE / "lib" / "beside.c"), "-o",
                    str(program)], check=True, timeout=120)
    return program


def serve(*options: str, **environment: str) -> subprocess.Popen:
    """Starts the server."""
    return subprocess.Popen([sys.executable, str(EXAMPLE / "server.py"), *options], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True,
                            env={**os.environ, "PYTHONPATH": str(SOURCE / "export"), **environment})


@contextlib.contextmanager
def serving(*options: str, **environment: str) -> Iterator[Tuple[subprocess.Popen, int]]:
    """A server at any port that is free, until the end of the block."""
    with serve("--port", "0", *options, **environment) as process:
        try:
            assert process.stdout
            yield process, int(process.stdout.readline().split()[1])
        finally:
            process.kill()


@pytest.fixture(scope="module")
def server(request: pytest.FixtureRequest) -> Iterator[Tuple[int, int]]:
    """The port of a server that sends as fast as the toy takes it, and how many frames its packets repeat: 0, or the
    parameter."""
    repeat = getattr(request, "param", 0)
    with serving("--ahead", "60", "--repeat", str(repeat)) as (_, port):
        yield port, repeat


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
    found = [Shown((row[0] ^ 2**31) - 2**31, bool(row[1]), bytes(row[2:4]), tuple(row[4:])) for row in numbers]
    for before, line in zip(found, found[1:]):
        assert all(abs(a - b) <= most for a, b, most in zip(before.row, line.row, LIMITS)), "a servo jumps"
        assert all(abs(a - b) <= most for a, b, most in zip(before.pulses, line.pulses, (101, 81))), "by rounding, one"
    return found


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
    motion = labial.render(timings, exact=True)
    values = labial.Rig(FACE).ahead(motion, len(motion))  # slow servos start early enough
    return Said(timings, expected(motion), [tuple(map(int, value.values())) for value in values])


LIMITS = (51, 51)  #: of the toy, steps of 255 in 20 ms: 100 of 500 us and 80 of 400


def compare(lines: Sequence[Shown], spoken: Said, start: int, lost: Sequence[int] = ()) -> int:
    """Checks that what is shown is the rig's value at the sample that is heard, or as near to it as the servos come,
    but in lost frames. Returns how many lines have just the rig's values."""
    newest, compared, before = -1, 0, None
    for line in lines:
        newest = max(newest, (line.sample - start) // STEP)  # the clock jitters, the mouth does not turn back
        if 0 <= newest < len(spoken.rows) and newest not in lost:
            assert line.speaks
            compared += line.row == spoken.rows[newest]
            for value, wanted, last, most in zip(line.row, spoken.rows[newest], before or line.row, LIMITS):
                assert value == wanted or value - last == (most if wanted > last else -most) or before is None, line
            if line.row == spoken.rows[newest]:
                for pulse, value, span in zip(line.pulses, spoken.values[newest], (500, 400)):
                    assert abs(pulse - value) <= span / 255 / 2 + 0.5
        before = line.row
    return compared


def closures(lines: Sequence[Shown], spoken: Said, start: int) -> int:
    """Checks that the jaw is closed, up to 3 %, in each p, b, m of 30 ms or more that the lines reach; returns how many
    there are."""
    found, begin = 0, 0.0
    for label, length in spoken.timings:
        end = begin + length
        inside = [line.row[0] for line in lines
                  if begin - 10 <= (line.sample - start) * 1000 / RATE_OF_VOICE < end + 10]
        if label in ("p", "b", "m") and length >= 30 and len(inside) >= length // 20:
            assert min(inside) <= 8, (label, begin)
            found += 1
        begin = end
    return found


def test_a_toy_shows_what_is_heard(toy: Path, server: Tuple[int, int]) -> None:
    """Catches lips that are not in step with the samples, in one utterance and in the next; lips that are open in p, b,
    m; and pulses that are not the rig's."""
    lines = play(toy, server[0], "say Mama may pop a bubble.\nplay 60000\nsay Bob may be happy.\nplay 60000\n",
                 "jitter")
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
    assert compare(lines[: len(spoken.rows) - 12], spoken, 0, lost) > 40
    for k in range(lost[0], lost[0] + 10):
        assert lines[k].speaks == (k < lost[0] + 5)
        if k < lost[0] + 5:
            assert lines[k].row == lines[lost[0] - 1].row


def test_a_cancel(toy: Path, server: Tuple[int, int]) -> None:
    """Catches lips that speak on after a cancel, and ones that are late by the dropped sound from then on."""
    lines = play(toy, server[0], "say Mama may pop a bubble, and another one.\nplay 400\nstop\n"
                                 "say Bob may be happy.\nplay 60000\n", "jitter")
    first, second = said("Mama may pop a bubble, and another one."), said("Bob may be happy.")
    stopped = next(k for k, line in enumerate(lines) if not line.speaks and k)
    assert stopped == 20 and compare(lines[:stopped], first, 0) > 10, "the clock begins before the first sample"
    assert [line.speaks for line in lines[stopped : stopped + 6]] == [False] * 6
    assert lines[stopped + 5].row == bytes([0, 128])
    assert lines[stopped - 1].row != lines[stopped].row != lines[stopped + 5].row, "it eases"
    after = [line for line in lines[stopped + 6 :] if line.speaks]
    start = round(after[0].sample / 960) * 960  # behind all blocks of 60 ms that were sent
    assert start > 20 * STEP + 960
    assert compare(after, second, start) > 50
    assert closures(after, second, start) >= 3


# ---- What goes wrong -------------------------------------------------------------------------------------------------

needs_flite = pytest.mark.skipif(not shutil.which("flite"), reason="no flite: install the Debian package flite")


@needs_flite
@pytest.mark.parametrize(("options", "status", "message"), [
    (["--rig", "nosuch.toml"], 1, "server: nosuch.toml: No such file or directory"),
    (["--voice", "nosuch"], 1, "server: flite has no voice 'nosuch': it has "),
    (["--repeat", "250"], 1, "server: a packet cannot have 10 frames and 250 repeated ones: 1 .. 255 in all"),
    (["--repeat", "300"], 2, "server: argument --repeat: '300' is not a whole number within 0 .. 254"),
    (["--ahead", "-1"], 2, "server: argument --ahead: '-1' is not a number from 0 to 600"),
    (["--ahead", "nan"], 2, "server: argument --ahead: 'nan' is not a number from 0 to 600"),
    (["--port", "65536"], 2, "server: argument --port: '65536' is not a whole number within 0 .. 65535"),
    (["--hurry"], 2, "server: unrecognized arguments: --hurry"),
    ([], 1, "server: the voice needs flite: apt-get install flite"),
])  # fmt: skip
def test_a_server_checks_what_it_is_given(options: List[str], status: int, message: str, tmp_path: Path) -> None:
    """Catches a server that prints its port and fails at the first toy, a voice that flite silently replaces, and a
    traceback."""
    with serve("--port", "0", *options, **({} if options else {"PATH": str(tmp_path)})) as process:
        out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (status, "")
    assert err.startswith(message) and err.count("\n") == 1


@needs_flite
def test_a_port_that_is_taken() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with serve("--port", str(port)) as process:
            out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (1, "")
    assert err.lower() == f"server: port {port} of 127.0.0.1: address already in use\n"


@contextlib.contextmanager
def connected(port: int) -> Iterator[Tuple[socket.socket, Callable[[], bytes]]]:
    """A connection, and what takes the kind of the server's next message: nothing at its end."""
    with socket.create_connection(("127.0.0.1", port), timeout=60) as toy, toy.makefile("rb") as stream:
        def take() -> bytes:
            with contextlib.suppress(ConnectionResetError):
                if len(head := stream.read(3)) == 3:
                    stream.read(struct.unpack("<H", head[1:])[0])
                    return head[:1]
            return b""

        yield toy, take


@needs_flite
def test_connections_do_not_wait_for_each_other(tmp_path: Path) -> None:
    """Catches a server that speaks, or waits, while it accepts a toy: with 60 new ones the sound of a toy that plays
    came 9 s late. flite takes 3 s here for a text, so that one connection that waits for it is seen."""
    real = shutil.which("flite")
    (tmp_path / "flite").write_text(f'#!/bin/sh\n[ ! -f "{tmp_path}/slow" ] || sleep 3\nexec "{real}" "$@"\n')
    (tmp_path / "flite").chmod(0o755)
    with serving("--ahead", "0.2", PATH=f"{tmp_path}{os.pathsep}{os.environ['PATH']}") as (_, port), \
            contextlib.ExitStack() as toys:
        first, take = toys.enter_context(connected(port))
        first.sendall(b"say " + 5 * b"Mama may pop a bubble, and Bob may be happy about it. " + b"\n")
        while take() != b"A":
            pass
        (tmp_path / "slow").touch()
        others = [toys.enter_context(connected(port)) for _ in range(60)]
        assert [take_of_other() for _, take_of_other in others] == [b"R"] * 60
        others[0][0].sendall(b"say a\n")
        sound = [time.monotonic() for _ in range(30) if take() == b"A"]
        assert len(sound) > 20 and max(after - before for before, after in zip(sound, sound[1:])) < 2.5


@pytest.mark.slow
@needs_flite
def test_limits_of_a_server() -> None:
    """Catches connections and silent toys that are kept without end, lines that are, and an empty line that ends."""
    with serving("--connections", "2", "--idle", "1") as (process, port):
        with connected(port) as (speaking, take), connected(port) as (_, take_of_silent):
            assert [take(), take_of_silent()] == [b"R", b"R"]
            with connected(port) as (_, take_of_third):
                assert take_of_third() == b""
            speaking.sendall(b"\nsay Hello there, how are you today, and what do you say?\n")
            assert [take() for _ in range(20)].count(b"A") > 10, "it is not silent while it speaks"
            assert list(iter(take, b""))[-1] == b"E", "and is hung up on when it has been"
        with connected(port) as (long, take):
            long.sendall(b"say " + b"a" * 5000)
            assert list(iter(take, b""))[0] == b"R"
        with connected(port) as (many, take):
            many.sendall(b"say a\n" * 20)
            ends = 0
            while ends < 20:  # also of what it does not speak
                kind = take()
                assert kind
                ends += kind == b"E"
        process.kill()
        assert process.stderr
        told = process.stderr.read().splitlines()
    assert "server: there are 2 toys already" in told and "server: a toy has said nothing for 1 s" in told
    assert "server: a toy sends more than 2000 bytes in a line" in told
    assert all(line.startswith("server: ") for line in told)


def refused(toy: Path, *arguments: object, text: str = "") -> Tuple[int, str]:
    """The status of a toy that prints nothing, and what it says."""
    done = subprocess.run([toy, *map(str, arguments)], input=text, capture_output=True, text=True, check=False,
                          timeout=10)
    assert done.stdout == ""
    return done.returncode, done.stderr


def test_a_toy_checks_what_it_is_given(toy: Path, server: Tuple[int, int]) -> None:
    """Catches a port of 0, options that are passed over, a sentence that names no port, a line that does nothing."""
    for arguments in ([], ["x"], ["0"], ["65536"], ["1", "lose"], ["1", "lose", "x"], ["1", "hurry"]):
        assert refused(toy, *arguments) == (2, "usage: toy PORT [lose N] [jitter]\n")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    assert refused(toy, port) == (1, f"toy: port {port}: Connection refused\n")
    assert refused(toy, server[0], text="sing\n") == (
        1, "toy: standard input: a line is neither say TEXT, play MS nor stop\n")


@pytest.mark.slow
@pytest.mark.parametrize(("number", "complaint"), [
    (signal.SIGKILL, "toy: the server has gone: "), (signal.SIGSTOP, "toy: the server has gone: it sends nothing\n"),
])
def test_a_toy_whose_server_dies_or_stops(toy: Path, number: int, complaint: str) -> None:
    """Catches "the server has gone: Success", and a toy that waits for ever."""
    with serving("--ahead", "0.1") as (process, port):
        with subprocess.Popen([toy, str(port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as playing:
            assert playing.stdin
            playing.stdin.write("say Mama may pop a bubble, and Bob may be happy about it.\nplay 60000\n")
            playing.stdin.flush()
            assert playing.stdout
            assert all(playing.stdout.readline() for _ in range(10))
            process.send_signal(number)
            _, err = playing.communicate(timeout=PATIENCE + 60)
    assert playing.returncode == 1
    assert err.startswith(complaint) and err.count("\n") == 1 and "Success" not in err
