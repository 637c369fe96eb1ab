#!/usr/bin/env python3
"""A server whose toys speak with moving lips: it sends sound, and beside it a packet of lips for every 200 ms.

    python3 server.py --rig face.toml                    # at port 8765, until Ctrl-C
    python3 server.py --rig face.toml --ahead 2          # sends up to two seconds before they are heard
    python3 server.py --rig face.toml --repeat 10        # each packet has the frames of the one before once more

The voice is flite, in the place of one of your own that tells when it speaks its phonemes. What stands here for a
WebSocket is a plain connection: a toy sends lines, "say TEXT" and "stop"; the server sends messages of a byte for their
kind, two bytes for the length of the rest, low byte first, and the rest:

    R  samples per second, 4 bytes, low byte first: the first message
    A  sound: samples of 16 bits, low byte first, of one channel
    L  a packet of lips (docs/beside.md)
    E  the end of an utterance
"""

from __future__ import annotations

import argparse
import asyncio
import io
import struct
import subprocess
import sys
import tempfile
import wave
from pathlib import Path
from typing import List, NamedTuple, Tuple

import labial
from labial.errors import LabialError

#: Milliseconds of sound in a message: three frames.
BLOCK = 60
#: Most characters of a line from a toy.
LONGEST = 2000
#: Most utterances of a toy that wait.
WAITING = 8


class Spoken(NamedTuple):
    """An utterance of the voice."""

    sound: bytes  #: 16-bit samples of one channel, low byte first
    rate: int  #: samples per second
    timings: List[Tuple[str, float]]  #: phonemes with their milliseconds


def speak(text: str, voice: str) -> Spoken:
    """A text as flite speaks it. Raises LabialError if it cannot."""
    with tempfile.TemporaryDirectory() as folder:
        path, words = Path(folder) / "spoken.wav", Path(folder) / "spoken.txt"
        words.write_text(text, encoding="utf-8")
        try:
            done = subprocess.run(["flite", "-voice", voice, "-f", words, "-psdur", "-o", path], check=True,
                                  capture_output=True, encoding="utf-8")
            with wave.open(str(path)) as sound:
                timings = labial.read_timings(io.StringIO(done.stdout), source="flite")
                return Spoken(sound.readframes(sound.getnframes()), sound.getframerate(), timings)
        except (OSError, subprocess.CalledProcessError, wave.Error) as error:
            raise LabialError(f"flite could not synthesise {text!r}: {error}") from None


class Toy:
    """One connection."""

    def __init__(self, writer: asyncio.StreamWriter, options: argparse.Namespace) -> None:
        self._writer, self._voice, self._ahead = writer, options.voice, options.ahead
        self._rate = speak("a", self._voice).rate
        self._lips = labial.Beside(options.rig, repeat=options.repeat)
        self._turn = asyncio.Lock()  # of an utterance
        self._sent = 0  # samples since the beginning, at any time
        self._heard_by = 0.0  # when the toy has played them, seconds of the loop's clock

    def _send(self, kind: bytes, data: bytes = b"") -> None:
        self._writer.write(kind + struct.pack("<H", len(data)) + data)

    def hello(self) -> None:
        """The rate and the face at rest."""
        self._send(b"R", struct.pack("<I", self._rate))
        self._send(b"L", self._lips.hello())

    async def say(self, text: str) -> None:
        """Sends an utterance when the ones before it have been sent."""
        async with self._turn:
            try:
                spoken = await asyncio.to_thread(speak, text, self._voice)
                await self._send_utterance(spoken)
            except (LabialError, ConnectionError) as error:
                print(f"server: {error}", file=sys.stderr)
            self._send(b"E")

    async def _send_utterance(self, spoken: Spoken) -> None:
        """Sends sound in blocks, each after the packets of lips that begin before its end."""
        packets = self._lips.packets(labial.render(spoken.timings), sample=self._sent, rate=self._rate)
        block = 2 * self._rate * BLOCK // 1000
        for start in range(0, len(spoken.sound), block):
            sound = spoken.sound[start : start + block].ljust(block, b"\0")  # whole frames, as of an Opus packet
            await self._in_time()
            end = self._sent + block // 2
            while packets and packets[0].frame * self._rate < end * 50:
                self._send(b"L", packets.pop(0).data)
            self._send(b"A", sound)
            self._sent = end
            await self._writer.drain()
        for packet in packets:
            self._send(b"L", packet.data)

    def cancel(self) -> None:
        """Tells the toy to drop what it has not played."""
        self._send(b"L", self._lips.cancel(self._sent, self._rate))
        self._heard_by = 0.0

    async def _in_time(self) -> None:
        """Waits until the toy has less than `ahead` seconds of sound."""
        now = asyncio.get_running_loop().time()
        self._heard_by = max(self._heard_by, now) + BLOCK / 1000
        await asyncio.sleep(max(self._heard_by - now - self._ahead, 0.0))


async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, options: argparse.Namespace) -> None:
    """Speaks to one toy until it hangs up."""
    speaking: List[asyncio.Task[None]] = []
    try:
        toy = Toy(writer, options)
        toy.hello()
        while line := (await reader.readline()).decode("utf-8", "replace").strip():
            speaking = [task for task in speaking if not task.done()]
            if line == "stop":
                for task in speaking:
                    task.cancel()
                toy.cancel()
            elif line.startswith("say ") and len(speaking) < WAITING:
                speaking.append(asyncio.create_task(toy.say(line[4:])))
    except (LabialError, ConnectionError, ValueError) as error:  # a ValueError for a line that is too long
        print(f"server: {error}", file=sys.stderr)
    finally:
        for task in speaking:
            task.cancel()
        writer.close()


async def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="A server of sound and lips.")
    parser.add_argument("--rig", default=str(Path(__file__).with_name("face.toml")), help="the face's description")
    parser.add_argument("--voice", default="slt", help="of flite")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8765, help="0 for any that is free")
    parser.add_argument("--ahead", type=float, default=1.0, help="seconds that are sent before they are heard")
    parser.add_argument("--repeat", type=int, default=0, help="frames that each packet repeats")
    options = parser.parse_args()
    server = await asyncio.start_server(lambda reader, writer: serve(reader, writer, options), options.host,
                                        options.port, limit=LONGEST)
    print(f"port {server.sockets[0].getsockname()[1]}", flush=True)
    async with server:
        await server.serve_forever()


if __name__ == "__main__":
    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        pass
