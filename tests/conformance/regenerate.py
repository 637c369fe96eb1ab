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
from pathlib import Path
from typing import Dict, Sequence

import numpy as np

HERE = Path(__file__).resolve().parent
CC = os.environ.get("LABIAL_CC") or "cc"
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT / "export")]

from labial.errors import LabialError  # noqa: E402
from labial.evaluate.check import LARGEST, RMS  # noqa: E402
from labial.reference.tables import ExportedTables  # noqa: E402
from labial.tables.model import load  # noqa: E402
from labial.tables.quantise import ExportedModel, quantise  # noqa: E402
from motion import script_motion  # noqa: E402
from scripts import MODELS, Frames, Script, as_c, read, read_frames  # noqa: E402


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
        sources = [folder / "vectors.c", HERE / "player.c", HERE / "print_frames.c", ROOT / "boards" / "text.c",
                   ROOT / "boards" / "host" / "host.c", *sorted((ROOT / "lib").glob("*.c")),
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
    """Runs the command; returns its exit status."""
    try:
        models = bundled_models()
        scripts = read(HERE / "streams.txt", models)
        text = library_frames(as_c(scripts, models))
        frames = read_frames(text)
        print(deviations(models, scripts, frames))
        (HERE / "frames.txt").write_text(text, encoding="ascii", newline="\n")
        (HERE / "vectors.c").write_text(as_c(scripts, models, frames), encoding="ascii", newline="\n")
    except LabialError as error:
        print(f"regenerate: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
