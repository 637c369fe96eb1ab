"""Writes ``sessions.json``: what happens in each session, and what :mod:`oracle` shows in it; and ``frames.txt``, the
frames of each session, written as those of ``tests/conformance`` are.

    PYTHONPATH=export:tests/voices LABIAL_RUNTIME=.../labial_runtime.so python3 tests/voices/regenerate_voices.py

A step is a call of a voice: its name and arguments. ["plays", first, last, difference] plays to each of these times.
After a step that plays, `shown` has the number of its frames, the last one's number, and the CRC-32 of all their FAPs,
16 bits each, low byte first.
"""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from oracle import Oracle, Shown, summary

SAMPLES = json.loads((Path(__file__).parents[1] / "python" / "services.json").read_text(encoding="utf-8"))["samples"]
WORDS = [("Maybe,", 0.1, 0.52), ("people", 0.56, 0.95), ("hum", 0.97, 1.2), ("by", 1.5, 1.7), ("the", 1.7, 1.8),
         ("pool.", 1.83, 2.3)]  # fmt: skip
SOUNDS = [("m", 0.1, 0.17), ("eɪ", 0.17, 0.3), ("b", 0.3, 0.36), ("i", 0.36, 0.5), ("ɡ", 0.75, 0.82),
          ("oʊ", 0.82, 1.0), ("p", 1.0, 1.08), ("uː", 1.08, 1.3), ("l", 1.3, 1.4)]  # fmt: skip
FRAME = 0.02


def _plays(first: float, last: float, step: float = FRAME) -> List[Any]:
    return ["plays", first, last, step]


def _sample(name: str) -> List[List[Any]]:
    return [["feed", message] for sample in SAMPLES if sample["name"] == name for message in sample["messages"]]


def _sounds(first: int = 0, end: int = len(SOUNDS)) -> List[List[Any]]:
    return [["push", *sound] for sound in SOUNDS[first:end]]


def _stamps(name: Tuple[str, str], *words: Tuple[str, float, float]) -> List[Any]:
    """A message of words, with the name of what it belongs to."""
    stamps = {key: list(values) for key, values in zip(("words", "start", "end"), zip(*words))}
    return ["feed", {"type": "timestamps", name[0]: name[1], "word_timestamps": stamps}]


def _rime(*words: Tuple[str, float, float]) -> List[Any]:
    return _stamps(("contextId", "r"), *words)


def _answer(name: str, *words: Tuple[str, float, float]) -> List[Any]:
    """A message of Cartesia."""
    return _stamps(("context_id", name), *words)


def _words(first: int = 0, end: int = len(WORDS)) -> List[List[Any]]:
    return [["say", *word] for word in WORDS[first:end]]


def _in_time(calls: List[List[Any]], lead: float) -> List[List[Any]]:
    """Each call of a word or phoneme so long before the sound plays it, in seconds."""
    found, moment = [], 0.0
    for call in calls:
        due = round(max(0.0, call[2] - lead) / FRAME) * FRAME
        if due > moment:
            found.append(_plays(moment, round(due - FRAME, 6)))
            moment = round(due, 6)
        found.append(call)
    return [*found, _plays(moment, 3.0)]


def _one_by_one(name: str, every: float) -> List[List[Any]]:
    """A sample's messages, one after `every` seconds of playing."""
    return [step for k, feed in enumerate(_sample(name))
            for step in (feed, _plays(round(every * k, 3), round(every * (k + 1) - FRAME, 3)))]


def _aligned(text: str, starts: List[int], lengths: List[int]) -> List[Any]:
    """A message of ElevenLabs."""
    return ["feed", {"alignment": {"chars": list(text), "charStartTimesMs": starts, "charDurationsMs": lengths}}]


def _split_word() -> List[List[Any]]:
    """ElevenLabs' characters in messages that end within a word, whose times go on, and begin at 0 again."""
    def message(text: str, start: int) -> List[Any]:
        starts = [start + 70 * k + 9 * (k % 3) for k in range(len(text))]
        return _aligned(text, starts, [b - a for a, b in zip(starts, [*starts[1:], start + 70 * len(text)])])

    return [message("Maybe pe", 100), _plays(0, 0.2), message("ople [soft", 660), _plays(0.22, 0.4),
            message("ly] hum.", 1360), _plays(0.42, 1.6), message(" By the", 0), _plays(1.62, 3)]


def _characters(*pieces: str) -> List[List[Any]]:
    """The same of 150 ms each, and of 300 ms for punctuation; a message ends where a blank of no length does."""
    steps, start = [], 100
    for text in pieces:
        lengths = [0 if character == " " else 300 if character in "、。，！" else 150 - 20 * (k % 3)
                   for k, character in enumerate(text)]
        steps.append(_aligned(text, [start + sum(lengths[:k]) for k in range(len(text))], lengths))
        start += sum(lengths)
    return steps


def _long() -> List[List[Any]]:
    """Twelve seconds of phonemes, and then one that was not known in time."""
    calls = [["push", label, round(start + 1.5 * k, 3), round(end + 1.5 * k, 3)]
             for k in range(8) for label, start, end in SOUNDS]
    return [*calls, _plays(0, 11.8), ["push", "m", 12.0, 12.2], ["push", "ɑ", 12.2, 12.5], _plays(11.82, 13.5)]


SESSIONS: Dict[str, Dict[str, Any]] = {
    "phonemes are known before": {"steps": [*_sounds(), _plays(0, 2)]},
    "phonemes come in time": {"steps": _in_time(_sounds(), 0.6)},
    "phonemes come late": {"steps": _in_time(_sounds(), 0.05)},
    "phonemes come when they are over": {"steps": _in_time(_sounds(), -0.2)},
    "a phoneme fills a pause that is playing": {"steps": [*_sounds(0, 4), _plays(0, 0.58), ["push", "ʃ", 0.55, 0.7],
                                                         *_sounds(4), _plays(0.6, 2)]},
    "a phoneme is revised": {"steps": [*_sounds(), _plays(0, 0.3), ["push", "f", 0.82, 1.0], _plays(0.32, 0.9),
                                       ["push", "ɑ", 0.9, 1.0], _plays(0.92, 2)]},
    "no clock, then one that begins late": {"steps": [["played", None], *_sounds(), ["played", None],
                                                      ["played", -0.1], _plays(0, 1.6)]},
    "a clock of odd steps": {"steps": [*_sounds(), _plays(0, 1.6, 0.0173)]},
    "a clock that goes back and jumps": {"steps": [*_sounds(), _plays(0, 0.2), ["played", 0.1], ["played", 0.31],
                                                   ["played", 1.29], ["played", 9.0], ["played", 9.02]]},
    "the sound was heard before": {"steps": [*_sounds(), ["played", 5.0], _plays(5.02, 5.1)]},
    "times are moved": {"options": {"offset_ms": 80}, "steps": [*_sounds(), _plays(0, 1.7)]},
    "cancelled and begun again": {"steps": [*_sounds(), _plays(0, 0.4), ["cancel", 200], *_sounds(4),
                                            _plays(0.42, 0.9), ["begin", 1.0], *_sounds(), _plays(0.92, 2.8)]},
    "cancelled twice, begun during the fade": {"steps": [*_sounds(), _plays(0, 0.9), ["cancel", 500],
                                                         _plays(0.92, 1.0), ["cancel", 300], _plays(1.02, 1.1),
                                                         ["begin", None], *_sounds(), _plays(1.12, 3)]},
    "one utterance after the other": {"steps": [*_sounds(), ["begin", None], *_sounds(0, 4), ["begin", 2.2],
                                                *_sounds(4), _plays(0, 4)]},
    "an utterance cuts the one before": {"steps": [*_sounds(), _plays(0, 0.5), ["begin", 0.84], *_sounds(),
                                                   _plays(0.52, 2.6)]},
    "sentences whose times begin again, a little later": {"words": True, "steps": [
        _rime(("Maybe", 0.08, 0.5), ("people", 0.52, 0.9)), _rime(("hum", 0.12, 0.4), ("by", 0.45, 0.8)),
        _plays(0, 0.4), _rime(("the", 0.16, 0.3), ("pool", 0.35, 0.9)), _plays(0.42, 3.2)]},
    "told before it begins": {"steps": [*_sounds(), ["begin", 0.0], ["finish"], _plays(0, 1.5), *_sounds(0, 4),
                                        _plays(1.52, 1.7), ["begin", 2.0], *_sounds(4), _plays(1.72, 4)]},
    "finished, and more": {"steps": [*_sounds(), ["finish"], _plays(0, 1.5), *_sounds(0, 4), _plays(1.52, 2.6)]},
    "a long time before": {"steps": _long()},
    "words are known before": {"words": True, "steps": [*_words(), _plays(0, 3)]},
    "words come in time": {"words": True, "steps": _in_time(_words(), 1.2)},
    "words come late": {"words": True, "steps": _in_time(_words(), 0.1)},
    "words without ends": {"words": True, "steps": _in_time([word[:3] for word in _words()], 0.8)},
    "begun behind a word whose end is not known": {
        "words": True, "steps": [["say", "strengths", 0.1], ["begin", None], ["say", "hum", 0.1], _plays(0, 2.5)]},
    "a word is revised": {"words": True, "steps": [*_words(), _plays(0, 0.4), ["say", "purple", 0.56, 0.95],
                                                   _plays(0.42, 0.7), ["say", "poodle", 1.0, 1.2], _plays(0.72, 3)]},
    "Azure's visemes": {"options": {"format": "azure"}, "steps": [*_sample("azure"), _plays(0, 1.5)]},
    "Azure's visemes come one by one": {
        "options": {"format": "azure"},
        "steps": _one_by_one("azure", 0.1)},
    "Polly's words come one by one": {"words": True, "options": {"format": "polly"},
                                      "steps": _one_by_one("polly_words", 0.2)},
    "Hume's words, then their phonemes": {"words": True, "options": {"format": "hume"},
                                          "steps": [*_one_by_one("hume", 0.04), _plays(0.32, 1.3)]},
    "ElevenLabs splits a word": {"words": True, "options": {"format": "elevenlabs"}, "steps": _split_word()},
    "characters of scripts without blanks": {
        "words": True, "options": {"format": "elevenlabs", "own": {
            "ままとぱ": "M AA M AA T OW P AA", "食べます": "T AA B EH M AA S", "妈妈": "M AA M AA", "แม่": "M EH"}},
        "steps": [*_characters("ままとぱぱはパンを食べます。妈妈", "！แม่และพ่อ 爸爸,朋友"), _plays(0, 6)]},
    "messages that end with a blank of no length": {
        "words": True, "options": {"format": "elevenlabs"},
        "steps": [*_characters("Bob ", "may ", "hum ", "by."), _plays(0, 3)]},
    "named answers, each told before its sound": {
        "words": True, "steps": [
            _answer("a", ("Maybe", 0.1, 0.5), ("people", 0.55, 0.95)), _plays(0, 0.5), _answer("b", ("hum", 0.1, 0.4)),
            _plays(0.52, 0.8), _answer("c", ("pool", 0.1, 0.5)), _answer("b", ("by", 0.45, 0.8)), _plays(0.82, 1.28),
            ["begin", 1.3], _answer("b", ("the", 0.85, 1.0)), _plays(1.3, 2.58), ["begin", 2.6], _plays(2.6, 4)]},
    "begun at once after a cancel, and told its sound": {
        "words": True, "steps": [
            _answer("a", ("Maybe", 0.1, 0.5), ("people", 0.55, 0.95)), _plays(0, 0.5), ["cancel", 200],
            _answer("b", ("late", 0.1, 0.4)), _plays(0.52, 0.8), ["begin", None], _answer("b", ("late", 0.5, 0.8)),
            _answer("c", ("hum", 0.1, 0.4)), _plays(0.82, 0.98), ["begin", 1.1], _answer("c", ("by", 0.45, 0.8)),
            _answer("a", ("pool", 0.1, 0.4)), _plays(1, 3)]},
    "Inworld's phones": {"options": {"format": "inworld"}, "steps": [*_sample("inworld"), _plays(0, 1.3)]},
    "Polly's visemes": {"options": {"format": "polly"}, "steps": [*_sample("polly"), _plays(0, 1.5)]},
    "Piper's chunks": {"options": {"format": "piper"}, "steps": [*_sample("piper"), _plays(0, 4)]},
    "Kokoro's results": {"options": {"format": "kokoro"}, "steps": [*_sample("kokoro"), _plays(0, 3)]},
    "HeadTTS's answers": {"options": {"format": "headtts"}, "steps": [*_sample("headtts"), _plays(0, 3)]},
    "Cartesia's phonemes": {"options": {"format": "cartesia"},
                            "steps": [*_sample("cartesia_phonemes"), _plays(0, 1.5)]},
    "Cartesia's words": {"words": True, "options": {"format": "cartesia"},
                         "steps": [*_sample("cartesia")[:2], _plays(0, 0.3), *_sample("cartesia")[2:],
                                   _plays(0.32, 1.5)]},
    "ElevenLabs' characters": {"words": True, "options": {"format": "elevenlabs"},
                               "steps": [_sample("elevenlabs_ws")[0], _plays(0, 0.3),
                                         *_sample("elevenlabs_ws")[1:], _plays(0.32, 1.7)]},
    "Fish Audio's chunks are revised": {"words": True, "options": {"format": "fish"},
                                        "steps": [_sample("fish")[0], _plays(0, 0.2), _sample("fish")[1],
                                                  _plays(0.22, 0.5), *_sample("fish")[2:], _plays(0.52, 1.5)]},
}


def rows_of(frames: Sequence[Sequence[int]]) -> List[str]:
    """A line for each frame; for those that are like the one before ``and`` and how many they are."""
    rows: List[str] = []
    for faps, same in itertools.groupby(frames):
        rows.append(" ".join(map(str, faps)))
        alike = len(list(same)) - 1
        rows += [f"and {alike}"] * bool(alike)
    return rows


def frames_text(shown: Mapping[str, Sequence[Optional[Sequence[Shown]]]]) -> str:
    """The content of ``frames.txt``, of what the steps of each session show."""
    rows: List[str] = []
    for name, steps in shown.items():
        rows += [name, *rows_of([frame.faps for frames in steps for frame in frames or []])]
    return "\n".join(rows) + "\n"


def main() -> None:
    found, every = [], {}
    for name, session in SESSIONS.items():
        oracle = Oracle(session.get("options", {}))
        shown = [oracle.run(step) for step in session["steps"]]
        every[name] = shown
        found.append({"name": name, **session, "shown": [summary(frames) for frames in shown if frames is not None]})
    lines = ",\n".join(json.dumps(session, ensure_ascii=False) for session in found)
    text = f'{{"about": "written by regenerate_voices.py, which explains it", "sessions": [\n{lines}\n]}}\n'
    Path(__file__).with_name("sessions.json").write_text(text, encoding="utf-8")
    Path(__file__).with_name("frames.txt").write_text(frames_text(every), encoding="utf-8")


if __name__ == "__main__":
    main()
