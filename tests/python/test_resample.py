"""Frames of a fixed rate: exact sums, the right moments, no aliasing."""

from __future__ import annotations

import numpy as np
import pytest

from labial.corpus import Episode, Segment, resample
from labial.errors import LabialError


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
    """Catches a shift by half a frame, or times counted from the file's zero instead of the first segment's start."""
    resampled = resample(episode([0.0, 2.0], [0.0, 200.0], [Segment(0.5, 1.5, "A")]), 50)
    assert np.allclose(resampled.motion[:, 0], 100 * (0.5 + (np.arange(50) + 0.5) / 50))


def test_values_outside_the_recording_are_held():
    """Catches extrapolation or NaN where phonemes outlast the motion."""
    resampled = resample(episode([0.2, 0.4], [5.0, 7.0], [Segment(0, 1, "A")]), 50)
    assert resampled.motion[0, 0] == 5 and resampled.motion[-1, 12] == 7


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


def test_fast_motion_does_not_fold_back():
    """Catches plain decimation of 120 Hz: a 48 Hz ripple would come out as a slow wave of 2 Hz and full height."""
    times = np.arange(240) / 120
    ripple = resample(episode(times, np.sin(2 * np.pi * 48 * times), [Segment(0, 1.9, "A")]), 50).motion[:, 0]
    slow = resample(episode(times, np.sin(2 * np.pi * 2 * times), [Segment(0, 1.9, "A")]), 50).motion[:, 0]
    assert abs(ripple[2:-2]).max() < 0.1
    centres = (np.arange(95) + 0.5) / 50
    assert abs(slow - np.sin(2 * np.pi * 2 * centres)).max() < 0.01


def test_what_has_no_frames_is_refused():
    """Catches a division by zero or an empty array further on."""
    for segments in ([], [Segment(0, 0.004, "A")]):
        with pytest.raises(LabialError):
            resample(episode([0.0, 1.0], [0.0, 1.0], segments), 50)
