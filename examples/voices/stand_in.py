"""A voice to try with, in place of a speech service: hums words, and tells when each is heard.

    python3 stand_in.py [PORT]

serves it as a WebSocket on 127.0.0.1, with messages like those of ElevenLabs: each client's first message is the text;
the answers, three words each, have sound (base64, 16 bits, 24 kHz) and the times of its characters from their own
beginning. They come faster than they are heard. It needs the package websockets, and nothing else.
"""

from __future__ import annotations

import asyncio
import base64
import json
import math
import sys
from array import array
from typing import Any, Dict, Iterator, List, NamedTuple, Tuple

RATE = 24000
PORT = 8765
#: Seconds of a character, and from a word to the next.
_CHARACTER, _GAP = 0.065, 0.06


class Said(NamedTuple):
    """Some words, as a service answers."""

    sound: bytes  #: 16-bit samples of one channel, low byte first
    words: List[Tuple[str, float, float]]  #: each word, its beginning and end, seconds from the beginning of the sound


def say(text: str) -> Iterator[Said]:
    """A text in pieces of three words."""
    words = text.split()
    for first in range(0, len(words), 3):
        moment, timed, samples = 0.0, [], array("h")
        for word in words[first : first + 3]:
            end = moment + _CHARACTER * len(word)
            timed.append((word, round(moment, 3), round(end, 3)))
            samples.extend(_hum(end - moment))
            samples.extend([0] * round(_GAP * RATE))
            moment = len(samples) / RATE
        if sys.byteorder == "big":
            samples.byteswap()
        yield Said(samples.tobytes(), timed)


def message_of(said: Said) -> Dict[str, Any]:
    """What is said as a message: sound and alignment of the characters, blanks included."""
    characters, starts, lengths = [], [], []
    for word, start, end in said.words:
        step = (end - start) / len(word)
        for place, character in enumerate(f"{word} "):
            characters.append(character)
            starts.append(round(1000 * (start + place * step)))
            lengths.append(round(1000 * (step if place < len(word) else _GAP)))
    return {"audio": base64.b64encode(said.sound).decode("ascii"), "isFinal": None,
            "alignment": {"chars": characters, "charStartTimesMs": starts, "charDurationsMs": lengths}}


def _hum(seconds: float) -> List[int]:
    """A tone that swells and fades."""
    count = round(seconds * RATE)
    return [round(6000 * math.sin(math.pi * k / count) * math.sin(2 * math.pi * 140 * k / RATE)) for k in range(count)]


async def serve(port: int = PORT) -> None:
    """Answers until it is cancelled."""
    import websockets

    async def answer(socket: Any) -> None:
        text = await socket.recv()
        for said in say(text):
            await socket.send(json.dumps(message_of(said)))
            await asyncio.sleep(len(said.sound) / (4 * RATE))  # twice as fast as it is heard
        await socket.send(json.dumps({"audio": None, "isFinal": True, "alignment": None}))

    async with websockets.serve(answer, "127.0.0.1", port):
        await asyncio.get_running_loop().create_future()


if __name__ == "__main__":
    asyncio.run(serve(*map(int, sys.argv[1:2])))
