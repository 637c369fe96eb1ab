"""A voice to try with, in place of a speech service: hums words, and tells when each is heard.

    python3 stand_in.py [PORT]

prints its port and serves the voice as a WebSocket on 127.0.0.1, with messages like those of ElevenLabs: each client's
first message is the text; the answers, three words each, have sound (base64, 16 bits, 24 kHz) and the times of its
characters from their own beginning. They come faster than they are heard. Of Python's packages it needs websockets
alone.
"""

from __future__ import annotations

import asyncio
import base64
import json
import math
import os
import sys
from array import array
from typing import Any, Dict, Iterator, List, NamedTuple, Tuple

RATE = 24000
PORT = 8765
#: Most bytes of a text, clients at a time, and seconds until a client has said what it wants.
LONGEST, CLIENTS, PATIENCE = 4000, 64, 60.0
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


async def serve(port: int = PORT, patience: float = PATIENCE) -> int:
    """Answers until it is cancelled. Raises OSError for a port that cannot be had."""
    import websockets

    clients = 0

    async def answer(socket: Any) -> None:
        nonlocal clients
        clients += 1
        try:
            if clients > CLIENTS:
                await socket.close(1013, "there are enough clients")
                return
            text = await asyncio.wait_for(socket.recv(), patience)
            answers = say(text if isinstance(text, str) else "")
            while said := await asyncio.to_thread(next, answers, None):  # others go on while it hums
                await socket.send(json.dumps(message_of(said)))
                await asyncio.sleep(len(said.sound) / (4 * RATE))  # twice as fast as it is heard
            await socket.send(json.dumps({"audio": None, "isFinal": True, "alignment": None}))
        except (asyncio.TimeoutError, websockets.ConnectionClosed):
            pass  # which closes the connection
        finally:
            clients -= 1

    async with websockets.serve(answer, "127.0.0.1", port, max_size=LONGEST) as server:
        print(f"port {next(iter(server.sockets)).getsockname()[1]}", flush=True)
        await asyncio.get_running_loop().create_future()
    return 0


def main() -> int:
    """The command line."""
    given = sys.argv[1:] or [str(PORT)]
    if len(given) > 1 or not given[0].isdecimal() or int(given[0]) > 65535:
        print("usage: stand_in [PORT]", file=sys.stderr)
        return 2
    try:
        asyncio.run(serve(int(given[0])))
    except ModuleNotFoundError as error:
        print(f"stand_in: this needs the package {error.name}: pip install {error.name}", file=sys.stderr)
    except OSError as error:
        print(f"stand_in: port {given[0]}: {os.strerror(error.errno or 0)}", file=sys.stderr)
    except KeyboardInterrupt:
        return 130
    return 1


if __name__ == "__main__":
    sys.exit(main())
