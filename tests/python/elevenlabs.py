"""A stand-in for ElevenLabs' stream of sound and characters over a WebSocket, on this machine.

A client connects, sends its text in pieces, as JSON, and an empty text at the end. The answers are messages with a
piece of the sound, 16 bits at 16 kHz in base64, and the characters that it speaks with their times in milliseconds,
which begin at 0 in each message; the last one says ``isFinal``. The sound is a hum as long as its characters.
"""

from __future__ import annotations

import base64
import json
import struct
import threading
import time
from contextlib import contextmanager, suppress
from typing import Any, Dict, Iterator, List

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

RATE = 16000


def messages(text: str, pace: int = 70) -> List[Dict[str, Any]]:
    """The answers to a text: a message for each sentence; a character lasts `pace` milliseconds, a blank as long."""
    found = []
    for sentence in (f"{part.strip()}." for part in text.split(".") if part.strip()):
        characters = [*sentence, " "]
        length = pace * len(characters)
        samples = [round(3000 * ((n * 110 // RATE) % 2 * 2 - 1)) for n in range(RATE * length // 1000)]
        alignment = {"chars": characters, "charStartTimesMs": [pace * n for n in range(len(characters))],
                     "charsDurationsMs": [pace] * len(characters)}
        found.append({"audio": base64.b64encode(struct.pack(f"<{len(samples)}h", *samples)).decode(),
                      "isFinal": None, "alignment": alignment, "normalizedAlignment": alignment})
    return [*found, {"audio": None, "isFinal": True, "alignment": None, "normalizedAlignment": None}]


@contextmanager
def voice(wait: float = 0.25) -> Iterator[str]:
    """Serves any number of clients, `wait` seconds before each message; the address."""
    def speak(client: ServerConnection) -> None:
        with suppress(ConnectionClosed):  # it went away
            for message in messages("".join(iter(lambda: json.loads(client.recv())["text"], ""))):
                time.sleep(wait)
                client.send(json.dumps(message))

    with serve(speak, "127.0.0.1", 0, compression=None) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
