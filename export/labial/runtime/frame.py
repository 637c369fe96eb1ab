"""A frame, and the latency of a stream."""

from __future__ import annotations

from typing import NamedTuple, Tuple, Union

from labial.runtime.rig import Rig, Values


class _Moment(NamedTuple):
    number: int
    faps: Tuple[int, ...]


class Frame(_Moment):
    """The mouth at one moment: a pair, `number` and `faps`.

    Attributes:
        number: counted from 0 since the stream was made; it is due number / fps seconds after the first.
        faps: 13 values, FAP units, in the order of ``labial.files.faps.FAP_NUMBERS``.
        visemes: how much of each sound the frame shows, 15 shares of together 128 in the order of
        ``labial.tables.visemes.VISEMES``; empty where it is not known.
    """

    visemes: Tuple[int, ...]

    def __new__(cls, number: int, faps: Tuple[int, ...], visemes: Tuple[int, ...] = ()) -> Frame:
        """A frame."""
        frame = super().__new__(cls, number, faps)
        frame.visemes = visemes
        return frame

    def rig(self, face: Union[Rig, str]) -> Values:
        """The values of `face`: one for each output, by name, in the rig's unit; weights are 0 .. 1.

        `face` is a :class:`labial.Rig`. Outputs with a limit of speed continue from the previous frame, so call this
        once per frame, in order. `face` may also be the name of a built-in rig, such as "arkit".
        """
        return (Rig.builtin(face) if isinstance(face, str) else face).apply(self.faps, visemes=self.visemes)


class Latency(NamedTuple):
    """What has been pushed to a stream and not yet delivered (``labial_latency_t``)."""

    frames: int  #: pushed and not yet delivered
    milliseconds: int  #: the same as time
    phonemes: int  #: pushed, with frames that are not yet accepted
    delay: int  #: frames from accepting a frame to delivering it
