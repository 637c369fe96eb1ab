"""The Python run-time answers every conformance stream with the same bytes as C, however it is fed."""

from __future__ import annotations

from typing import Any, Dict

import numpy as np
import pytest

import labial
from runtime import conformance_frames, conformance_scripts, needs_runtime

pytestmark = needs_runtime


@pytest.mark.parametrize("feed", ["fill", "single", "hungry", "whole"])
@pytest.mark.parametrize("script", conformance_scripts(), ids=lambda script: script["name"])
def test_stream_has_the_same_frames(script: Dict[str, Any], feed: str) -> None:
    """A push that is lost in the run-time's own queue, a cancel that keeps one, a model that is named too late, a frame
    that is skipped or delivered twice: all of it moves a frame."""
    from runtime_player import play

    rows = play(script, feed)
    wanted = conformance_frames()[script["name"]]
    assert len(rows) == len(wanted)
    assert rows == [tuple(row) for row in wanted.tolist()]


def test_render_has_the_same_frames() -> None:
    """Whole utterances of one part: numbers or labels, a list of tuples."""
    played = 0
    for script in conformance_scripts():
        part = script["parts"][0]
        pushes = part["pushes"]
        if len(script["parts"]) > 1 or part["cancel"] or part["articulation"]:
            continue
        if any(push[0] != "speech" for push in pushes):
            continue
        for name in (lambda phoneme: phoneme, lambda phoneme: labial.speech_en.phonemes[phoneme]):
            motion = labial.render([(name(phoneme), milliseconds) for _, phoneme, milliseconds in pushes])
            assert isinstance(motion, list) and all(type(row) is tuple and len(row) == 13 for row in motion)
            assert (np.array(motion).reshape(-1, 13) == conformance_frames()[script["name"]]).all()
        played += 1
    assert played > 10
