"""Words in the npm packages against the exporter: the same phonemes at the same times, of texts, of words and
characters with their times, and of what services tell of them."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import labial
from labial.corpus.formats import read_timings
from labial.corpus.words import PLAIN, Pronunciation, pronunciation
from labial.errors import DataError, LabialError
from messages import NAMES, PIECES, SAMPLES, drawn_messages
from npm import answered
from packages import needs_runtime
from test_npm import MALFORMED, drawn_json

pytestmark = needs_runtime
OWN: Dict[str, Any] = {"kokoro": "K OW K AO R OW", "it's": ["IH", "T", "S"], "Zürich": "Z UH R IH K", "go": ""}


#: Each call by its name with its arguments: what it makes of them, or the sentence of its error.
CALL = """
const words = await labial.words();
answer(given.map(([name, ...rest]) => {
    try {
        return words[name](...rest);
    } catch (error) {
        if (error.name !== "LabialError" || error.message.includes("\\n")) throw error;
        return error.message;
    }
}));
"""
Rows = List[Tuple[float, float, str]]


def rows(found: List[Dict[str, Any]]) -> Rows:
    assert all(item["labels"] == "arpabet" for item in found)
    return [(item["start"], item["end"], item["label"]) for item in found]


def timed(timings: List[Tuple[str, int]]) -> Rows:
    """Python's phonemes and milliseconds as segments."""
    found, moment = [], 0
    for label, length in timings:
        found.append((moment / 1000, (moment + length) / 1000, "" if label == "SIL" else label))
        moment += length
    return found


def text_of(rng: random.Random) -> str:
    return "".join(rng.choice(PIECES) + rng.choice(["", " ", " ", "\n"]) for _ in range(rng.randrange(1, 8)))


def test_texts(tmp_path: Path) -> None:
    """Would catch tables of another build, and letters of any script that JavaScript passes on otherwise."""
    rng = random.Random(7)
    common = (Path(labial.__file__).parent / "words" / "common.txt").read_text(encoding="utf-8").splitlines()
    texts = [" ".join(line for line in common if line[:1].isalpha())] + [text_of(rng) for _ in range(300)]
    calls = [["phonemes", text, {"own": OWN} if number % 3 == 0 else {}] for number, text in enumerate(texts)]
    found = answered(CALL, calls, tmp_path)
    assert found == [labial.phonemes(text, own=OWN if number % 3 == 0 else None) for number, text in enumerate(texts)]
    assert len(found[0]) > 20000


def drawn_words(rng: random.Random) -> Tuple[List[Tuple[str, int, Optional[int]]], int]:
    """Words, mostly in order, with gaps, overlaps and unknown ends; and an offset."""
    found: List[Tuple[str, int, Optional[int]]] = []
    moment = 0
    for _ in range(rng.randrange(1, 12)):
        moment += rng.choice([0, 0, 40, 149, 150, 151, 700, -1 if rng.random() < 0.03 else 0])
        length = rng.choice([0, 3, 90, 320, 800, 3_600_001 if rng.random() < 0.02 else 200])
        found.append((rng.choice(PIECES), max(0, moment), rng.choice([max(0, moment) + length, None])))
        moment += rng.choice([length, length // 2])
    return found, rng.choice([0, 0, 35, -120, -5000])


def test_words_and_characters_with_times(tmp_path: Path) -> None:
    """Would catch another rounding, a gap or an end that is treated otherwise, and an error on one side alone."""
    rng = random.Random(8)
    calls: List[Any] = []
    wanted: List[Any] = []

    def add(call: List[Any], how: Dict[str, Any], make: Any) -> None:
        calls.append([*call, {"own": how["own"], "offset": how["offset_ms"] / 1000}])
        try:
            wanted.append(timed(make(**how)))
        except LabialError as error:
            wanted.append(str(error))

    for number in range(400):
        words, offset = drawn_words(rng)
        how = {"own": OWN if number % 2 else None, "offset_ms": offset}
        add(["wordTimings", [{"text": text, "start": start / 1000, "end": None if end is None else end / 1000}
                             for text, start, end in words]], how, lambda w=words, **how: labial.word_timings(w, **how))
        text = text_of(rng)
        items = [text[place : place + size] for size in [rng.choice([1, 1, 3])] for place in range(0, len(text), size)]
        steps = [rng.choice([30, 30, 70, 0, -20]) for _ in items]
        starts = [max(0, sum(steps[:place])) for place in range(len(items))]
        ends = [max(0, start + step) for start, step in zip(starts, steps)]
        add(["characterTimings", items, [t / 1000 for t in starts], [t / 1000 for t in ends]], how,
            lambda a=items, b=starts, c=ends, **how: labial.character_timings(a, b, c, **how))
    found = answered(CALL, calls, tmp_path)
    for call, one, other in zip(calls, found, wanted):
        assert isinstance(one, str) if isinstance(other, str) else rows(one) == other, call
    assert 10 < sum(isinstance(one, str) for one in wanted) < 200


def by_python(folder: Path, text: str, form: Optional[str], how: Pronunciation, offset: float) -> Any:
    path = folder / "a"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        return [(item.start, item.end, item.label, "" if item.labels == "auto" else item.labels)
                for item in read_timings(path, form, how, offset)]
    except DataError as error:
        return str(error)


def assert_alike(
    folder: Path, cases: List[Tuple[Optional[str], str]], own: Any = None, offset: float = 0.0
) -> List[Any]:
    """Reads each text, as JavaScript and Python do, in a format, or in the one that its content tells."""
    options = [{**({} if form is None else {"format": form}), "own": own, "offset": offset} for form, _ in cases]
    calls = [["read", text, option] for (_, text), option in zip(cases, options)]
    wanted = [by_python(folder, text, form, pronunciation(own) if own else PLAIN, offset) for form, text in cases]
    for case, found, other in zip(cases, answered(CALL, calls, folder / "npm"), wanted):
        if isinstance(other, str) or isinstance(found, str):
            assert isinstance(found, str) and isinstance(other, str), (case, found, other)
        else:
            segments = [(item["start"], item["end"], item["label"], item.get("labels", "")) for item in found]
            assert segments == other, case
    return wanted


def test_samples_of_services(tmp_path: Path) -> None:
    """Every sample, told by its content; text that is no JSON as well. Would catch a service taken for another."""
    cases = [(None, sample.text) for sample in SAMPLES.values()]
    cases += [(None, "0 .1 sil\n.1 .3 m\n"), ("lab", "0 .1 sil\n"), (None, "{}"), (None, "[]"), (None, "nothing")]
    wanted = assert_alike(tmp_path, cases)
    assert len(cases) > 24 and sum(isinstance(one, str) for one in wanted) == 3
    assert_alike(tmp_path, cases, {"maybe": "P AA"}, -0.2)


def test_drawn_messages(tmp_path: Path) -> None:
    """Would catch rules that agree on the samples alone: where messages join, what is left out, spellings, errors."""
    rng = random.Random(9)
    drawn = [drawn_messages(rng) for _ in range(600)]
    cases = [(service if number % 3 else None, text) for number, (service, text) in enumerate(drawn)]
    wanted = assert_alike(tmp_path, cases, OWN, 0.03)
    read = {service for (service, _), one in zip(drawn, wanted) if not isinstance(one, str)}
    assert read == set(NAMES) and 40 < sum(isinstance(one, str) for one in wanted) < 400
    others = [drawn_json(rng)[1] for _ in range(150)]
    assert_alike(tmp_path, [(None, text) for text in others])


def test_malformed_messages(tmp_path: Path) -> None:
    """Would catch what one side refuses and the other one reads."""
    cases = [(None, text if isinstance(text, str) else json.dumps(text)) for _, text in MALFORMED]
    cases += [(name, json.dumps(text)) for name in NAMES for text in ({}, [], [1], None, [[]], {"alignment": 3})]
    assert_alike(tmp_path, cases)


MESSAGES = """
const words = await labial.words();
answer(given.map(([format, messages]) => {
    const reader = words.reader({ format });
    return messages.map((message) => reader.read(message));
}));
"""


def test_messages_one_by_one(tmp_path: Path) -> None:
    """Would catch times of a message that do not follow those of the one before: together they are what read() has."""
    names = {"elevenlabs_ws": "characters", "elevenlabs": "characters", "cartesia": "words", "rime": "words",
             "cartesia_phonemes": "phonemes", "hume": "phonemes", "inworld": "phonemes", "minimax": "words",
             "words": "words"}  # fmt: skip
    given = [["auto", SAMPLES[name].messages] for name in names]
    for name, kind, found in zip(names, names.values(), answered(MESSAGES, given, tmp_path)):
        items = [item for one in found for item in one[kind]]
        (tmp_path / "a.json").write_text(SAMPLES[name].text, encoding="utf-8")
        wanted = read_timings(tmp_path / "a.json")
        if kind == "phonemes":
            assert [item["text"] for item in items] == [one.label for one in wanted], name
            continue
        spoken = "".join(item["text"] for item in items).replace(" ", "")
        assert spoken.rstrip(".") == "Maybe,go" and items[0]["start"] == 0.1 and items[-1]["end"] == 1.0, name
