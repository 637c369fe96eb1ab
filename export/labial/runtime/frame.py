"""A frame, and what the stream tells of its look-ahead."""

from __future__ import annotations

from typing import NamedTuple, Tuple, Union

from labial.runtime.rig import Rig, Values


class Frame(NamedTuple):
    """The mouth at one moment."""

    number: int  #: counted from 0 since the stream was made; it is due number / fps seconds after the first
    faps: Tuple[int, ...]  #: 13 values, FAP units, in the order of ``labial.faps.FAP_NUMBERS``

    def rig(self, face: Union[Rig, str]) -> Values:
        """What moves `face`: a value for each output, by name, in the rig's own unit: weights are 0 .. 1.

        `face` is a :class:`labial.Rig`. Outputs with a limit of speed go on from where the frame before left them, so
        this is called once per frame, in order. A built-in rig may also be given by its name, such as "arkit".
        """
        return (Rig.builtin(face) if isinstance(face, str) else face).apply(self.faps)


class Latency(NamedTuple):
    """What a stream holds between what was pushed and what was delivered (``labial_latency_t``)."""

    frames: int  #: pushed and not yet delivered
    milliseconds: int  #: the same as time
    phonemes: int  #: pushed and not yet taken up to their last frame
    delay: int  #: frames between one that is taken up and the one that is delivered at the same time
