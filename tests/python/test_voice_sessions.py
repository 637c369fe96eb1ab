"""Sessions of voices against tests/voices/oracle.py: those that Python and JavaScript share, and drawn ones."""

from __future__ import annotations

import json
import random
from typing import Any, List

import pytest

import labial
from oracle import Oracle, Shown, sessions, summary, times
from packages import SOURCE
from regenerate_voices import SESSIONS, frames_text
from runtime import needs_runtime

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


@pytest.mark.parametrize("first", [0, 10, 20])
def test_sessions_that_are_drawn(first: int) -> None:
    """Ten sessions each."""
    for seed in range(first, first + 10):
        oracle = Oracle({})
        with labial.Voice() as voice:
            for number, step in enumerate(drawn(seed)):
                assert follow(voice, step) == (oracle.run(step) or []), (seed, number, step)
