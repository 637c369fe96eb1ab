"""Voices in the npm package against those of Python: the same frames, or an error in both, in sessions that are drawn
at random; tests/voices has others, which tests/npm/voices.test.mjs runs."""

from __future__ import annotations

import json
import random
from array import array
from pathlib import Path
from typing import Any, Dict, List, Optional

import labial
from labial.errors import LabialError
from labial.files.faps import CHANNELS
from messages import NAMES, PIECES, drawn_messages
from npm import answered
from runtime import needs_runtime
from test_npm import drawn_json

pytestmark = needs_runtime

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
