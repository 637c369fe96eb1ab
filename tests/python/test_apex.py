"""The apex of a phoneme, from the envelope of its sound: by itself, in `labial record` and in the reader of IEMOCAP."""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
import pytest

from labial.capture.landmarks import Given
from labial.capture.record import record
from labial.corpus import Segment, read_corpus
from labial.corpus.apex import STEP, WINDOW, envelope, read_wave, with_apexes
from labial.corpus.iemocap import read_iemocap
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError
from labial.train import without_apex
from test_corpora import PHSEG, face
from test_corpora import write as write_utterance
from test_record import talking
from test_record import write as write_landmarks

RATE = 16000


def sound(*loud: float, seconds: float = 3.0) -> np.ndarray:
    """A tone that swells within 60 ms around each of the moments `loud`, over a faint one."""
    times = np.arange(int(seconds * RATE)) / RATE
    swell = sum(np.exp(-(((times - moment) / 0.02) ** 2)) for moment in loud)
    return (0.02 + swell) * np.sin(2 * np.pi * 150 * times)


def save(path: Path, samples: np.ndarray, channels: int = 1, width: int = 2) -> Path:
    with wave.open(str(path), "wb") as out:
        out.setnchannels(channels)
        out.setsampwidth(width)
        out.setframerate(RATE)
        out.writeframes(np.repeat(np.rint(samples / 1.1 * 32767 * 256 ** (width - 2)), channels)
                        .astype({1: "u1", 2: "<i2", 4: "<i4"}[width]).tobytes())
    return path


def test_the_envelope_is_the_moving_root_mean_square() -> None:
    """Against the definition, sample by sample; would catch a window that is shifted, or not divided by its sum."""
    samples = np.random.default_rng(1).normal(0, 1, 2000)
    found = envelope(samples, RATE)
    half = round(WINDOW * RATE) // 2
    window = np.hanning(2 * half + 2)[1:-1]
    for i in range(len(found)):
        at = round(i * STEP * RATE)
        square = [samples[at + j] ** 2 * window[j + half] for j in range(-half, half) if 0 <= at + j < len(samples)]
        assert found[i] == pytest.approx(np.sqrt(np.sum(square) / window.sum()), rel=0.02)
    assert len(found) == 25


def test_the_loudest_moment_of_each_segment_is_its_apex() -> None:
    """Within its own bounds; what has an apex keeps it; where nothing sounds, or nothing changes, there is none."""
    segments = (Segment(0.0, 0.5, "SIL"), Segment(0.5, 0.8, "AA"), Segment(0.8, 1.0, "P", 0.9), Segment(1.0, 1.5, "IY"),
                Segment(1.5, 1.501, "T"), Segment(2.5, 4.0, "SIL"), Segment(4.0, 5.0, "K"))
    samples = sound(0.6, 1.02)
    samples[int(2.5 * RATE):] = 0.0
    found = [segment.apex for segment in with_apexes(segments, samples, RATE)]
    assert found[1] == pytest.approx(0.6, abs=0.0051) and found[2] == 0.9
    assert found[3] == pytest.approx(1.02, abs=0.0051)
    assert found[5] == pytest.approx(2.5, abs=WINDOW) and found[6] is None
    assert with_apexes(segments[:1], np.zeros(RATE), RATE) == segments[:1]


@pytest.mark.parametrize("channels", [1, 2])
def test_waves_are_read(tmp_path: Path, channels: int) -> None:
    samples, rate = read_wave(save(tmp_path / "a.wav", sound(0.5), channels))
    assert rate == RATE and np.abs(samples / 32767 * 1.1 - sound(0.5)).max() < 1e-3


def test_waves_that_cannot_be_read_name_the_file(tmp_path: Path) -> None:
    path = save(tmp_path / "a.wav", sound(0.5), width=4)
    for content, message in ((path.read_bytes(), "32 bits"), (b"RIFF", "not a WAV file"), (b"", "not a WAV file")):
        path.write_bytes(content)
        with pytest.raises(DataError, match=f"a.wav: .*{message}"):
            read_wave(path)
    with pytest.raises(DataError, match="missing.wav: No such file"):
        read_wave(tmp_path / "missing.wav")


def test_record_takes_the_apex_from_the_sound_beside(tmp_path: Path) -> None:
    """A sound of the recording's name; without one the middle is taken, and the summary says so."""
    points, _ = talking()
    lab = "0 1 SIL\n1 1.4 AA\n1.4 1.5 P\n1.5 2 IY\n2 3 SIL\n"
    path = write_landmarks(tmp_path / "in", landmarks=points, lab=lab)
    summary = record([path], tmp_path / "without", SPEECH, Given(), 12.0)
    assert "apex: the loudest moment of 0 of 5 phonemes; of the others, whose sound is not known, the middle" in summary
    (episode,) = read_corpus(tmp_path / "without")
    assert without_apex([episode]) == ["apex: not known of 5 of 5 phonemes, which are learnt from their middle"]
    save(tmp_path / "in" / "a.wav", sound(1.1, 1.9))
    summary = record([path], tmp_path / "with", SPEECH, Given(), 12.0)
    assert "apex: the loudest moment of 5 of 5 phonemes" in summary and "not known" not in summary
    (episode,) = read_corpus(tmp_path / "with")
    assert episode.segments[1].apex == pytest.approx(1.1, abs=0.0051)
    assert episode.segments[3].apex == pytest.approx(1.9, abs=0.0051)
    assert without_apex([episode]) == []


def test_iemocap_takes_the_apex_from_its_sounds(tmp_path: Path) -> None:
    """The utterance's own; one without a sound has none."""
    for utterance in ("Ses01F_impro01_F000", "Ses01F_impro01_F001"):
        write_utterance(tmp_path, utterance, face([]), PHSEG)
    folder = tmp_path / "Session1" / "sentences" / "wav" / "Ses01F_impro01"
    folder.mkdir(parents=True)
    save(folder / "Ses01F_impro01_F000.wav", sound(1.3, seconds=2.0))
    first, second = read_iemocap(tmp_path)
    assert first.segments[1].label == "AA" and first.segments[1].apex == pytest.approx(1.3, abs=0.0051)
    assert [segment.apex for segment in second.segments] == [None] * len(second.segments)
