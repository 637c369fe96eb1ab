"""A stand-in for ElevenLabs' stream of sound and characters over a WebSocket, on this machine.

A client connects, sends its text in pieces, as JSON, and an empty text at the end. The answers are messages with a
piece of the sound, 16 bits at 16 kHz in base64, and the characters that it speaks with their times in milliseconds,
which begin at 0 in each message; the last one says ``isFinal``. The sound is a hum as long as its characters.
"""

from __future__ import annotations

import base64
import hashlib
import json
import socket
import struct
import threading
import time
from contextlib import contextmanager
from typing import Any, Dict, Iterator, List, Sequence, Tuple

RATE = 16000
#: Of RFC 6455.
_GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
_TEXT, _CLOSE = 1, 8


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
    with socket.create_server(("127.0.0.1", 0)) as listener:
        threading.Thread(target=_accept, args=(listener, wait), daemon=True).start()
        yield f"ws://127.0.0.1:{listener.getsockname()[1]}"


def _accept(listener: socket.socket, wait: float) -> None:
    while True:
        try:
            connection, _ = listener.accept()
        except OSError:
            return
        threading.Thread(target=_serve, args=(connection, wait), daemon=True).start()


def _serve(connection: socket.socket, wait: float) -> None:
    with connection:
        try:
            _shake_hands(connection)
            text = ""
            while piece := json.loads(_received(connection))["text"]:
                text += piece
            for message in messages(text):
                time.sleep(wait)
                _send(connection, _TEXT, json.dumps(message).encode())
            _send(connection, _CLOSE, struct.pack(">H", 1000))
            connection.recv(1024)  # that the client closes
        except (OSError, EOFError):
            pass  # it went away


def _shake_hands(connection: socket.socket) -> None:
    head = b""
    while b"\r\n\r\n" not in head:
        head += _exactly(connection, 1)
    fields: Sequence[Tuple[bytes, bytes, bytes]] = [line.partition(b":") for line in head.split(b"\r\n")]
    key = next(value.strip() for name, _, value in fields if name.lower() == b"sec-websocket-key")
    answer = base64.b64encode(hashlib.sha1(key + _GUID).digest())
    connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       b"Sec-WebSocket-Accept: " + answer + b"\r\n\r\n")


def _received(connection: socket.socket) -> bytes:
    """The text of the next frame, which a client masks."""
    kind, length = _exactly(connection, 2)
    if kind & 15 != _TEXT:
        raise EOFError
    size = length & 127
    if size >= 126:
        size = int.from_bytes(_exactly(connection, 2 if size == 126 else 8), "big")
    mask = _exactly(connection, 4)
    return bytes(byte ^ mask[n % 4] for n, byte in enumerate(_exactly(connection, size)))


def _exactly(connection: socket.socket, count: int) -> bytes:
    data = b""
    while len(data) < count:
        piece = connection.recv(count - len(data))
        if not piece:
            raise EOFError
        data += piece
    return data


def _send(connection: socket.socket, kind: int, data: bytes) -> None:
    size = len(data)
    length = struct.pack(">B", size) if size < 126 else struct.pack(">BH", 126, size) if size < 1 << 16 else (
        struct.pack(">BQ", 127, size))  # fmt: skip
    connection.sendall(bytes([0x80 | kind]) + length + data)
