"""The sizes of the networks that Labial comes with, and what their classes are."""

from __future__ import annotations

from typing import Dict, NamedTuple, Tuple


class Memory(NamedTuple):
    """How far a block's memory reaches: `past` and `ahead` frames of `dilation` frames each, besides the present."""

    past: int
    ahead: int
    dilation: int

    @property
    def taps(self) -> int:
        """Taps of the memory, the oldest first; tap `past` is the present."""
        return self.past + self.ahead + 1


class Plan(NamedTuple):
    """The sizes of a network: its units and the memories of its blocks."""

    units: int
    memories: Tuple[Memory, ...]

    @property
    def ahead(self) -> int:
        """Frames that must follow a frame before it is known."""
        return sum(memory.ahead * memory.dilation for memory in self.memories)


#: The first three know a frame 80 ms after its end, and have smoothed it 20 ms later, 120 ms after its begin; the last
#: one, for sound that is there before it is played, 280 ms after its begin.
PLANS: Dict[str, Plan] = {
    "small": Plan(68, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 2))),
    "large": Plan(76, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1))),
    "host": Plan(192, (Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1), Memory(5, 1, 1))),
    "ahead": Plan(192, (Memory(5, 3, 1), Memory(5, 3, 1), Memory(5, 3, 1), Memory(5, 3, 1))),
}

#: The lip classes, each named by the ARPABET phoneme that stands for it.
CLASSES = ("SIL", "M", "F", "TH", "T", "L", "S", "SH", "K", "HH", "R", "ER", "W", "IY", "IH", "EH", "AE", "AH", "AA",
           "AO", "OW", "UW", "UH", "AY", "AW", "EY")
#: The classes of the phonemes that stand for no class of their own.
MEMBERS = {"P": "M", "B": "M", "V": "F", "DH": "TH", "D": "T", "N": "T", "Z": "S", "ZH": "SH", "CH": "SH", "JH": "SH",
           "G": "K", "NG": "K", "Y": "IY", "OY": "AO"}
#: The class in which lips are closed.
CLOSED = "M"


def class_of(phoneme: str) -> str:
    """The lip class of an ARPABET phoneme without stress."""
    return MEMBERS.get(phoneme, phoneme)
