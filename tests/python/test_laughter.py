"""Laughs: the synthetic corpus with its published timings, and laughs of a wanted length."""

from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np
import pytest

from labial.corpus import laughter, read_corpus
from labial.corpus.laughter import generate
from labial.corpus.phonesets import LAUGHTER, LAUGHTER_GRADES
from labial.errors import DataError
from labial.files.faps import FAP_NUMBERS
from labial.reference.laughs import pieces, table_header
from packages import SOURCE

CHANNEL = {number: index for index, number in enumerate(FAP_NUMBERS)}
ONSETS = [label for label, starts in zip(LAUGHTER.phonemes, LAUGHTER.boundary) if starts]  # of every grade


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The corpus at its full size."""
    path = tmp_path_factory.mktemp("laughter") / "corpus"
    generate(path)
    return path


@pytest.fixture(scope="module")
def episodes(folder):
    """Its episodes, as the trainer reads them."""
    return read_corpus(folder, "laughter")


def trains(episode):
    """Lists of pulse onsets in seconds: vowels and cackles that begin within 0.35 s of each other."""
    result = [[]]
    for segment in episode.segments:
        if segment.label in ONSETS:
            if result[-1] and segment.start - result[-1][-1] > 0.35:
                result.append([])
            result[-1].append(segment.start)
    return [train for train in result if train]


@pytest.mark.slow
def test_every_phoneme_occurs_often_enough_to_train(episodes):
    """Catches a phoneme that the generator all but forgets."""
    counts = defaultdict(int)
    for episode in episodes:
        for segment in episode.segments:
            counts[segment.label] += 1
    assert len(episodes) == 200 and set(counts) == set(LAUGHTER.phonemes) and min(counts.values()) >= 25


@pytest.mark.parametrize("label, low, high", [
    ("a", 80, 116), ("e", 80, 104), ("fricative", 120, 120), ("ic", 80, 80), ("cackle", 48, 48), ("nasal", 80, 80),
    ("ne", 240, 240), ("silence", 160, 220), ("click", 40, 40), ("plosive", 40, 40),
])  # fmt: skip
def test_median_durations_are_the_published_ones(episodes, label, low, high):
    """Catches durations that drift when a pulse's parts are fitted into its period."""
    grades = (label, *LAUGHTER_GRADES.get(label, ()))
    durations = [1000 * s.duration for e in episodes for s in e.segments if s.label in grades]
    assert 0.85 * low <= np.median(durations) <= 1.15 * high


def test_pulses_and_trains_have_the_published_rhythm(episodes):
    """Catches trains that are too slow, too regular or too long, and laughs without pauses."""
    groups = [train for episode in episodes for train in trains(episode)]
    intervals = 1000 * np.concatenate([np.diff(train) for train in groups])
    assert 195 <= np.median(intervals) <= 225 and 15 <= np.percentile(intervals, 84) - np.median(intervals) <= 50
    lengths = [len(train) for train in groups]
    assert np.median(lengths) == 3 and 10 <= max(lengths)
    quiet = sum(s.duration for e in episodes for s in e.segments
                if s.label in ("silence", "ne", "fricative", *LAUGHTER_GRADES["fricative"]))
    assert quiet > 0.5 * sum(e.segments[-1].end for e in episodes)


def test_rare_but_published_sequences_occur(episodes):
    """Catches a corpus of regular laughs only: real ones have one-frame phonemes, repeats and silences of seconds."""
    durations = [s.duration for e in episodes for s in e.segments]
    assert min(durations) <= 0.02 and max(durations) > 4
    assert any(a.label == b.label != "silence" for e in episodes for a, b in zip(e.segments, e.segments[1:]))


def test_segments_tile_and_motion_covers_them(episodes):
    """Catches rounding that leaves gaps, apexes outside of their phonemes, motion of another length."""
    for episode in episodes:
        assert episode.segments[0].start == 0
        assert all(a.end == b.start for a, b in zip(episode.segments, episode.segments[1:]))
        assert all(s.start <= s.apex <= s.end for s in episode.segments)
        assert abs(len(episode.times) / 50 - episode.segments[-1].end) <= 0.011


def test_jaw_beats_with_the_pulses(episodes):
    """Catches a jaw that does not open for vowels, lags behind them, or stays open in silence."""
    opened, closed, lags = [], [], []
    for episode in episodes:
        jaw = episode.frames[:, CHANNEL[3]]
        for segment in episode.segments:
            middle = (segment.start + segment.end) / 2
            if segment.label == "a":
                near = np.flatnonzero(abs(episode.times - middle) < 0.08)
                opened.append(jaw[near].max())
                lags.append(episode.times[near[np.argmax(jaw[near])]] - middle)
            elif segment.label == "silence" and segment.duration > 0.3:
                closed.append(np.interp(middle, episode.times, jaw))
    assert np.median(opened) > 100 and np.median(closed) < 0.25 * np.median(opened) and abs(np.median(lags)) < 0.02


def test_faces_are_plausible(episodes):
    """Catches lips that cross, corners that a laugh pulls down or together, faces that lean, jumps and noise."""
    frames = np.concatenate([e.frames for e in episodes])
    jaw, openness = frames[:, CHANNEL[3]], -(frames[:, CHANNEL[51]] + frames[:, CHANNEL[52]])
    assert openness.min() > -10 and jaw.min() > -6 and np.percentile(jaw, 99) < 500 and openness.max() < 720
    slope = np.polyfit(jaw, frames[:, CHANNEL[52]], 1)[0]
    assert -1.1 < slope < -0.7
    start = np.stack([e.frames[:3].mean(axis=0) for e in episodes])
    assert abs(np.median(start, axis=0)).max() < 15
    for left, right in ((53, 54), (55, 56), (57, 58), (59, 60)):
        a, b = frames[:, CHANNEL[left]], frames[:, CHANNEL[right]]
        assert np.corrcoef(a, b)[0, 1] > 0.95 and 0 < np.std(a - b) < 12
    assert np.median(frames[:, CHANNEL[53]]) > 30 and np.median(frames[:, CHANNEL[59]]) > 40
    assert np.percentile(frames[:, CHANNEL[51]], 10) < -40
    for episode in episodes:
        assert abs(np.diff(episode.frames, axis=0)).max() < 200  # FAP 3: 30 cm/s, as fast as jaws are


def test_the_smile_grows_with_intensity_and_outlasts_the_pulses(episodes):
    """Catches a smile that is constant, or that ends with the voice, or never."""
    loud, smile, after = [], [], []
    for episode in episodes:
        voiced = [s for s in episode.segments if s.label in ONSETS]
        inside = (episode.times > voiced[0].start) & (episode.times < voiced[-1].end)
        loud.append(np.percentile(episode.frames[inside, CHANNEL[3]], 95))
        smile.append(episode.frames[inside, CHANNEL[59]].mean())
        ends = np.interp(voiced[-1].end + np.array([0.1, 1.1]), episode.times, episode.frames[:, CHANNEL[59]])
        if voiced[-1].end + 1.1 < episode.times[-1]:
            after.append(ends[1] / ends[0])
    assert np.corrcoef(loud, smile)[0, 1] > 0.6
    assert len(after) > 100 and 0.7 < np.median(after) < 0.95  # what a second of the slow decay leaves


def test_same_seed_same_bytes_and_no_mixing(tmp_path):
    """Catches unseeded randomness, output that depends on the number of episodes, two runs in one folder, and "-0.00",
    which other platforms' rounding may write as "0.00"."""
    for name, count, seed in (("a", 5, 7), ("b", 5, 7), ("c", 3, 7), ("d", 5, 8)):
        generate(tmp_path / name, count, seed)

    def content(name):
        return {p.name: p.read_bytes() for p in (tmp_path / name).iterdir() if p.suffix != ".md"}

    assert content("a") == content("b") and content("c").items() <= content("a").items()
    assert content("a")["laugh0000.csv"] != content("d")["laugh0000.csv"]
    assert not any(b",-0.00" in data for data in content("a").values())
    assert "synthetic" in (tmp_path / "a" / "README.md").read_text().lower()
    with pytest.raises(DataError, match="not empty"):
        generate(tmp_path / "a", 5, 7)


# ---- Laughs of a wanted length ---------------------------------------------------------------------------------------


def test_the_table_is_the_corpus() -> None:
    """Catches statistics that were changed in the corpus and not on the device: run
    python -m labial.reference.laughs then."""
    assert (SOURCE / "lib/laugh_table.h").read_text(encoding="ascii") == table_header()


def test_statistics_are_those_of_the_corpus() -> None:
    """Catches a grammar that drifted from the corpus: at half intensity phonemes have its medians and, within a
    quarter, its frequencies; pulses follow each other every 210 ms; most of a laugh is silence or breath."""
    rng = np.random.Generator(np.random.PCG64(3))
    corpus = [item for _ in range(150) for item in laughter._bout(rng)[0][1:-1]]
    # Intensities of the corpus are 0 to 1, half in the mean; the number of trains, not their making, depends on it.
    laughs = [item for seed in range(60) for item in pieces(20000, 128, seed)]
    laughs = [(label.split("_")[0], ms) for label, ms in laughs]  # whatever their grade
    corpus = [(label.split("_")[0], ms) for label, ms, _ in corpus]
    ours, theirs = Counter(label for label, _ in laughs), Counter(label for label, _ in corpus)
    for label in LAUGHTER.phonemes[:12]:
        share, expected = ours[label] / len(laughs), theirs[label] / len(corpus)
        assert share == pytest.approx(expected, rel=0.25, abs=0.01), label
        median = np.median([ms for name, ms in laughs if name == label])
        assert median == pytest.approx(np.median([ms for name, ms in corpus if name == label]), rel=0.12), label
    total = sum(ms for _, ms in laughs)
    assert sum(ms for label, ms in laughs if label in ("silence", "fricative", "ne")) > 0.5 * total
    onsets, at = [], 0
    for label, ms in laughs:
        if label in (*laughter.VOWELS, "cackle", "nasal"):
            onsets.append(at)
        at += ms
    gaps = np.diff(onsets)
    assert np.median(gaps[gaps < 300]) == pytest.approx(210, abs=10)


def grade(label: str) -> int:
    return {"soft": 0, "loud": 2}.get(label.split("_")[-1], 1)
