#!/usr/bin/env python3
"""A server whose toys speak with moving lips: it sends sound, and beside it a packet of lips for every 200 ms.

    python3 server.py --rig face.toml                    # at port 8765, until Ctrl-C
    python3 server.py --rig face.toml --ahead 2          # sends up to two seconds before they are heard
    python3 server.py --rig face.toml --repeat 10        # each packet has the frames of the one before once more
    python3 server.py --rig face.toml --with-sound       # hears the voice, too, for lips nearer to people's

Before it prints its port it has checked all that it was given and spoken a word; what is wrong is a line on standard
error, and status 1. A toy that comes when there are enough of them, or that is silent for long, is hung up on.

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
import os
import struct
import subprocess
import sys
import tempfile
import wave
from functools import partial
from pathlib import Path
from typing import Callable, List, NamedTuple, Set, Tuple

import labial
from labial.errors import LabialError, apt, missing
from labial.files.grammar import whole
from labial.program import Parser, complain, number, os_error, run

#: Milliseconds of sound in a message: three frames.
BLOCK = 60
#: Most characters of a line from a toy.
LONGEST = 2000
#: Most utterances of a toy that wait.
WAITING = 8
#: Seconds that flite may take for one of them.
PATIENCE = 60


class Spoken(NamedTuple):
    """An utterance of the voice."""

    sound: bytes  #: 16-bit samples of one channel, low byte first
    rate: int  #: samples per second
    timings: List[Tuple[str, float]]  #: phonemes with their milliseconds

    def frames(self, with_sound: bool) -> List[Tuple[int, ...]]:
        """The lips: those of the phonemes, `with_sound` with a share of what is heard in the sound."""
        said = labial.render(self.timings, exact=True)
        if not with_sound:
            return said
        with labial.Hearing(self.rate, exact=True) as hearing:
            hearing.measure(self.sound)
            return labial.with_sound(said, [frame.faps for frame in hearing.frames([self.sound])][: len(said)])


def flite(*arguments: object) -> str:
    """What flite prints. Raises LabialError if it cannot be run, fails, or takes too long."""
    try:
        return subprocess.run(["flite", *map(str, arguments)], check=True, capture_output=True, encoding="utf-8",
                              timeout=PATIENCE).stdout
    except FileNotFoundError:
        raise missing("the voice", "flite", apt("flite")) from None
    except (OSError, subprocess.SubprocessError) as error:
        raise LabialError(f"flite failed: {error}") from None


def speak(text: str, voice: str) -> Spoken:
    """A text as flite speaks it. Raises LabialError if it cannot."""
    with tempfile.TemporaryDirectory() as folder:
        path, words = Path(folder) / "spoken.wav", Path(folder) / "spoken.txt"
        words.write_text(text, encoding="utf-8")
        told = flite("-voice", voice, "-f", words, "-psdur", "-o", path)
        try:
            with wave.open(str(path)) as sound:
                timings = labial.read_timings(io.StringIO(told), source="flite")
                return Spoken(sound.readframes(sound.getnframes()), sound.getframerate(), timings)
        except (OSError, EOFError, wave.Error) as error:
            raise LabialError(f"flite could not synthesise {text!r}: {error}") from None


class Service:
    """What all connections share.

    Raises LabialError if the face cannot be packed, or if there is no such voice.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        self.ahead, self.idle, self.connections = options.ahead, options.idle, options.connections
        self.with_sound = options.with_sound
        self._voice, self._rig, self._repeat = options.voice, options.rig, options.repeat
        self.lips()
        known = flite("-lv").partition(":")[2].split()
        if self._voice not in known and not Path(self._voice).is_file():  # flite would take its first one
            raise LabialError(f"flite has no voice {self._voice!r}: it has {', '.join(known)}")
        self.rate = speak("a", self._voice).rate
        self.toys = 0
        self._speaking = asyncio.Semaphore(os.cpu_count() or 1)  # of flite

    def lips(self) -> labial.Beside:
        """Those of a connection."""
        return labial.Beside(self._rig, repeat=self._repeat)

    async def speak(self, text: str) -> Spoken:
        """A text, while connections go on."""
        async with self._speaking:
            return await asyncio.to_thread(speak, text, self._voice)


class Toy:
    """One connection, which begins with the rate and the face at rest."""

    def __init__(self, writer: asyncio.StreamWriter, service: Service) -> None:
        self._writer, self._service, self._lips = writer, service, service.lips()
        self._turn = asyncio.Lock()  # of an utterance
        self._sent = 0  # samples since the beginning, at any time
        self._heard_by = 0.0  # when the toy has played them, seconds of the loop's clock
        self.send(b"R", struct.pack("<I", service.rate))
        self.send(b"L", self._lips.hello())

    def send(self, kind: bytes, data: bytes = b"") -> None:
        """A message."""
        self._writer.write(kind + struct.pack("<H", len(data)) + data)

    async def say(self, text: str) -> None:
        """Sends an utterance when the ones before it have been sent."""
        async with self._turn:
            try:
                await self._send_utterance(await self._service.speak(text))
            except LabialError as error:
                complain("server", error)
            except ConnectionError:
                return  # its end is seen where lines are read
            self.send(b"E")

    async def _send_utterance(self, spoken: Spoken) -> None:
        """Sends sound in blocks, each after the packets of lips that begin before its end."""
        rate = self._service.rate
        packets = self._lips.packets(spoken.frames(self._service.with_sound), sample=self._sent, sample_rate=rate)
        block = 2 * rate * BLOCK // 1000
        for start in range(0, len(spoken.sound), block):
            sound = spoken.sound[start : start + block].ljust(block, b"\0")  # whole frames, as of an Opus packet
            await self._in_time()
            end = self._sent + block // 2
            while packets and packets[0].frame * rate < end * 50:
                self.send(b"L", packets.pop(0).data)
            self.send(b"A", sound)
            self._sent = end
            await self.drain()
        for packet in packets:
            self.send(b"L", packet.data)

    def cancel(self) -> None:
        """Tells the toy to drop what it has not played."""
        self.send(b"L", self._lips.cancel(self._sent, self._service.rate))
        self._heard_by = 0.0

    async def _in_time(self) -> None:
        """Waits until the toy has less than `ahead` seconds of sound."""
        now = asyncio.get_running_loop().time()
        self._heard_by = max(self._heard_by, now) + BLOCK / 1000
        await asyncio.sleep(max(self._heard_by - now - self._service.ahead, 0.0))

    async def drain(self) -> None:
        """Waits until the toy takes more; if it does not for long, the connection is lost."""
        patience = asyncio.get_running_loop().call_later(self._service.idle, self._writer.transport.abort)
        try:
            await self._writer.drain()
        finally:
            patience.cancel()


async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, service: Service) -> None:
    """Serves a toy until it goes, or says nothing for long while nothing is spoken to it."""
    speaking: Set[asyncio.Task[None]] = set()
    service.toys += 1
    try:
        if service.toys > service.connections:
            raise LabialError(f"there are {service.connections} toys already")
        toy = Toy(writer, service)
        while line := await next_line(reader, service.idle, lambda: bool(speaking)):
            text = line.decode("utf-8", "replace").strip()
            if text == "stop":
                for task in list(speaking):
                    task.cancel()
                toy.cancel()
            elif text.startswith("say ") and len(speaking) < WAITING:
                task = asyncio.create_task(toy.say(text[4:]))
                speaking.add(task)
                task.add_done_callback(speaking.discard)
            elif text.startswith("say "):
                toy.send(b"E")  # it is not spoken at all
            await toy.drain()
    except (LabialError, ConnectionError) as error:
        complain("server", error)
    except ValueError:
        complain("server", f"a toy sends more than {LONGEST} bytes in a line")
    finally:
        service.toys -= 1
        for task in speaking:
            task.cancel()
        writer.close()


async def next_line(reader: asyncio.StreamReader, idle: float, busy: Callable[[], bool]) -> bytes:
    """A toy's next line, empty at its end. Raises LabialError after `idle` seconds without one, but while `busy`."""
    waiting = asyncio.ensure_future(reader.readline())
    try:
        while not (await asyncio.wait([waiting], timeout=idle))[0]:
            if not busy():
                raise LabialError(f"a toy has said nothing for {idle:g} s")
        return await waiting
    finally:
        waiting.cancel()


async def main() -> int:
    """The command line; returns its exit status when it cannot serve."""
    parser = Parser(prog="server", description="A server of sound and lips.")
    parser.add_argument("--rig", default=str(Path(__file__).with_name("face.toml")), help="the face's description")
    parser.add_argument("--voice", default="slt", help="of flite")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=partial(whole, 0, 65535), default=8765, help="0 for any that is free")
    parser.add_argument("--ahead", type=number(0, 600), default=1.0, help="seconds that are sent before they are heard")
    parser.add_argument("--repeat", type=partial(whole, 0, 254), default=0, help="frames that each packet repeats")
    parser.add_argument("--with-sound", action="store_true", help="hear the voice, too, for lips nearer to people's")
    parser.add_argument("--connections", type=partial(whole, 1, 10000), default=64, help="most toys at a time")
    parser.add_argument("--idle", type=number(0.1, 86400), default=600.0, help="seconds without a word from a toy")
    options = parser.parse_args()
    service = Service(options)
    try:
        server = await asyncio.start_server(lambda reader, writer: serve(reader, writer, service), options.host,
                                            options.port, limit=LONGEST)
    except OSError as error:
        raise LabialError(f"port {options.port} of {options.host}: {os_error(error)}") from None
    print(f"port {server.sockets[0].getsockname()[1]}", flush=True)
    async with server:
        await server.serve_forever()
    return 0


if __name__ == "__main__":
    sys.exit(run("server", lambda: asyncio.run(main())))
