"""Makes ``vectors.c`` and ``frames.txt`` anew, after a change of ``streams.txt``, a model or the library's numbers.

    python3 tests/conformance/regenerate.py

needs numpy and a C compiler. The frames are the library's own; they are only written if they follow the float64
reference as closely as the method asks.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np

HERE = Path(__file__).resolve().parent
CC = os.environ.get("LABIAL_CC") or "cc"
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT / "export")]

from labial.errors import LabialError  # noqa: E402
from labial.evaluate.check import LARGEST, RMS  # noqa: E402
from labial.files.faps import CHANNELS  # noqa: E402
from labial.reference.fade import FADE, closing_steps, eased, faded, rests  # noqa: E402
from labial.reference.stream import aims, gains, solution  # noqa: E402
from labial.reference.tables import ExportedTables, Tables  # noqa: E402
from labial.reference.trajectory import WINDOW  # noqa: E402
from labial.reference.units import frame_counts  # noqa: E402
from labial.reference.viterbi import LAG  # noqa: E402
from labial.tables.model import load  # noqa: E402
from labial.tables.quantise import ExportedModel, quantise  # noqa: E402
from scripts import MODELS, Frames, Part, Push, Script, as_c, ease_frames, read, read_frames  # noqa: E402

# ---- What a stream's frames should be, in float64: the exporter's reference of each step, and here what it leaves to
# the stream - passing from model to model, cancelling, taking up again (lib/units.c, lib/stream.c)


@dataclass(frozen=True)
class Run:
    """Phonemes of one model that follow each other, with their frames: what is solved at once, as if silence were
    before and after."""

    model: str
    begin: int  #: frame of the part
    phonemes: Tuple[Tuple[int, int], ...]
    counts: Tuple[int, ...]


def runs(pushes: Sequence[Push], fps: int) -> List[Run]:
    """The runs of a part. Phonemes without frames leave no trace but their time."""
    counts = frame_counts([push.milliseconds for push in pushes], fps)
    held = [(push, count) for push, count in zip(pushes, counts) if count]
    result: List[Run] = []
    begin = 0
    for model, group in groupby(held, key=lambda item: item[0].model):
        own = list(group)
        result.append(Run(model, begin, tuple((push.phoneme, push.milliseconds) for push, _ in own),
                          tuple(count for _, count in own)))
        begin += sum(result[-1].counts)
    return result


def part_gain(part: Part, frames: int, stride: int, percent: int, window: int = WINDOW, lag: int = LAG) -> np.ndarray:
    """(frames, 13) the articulation of the frames of a part, which begins with `percent`. When n frames are delivered,
    n and the delay are taken in."""
    wanted = np.full(frames, percent)
    for after, later in part.articulation:
        wanted[after + window + lag + stride if after else 0 :] = later
    return gains(wanted, stride, lag)


def part_motion(
    tables: Dict[str, Tables], part: Part, held: np.ndarray, percent: int = 100, **limits: int
) -> np.ndarray:
    """(T, 13) float64, FAP: the frames of one part up to its end or cancel, without the way to rest. `held` (13,) is
    the pose from which it fades in; `percent` the articulation that it begins with; `limits` are the
    `window`, `lag` and `searched` of a library that is built for others. A contact is known as far ahead as a frame
    that is taken in waits for its delivery."""
    motion = np.zeros((0, CHANNELS))
    faded_until = 0  # the frame behind the last that a fade has touched
    own_runs = runs(part.pushes, tables["speech"].fps)
    until = [run.begin + sum(run.counts) for run in own_runs]
    gain = part_gain(part, max(until, default=0), tables["speech"].stride, percent,
                     **{name: value for name, value in limits.items() if name != "searched"})
    for run, end in zip(own_runs, until):
        own = tables[run.model]
        articulated = gain[run.begin : end, : len(own.solved)]
        target, contact, ends = aims(own, run.phonemes, run.counts)
        fresh = solution(own, target, contact, ends, articulated, begin=run.begin, **limits)
        stands = run.begin < 2 or run.begin <= faded_until
        moved = np.zeros(CHANNELS) if stands else motion[-1] - motion[-2]
        pose = motion[-1] if run.begin else held
        delay = limits.get("window", WINDOW) + limits.get("lag", LAG) + own.stride
        closing = closing_steps(pose, contact[: delay + 1].any(axis=1))
        fresh = faded(pose, moved, fresh, closing=closing)
        faded_until = run.begin + FADE
        motion = np.concatenate([motion, fresh])
    return motion[: part.cancel[0]] if part.cancel else motion


def script_motion(tables: Dict[str, Tables], script: Script, **limits: int) -> np.ndarray:
    """(T, 13) float64, FAP: all frames of a stream; `limits` as in :func:`part_motion`."""
    rate = tables["speech"].fps
    held, percent = np.zeros(CHANNELS), 100
    shown: List[np.ndarray] = [np.zeros((0, CHANNELS))]
    for part in script.parts:
        motion = part_motion(tables, part, held, percent, **limits)
        percent = part.articulation[-1][1] if part.articulation else percent
        shown.append(motion)
        held = motion[-1] if len(motion) else held
        if part.cancel:
            over = [part.cancel[1], *(milliseconds for _, milliseconds in part.again)]
            until = [frames for frames, _ in part.again]
            for milliseconds, frames in zip(over, [*until, None]):
                length = ease_frames(milliseconds, rate)
                shown.append(eased(held, length)[:frames])
                held = shown[-1][-1] if len(shown[-1]) else held
            held = np.zeros(CHANNELS)
        elif not rests(held):
            shown.append(eased(held))
            held = np.zeros(CHANNELS)
    return np.concatenate(shown)


# ---- Frames of the library


def bundled_models() -> Dict[str, ExportedModel]:
    """The bundled models' tables, by their words in ``streams.txt``."""
    return {word: quantise(load(str(ROOT / "export" / "models" / f"{name}.npz")), name)
            for word, name in MODELS.items()}


def library_frames(vectors: str, **limits: int) -> str:
    """What print_frames.c prints, compiled with `vectors` and the host's compiler. `limits` are those of
    ``labial/labial.h`` that are not the default, `window` for ``LABIAL_WINDOW``."""
    with tempfile.TemporaryDirectory(prefix="labial-") as name:
        folder = Path(name)
        (folder / "vectors.c").write_text(vectors, encoding="ascii")
        library = [path for path in sorted((ROOT / "lib").glob("*.c"))
                   if not path.name.startswith(("hear", "timings", "voice", "words"))]  # no part of a stream
        sources = [folder / "vectors.c", HERE / "player.c", HERE / "print_frames.c", ROOT / "boards" / "text.c",
                   ROOT / "boards" / "host" / "host.c", *library,
                   *(ROOT / "lib" / "models" / f"{model}.c" for model in MODELS.values())]
        includes = [f"-I{path}" for path in (ROOT / "include", ROOT / "lib" / "models", ROOT / "boards", HERE)]
        defined = [f"-DLABIAL_{limit.upper()}={value}" for limit, value in limits.items()]
        command = [CC, "-std=c99", "-O2", '-DBOARD_NAME="host"', *defined, *includes, *map(str, sources),
                   "-o", str(folder / "print_frames")]
        for step in (command, [str(folder / "print_frames")]):
            done = subprocess.run(step, capture_output=True, text=True)
            if done.returncode:
                raise LabialError(f"{Path(step[0]).name} failed:\n{done.stderr}{done.stdout[-500:]}")
        return done.stdout


def brief(text: str) -> str:
    """The frames' text with ``and`` and a number for lines that are like the one before."""
    rows = [(line, sum(1 for _ in same) - 1) for line, same in groupby(text.splitlines())]
    return "".join(f"{line}\nand {alike}\n" if alike else f"{line}\n" for line, alike in rows)


def deviations(models: Dict[str, ExportedModel], scripts: Sequence[Script], frames: Frames, **limits: int) -> str:
    """How far the frames are from the float64 reference; raises LabialError when that is too far. In the RMS a pose
    that does not move, which has one rounding, counts once. `limits` as in :func:`motion.script_motion`."""
    tables = {word: ExportedTables(model) for word, model in models.items()}
    lines, found = [], []
    for script in scripts:
        wanted = script_motion(tables, script, **limits)
        if wanted.shape != frames[script.name].shape:
            raise LabialError(f"{script.name}: {len(frames[script.name])} frames, the reference has {len(wanted)}")
        difference = frames[script.name] - np.floor(wanted + 0.5)
        largest = np.abs(difference).max(initial=0)
        lines.append(f"{script.name:<18}{len(wanted):>6} frames, largest difference {largest:.0f}")
        if largest > LARGEST:
            t, k = np.unravel_index(int(np.abs(difference).argmax()), difference.shape)
            raise LabialError(f"{script.name}: frame {t}, channel {k} is {frames[script.name][t, k]}, "
                              f"the reference has {wanted[t, k]:.2f}")
        found.append(difference[np.diff(frames[script.name], axis=0, prepend=np.inf).any(axis=1)])
    every = np.concatenate(found)
    rms = float(np.sqrt(np.mean(every**2)))
    if rms > RMS:
        raise LabialError(f"RMS {rms:.3f} FAP units from the reference, limit {RMS}")
    lines.append(f"{'all':<18}{len(every):>6} frames that move, RMS {rms:.3f} FAP units")
    return "\n".join(lines)


def main() -> int:
    try:
        models = bundled_models()
        scripts = read(HERE / "streams.txt", models)
        text = library_frames(as_c(scripts, models))
        frames = read_frames(text)
        print(deviations(models, scripts, frames))
        (HERE / "frames.txt").write_text(brief(text), encoding="ascii", newline="\n")
        (HERE / "vectors.c").write_text(as_c(scripts, models, frames), encoding="ascii", newline="\n")
    except LabialError as error:
        print(f"regenerate: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
