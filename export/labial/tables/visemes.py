"""The sounds that a frame shows: the 15 visemes of Oculus LipSync, which are MPEG-4's 14 and silence
(include/labial/visemes.h, which says what their shares are)."""

from __future__ import annotations

from typing import Dict, Mapping, NamedTuple, Tuple

#: The visemes in the order of a frame's shares, and the ARPABET phonemes of each. /HH/ has none: its neighbours share
#: its time.
VISEMES: Mapping[str, Tuple[str, ...]] = {
    "sil": ("SIL",), "PP": ("P", "B", "M"), "FF": ("F", "V"), "TH": ("TH", "DH"), "DD": ("T", "D"),
    "kk": ("K", "G", "NG"), "CH": ("CH", "JH", "SH", "ZH"), "SS": ("S", "Z"), "nn": ("N", "L"), "RR": ("R", "ER"),
    "aa": ("AA", "AE", "AH", "AW", "AY"), "E": ("EH", "EY"), "ih": ("IH", "IY", "Y"), "oh": ("AO", "OW", "OY"),
    "ou": ("UH", "UW", "W"),
}
#: The viseme of each phoneme; without /HH/.
VISEME_OF: Mapping[str, str] = {phoneme: viseme for viseme, members in VISEMES.items() for phoneme in members}
#: A share of one in the C library.
ONE = 128


class Dominance(NamedTuple):
    """How much a sound counts beside its neighbours: a strength, and how fast it falls off per millisecond before the
    sound begins and after it has ended."""

    strength: int
    onset: int
    release: int


_VOWEL, _TONGUE, _TIGHT = Dominance(640, 10, 10), Dominance(512, 10, 12), Dominance(2048, 51, 51)
#: Lips round early (onsets of 112 ms and less), and closed lips and teeth on the lip part fast (40 ms).
DOMINANCES: Mapping[str, Dominance] = {
    "sil": Dominance(384, 6, 6), "PP": _TIGHT, "FF": _TIGHT, "TH": Dominance(1536, 34, 51), "DD": _TONGUE,
    "kk": _TONGUE, "CH": Dominance(1280, 16, 21), "SS": Dominance(1024, 20, 25), "nn": _TONGUE,
    "RR": Dominance(768, 12, 12), "aa": _VOWEL, "E": _VOWEL, "ih": _VOWEL, "oh": Dominance(896, 9, 11),
    "ou": Dominance(896, 8, 11),
}
#: Milliseconds from which on no sound counts.
AROUND = 120
#: FAP 44, 45 and 46 of each viseme (docs/method.md).
TONGUES: Dict[str, Tuple[int, int, int]] = {
    "sil": (0, 0, 0), "PP": (0, 0, 0), "FF": (0, 0, 0), "TH": (160, 240, 40), "DD": (400, 60, 80),
    "kk": (-120, -100, 420), "CH": (300, 0, 260), "SS": (260, 40, 160), "nn": (400, 60, 60), "RR": (300, -120, 200),
    "aa": (-80, -40, -80), "E": (40, 20, 160), "ih": (60, 40, 320), "oh": (-60, -120, 120), "ou": (-40, -120, 280),
}
