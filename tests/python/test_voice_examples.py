"""examples/voices: lips that follow a voice on a WebSocket. tests/agents has the examples for Pipecat and LiveKit."""

from __future__ import annotations

import asyncio
import os
import re
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, List, Tuple

import numpy as np
import pytest
import websockets

import follow_websocket
import labial
import player
import stand_in
from labial.errors import LabialError
from packages import SOURCE, needs_runtime

pytestmark = needs_runtime
EXAMPLES = SOURCE / "examples" / "voices"


def test_lips_follow_a_websocket(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Every frame is printed once, when it is due, and is that of the words and times that the service tells. Its
    sounds change slowly where more becomes known."""
    monkeypatch.setattr("player.shutil.which", lambda name: None)
    text = "Maybe hum by pool."

    async def run() -> float:
        async with websockets.serve(lambda socket: None, "127.0.0.1", 0) as probe:
            port = probe.sockets[0].getsockname()[1]
        server = asyncio.create_task(stand_in.serve(port))
        await asyncio.sleep(0.1)
        began = time.monotonic()
        await follow_websocket.main(text, f"ws://127.0.0.1:{port}")
        server.cancel()
        return time.monotonic() - began

    took = asyncio.run(run())
    shown_lines = capsys.readouterr().out.splitlines()[1:]  # behind the port
    rows = [re.fullmatch(r" *(\d+) jaw (\S+) pucker (\S+)", line) for line in shown_lines]
    shown = [(int(row[1]), float(row[2]), float(row[3])) for row in rows if row]
    assert len(shown) == len(rows) > 60 and took > len(rows) / 50 - 0.1
    with labial.Voice() as voice:
        for said in stand_in.say(text):
            voice.feed(stand_in.message_of(said))
        expected = [(frame.number, round(weights["jawOpen"], 3), round(weights["mouthPucker"], 3))
                    for k in range(len(shown)) for frame in voice.played(k / 50)
                    for weights in [frame.rig("arkit")]]
    np.testing.assert_allclose(shown, expected, rtol=0, atol=0.03)
    assert max(jaw for _, jaw, _ in shown) > 0.1


def program(name: str, *arguments: str, **environment: str) -> subprocess.Popen:
    """Starts an example."""
    return subprocess.Popen([sys.executable, str(EXAMPLES / f"{name}.py"), *arguments], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True,
                            env={**os.environ, "PYTHONPATH": str(SOURCE / "export"), **environment})


def ended(process: subprocess.Popen) -> Tuple[int, str, str]:
    """Status, output and errors."""
    with process:
        out, err = process.communicate(timeout=40)
    return process.returncode, out, err


def test_a_service_that_is_not_there() -> None:
    """The client says so in a line; it does not wait for ever."""
    status, out, err = ended(program("follow_websocket", "hum", "ws://127.0.0.1:9"))
    assert (status, out, err.count("\n")) == (1, "", 1)
    assert err.startswith("follow_websocket: ws://127.0.0.1:9: ") and "refused" in err.lower()


@pytest.mark.slow
def test_a_service_that_dies() -> None:
    """Catches a traceback, and frames that are not shown since their end is missing."""
    with program("stand_in", "0") as service:
        assert service.stdout
        port = service.stdout.readline().split()[1]
        client = program("follow_websocket", "Maybe people hum by the pool and hum again.", f"ws://127.0.0.1:{port}")
        assert client.stdout
        client.stdout.readline()
        service.kill()
    status, out, err = ended(client)
    assert status == 1 and len(out.splitlines()) > 10
    assert err.startswith(f"follow_websocket: ws://127.0.0.1:{port}: ConnectionClosed") and err.count("\n") == 1


def test_a_service_that_sends_something_else() -> None:
    """Catches a traceback for a message without sound, and for one that is no JSON."""
    for message in ('{"word": 1}', "nothing", "[]"):
        async def answer(socket: Any, message: str = message) -> None:
            await socket.recv()
            await socket.send(message)

        async def run() -> None:
            async with websockets.serve(answer, "127.0.0.1", 0) as service:
                await follow_websocket.main("hum", f"ws://127.0.0.1:{service.sockets[0].getsockname()[1]}")

        with pytest.raises(LabialError):
            asyncio.run(run())


@pytest.mark.parametrize("arguments", [["x"], ["65536"], ["1", "2"], ["-1"]])
def test_a_stand_in_checks_its_port(arguments: List[str]) -> None:
    assert ended(program("stand_in", *arguments)) == (2, "", "usage: stand_in [PORT]\n")


def test_a_port_that_is_taken() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        status, out, err = ended(program("stand_in", str(port)))
    assert (status, out, err.lower()) == (1, "", f"stand_in: port {port}: address already in use\n")


@pytest.mark.slow
def test_limits_of_the_stand_in(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Catches clients that are kept though they say nothing, texts without end, and a long word that stops others."""
    monkeypatch.setattr(stand_in, "CLIENTS", 2)

    async def run() -> None:
        server = asyncio.create_task(stand_in.serve(0, patience=0.5))
        while not (told := capsys.readouterr().out):
            await asyncio.sleep(0.01)
        address = f"ws://127.0.0.1:{told.split()[1]}"
        async with websockets.connect(address) as first, websockets.connect(address) as second:
            async with websockets.connect(address) as third:
                with pytest.raises(websockets.ConnectionClosed, match="enough clients"):
                    await third.recv()
            await first.send("a" * 3900)
            began = time.monotonic()
            pong = await second.ping()
            await asyncio.wait_for(pong, 5)
            assert time.monotonic() - began < 1.0
            with pytest.raises(websockets.ConnectionClosed):
                await asyncio.wait_for(second.recv(), 5)
        async with websockets.connect(address) as first:
            await first.send("a" * 5000)
            with pytest.raises(websockets.ConnectionClosed, match="1009"):
                await asyncio.wait_for(first.recv(), 5)
        server.cancel()

    asyncio.run(run())


@pytest.mark.parametrize(("name", "package"), [
    ("follow_websocket", "websockets"), ("stand_in", "websockets"), ("pipecat_bot", "pipecat"),
    ("livekit_agent", "livekit")])
def test_without_its_package_an_example_says_what_to_install(name: str, package: str, tmp_path: Path) -> None:
    """Catches a traceback. A module that cannot be found hides the package."""
    (tmp_path / f"{package}.py").write_text(f"raise ModuleNotFoundError('No module', name='{package}')\n")
    paths = os.pathsep.join((str(tmp_path), str(SOURCE / "export")))
    arguments = {"stand_in": ["0"], "follow_websocket": ["hum"]}.get(name, [])
    status, out, err = ended(program(name, *arguments, PYTHONPATH=paths))
    assert (status, out) == (1, "")
    assert err.startswith(f"{name}: this needs the package {package}: pip install {package}")


def test_the_player_keeps_its_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """No time before the first sound; a gap in the sound is not heard as sound."""
    now = [100.0]
    monkeypatch.setattr("player.time.monotonic", lambda: now[0])
    heard = player.Player(1000, silent=True)
    assert heard.heard() is None and heard.written == 0
    found: List[Any] = []
    heard.play(bytes(1000))  # half a second
    for moment in (100.0, 100.2, 100.4):
        now[0] = moment
        found.append(heard.heard())
    now[0] = 101.0
    heard.play(bytes(1000))  # half a second late
    found.append(heard.heard())
    now[0] = 101.25
    found.append(heard.heard())
    assert found == pytest.approx([0.0, 0.2, 0.4, 0.5, 0.75])
    heard.close()


def test_the_player_pipes_to_aplay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What aplay is given, and that one that fails is done without."""
    for name, script in (("good", f'echo "$@" > {tmp_path}/arguments\ncat > {tmp_path}/sound\n'), ("bad", "exit 1\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "aplay").write_text(f"#!/bin/sh\n{script}")
        (tmp_path / name / "aplay").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}/good{os.pathsep}{os.environ['PATH']}")
    playing = player.Player(16000)
    playing.play(b"\x01\x02" * 100)
    playing.play(b"\x03\x04")
    playing.close()
    assert (tmp_path / "sound").read_bytes() == b"\x01\x02" * 100 + b"\x03\x04"
    assert (tmp_path / "arguments").read_text().split() == "-q -t raw -f S16_LE -c 1 -r 16000".split()
    monkeypatch.setenv("PATH", f"{tmp_path}/bad{os.pathsep}{os.environ['PATH']}")
    failing = player.Player(16000)
    for _ in range(20):
        failing.play(bytes(100_000))
        time.sleep(0.01)
    failing.close()
    assert failing.written == 62.5
