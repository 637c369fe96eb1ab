"""examples/voices: lips that follow a voice on a WebSocket. tests/agents has the examples for Pipecat and LiveKit."""

from __future__ import annotations

import asyncio
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, List

import follow_websocket
import player
import pytest
import stand_in
import websockets

import labial
from packages import SOURCE
from runtime import needs_runtime

pytestmark = needs_runtime
EXAMPLES = SOURCE / "examples" / "voices"


def test_lips_follow_a_websocket(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Every frame is printed once, when it is due, and is that of the words and times that the service tells."""
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
    rows = [re.fullmatch(r" *(\d+) jaw (\S+) pucker (\S+)", line) for line in capsys.readouterr().out.splitlines()]
    shown = [(int(row[1]), float(row[2]), float(row[3])) for row in rows if row]
    assert len(shown) == len(rows) > 60 and took > len(rows) / 50 - 0.1
    with labial.Voice() as voice:
        for said in stand_in.say(text):
            voice.feed(stand_in.message_of(said))
        expected = [(frame.number, round(weights["jawOpen"], 3), round(weights["mouthPucker"], 3))
                    for k in range(len(shown)) for frame in voice.played(k / 50)
                    for weights in [frame.rig("arkit")]]
    assert shown == expected and max(jaw for _, jaw, _ in shown) > 0.1


def test_a_service_that_fails_ends_the_loop(tmp_path: Path) -> None:
    """Without a server the client says so; it does not wait for ever."""
    done = subprocess.run([sys.executable, str(EXAMPLES / "follow_websocket.py"), "hum", "ws://127.0.0.1:9"],
                          capture_output=True, text=True, cwd=tmp_path, timeout=30,
                          env={**os.environ, "PYTHONPATH": str(SOURCE / "export")})
    assert done.returncode != 0 and "refused" in done.stderr.lower()


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
