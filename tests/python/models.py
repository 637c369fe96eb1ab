"""Models, phoneme streams, sounds and corpora made up for the tests."""

from __future__ import annotations

import io
import wave
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Dict, Iterable, List, Mapping, Tuple

import numpy as np

from labial.corpus import Episode
from labial.corpus.folder import HEADER
from labial.files.faps import CHANNELS
from labial.hearing.model import CLASSES, INPUTS, HearingModel, Memory
from labial.tables.model import Model

Stream = List[Tuple[int, int]]


def random_model(seed: int, method: str = "labial", phonemes: int = 9, states: int = 12, components: int = 3,
                 knots: int = 1) -> Model:
    """A model with every table filled: phoneme 0 is silence, every third phoneme is a boundary."""
    rng = np.random.default_rng(seed)
    own = method == "labial"
    classes = 4
    count = phonemes * components
    reach = 300.0 * rng.uniform(0.1, 1.0, CHANNELS)
    mean = np.sort(rng.uniform(-1.0, 1.0, (CHANNELS, states)) * reach[:, None], axis=1)
    variance = (reach[:, None] * rng.uniform(0.05, 0.3, (CHANNELS, states))) ** 2
    state_mean = np.stack([mean, rng.normal(0, 0.05, mean.shape) * reach[:, None],
                           rng.normal(0, 0.02, mean.shape) * reach[:, None]], axis=-1)
    precision = np.stack([0.3 / variance, 3.0 / variance, 6.0 / variance], axis=-1)
    stay = np.eye(states) * 3.0 + rng.uniform(0.0, 1.0, (CHANNELS, states, states))
    taps = np.arange(-6, 7, 2) if own else np.zeros(0, dtype=np.int64)

    def log_share(shape: Tuple[int, ...]) -> np.ndarray:
        value = rng.uniform(0.05, 1.0, shape)
        return np.log(value / value.sum(axis=-1, keepdims=True))

    anchor = 3.0 / variance if own else np.zeros_like(variance)
    floor = np.where(rng.random((phonemes, CHANNELS)) < (0.15 if own else 0.0), 0.3 * reach, -np.inf)
    return Model(
        kind="speech",
        method=method,
        fps=50,
        phonemes=tuple(["SIL"] + [f"P{i}" for i in range(1, phonemes)]),
        classes=tuple(f"class {i}" for i in range(classes)),
        silence="SIL",
        soft=own,
        search_stride=1 + seed % 3 if own else 1,
        viseme_class=np.arange(phonemes) % classes,
        boundary=np.arange(phonemes) % 3 == 1,
        component_count=np.full(phonemes, components),
        log_weight=log_share((phonemes, components)).ravel(),
        duration_mean=rng.uniform(0.04, 0.25, count),
        duration_variance=rng.uniform(0.01, 0.05, count) ** 2,
        shape=rng.uniform(-0.8, 0.8, (count, CHANNELS)) * reach,
        slope=rng.normal(0, 2.0, (count, CHANNELS)) * reach if own else np.zeros((count, CHANNELS)),
        log_previous=log_share((count, classes)) if own else np.zeros((count, 0)),
        log_next=log_share((count, classes)) if own else np.zeros((count, 0)),
        kernel=rng.normal(0, 0.05, (phonemes, len(taps), CHANNELS)) * reach,
        kernel_lag=taps,
        pair_key=np.array([[p, side, n] for p in range(phonemes) for side in (0, 1) for n in range(phonemes)
                           if (p + n + side) % 3 == 0 and own], dtype=np.int64).reshape(-1, 3),
        pair_shape=rng.normal(0, 0.1, (sum((p + n + side) % 3 == 0 and own for p in range(phonemes)
                                           for side in (0, 1) for n in range(phonemes)), knots, CHANNELS)) * reach,
        floor=floor,
        contact=np.isfinite(floor) & (rng.random(floor.shape) < 0.7),
        firm=np.median(precision[..., 0] + anchor, axis=1) * 4.0,
        emission_mean=mean,
        emission_variance=variance,
        state_mean=state_mean,
        state_precision=precision,
        state_anchor=anchor,
        log_transition=np.log(stay / stay.sum(axis=-1, keepdims=True)),
        log_initial=log_share((CHANNELS, states)),
        aliases={"sil": "SIL", "p1": "P1", "ɑ": "P2"},
        attribution="Made up.",
    )


def without_floors(model: Model) -> Model:
    """The model with targets that nothing holds up."""
    shape = model.floor.shape
    return replace(model, floor=np.full(shape, -np.inf), contact=np.zeros(shape, dtype=bool))


def streams(phonemes: int, boundary: np.ndarray, seed: int) -> Dict[str, Stream]:
    """Phoneme streams of all kinds, by name."""
    rng = np.random.default_rng(seed)
    vowels, consonants = np.flatnonzero(boundary), np.flatnonzero(~boundary)

    def draw(among: np.ndarray, count: int, low: int, high: int) -> Stream:
        return [(int(rng.choice(among)), int(rng.integers(low, high))) for _ in range(count)]

    every = np.arange(phonemes)
    return {
        "ordinary": draw(every, 60, 30, 200),
        "one frame each": [(int(p), 20) for p in rng.choice(every, 120)],
        "one millisecond each": [(int(p), 1) for p in rng.choice(every, 300)],
        "long pauses": sum((draw(every, 4, 40, 160) + [(0, 2500)] for _ in range(4)), []),
        "only vowels": draw(vowels, 40, 20, 300),
        "only consonants": draw(consonants, 40, 20, 300),
        "long": draw(every, 20, 300, 1500),
        "with zeros": [(p, ms if rng.random() < 0.6 else 0) for p, ms in draw(every, 60, 10, 150)],
        "one phoneme": draw(every, 1, 20, 500),
    }


def lab(phonemes: Iterable[Tuple[str, int]]) -> str:
    """Lines of start, end and label: phonemes of these lengths, milliseconds, one after the other."""
    lines, begin = [], 0
    for label, length in phonemes:
        lines.append(f"{begin / 1000:.3f} {(begin + length) / 1000:.3f} {label}\n")
        begin += length
    return "".join(lines)


def archive(members: Mapping[str, bytes]) -> bytes:
    """A model's file, or what looks like one."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members.items():
            target.writestr(name, content)
    return out.getvalue()


def members_of(path: Path) -> Dict[str, bytes]:
    """What a model's file holds, by the names within."""
    with zipfile.ZipFile(path) as source:
        return {name: source.read(name) for name in source.namelist()}


def write_motion(path: Path, times: Iterable[float], frames: np.ndarray) -> Path:
    """Writes (T, 13) FAPs at these seconds as a file of frames."""
    rows = (",".join([f"{time:.3f}", *(f"{value:.12g}" for value in row)]) for time, row in zip(times, frames))
    path.write_text("\n".join([HEADER, *rows]) + "\n")
    return path


def write_wav(path: Path, sound: np.ndarray, rate: int = 16000, width: int = 2) -> Path:
    """A WAV file of samples (N,) or (N, channels)."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1 if sound.ndim == 1 else sound.shape[1])
        file.setsampwidth(width)
        file.setframerate(rate)
        file.writeframes(sound.astype({1: "u1", 2: "<i2", 4: "<i4"}[width]).tobytes())
    return path


def write_episode(folder: Path, item: Episode) -> None:
    """Writes an episode as corpora have it, each apex in the middle of its phoneme."""
    write_motion(folder / f"{item.name}.csv", item.times, item.frames)
    (folder / f"{item.name}.lab").write_text("".join(
        f"{s.start:.4f} {s.end:.4f} {s.label} {(s.start + s.end) / 2:.4f} {s.word or '<sil>'}\n"
        for s in item.segments))


def random_hearing(seed: int = 0) -> HearingModel:
    """A network of one block with random weights whose frames stay within what a mouth can do."""
    random, units, block = np.random.default_rng(seed), 8, Memory(2, 1, 1)

    def array(*shape: int) -> np.ndarray:
        return random.normal(scale=0.3, size=shape).astype(np.float32)

    return HearingModel(
        memories=(block,), dense=(array(units, INPUTS),), bias=(array(units),), memory=(array(units, block.taps),),
        last=array(units, units), last_bias=array(units), class_weight=array(len(CLASSES), units),
        class_bias=array(len(CLASSES)), closed_weight=array(units), closed_bias=array(1),
        fap_weight=array(CHANNELS, units), fap_bias=array(CHANNELS), classes=CLASSES,
        fap_mean=np.zeros(CHANNELS, np.float32), fap_scale=np.full(CHANNELS, 50.0, np.float32),
        closed=np.zeros(CHANNELS, np.float32), closing=np.linspace(1, 0, CHANNELS, dtype=np.float32),
        close_from=0.0, close_to=1.0)
