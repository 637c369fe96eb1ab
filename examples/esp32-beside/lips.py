"""Lips for xiaozhi-esp32-server, as core/utils/lips.py: the frames of a sentence travel with its packets of sound, and
go to the device before them (docs/beside.md)."""

from __future__ import annotations

import base64
import json
import logging
from pathlib import Path
from typing import Any, Dict, List, Sequence, Tuple

import labial
from labial.errors import LabialError

#: The face of the devices: a description (docs/servos.md).
FACE = Path(__file__).with_name("face.toml")
#: Of the voice, as labial.word_timings() takes it: "en", or what espeak-ng calls it, such as "cmn".
LANGUAGE = "en"
#: Frames of lips in a packet of sound, 60 ms; and how many packets of sound have their lips sent together.
FRAMES, TOGETHER = 3, 4
#: A rate of which a frame is a whole number of samples: only the number of frames matters here.
RATE = 24000


class Sound(bytes):
    """A packet of sound, and the frames of lips that begin with it."""

    frames: Sequence[Tuple[int, ...]] = ()


class Voice:
    """The sentences of a provider of speech."""

    def __init__(self) -> None:
        self._motion: List[Tuple[int, ...]] = []
        self._packets = 0

    def timed(self, boundaries: List[Dict[str, Any]]) -> None:
        """A sentence begins, whose words have these times, as edge-tts tells them."""
        self._motion, self._packets = [], 0
        try:
            if boundaries:
                self._motion = labial.render(labial.read_timings(boundaries, language=LANGUAGE), exact=True)
        except LabialError as error:
            logging.getLogger(__name__).warning("no lips: %s", error)

    def sound(self, packet: bytes) -> Sound:
        """The next packet of the sentence, with its lips."""
        found = Sound(packet)
        if self._packets % TOGETHER == 0:
            found.frames = self._motion[FRAMES * self._packets :][: FRAMES * TOGETHER]
        self._packets += 1
        return found


async def send_lips(conn: Any, packet: bytes) -> None:
    """Sends what goes before a packet of sound on a connection, and counts the packet. The count never begins anew:
    packets that the device drops have their numbers, too."""
    if not hasattr(conn, "lips"):
        conn.lips, conn.lips_packets = labial.Beside(FACE, frames=FRAMES * TOGETHER), 0
    frames = getattr(packet, "frames", ())
    sample = conn.lips_packets * FRAMES * RATE // 50
    conn.lips_packets += 1
    for message in conn.lips.packets(frames, sample=sample, sample_rate=RATE) if frames else ():
        data = base64.b64encode(message.data).decode("ascii")
        await conn.websocket.send(json.dumps({"type": "lips", "data": data, "session_id": conn.session_id}))
