"""A synthetic corpus of laughter: phonemes with the timings that have been published, motion of our own design.

No recording of laughter's lip motion with its phonemes is public, so this program generates a corpus. Its sources:

* **Timings are published facts.** Laughter pulses follow each other every 210 ms (notes of some 75 ms, getting
  softer) [Provine and Yong 1991]; a train has a median of 3 pulses and up to 17; median durations of the phoneme
  classes are those of annotated laughs (`MEDIANS`); more than half of a laugh is silence or breath; an inhalation
  follows a train of exhalations; phonemes of 20 ms, the same phoneme twice and silences of 5 s occur.
* **Weak articulation is a published fact** [Bachorowski et al. 2001]: central vowels and h-like sounds dominate, so
  the vowels' shapes here differ little. That the smile deepens with the laugh's intensity is, too [Ruch]; so is that
  the corners stay drawn back and up through the bout while the jaw quivers with the pulses.
* **Amplitudes are design choices:** every number of FAP units below, the speed of the smile, the asymmetry, the noise.
  So are the shares of the phonemes and the durations of "o", "grunt" and of the pauses between trains.
* **Loudness is a design choice, too** (docs/laughing.md). The jaw is proportional to a pulse's, the lips part over its
  first third, and the smile follows slowly. A model sees it as the *grades* of the phonemes that carry a bout's
  amplitude; between two grades the label is random, with the probability given by the loudness.

The bottom lip follows the jaw, the top lip rises a little with the smile, and both meet when the lips are closed.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import List, Tuple

import numpy as np

from labial.corpus.folder import HEADER
from labial.corpus.phonesets import LAUGHTER_GRADES
from labial.defaults import EPISODES
from labial.errors import DataError, PathLike
from labial.files.faps import CHANNELS, FAP_NUMBERS
from labial.files.outputs import folder

#: Frames per second of the corpus; a frame is the motion at its centre.
FPS = 50
#: Median duration in milliseconds of phonemes with a random duration; fricatives and silences in a pulse fill its
#: period.
MEDIANS = {"a": 98, "e": 92, "o": 92, "ic": 80, "cackle": 48, "nasal": 80, "ne": 240, "fricative": 120, "click": 40,
           "plosive": 40, "grunt": 200}
#: Standard deviation of a duration's logarithm.
SPREAD = 0.22
#: A pulse's period, milliseconds from onset to onset: mean, standard deviation, and limits.
PERIOD, PERIOD_SPREAD = 210.0, 25.0
PERIOD_SHORTEST, PERIOD_LONGEST = 140, 280
#: Pulses of a train: median, standard deviation of the logarithm, most.
TRAIN_MEDIAN, TRAIN_SPREAD, TRAIN_LONGEST = 3.0, 0.6, 17
#: Shortest phoneme, milliseconds: one frame.
SHORTEST = 20
#: A phoneme's mouth at full loudness: jaw (of `_JAW`), lips apart (0 closed, 1 free), rounding.
GESTURES = {
    "silence": (0.16, 0.60, 0.0), "ne": (0.04, 0.15, 0.0), "nasal": (0.10, 0.05, 0.0), "click": (0.22, 0.60, 0.1),
    "plosive": (0.16, 0.50, 0.0), "fricative": (0.36, 0.90, 0.0), "ic": (0.90, 1.00, -0.2), "e": (0.94, 1.00, 0.0),
    "o": (0.92, 1.00, 1.0), "grunt": (0.20, 0.45, 0.1), "cackle": (1.50, 1.00, 0.0), "a": (1.00, 1.00, 0.0),
}
_JAW = 600.0  # FAP 3 of the widest opening: about 18 mm of an adult's face
#: The jaw's opening and the smile of the softest laugh, a hum; the loudness from which the lips part freely.
_HUMMED, _FAINT, _PARTED = 0.06, 0.12, 0.35
_STEP = 5  # ms between samples of the motion before it is sampled at FPS
#: Kinds of a pulse and their shares: vowel after breath, vowel and silence, cackle, closed lips, glottal stop first.
PULSES, PULSE_SHARES = ("h", "bare", "cackle", "nasal", "stop"), (0.62, 0.12, 0.10, 0.09, 0.07)
VOWELS, VOWEL_SHARES = ("a", "e", "o", "ic"), (0.40, 0.34, 0.10, 0.16)
#: How often the kind of a pulse, and its vowel, is drawn again within a train.
CHANGED = 0.15
#: What a bout may begin with, and how often.
ONSETS = {"ne": 0.25, "click": 0.15, "grunt": 0.20, "plosive": 0.15}
#: How often a pause between trains has an inhalation, that inhalation a click before it, and is by the nose; and how
#: often the pause has a grunt, a silence and a longer rest.
INHALED, CLICKED, BY_NOSE, GRUNTED, SILENT, RESTED = 0.75, 0.2, 0.75, 0.18, 0.5, 0.15
#: How much softer a pulse is than the one before it, and a train than the one before.
PULSE_DECAY, TRAIN_DECAY = 0.93, 0.92
#: How loud air is drawn in after a train, of the train's loudness.
INHALED_LOUDNESS = 0.7
#: Loudness up to which every phoneme that has grades is a soft one, and from which it is a loud one; half way between
#: the two all are of middle grade.
SOFT, LOUD = 0.08, 0.96
_UNGRADED = {graded: label for label, grades in LAUGHTER_GRADES.items() for graded in grades}

_Phoneme = Tuple[str, int, float]  # label, milliseconds, loudness 0..1


def generate(out_dir: PathLike, episodes: int = EPISODES, seed: int = 0) -> None:
    """Writes a Labial corpus folder of `episodes` bouts of laughter; the same seed gives the same bytes. Raises
    DataError when `out_dir` exists and is not empty: another run's episodes would mix with these."""
    path = Path(out_dir)
    if path.is_dir() and any(path.iterdir()):
        raise DataError(path, None, "the folder is not empty")
    random = np.random.Generator(np.random.PCG64(seed))
    with folder(path) as made:
        for number in range(episodes):
            phonemes, intensity = _bout(random)
            (made / f"laugh{number:04d}.csv").write_bytes(_csv(_motion(random, phonemes, intensity)).encode())
            (made / f"laugh{number:04d}.lab").write_bytes(_lab(random, phonemes).encode())
        (made / "README.md").write_bytes(_README.format(episodes=episodes, seed=seed, fps=FPS).encode())


def is_synthetic(path: PathLike) -> bool:
    """Whether the folder's README says that :func:`generate` made it."""
    try:
        with open(Path(path) / "README.md", encoding="utf-8", errors="replace") as readme:
            return readme.readline().strip() == _TITLE
    except OSError:
        return False


def _bout(random: np.random.Generator) -> Tuple[List[_Phoneme], float]:
    """A bout's phonemes and its intensity, 0 to 1."""
    intensity = 0.5 - 0.5 * math.cos(math.pi * random.random())  # faint and hearty laughs more often than others
    bout: List[_Phoneme] = [("silence", int(random.uniform(200, 500)), 0.0)]

    def add(label: str, loudness: float) -> None:
        bout.append((label, _duration(random, label), loudness))

    onset = next((label for label, share in ONSETS.items() if random.random() < share), None)
    if onset:
        add(onset, 0.5 * intensity)
    for train in range(2 + int(random.binomial(4, intensity))):
        loudness = intensity * TRAIN_DECAY**train
        bout += _train(random, loudness)
        if random.random() < INHALED:  # air runs out and is drawn in again
            add("silence", 0.25 * loudness)
            if random.random() < CLICKED:
                add("click", 0.6 * loudness)
            add("ne" if random.random() < BY_NOSE else "fricative", INHALED_LOUDNESS * loudness)
        if random.random() < GRUNTED:
            add("grunt", 0.5 * loudness)
        if random.random() < SILENT:
            add("silence", 0.25 * loudness)
        if random.random() < RESTED:
            longest = 5000 if random.random() < 0.1 else 900
            bout.append(("silence", int(random.uniform(0.5, 1.0) * longest), 0.0))
    if random.random() < 0.5:
        add("ne", 0.3 * intensity)
    bout.append(("silence", int(random.uniform(700, 1600)), 0.0))
    return [(_graded(random, label, loudness), length, loudness) for label, length, loudness in bout], intensity


def _graded(random: np.random.Generator, label: str, loudness: float) -> str:
    """The phoneme in the grade of `loudness`, drawn between the two nearest grades."""
    if label not in LAUGHTER_GRADES:
        return label
    soft, loud = LAUGHTER_GRADES[label]
    wanted = float(np.clip(2 * (loudness - SOFT) / (LOUD - SOFT), 0, 2))
    return (soft, label, loud)[min(int(wanted + random.random()), 2)]


def _train(random: np.random.Generator, loudness: float) -> List[_Phoneme]:
    """Pulses of one exhalation, each softer than the one before; most have the train's own vowel."""
    count = min(max(round(TRAIN_MEDIAN * float(np.exp(random.normal(0, TRAIN_SPREAD)))), 1), TRAIN_LONGEST)
    kind, vowel = random.choice(PULSES, p=PULSE_SHARES), random.choice(VOWELS, p=VOWEL_SHARES)
    train: List[_Phoneme] = []
    for pulse in range(count):
        if random.random() < CHANGED:
            kind = random.choice(PULSES, p=PULSE_SHARES)
        if random.random() < CHANGED:
            vowel = random.choice(VOWELS, p=VOWEL_SHARES)
        loud = loudness * PULSE_DECAY**pulse * float(np.exp(random.normal(0, 0.10)))
        period = int(np.clip(random.normal(PERIOD, PERIOD_SPREAD), PERIOD_SHORTEST, PERIOD_LONGEST))
        note = str({"cackle": "cackle", "nasal": "nasal"}.get(str(kind), vowel))
        sound = min(_duration(random, note), period - 40)
        rest = period - sound
        if kind == "h":
            train += [("fricative", rest, loud), (note, sound, loud)]
        elif kind == "stop":
            stop = min(_duration(random, "plosive"), rest - 20)
            train += [("plosive", stop, loud), (note, sound, loud), ("silence", rest - stop, 0.5 * loud)]
        elif random.random() < 0.05:  # the voice does not stop: the same phoneme twice
            train += [(note, sound, loud), (note, max(rest - 60, 20), 0.8 * loud), ("silence", 60, 0.5 * loud)]
        else:
            train += [(note, sound, loud), ("silence", rest, 0.5 * loud)]
    return train


def _duration(random: np.random.Generator, label: str) -> int:
    """Milliseconds, at least one frame."""
    if label == "silence":
        return max(int(random.uniform(160, 420)), SHORTEST)
    return max(round(MEDIANS[label] * float(np.exp(random.normal(0, SPREAD)))), SHORTEST)


def _motion(random: np.random.Generator, phonemes: List[_Phoneme], intensity: float) -> np.ndarray:
    """(T, 13) FAPs of a bout, T frames from its beginning."""
    total = sum(milliseconds for _, milliseconds, _ in phonemes)
    count = total // _STEP + 1
    jaw, apart, rounding, effort = (np.zeros(count) for _ in range(4))
    begin = 0
    for label, milliseconds, loudness in phonemes:
        span = slice(begin // _STEP, max((begin + milliseconds) // _STEP, begin // _STEP + 1))
        wide, free, rounded = GESTURES[_UNGRADED.get(label, label)]
        laughing = loudness > 0
        vigour = laughing * (_HUMMED + (1 - _HUMMED) * loudness) * float(np.exp(random.normal(0, 0.10)))
        jaw[span], rounding[span], effort[span] = wide * vigour, rounded * vigour, max(loudness, laughing * _FAINT)
        apart[span] = laughing * free * (0.25 + 0.75 * min(loudness / _PARTED, 1.0))
        begin += milliseconds
    smile = _follow(_smooth(effort, 150), intensity)
    jaw = np.clip(_smooth(jaw, 34), 0, 1) * _JAW + 14 * smile
    # Lips part by the jaw's opening and the teeth that a smile bares; at rest they close as the smile fades.
    seal = np.clip(_smooth(apart, 38), 0, 1)
    seal = np.maximum(seal, 0.35 * np.clip(smile - 0.3, 0, 1))
    aperture = seal * (1.08 * jaw + 60 * smile)
    rounding = _smooth(rounding, 45)
    raised = 0.16 * aperture + 42 * smile
    faps = {3: jaw, 16: -34 * smile - 0.10 * jaw + 40 * rounding, 17: -48 * smile + 42 * rounding, 51: -raised,
            52: raised - aperture}
    corner_out = 150 * smile - 0.05 * jaw - 34 * rounding
    corner_up = 195 * smile - 0.16 * jaw
    lean = float(random.normal(0, 0.04))  # one side of the face smiles a little more
    for side, more in enumerate((1 + lean, 1 - lean)):
        faps[53 + side], faps[59 + side] = corner_out * more, corner_up * more
        faps[55 + side] = -0.80 * raised + -30 * smile * more
        faps[57 + side] = 0.78 * (raised - aperture) + 34 * smile * more
    frames = np.stack([faps[number] for number in FAP_NUMBERS], axis=1)
    # Samples at the centres of the frames, from those every `_STEP` ms.
    moments = (np.arange(max(round(total * FPS / 1000), 1)) + 0.5) * 1000 / FPS
    frames = np.stack([np.interp(moments, np.arange(count) * _STEP, item) for item in frames.T], axis=1)
    noise = random.normal(0, 1.0, (len(frames) + 2, CHANNELS))  # like a tracker's: small, a little smoothed
    return frames + 0.5 * noise[1:-1] + 0.25 * (noise[:-2] + noise[2:])


def _smooth(signal: np.ndarray, sigma: float) -> np.ndarray:
    """A Gaussian blur of `sigma` milliseconds: a gesture begins before its sound and outlasts it. Edges repeat."""
    reach = int(3 * sigma / _STEP) + 1
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * _STEP / sigma) ** 2)
    return np.convolve(np.pad(signal, reach, mode="edge"), kernel / kernel.sum(), mode="valid")


def _follow(effort: np.ndarray, intensity: float) -> np.ndarray:
    """The smile, 0..1: rises with the loudness of laughing within 0.2 s, sinks over 2.5 s, never below a faint one."""
    target = np.maximum(effort**0.8, 0.12 * intensity)
    smile, level = np.empty_like(target), 0.5 * target[0]
    for index, goal in enumerate(target):
        level += (goal - level) * _STEP / (200 if goal > level else 2500)
        smile[index] = level
    return _smooth(smile, 60)


def _csv(frames: np.ndarray) -> str:
    lines = [HEADER]
    for number, frame in enumerate(np.round(frames, 2) + 0.0):  # + 0.0: no "-0.00"
        lines.append(",".join([f"{(number + 0.5) / FPS:.3f}", *(f"{value:.2f}" for value in frame)]))
    return "\n".join(lines) + "\n"


def _lab(random: np.random.Generator, phonemes: List[_Phoneme]) -> str:
    """Timings with apexes: the envelope's maximum lies at about two fifths of a phoneme."""
    lines, begin = [], 0
    for label, milliseconds, _ in phonemes:
        apex = begin + round(float(np.clip(random.normal(0.42, 0.08), 0.1, 0.9)) * milliseconds)
        lines.append(f"{begin / 1000:.3f} {(begin + milliseconds) / 1000:.3f} {label} {apex / 1000:.3f}")
        begin += milliseconds
    return "\n".join(lines) + "\n"


#: First line of the README beside the episodes, by which the corpus is recognised.
_TITLE = "# Synthetic laughter"

_README = _TITLE + """

Nobody laughed for this corpus: {episodes} bouts of laughter were computed by `labial.corpus.laughter` (seed {seed}).
Timings follow published statistics of laughter; amplitudes of the motion are design choices. See that module for both.

Per bout: `NAME.csv` (`time` in s, 13 FAP channels in FAP units, {fps} frames/s) and `NAME.lab` (`start end phoneme
apex`, s). A model that is trained on it imitates this program, not people, and should say so.
"""
