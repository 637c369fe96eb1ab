"""The committed vectors of ``tests/conformance`` against ``streams.txt`` and the float64 reference, and the C library
against that on phoneme streams of all kinds."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
import pytest

import regenerate
from labial.errors import LabialError
from labial.evaluate.check import device_frames
from labial.reference.fade import delivered
from labial.reference.stream import synthesise
from labial.reference.tables import ExportedTables
from labial.tables.quantise import ExportedModel, quantise
from models import random_model, streams
from packages import needs_runtime
from regenerate import bundled_models, deviations, library_frames
from scripts import Frames, Part, Push, Script, as_c, digest, read, read_frames

HERE = Path(__file__).resolve().parents[1] / "conformance"


@pytest.fixture(scope="module")
def models() -> Dict[str, ExportedModel]:
    return bundled_models()


@pytest.fixture(scope="module")
def scripts(models: Dict[str, ExportedModel]) -> List[Script]:
    return read(HERE / "streams.txt", models)


@pytest.fixture(scope="module")
def frames() -> Frames:
    return read_frames((HERE / "frames.txt").read_text(encoding="ascii"))


@pytest.mark.parametrize("part", [0, *(pytest.param(part, marks=pytest.mark.slow) for part in range(1, 4))])
def test_committed_frames_follow_the_reference(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames, part: int
) -> None:
    """Every wrong decision, switch, fade or easing is far beyond the limits: these are no golden files. In parts, which
    run at the same time."""
    report = deviations(models, scripts[part::4], frames)
    assert len(report.splitlines()) == len(scripts[part::4]) + 1


def test_a_wrong_frame_is_not_accepted(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """The comparison above can fail: on one number, on a frame too many, on small errors everywhere."""
    scripts = [script for script in scripts if script.name in ("cancelled", "switch")]
    one = {name: motion.copy() for name, motion in frames.items()}
    one["cancelled"][40, 3] += 3
    with pytest.raises(LabialError, match="cancelled: frame 40, channel 3"):
        deviations(models, scripts, one)
    longer = {**frames, "switch": np.concatenate([frames["switch"], frames["switch"][-1:]])}
    with pytest.raises(LabialError, match="switch: 100 frames, the reference has 99"):
        deviations(models, scripts, longer)
    with pytest.raises(LabialError, match="RMS|frame"):
        deviations(models, scripts, {name: motion + 1 for name, motion in frames.items()})


def test_vectors_are_those_of_the_streams_and_frames(
    models: Dict[str, ExportedModel], scripts: List[Script], frames: Frames
) -> None:
    """Would catch a digest or a step that was edited by hand, and a stream added without regenerating."""
    assert (HERE / "vectors.c").read_text(encoding="ascii") == as_c(scripts, models, frames), "run regenerate.py"
    assert list(frames) == [script.name for script in scripts]


def runs_of(*pushes: Tuple[str, int, int]) -> List[regenerate.Run]:
    return regenerate.runs([Push(*push) for push in pushes], 50)


def test_runs_are_those_of_frames() -> None:
    """Phonemes without frames part no run, their time goes on to the next, and a run knows where it begins."""
    found = runs_of(("speech", 3, 60), ("laughter", 1, 9), ("speech", 4, 11), ("laughter", 2, 45), ("laughter", 1, 36))
    assert [(run.model, run.begin, run.phonemes, run.counts) for run in found] == [
        ("speech", 0, ((3, 60), (4, 11)), (3, 1)), ("laughter", 4, ((2, 45), (1, 36)), (2, 2))]
    assert runs_of(("speech", 1, 9)) == []


def test_one_run_is_the_reference(models: Dict[str, ExportedModel]) -> None:
    """A part of one model is what the reference makes of it, and a later run its motion on other turns."""
    tables = {word: ExportedTables(model) for word, model in models.items()}
    pushes = tuple(Push("speech", number, 75) for number in (0, 5, 9, 20, 0))
    alone = regenerate.part_motion(tables, Part(pushes, None), np.zeros(13))
    whole = synthesise(tables["speech"], [(push.phoneme, push.milliseconds) for push in pushes])
    assert (alone == delivered(whole, exact=True)).all()
    behind = regenerate.part_motion(tables, Part((Push("laughter", 1, 20), *pushes), None), np.zeros(13))
    assert len(behind) == len(alone) + 1 and 0 < np.abs(behind[9:] - alone[8:]).max() < 60


def test_the_digest_is_the_standard_one() -> None:
    """CRC-32 of the bytes that any language can make of the frames: little-endian, whatever the host."""
    assert digest(np.array([[0x3231, 0x3433, 0x3635, 0x3837]])) == 0x9AE0DAAF  # "12345678"


@pytest.mark.slow
@pytest.mark.parametrize("limits", [{"window": 48}, {"window": 1, "lag": 1}, {"window": 15, "lag": 40},
                                    {"window": 15, "lag": 40, "searched": 64}],
                         ids=lambda limits: "_".join(f"{limit}_{value}" for limit, value in limits.items()))
def test_other_limits_follow_the_reference(
    models: Dict[str, ExportedModel], scripts: List[Script], limits: Dict[str, int]
) -> None:
    """A library that is built for another window, lag or width of the search plays the streams as the reference with
    these does."""
    short = [script for script in scripts if script.name not in ("minutes", "endless")]
    frames = read_frames(library_frames(as_c(scripts, models), **limits))
    assert len(deviations(models, short, frames, **limits).splitlines()) == len(short) + 1
    with pytest.raises(LabialError):
        deviations(models, short, frames)


@needs_runtime
@pytest.mark.parametrize("method", [pytest.param("paper", marks=pytest.mark.slow), "labial"])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 6))])
def test_library_follows_the_reference(method: str, seed: int) -> None:
    """At most one FAP unit anywhere and RMS 0.25: any wrong decision or overflow is far beyond."""
    model = random_model(seed, method, states=50 if seed % 2 else 12)
    exported = quantise(model, "tested_model")
    asked = list(streams(len(model.phonemes), model.boundary, seed).values())
    if seed == 0:
        rng = np.random.default_rng(0)
        asked.append([(int(rng.integers(9)), int(rng.integers(20, 150))) for _ in range(2000)])
    tables = ExportedTables(exported)
    differences = []
    for stream, found in zip(asked, device_frames(exported, asked)):
        expected = delivered(synthesise(tables, stream), exact=True)
        assert found.shape == expected.shape
        difference = found - np.floor(expected + 0.5)
        assert np.abs(difference).max(initial=0) <= 1
        assert np.abs(found - expected).max(initial=0) <= 0.6
        differences.append(difference)
    assert np.sqrt(np.mean(np.concatenate(differences) ** 2)) <= 0.25  # over all: a held pose may lie on a half
