"""Distortions of sounds and of their log energies: what each changes, and what it leaves."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("soxr")

from labial.hearing import distort  # noqa: E402
from labial.hearing.features import BANDS, FLOOR, RATE, log_energies, triangles  # noqa: E402


def tone(frequency: float, seconds: float = 1.0) -> np.ndarray:
    return (0.5 * np.sin(2 * np.pi * frequency * np.arange(round(seconds * RATE)) / RATE)).astype(np.float32)


def noise(seconds: float = 2.0, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(scale=0.1, size=round(seconds * RATE)).astype(np.float32)


def loudest(sound: np.ndarray) -> float:
    """Hz of the largest line of the spectrum."""
    return float(np.argmax(np.abs(np.fft.rfft(sound))) * RATE / len(sound))


def test_speed_changes_length_and_pitch() -> None:
    found = distort.resampled(tone(440.0), 1.1)
    assert len(found) == round(RATE / 1.1) and loudest(found) == pytest.approx(484.0, abs=2)
    assert distort.rms(found) == pytest.approx(distort.rms(tone(440.0)), rel=0.02)


def test_levels_and_offsets() -> None:
    """Peaks in dB of full scale, rounded to whole numbers; silence stays silence; too large an offset is held."""
    found = distort.as_integers(tone(440.0), -40.0)
    assert found.dtype == np.int16 and np.abs(found).max() == 328
    assert distort.as_integers(tone(440.0), -40.0, 0.5).mean() == pytest.approx(164, abs=1)
    assert not distort.as_integers(np.zeros(10, np.float32), 0.0).any()
    assert distort.as_integers(tone(440.0), 0.0, 0.3).max() == 32767


def test_a_channel_passes_its_band() -> None:
    """24 dB an octave outside, 3 dB at its edges, all of the middle."""
    for frequency, level in ((1000.0, 0.0), (300.0, -3.0), (150.0, -24.0), (3400.0, -3.0), (6800.0, -24.0)):
        found = distort.rms(distort.limited(tone(frequency), 300.0, 3400.0)) / distort.rms(tone(frequency))
        assert 20 * np.log10(found) == pytest.approx(level, abs=0.5)


def test_a_room_rings_after_the_sound() -> None:
    """A click is followed by noise that falls by 60 dB in the decay, of the click's energy."""
    click = np.zeros(RATE, np.float32)
    click[1000] = 1.0
    found = distort.reverberated(click, 0.5, 1.0, np.random.default_rng(0))
    assert found[1000] == pytest.approx(1.0, abs=1e-4) and not np.abs(found[:1000]).max() > 1e-5
    tail = found[1001:]
    assert np.sum(tail**2) == pytest.approx(1.0, rel=0.01) and np.abs(tail[8100:]).max() < 1e-5
    level = [10 * np.log10(np.mean(tail[a : a + 800] ** 2)) for a in (400, 4400)]
    assert level[0] - level[1] == pytest.approx(30.0, abs=1.5)  # a quarter of a second of the half


def test_clipping_and_companding() -> None:
    """The share that is cut off; 8 bits of mu-law leave 37 to 39 dB at any level down to -30 dB."""
    found = distort.clipped(noise(), 0.05)
    assert (np.abs(found) >= np.abs(found).max() - 1e-6).mean() == pytest.approx(0.05, abs=0.002)
    for scale in (1.0, 0.03):
        given = noise() / np.abs(noise()).max() * scale
        error = distort.companded(given) - given
        assert 34 < 20 * np.log10(distort.rms(given) / distort.rms(error)) < 41


def test_rumble_is_low() -> None:
    spectrum = np.abs(np.fft.rfft(distort.rumbling(RATE, np.random.default_rng(3)))) ** 2
    assert spectrum[:400].sum() > 0.95 * spectrum.sum()


def test_drawn_distortions_cover_their_ranges() -> None:
    """Half of the sounds keep room and channel; levels and speeds fill their ranges; the same seed draws the same."""
    random = np.random.default_rng(0)
    every = [distort.drawn(random) for _ in range(2000)]
    again = np.random.default_rng(0)
    assert [distort.drawn(again) for _ in range(5)] == every[:5]
    plain = [item for item in every if not (item.decay or item.band or item.rumble or item.clip or item.companded
                                            or item.offset)]
    assert 0.5 < len(plain) / len(every) < 0.65
    peaks, speeds = (np.array([getattr(item, name) for item in every]) for name in ("peak", "speed"))
    assert -45 <= peaks.min() < -44 and -1 < peaks.max() <= 0 and 0.25 < (speeds == 1.0).mean() < 0.35
    assert 0.85 <= speeds.min() < 0.86 and 1.19 < speeds.max() <= 1.2
    for item in (every[0], distort.Distortion(1.1, 0.2, 1.0, (200.0, 4000.0), 0.5, 0.05, companded=True, peak=-20.0,
                                                   offset=0.1)):
        found = distort.distorted(noise(0.5), item, np.random.default_rng(1))
        assert found.dtype == np.int16 and len(found) == round(8000 / item.speed)


# ---- Log energies


def test_noise_has_the_bands_of_noise() -> None:
    """Of white noise the bands have energies in proportion to their triangles; all together have a mean of 1."""
    found = np.exp2(distort.white(60.0, np.random.default_rng(0))).mean(axis=0)
    shares = triangles().sum(axis=0)
    assert found == pytest.approx(shares / shares.mean(), rel=0.05)


def test_noise_is_mixed_at_its_ratio() -> None:
    """Against sounds that are mixed before their energies are taken: the same but for what sound and noise add to each
    other at random, most in the narrow low bands; and any level of the noise counts the same."""
    speech, hiss = 3000 * noise(2.0), 3000 * noise(2.0, 1)
    swell = np.repeat([0.05, 1.0, 0.2, 1.0], RATE // 2).astype(np.float32)
    given, added = (log_energies(item)[None, 2:] for item in (speech * swell, hiss))
    ratio = 10.0
    scale = distort.rms(speech * swell) / distort.rms(hiss) * 10 ** (-ratio / 20)
    true = log_energies(speech * swell + scale * hiss)[2:]
    found = distort.mixed(given, added - 5.0, np.array([ratio]))[0]
    assert np.abs((found - true).mean(axis=0)).max() < 0.25
    assert np.abs((found - true).reshape(4, -1).mean(axis=1)).max() < 0.2


def test_bands_are_warped_linearly() -> None:
    """Band k has what was in band 1.1 k; a factor of 1 changes nothing."""
    ramp = np.tile(np.arange(BANDS, dtype=np.float32), (2, 3, 1))
    found = distort.warped(ramp, np.array([1.0, 1.1]))
    assert found[0] == pytest.approx(ramp[0], abs=1e-5)
    assert found[1, 0] == pytest.approx(np.minimum(1.1 * np.arange(BANDS), BANDS - 1), abs=1e-4)


def test_augmented_energies() -> None:
    """Shapes and the floor; digital silence stays where no noise comes; most crops have noise in it; the same seed
    gives the same; the level of speech strays to both sides."""
    pool = distort.white(30.0, np.random.default_rng(0))
    given = np.full((400, 60, BANDS), FLOOR, np.float32)
    given[:, 20:] = 16.0
    found = distort.augmented(given, pool, np.random.default_rng(1))
    assert found.shape == given.shape and found.dtype == np.float32 and found.min() == FLOOR
    assert np.array_equal(found, distort.augmented(given, pool, np.random.default_rng(1)))
    silent = (found[:, :20] == FLOOR).all(axis=(1, 2))
    assert 1 - distort.NOISY < silent.mean() + 0.02 and silent.mean() < 1 - distort.NOISY + 0.06
    moved = np.median(found[:, 20:], axis=(1, 2)) - 16.0
    assert 1.3 < moved.std() < 3.5 and abs(moved.mean()) < 0.6
