"""Frames of a fixed rate: exact sums, the right moments, no aliasing; the same part by part, in bounded memory."""

from __future__ import annotations

import io
import math
import tracemalloc
from itertools import groupby
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest

from labial.__main__ import main
from labial.corpus import Episode, Segment, resample
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.files.faps import TOUCHING
from labial.files.frames import at_rate, opening, sampled, spans, spans_told
from labial.reference import stream
from labial.reference.fade import delivered
from labial.reference.synthesis import synthesise
from labial.reference.tables import ExportedTables, FloatTables, Tables
from labial.rig.animation import FORMATS, with_shares
from labial.tables.model import load
from labial.tables.phones import drawn_streams
from labial.tables.quantise import quantise
from models import lab


def episode(times, values, segments):
    """All 13 channels carry `values`."""
    return Episode("x", np.asarray(times), np.repeat(np.asarray(values)[:, None], 13, axis=1), tuple(segments))


def test_frames_of_segments_sum_to_the_total_and_round_once():
    """Catches rounding of each duration, which would drift by 7 frames here."""
    segments = [Segment(i * 0.033, (i + 1) * 0.033, "A") for i in range(20)]
    resampled = resample(episode([0.0, 1.0], [0.0, 1.0], segments), 50)
    assert resampled.length.sum() == len(resampled.motion) == 33
    assert abs(np.cumsum(resampled.length) - np.arange(1, 21) * 1.65).max() <= 0.5


def test_motion_is_sampled_at_frame_centres_from_the_first_segment():
    """Catches a shift by half a frame, times counted from the file's zero instead of the first segment's start, and
    extrapolation or NaN where phonemes outlast the motion."""
    resampled = resample(episode([0.0, 2.0], [0.0, 200.0], [Segment(0.5, 1.5, "A")]), 50)
    assert np.allclose(resampled.motion[:, 0], 100 * (0.5 + (np.arange(50) + 0.5) / 50))
    outside = resample(episode([0.2, 0.4], [5.0, 7.0], [Segment(0, 1, "A")]), 50)
    assert outside.motion[0, 0] == 5 and outside.motion[-1, 12] == 7


def test_half_frames_round_up_in_spite_of_binary_fractions():
    """Catches 0.07 s at 50 per second (3.5 frames) that becomes 3 or 4 by the last bit of a product."""
    products = []
    for hundredth in range(200):
        start, end = hundredth / 100, (hundredth + 7) / 100
        resampled = resample(episode([0.0, 9.0], [0.0, 0.0], [Segment(start, end, "A")]), 50)
        products.append((end - start) * 50)
        assert len(resampled.motion) == 4
    assert min(products) < 3.5 <= max(products)  # both sides of the half were tried


def test_short_segments_stay_with_zero_frames():
    """Catches a segment that is dropped, or an apex beyond the last frame."""
    segments = [Segment(0, 0.1, "A", 0.09), Segment(0.1, 0.104, "B"), Segment(0.104, 0.2, "C")]
    segments.append(Segment(0.2, 0.203, "D"))
    resampled = resample(episode([0.0, 1.0], [0.0, 1.0], segments), 50)
    assert resampled.length.tolist() == [5, 0, 5, 0]
    assert resampled.apex.tolist() == [4, 5, 7, 9]
    for nothing in ([], [Segment(0, 0.004, "A")]):
        with pytest.raises(LabialError):
            resample(episode([0.0, 1.0], [0.0, 1.0], nothing), 50)


def test_fast_motion_does_not_fold_back():
    """Catches plain decimation of 120 Hz: a 48 Hz ripple would come out as a slow wave of 2 Hz and full height."""
    times = np.arange(240) / 120
    ripple = resample(episode(times, np.sin(2 * np.pi * 48 * times), [Segment(0, 1.9, "A")]), 50).motion[:, 0]
    slow = resample(episode(times, np.sin(2 * np.pi * 2 * times), [Segment(0, 1.9, "A")]), 50).motion[:, 0]
    assert abs(ripple[2:-2]).max() < 0.1
    centres = (np.arange(95) + 0.5) / 50
    assert abs(slow - np.sin(2 * np.pi * 2 * centres)).max() < 0.01


# ---- Motion that is made, resampled and written part by part ---------------------------------------------------------


Pairs = List[Tuple[int, int]]


@pytest.fixture(scope="module", params=["speech_en", pytest.param("laughter_synthetic", marks=pytest.mark.slow)])
def float_tables(request: pytest.FixtureRequest) -> FloatTables:
    return FloatTables(load(request.param))


def streams(tables: Tables) -> List[Pairs]:
    """All that a cut may fall on: phonemes of no frames at either end and between, pauses longer than a part, several
    pauses in a row, one-frame phonemes, and streams shorter than what the solution looks ahead."""
    rng = np.random.default_rng(5)
    drawn = [(phoneme, 0 if rng.random() < 0.2 else length if rng.random() < 0.8 else 20)
             for phoneme, length in drawn_streams(load("speech_en"), 1, 25, 1)[0] if phoneme < len(tables.phonemes)]
    silence = tables.silence
    return [[(silence, 0)] * 30 + drawn + [(1, 0)] * 10,
            [(silence, 1000), (silence, 500), *drawn[:9], (silence, 1100), (silence, 1000)],
            *([(1, 20 * frames)] for frames in (1, 2, 3, 7, 10, 11))]


def test_motion_is_the_same_in_parts(float_tables: FloatTables) -> None:
    """To the last bit, whatever the parts. Would catch a score, a factor or a neighbour that a cut loses."""
    for tables in (float_tables, ExportedTables(quantise(float_tables.model, "x"))):
        for phonemes in streams(tables):
            whole = stream.synthesise(tables, phonemes)
            for part in (1, 40):
                assert np.array_equal(np.concatenate(list(stream.in_parts(tables, phonemes, part))), whole), part
        assert list(stream.in_parts(tables, [(tables.silence, 0)])) == []


@pytest.mark.slow
def test_memory_does_not_grow_with_the_stream() -> None:
    """Would catch anything that is kept of each frame: twelve times as many take no more memory."""
    tables = FloatTables(load("speech_en"))
    phonemes = drawn_streams(tables.model, 1, 30, 2)[0]

    def peak(times: int) -> int:
        tracemalloc.start()
        for _ in stream.in_parts(tables, phonemes * times, 100):
            pass
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return found

    peak(1)  # what the first use of a library takes
    more = 22 * sum(milliseconds for _, milliseconds in phonemes) // 20  # frames
    assert peak(24) - peak(2) < 0.5 * more * tables.solved.size * 8  # a float64 of each channel in each frame


@pytest.mark.parametrize("wanted", [24, 25, 30, 49, 50, 60, 120])
def test_other_rates_keep_closures_and_the_end(wanted: int) -> None:
    """Lips that touch in any frame touch within that time at every rate, and the face is at rest at the end."""
    motion = delivered(synthesise(load("speech_en"), [
        (SPEECH.phonemes.index(label), length) for label, length in
        [("SIL", 200), ("AA", 150), ("M", 70), ("AA", 180), ("P", 60), ("IY", 90), ("B", 50), ("AW", 230)]]))
    frames = at_rate(motion, 50, wanted)
    assert 0 <= len(frames) / wanted - len(motion) / 50 < 1 / wanted + 1e-9 and np.array_equal(frames[-1], motion[-1])
    assert np.abs(frames[-1]).max() < 0.5
    touching = spans(opening(motion[10:-12]) <= TOUCHING)
    assert len(touching) == 3
    for first, end in touching:
        when = slice(math.floor((first + 10) * wanted / 50), math.ceil((end + 10) * wanted / 50))
        assert opening(frames[when]).min() <= TOUCHING, (first, wanted)
    mean = sampled((np.arange(len(motion)) + 0.5) / 50, motion, wanted, len(frames))
    assert np.abs(frames[: round(0.25 * wanted)] - mean[: round(0.25 * wanted)]).max() < (1e-9 if wanted > 50 else 80)
    assert not len(at_rate(motion[:0], 50, wanted)) and len(at_rate(motion[:1], 50, wanted)) == math.ceil(wanted / 50)


@pytest.mark.slow
def test_files_do_not_show_the_parts(tmp_path: Path) -> None:
    """Would catch a head or a number that begins anew with each part."""
    model = load("speech_en")
    phonemes = drawn_streams(model, 1, 800, 3)[0]
    assert sum(length for _, length in phonemes) * 50 > 1000 * stream.PART  # two parts
    spoken = [(model.phonemes[phoneme], length) for phoneme, length in phonemes]
    (tmp_path / "a.lab").write_text(lab(spoken))
    frames = with_shares(delivered(synthesise(model, phonemes)), spoken, 50)
    for name in ("csv", "fap", "livelink", "vrm"):
        given = [str(tmp_path / "a.lab"), "-o", str(tmp_path / name), "--to", name]
        assert main(["synth", "speech_en", *given]) == 0
        text = io.StringIO()
        FORMATS[name].write(text, [frames], 50, "speech_en", len(frames))
        same = (tmp_path / name).read_text() == text.getvalue()
        assert same, name  # a difference of two long texts takes minutes to be shown


def test_spans_are_the_stretches() -> None:
    """Would catch a stretch at either end that is lost, one that is a frame too long, against itertools, one that is
    told until the frame after it, and stretches that are left out without a word."""
    rng = np.random.default_rng(1)
    for _ in range(300):
        holds = rng.random(rng.integers(0, 12)) < rng.random()
        expected = [list(group) for held, group in groupby(range(len(holds)), key=lambda t: bool(holds[t])) if held]
        assert spans(holds) == [(group[0], group[-1] + 1) for group in expected]
    told, times = np.array([1, 1, 0, 1, 0, 0, 1, 1], dtype=bool), np.arange(8) / 10
    assert spans_told(times, told, 3) == "0.00 to 0.10, 0.30 to 0.30, 0.60 to 0.70 s"
    assert spans_told(times, told, 1) == "0.00 to 0.10 s and 2 times more"
