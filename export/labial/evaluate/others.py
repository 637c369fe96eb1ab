"""Other projects that make lips of sound alone, for ``labial evaluate-hear``.

- **wawa-lipsync** and **headaudio** are npm packages for browsers. Their own files run under node, fed with the sound
  at 48 kHz, and tell the weights of Oculus LipSync's visemes 60 times a second (others.mjs). wawa-lipsync hears what
  the browser's AnalyserNode reports, which :func:`levels` computes as the Web Audio API defines it.
- **pocketsphinx** is a recogniser: its phone loop finds phonemes without any words, and Labial's bundled voice speaks
  them. It knows the whole sound in advance.

A viseme stands for Labial's own frame in the middle of a long phoneme of it (`VISEMES`), `PP` as the pose of Labial's
closed lips, `sil` and weights of 0 as the neutral face; weights mix these as an avatar mixes its shapes. So all methods
are judged by the same lips.
"""

from __future__ import annotations

import shutil
from functools import cache
from pathlib import Path
from typing import Callable, Dict, Optional

import numpy as np
import soxr

from labial.errors import LabialError, PathLike, apt, missing, needs
from labial.evaluate.hearing import long_pose
from labial.files.faps import CHANNELS
from labial.hearing import voices
from labial.hearing.features import RATE, frames_of
from labial.hearing.targets import FRAME_MS, closure, durations, frames
from labial.sound.samples import prepared

#: Oculus LipSync's visemes, and a phoneme of each.
VISEMES: Dict[str, str] = {
    "sil": "", "PP": "P", "FF": "F", "TH": "TH", "DD": "D", "kk": "K", "CH": "CH", "SS": "S", "nn": "N", "RR": "R",
    "aa": "AA", "E": "EH", "I": "IH", "O": "OW", "U": "UW"}
#: Methods, and the npm package that each needs.
PACKAGES: Dict[str, str] = {"wawa-lipsync": "wawa-lipsync", "wawa-lipsync unsmoothed": "wawa-lipsync",
                            "headaudio": "@met4citizen/headaudio", "pocketsphinx": ""}
#: Samples a second of the browser's sound, what it hears at once, and how often its page is drawn.
BROWSER_RATE, BLOCK, PER_SECOND = 48000, 128, 60
#: Samples that the AnalyserNode looks at, the share of what it reported before, dB of its levels 0 and 255.
FFT, SMOOTHING, QUIET, LOUD = 2048, 0.8, -100.0, -30.0


def method(name: str, npm: Optional[PathLike]) -> Callable[[np.ndarray], np.ndarray]:
    """One of `PACKAGES`: (N,) int16 at 16 kHz -> (T, 13) frames. `npm` is the folder where its package was installed.
    Raises LabialError where node or the package is not there."""
    if name == "pocketsphinx":
        return listener()
    package = PACKAGES[name]
    node = shutil.which("node")
    if node is None:
        raise missing(name, "node", apt("nodejs"))
    if npm is None:
        raise LabialError(f"{name} is an npm package: npm install --prefix FOLDER {package}, and then --npm FOLDER")
    modules = Path(npm).resolve() / "node_modules"
    if not (modules / package / "package.json").is_file():
        raise LabialError(f"there is no {modules / package}: npm install --prefix {npm} {package}")
    program, column = node, int(name == "wawa-lipsync unsmoothed")

    def heard(sound: np.ndarray) -> np.ndarray:
        samples = in_browser(sound)
        kind, given = (name, samples) if name == "headaudio" else (package, levels(samples))
        return shown(run(program, kind, modules, given.tobytes())[:, column], frames_of(len(sound)))

    return heard


def in_browser(sound: np.ndarray) -> np.ndarray:
    """(M,) float32 at `BROWSER_RATE`, full scale 1, of a sound at 16 kHz."""
    return soxr.resample(np.asarray(sound, np.float32) / 32768, RATE, BROWSER_RATE).astype("<f4")


def levels(samples: np.ndarray) -> np.ndarray:
    """(K, 1024) uint8: what getByteFrequencyData() of an AnalyserNode with default settings tells of (M,) samples,
    called `PER_SECOND` times a second: dB of a spectrum behind a Blackman window, smoothed from call to call."""
    turn = 2 * np.pi * np.arange(FFT) / FFT
    window = 0.42 - 0.5 * np.cos(turn) + 0.08 * np.cos(2 * turn)
    calls = -(-len(samples) * PER_SECOND // BROWSER_RATE)
    before = np.concatenate([np.zeros(FFT), np.asarray(samples, float)])
    found = np.empty((calls, FFT // 2), np.uint8)
    smooth = np.zeros(FFT // 2)
    for call in range(calls):
        end = call * BROWSER_RATE // PER_SECOND // BLOCK * BLOCK
        size = np.abs(np.fft.rfft(before[end : end + FFT] * window))[: FFT // 2] / FFT
        smooth = SMOOTHING * smooth + (1 - SMOOTHING) * size
        decibels = 20 * np.log10(np.maximum(smooth, 1e-30))
        found[call] = np.clip(255 * (decibels - QUIET) / (LOUD - QUIET), 0, 255)
    return found


def run(node: str, package: str, modules: Path, given: bytes) -> np.ndarray:
    """(K, ways, visemes) weights, `PER_SECOND` rows a second, of what a package hears. Raises LabialError."""
    command = [node, str(Path(__file__).with_suffix(".mjs")), package, str(modules), ",".join(VISEMES)]
    ways = 2 if package == "wawa-lipsync" else 1
    return np.frombuffer(voices.run(package, command, given), "<f4").reshape(-1, ways, len(VISEMES))


@cache
def poses() -> np.ndarray:
    """(visemes, 13) FAP units: the pose of each viseme; see the top."""
    found = np.zeros((len(VISEMES), CHANNELS))
    for row, (viseme, phoneme) in enumerate(VISEMES.items()):
        if viseme == "PP":
            found[row] = closure().pose
        elif phoneme:
            found[row] = long_pose(phoneme)
    return found


def shown(weights: np.ndarray, count: int) -> np.ndarray:
    """(`count`, 13) frames of (K, visemes) weights, `PER_SECOND` rows a second, in the middle of each frame."""
    if not len(weights):
        return np.zeros((count, CHANNELS))
    at = (np.arange(count) + 0.5) * FRAME_MS / 1000
    rows = np.arange(len(weights)) / PER_SECOND
    return np.stack([np.interp(at, rows, column) for column in weights.T], axis=1) @ poses()


def listener() -> Callable[[np.ndarray], np.ndarray]:
    """PocketSphinx's phone loop, spoken by Labial's bundled voice."""
    with needs("the method pocketsphinx", "align"):
        from labial.sound.recogniser import Recogniser
    recogniser = Recogniser()

    def heard(sound: np.ndarray) -> np.ndarray:
        if not len(sound):
            return np.zeros((0, CHANNELS))
        segments = recogniser.loop(prepared(np.asarray(sound, np.float32) / 32768))
        return frames(durations(segments), frames_of(len(sound)))

    return heard
