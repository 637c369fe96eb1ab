"""Laughs of a given length: laughter phonemes and their durations.

lib/laugh.c computes the same numbers; this module writes its tables (:func:`table_header`). The grammar and the
statistics are those of the synthetic corpus (labial.corpus.laughter): trains of pulses 210 ms apart, pauses with an
inhalation between them. All arithmetic is in integers, so that both give the same laugh.

Loudness is the corpus's, too: the intensity, which decreases from pulse to pulse and from train to train, selects soft,
plain or loud grades of the phonemes that have grades. The rhythm does not depend on it.

At intensity 0.5 the rhythm is the corpus's. Towards 1 trains become longer, pauses shorter, vowels longer and more
often open, and cackles more frequent; towards 0 it is the other way round and more pulses are hummed with closed lips.
"""

from __future__ import annotations

import math
import textwrap
from statistics import NormalDist
from typing import Iterator, List, Sequence, Tuple

from labial.corpus import laughter
from labial.corpus.laughter import PERIOD_LONGEST, PERIOD_SHORTEST, PULSES, SHORTEST, TRAIN_LONGEST, VOWELS
from labial.corpus.phonesets import LAUGHTER, LAUGHTER_GRADES
from labial.files.outputs import writing

#: Intensity of the heartiest laugh.
FULL = 256
#: How much more frequent (of 256, per full range) a kind of pulse or a vowel is at the highest intensity than at the
#: middle one; a design choice.
_PULSE_TILT = {"h": -40, "bare": 128, "cackle": 205, "nasal": -230, "stop": 0}
_VOWEL_TILT = {"a": 128, "e": -50, "o": 40, "ic": -128}


def _of_256(share: float) -> int:
    return round(256 * share)


def _shares(shares: Sequence[float]) -> List[int]:
    """`shares` of 256; the first one includes the remainder of rounding."""
    rounded = [_of_256(share) for share in shares]
    rounded[0] += 256 - sum(rounded)
    return rounded


#: Of 256: how often a kind or a vowel changes within a train, what a laugh begins with, what a pause has.
_CHANGED = _of_256(laughter.CHANGED)
_ONSETS = {label: _of_256(share) for label, share in laughter.ONSETS.items()}
_PAUSE = {name: _of_256(getattr(laughter, name))
          for name in ("INHALED", "CLICKED", "BY_NOSE", "GRUNTED", "SILENT", "RESTED")}

_QUANTILES = [NormalDist().inv_cdf((k + 0.5) / 32) for k in range(32)]
#: Standard normal deviates in 1/32, and lognormal factors of durations (in 1/128) and of train lengths (in 1/32).
DEVIATES = [round(32 * z) for z in _QUANTILES]
STRETCH = [round(128 * math.exp(laughter.SPREAD * z)) for z in _QUANTILES]
LENGTHS = [round(32 * math.exp(laughter.TRAIN_SPREAD * z)) for z in _QUANTILES]
PERIOD, PERIOD_SPREAD = round(laughter.PERIOD), round(laughter.PERIOD_SPREAD)
TRAIN_MEDIAN = round(laughter.TRAIN_MEDIAN)
MEDIANS = [laughter.MEDIANS.get(label, 0) for label in LAUGHTER.phonemes if label in laughter.GESTURES]
#: Of 256: how loud the next pulse, the next train and air drawn in are; below the softest train all begins anew.
PULSE_DECAY, TRAIN_DECAY = _of_256(laughter.PULSE_DECAY), _of_256(laughter.TRAIN_DECAY)
_INHALED_LOUDNESS, _SOFTEST = _of_256(laughter.INHALED_LOUDNESS), _of_256(0.6)
#: Up to which loudness of 256 all is soft, and how many 1/256 grades (from soft, 0, to loud, 512) 1/256 more make.
SOFT, GRADES = _of_256(laughter.SOFT), round(512 / (laughter.LOUD - laughter.SOFT))
#: What the dither between two grades grows by from phoneme to phoneme, of 256: the golden ratio, whose multiples,
#: modulo 1, are spread as evenly as can be, so that each stretch of a laugh has its share of both grades.
_DITHER_STEP = 158
PULSE_SHARES, VOWEL_SHARES = _shares(laughter.PULSE_SHARES), _shares(laughter.VOWEL_SHARES)


class _Laugh:
    """The state of one laugh."""

    def __init__(self, milliseconds: int, intensity: int, seed: int) -> None:
        self.left = milliseconds
        self.tail = min(milliseconds // 6, 300)  # the mouth comes to rest
        self.intensity = min(intensity, FULL)
        self.random = (seed * 2654435761 + 2654435769) % 2**32 or 1
        self.pulses = 0
        self.kind = self.vowel = 0
        self.train_loudness = self.loudness = 255  # of the train and of its next pulse, at full intensity
        self.dither = self.random >> 24
        self.queue: List[Tuple[str, int]] = []

    def draw(self, count: int) -> int:
        """0 .. count - 1, `count` at most 65536."""
        self.random ^= self.random << 13 & 0xFFFFFFFF
        self.random ^= self.random >> 17
        self.random ^= self.random << 5 & 0xFFFFFFFF
        return (self.random >> 16) * count >> 16

    def chance(self, share: int) -> bool:
        return self.draw(256) < share

    def choose(self, shares: Sequence[int], tilts: Sequence[int]) -> int:
        weights = [share * (32768 + tilt * (self.intensity - 128)) >> 8 for share, tilt in zip(shares, tilts)]
        place = self.draw(sum(weights))
        for index, weight in enumerate(weights[:-1]):
            if place < weight:
                return index
            place -= weight
        return len(weights) - 1

    def duration(self, label: str) -> int:
        if label == "silence":
            value = (160 + self.draw(261)) * (384 - self.intensity) >> 8
        else:
            value = MEDIANS[LAUGHTER.phonemes.index(label)] * STRETCH[self.draw(32)] >> 7
            if label in VOWELS or label in ("cackle", "nasal"):
                value = value * (218 + (77 * self.intensity >> 8)) >> 8
        return max(value, SHORTEST)

    def add(self, label: str, milliseconds: int) -> None:
        self.queue.append((label, milliseconds))

    def add_graded(self, label: str, milliseconds: int, loudness: int) -> None:
        """Adds `label` in the grade for `loudness` of 256 and the intensity; a dither alternates between two grades."""
        if label in LAUGHTER_GRADES:
            soft, loud = LAUGHTER_GRADES[label]
            self.dither = (self.dither + _DITHER_STEP) % 256
            louder = max((self.intensity * (loudness + 1) >> 8) - SOFT, 0)
            wanted = min(louder * GRADES >> 8, 512)
            label = (soft, label, loud)[wanted + self.dither >> 8]
        self.add(label, milliseconds)

    def choose_kind(self) -> None:
        self.kind = self.choose(PULSE_SHARES, list(_PULSE_TILT.values()))

    def choose_vowel(self) -> None:
        self.vowel = self.choose(VOWEL_SHARES, list(_VOWEL_TILT.values()))

    def begin_train(self) -> None:
        median = TRAIN_MEDIAN * (256 + self.intensity)  # 2/3 to 4/3 of the corpus's median, in 1/384
        self.pulses = min(max((median * LENGTHS[self.draw(32)] + 6144) // 12288, 1), TRAIN_LONGEST)
        self.loudness = self.train_loudness
        self.choose_kind()
        self.choose_vowel()

    def pulse(self, room: int) -> None:
        if self.chance(_CHANGED):
            self.choose_kind()
        if self.chance(_CHANGED):
            self.choose_vowel()
        period = PERIOD + (PERIOD_SPREAD * DEVIATES[self.draw(32)] >> 5)
        period = min(max(period, PERIOD_SHORTEST), PERIOD_LONGEST, room)
        kind = PULSES[self.kind]
        note = kind if kind in ("cackle", "nasal") else VOWELS[self.vowel]
        sound = min(self.duration(note), period - 40)
        rest = period - sound
        if kind == "h":
            self.add_graded("fricative", rest, self.loudness)
            self.add_graded(note, sound, self.loudness)
        elif kind == "stop":
            stop = min(self.duration("plosive"), rest - 20)
            self.add("plosive", stop)
            self.add_graded(note, sound, self.loudness)
            self.add("silence", rest - stop)
        else:
            self.add_graded(note, sound, self.loudness)
            self.add("silence", rest)
        self.loudness = self.loudness * PULSE_DECAY >> 8

    def pause(self, room: int) -> None:
        if self.chance(_PAUSE["INHALED"]):
            self.add("silence", self.duration("silence"))
            if self.chance(_PAUSE["CLICKED"]):
                self.add("click", self.duration("click"))
            inhaled = "ne" if self.chance(_PAUSE["BY_NOSE"]) else "fricative"
            self.add_graded(inhaled, self.duration(inhaled), self.train_loudness * _INHALED_LOUDNESS >> 8)
        for name, label in (("GRUNTED", "grunt"), ("SILENT", "silence")):
            if self.chance(_PAUSE[name]):
                self.add(label, self.duration(label))
        if self.chance(_PAUSE["RESTED"]):
            self.add("silence", 450 + self.draw(451))
        if sum(milliseconds for _, milliseconds in self.queue) + PERIOD_SHORTEST > room:
            breath = min(self.duration("ne"), room)
            self.queue = [("ne", breath)]
            if breath + PERIOD > room:  # no pulse fits after it: the laugh ends with air drawn in
                self.tail = self.left - breath
                return
        self.train_loudness = self.train_loudness * TRAIN_DECAY >> 8
        if self.train_loudness < _SOFTEST:  # a laugh that is longer than a bout has several bouts
            self.train_loudness = 255
        self.begin_train()

    def onset(self, room: int) -> None:
        self.begin_train()
        place = self.draw(256)
        for label, share in _ONSETS.items():
            if place < share:
                milliseconds = self.duration(label)
                if milliseconds + 3 * PERIOD_SHORTEST <= room:
                    self.add(label, milliseconds)
                return
            place -= share

    def compose(self) -> None:
        """Fills the queue with what comes next."""
        room = self.left - self.tail
        if room < SHORTEST:
            self.add("silence", self.left)
        elif room < PERIOD_SHORTEST:
            self.add_graded("fricative", room, self.loudness)
        elif self.pulses == 0:
            self.pause(room)
        else:
            self.pulse(room)
            self.pulses -= 1


def pieces(milliseconds: int, intensity: int, seed: int) -> Iterator[Tuple[str, int]]:
    """Laughter phonemes and their milliseconds, which add up to `milliseconds`; `intensity` is 0 .. `FULL`."""
    laugh = _Laugh(milliseconds, intensity, seed)
    laugh.onset(laugh.left - laugh.tail)
    while laugh.left > 0:
        while not laugh.queue:
            laugh.compose()
        label, length = laugh.queue.pop(0)
        length = laugh.left if laugh.left < length + SHORTEST else length
        laugh.left -= length
        yield label, length


def table_header() -> str:
    """lib/laugh_table.h: the statistics as C."""

    def table(kind: str, name: str, values: Sequence[int], comment: str) -> str:
        body = textwrap.fill(", ".join(map(str, values)), width=118, initial_indent="    ", subsequent_indent="    ")
        return f"/* {comment} */\nstatic const {kind} {name}[{len(values)}] = {{\n{body}\n}};\n"

    def defines(suffix: str, **values: int) -> str:
        return "".join(f"#define {name} {value}{suffix}\n" for name, value in values.items())

    number = LAUGHTER.phonemes.index
    parts = [
        """/*
 * laugh_table.h - the statistics of laughter behind laugh.c. Written by export/labial/reference/laughs.py from those of
 * the synthetic corpus; do not edit.
 */
#ifndef LABIAL_LAUGH_TABLE_H
#define LABIAL_LAUGH_TABLE_H

#include <stdint.h>

""",
        defines("", PERIOD=PERIOD, PERIOD_SPREAD=PERIOD_SPREAD, PERIOD_SHORTEST=PERIOD_SHORTEST,
                PERIOD_LONGEST=PERIOD_LONGEST, TRAIN_MEDIAN=TRAIN_MEDIAN, TRAIN_LONGEST=TRAIN_LONGEST,
                SHORTEST=SHORTEST),
        "\n/* Of 256: how loud the next pulse, the next train and air drawn in are; the softest train. */\n",
        defines("u", PULSE_DECAY=PULSE_DECAY, TRAIN_DECAY=TRAIN_DECAY, INHALED_LOUDNESS=_INHALED_LOUDNESS,
                SOFTEST=_SOFTEST),
        "\n/* Up to which loudness of 256 all is soft; 1/256 grades for each 1/256 more; how the dither moves on. */\n",
        defines("u", SOFT=SOFT, GRADES=GRADES, DITHER_STEP=_DITHER_STEP),
        "\n/* Of 256: what a pause between trains has. */\n", defines("", **_PAUSE), "\n",
        table("uint8_t", "medians", MEDIANS, "Median duration of each phoneme, milliseconds; silence has its own."),
        table("int8_t", "deviates", DEVIATES, "Equally likely standard normal deviates, in 1/32."),
        table("uint8_t", "stretches", STRETCH, "Equally likely factors of a duration, in 1/128."),
        table("uint8_t", "lengths", LENGTHS, "Equally likely factors of a train's length, in 1/32."),
        table("uint8_t", "pulse_shares", PULSE_SHARES,
              "Kinds of pulses (breath first, vowel alone, cackle, nasal, stop first): shares of 256."),
        table("int16_t", "pulse_tilts", list(_PULSE_TILT.values()), "How these grow with intensity, of 256."),
        table("uint8_t", "vowels", [number(v) for v in VOWELS], "Vowels of pulses, their shares and their tilts."),
        table("uint8_t", "vowel_shares", VOWEL_SHARES, "The same."),
        table("int16_t", "vowel_tilts", list(_VOWEL_TILT.values()), "The same."),
        table("uint8_t", "onsets", [number(v) for v in _ONSETS], "What a laugh may start with."),
        table("uint8_t", "onset_shares", list(_ONSETS.values()), "The shares, of 256; mostly it starts with a pulse."),
        table("uint8_t", "soft_grades", [number(LAUGHTER_GRADES[label][0]) if label in LAUGHTER_GRADES else 0
                                         for label in LAUGHTER.phonemes[: len(MEDIANS)]],
              "The soft grade of each phoneme that has one, 0 for the others; the loud grade is the next number."),
        "\n#endif\n",
    ]
    return "".join(parts)


if __name__ == "__main__":
    import sys

    with writing(sys.argv[1], "ascii") as out:
        out.write(table_header())
