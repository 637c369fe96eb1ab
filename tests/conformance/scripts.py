"""Reads ``streams.txt`` and writes the streams as C."""

from __future__ import annotations

import re
import textwrap
import zlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from labial.errors import LabialError
from labial.tables.emit import phoneme_constants
from labial.tables.quantise import ExportedModel

#: Word in ``streams.txt`` and name of the bundled model's symbol, in the order of ``vectors.h``.
MODELS = {"speech": "speech_en", "laughter": "laughter_synthetic"}

#: Frames per stream, (T, 13) int.
Frames = Dict[str, np.ndarray]


@dataclass(frozen=True)
class Push:
    """A phoneme of the model ``speech`` or ``laughter`` for so many milliseconds."""

    model: str
    phoneme: int
    milliseconds: int


@dataclass(frozen=True)
class Part:
    """What is pushed before an end or, with `cancel` (frames before it, milliseconds of easing), before a cancel, which
    `again` repeats (frames of the easing before it, milliseconds of another); `articulation` is what it is set to
    (frames of the part before it, percent)."""

    pushes: Tuple[Push, ...]
    cancel: Optional[Tuple[int, int]]
    again: Tuple[Tuple[int, int], ...] = ()
    articulation: Tuple[Tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Script:
    """One stream: its name and its parts, each but the first after a restart."""

    name: str
    parts: Tuple[Part, ...]


def ease_frames(milliseconds: int, fps: int) -> int:
    """Frames of an easing over `milliseconds`."""
    return min(max(-(-milliseconds * fps // 1000), 1), 1000)


def read(path: Path, models: Dict[str, ExportedModel]) -> List[Script]:
    """The streams of the file; raises LabialError naming file and line."""
    scripts: List[Script] = []
    parts: List[Part] = []
    pushes: List[Push] = []
    articulation: List[Tuple[int, int]] = []
    name = ""

    def finish() -> None:
        if name and (pushes or not parts):
            parts.append(Part(tuple(pushes), None, articulation=tuple(articulation)))
        if name:
            scripts.append(Script(name, tuple(parts)))

    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        where = f"{path}:{number}"
        word, _, rest = line.partition(" ")
        if not line.strip() or word == "#":
            continue
        if word == "stream":
            finish()
            match = re.fullmatch(r"([a-z_]+): \S.*", rest)
            if not match or match.group(1) in [script.name for script in scripts]:
                raise LabialError(f"{where}: a stream needs a name of its own, small letters, and a reason")
            name, parts, pushes, articulation = match.group(1), [], [], []
        elif word in MODELS and name:
            pushes += _pushes(where, word, rest, models[word])
        elif word == "turns" and name:
            pushes += _turns(where, rest, models)
        elif (word == "end" and not rest or word == "cancel" and re.fullmatch(r"\d+ \d+", rest)) and name:
            at = rest.split()
            parts.append(Part(tuple(pushes), (int(at[0]), int(at[1])) if at else None,
                              articulation=tuple(articulation)))
            pushes, articulation = [], []
        elif word == "again" and re.fullmatch(r"\d+ \d+", rest) and parts and parts[-1].cancel and not pushes:
            after, milliseconds = map(int, rest.split())
            eased = (parts[-1].cancel, *parts[-1].again)[-1][1]
            if after >= ease_frames(eased, models["speech"].fps):
                raise LabialError(f"{where}: the easing over {eased} ms is done before its frame {after}")
            parts[-1] = replace(parts[-1], again=(*parts[-1].again, (after, milliseconds)))
        elif word == "articulation" and re.fullmatch(r"\d+ \d+", rest) and name:
            after, percent = map(int, rest.split())
            if articulation and after <= articulation[-1][0]:
                raise LabialError(f"{where}: the articulation changes after {articulation[-1][0]} frames already")
            articulation.append((after, percent))
        else:
            raise LabialError(f"{where}: {line!r} is not understood")
    finish()
    return scripts


def _pushes(where: str, word: str, text: str, model: ExportedModel) -> List[Push]:
    labels = [constant[len(model.name) + 1 :] for constant in phoneme_constants(model)]
    found = []
    for item in text.split(","):
        match = re.fullmatch(r"\s*(\S+) (\d+)\s*", item)
        if not match or match.group(1) not in [*labels, "*"]:
            raise LabialError(f"{where}: {item.strip()!r} is not a phoneme of {model.name} and milliseconds")
        label, milliseconds = match.group(1), int(match.group(2))
        chosen = range(len(labels)) if label == "*" else [labels.index(label)]
        found += [Push(word, phoneme, milliseconds) for phoneme in chosen]
    return found


def _turns(where: str, text: str, models: Dict[str, ExportedModel]) -> List[Push]:
    match = re.fullmatch(r"(\d+): ([^|]+)\|([^|]+)", text)
    if not match:
        raise LabialError(f"{where}: turns need a number and a list of phonemes for each model")
    lists = [_pushes(where, word, part, models[word]) for word, part in zip(MODELS, match.groups()[1:])]
    return [lists[i % 2][i // 2 % len(lists[i % 2])] for i in range(int(match[1]))]


def digest(frames: np.ndarray) -> int:
    """CRC-32 of frames (T, 13) as little-endian int16."""
    return zlib.crc32(frames.astype("<i2").tobytes())


def as_c(scripts: Sequence[Script], models: Dict[str, ExportedModel], frames: Optional[Frames] = None) -> str:
    """``vectors.c``; without `frames`, the digests are zero."""
    constants = {word: phoneme_constants(model) for word, model in models.items()}
    text = ["/* Written by regenerate.py from streams.txt; do not edit. */", '#include "vectors.h"', ""]
    text += [f'#include "{model.name}.h"' for model in models.values()]
    text += ["", "#define PUSH(model, phoneme, ms) { CONFORMANCE_PUSH, CONFORMANCE_##model, phoneme, ms }",
             "#define END { CONFORMANCE_END, 0, 0, 0 }",
             "#define CANCEL(frames, ms) { CONFORMANCE_CANCEL, 0, frames, ms }",
             "#define AGAIN(frames, ms) { CONFORMANCE_AGAIN, 0, frames, ms }",
             "#define ARTICULATION(frames, percent) { CONFORMANCE_ARTICULATION, 0, frames, percent }"]
    table = []
    for script in scripts:
        steps: List[str] = []
        for part in script.parts:
            steps += ["ARTICULATION({}, {})".format(*change) for change in part.articulation]
            steps += [f"PUSH({push.model.upper()}, {constants[push.model][push.phoneme]}, {push.milliseconds})"
                      for push in part.pushes]
            steps.append("END" if part.cancel is None else "CANCEL({}, {})".format(*part.cancel))
            steps += ["AGAIN({}, {})".format(*again) for again in part.again]
        text += ["", f"static const conformance_step_t {script.name}_steps[] = {{", _wrapped(steps), "};"]
        motion = frames[script.name] if frames else np.zeros((0, 13), dtype=np.int64)
        table.append(f'    {{ "{script.name}", {script.name}_steps, {len(steps)}, {len(motion)}, '
                     f"0x{digest(motion):08x}u }}")
    text += ["", "const conformance_stream_t conformance_streams[] = {", ",\n".join(table), "};", "",
             f"const unsigned conformance_stream_count = {len(scripts)};", ""]
    return "\n".join(text)


def _wrapped(items: Sequence[str]) -> str:
    joined = ", ".join(item.replace(" ", "\u00a0") for item in items)
    return textwrap.fill(joined, 118, initial_indent="    ", subsequent_indent="    ").replace("\u00a0", " ")


def read_frames(text: str) -> Frames:
    """The frames of ``frames.txt``; raises LabialError naming the line."""
    rows: Dict[str, List[List[int]]] = {}
    name: Union[str, None] = None
    for number, line in enumerate(text.splitlines(), 1):
        values = line.split()
        if re.fullmatch(r"[a-z_]+", line) and line not in rows:
            name = line
            rows[name] = []
        elif name is not None and len(values) == 13 and all(re.fullmatch(r"-?\d+", value) for value in values):
            rows[name].append([int(value) for value in values])
        elif name is not None and rows[name] and re.fullmatch(r"and \d+", line):
            rows[name] += [rows[name][-1]] * int(values[1])
        else:
            raise LabialError(f"frames, line {number}: {line!r} is neither a stream's name nor 13 numbers "
                              "nor `and` and a number")
    return {key: np.array(value, dtype=np.int64).reshape(-1, 13) for key, value in rows.items()}
