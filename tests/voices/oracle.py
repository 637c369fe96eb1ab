"""What a voice must show, worked out without :class:`labial.Voice`: slowly, from everything that was ever told.

For each change it makes the whole timeline again, with the readers of files and the conversion of all words at once,
and for each frame all frames before it, by :func:`labial.render`. Nothing is forgotten and nothing is kept.
"""

from __future__ import annotations

import functools
import itertools
import json
import math
import sys
import zlib
from array import array
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Set, Tuple

import numpy as np

import labial
from labial.reference.stream import aims
from labial.reference.tables import ExportedTables
from labial.tables.model import load
from labial.tables.quantise import quantise

#: Milliseconds of the silence after all that is known.
ENDLESS = 3_600_000
#: Frames of it that a session may see.
SILENT = 1000
FADE = 8
#: Frames that a stream has taken in ahead of the one that it delivered last.
KNOWN = 6
#: FAP units that lips are apart, so that they must meet for a contact before a fade's end; channels of jaw and lips.
APART, CLOSING = 24, (0, 3, 4, 7, 8, 9, 10)
#: Milliseconds from the end of all that is known until the face begins to ease to rest, and until it is there.
STILL, REST = 200, 500

Plan = List[Tuple[int, float, str]]
Faps = Tuple[int, ...]


class Shown(NamedTuple):
    number: int
    faps: Faps


def sessions(path: Path) -> List[Dict[str, Any]]:
    found: List[Dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["sessions"]
    return found


def times(step: List[Any]) -> List[Optional[float]]:
    """The times of a step ["played", time] or ["plays", first, last, difference]."""
    if step[0] == "played":
        return [step[1]]
    _, first, last, difference = step
    return [first + k * difference for k in range(math.floor((last - first) / difference + 1e-6) + 1)]


def summary(frames: List[Shown]) -> List[int]:
    """The number of frames, the last one's number, and the CRC-32 of all FAPs, 16 bits each, low byte first."""
    data = array("h", [fap for frame in frames for fap in frame.faps])
    if sys.byteorder == "big":
        data.byteswap()
    return [len(frames), frames[-1].number if frames else -1, zlib.crc32(data.tobytes())]


class Oracle:
    """Follows a session's steps; `options` are those of :class:`labial.Voice`."""

    def __init__(self, options: Dict[str, Any]) -> None:
        self.options = options
        self.utterances: List[Dict[str, Any]] = [_utterance(0, True)]
        self.gone: Set[Optional[str]] = set()  # names of what was cancelled
        self.finished = self.cancelled = False
        self.neutral, self.epoch, self.plan = False, -1, []  # the stream: since when, of what
        self.next, self.shown = 0, None
        self.fade: Tuple[Faps, int, int, int] = ((0,) * 13, 0, 0, 0)
        self.changed = True

    def run(self, step: List[Any]) -> Optional[List[Shown]]:
        """A step of a session; returns the frames of one that plays."""
        name, *arguments = step
        if name in ("played", "plays"):
            return [frame for time in times(step) for frame in self.played(time)]
        getattr(self, name)(*arguments)
        self.changed = True
        return None

    # ---- What is told

    def feed(self, message: Any) -> None:
        name = message.get("context_id")
        if self.cancelled:
            self.gone.add(name)
        elif name is None or name not in self.gone:
            self.named(name)["messages"].append(message)
            self.requeue(self.next * 20)

    def named(self, name: Optional[str]) -> Dict[str, Any]:
        """The utterance of a name, which may be a new one; that of no name is the last one."""
        for one in self.utterances:
            if name and one["name"] == name:
                return one
        if self.finished or (name and self.utterances[-1]["name"]):
            self.begin()
            self.utterances[-1]["early"] = True
        self.utterances[-1]["name"] = name or self.utterances[-1]["name"]
        return self.utterances[-1]

    def say(self, text: str, start: float, end: Optional[float] = None) -> None:
        if self.listens():
            self.insert("words", text, _ms(start), None if end is None else _ms(end))

    def push(self, phoneme: str, start: float, end: float) -> None:
        if self.listens():
            self.insert("phonemes", phoneme, _ms(start), _ms(end))

    def begin(self, at: Optional[float] = None) -> None:
        waiting = [] if at is None else [one for one in self.utterances if self.waits(one, _ms(at))]
        if waiting:
            waiting[0].update(origin=_ms(at or 0), queued=False, early=False)
            self.requeue(-1)
            return
        start = max(self.ends()[-1] if self.utterances else 0, self.next * 20) if at is None else _ms(at)
        gives_way = self.utterances and not self.utterances[-1]["queued"] and not self.spoken(self.utterances[-1])
        self.utterances.append(_utterance(start, at is None and not gives_way))
        self.utterances[-1]["early"] = at is None and self.cancelled
        self.finished = self.cancelled = False

    def waits(self, one: Dict[str, Any], at: int) -> bool:
        """Whether an utterance was told before its sound: it began by itself and is not over, or is not to be heard."""
        number = self.utterances.index(one)
        is_cut = any(other["origin"] <= one["origin"] for other in self.utterances[number + 1 :])
        if not one["queued"] or not self.spoken(one) or is_cut:
            return False
        return at <= one["origin"] or (one["early"] and self.ends()[number] > self.next * 20)

    def requeue(self, moment: int) -> None:
        """Moves what is queued and begins after a moment behind what was told more of."""
        for number, one in enumerate(self.utterances[1:]):
            if one["queued"] and one["origin"] > moment:
                one["origin"] = max(one["origin"], self.ends()[number])

    def finish(self) -> None:
        self.finished = True

    def cancel(self, milliseconds: float) -> None:
        self.gone |= {one["name"] for one in self.utterances}
        self.utterances, self.cancelled, self.finished = [], True, False
        self.neutral = True
        frames = max(1, math.ceil(milliseconds / 20 - 1e-6))
        self.fade = (self.shown or (0,) * 13, 0, frames, frames)

    def listens(self) -> bool:
        if not self.cancelled:
            self.named(None)
        return not self.cancelled

    def insert(self, kind: str, text: str, start: int, end: Optional[int]) -> None:
        """Puts an item in place of those that begin within its time, but for what its end may be rounded by."""
        utterance = self.utterances[-1]
        behind = start + 1 if end is None else max(end - min(20, (end - start) / 2), start + 1)
        kept = [item for item in utterance[kind] if not start <= item[0] < behind]
        utterance[kind] = sorted([*kept, (start, end, text)], key=lambda item: item[0])
        utterance["end"] = max(utterance["end"], start if end is None else end)

    # ---- The timeline

    def spoken(self, utterance: Dict[str, Any]) -> List[Tuple[int, int, str]]:
        """Phonemes of an utterance with their times in it."""
        if utterance["messages"]:
            try:
                timings = labial.read_timings(utterance["messages"], source=self.options.get("format"),
                                              own=self.options.get("own"))
            except labial.errors.DataError as error:  # so far they tell nothing
                assert "times nothing here" in str(error)
                timings = []
        elif utterance["phonemes"]:
            timings, moment = [], 0
            starts = [start for start, _, _ in utterance["phonemes"]][1:]
            for (start, end, label), after in zip(utterance["phonemes"], [*starts, math.inf]):
                end = after if abs(after - end) <= 1 else min(end, after)  # rounding
                timings += [("SIL", start - moment), (label, end - start)]
                moment = end
        else:
            timings = labial.word_timings([(text, start, end) for start, end, text in utterance["words"]])
        ends = list(itertools.accumulate(int(length) for _, length in timings))
        return [(begin, end, label) for begin, end, (label, _) in zip([0, *ends], ends, timings) if label != "SIL"]

    def ends(self) -> List[int]:
        return [one["origin"] + max([one["end"], *(end for _, end, _ in self.spoken(one))]) for one in self.utterances]

    def from_time(self, start: int) -> Plan:
        """All that is known from a time on."""
        found: Plan = []
        moment = start
        origins = [one["origin"] for one in self.utterances]
        limits = [min(origins[k + 1 :], default=math.inf) for k in range(len(origins))]
        for one, limit in zip(self.utterances, limits):
            offset = int(self.options.get("offset_ms", 0))
            shift = one["origin"] + offset
            for begin, end, label in self.spoken(one):
                begin, end = max(begin + shift, moment), min(end + shift, limit + offset)
                if begin < end:
                    found += [(moment, begin, "SIL")] if begin > moment else []
                    found.append((begin, end, label))
                    moment = end
        return [*found, (moment, math.inf, "SIL")]

    # ---- Frames

    def played(self, time: Optional[float]) -> List[Shown]:
        due = -1 if time is None or time < 0 else math.floor(time * 50 + 1e-6)
        late = due - self.next >= 50
        if late:
            self.next = due
        if due >= self.next and (self.changed or late):
            self.change(late)
        found = []
        while self.next <= due:
            base = (0,) * 13 if self.neutral else rested(self.plan, self.next)
            offset, step, steps, closing = self.fade
            if step < steps:
                step += 1
                left = [16384 - eased(min(step, end), end) for end in (closing if k in CLOSING else steps
                                                                      for k in range(13))]
                base = tuple(one + ((more * part + 8192) >> 14) for one, more, part in zip(base, offset, left))
                self.fade = (offset, step, steps, closing)
            found.append(Shown(self.next, base))
            self.shown = base
            self.next += 1
        return found

    def change(self, late: bool) -> None:
        """Makes another stream if the phonemes that this one has are not those that it should have."""
        self.changed = False
        start = max(0, self.next * 20 // 1000 - 2) * 1000
        plan = self.from_time(start)
        if self.neutral and not any(map(self.spoken, self.utterances)) and (self.shown is not None or self.cancelled):
            return
        if not self.neutral and not late and self.epoch >= 0:
            fed = self.plan[: needed(self.plan, self.next - self.epoch // 20)]
            clipped = [(max(begin, start), end, label) for begin, end, label in fed if end > start]
            if plan[: len(clipped)] == clipped:
                self.plan = [*fed, *plan[len(clipped) :]]
                return
        self.epoch, self.plan, self.neutral = start, plan, False
        if self.shown is not None:
            before = rested(plan, self.next - 1)
            touching = [k for k, touches in enumerate(contacts(plan, self.next)) if touches]
            closing = touching[0] + 2 if touching and -sum(self.shown[3:5]) > APART else FADE
            self.fade = (tuple(one - other for one, other in zip(self.shown, before)), 0, FADE, closing)


def _utterance(origin: int, queued: bool) -> Dict[str, Any]:
    return dict(origin=origin, end=0, messages=[], words=[], phonemes=[], queued=queued, early=False, name=None)


def _ms(seconds: float) -> int:
    return math.floor(seconds * 1000 + 0.5)


def _timings(plan: Plan) -> List[Tuple[str, float]]:
    return [(label, min(end - start, ENDLESS)) for start, end, label in plan]


def eased(step: int, steps: int) -> int:
    """3 s^2 - 2 s^3 of 2^14, at a step of so many."""
    share = (step << 14) // steps
    return ((share * share >> 14) * (49152 - 2 * share)) >> 14


def rested(plan: Plan, number: int) -> Faps:
    """A frame of a voice that follows a plan, which eases to rest after all that is known."""
    made = _motion(tuple(plan))[number - plan[0][0] // 20]
    passed = min(max(0, number * 20 - int(plan[-1][0]) - STILL), REST - STILL)
    left = 16384 - eased(passed, REST - STILL)
    return tuple((fap * left + 8192) >> 14 for fap in made)


@functools.lru_cache(maxsize=4)
def _motion(plan: Tuple[Tuple[int, float, str], ...]) -> List[Faps]:
    """The frames of a plan, but not those of an hour of silence."""
    spoken = [end for _, end, _ in plan if end < math.inf]
    count = (int(spoken[-1] if spoken else 0) - plan[0][0]) // 20 + SILENT
    with labial.Stream() as stream:
        for phoneme, length in _timings(list(plan)):
            stream.push(phoneme, length)
        return [item.faps for item in itertools.islice(stream, count)]


@functools.lru_cache(maxsize=1)
def _tables() -> ExportedTables:
    """The bundled voice's."""
    models = Path(__file__).parents[2] / "export" / "models"
    return ExportedTables(quantise(load(str(models / "speech_en.npz")), "speech_en"))


def contacts(plan: Plan, number: int) -> List[bool]:
    """Whether lips or lip and teeth touch, in each frame from this one of a plan on that a stream has taken in."""
    phonemes = [(labial.speech_en.number(label), round(min(length, SILENT * 20))) for label, length in _timings(plan)]
    _, contact, _ = aims(_tables(), phonemes)
    first = number - plan[0][0] // 20
    return [bool(touches) for touches in np.any(contact[first : first + KNOWN], axis=1)]


def needed(plan: Plan, number: int) -> int:
    """How many phonemes of a plan a stream must have before it makes the frames before this one."""
    with labial.Stream() as stream:
        count = frames = 0
        for phoneme, length in _timings(plan):
            if frames >= number:
                break
            stream.push(phoneme, length)
            count += 1
            while frames < number and next(stream, None):
                frames += 1
    return count
