"""Lips that follow a voice on a WebSocket: plays its sound and prints the mouth, frame by frame.

    python3 stand_in.py &
    python3 follow_websocket.py "Maybe people hum by the pool."

A service has another address, asks for a key and has its own first message; what follows is the same.
"""

from __future__ import annotations

import asyncio
import base64
import json
import sys

import labial
from labial.errors import LabialError
from labial.program import Parser, os_error, run
from player import Player

try:
    import websockets
except ModuleNotFoundError:
    sys.exit("follow_websocket: this needs the package websockets: pip install websockets")


async def main(text: str, address: str) -> int:
    """Says a text. Raises LabialError, or OSError, when the service fails."""
    voice, player = labial.Voice(), Player(24000)

    async def receive() -> None:
        async with websockets.connect(address) as socket:
            await socket.send(text)
            async for message in socket:
                voice.feed(message)
                player.play(base64.b64decode(json.loads(message)["audio"] or ""))

    receiving = asyncio.create_task(receive())
    receiving.add_done_callback(lambda _: voice.finish())
    async for frame in voice.follow(player.heard):
        weights = frame.rig("arkit")
        print(f"{frame.number:4} jaw {weights['jawOpen']:.3f} pucker {weights['mouthPucker']:.3f}", flush=True)
    try:
        await receiving
    except (websockets.WebSocketException, KeyError, TypeError, ValueError) as error:
        raise LabialError(f"{address}: {type(error).__name__}: {error}") from None
    except OSError as error:
        raise LabialError(f"{address}: {os_error(error)}") from None
    return 0


if __name__ == "__main__":
    parser = Parser(prog="follow_websocket", description="Lips that follow a voice.")
    parser.add_argument("text")
    parser.add_argument("address", nargs="?", default="ws://127.0.0.1:8765")
    options = parser.parse_args()
    sys.exit(run("follow_websocket", lambda: asyncio.run(main(options.text, options.address))))
