"""Lips beside the audio: frames as packets, which a toy plays in step with the sound that it is sent
(``include/labial/beside.h`` has the format, docs/beside.md the whole)."""

from __future__ import annotations

import secrets
import struct
from array import array
from itertools import chain
from typing import Iterable, List, NamedTuple, Optional, Union

from labial.core.guard import whole
from labial.errors import LabialError, PathLike
from labial.files.faps import CHANNELS
from labial.runtime.rig import Faps, Rig, one_frame, shares_of

#: LABIAL_BESIDE_FORMAT and LABIAL_BESIDE_FPS of include/labial/beside.h.
FORMAT, RATE = 2, 50
#: Most outputs, and frames of a packet.
MOST = 255
#: How many sessions there are.
SESSIONS = 65536
#: Largest difference of an output's limits for which the sums of a toy or player stay below 2^31.
SPAN_MAX = 8_000_000


class Packet(NamedTuple):
    """A message to the toy."""

    frame: int  #: its first frame that no earlier packet has: it is due before the sound from sample frame * rate / 50
    data: bytes


class Beside:
    """The lips of one connection, as packets that go beside its sound.

        lips = labial.Beside("face.toml")
        await socket.send(lips.hello())
        for packet in lips.packets(labial.render(timings), sample=sent, sample_rate=24000):
            await socket.send(packet.data)  # before the sound of the same time

    Samples are counted from the beginning of the connection, with everything that was sent, played or not. A frame's
    values are those of the rig, as bytes from 0 for an output's minimum to 255 for its maximum.

    Args:
        rig: a :class:`labial.Rig` of this connection, the path of a description, or the name of a built-in rig; of 1 to
        255 outputs. frames: of a packet, 1 to 255. repeat: how many frames of the packets before are in each packet
        once more, for transports that lose messages; with `frames` together at most 255. session: 0 to 65535, by which
        the toy tells these packets from those of the session before; drawn at random without it.
    """

    def __init__(self, rig: Union[Rig, PathLike], *, frames: int = 10, repeat: int = 0,
                 session: Optional[int] = None) -> None:
        self._rig = rig if isinstance(rig, Rig) else Rig(rig)
        self._frames, self._repeat = whole(frames, "a number of frames"), whole(repeat, "a number of repeated frames")
        if self._frames < 1 or self._repeat < 0 or self._frames + self._repeat > MOST:
            raise LabialError(f"a packet cannot have {frames} frames and {repeat} repeated ones: 1 .. {MOST} in all")
        if not 1 <= len(self._rig.outputs) <= MOST:
            raise LabialError(f"{self._rig.name} has {len(self._rig.outputs)} outputs: packets have 1 .. {MOST}")
        for name, (low, high) in zip(self._rig.outputs, self._rig.limits):
            if high - low > SPAN_MAX:
                raise LabialError(f"{self._rig.name}: the limits of {name} are more than {SPAN_MAX} apart, too far for "
                                  "bytes")
        self._session = secrets.randbelow(SESSIONS) if session is None else whole(session, "a session")
        if not 0 <= self._session < SESSIONS:
            raise LabialError(f"a session is 0 to {SESSIONS - 1}, not {session}")
        self._rest = self._bytes(self._rig.resting)
        self._rows: List[bytes] = []  # those that wait, behind those that are repeated
        self._sent = 0  # of these rows, how many are repeated
        self._next = 0  # number of the next frame

    @property
    def rig(self) -> Rig:
        """The rig of this connection."""
        return self._rig

    @property
    def session(self) -> int:
        """The number of this session."""
        return self._session

    @property
    def frame(self) -> int:
        """The number of the next frame."""
        return self._next

    def hello(self) -> bytes:
        """The first message: the face at rest, and no frame."""
        return self._packet(0, self._next, [])

    def at(self, sample: int, sample_rate: int) -> None:
        """The next frame is the one that is nearest to sample number `sample` of `sample_rate` a second. Raises
        LabialError while frames wait, and for numbers out of range."""
        if len(self._rows) > self._sent:
            raise LabialError("frames wait: flush them first")
        number = _frame_at(sample, sample_rate)
        if number != self._next:
            self._rows, self._sent = [], 0
        self._next = number

    def push(self, frames: Iterable[Faps]) -> List[Packet]:
        """Appends frames, 50 a second, and returns the packets that are full: frames of a stream, of hearing or of
        :func:`labial.render`, or 13 FAPs each, which do not move outputs that follow sounds. A servo that has to start
        early, because it is slow, sees as many frames ahead as are pushed at once."""
        faps, shares = array("h"), bytearray()
        for frame in frames:
            faps.extend(one_frame(frame))
            shares += shares_of(frame)
        values = self._rig.play(faps, 65535, shares)
        self._rows += map(self._bytes, zip(*[iter(values)] * len(self._rig.outputs)))
        self._next += len(faps) // CHANNELS
        found = []
        while len(self._rows) - self._sent >= self._frames:
            found.append(self._pack(self._frames))
        return found

    def flush(self) -> List[Packet]:
        """The packet of the frames that wait, if any do."""
        waiting = len(self._rows) - self._sent
        return [self._pack(waiting)] if waiting else []

    def packets(self, frames: Iterable[Faps], *, sample: int, sample_rate: int) -> List[Packet]:
        """An utterance whose sound begins with sample number `sample`: :meth:`at`, :meth:`push` and :meth:`flush`."""
        self.at(sample, sample_rate)
        return [*self.push(frames), *self.flush()]

    def cancel(self, sample: int, sample_rate: int) -> bytes:
        """The message that makes all earlier frames void. `sample` is the number of the next sample that will be sent;
        the toy drops the sound that it has not played, and eases to rest."""
        self._rows, self._sent, self._next = [], 0, _frame_at(sample, sample_rate)
        self._rig.rest()
        return self._packet(1, self._next, [])

    # ---- Bytes

    def _bytes(self, values: Iterable[int]) -> bytes:
        """The values of a frame in bytes: 0 for the minimum, 255 for the maximum, rounded to the nearest."""
        return bytes((2 * 255 * (value - low) + max(high - low, 1)) // (2 * max(high - low, 1))
                     for value, (low, high) in zip(values, self._rig.limits))

    def _pack(self, count: int) -> Packet:
        """A packet of so many rows that wait, and of those that are repeated."""
        first = self._next - (len(self._rows) - self._sent)
        end = self._sent + count
        data = self._packet(0, first - self._sent, self._rows[:end])
        kept = min(self._repeat, end)
        self._rows, self._sent = self._rows[end - kept :], kept
        return Packet(first, data)

    def _packet(self, cancels: int, first: int, rows: List[bytes]) -> bytes:
        head = struct.pack("<4BIH", FORMAT, cancels, len(self._rig.outputs), len(rows), first & 0xFFFFFFFF,
                           self._session)
        return b"".join(chain((head, self._rest), rows))


def _frame_at(sample: int, sample_rate: int) -> int:
    number, per_second = whole(sample, "a sample's number"), whole(sample_rate, "a sample rate")
    if number < 0 or per_second < 1:
        raise LabialError(f"sample {number} at {per_second} a second is no time")
    return (2 * number * RATE + per_second) // (2 * per_second)
