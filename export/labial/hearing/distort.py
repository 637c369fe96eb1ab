"""Distortions with a seed: what voices, rooms, channels and noise do to speech before it is heard.

Sounds are (N,) float32 at 16 kHz in which full scale is 1, results are of the same length unless a function says
otherwise. What can be done to energies of bands is done there, anew in each batch: other voices, channels and noise
(:func:`augmented`); these arrays are (B, n, 24), log2 energies as of :func:`labial.hearing.features.log_energies`.
"""

from __future__ import annotations

import io
from typing import Dict, NamedTuple, Optional, Tuple

import numpy as np

from labial.hearing.features import BANDS, FLOOR, HIGHEST, LOWEST, RATE, log_energies, mel

#: Peaks of a sound in dB of full scale, from the quietest to the loudest.
PEAKS = (-45.0, 0.0)
#: How many times as fast a sound is.
SPEEDS = (0.85, 1.2)
#: Codecs of telephones, radios, calls and the web, as libsndfile has them: format, subtype, samples per second, and how
#: hard it compresses, 0 .. 1.
CODECS: Dict[str, Tuple[str, str, int, float]] = {
    "gsm": ("WAV", "GSM610", 8000, 0.0), "adpcm": ("WAV", "IMA_ADPCM", 16000, 0.0),
    "g726": ("AU", "G723_24", 8000, 0.0), "opus": ("OGG", "OPUS", 16000, 1.0),
    "vorbis": ("OGG", "VORBIS", 16000, 1.0), "mp3": ("MP3", "MPEG_LAYER_III", 16000, 0.95),
}
#: Share of the crops whose bands are warped, from and to which factor: voices of other sizes.
WARPED, WARPS = 0.6, (0.87, 1.15)
#: Share of the crops under noise, and its ratio to the speech, dB.
NOISY, RATIOS = 0.85, (0.0, 48.0)
#: Share of the crops of which a few bands, or all above some band, are missing.
DROPPED, CUT = 0.25, 0.1
#: Octaves of level in the three waves of a random equaliser, and of gain.
_EQUALISER, _GAIN = 1.2, 2.0
#: Mels of the bands' peaks, and their octaves relative to the lowest.
_PEAKS = np.linspace(mel(np.array(LOWEST)), mel(np.array(HIGHEST)), BANDS + 2)[1:-1]
_OCTAVES = np.log2(700.0 * np.expm1(_PEAKS / 1127.0) / (700.0 * np.expm1(_PEAKS[0] / 1127.0)))


class Distortion(NamedTuple):
    """What is done to a sound, in this order."""

    speed: float = 1.0  #: times as fast, and as high
    decay: float = 0.0  #: seconds until the reverberation has fallen by 60 dB; 0 without
    dry: float = 1.0  #: amplitude of the direct sound relative to that of the reverberation
    band: Optional[Tuple[float, float]] = None  #: Hz that a channel passes
    rumble: float = 0.0  #: amplitude of hum and rumble relative to the sound's RMS
    clip: float = 0.0  #: share of the samples that are cut off
    echo: Tuple[float, float] = (0.0, 0.0)  #: seconds until a near surface's reflection comes, and its amplitude
    evening: float = 0.0  #: how much a microphone's automatic gain evens out the level, 0 .. 1
    companded: bool = False  #: 8 bits by mu-law
    codec: str = ""  #: of `CODECS`
    peak: float = -6.0  #: dB of full scale
    offset: float = 0.0  #: of all samples, relative to the peak


def drawn(random: np.random.Generator) -> Distortion:
    """A random distortion: half of the sounds lose nothing but level and speed."""
    speed = float(np.exp(random.uniform(*np.log(SPEEDS)))) if random.random() < 0.7 else 1.0
    peak = float(random.uniform(*PEAKS))
    if random.random() < 0.5:
        return Distortion(speed=speed, peak=peak)
    kind = random.random(9)
    return Distortion(speed=speed, peak=peak, decay=float(random.uniform(0.1, 0.6)) if kind[0] < 0.45 else 0.0,
                      dry=float(random.uniform(0.7, 2.5)),
                      band=tuple(random.uniform((50, 3300), (350, 7000)).tolist()) if kind[1] < 0.4 else None,
                      rumble=float(np.exp(random.uniform(*np.log((0.02, 1.5))))) if kind[2] < 0.25 else 0.0,
                      clip=float(random.uniform(0.005, 0.08)) if kind[3] < 0.2 else 0.0, companded=bool(kind[4] < 0.25),
                      offset=float(random.uniform(-0.3, 0.3)) if kind[5] < 0.2 else 0.0,
                      echo=tuple(random.uniform((0.0004, 0.2), (0.008, 0.8)).tolist()) if kind[6] < 0.3 else (0.0, 0.0),
                      evening=float(random.uniform(0.2, 0.7)) if kind[7] < 0.25 else 0.0,
                      codec=str(random.choice(list(CODECS))) if kind[8] < 0.35 else "")


def distorted(samples: np.ndarray, distortion: Distortion, random: np.random.Generator) -> np.ndarray:
    """(M,) int16: `samples` after all of a distortion; M is N / speed, rounded."""
    sound: np.ndarray = np.asarray(samples, dtype=np.float32)
    if distortion.speed != 1.0:
        sound = resampled(sound, distortion.speed)
    if distortion.decay > 0:
        sound = reverberated(sound, distortion.decay, distortion.dry, random)
    if distortion.echo[1] > 0:
        sound = echoed(sound, *distortion.echo)
    if distortion.band is not None:
        sound = limited(sound, *distortion.band)
    if distortion.rumble > 0:
        sound = sound + distortion.rumble * rms(sound) * rumbling(len(sound), random)
    if distortion.evening > 0:
        sound = evened(sound, distortion.evening)
    if distortion.clip > 0:
        sound = clipped(sound, distortion.clip)
    if distortion.companded:
        sound = companded(sound / max(_peak(sound), 1e-9))
    if distortion.codec:
        sound = coded(sound / max(_peak(sound), 1e-9), *CODECS[distortion.codec])
    return as_integers(sound, distortion.peak, distortion.offset)


def rms(sound: np.ndarray) -> float:
    """The root of the mean square; 0 for no samples."""
    return float(np.sqrt(np.mean(np.square(sound)))) if len(sound) else 0.0


def _peak(sound: np.ndarray) -> float:
    return float(np.abs(sound).max(initial=0.0))


def as_integers(sound: np.ndarray, peak: float, offset: float = 0.0) -> np.ndarray:
    """int16 of a sound whose peak becomes `peak` dB of full scale, with `offset`, relative to the peak, added."""
    most = _peak(sound)
    gain = 32767.0 * 10 ** (peak / 20) / most if most > 0 else 0.0
    scaled = sound * gain + 32767.0 * 10 ** (peak / 20) * offset
    return np.clip(np.round(scaled), -32768, 32767).astype(np.int16)


def resampled(sound: np.ndarray, speed: float) -> np.ndarray:
    """(N / speed,) the sound at another speed, and so at another pitch."""
    import soxr

    count = max(round(len(sound) / speed), 1)
    found = soxr.resample(sound, RATE * speed, RATE)[:count]
    return np.pad(found, (0, count - len(found))).astype(np.float32)


def reverberated(sound: np.ndarray, decay: float, dry: float, random: np.random.Generator) -> np.ndarray:
    """A sound in a room whose reverberation falls by 60 dB in `decay` seconds: noise that decays, of the energy of the
    direct sound divided by `dry` squared."""
    count = max(round(decay * RATE), 2)
    tail = random.normal(size=count) * 10 ** (-3 * np.arange(count) / count)
    tail[: RATE // 400] = 0.0
    tail /= np.sqrt(np.sum(np.square(tail))) * dry
    tail[0] = 1.0
    size = 1 << (len(sound) + count - 1).bit_length()
    return np.fft.irfft(np.fft.rfft(sound, size) * np.fft.rfft(tail, size), size)[: len(sound)].astype(np.float32)


def limited(sound: np.ndarray, low: float, high: float) -> np.ndarray:
    """A sound through a channel that passes `low` to `high` Hz and falls by 24 dB an octave outside."""
    spectrum = np.fft.rfft(sound)
    frequency = np.maximum(np.arange(len(spectrum)) * RATE / max(len(sound), 1), 1e-3)
    gain = 1 / np.sqrt((1 + (low / frequency) ** 8) * (1 + (frequency / high) ** 8))
    return np.fft.irfft(spectrum * gain, len(sound)).astype(np.float32)


def rumbling(count: int, random: np.random.Generator) -> np.ndarray:
    """(`count`,) hum of the mains with its harmonics and noise below 250 Hz, RMS 1."""
    time = np.arange(count) / RATE
    mains = 50.0 if random.random() < 0.5 else 60.0
    hum = sum(random.uniform(0, 1) / k * np.sin(2 * np.pi * (k * mains * time + random.random())) for k in range(1, 7))
    noise = limited(random.normal(size=count).astype(np.float32), 20.0, 200.0)
    mixed = hum * random.random() + noise * (random.random() + 0.1) / max(rms(noise), 1e-9)
    return (mixed / max(rms(mixed), 1e-9)).astype(np.float32)


def clipped(sound: np.ndarray, share: float) -> np.ndarray:
    """A sound of which the loudest `share` of the samples are cut off."""
    limit = float(np.quantile(np.abs(sound), 1 - share)) if len(sound) else 0.0
    return np.clip(sound, -limit, limit)


def echoed(sound: np.ndarray, delay: float, amplitude: float) -> np.ndarray:
    """A sound with its reflection from a near surface, such as a table's, which reaches the microphone `delay` seconds
    later: it dips at regular distances in frequency."""
    samples = max(round(delay * RATE), 1)
    result: np.ndarray = np.asarray(sound, dtype=np.float32).copy()
    result[samples:] += np.float32(amplitude) * sound[: len(sound) - samples]
    return result


def evened(sound: np.ndarray, strength: float) -> np.ndarray:
    """A sound as an automatic gain leaves it: its level, over 50 ms, goes `strength` of the way to the loudest."""
    steps = max(len(sound) * 20 // RATE, 1)
    power = np.array([np.mean(np.square(part)) for part in np.array_split(sound, steps)])
    level = np.maximum(np.sqrt(power), 1e-3 * np.sqrt(power.max(initial=0.0)) + 1e-9)
    gain = (level.max() / level) ** strength
    at = np.interp(np.arange(len(sound)), (np.arange(steps) + 0.5) * len(sound) / steps, gain)
    return (sound * at).astype(np.float32)


def coded(sound: np.ndarray, form: str, subtype: str, rate: int, compression: float) -> np.ndarray:
    """A sound within -1 .. 1 through a codec of :data:`CODECS` and back, without the codec's delay."""
    import soundfile
    import soxr

    given = np.clip(sound if rate == RATE else soxr.resample(sound, RATE, rate), -1, 1).astype(np.float32)
    file = io.BytesIO()
    more = {"compression_level": compression} if compression > 0 else {}
    soundfile.write(file, given, rate, format=form, subtype=subtype, **more)
    file.seek(0)
    found = soundfile.read(file, dtype="float32")[0]
    if len(found) != len(given):  # a codec of blocks, which may begin late
        size = 1 << (len(found) + len(given)).bit_length()
        product = np.fft.irfft(np.fft.rfft(found, size) * np.conj(np.fft.rfft(given, size)), size)
        found = found[int(np.argmax(product[: max(len(found) - len(given) + 1, 1)])) :]
    found = found if rate == RATE else soxr.resample(found, rate, RATE)
    return np.pad(found[: len(sound)], (0, max(len(sound) - len(found), 0))).astype(np.float32)


def companded(sound: np.ndarray) -> np.ndarray:
    """A sound within -1 .. 1 in 8 bits by mu-law (ITU-T G.711), and back."""
    code = np.round(np.sign(sound) * np.log1p(255.0 * np.minimum(np.abs(sound), 1.0)) / np.log(256.0) * 127.0)
    return (np.sign(code) * np.expm1(np.abs(code) / 127.0 * np.log(256.0)) / 255.0).astype(np.float32)


def white(seconds: float, random: np.random.Generator) -> np.ndarray:
    """(n, 24) float32 log2 energies of white noise, relative to the mean energy of all bands together."""
    noise = log_energies(random.normal(scale=1000.0, size=round(seconds * RATE)))[2:]
    return noise - np.log2(np.exp2(noise).mean())


def power(energies: np.ndarray) -> np.ndarray:
    """(B, 1, 1) log2 of the mean energy of each crop."""
    return np.log2(np.exp2(energies).mean(axis=(1, 2), keepdims=True))


def mixed(energies: np.ndarray, noise: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Crops with `noise`, (B, n, 24) of any level, added at `ratio` (B,) dB below the crops' mean energy."""
    level = power(energies) - power(noise) - np.asarray(ratio)[:, None, None] * (np.log2(10.0) / 10.0)
    return np.log2(np.exp2(energies) + np.exp2(noise + level.astype(np.float32)))


def warped(energies: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Crops whose band k has the energy of band k * factor, `factor` (B,), between bands linearly."""
    at = np.clip(np.arange(BANDS) * factor[:, None], 0, BANDS - 1)
    share = np.maximum(1 - np.abs(np.arange(BANDS)[:, None] - at[:, None, :]), 0)  # of each band in each new one
    return energies @ share.astype(np.float32)


def noises(count: int, length: int, pool: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(count, length, 24) noises of several colours, from a pool of :func:`white`: white to twice as steep as pink,
    with random bands; some are hum alone, some swell."""
    found = pool[random.integers(len(pool) - length, size=count)[:, None] + np.arange(length)]
    slope = random.choice([0.0, 1.0], size=count, p=[0.4, 0.6]) * random.uniform(0.0, 2.0, size=count)
    colour = -slope[:, None] * _OCTAVES + random.normal(scale=0.5, size=(count, BANDS))
    hums = random.random(count) < 0.08
    colour[hums] -= 2.5 * np.maximum(np.arange(BANDS) - random.integers(1, 4, size=(int(hums.sum()), 1)), 0)
    time = np.arange(length) / 100.0
    rate, phase = random.uniform(0.1, 3.0, size=(count, 1)), random.uniform(0, 2 * np.pi, size=(count, 1))
    depth = random.uniform(0.0, 2.5, size=(count, 1)) * (random.random((count, 1)) < 0.3)
    swell = depth * np.sin(2 * np.pi * rate * time + phase)
    return found + colour[:, None, :].astype(np.float32) + swell[:, :, None].astype(np.float32)


def augmented(energies: np.ndarray, pool: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(B, n, 24) float32: `energies` after everything above, not below the floor."""
    count, length = energies.shape[:2]
    found = np.asarray(energies, dtype=np.float32)
    silent = found <= FLOOR + 0.01  # digital silence stays silent whatever the channel does
    factor = np.where(random.random(count) < WARPED, random.uniform(*WARPS, size=count), 1.0)
    found = warped(found, factor)
    place = np.linspace(0.0, 1.0, BANDS)
    shape = random.normal(scale=_GAIN, size=(count, 1)) + np.zeros(BANDS)
    for k in range(1, 4):
        phase = random.uniform(0, 2 * np.pi, size=(count, 1))
        shape += random.normal(size=(count, 1)) * _EQUALISER / k * np.cos(np.pi * k * place + phase)
    dropped = random.random((count, 1)) < DROPPED
    first, width = random.integers(BANDS, size=(count, 1)), random.integers(1, 4, size=(count, 1))
    within = (np.arange(BANDS) >= first) & (np.arange(BANDS) < first + width)
    shape -= np.where(within & dropped, random.uniform(2, 14, size=(count, 1)), 0.0)
    edge = np.where(random.random((count, 1)) < CUT, random.integers(16, BANDS, size=(count, 1)), BANDS)
    shape -= np.where(np.arange(BANDS) >= edge, 16.0, 0.0)
    found = np.where(silent, FLOOR, found + shape[:, None, :].astype(np.float32))
    noisy = np.flatnonzero(random.random(count) < NOISY)
    if len(noisy):
        ratio = random.uniform(*RATIOS, size=len(noisy))
        found[noisy] = mixed(found[noisy], noises(len(ratio), length, pool, random), ratio)
    return np.maximum(found, FLOOR).astype(np.float32)
