"""What a synthesiser makes of a text: sound, and the phonemes in it."""

from __future__ import annotations

from typing import List, NamedTuple, Tuple


class Utterance(NamedTuple):
    """Something said."""

    sound: bytes  #: 16-bit samples of one channel, little-endian
    rate: int  #: samples per second
    timings: List[Tuple[str, float]]  #: phonemes and their milliseconds, from the sound's beginning to its end
    labels: str  #: the set that the phonemes are of, as labial.render() takes it

    @property
    def seconds(self) -> float:
        """How long the sound is."""
        return len(self.sound) / 2 / self.rate
