"""Lips that follow a voice on a WebSocket: plays its sound and prints the mouth, frame by frame.

    python3 stand_in.py &
    python3 follow_websocket.py "Maybe people hum by the pool."

A service has another address, asks for a key and has its own first message; what follows is the same.
"""

import asyncio
import base64
import json
import sys

import websockets

import labial
from player import Player


async def main(text: str, address: str = "ws://127.0.0.1:8765") -> None:
    """Says a text."""
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
    await receiving


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:3]))
