"""Sessions of voices against tests/voices/oracle.py: those that Python and JavaScript share, and drawn ones."""

from __future__ import annotations

import json
import random
from array import array
from pathlib import Path
from typing import Any, Dict, List, Optional

import pytest

import labial
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from messages import NAMES, PIECES, drawn_messages
from npm import answered
from oracle import Oracle, Shown, sessions, summary, times
from packages import SOURCE, needs_runtime
from regenerate_voices import SESSIONS, frames_text
from test_npm import drawn_json

pytestmark = needs_runtime
FRAMES = "\n" + (SOURCE / "tests" / "voices" / "frames.txt").read_text(encoding="utf-8")
STORED = {session["name"]: session for session in sessions(SOURCE / "tests" / "voices" / "sessions.json")}


def follow(voice: labial.Voice, step: List[Any]) -> List[Shown]:
    """The frames of a step of a session that plays."""
    if step[0] in ("played", "plays"):
        return [Shown(*frame) for time in times(step) for frame in voice.played(time)]
    getattr(voice, step[0])(*step[1:])
    return []


@pytest.mark.parametrize("name", SESSIONS)
def test_sessions(name: str) -> None:
    """Every session shows what the oracle says, which is what the file of sessions has."""
    session = SESSIONS[name]
    steps, options = session["steps"], session.get("options", {})
    oracle = Oracle(options)
    expected = [oracle.run(step) for step in steps]
    shown = [summary(frames) for frames in expected if frames is not None]
    assert STORED[name] == json.loads(json.dumps({"name": name, **session, "shown": shown}))
    assert f"\n{frames_text({name: expected})}" in FRAMES, "run regenerate_voices.py"
    with labial.Voice(**options) as voice:
        assert [follow(voice, step) for step in steps] == [frames or [] for frames in expected]


def drawn(seed: int) -> List[List[Any]]:
    """The steps of a session that is drawn at random: words or phonemes before, while and after they are due, revised,
    cancelled, begun anew."""
    draw = random.Random(seed)
    words = draw.random() < 0.5
    steps: List[List[Any]] = []
    now = origin = 0.0
    for _ in range(draw.randrange(5, 40)):
        kind = draw.random()
        if kind < 0.45:
            start = round(max(0.0, now - origin + draw.uniform(-0.4, 1.0)), 3)
            end = round(start + draw.choice([0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.8]), 3)
            if words:
                text = draw.choice(["Maybe", "people", "hum", "by", "the", "pool.", "strengths", "21", "(yes)", "你好"])
                steps.append(["say", text, start, draw.choice([end, end, None])])
            else:
                steps.append(["push", draw.choice(["AA", "M", "S", "IY", "T", "UW", "B", "SH", "OW", "F"]), start, end])
        elif kind < 0.85:
            now = round(now + draw.choice([0.013, 0.02, 0.1, 0.3, 0.3, 0.9, 1.5]), 4)
            steps.append(["played", now])
        elif kind < 0.9:
            steps.append(["cancel", draw.choice([10, 100, 200, 500])])
        elif kind < 0.96:
            origin = round(max(0.0, now + draw.uniform(-0.2, 0.5)), 3)
            steps.append(["begin", draw.choice([None, origin])])
        else:
            steps.append(["finish"])
    return [*steps, ["plays", now, now + 1.5, 0.02]]


@pytest.mark.parametrize("first", [0, *(pytest.param(first, marks=pytest.mark.slow) for first in (10, 20))])
def test_sessions_that_are_drawn(first: int) -> None:
    """Ten sessions each."""
    for seed in range(first, first + 10):
        oracle = Oracle({})
        with labial.Voice() as voice:
            for number, step in enumerate(drawn(seed)):
                assert follow(voice, step) == (oracle.run(step) or []), (seed, number, step)


# ---- Voices in the npm package against those of Python ---------------------------------------------------------------


#: What each step of a session shows, and "!" for those that are refused.
SESSION = """
const sessions = [];
for (const { options: { offset_ms, ...options }, steps } of given) {
    const voice = await labial.voice({ ...options, offset: offset_ms / 1000 });
    sessions.push(steps.map(([name, ...rest]) => {
        try {
            const found = voice[name](...rest);
            return name === "played" ? found.flatMap((faps) => [...faps]) : [];
        } catch (error) {
            if (error.name !== "LabialError" && error.name !== "TypeError" && error.name !== "RangeError") throw error;
            return "!";
        }
    }));
    voice.close();
}
answer(sessions);
"""


def drawn_session(rng: random.Random) -> Dict[str, Any]:
    """Messages of a service, cut to pieces as they might arrive; words, phonemes, clocks, utterances, cancels."""
    service, text = drawn_messages(rng) if rng.random() < 0.8 else drawn_json(rng)[:2]
    try:
        found = json.loads(text)
    except ValueError:
        found = [json.loads(line) for line in text.splitlines()]
    messages: List[Any] = found if isinstance(found, list) else [found]
    steps: List[List[Any]] = []
    moment = 0.0
    while messages or rng.random() < 0.8:
        kind = rng.random()
        if messages and kind < 0.5:
            count = rng.randrange(1, 4)
            steps.append(["feed", messages[:count] if rng.random() < 0.5 else json.dumps(messages[:count])])
            del messages[:count]
        elif kind < 0.6:
            start = rng.random() * 3
            length: Optional[float] = rng.choice([0.0, 0.2, 0.4567, None])
            steps.append(["say", rng.choice(PIECES[:8]), start, None if length is None else start + length])
        elif kind < 0.65:
            start = rng.random() * 3
            steps.append(["push", rng.choice(["m", "AA", "ʃ", "zz"]), start, start + rng.choice([0.1, 0.0004, -1])])
        elif kind < 0.7:
            steps.append(rng.choice([["begin"], ["begin", moment + rng.random()], ["finish"], ["cancel", 150]]))
        else:
            moment += rng.choice([0.02, 0.033, 0.2, 0.5, 1.5, -0.1])
            steps.append(["played", rng.choice([moment, moment, moment, None])])
    return {"options": {"format": service if service in NAMES and rng.random() < 0.5 else "auto",
                        "offset_ms": rng.choice([0, 0, 40, -200])}, "steps": steps}  # fmt: skip


def shown(session: Dict[str, Any]) -> List[Any]:
    """What Python shows in a session."""
    options = session["options"]
    found: List[Any] = []
    with labial.Voice(None if options["format"] == "auto" else options["format"],
                      offset_ms=options["offset_ms"]) as voice:
        for name, *rest in session["steps"]:
            try:
                frames = getattr(voice, name)(*rest)
                found.append(list(array("h", [fap for frame in frames for fap in frame.faps])) if frames else [])
            except (LabialError, TypeError):
                found.append("!")
    return found


def test_sessions_are_the_same(tmp_path: Path) -> None:
    """Catches a message that one language reads otherwise, another rounding, another moment of a change."""
    rng = random.Random(11)
    sessions = [drawn_session(rng) for _ in range(150)]
    frames = refused = 0
    for session, found in zip(sessions, answered(SESSION, sessions, tmp_path / "npm")):
        expected = shown(session)
        for step, one, other in zip(session["steps"], found, expected):
            assert one == other, (session["options"], step, session["steps"])
        assert len(found) == len(expected)
        refused += expected.count("!")
        frames += sum(len(one) // CHANNELS for one in expected if one != "!")
    assert frames > 1500 and refused > 20
